#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Evidence for or against the paper's conjecture that both conditions of theorem 2 always hold.

Embeds every shared mesh into every spherical family that `orbitutte types` lists, with several choices of marked vertices, and asks
`orbitutte verify --theorem2` about each. Every run appends a JSON row to experiments/theorem2.jsonl. Runs that have a row there are not
repeated, so the experiment may be interrupted, and adding a family adds only its own rows. `orbitutte sample` makes the meshes of
projective planes.

  theorem2.py                  runs what is missing, then writes the tables of docs/theorem2.md
  theorem2.py --jobs N         runs N processes at a time (2)
  theorem2.py --minutes T      starts no run after T minutes
  theorem2.py --program FILE   the command line to run (build/orbitutte)
  theorem2.py --summary        only writes the tables
"""
import argparse
import collections
import concurrent.futures
import json
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
MESHES = ROOT.parent / 'shared' / 'meshes'
ROWS = ROOT / 'experiments' / 'theorem2.jsonl'
PAGE = ROOT / 'docs' / 'theorem2.md'

ORDERS = [2, 3, 5, 8]  # the free order N; meshes of more than LARGE faces: only the second, with the cones of cones.tsv
LARGE = 45000
SEEDS = {'sphere': [1, 2, 3], 'disk': [1, 2], 'projective-plane': [1, 2, 3]}  # of random well separated cones
SAMPLES = [('boy', 2000), ('boy', 8000), ('roman', 2000), ('roman', 8000)]  # projective planes
ALLOWED_SECONDS = 900  # for one process

Source = collections.namedtuple('Source', 'name path faces topology outer inner')  # outer and inner marks of cones.tsv
Run = collections.namedtuple('Run', 'source family signature choice')


def key(row):
    return row['mesh'], row['signature'], row['cones']


def read_rows():
    return [json.loads(line) for line in ROWS.read_text(encoding='utf-8').splitlines()] if ROWS.exists() else []


# What to run


def numbers(text):
    return [] if text == '-' else [int(v) for v in text.split(',')]


def shared_sources():
    sources = []
    for line in (MESHES / 'cones.tsv').read_text(encoding='utf-8').splitlines()[1:]:
        name, _, faces, topology, marked, interior = line.split('\t')
        sources.append(Source(name, MESHES / name, int(faces), topology, numbers(marked), numbers(interior)))
    return sources


def sampled_sources(program, folder):
    sources = []
    for shape, faces in SAMPLES:
        path = folder / f'{shape}-{faces}.off'
        subprocess.run([program, 'sample', '--shape', shape, '--faces', str(faces), '-o', path], check=True, stderr=subprocess.DEVNULL)
        sources.append(Source(f'{shape}:{faces}', path, faces, 'projective-plane', [], []))
    return sources


def signatures(family, faces):
    if 'N' not in family:
        return [family]
    return [family.replace('N', str(n)) for n in (ORDERS if faces <= LARGE else ORDERS[1:2])]


def choices(source):
    table = ['table'] if source.outer else []
    return table if source.faces > LARGE else table + ['auto'] + [f'random {seed}' for seed in SEEDS[source.topology]]


def all_runs(families, sources):
    return [Run(source, family['family'], signature, choice) for source in sorted(sources, key=lambda s: s.faces) for family in families
            if family['input'] == source.topology for signature in signatures(family['family'], source.faces) for choice in choices(source)]


# Marked vertices


def marks_of(signature):
    """How many marks lie inside the surface, and how many on its boundary. Orders are single digits here."""
    before, star, after = signature.rstrip('x').partition('*')
    return len(before), len(after) if star else 0


def read_text_mesh(path):
    """The vertices and faces of an OFF or OBJ file."""
    lines = [line.split('#')[0].split() for line in path.read_text(encoding='latin-1').splitlines()]
    lines = [words for words in lines if words]
    if path.suffix == '.obj':
        points = [tuple(map(float, words[1:4])) for words in lines if words[0] == 'v']
        return points, [[int(w.split('/')[0]) - 1 for w in words[1:]] for words in lines if words[0] == 'f']
    at = 1 if len(lines[0]) == 1 else 0
    counts = lines[at] if at else lines[0][1:]
    vertices, faces = int(counts[0]), int(counts[1])
    points = [tuple(map(float, words[:3])) for words in lines[at + 1:at + 1 + vertices]]
    return points, [list(map(int, words[1:4])) for words in lines[at + 1 + vertices:at + 1 + vertices + faces]]


def inner_and_boundary(faces):
    """The vertices inside the surface and those on its boundary, ascending."""
    seen = collections.Counter()
    for face in faces:
        for k in range(3):
            seen[tuple(sorted((face[k - 1], face[k])))] += 1
    boundary = {v for edge, count in seen.items() if count == 1 for v in edge}
    return sorted({v for face in faces for v in face} - boundary), sorted(boundary)


def well_separated(points, pools, rng):
    """Picks a random first vertex, then each time the farthest of twenty random ones; one vertex from each pool."""
    marks = []
    for pool in pools:
        candidates = rng.sample(pool, min(20, len(pool))) if marks else [rng.choice(pool)]
        candidates = [v for v in candidates if v not in marks]
        marks.append(max(candidates, key=lambda v: min((math.dist(points[v], points[m]) for m in marks), default=0)))
    return marks


class Meshes:
    """The vertices of each mesh from which random marks are chosen; each mesh is read once."""

    def __init__(self):
        self.known, self.lock = {}, threading.Lock()

    def get(self, source):
        with self.lock:
            if source.name not in self.known:
                points, faces = read_text_mesh(source.path)
                self.known[source.name] = points, *inner_and_boundary(faces)
            return self.known[source.name]


def cones(run, meshes):
    """The argument of --cones."""
    inner, outer = marks_of(run.signature)
    if run.choice == 'auto':
        return 'extremities'
    if run.choice == 'table':
        pools = (run.source.outer[:inner], []) if run.source.topology == 'sphere' else (run.source.inner[:inner], run.source.outer[:outer])
        return ','.join(map(str, pools[0] + pools[1]))
    points, inside, boundary = meshes.get(run.source)
    rng = random.Random(f'{run.source.name} {run.signature} {run.choice}')
    return ','.join(map(str, well_separated(points, [inside] * inner + [boundary] * outer, rng)))


# Running


def call(*command):
    """Exit code, standard output and seconds. The process has one thread, since several run at a time."""
    start = time.monotonic()
    environment = dict(os.environ, OPENBLAS_NUM_THREADS='1')
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=ALLOWED_SECONDS,
                          env=environment, check=False)
    return done.returncode, done.stdout, round(time.monotonic() - start, 2)


def description(report):
    return {'marks': [cone['vertex'] for cone in report['cones']], 'group_order': report['orbifold']['group_order'],
            'termination': report['termination'], 'iterations': report['iterations'], 'gradient_norm': report['gradient_norm'],
            'certified': report['certificate']['bijective'], 'nonpositive_faces': len(report['certificate']['nonpositive_faces']),
            'commit': report['environment']['commit']}


def conditions(theorem2):
    return {name: theorem2[name] for name in ('status', 'holds', 'method', 'max_edge_length', 'negative_eigenvalues', 'kernel_dimension',
                                              'kernel_residual')} | {'least_shift': min([r['shift'] for r in theorem2['representations']
                                                                                         if r['unknowns']], default=None)}


def measure(program, run, meshes, folder):
    """The row of one run; without 'theorem2' if the mesh could not be embedded as asked."""
    row = {'mesh': run.source.name, 'faces': run.source.faces, 'family': run.family, 'signature': run.signature, 'cones': run.choice}
    with tempfile.TemporaryDirectory(dir=folder) as here:
        embedding, report = pathlib.Path(here, 'map.ply'), pathlib.Path(here, 'map.json')
        marked = cones(run, meshes)
        row['exit'], _, row['embed_seconds'] = call(program, 'embed', run.source.path, '--orbifold', run.signature, '--cones', marked,
                                                    '--threads', 1, '--weights', 'cotan', '--quiet', '-o', embedding, '--report', report)
        if not report.exists():
            return row | {'marks': marked}
        row |= description(json.loads(report.read_text(encoding='utf-8')))
        _, output, row['verify_seconds'] = call(program, 'verify', embedding, report, run.source.path, '--theorem2', '--json')
        return row | {'theorem2': conditions(json.loads(output)['theorem2'])}


def run_all(runs, arguments, folder):
    meshes, lock, started = Meshes(), threading.Lock(), time.monotonic()

    def one(run):
        if arguments.minutes and time.monotonic() - started > 60 * arguments.minutes:
            return
        row = measure(arguments.program, run, meshes, folder)
        with lock, ROWS.open('a', encoding='utf-8') as rows:
            rows.write(json.dumps(row) + '\n')

    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for _ in pool.map(one, runs):
            pass


# Tables


def share(rows, condition):
    return sum(1 for row in rows if condition(row))


def edges_short(row):
    return row['theorem2']['max_edge_length'] < math.pi / 2


def verdict(row):
    theorem2 = row['theorem2']
    return theorem2['status'] if theorem2['status'] != 'measured' else 'holds' if theorem2['holds'] else 'fails'


def table(header, rows):
    return '\n'.join(['| ' + ' | '.join(header) + ' |', '|' + '---|' * len(header)] + ['| ' + ' | '.join(map(str, r)) + ' |' for r in rows])


def line_of(name, rows):
    iterations = [row['iterations'] for row in rows]
    longest = max(row['theorem2']['max_edge_length'] for row in rows)
    return [name, len(rows), share(rows, lambda r: r['certified']), share(rows, edges_short),
            share(rows, lambda r: r['theorem2']['negative_eigenvalues'] == 1), share(rows, lambda r: r['theorem2']['kernel_dimension'] == 3),
            share(rows, lambda r: r['theorem2']['holds']), share(rows, lambda r: r['theorem2']['status'] == 'inconclusive'),
            share(rows, lambda r: r['theorem2']['status'] == 'not run'), f'{longest:.3f}', f'{statistics.median(iterations):g}', max(iterations)]


COLUMNS = ['runs', 'certified', 'edges < pi/2', 'one negative', 'kernel 3', 'both hold', 'inconclusive', 'not run', 'longest edge',
           'iterations, median', 'most']


def by(name, rows):
    groups = collections.defaultdict(list)
    for row in rows:
        groups[row[name]].append(row)
    lines = [line_of(group.replace('*', '\\*'), members) for group, members in groups.items()]
    return table([name] + COLUMNS, lines + [line_of('**all**', rows)])


def exceptions(rows):
    """The runs that are not certified or fail a condition."""
    odd = [row for row in rows if not (row['certified'] and row['theorem2']['holds'])]
    lines = [[row['mesh'], row['signature'].replace('*', '\\*'), row['cones'], 'yes' if row['certified'] else f"no (exit {row['exit']})",
              row['nonpositive_faces'], f"{row['theorem2']['max_edge_length']:.4g}", row['theorem2']['negative_eigenvalues'],
              row['theorem2']['kernel_dimension'], f"{row['theorem2']['kernel_residual']:.1e}", verdict(row)] for row in odd]
    header = ['mesh', 'orbifold', 'cones', 'certified', 'nonpositive faces', 'longest edge', 'negative', 'kernel', 'residual', 'theorem 2']
    return table(header, lines) if lines else 'None.'


def cross_table(rows):
    counts = collections.Counter((row['certified'], verdict(row)) for row in rows)
    kinds = ['holds', 'fails', 'inconclusive', 'not run']
    return table(['', *(f'theorem 2: {kind}' for kind in kinds)],
                 [[name, *(counts[certified, kind] for kind in kinds)] for name, certified in (('certified', True), ('not certified', False))])


def replace_section(text, name, content):
    begin, end = f'<!-- {name}: written by experiments/theorem2.py -->', f'<!-- end of {name} -->'
    pattern = re.compile(re.escape(begin) + '.*?' + re.escape(end), re.S)
    if not pattern.search(text):
        raise SystemExit(f'{PAGE.name} has no place for "{name}"')
    return pattern.sub(lambda _: f'{begin}\n{content}\n{end}', text)


def write_summary():
    rows = read_rows()
    embedded = [row for row in rows if 'theorem2' in row]
    refused = len(rows) - len(embedded)
    total = f'{len(rows)} runs; {refused} of them could not be embedded as asked and are in no table.\n\n'
    text = PAGE.read_text(encoding='utf-8')
    for name, content in (('verdicts', total + cross_table(embedded)), ('families', by('family', embedded)), ('meshes', by('mesh', embedded)),
                          ('exceptions', exceptions(embedded))):
        text = replace_section(text, name, content)
    PAGE.write_text(text, encoding='utf-8')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--jobs', type=int, default=2)
    parser.add_argument('--minutes', type=float, default=0)
    parser.add_argument('--program', type=pathlib.Path, default=ROOT / 'build' / 'orbitutte')
    parser.add_argument('--summary', action='store_true')
    arguments = parser.parse_args()
    if not arguments.summary:
        if not MESHES.exists():
            raise SystemExit(f'the meshes are missing: {MESHES}')
        families = json.loads(subprocess.run([arguments.program, 'types', '--json'], check=True, stdout=subprocess.PIPE).stdout)
        families = [family for family in families if family['group_order'] != 'infinite']  # theorem 2 is about the sphere
        with tempfile.TemporaryDirectory() as folder:
            sources = shared_sources()
            if any(family['input'] == 'projective-plane' for family in families):
                sources += sampled_sources(arguments.program, pathlib.Path(folder))
            done = {key(row) for row in read_rows()}
            runs = [run for run in all_runs(families, sources) if (run.source.name, run.signature, run.choice) not in done]
            print(f'{len(done)} runs done, {len(runs)} to go', file=sys.stderr)
            run_all(runs, arguments, folder)
    write_summary()


if __name__ == '__main__':
    main()
