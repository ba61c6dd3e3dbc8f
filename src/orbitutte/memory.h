// SPDX-License-Identifier: MIT
// Advice to the allocator for programs that embed large meshes.
#pragma once

namespace orbitutte {

/// Makes malloc keep what is freed for later use, where it is glibc's, instead of giving it back to the
/// operating system and asking for it anew: large arrays come and go in every stage, and first touching their
/// pages takes up to a third of an embedding's time (docs/benchmarks.md). It holds for the whole process
/// until its end, so a program may call this in its main; the library never does.
void keep_freed_memory();

}  // namespace orbitutte
