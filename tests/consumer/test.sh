#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs a build, moves it elsewhere, and builds and runs a program against it: by find_package, then by pkg-config.
# usage: tests/consumer/test.sh BUILD
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
build=$(cd "$1" && pwd -P)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cxx=${CXX:-c++}
fail() { echo "FAILED: $*" >&2; exit 1; }

cmake --install "$build" --prefix "$scratch/first" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
prefix=$scratch/moved
mv "$scratch/first" "$prefix"
library=$(dirname "$(find "$prefix" -name 'liborbitutte.*' | head -n 1)")
echo "installed and moved: $(find "$prefix" -type f | wc -l) files"

# Nothing names the build or the place of the first installation.
if grep -rlF -e "$source/" -e "$build" -e "$scratch/first" "$prefix"; then fail "the files above name a folder of the build"; fi

# Nor where this machine has the libraries that it is linked with.
if grep -rnE '(^|[;" ])/[^;" ]*[.](so|a|dylib)' "$library/cmake" "$library/pkgconfig"; then fail "the above names a library by its path"; fi

# All that the command and the examples include is a public header, and each header includes what it needs.
missing=$(cat "$source"/apps/*.{cpp,h} "$source"/examples/*.cpp | sed -n 's/^#include "\(orbitutte\/.*\)"/\1/p' | sort -u |
          while read -r header; do [ -e "$prefix/include/$header" ] || echo "$header"; done)
[ -z "$missing" ] || [ "$missing" = orbitutte/render/render.h ] || fail "not among the public headers of cmake/install.cmake: $missing"
(cd "$prefix/include" && find . -name '*.h' | sort -r | sed 's/.*/#include "&"/') >"$scratch/headers.cpp"
export PKG_CONFIG_PATH=$library/pkgconfig
read -r -a flags < <(pkg-config --cflags orbitutte)
"$cxx" -std=c++20 -fsyntax-only -Wall -Wextra "${flags[@]}" "$scratch/headers.cpp"
echo "headers: $(wc -l <"$scratch/headers.cpp"), complete"

# What a program depends on, and what it is linked with, lies in the moved prefix.
uses_moved() {
  grep -q "$prefix/\(.*/\)\?include/orbitutte/embed[.]h" "$1" || fail "$1 does not name the installed headers"
  ! grep -F -e "$source/src" -e "$build" "$1" || fail "$1 names the source tree"
}

cmake -S "$source/tests/consumer" -B "$scratch/consumer" -D CMAKE_PREFIX_PATH="$prefix" -D CMAKE_BUILD_TYPE=None \
      -D CMAKE_CXX_FLAGS=-O0 -G Ninja >"$scratch/log" 2>&1 &&
  cmake --build "$scratch/consumer" --verbose >>"$scratch/log" 2>&1 || { cat "$scratch/log"; exit 1; }
grep -qF "$library/liborbitutte." "$scratch/log" || fail "the program is not linked with the installed library"
ninja -C "$scratch/consumer" -t deps >"$scratch/consumer.d"
uses_moved "$scratch/consumer.d"
"$scratch/consumer/consumer"
echo "find_package: works"

# A program that asks for another minor version is refused.
mkdir "$scratch/wrong"
for wrong in 0.0 0.2; do
  printf 'cmake_minimum_required(VERSION 3.22)\nproject(wrong LANGUAGES NONE)\nfind_package(orbitutte %s REQUIRED)\n' $wrong \
    >"$scratch/wrong/CMakeLists.txt"
  ! cmake -S "$scratch/wrong" -B "$scratch/wrong/build" -D CMAKE_PREFIX_PATH="$prefix" >"$scratch/log" 2>&1 || fail "version $wrong was found"
  grep -q 'version: 0[.]1[.]' "$scratch/log" || fail "version $wrong was refused for another reason: $(cat "$scratch/log")"
done
echo "find_package: refuses 0.0 and 0.2"

static=--static
[ -e "$library/liborbitutte.a" ] || static=
read -r -a flags < <(pkg-config --cflags --libs $static orbitutte)
"$cxx" -std=c++20 -O0 -MMD -MF "$scratch/pkg-config.d" "$source/tests/consumer/main.cpp" -o "$scratch/pkg-config" "${flags[@]}"
uses_moved "$scratch/pkg-config.d"
LD_LIBRARY_PATH=$library "$scratch/pkg-config"
echo "pkg-config: works"

# Eigen allocates matrices in another way for AVX: such a program would crash when it frees what the library allocated.
if [ "$(uname -m)" = x86_64 ]; then
  ! "$cxx" -std=c++20 -fsyntax-only -mavx2 -mfma "${flags[@]}" "$source/tests/consumer/main.cpp" 2>"$scratch/log" || fail "AVX was accepted"
  grep -q 'orbitutte was compiled for other vector instructions' "$scratch/log" || fail "AVX was refused with: $(cat "$scratch/log")"
  echo "other vector instructions: refused"
fi
