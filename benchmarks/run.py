#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the benchmarks and writes their tables into docs/benchmarks.md and the plot of growth beside it.

Builds into build/benchmark, runs every case in a process of its own, and keeps all rows, as JSON, in build/benchmark/rows.jsonl.
Figures are medians over the repetitions; ratios are formed within one run. If the folder with the real meshes (../shared) is missing,
its cases are skipped, with a message. The plot needs gnuplot (./setup --benchmarks installs it).

  run.py            everything that the machine's memory allows
  run.py --quick    up to 400K triangles, printed only
"""
import argparse
import datetime
import json
import math
import os
import pathlib
import platform
import re
import shutil
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / 'build' / 'benchmark'
MESHES = ROOT.parent / 'shared' / 'meshes'
PAGE = ROOT / 'docs' / 'benchmarks.md'
PLOT = ROOT / 'docs' / 'growth.svg'
WEIGHTS = ['standard', 'cotan']  # what users get first
STAGES = ['validate', 'weights', 'cut', 'factorize', 'initialize', 'optimize', 'certify', 'mend']

# (mesh, orbifold, midpoint subdivisions, repetitions)
LADDER = [('figure:100000', '432', 0, 7), ('figure:400000', '432', 0, 5), ('figure:1600000', '432', 0, 3), ('figure:6400000', '432', 0, 3),
          ('mask:100000', '*432', 0, 7), ('mask:400000', '*432', 0, 5), ('mask:1600000', '*432', 0, 3),
          ('david_50k.off', '432', 0, 7), ('david_50k.off', '432', 1, 5), ('david_50k.off', '432', 2, 3),
          ('bunny.off', '432', 0, 7), ('bunny.off', '432', 1, 5), ('igea.ply', '432', 0, 5), ('igea.ply', '432', 1, 3),
          ('armadillo.obj', '432', 0, 7), ('armadillo.obj', '432', 1, 5), ('armadillo.obj', '432', 2, 3),
          ('cortex_icbm152_lh.off', '432', 0, 7), ('cortex_icbm152_lh.off', '432', 1, 5), ('cortex_icbm152_lh.off', '432', 2, 3),
          ('face.obj', '*432', 0, 7), ('face.obj', '*432', 2, 5)]

# Cold processes: (mesh, orbifold, midpoint subdivisions, processes).
GROWTH = [('figure:100000', '432', 0, 5), ('figure:400000', '432', 0, 5), ('figure:1600000', '432', 0, 3), ('figure:6400000', '432', 0, 2),
          ('figure:12800000', '432', 0, 1), ('figure:6400000', '432', 1, 1),
          ('mask:100000', '*432', 0, 5), ('mask:1600000', '*432', 0, 3), ('mask:12800000', '*432', 0, 1)]
BYTES_A_TRIANGLE = 850  # at most, as far as it was measured, the mesh and the program included

# The paper's Table 1 (MATLAB, one thread at 3.50 GHz): model, initialisation in seconds, iterations, optimisation in seconds; and what stands in
# for the model here: mesh, orbifold, midpoint subdivisions.
TABLE_1 = [('Moon', 0.25, 25, 0.86, 'itokawa.off', '432', 0), ('Fandisk', 0.80, 20, 2.72, 'fandisk.off', '*432', 0),
           ('David', 0.97, 21, 3.66, 'david_50k.off', '432', 0), ('Bunny', 1.65, 19, 6.12, 'bunny.off', '432', 0),
           ('Dragon', 2.04, 31, 9.09, 'figure:100000', '432', 0), ('Armadillo', 8.67, 24, 24.79, 'armadillo.obj', '432', 1),
           ('Ramesses', 14.89, 23, 33.82, 'figure:386000', '432', 0), ('Frog', 13.50, 21, 29.66, 'figure:392000', '432', 0),
           ('Lucy', 15.05, 30, 61.56, 'figure:526000', '432', 0), ('Nicola', 27.99, 22, 87.53, 'figure:1000000', '432', 0),
           ('Crab', 66.95, 24, 295.42, 'figure:2000000', '332', 0)]


def cones_of(mesh):
    """The marked vertices of a shared mesh; none for samples, which have their own."""
    if ':' in mesh:
        return None
    for line in (MESHES / 'cones.tsv').read_text(encoding='utf-8').splitlines():
        columns = line.split('\t')
        if columns[0] == mesh:
            return columns[4]
    raise KeyError(mesh)


def run(program, *arguments):
    """The rows that one process prints."""
    print('running', program, *arguments, file=sys.stderr)
    output = subprocess.run([BUILD / 'benchmarks' / program, *map(str, arguments)], check=True, stdout=subprocess.PIPE, text=True).stdout
    with (BUILD / 'rows.jsonl').open('a', encoding='utf-8') as kept:
        kept.write(output)
    return [json.loads(line) for line in output.splitlines()]


def run_embedding(mesh, *arguments):
    """The rows of one mesh; none if it is missing."""
    if ':' not in mesh and not (MESHES / mesh).exists():
        print(f'left out: {mesh} (no {MESHES.name} folder beside the repository)', file=sys.stderr)
        return []
    cones = cones_of(mesh)
    return run('embedding_benchmark', mesh if cones is None else MESHES / mesh, *arguments, *(['--cones', cones] if cones else []))


def median(rows, *keys):
    def value(row):
        for key in keys:
            row = row[key]
        return row
    return statistics.median(value(row) for row in rows)


def table(head, rows):
    lines = ['| ' + ' | '.join(head) + ' |', '|' + '---|' * len(head)]
    return '\n'.join(lines + ['| ' + ' | '.join(row) + ' |' for row in rows])


def size(faces):
    return f'{faces / 1e6:.2f}M' if faces >= 999500 else f'{faces / 1e3:.0f}K'


def seconds(value):
    return f'{value:.3f}' if value < 1 else f'{value:.2f}'


def embedding_rows(cases):
    return [(case, rows) for case in cases
            if (rows := run_embedding(case[0], '--orbifold', case[1], '--subdivide', case[2], '--repeat', case[3]))]


def of_weights(runs, weights):
    """The embeddings of a case with one kind of weights, one a run."""
    return [embedding for run in runs for embedding in run['embeddings'] if embedding['weights'] == weights]


def stage_median(embeddings, stage):
    return statistics.median(embedding['stages'].get(stage, 0.0) for embedding in embeddings)


def ladder_table(measured):
    rows = []
    for (mesh, orbifold, subdivisions, _), runs in measured:
        name = mesh.split(':')[0] if ':' in mesh else f"{mesh}{', subdivided' * bool(subdivisions)}"
        for weights in WEIGHTS:
            embeddings = of_weights(runs, weights)
            rows.append([name, size(runs[0]['faces']), orbifold, weights, *(seconds(stage_median(embeddings, stage)) for stage in STAGES),
                         seconds(median(embeddings, 'total')), seconds(median(runs, 'T0')), seconds(median(runs, 'T0_amd')),
                         f"**{median(embeddings, 'ratio'):.2f}**", f"{embeddings[0]['iterations']}/{embeddings[0]['evaluations']}",
                         f"{median(embeddings, 'peak_memory_bytes') / 2**30:.2f}",
                         'yes' if all(embedding['certified'] for embedding in embeddings) else 'NO'])
    return table(['mesh', 'triangles', 'orbifold', 'weights', *STAGES, 'total', 'T0', 'with AMD', 'total/T0', 'iterations/evaluations', 'GiB', 'certified'],
                 rows)


def table_1():
    rows = []
    for model, paper_start, paper_iterations, paper_optimisation, mesh, orbifold, subdivisions in TABLE_1:
        runs = run_embedding(mesh, '--orbifold', orbifold, '--subdivide', subdivisions, '--repeat', 3, '--weights', 'cotan')
        if not runs:
            continue
        embeddings = of_weights(runs, 'cotan')
        total, optimisation, certificate = (median(embeddings, 'total'), stage_median(embeddings, 'optimize'), stage_median(embeddings, 'certify'))
        stands_for = mesh.split(':')[0] + (', subdivided once' if subdivisions else '')
        rows.append([model, stands_for, f"{runs[0]['faces']:,}", orbifold, f'{paper_start:.2f}', str(paper_iterations), f'{paper_optimisation:.2f}',
                     seconds(total - optimisation - certificate), str(embeddings[0]['iterations']), seconds(optimisation), seconds(certificate)])
    return table(['model', 'measured on', 'triangles', 'orbifold', 'the paper: initialisation, s', 'iterations', 'optimisation, s',
                  'here: initialisation, s', 'iterations', 'optimisation, s', 'certificate, s'], rows)


def again_table(sizes):
    rows = []
    for faces in sizes:
        runs = run_embedding(f'figure:{faces}', '--orbifold', '432', '--again', '532', '--repeat', 4)[1:]
        first = median(runs, 'first', 'total')
        for name, what in [('first', '432'), ('other_orders', '532, the same cones'), ('other_cones', '432, another third cone')]:
            rows.append([size(runs[0]['faces']), what, seconds(median(runs, name, 'total')), f"{median(runs, name, 'total') / first:.2f}",
                         *(seconds(median(runs, name, 'stages', stage)) for stage in ['cut', 'factorize', 'optimize'])])
    return table(['triangles', 'embedding', 'seconds', 'of the first', 'cut', 'factorize', 'optimize'], rows)


def io_table():
    rows = [[row['file'], row['direction'], f"{row['bytes'] / 1e6:.0f}", f"{row['seconds']:.3f}", f"{row['MB_per_second']:.0f}"]
            for row in run('io_benchmark', 1600000)]
    return table(['file', 'direction', 'MB', 'seconds', 'MB/s'], rows)


def memory_available():
    """In bytes (Linux)."""
    return 1024 * int(next(line.split()[1] for line in open('/proc/meminfo', encoding='utf-8') if line.startswith('MemAvailable')))


def exponent(small, large, *keys):
    """Of growth with the number of triangles: log(ratio)/log(ratio of sizes), between two sets of rows."""
    return math.log(median(large, 'embeddings', 0, *keys) / median(small, 'embeddings', 0, *keys)) / math.log(large[0]['faces'] / small[0]['faces'])


def cold_rows(case):
    """One row from each of the processes of a case of GROWTH; none if memory is too small."""
    mesh, orbifold, subdivisions, processes = case
    if int(mesh.split(':')[1]) * 4**subdivisions * BYTES_A_TRIANGLE > memory_available():
        print(f'left out: {mesh}, subdivisions: {subdivisions} (too little memory)', file=sys.stderr)
        return []
    return [run_embedding(mesh, '--orbifold', orbifold, '--subdivide', subdivisions, '--alone', '--repeat', 1, '--weights', WEIGHTS[0])[0]
            for _ in range(processes)]


def growth_table():
    """Embeddings in processes of their own that have touched no memory before."""
    rows, lines, first = [], [], {}
    for case in GROWTH:
        if not (cold := cold_rows(case)):
            continue
        kind = case[0].split(':')[0]
        memory = median(cold, 'embeddings', 0, 'peak_memory_bytes')
        rows.append([kind + ', subdivided' * case[2], size(cold[0]['faces']), seconds(median(cold, 'embeddings', 0, 'total')), f'{memory / 2**30:.2f}',
                     f"{memory / 1024 / cold[0]['faces']:.2f}", 'yes' if all(row['embeddings'][0]['certified'] for row in cold) else 'NO'])
        small = first.setdefault(kind, cold)
        if cold[0]['faces'] >= 10 * small[0]['faces']:
            lines.append(f"- {kind}: from {size(small[0]['faces'])} to {size(cold[0]['faces'])} triangles time grows as n^{exponent(small, cold, 'total'):.2f}, "
                         f"memory as n^{exponent(small, cold, 'peak_memory_bytes'):.2f}")
    return table(['mesh', 'triangles', 'seconds', 'GiB', 'KB a triangle', 'certified'], rows) + '\n\n' + '\n'.join(lines)


def plot(measured):
    if not shutil.which('gnuplot'):
        print('no plot: gnuplot is missing (./setup --benchmarks installs it)', file=sys.stderr)
        return
    blocks, plots = [], []
    for kind, orbifold in [('figure', '432'), ('mask', '*432')]:
        runs = [rows for (mesh, *_), rows in measured if mesh.startswith(kind + ':')]
        for seconds_of, label in [(lambda rows: median(of_weights(rows, WEIGHTS[0]), 'total'), f'embedding, {orbifold}'),
                                  (lambda rows: median(rows, 'T0'), f'T0 of the same mesh ({kind})')]:
            index = len(blocks)
            blocks.append('\n'.join(f"{rows[0]['faces']} {seconds_of(rows)}" for rows in runs))
            plots.append(f'$data index {index} with linespoints title "{label}"')
    data = '$data << EOD\n' + '\n\n\n'.join(blocks) + '\nEOD\n'
    script = data + f'''set terminal svg size 720,480 background rgb "white"
set output "{PLOT}"
set logscale xy
set grid
set key left top
set xlabel "triangles"
set ylabel "seconds"
set format x "10^{{%T}}"
plot {", ".join(plots)}
'''
    subprocess.run(['gnuplot'], input=script, text=True, check=True)


def machine():
    cpu = next((line.split(':')[1].strip() for line in open('/proc/cpuinfo', encoding='utf-8') if line.startswith('model name')), '')
    commit = subprocess.run(['git', '-C', ROOT, 'describe', '--always', '--dirty'], stdout=subprocess.PIPE, text=True, check=False).stdout
    return f"{datetime.date.today().isoformat()}, commit {commit.strip()}: {os.cpu_count()} cores of {cpu or platform.machine()}, shared with others"


def replace_section(text, name, content):
    begin, end = f'<!-- {name}: written by benchmarks/run.py -->', f'<!-- end of {name} -->'
    pattern = re.compile(re.escape(begin) + '.*?' + re.escape(end), re.S)
    assert pattern.search(text), f'{PAGE} has no section {name}'
    return pattern.sub(lambda _: f'{begin}\n{content}\n{end}', text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--quick', action='store_true')
    quick = parser.parse_args().quick
    subprocess.run(['cmake', '--preset', 'benchmark'], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(['cmake', '--build', '--preset', 'benchmark', '--parallel', str(os.cpu_count())], cwd=ROOT, check=True,
                   stdout=subprocess.DEVNULL)
    (BUILD / 'rows.jsonl').write_text('', encoding='utf-8')
    if quick:
        measured = embedding_rows([case for case in LADDER if ':' in case[0] and int(case[0].split(':')[1]) <= 400000])
        print(ladder_table(measured))
        return
    measured = embedding_rows(LADDER)
    sections = {'machine': machine(), 'ladder': ladder_table(measured), 'growth': growth_table(), 'table 1': table_1(),
                'again': again_table([100000, 1600000]), 'files': io_table()}
    plot(measured)
    page = PAGE.read_text(encoding='utf-8')
    for name, content in sections.items():
        page = replace_section(page, name, content)
    PAGE.write_text(page, encoding='utf-8')


if __name__ == '__main__':
    main()
