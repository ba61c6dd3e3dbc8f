#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The target orbitutte_product builds all that `cmake --install` installs, and a build without its Python module has no empty package.
# usage: tests/package/product_test.sh BUILD
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
build=$(cd "$1" && pwd -P)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$build"

# What is installed out of the build: the scripts of CMake name it.
ninja -t targets all | sed -n 's/: [^:]*$//p' | sort -u >"$scratch/made"
find . -name cmake_install.cmake -not -path './install/*' -exec grep -ohE "\"$build/[^\"]+\"" {} + | tr -d '"' | sed "s|^$build/||" | sort -u |
  comm -12 - "$scratch/made" >"$scratch/installed"
[ "$(wc -l <"$scratch/installed")" -ge 3 ] || { echo "FAILED: only these are installed: $(cat "$scratch/installed")" >&2; exit 1; }

# Every command that makes one of these files is a command of the target.
ninja -t commands orbitutte_product | sort -u >"$scratch/commands"
while read -r file; do
  ninja -t commands "$file" | sort -u | comm -23 - "$scratch/commands" | grep . >"$scratch/missing" || continue
  echo "FAILED: installed, but not built by orbitutte_product: $file" >&2
  exit 1
done <"$scratch/installed"
echo "orbitutte_product builds the $(wc -l <"$scratch/installed") files that are installed"

# A build that was configured only.
python=$(sed -n 's/^Python_EXECUTABLE:[A-Z]*=//p; s/^_Python_EXECUTABLE:INTERNAL=//p' CMakeCache.txt | head -n 1)
[ -d "$build/python/orbitutte" ] && [ -n "$python" ] || exit 0
cmake -S "$source" -B "$scratch/configured" -D ORBITUTTE_BUILD_TESTS=OFF -D ORBITUTTE_BUILD_EXAMPLES=OFF -D Python_EXECUTABLE="$python" >"$scratch/log" 2>&1 ||
  { cat "$scratch/log" >&2; exit 1; }
said=$(PYTHONPATH=$scratch/configured/python "$python" -c 'import orbitutte' 2>&1 || true)
[[ $said == *'ImportError: the compiled module of orbitutte'*orbitutte_package* ]] || { echo "FAILED: without the compiled module Python says: $said" >&2; exit 1; }
echo "without its compiled module the package says: ${said##*$'\n'}"
