#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures what a call from Python costs beyond the same computation on the command line: the median ratio of alternating runs.

usage: PYTHONPATH=build/python python3 benchmarks/python_overhead.py [--faces N] [--repeat K] [--command build/orbitutte]

Each run is a process of its own. The command line's time is the sum of its report's stages from 'validate' to 'certify', without reading
and writing. Python's is the wall-clock time of orbitutte.embed() on arrays in memory, which converts, computes and makes the report.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

STAGES = ("validate", "weights", "cut", "factorize", "initialize", "optimize", "certify")

CALL = """
import json, sys, time
import numpy, orbitutte
orbitutte.use_huge_pages()  # as the command line does
V, F = orbitutte.read_mesh(sys.argv[1])
V, F = V.copy(), F.astype(numpy.int64)  # NumPy's default integers, which have to be converted
start = time.perf_counter()
embedding = orbitutte.embed(V, F, sys.argv[2], json.loads(sys.argv[3]))
total = time.perf_counter() - start
print(json.dumps({"total": total, "inside": embedding.report["timings"]["total"], "energy": embedding.energy}))
"""


def run(*arguments):
    return json.loads(subprocess.run([str(argument) for argument in arguments], check=True, capture_output=True, text=True).stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--faces", type=int, default=100000)
    parser.add_argument("--repeat", type=int, default=9)
    parser.add_argument("--orbifold", default="432")
    parser.add_argument("--command", default=pathlib.Path(__file__).parents[1] / "build" / "orbitutte")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder) / "mesh.ply"
        subprocess.run([arguments.command, "sample", "--faces", str(arguments.faces), "-o", mesh], check=True, capture_output=True)
        first = run(arguments.command, "embed", mesh, "--orbifold", arguments.orbifold, "--cones", "extremities", "--quiet", "--json")
        cones = [cone["vertex"] for cone in first["cones"]]
        command, python, inside = [], [], []
        for _ in range(arguments.repeat):
            report = run(arguments.command, "embed", mesh, "--orbifold", arguments.orbifold, "--cones", ",".join(map(str, cones)), "--quiet",
                         "--json")
            command.append(sum(report["timings"][stage] for stage in STAGES))
            call = run(sys.executable, "-c", CALL, mesh, arguments.orbifold, json.dumps(cones))
            python.append(call["total"])
            inside.append(call["inside"])
            assert call["energy"] == report["energy"], "both must compute the same"
    row = {"faces": first["mesh"]["faces"], "repetitions": arguments.repeat, "command_line_seconds": statistics.median(command),
           "python_seconds": statistics.median(python), "ratio": statistics.median(p / c for p, c in zip(python, command)),
           "beyond_the_computation": statistics.median(p / i for p, i in zip(python, inside)) - 1}
    print(json.dumps(row, indent=1))


if __name__ == "__main__":
    main()
