// SPDX-License-Identifier: MIT
#include "orbitutte/memory.h"

#include <dlfcn.h>

#include <cstdint>
#include <cstdlib>

#include "orbitutte/parallel.h"

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace orbitutte {
namespace {

#ifdef __GLIBC__
// Half of the machine's memory, in bytes: Linux refuses a single request for more than all of it.
std::size_t half_of_memory() {
  return static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) / 2 *
         static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Advises the whole huge pages inside a block; pages outside stay as they are.
void advise_huge_pages(void* block, std::size_t size) {
  constexpr std::uintptr_t page = 2 << 20;
  const auto begin = reinterpret_cast<std::uintptr_t>(block), end = begin + size;
  const std::uintptr_t first = (begin + page - 1) / page * page, last = end / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
}
#endif

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_TOP_PAD, 64 << 20);
#endif
}

void use_huge_pages() {
  keep_freed_memory();
#ifdef __GLIBC__
  mallopt(M_ARENA_MAX, 1);  // other arenas do not lie in the heap that is advised
  const std::size_t size = half_of_memory();
  void* const heap = std::malloc(size);
  if (!heap) return;
  advise_huge_pages(heap, size);
  std::free(heap);  // it stays malloc's
#endif
}

// In a process that was forked, already the call that sets the number starts threads.
void use_one_blas_thread() {
  const auto get = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_num_threads"));
  const auto set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (get && set && get() != 1) set(1);
}

int on_one_thread(const std::function<int()>& work) { return with_threads(1, work); }

}  // namespace orbitutte
