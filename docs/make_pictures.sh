#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/pictures/ from the program's own sample meshes. Needs build/orbitutte and pngquant.
# usage: docs/make_pictures.sh [PROGRAM]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
orbitutte=${1-$root/build/orbitutte}
out=$root/docs/pictures
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

# A sample and its embedding: NAME SHAPE FACES ORBIFOLD
embed() {
  "$orbitutte" sample --shape "$2" --faces "$3" -o "$1.ply"
  "$orbitutte" embed "$1.ply" --orbifold "$4" --cones auto -o "$1-map.ply" --report "$1.json" --quiet
}

# A picture with a palette of 128 colours: PICTURE NAME [OPTION ...]
render() {
  local picture=$1 name=$2
  shift 2
  "$orbitutte" render "$name-map.ply" "$name.json" "$name.ply" -o full.png "$@"
  pngquant --force --speed 1 --output "$out/$picture.png" 128 full.png
}

mkdir -p "$out"
embed figure figure 20000 432
embed mask mask 3000 '*532'
render sheet figure --size 1600x1228
"$orbitutte" compare figure.ply -o full.png >/dev/null
pngquant --force --speed 1 --output "$out/comparison.png" 128 full.png
render mask mask --panel source --size 480
render mask-sphere mask --panel sphere --size 480
embed boy boy 20000 1x
render boy boy --size 1200x920
