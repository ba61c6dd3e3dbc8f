// SPDX-License-Identifier: MIT
// Advice to allocator, BLAS and oneTBB for programs that embed large meshes, or many.
#pragma once

#include <functional>

namespace orbitutte {

/// Makes glibc's malloc keep freed memory for later use instead of giving it back to the operating system;
/// other allocators stay as they are. Large arrays come and go in every stage, and first touching their
/// pages takes up to a third of an embedding's time (docs/benchmarks.md). The effect lasts until the process
/// ends, so the library never calls this; a program may call it in its main.
void keep_freed_memory();

/// Does the same, and asks Linux to back glibc's heap by huge pages, which most systems give only to those
/// who ask: pages are touched for the first time 512 at a time. For a program to call in its main, before it
/// starts threads: they all share the one heap from then on.
void use_huge_pages();

/// Makes BLAS calls run on the calling thread: two BLAS threads gain little on small fronts and lose much on
/// a busy machine. The library does so when it factorises. A program that forks processes that embed may call
/// it before: otherwise OpenBLAS starts its threads anew in each of them, to wait for work in a busy loop.
void use_one_blas_thread();

/// Calls `work`, in which all loops run on the calling thread, also those outside of an embedding, such as
/// reading, and returns what it returns. For a program that has work for every core already.
int on_one_thread(const std::function<int()>& work);

}  // namespace orbitutte
