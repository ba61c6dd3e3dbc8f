#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the Debian packages in a minimal root of this machine's Debian release, runs the command there, and removes it again.
# Too slow for every change: by hand, as root, with mmdebstrap installed. The root is made from the package sources of this machine.
# usage: tests/package/clean_root_test.sh FOLDER_OF_THE_DEBS [--development]
#        --development: also installs liborbitutte-dev with a compiler there (half a gigabyte), and builds tests/consumer
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)
[ $# -ge 1 ] && debs=$(cd "$1" && pwd -P) || { sed -n 's/^# usage: /usage: /p' "${BASH_SOURCE[0]}" >&2; exit 2; }
development=${2-}
[ "$(id -u)" = 0 ] && command -v mmdebstrap >/dev/null || { echo "this needs root and mmdebstrap" >&2; exit 1; }
scratch=$(mktemp -d)
root=$scratch/root
trap 'rm -rf "$scratch"' EXIT
fail() { echo "FAILED: $*" >&2; exit 1; }
# In a mount namespace of its own, so that /proc is gone with it.
inside() { unshare --mount sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }
# What there is, but for apt's and dpkg's own records.
listing() {
  local skip=() folder
  for folder in proc dev sys tmp var/lib/apt var/lib/dpkg var/cache var/log; do skip+=(-path "./$folder" -prune -o); done
  (cd "$root" && find . -xdev "${skip[@]}" -print | sort)
}

# Debian's own sources of this machine, and how it reaches them.
. /etc/os-release
apt-get indextargets --format '$(SITE) $(RELEASE) $(COMPONENT)' "Created-By: Packages" |
  awk -v release="$VERSION_CODENAME" '$2 == release || $2 == release "-updates" || $2 == release "-security"' | sort -u |
  while read -r site suite component; do echo "deb $site $suite $component"; done >"$scratch/sources.list"
grep -q " $VERSION_CODENAME " "$scratch/sources.list" || fail "this machine has no package sources of its release, '$VERSION_CODENAME'"
apt-config dump | grep -E '^Acquire::(http|https|ftp)::' >"$scratch/apt.conf" || true

mmdebstrap --quiet --mode=root --variant=apt --aptopt="$scratch/apt.conf" "$VERSION_CODENAME" "$root" - <"$scratch/sources.list"
cp -r "$debs" "$root/debs"
echo "root: $(inside dpkg-query -f '.\n' -W | wc -l) packages, $(du -sm "$root" | cut -f1) MB"
inside apt-get -qq update
listing >"$scratch/before"

inside sh -c 'apt-get install -y /debs/orbitutte_*.deb' >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "apt could not install it"; }
echo "installed: $(grep -E '^[0-9]+ upgraded' "$scratch/log")"
inside orbitutte --version
inside sh -ec 'cd /tmp
  orbitutte sample --shape figure --faces 20000 -o figure.ply
  orbitutte embed figure.ply --orbifold 432 --cones extremities -o map.ply --report map.json --quiet
  orbitutte verify map.ply map.json figure.ply
  orbitutte tile map.ply map.json -o tiling.glb
  orbitutte render map.ply map.json figure.ply -o map.png
  orbitutte report map.ply map.json figure.ply -o page.html
  ls -l'
inside dpkg --verify orbitutte || fail "dpkg --verify finds the above"
if compgen -G "$debs/python3-orbitutte_*.deb" >/dev/null; then
  inside sh -c 'apt-get install -y /debs/python3-orbitutte_*.deb' >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "apt could not install the module"; }
  inside python3 -c 'import orbitutte; print(orbitutte.embed(*orbitutte.sample_mesh("figure", 20000), "432", "auto"))'
fi
inside sh -c 'apt-get purge -y --auto-remove orbitutte python3-orbitutte' >"$scratch/log" 2>&1 || { cat "$scratch/log"; fail "apt could not remove it"; }
! inside sh -c 'command -v orbitutte' || fail "the command is still there"
listing >"$scratch/after"
left=$(comm -13 "$scratch/before" "$scratch/after" | grep -i orbitutte || true)
[ -z "$left" ] || fail "left behind: $left"
echo "removed: $(comm -13 "$scratch/before" "$scratch/after" | wc -l) files of other packages left behind, none of orbitutte"

if [ "$development" = --development ]; then
  inside sh -c 'apt-get install -y --no-install-recommends g++ cmake make pkg-config /debs/liborbitutte-dev_*.deb' >"$scratch/log" 2>&1 ||
    { cat "$scratch/log"; fail "apt could not install liborbitutte-dev"; }
  cp -r "$source/tests/consumer" "$root/tmp/consumer"
  inside sh -ec 'cd /tmp/consumer && cmake -S . -B build && cmake --build build && build/consumer
    c++ -std=c++20 main.cpp -o by_pkg_config $(pkg-config --cflags --libs --static orbitutte) && ./by_pkg_config'
fi
echo "passed"
