#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# cpack makes the Debian packages: the right files, what they depend on, the licence, and no folder of the build in them.
# usage: tests/package/deb_test.sh BUILD
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
build=$(cd "$1" && pwd -P)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }

cpack --config "$build/CPackConfig.cmake" -B "$scratch" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip >"$scratch/log" 2>&1 ||
  { cat "$scratch/log"; exit 1; }
version=$("$build/orbitutte" --version | sed -n '1s/^orbitutte \([0-9.]*\) .*/\1/p')
archive() { echo "$scratch/$1_${version}_$(dpkg --print-architecture).deb"; }

# usage: has PACKAGE FILE ...      the files as find's patterns
has() {
  local package=$1 file
  shift
  [ -e "$(archive "$package")" ] || fail "there is no $(archive "$package"): $(ls "$scratch")"
  dpkg-deb --contents "$(archive "$package")" >"$scratch/contents"
  dpkg-deb --raw-extract "$(archive "$package")" "$scratch/$package"
  for file in "$@" "share/doc/$package/copyright" "share/doc/$package/changelog.gz"; do
    [ -n "$(find "$scratch/$package/usr" -type f -path "*/usr/$file")" ] || fail "$package has no $file"
  done
  if grep -v ' root/root ' "$scratch/contents"; then fail "what is above does not belong to root"; fi
  if grep -vE ' [.]/(usr/.*)?$' "$scratch/contents"; then fail "what is above is not in /usr"; fi
  if grep -raFl -e "$source/" -e "$build/" -e "$scratch" "$scratch/$package"; then fail "what is above names a folder of the build"; fi
  echo "$package: $(wc -l <"$scratch/contents") files and folders"
}
has orbitutte bin/orbitutte share/man/man1/orbitutte.1.gz share/bash-completion/completions/orbitutte \
    'share/zsh/*/_orbitutte' share/fish/vendor_completions.d/orbitutte.fish
has liborbitutte-dev include/orbitutte/embed.h include/orbitutte/version.h 'lib*/liborbitutte.a' 'lib*/pkgconfig/orbitutte.pc' \
    'lib*/cmake/orbitutte/orbitutteConfig.cmake' 'lib*/cmake/orbitutte/orbitutteConfigVersion.cmake'


# The Python module, where it was built for the system's Python.
if grep -q '"debian_python"\|;debian_python' "$build/CPackConfig.cmake"; then
  has python3-orbitutte lib/python3/dist-packages/orbitutte/__init__.py lib/python3/dist-packages/orbitutte/py.typed \
      'lib/python3/dist-packages/orbitutte/_orbitutte.*.so'
  PYTHONPATH=$scratch/python3-orbitutte/usr/lib/python3/dist-packages /usr/bin/python3 -c 'import orbitutte
assert orbitutte.__file__.startswith("'"$scratch"'/"), orbitutte.__file__
V, F = orbitutte.sample_mesh("figure", 1000)
assert orbitutte.embed(V, F, "332", "auto").bijective'
  depends=$(dpkg-deb --field "$(archive python3-orbitutte)" Depends)
  for package in python3-numpy "python3 (<< 3." libtbb; do
    [[ ", $depends" == *", $package"* ]] || fail "python3-orbitutte depends on $depends only"
  done
fi

# Each library that the command loads comes from a package that it depends on; a BLAS from whichever of those that can replace each other.
command=$scratch/orbitutte/usr/bin/orbitutte
depends=$(dpkg-deb --field "$(archive orbitutte)" Depends)
dependencies=$(tr ',|' '\n\n' <<<"$depends" | awk '{print $1}')
for library in $(readelf -d "$command" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'); do
  path=$(ldd "$command" | awk -v library="$library" '$1 == library {print $3}')
  [ -n "$path" ] || continue  # the dynamic linker, which needs no looking for
  packages=$(dpkg-query --search "$(readlink -f "$path")" "$path" "/usr$path" 2>/dev/null | sed 's/:.*//' | sort -u || true)
  case $library in lib*blas* | liblapack*) packages="libopenblas0 libblas3 liblapack3" ;; esac
  [ -z "$packages" ] || grep -qFxf <(tr ' ' '\n' <<<"$packages") <<<"$dependencies" ||
    fail "$library comes from $packages, and the package depends on $depends only"
done
if readelf -d "$command" | grep -E 'RPATH|RUNPATH'; then fail "the command looks for libraries in a folder of its own"; fi
if readelf -S "$command" | grep -q '[.]symtab'; then fail "the command is not stripped"; fi
echo "depends on: $depends"
depends=$(dpkg-deb --field "$(archive liborbitutte-dev)" Depends)
for package in libeigen3-dev libsuitesparse-dev libmetis-dev; do
  [[ ", $depends," == *", $package,"* ]] || fail "liborbitutte-dev does not depend on $package"
done

# The command and the copyright file name the same licence.
licence=$("$build/orbitutte" --version | grep -oE 'GPL-[0-9.]+-or-later' | head -n 1 || true)
grep -qF " ${licence:-MIT, with}" "$scratch/orbitutte/usr/share/doc/orbitutte/copyright" || fail "copyright does not say '${licence:-MIT}'"
says_mumps() { grep -c CeCILL || true; }
[ "$("$build/orbitutte" --version | says_mumps)" = "$(says_mumps <"$scratch/orbitutte/usr/share/doc/orbitutte/copyright")" ] ||
  fail "--version and copyright do not agree about MUMPS"
echo "licence: ${licence:-MIT}"
