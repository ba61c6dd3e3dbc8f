#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what is missing, builds, embeds a mesh, tiles the sphere with it, draws it, and writes a page about it; the files go to out/.
# usage: ./demo.sh                            a mesh that the program makes itself
#        ./demo.sh MESH [OPTION ...]          your mesh; the options are those of 'orbitutte embed'
# The exit code is that of 'orbitutte embed': 0 when the result is certified.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
case "${1-}" in -h | --help) sed -n '3,6s/^# //p' "$root/demo.sh"; exit 0 ;; esac

"$root/setup"
"$root/cmake/build.sh" orbitutte_product

orbitutte=$root/build/orbitutte
out=$root/out
mkdir -p "$out"
written=("$out"/embedding.ply "$out"/report.json "$out"/tiling.{ply,glb} "$out"/picture.png "$out"/page.html)
for file in "${written[@]}"; do
  [ $# = 0 ] || ! [ "$1" -ef "$file" ] || { echo "demo.sh: $1 is a file that the demo itself writes; copy it and give the copy" >&2; exit 2; }
done
rm -f "${written[@]}"

if [ $# = 0 ]; then
  mesh=$out/sample.ply
  "$orbitutte" sample --shape figure --faces 20000 -o "$mesh"
else
  mesh=$1
  shift
fi

# Where the user's options name the files and choices, they stand.
embedding=$out/embedding.ply report=$out/report.json
given=' '
arguments=("$@")
for ((k = 0; k < $#; ++k)); do
  option=${arguments[k]%%=*}
  value=${arguments[k]#*=}
  [ "$option" != "${arguments[k]}" ] || value=${arguments[k + 1]-}
  given+="$option "
  case $option in
    -o | --output) embedding=$value ;;
    --report) report=$value ;;
  esac
done
is_given() { case $given in *" $1 "*) true ;; *) false ;; esac; }

is_given -o || is_given --output || arguments+=(-o "$embedding")
is_given --report || arguments+=(--report "$report")

code=0
"$orbitutte" embed "$mesh" "${arguments[@]}" || code=$?
case $code in
  0 | 4 | 5) ;;
  *) echo "Nothing was embedded (exit code $code); the reason is above."; exit "$code" ;;
esac

tilings=()
for tiling in "$out/tiling.glb" "$out/tiling.ply"; do
  if "$orbitutte" tile "$embedding" "$report" -o "$tiling" 2>"$out/tile.log"; then
    tilings+=("$tiling")
  else
    cat "$out/tile.log" >&2
  fi
done
rm -f "$out/tile.log"
"$orbitutte" render "$embedding" "$report" "$mesh" -o "$out/picture.png" || true
page=$out/page.html
"$orbitutte" report "$embedding" "$report" "$mesh" -o "$page" || page=

echo
/usr/bin/python3 - "$report" "$mesh" <<'PYTHON'
import json, sys
report = json.load(open(sys.argv[1], encoding='utf-8'))
mesh, orbifold = report['mesh'], report['orbifold']
print(f"{sys.argv[2]}: {mesh['vertices']} vertices, {mesh['faces']} faces, a {mesh['topology'].replace('-', ' ')}")
group = f"group of order {orbifold['group_order']}" if orbifold['group_order'] else 'infinite group, or none'
print(f"embedded into {orbifold['signature']} ({group}), cones at {', '.join(str(cone['vertex']) for cone in report['cones'])}")
print(f"energy {report['energy']:.6g}, {report['iterations']} iterations ({report['termination']}), "
      f"{report['timings']['total']:.2f} s")
distortion = report['distortion']
print(f"area: within a factor of 4 of the mean scale on {distortion['within_4']:.1%} of the surface, "
      f"shrunk by more than 64 on {distortion['below_64']:.1%}")
print(f"angles: median distortion {distortion['angle']['median']:.4g}, where 1 is none")
if report['certificate']['bijective']:
    print('certified: the map is a bijection onto the orbifold')
else:
    failed = [check['name'] for check in report['certificate']['checks'] if not check['passed']]
    print('NOT certified; these checks failed:', ', '.join(failed))
PYTHON
echo "embedding  $embedding"
echo "report     $report"
for tiling in ${tilings[@]+"${tilings[@]}"}; do
  echo "tiling     $tiling"
done
[ ! -e "$out/picture.png" ] || echo "picture    $out/picture.png"
[ -z "$page" ] || echo "page       $page    (open it in a browser)"
exit "$code"
