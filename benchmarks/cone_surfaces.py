#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Times maps onto tiles of free shape beside 222 maps of the same meshes, on one thread, and writes the table of docs/curved-cones.md.

A figure is sampled; real meshes are those of the acceptance test (../shared), left out if they are missing. Every case runs in turn with the 222 map
that it is compared with. Time is that of the stages factorize, initialize and optimize: all that solves for the map. Medians over the repetitions.

  cone_surfaces.py --program build/orbitutte            prints the table
  cone_surfaces.py --program build/orbitutte --write    writes it into the page, too
"""
import argparse
import json
import pathlib
import re
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / 'docs' / 'curved-cones.md'
MESHES = ROOT.parent / 'shared' / 'meshes'
REAL = ['my_man_maxp.off', 'david_50k.off', 'cortex_icbm152_lh.off', 'armadillo.obj']
STAGES = ['factorize', 'initialize', 'optimize']
TARGETS = {'plane, 4 x pi': ['cones', '--angles', 'pi,pi,pi,pi'], 'sphere, 4 x 1.6 pi': ['cones', '--angles', '1.6pi,1.6pi,1.6pi,1.6pi'],
           '2,2,2,2,2': ['2,2,2,2,2'], '2,2,2,2,2,2': ['2,2,2,2,2,2']}


def report_of(program, mesh, target):
    command = [program, 'embed', str(mesh), '--cones', 'extremities', '--threads', '1', '--json', '--quiet', '--orbifold', *target]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    if result.returncode not in (0, 4, 5):
        raise RuntimeError(f'exit code {result.returncode}: {command}')
    return json.loads(result.stdout)


def seconds(report):
    return sum(report['timings'].get(stage, 0.0) for stage in STAGES)


def row(options, name, mesh, target):
    """A line of the table: one target on one mesh."""
    plain, own = [], []
    for _ in range(options.repeat):
        plain.append(report_of(options.program, mesh, ['222']))
        own.append(report_of(options.program, mesh, TARGETS[target]))
    reference, time = (statistics.median(map(seconds, reports)) for reports in (plain, own))
    last = own[-1]
    tiles = len(last['shapes']) if last.get('shapes') else 1
    return [name, f"{last['mesh']['faces'] / 1000:.0f}K", target, f'{reference:.3f}', f'{time:.3f}', f'**{time / reference:.1f}**', str(tiles),
            f"{last['conformality']:.4f}", 'yes' if last['certificate']['bijective'] else 'NO']


def table(rows):
    head = ['mesh', 'triangles', 'target', '222, s', 'this, s', 'ratio', 'tiles', 'E/2A', 'certified']
    return '\n'.join('| ' + ' | '.join(cells) + ' |' for cells in [head, ['---'] * len(head), *rows])


def meshes(folder):
    sample = pathlib.Path(folder) / 'figure.ply'
    yield 'figure', sample
    for name in REAL:
        if (MESHES / name).exists():
            yield name.split('.')[0], MESHES / name
        else:
            print(f'left out: {name} (no {MESHES.name} folder beside the repository)', file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--program', default=str(ROOT / 'build' / 'orbitutte'))
    parser.add_argument('--repeat', type=int, default=3)
    parser.add_argument('--write', action='store_true')
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([options.program, 'sample', '--shape', 'figure', '--faces', '100000', '-o', f'{folder}/figure.ply'], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        written = table([row(options, name, mesh, target) for name, mesh in meshes(folder) for target in TARGETS])
    print(written)
    if options.write:
        begin, end = '<!-- times: written by benchmarks/cone_surfaces.py -->', '<!-- end of times -->'
        page = PAGE.read_text(encoding='utf-8')
        assert begin in page, f'{PAGE} has no place for the table'
        PAGE.write_text(re.sub(f'{begin}.*?{end}', lambda _: f'{begin}\n{written}\n{end}', page, flags=re.S), encoding='utf-8')


if __name__ == '__main__':
    main()
