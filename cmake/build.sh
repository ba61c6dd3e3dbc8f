#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Configures and builds into build/ (Ninja, Release and several files at a time unless it was configured otherwise), showing the log only
# where it fails.
# usage: cmake/build.sh [TARGET ...]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
build=$root/build
log=$build/build.log

configure=(cmake -S "$root" -B "$build")
[ -f "$build/CMakeCache.txt" ] || configure+=(-G Ninja -D CMAKE_BUILD_TYPE=Release -D CMAKE_UNITY_BUILD=ON)
compile=(cmake --build "$build" --parallel "$(nproc)")
[ $# = 0 ] || compile+=(--target "$@")

mkdir -p "$build"
echo "Building in $build (the first time takes a few minutes) ..." >&2
if ! { "${configure[@]}" && "${compile[@]}"; } >"$log" 2>&1; then
  cat "$log" >&2
  echo "The build failed; the log above is in $log." >&2
  exit 1
fi
