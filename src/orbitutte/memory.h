// SPDX-License-Identifier: MIT
// Advice to the allocator for programs that embed large meshes.
#pragma once

namespace orbitutte {

/// Makes glibc's malloc keep freed memory for later use instead of giving it back to the operating system;
/// other allocators stay as they are. Large arrays come and go in every stage, and first touching their
/// pages takes up to a third of an embedding's time (docs/benchmarks.md). The effect lasts until the process
/// ends, so the library never calls this; a program may call it in its main.
void keep_freed_memory();

}  // namespace orbitutte
