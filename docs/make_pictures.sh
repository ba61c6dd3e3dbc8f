#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes docs/pictures/. Needs build/orbitutte, the Python module in build/python, pngquant and chromium. Those of real meshes need ../shared beside the repository: where it is
# missing they stay as they are. Only meshes whose licences allow pictures of them are drawn.
# usage: docs/make_pictures.sh [PROGRAM]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
orbitutte=$(realpath -m "${1-$root/build/orbitutte}")
out=$root/docs/pictures
shared=$root/../shared/meshes

[ -x "$orbitutte" ] || { echo "make_pictures.sh: there is no program $orbitutte; cmake/build.sh orbitutte_cli builds it" >&2; exit 1; }
for tool in pngquant chromium; do
  command -v $tool >/dev/null || { echo "make_pictures.sh: $tool is missing; the package of that name has it" >&2; exit 1; }
done

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p "$out"
cd "$scratch"
declare -A mesh_of=()  # the mesh of each embedding, by its name

# A mesh that the program makes: NAME SHAPE FACES
sample() { "$orbitutte" sample --shape "$2" --faces "$3" -o "$1.ply"; }

# An embedding: NAME MESH ORBIFOLD CONES [OPTION ...]
embed() {
  local name=$1 mesh=$2 orbifold=$3 cones=$4
  shift 4
  mesh_of[$name]=$mesh
  "$orbitutte" embed "$mesh" --orbifold "$orbifold" --cones "$cones" -o "$name-map.ply" --report "$name.json" --quiet "$@"
}

# With the paper's weights.
embed_as_paper() { embed "$@" --weights cotan; }

# A picture file with a palette of 128 colours: PICTURE FILE
keep() { pngquant --force --speed 1 --output "$out/$1.png" 128 "$2"; }

# A picture of an embedding: PICTURE NAME [OPTION ...]
render() {
  local picture=$1 name=$2
  shift 2
  "$orbitutte" render "$name-map.ply" "$name.json" "${mesh_of[$name]}" -o full.png "$@"
  keep "$picture" full.png
}

# Mesh and histograms of both geometries: PICTURE MESH CONES
compare() {
  "$orbitutte" compare "$2" --cones "$3" --weights cotan -o full.png >/dev/null
  keep "$1" full.png
}

# surface-maps.md: a figure, and one of other proportions, with five landmarks; that one's texture is a checkerboard
PYTHONPATH=$(dirname "$orbitutte")/python:$root/docs /usr/bin/python3 - <<'END'
import numpy as np
import orbitutte
from draw_textured import write_png

V, F = orbitutte.sample_mesh("figure", 8000)
W, G = orbitutte.sample_mesh("figure", 6000)
bent = lambda P: np.stack([1.35 * P[:, 0], 0.9 * P[:, 1] - 0.15 * P[:, 0] ** 2, P[:, 2] + 0.2 * P[:, 1] ** 2], axis=1)
marks = orbitutte.choose_cones(V, F, "2,2,2,2,2")
partners = [int(np.argmin(np.linalg.norm(W - V[mark], axis=1))) for mark in marks]
orbitutte.write_mesh("map-a.obj", V, F)
orbitutte.write_mesh("map-b.obj", bent(W), G)
np.savetxt("landmarks.txt", np.stack([marks, partners], axis=1), fmt="%d")
i, j = np.mgrid[:1024, :1024]
light = ((i // 32 + j // 32) % 2 == 0)[:, :, None]
write_png("checkerboard.png", np.where(light, [240, 236, 228], np.stack([40 + i // 8, 80 + 0 * i, 60 + j // 8], axis=2)).astype(np.uint8))
END
"$orbitutte" embed map-b.obj --orbifold 432 --cones extremities -o map-b.ply --report map-b.json --quiet
"$orbitutte" export map-b.ply map-b.json map-b.obj -o map-b-textured.obj >/dev/null
"$orbitutte" map map-a.obj map-b-textured.obj --landmarks landmarks.txt -o surface-map --picture full.png --texture checkerboard.png --texture-size 2048 --quiet
keep map-sheet full.png
/usr/bin/python3 "$root/docs/draw_textured.py" full.png map-b-textured.obj checkerboard.png
keep map-texture full.png
/usr/bin/python3 "$root/docs/draw_textured.py" full.png surface-map/textured_a.obj surface-map/texture.png
keep map-textured full.png

# examples.md
PYTHONPATH=$(dirname "$orbitutte")/python /usr/bin/python3 "$root/examples/distortion_of_orders.py" >/dev/null
cp orders.svg "$out"
PYTHONPATH=$(dirname "$orbitutte")/python /usr/bin/python3 "$root/examples/transfer_heat_map.py" >/dev/null
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=520,320 --screenshot=full.png heat_map.svg 2>/dev/null
keep carried full.png

# README.md, rendering.md, comparison.md, projective-planes.md

sample figure figure 20000
sample mask mask 3000
sample boy boy 20000
embed figure figure.ply 432 best
embed mask mask.ply '*532' best
embed boy boy.ply 1x best
render sheet figure --size 1600x1228
"$orbitutte" compare figure.ply -o full.png >/dev/null
keep comparison full.png
render mask mask --panel source --size 480
render mask-sphere mask --panel sphere --size 480
render boy boy --size 1200x920

# reproduction.md: one tiling of each family

# PICTURE MESH ORBIFOLD [OPTION ...]
tiling() {
  local picture=$1 mesh=$2 orbifold=$3
  shift 3
  embed_as_paper "$picture" "$mesh" "$orbifold" best
  render "$picture" "$picture" --panel sphere --size 320 "$@"
}

sample disk mask 8000
tiling tiling-532 figure.ply 532
tiling tiling-432 figure.ply 432
tiling tiling-332 figure.ply 332
tiling tiling-225 figure.ply 225 --view 0.5,-0.5,1 --up=-y
tiling tiling-55 figure.ply 55 --view 1,0.5,0.6
tiling tiling-star532 disk.ply '*532'
tiling tiling-star432 disk.ply '*432'
tiling tiling-star332 disk.ply '*332'
tiling tiling-star225 disk.ply '*225' --view 0.5,0.5,1 --up y
tiling tiling-star33 disk.ply '*33' --view 1,0.5,0.6
tiling tiling-3star2 disk.ply '3*2'
tiling tiling-2star5 disk.ply '2*5'
tiling tiling-5star disk.ply '5*'
tiling tiling-3x boy.ply 3x --view 1,0,0.5
embed_as_paper paper figure.ply 432 best
render checkerboard-figure paper --panel checkerboard --size 400

# reproduction.md: real meshes

if [ ! -d "$shared" ]; then
  echo "make_pictures.sh: there is no $shared, so the pictures of real meshes stay as they are" >&2
  exit 0
fi

spot=$shared/spot.obj cortex=$shared/cortex_icbm152_lh.off face=$shared/face.obj
medial=(--view 1,0,0 --up z) lateral=(--view=-1,0,0 --up z)

embed_as_paper spot "$spot" 432 11505,2648,3517
render spot-source spot --panel source --size 400 --view=-1,0.3,-0.5
render spot-sphere spot --panel sphere --size 400
render convergence spot --panel convergence --size 640x440
render checkerboard-spot spot --panel checkerboard --size 400 --view=-1,0.3,0.4
embed_as_paper face "$face" '*432' 11,270,774
render face-source face --panel source --size 400
render face-sphere face --panel sphere --size 400 --view 1,0.3,1 --up=-z
render checkerboard-face face --panel checkerboard --size 400
embed_as_paper mixed "$face" '3*2' 4421,11
render mixed-source mixed --panel source --size 400
render mixed-sphere mixed --panel sphere --size 400

# Two cuts of one mesh.
embed_as_paper cortex "$cortex" 432 36349,40878,17665
embed_as_paper recut "$cortex" 432 36349,40878,17665 --cut-seed 5
render cortex-source cortex --panel source --size 400 "${medial[@]}"
render recut-source recut --panel source --size 400 "${medial[@]}"
render cortex-sphere cortex --panel sphere --size 400 --view 0.6,0,0.8
render recut-sphere recut --panel sphere --size 400 --view 0.6,0,0.8
render checkerboard-cortex cortex --panel checkerboard --size 400 "${lateral[@]}"

# Free and held boundaries.
printf '11 1 0 0\n270 0 1 0\n774 0 0 1\n' >corners.txt
embed_as_paper free "$face" '*222' 11,270,774
mesh_of[held]=$face
"$orbitutte" embed "$face" --orbifold polygon --polygon corners.txt --spread equidistant --weights cotan -o held-map.ply \
  --report held.json --quiet
render free-sphere free --panel sphere --size 400 --view 1,1,1 --up=-z
for name in free held; do
  render "$name-checkerboard" "$name" --panel checkerboard --size 400
  render "$name-angle" "$name" --panel angle --size 400
done

compare histograms-spot "$spot" 11505,2648,3517
compare histograms-cortex "$cortex" 36349,40878,17665
