#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Makes the site: see docs/build.sh.

BUILD/site-work/ gets a copy of the pages, with the pages of the reference beside them, which are made here: of the command line from
its --help, of C++ a page for each folder of public headers, of Python one for the module.
"""
import ast
import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SITE = ROOT / "docs/site"
COMMANDS = ["embed", "choose", "info", "repair", "types", "verify", "tile", "render", "report", "export", "measure", "compare", "map", "sample"]
FOLDERS = {  # of src/orbitutte, in the order of the reference: title
    "": "The method",
    "mesh": "Meshes",
    "orbifold": "Orbifolds",
    "solve": "Solving",
    "verify": "Certificate and distortion",
    "map": "Points",
    "output": "Files, pictures and tilings",
}


class Missing(Exception):
    """Something that the site is made from is not there."""


def output_of(*command: str) -> str:
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def require_tools(build: Path) -> None:
    tools = [name for name in ("doxygen",) if not shutil.which(name)]
    for module in ("sphinx", "myst_parser", "furo", "breathe"):
        if subprocess.run([sys.executable, "-c", f"import {module}"], stderr=subprocess.DEVNULL).returncode:
            tools.append(module)
    if tools:
        raise Missing(f"{', '.join(tools)} is missing; './setup --docs' installs it")
    if not (build / "orbitutte").exists():
        raise Missing(f"{build}/orbitutte is missing; build it first, or say where it is")
    environment = {**os.environ, "PYTHONPATH": str(build / "python")}
    if subprocess.run([sys.executable, "-c", "import orbitutte"], env=environment, stderr=subprocess.DEVNULL).returncode:
        raise Missing(f"{sys.executable} cannot import the module in {build}/python; build it with -D Python_EXECUTABLE={sys.executable}")


# Pages as they are

def copy_pages(work: Path) -> None:
    for old in work.glob("*"):
        if old.is_dir() and not old.is_symlink():
            shutil.rmtree(old)
        else:
            old.unlink()
    pages = work / "docs"
    shutil.copytree(ROOT / "docs", pages, ignore=shutil.ignore_patterns("site", "*.sh"))
    for name in ("README.md", "examples", "experiments", "LICENSE"):  # what pages link to
        (work / name).symlink_to(ROOT / name)
    for page in pages.glob("*.md"):  # [weights.md](weights.md) gets the title of that page
        page.write_text(re.sub(r"\[[\w-]+\.md\]\(", "[](", page.read_text()))
    with (pages / "index.md").open("a") as index:
        index.write("\n" + (SITE / "chapters.md").read_text())
    for name, page in (("CONTRIBUTING.md", "contributing.md"), ("CHANGELOG.md", "changes.md")):
        text = (ROOT / name).read_text().replace("](docs/", "](")
        (pages / page).write_text(text)
    shutil.copy(ROOT / "docs/make_pictures.sh", pages)


# The command line

OPTION = re.compile(r"^  (-\S+|[a-z]\w*)(?: ([A-Z]+)(?:=(\S+))?)?( REQUIRED)?(?: \.\.\.)?(?: Needs: \S+)?(?:\s{2,}(.*))?$")


def option_rows(text: str) -> list[list[str]]:
    """Name, value and meaning of each option in the text of --help; further lines of a meaning are indented deeper."""
    rows = []
    for line in text.split("\n"):
        if match := OPTION.match(line):
            name, value, standard, required, meaning = match.groups()
            names = ", ".join(f"`{one}`" for one in name.split(","))
            note = "required" if required else f"`{standard}`" if standard else ""
            rows.append([names + (f" {value.lower()}" if value and name.startswith("-") else ""), note, meaning or ""])
        elif line.startswith("   ") and rows:
            rows[-1][2] = f"{rows[-1][2]} {line.strip()}".strip()
    return rows


def command_page(program: Path) -> str:
    parts = ["# Command line\n\nWhat `orbitutte COMMAND --help` says; the man page, `man orbitutte` once it is installed, has the same.\n"
             "[](../file-formats.md) describes the files.\n"]
    for command in COMMANDS:
        text = output_of(str(program), command, "--help")
        rows = option_rows(text)
        if not rows or len(rows) != sum(bool(re.match("  [-a-z]", line)) for line in text.split("\n")):
            raise Missing(f"the help of '{command}' is not as it is expected")
        parts.append(f"## {command}\n\n{text.strip().splitlines()[0]}.\n\n```text\norbitutte {usage(command, text)}\n```\n")
        parts.append("| argument | default | meaning |\n| --- | --- | --- |\n" +
                     "\n".join("| " + " | ".join(cell.replace("|", r"\|").replace("*", r"\*") for cell in row) + " |" for row in rows) + "\n")
    codes = re.search(r"## Exit codes\n(.*?)\n## ", (ROOT / "docs/choosing-cones.md").read_text(), re.DOTALL)[1]
    parts.append("## Exit codes\n" + codes)
    return "\n".join(parts)


def usage(command: str, text: str) -> str:
    line = next(line for line in text.split("\n") if line.startswith("Usage:"))
    return line.removeprefix("Usage: orbitutte ").replace("[OPTIONS]", "[OPTION ...]")


# C++

def header_intro(path: Path) -> str:
    """What the comment at a header's top says."""
    lines = path.read_text().split("\n")
    intro = []
    for line in lines[1:]:
        if not line.startswith("// "):
            break
        intro.append(line[3:])
    return " ".join(intro)


def public_headers() -> list[Path]:
    """Those that are installed: what cmake/install.cmake lists, and what they include."""
    text = (ROOT / "cmake/install.cmake").read_text()
    names = re.search(r"set\(ORBITUTTE_HEADERS ([^)]*)\)", text)[1].split() + ["render/render"]
    headers = {f"orbitutte/{name}.h": None for name in names}  # in this order
    pending = list(headers)
    while pending:
        for header in sorted(re.findall(r'#include "(orbitutte/[^"]*)"', (ROOT / "src" / pending.pop()).read_text())):
            if header not in headers:
                headers[header] = None
                pending.append(header)
    return [ROOT / "src" / header for header in headers]


def cpp_pages(headers: list[Path]) -> dict[str, str]:
    pages = {}
    for folder, title in FOLDERS.items():
        own = [path for path in headers if path.parent == (ROOT / "src/orbitutte" / folder)]
        if not own:
            continue
        text = f"{title}\n{'=' * len(title)}\n"
        for path in own:
            name = path.relative_to(ROOT / "src")
            heading = f"``{name}``"
            intro = textwrap.fill(rst_text(header_intro(path)), 110)
            text += f"\n{heading}\n{'-' * len(heading)}\n\n{intro}\n\n.. doxygenfile:: {name}\n"
        pages[f"reference/cpp-{folder or 'method'}.rst"] = text
    names = "\n".join(f"   {Path(page).stem}" for page in pages)
    pages["reference/cpp.rst"] = ("C++\n===\n\nThe public headers, folder by folder; everything is in the namespace ``orbitutte``. "
                                  ":doc:`../paper` says which part of the paper is where.\n\n"
                                  f".. toctree::\n   :maxdepth: 2\n\n{names}\n")
    return pages


def rst_text(text: str) -> str:
    return re.sub(r"`([^`]+)`", r"``\1``", text.replace("*", r"\*").replace("|", r"\|").replace("_ ", r"\_ "))


def make_xml(work: Path, headers: list[Path]) -> list[str]:
    """Runs doxygen; what it complains of."""
    doxyfile = (SITE / "Doxyfile").read_text()
    doxyfile += f"OUTPUT_DIRECTORY = {work}/doxygen\nINPUT = {' '.join(str(path.relative_to(ROOT)) for path in headers)}\n"
    (work / "doxygen").mkdir(parents=True, exist_ok=True)
    done = subprocess.run(["doxygen", "-"], input=doxyfile, text=True, cwd=ROOT, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, check=True)
    return [line for line in done.stderr.split("\n") if "warning" in line or "error" in line]


# Python

PYTHON_PAGE = """Python
======

.. module:: orbitutte

@INTRODUCTION@

Embedding a mesh
----------------

.. autofunction:: embed
.. autofunction:: embed_fitted
.. autoclass:: Solver(V, F, **options)
   :members:
   :exclude-members: __init__, __new__

Meshes
------

.. autofunction:: info
.. autofunction:: families
.. autofunction:: choose
.. autofunction:: choose_cones
.. autofunction:: fitted_cones
.. autoclass:: FittedCones
   :members:
   :exclude-members: count, index, __init__, __new__
.. autofunction:: sample_mesh
.. autofunction:: read_mesh
.. autofunction:: write_mesh
.. autofunction:: read_vertex_data
.. autofunction:: write_vertex_data
.. autoclass:: VertexData
   :members:
   :exclude-members: count, index, __init__, __new__
.. autoclass:: ValueLabel
   :members:
   :exclude-members: count, index, __init__, __new__

The result
----------

.. autoclass:: Embedding
   :members:
   :exclude-members: __init__, __new__
.. autoclass:: Cone
   :members:
   :exclude-members: count, index, __init__, __new__
.. autoclass:: Seam
   :members:
   :exclude-members: count, index, __init__, __new__
.. autoclass:: EdgeWeights
   :members:
   :exclude-members: count, index, __init__, __new__
.. autoclass:: Location
   :members:
   :exclude-members: count, index, __init__, __new__
.. autoclass:: Offsets
   :members:
   :exclude-members: count, index, __init__, __new__

Maps between two surfaces
-------------------------

.. autofunction:: map_between
.. autoclass:: SurfaceMap
   :members:
   :exclude-members: __init__, __new__
.. autoclass:: SurfacePoints
   :members:
   :exclude-members: count, index, __init__, __new__
.. autoclass:: Overlay
   :members:
   :exclude-members: count, index, __init__, __new__
.. autoclass:: Texture
   :members:
   :exclude-members: count, index, __init__, __new__
.. autoclass:: TextureLayout
   :members:
   :exclude-members: count, index, __init__, __new__
.. autofunction:: read_texture_layout

Values on regular grids
-----------------------

.. autofunction:: resample
.. autoclass:: Resampler(embedding, grid, kind=None)
   :members:
   :exclude-members: __init__, __new__
.. autoclass:: Table
   :members:
   :exclude-members: count, index, __init__, __new__

Judging and tiling
------------------

.. autofunction:: verify
.. autofunction:: distortion
.. autofunction:: distortion_floor
.. autofunction:: tile
.. autoclass:: Tiling
   :members:
   :exclude-members: count, index, __init__, __new__

The program
-----------

.. autofunction:: build
.. autofunction:: keep_freed_memory
.. autofunction:: use_huge_pages

Exceptions and warnings
-----------------------

.. autoexception:: Error
.. autoexception:: MeshError
.. autoexception:: ArgumentError
.. autoexception:: FileError
.. autoexception:: Cancelled
.. autoexception:: EmbeddingWarning
.. autoexception:: MeshWarning
"""


def public_names(package: ast.Module) -> list[str]:
    """What the package exports, but for its version and names that are deprecated."""
    exported = next(node.value for node in package.body if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__")
    return [name for name in ast.literal_eval(exported) if name not in ("__version__", "signatures")]


def python_page() -> str:
    package = ast.parse((ROOT / "python/orbitutte/__init__.py").read_text())
    docstring = ast.get_docstring(package)
    left_out = [name for name in public_names(package) if not re.search(rf"^[.][.] auto\w+:: {name}\b", PYTHON_PAGE, re.MULTILINE)]
    if left_out:
        raise Missing(f"the page of Python leaves out {', '.join(left_out)}; add them to PYTHON_PAGE")
    return PYTHON_PAGE.replace("@INTRODUCTION@", docstring.partition("\nFunctions\n")[0])


# All of it

def bring_theme_along(site: Path) -> None:
    """Debian's furo is not bundled: its style imports another package's file by a path of web servers, and its script, which pages
    load as a classic one, another by 'import'. Both become whole."""
    style, imported = site / "_static/styles/furo.css", Path("/usr/share/javascript/normalize.css/normalize.css")
    text = style.read_text()
    if "/javascript/" in text:
        shutil.copy(imported, style.parent)
        style.write_text(text.replace("/javascript/normalize.css/normalize.css", "normalize.css"))
    script, spy = site / "_static/scripts/furo.js", site / "_static/scripts/gumshoe-patched.js"
    line = 'import Gumshoe from "./gumshoe-patched.js";\n'
    if line in (text := script.read_text()):
        script.write_text(spy.read_text() + text.replace(line, ""))


LOADED = re.compile(r"""(?:src|srcset|data|poster)\s*=\s*["']?(?:https?:)?//|<link[^>]+href\s*=\s*["']?(?:https?:)?//|(?:@import\s+|url\()\s*["']?(?:https?:)?/""",
                    re.IGNORECASE)


def foreign_loads(site: Path) -> list[str]:
    """Files of the site that load something from elsewhere; links that a reader may follow are none."""
    return [f"{path.relative_to(site)}: {match[0]}" for path in sorted(site.rglob("*")) if path.suffix in (".html", ".css")
            if (match := LOADED.search(path.read_text(errors="replace")))]


def project_version() -> str:
    return re.search(r"VERSION (\d+\.\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text())[1]


def main() -> int:
    build = Path(sys.argv[1]).resolve()
    work, site = build / "site-work", build / "site"
    try:
        require_tools(build)
        work.mkdir(exist_ok=True)
        copy_pages(work)
        headers = public_headers()
        complaints = make_xml(work, headers)
        pages = {"reference/command-line.md": command_page(build / "orbitutte"), "reference/python.rst": python_page(), **cpp_pages(headers)}
    except Missing as missing:
        print(f"docs/build.sh: {missing}", file=sys.stderr)
        return 1
    (work / "docs/reference").mkdir(exist_ok=True)
    for name, text in pages.items():
        (work / "docs" / name).write_text(text)
    environment = {**os.environ, "ORBITUTTE_PYTHON_PATH": str(build / "python"), "ORBITUTTE_XML": str(work / "doxygen/xml"),
                   "ORBITUTTE_VERSION": project_version()}
    shutil.rmtree(site, ignore_errors=True)
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", "-c", str(SITE), "-d", str(work / "doctrees"),
               str(work / "docs"), str(site)]
    status = subprocess.run(command, env=environment).returncode
    if (site / "_static").exists():
        bring_theme_along(site)
    complaints += [f"loads from elsewhere: {load}" for load in foreign_loads(site)]
    for complaint in complaints:
        print(f"docs/build.sh: {complaint}", file=sys.stderr)
    if status or complaints:
        return 1
    print(site / "index.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
