#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares two builds of the program on thin triangles: what conformality the one gains over the other, and what time it takes.

Both embed each mesh in turn, old new old new ..., so that a machine that becomes slower does so for both. Three figures at the end:
  - over the meshes on which the old program kept faces, and so computed the whole map more than once: the geometric mean of
    (mean angle distortion - 1) of the new over that of the old
  - over the same meshes, the median ratio of whole times, new over old
  - over all meshes, the median of the time that the new program spends in stages that the old report does not have, over that in the
    other stages: the share by which repairs prolong a plain embedding

  thin_triangles.py --old OLD/orbitutte --new NEW/orbitutte                   meshes beside the repository (../shared), and generated ones
  thin_triangles.py --old OLD --new NEW --repeat 5 a.off b.obj:*432 c.ply:532:1,2,3   these; into 432 with cones 'extremities' if it does not say

Times are those of the report, without reading and writing. A line of JSON per mesh goes to --json. Needs numpy for generated meshes.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MESHES = ROOT.parent / 'shared' / 'meshes'
SPHERES, DISKS = ['432', '22'], ['*432']
GENERATED = ['flat_faces/432,*', 'flat_disk_faces/*', 'slivers/432,*', 'spiky_ball/432,*', 'rough_ball/432,*']
# Of the report's timings, those that are no stage of the method.
NO_STAGES = {'read', 'write', 'total'}


def shared_meshes():
    """(mesh, orbifold, cones) of the meshes beside the repository; nothing if they are missing."""
    table = MESHES / 'cones.tsv'
    if not table.is_file():
        print(f'left out: real meshes (no {MESHES.name} folder beside the repository)', file=sys.stderr)
        return
    for line in table.read_text(encoding='utf-8').splitlines()[1:]:
        mesh, _, _, topology, marked, _ = line.split('\t')
        for orbifold in SPHERES if topology == 'sphere' else DISKS:
            yield MESHES / mesh, orbifold, ','.join(marked.split(',')[:len(orbifold.strip('*'))])


def generated_meshes(folder):
    """(mesh, orbifold, cones) of the thin kinds of the hard set, written into the folder."""
    sys.path.insert(0, str(ROOT / 'tests'))
    import hard_meshes  # numpy is needed here only
    import hard_set
    meshes = hard_meshes.generated()
    return hard_set.write_meshes(folder, {name: mesh for pattern in GENERATED for name, mesh in hard_set.matching(meshes, pattern).items()})


def named_mesh(text):
    mesh, orbifold, cones = (text.split(':') + ['', ''])[:3]
    return mesh, orbifold or '432', cones or 'extremities'


def embed(program, case, threads):
    """The report, whatever it certifies; None if there is none."""
    mesh, orbifold, cones = case
    command = [program, 'embed', mesh, '--orbifold', orbifold, '--cones', cones, '--threads', threads, '--json', '--quiet']
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    return json.loads(done.stdout) if done.returncode in (0, 4, 5) else None


def seconds(report):
    timings = report['timings']
    return timings['total'] - timings['read'] - timings['write']


def stages(report):
    return {name: time for name, time in report['timings'].items() if name not in NO_STAGES}


def extra_share(old, new):
    """The time in stages that the old report does not have, over the time in the others."""
    known = stages(old)
    plain = sum(time for name, time in stages(new).items() if name in known)
    return sum(time for name, time in stages(new).items() if name not in known) / plain


def excess(report):
    """The mean angle distortion above 1, which would be none."""
    return report['distortion']['angle']['mean'] - 1


def compare(options, case):
    """The row of one mesh; None if one of the programs makes no map."""
    pairs = [(embed(options.old, case, options.threads), embed(options.new, case, options.threads)) for _ in range(options.repeat)]
    if any(report is None for pair in pairs for report in pair):
        return None
    old, new = pairs[0]
    return {'mesh': pathlib.Path(case[0]).name, 'orbifold': case[1], 'faces': new['mesh']['faces'],
            'kept_faces': len(old['weights'].get('kept_faces') or []), 'moved_vertices': len(new.get('moved_vertices') or []),
            'certified': [report['certificate']['bijective'] for report in (old, new)],
            'excess': [excess(report) for report in (old, new)],
            'seconds': [statistics.median(seconds(pair[k]) for pair in pairs) for k in (0, 1)],
            'time_ratio': statistics.median(seconds(b) / seconds(a) for a, b in pairs),
            'extra': statistics.median(extra_share(*pair) for pair in pairs)}


def print_row(row):
    certified = '/'.join('yes' if there else 'no' for there in row['certified'])
    print(f"{row['mesh']} {row['orbifold']}: {row['faces']} faces, kept {row['kept_faces']}, moved {row['moved_vertices']}, certified "
          f"{certified}, angle - 1 {row['excess'][0]:.4g} -> {row['excess'][1]:.4g}, {row['seconds'][0]:.3f} s -> "
          f"{row['seconds'][1]:.3f} s (ratio {row['time_ratio']:.2f}), extra {100 * row['extra']:.1f} %", flush=True)


def geometric_mean(ratios):
    return math.exp(statistics.fmean(math.log(ratio) for ratio in ratios))


def print_figures(rows):
    thin = [row for row in rows if row['kept_faces']]
    measured = [row['excess'][1] / row['excess'][0] for row in thin if min(row['excess']) > 0]
    print(f'{len(rows)} meshes, {len(thin)} with kept faces in the old program')
    for name, k in [('old', 0), ('new', 1)]:
        print(f"certified by the {name} program: {sum(row['certified'][k] for row in rows)}")
    if measured:
        print(f'(mean angle - 1), new over old, geometric mean over {len(measured)}: {geometric_mean(measured):.3f}')
        print(f"time where faces were kept, new over old, median: {statistics.median(row['time_ratio'] for row in thin):.3f}")
    if rows:
        print(f"extra time over a plain embedding, median: {100 * statistics.median(row['extra'] for row in rows):.1f} %")
    if thin:
        print(f"the same where faces were kept: {100 * statistics.median(row['extra'] for row in thin):.1f} %")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--old', required=True, metavar='PROGRAM')
    parser.add_argument('--new', required=True, metavar='PROGRAM')
    parser.add_argument('--repeat', type=int, default=3, metavar='N', help='pairs per mesh')
    parser.add_argument('--threads', type=int, default=1, metavar='N')
    parser.add_argument('--json', metavar='FILE')
    parser.add_argument('meshes', nargs='*', metavar='MESH[:ORBIFOLD[:CONES]]')
    return parser.parse_args()


def main():
    options = parse_arguments()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        cases = [named_mesh(text) for text in options.meshes] or [*shared_meshes(), *generated_meshes(folder)]
        for case in cases:
            row = compare(options, case)
            if row is None:
                print(f'{case[0]} {case[1]}: one of the programs makes no map', flush=True)
                continue
            rows.append(row)
            print_row(row)
    if options.json:
        pathlib.Path(options.json).write_text(''.join(json.dumps(row) + '\n' for row in rows), encoding='utf-8')
    print_figures(rows)


if __name__ == '__main__':
    main()
