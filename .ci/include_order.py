#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The order of the library's layers, as CONTRIBUTING.md has it: each file includes only what comes before it. Prints the lines that break it."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = ROOT / "src/orbitutte"
PLAIN = "plain values"  # files at the root of src/orbitutte that every layer may know
LAYERS = [PLAIN, "geometry", "mesh", "io", "inspect", "samples", "weights", "cut", "orbifold", "linear", "solve", "verify", "cones", "quotient", "map",
          "resample", "embed", "report", "export", "page", "render"]
ROOT_FILES = {"names": PLAIN, "types": PLAIN, "errors": PLAIN, "progress": PLAIN, "parallel": PLAIN, "memory": PLAIN, "options": PLAIN, "minimum": PLAIN,
              "version": PLAIN, "embed_types": "embed", "embed": "embed", "certified_map": "embed", "choose": "embed", "distortion_floor": "embed", "preparation": "embed", "warnings": "embed"}
COMPOSING = {"map/surface_map", "map/composed_map"}  # the part of `map` that composes, as `embed` does
# The certificate shares no code with what it judges; only `embed` and `map` compose.
NEVER = {("verify", layer) for layer in ("weights", "cut", "linear", "solve", "cones")} | {("map", "solve"), ("map", "linear")}
SMALL = "orbitutte/embed_types.h"  # what programs include to name options and results
NOT_IN_SMALL = ("solve", "linear", "cut")


def layer_of(path):
    """`path` is relative to src/orbitutte."""
    parts = pathlib.PurePosixPath(path).parts
    if len(parts) > 1:
        return "embed" if path.split(".")[0] in COMPOSING else parts[0]
    stem = parts[0].split(".")[0]
    return ROOT_FILES.get(stem, f"unknown root file {stem}")


def tracked(*patterns):
    return subprocess.run(["git", "ls-files", *patterns], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()


def includes(path):
    for number, line in enumerate((ROOT / path).read_text(encoding="utf-8").splitlines(), 1):
        if found := re.match(r'#include *[<"]orbitutte/([^">]+)[">]', line):
            yield number, found[1]


def closure(headers):
    known, waiting = set(), list(headers)
    while waiting:
        header = waiting.pop()
        if header in known or header == "version.h":
            continue
        known.add(header)
        waiting += [included for _, included in includes(f"src/orbitutte/{header}")]
    return known


def listed_headers():
    """Those that cmake/install.cmake names; what they include is installed, too."""
    text = (ROOT / "cmake/install.cmake").read_text(encoding="utf-8")
    names = re.search(r"set\(ORBITUTTE_HEADERS ([^)]*)\)", text)[1].split() + ["render/map_sheet", "render/render"]
    return {name + ".h" for name in names}


def headers_of_programs():
    """What programs, bindings, examples and documents include."""
    files = tracked("apps/*", "python/*", "examples/*", "docs/*.md", "tests/consumer/*", "README.md")
    return {included for path in files if path.endswith((".h", ".cpp", ".md")) for _, included in includes(path)}


def other_includes(header):
    """The headers of libraries: their names have a folder or an ending."""
    return re.findall(r"#include *<([^>]*[/.][^>]*)>", (SOURCE / header).read_text(encoding="utf-8"))


def complaints():
    for path in tracked("src/orbitutte/*.h", "src/orbitutte/*.cpp"):
        layer = layer_of(path.removeprefix("src/orbitutte/"))
        if layer not in LAYERS:
            yield f"{path}: {layer} is no layer of {sys.argv[0]}"
            continue
        for number, included in includes(path):
            other = layer_of(included)
            if other not in LAYERS or LAYERS.index(other) > LAYERS.index(layer) or (layer, other) in NEVER:
                yield f"{path}:{number}: {layer} must not include {included}"
    listed = listed_headers()
    installed = closure(listed)
    for header in sorted(listed - headers_of_programs()):
        yield f"cmake/install.cmake: no program, binding, example or document includes {header}"
    for path in tracked("apps/*.h", "apps/*.cpp"):
        for number, included in includes(path):
            if included not in installed and included != "version.h":
                yield f"{path}:{number}: programs include installed headers only, not {included}"
    for header in sorted(installed):
        if "private to" in (SOURCE / header).read_text(encoding="utf-8").lower():
            yield f"src/orbitutte/{header}: is installed, and says that it is private"
        for included in other_includes(header):
            if not included.startswith("Eigen/"):
                yield f"src/orbitutte/{header}: is installed, and asks programs for {included}"
    if (ROOT / "src" / SMALL).exists():
        for header in sorted(closure([SMALL.removeprefix("orbitutte/")])):
            if layer_of(header) in NOT_IN_SMALL:
                yield f"src/{SMALL}: brings in {header}"


found = list(complaints())
print("\n".join(found))
sys.exit(1 if found else 0)
