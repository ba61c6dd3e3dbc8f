#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Small inputs through the command line: what tests/cases/cases.tsv says of each, and that standard output is ours alone.

  table   every line of cases.tsv (tests/cases/README.md tells its columns)
  tiny    meshes of 1 to 12 faces into one orbifold of each family that fits: standard output is one JSON document or nothing

Needs the standard library alone. A case that fails shows the commands to repeat it.
"""
import argparse
import concurrent.futures
import itertools
import json
import math
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

CASES = pathlib.Path(__file__).resolve().parent / "cases"
HUBS = [3200, 5000]
FAMILIES = {"sphere": ["532", "224", "22", "55"], "disk": ["*532", "*223", "*22", "*44", "3*2", "2*3", "4*"], "projective-plane": ["1x", "3x"]}
# Where the vertices that are marked are no choice of the mesh's, such meshes need not be embeddable: any of the codes will do.
JSON_BEHIND = {0, 4, 5}
OTHERWISE = {3}


def run(program, arguments, folder):
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=300, check=False)


def value_at(document, path):
    for key in path.split("."):
        document = document[int(key) if isinstance(document, list) else key]
    return document


def holds(found, expected):
    if isinstance(expected, float) and isinstance(found, (int, float)):
        return math.isclose(found, expected, rel_tol=1e-12)
    return found == expected


def faults_of_json(text, claims):
    try:
        document = json.loads(text)
    except ValueError as error:
        return [f"standard output is no JSON document: {error}"]
    faults = []
    for claim in claims.split("; "):
        path, expected = claim.split("=", 1)
        try:
            found = value_at(document, path)
        except (KeyError, IndexError):
            faults.append(f"{path} is missing")
            continue
        if not holds(found, json.loads(expected)):
            faults.append(f"{path} is {json.dumps(found)[:200]}, not {expected}")
    return faults


def faults_of_case(program, line):
    """The sentences that say what differs from the table; the folder is a fresh copy of the cases."""
    commands, code, says, silent, claims = line.split("\t")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file in CASES.iterdir():
            shutil.copy(file, folder)
        for corners in HUBS:
            if f"hub_{corners}" in commands:
                subprocess.run([sys.executable, CASES / "hub.py", str(corners), folder / f"hub_{corners}.obj"], check=True)
        *before, last = [shlex.split(command) for command in commands.split("; ")]
        for command in before:
            done = run(program, command, folder)
            if done.returncode != 0:
                return [f"'{shlex.join(command)}' ends with {done.returncode}: {done.stderr.strip()}"]
        done = run(program, last, folder)
    faults = []
    if done.returncode != int(code):
        faults.append(f"exit code {done.returncode}, not {code}: {done.stderr.strip()[:500]}")
    output = done.stdout + done.stderr
    if says != "-" and not re.search(says, output):
        faults.append(f"does not say '{says}': {output.strip()[:500]}")
    if silent != "-" and re.search(silent, output):
        faults.append(f"says '{silent}': {output.strip()[:500]}")
    return faults + (faults_of_json(done.stdout, claims) if claims != "-" else [])


def circle(n, height=0.0):
    return [(math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n), height) for k in range(n)]


def tiny_meshes():
    """(name, topology, vertices, faces from 0)"""
    yield "triangle", "disk", circle(3), [(0, 1, 2)]
    yield "quadrilateral", "disk", circle(4), [(0, 1, 2, 3)]
    for n in range(2, 13):
        strip = [(k // 2, k % 2, 0.1 * (k % 3)) for k in range(n + 2)]
        yield f"strip_{n}", "disk", strip, [(k, k + 1, k + 2) if k % 2 == 0 else (k + 1, k, k + 2) for k in range(n)]
    for n in range(3, 13):
        yield f"wheel_{n}", "disk", [*circle(n), (0, 0, 0.3)], [(k, (k + 1) % n, n) for k in range(n)]
    for n in range(4, 8):
        yield f"fan_{n}", "disk", circle(n), [(0, k, k + 1) for k in range(1, n - 1)]
    yield "tetrahedron", "sphere", [(0, 0, 1), *circle(3, -0.3)], [(0, 1, 2), (0, 2, 3), (0, 3, 1), (3, 2, 1)]
    for n in range(3, 7):
        sides = [face for k in range(n) for face in ((k, (k + 1) % n, n), ((k + 1) % n, k, n + 1))]
        yield f"double_pyramid_{n}", "sphere", [*circle(n), (0, 0, 1), (0, 0, -1)], sides
    for n in range(3, 7):
        prism = [*circle(n, -1), *circle(n, 1)]
        walls = [(k, (k + 1) % n, (k + 1) % n + n, k + n) for k in range(n)]
        yield f"prism_{n}", "sphere", prism, [*walls, tuple(range(n, 2 * n)), tuple(reversed(range(n)))]
    yield "pillow", "sphere", circle(3), [(0, 1, 2), (2, 1, 0)]
    six = [(1, 2, 3), (1, 3, 4), (1, 4, 5), (1, 5, 6), (1, 6, 2), (2, 3, 5), (3, 4, 6), (4, 5, 2), (5, 6, 3), (6, 2, 4)]
    places = [(0.2, 0.1, 1.0), *circle(5)]
    yield "projective_plane_6", "projective-plane", places, [tuple(v - 1 for v in face) for face in six]


def obj_text(vertices, faces):
    lines = ["v {} {} {}".format(*vertex) for vertex in vertices] + ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    return "\n".join(lines) + "\n"


def faults_of_output(done, codes_with_json):
    codes = sorted(codes_with_json | OTHERWISE)
    if done.returncode not in codes:
        return [f"exit code {done.returncode}, none of {codes}: {done.stderr.strip()[:500]}"]
    if done.returncode not in codes_with_json:
        return [f"standard output should be empty: {done.stdout[:300]}"] if done.stdout else []
    try:
        json.loads(done.stdout)
    except ValueError as error:
        return [f"standard output is no JSON document ({error}): {done.stdout[:300]}"]
    return []


def faults_of_tiny_mesh(program, mesh):
    name, topology, vertices, faces = mesh
    found = []
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "m.obj").write_text(obj_text(vertices, faces), encoding="ascii")
        tasks = [(["info", "m.obj", "--json"], {0, 3})]
        tasks += [(["embed", "m.obj", "--orbifold", signature, "--cones", "extremities", "--json"], JSON_BEHIND) for signature in FAMILIES[topology]]
        for arguments, codes in tasks:
            found += [f"{name}: {shlex.join(arguments)}: {fault}" for fault in faults_of_output(run(program, arguments, folder), codes)]
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="the command orbitutte")
    parser.add_argument("--filter", default="", help="only lines of the table with this text; 'tiny' for the tiny meshes")
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.program).resolve())
    lines = [line for line in (CASES / "cases.tsv").read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    lines = [line for line in lines if arguments.filter in line]
    meshes = list(tiny_meshes()) if arguments.filter in "tiny" else []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        of_table = [[f"{line.split(chr(9))[0]}: {fault}" for fault in faults]
                    for line, faults in zip(lines, pool.map(lambda line: faults_of_case(program, line), lines))]
        of_tiny = list(pool.map(lambda mesh: faults_of_tiny_mesh(program, mesh), meshes))
    faults = list(itertools.chain(*of_table, *of_tiny))
    for fault in faults:
        print("FAILED", fault)
    print(f"{len(lines)} cases of the table, {len(meshes)} tiny meshes, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
