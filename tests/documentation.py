#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs the code blocks of the documents, and checks what else in them can be checked.

usage: documentation.py write-cpp OUT.cpp                                   the C++ blocks of all pages as one program
       documentation.py run [--program P] [--python-path P] [--blocks P]    every block, page by page
       documentation.py self-test [--compiler C]                            planted faults must be found

A block is fenced (sh, python, cpp, text, cmake, toctree), or indented, which is shell. The blocks of a page run in their order in one
folder: shell first, then Python in one process, then C++ in one function, so that later blocks see what earlier ones made. The
folder's `build` is the one with the program, which is also on PATH.

An HTML comment right before a block says why it is not run: <!-- not run: installs packages -->. <!-- not run below: ... --> does so for
all that follows on the page. <!-- run first: orbitutte sample ... --> holds shell commands that a page takes for granted.
"""
import argparse
import collections
import contextlib
import io
import os
import re
import subprocess
import sys
import tempfile
import textwrap
import time
from pathlib import Path
from typing import NamedTuple, Optional

ROOT = Path(__file__).resolve().parent.parent
RUN = {"sh", "python", "cpp"}
SILENT = {"text", "{toctree}"}  # no code
TIME_LIMIT = 300  # seconds, of one page in one language


class Block(NamedTuple):
    page: str
    line: int  # of its first line of code, from 1
    language: str
    text: str
    reason: Optional[str]  # why it is not run

    @property
    def place(self) -> str:
        return f"{self.page}:{self.line}"


class Fault(Exception):
    """Something in the documents is not as it should be."""


def pages(root: Path = ROOT) -> list[Path]:
    return [root / "README.md", root / "CONTRIBUTING.md", *sorted((root / "docs").glob("*.md"))]


def comment_at(lines: list[str], k: int) -> tuple[str, int]:
    """The HTML comment that begins in line k, and the line after it."""
    end = k
    while "-->" not in lines[end]:
        end += 1
        if end == len(lines):
            raise Fault(f"line {k + 1}: the comment does not end")
    text = "\n".join(lines[k:end + 1])
    return text[text.index("<!--") + 4:text.index("-->")].strip(), end + 1


def fenced_at(lines: list[str], k: int) -> tuple[str, str, int]:
    """Language and text of the fenced block that begins in line k, and the line after it."""
    fence = re.match(r"`{3,}", lines[k])[0]
    end = k + 1
    while end < len(lines) and lines[end].strip() != fence:
        end += 1
    if end == len(lines):
        raise Fault(f"line {k + 1}: the block does not end")
    return lines[k][len(fence):].strip(), "\n".join(lines[k + 1:end]), end + 1


def indented_at(lines: list[str], k: int) -> tuple[str, int]:
    """The indented block that begins in line k, and the line after it."""
    end = k
    while end < len(lines) and (lines[end].startswith("    ") or not lines[end].strip()):
        end += 1
    return textwrap.dedent("\n".join(lines[k:end])).rstrip(), end


def blocks_of(page: str, text: str) -> list[Block]:
    lines = text.split("\n")
    blocks, reason, below, after_blank, k = [], None, None, True, 0
    try:
        while k < len(lines):
            line = lines[k]
            if line.startswith("<!--"):
                comment, k = comment_at(lines, k)
                word, _, rest = comment.partition(":")
                if word in ("not run", "not run below"):
                    said = " ".join(rest.split())
                    if not said:
                        raise Fault(f"line {k}: 'not run' without a reason")
                    reason, below = (said, below) if word == "not run" else (None, said)
                elif word == "run first":
                    blocks.append(Block(page, k, "sh", textwrap.dedent(rest).strip(), None))
                after_blank = True
                continue
            if line.startswith("```"):
                language, block, end = fenced_at(lines, k)
                blocks.append(Block(page, k + 2, language, block, reason or below))
                reason, k, after_blank = None, end, False
                continue
            if after_blank and line.startswith("    ") and line.strip():
                block, end = indented_at(lines, k)
                blocks.append(Block(page, k + 1, "sh", block, reason or below))
                reason, k, after_blank = None, end, True
                continue
            if line.strip() and reason:
                raise Fault(f"line {k + 1}: 'not run' does not stand before a block")
            after_blank = not line.strip()
            k += 1
    except Fault as fault:
        raise Fault(f"{page}: {fault}") from None
    for block in blocks:
        if block.language not in RUN | SILENT and not block.reason:
            raise Fault(f"{block.place}: a block in '{block.language}' can neither be run nor says why not")
    return blocks


def all_blocks(root: Path = ROOT) -> dict[str, list[Block]]:
    return {str(page.relative_to(root)): blocks_of(str(page.relative_to(root)), page.read_text()) for page in pages(root)}


def runnable(blocks: list[Block], language: str) -> list[Block]:
    return [block for block in blocks if block.language == language and not block.reason]


# C++: a function for every page, and a main that calls the one it is told.

def function_name(page: str) -> str:
    return "page_" + re.sub(r"\W", "_", page)


def cpp_program(documents: dict[str, list[Block]]) -> str:
    includes, functions, calls = set(), [], []
    for page, blocks in documents.items():
        parts = []
        for block in runnable(blocks, "cpp"):
            lines = block.text.split("\n")
            includes.update(line for line in lines if line.startswith("#include"))
            body = "\n".join("" if line.startswith("#include") else line for line in lines)
            parts.append(f'#line {block.line} "{block.page}"\n{body}')
        if parts:
            functions.append(f"void {function_name(page)}() {{\n" + "\n".join(parts) + "\n}\n")
            calls.append(f'  if (page == "{page}") return {function_name(page)}(), 0;\n')
    head = "// SPDX-License-Identifier: MIT\n// Written by tests/documentation.py from the C++ blocks of the documents.\n#include <string>\n"
    return (head + "\n".join(sorted(includes)) + "\n\n" + "\n".join(functions) +
            "\nint main(int, char** argv) {\n  const std::string page = argv[1];\n" + "".join(calls) + "  return 2;\n}\n")


def write_if_changed(path: Path, text: str) -> None:
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


# Running

def bash_script(blocks: list[Block]) -> str:
    return "set -Eeuo pipefail\n" + "".join(f"trap 'echo \"{b.place}: a command of this block failed\" >&2' ERR\n{b.text}\n" for b in blocks)


def python_script(blocks: list[Block]) -> str:
    """Each block compiled under the name and line where it stands, all in one namespace."""
    script = ["namespace = {'__name__': '__main__'}"]
    for block in blocks:
        padded = "\n" * (block.line - 1) + block.text
        script.append(f"exec(compile({padded!r}, {block.page!r}, 'exec'), namespace)")
    return "\n".join(script) + "\n"


def execute(command: list[str], folder: Path, environment: dict[str, str]) -> None:
    done = subprocess.run(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace", timeout=TIME_LIMIT)
    if done.returncode != 0:
        raise Fault(done.stdout + f"exit code {done.returncode}")


class Runner(NamedTuple):
    program: Path
    python_path: Optional[Path]  # None: there is no module, Python blocks are not run
    blocks: Optional[Path]  # None: the C++ blocks are not run

    def run_page(self, page: str, blocks: list[Block]) -> None:
        with tempfile.TemporaryDirectory(prefix="orbitutte-documents-") as name:
            folder = Path(name)
            (folder / "build").symlink_to(self.program.parent)
            environment = {**os.environ, "PATH": f"{self.program.parent}{os.pathsep}{os.environ['PATH']}"}
            if shell := runnable(blocks, "sh"):
                execute(["bash", "-c", bash_script(shell)], folder, environment)
            python = runnable(blocks, "python")
            if python and self.python_path:
                environment["PYTHONPATH"] = str(self.python_path)
                execute([sys.executable, "-W", "error", "-c", python_script(python)], folder, environment)
            if runnable(blocks, "cpp") and self.blocks:
                execute([str(self.blocks), page], folder, environment)


def run(runner: Runner, root: Path = ROOT) -> list[str]:
    """Runs all pages; the faults."""
    faults = check_map(root)
    documents, ran, left_out = all_blocks(root), 0, collections.Counter()
    for page, blocks in documents.items():
        start = time.monotonic()
        try:
            runner.run_page(page, blocks)
        except Fault as fault:
            faults.append(f"{page}: {fault}")
        except subprocess.TimeoutExpired:
            faults.append(f"{page}: takes longer than {TIME_LIMIT} s")
        here = [block for block in blocks if block.language in RUN and not block.reason]
        if runner.python_path is None:
            left_out.update(f"{page}: no Python module was built" for b in here if b.language == "python")
            here = [b for b in here if b.language != "python"]
        ran += len(here)
        if runner.blocks is None:
            left_out.update(f"{page}: its C++ blocks were not built" for b in here if b.language == "cpp")
            here = [b for b in here if b.language != "cpp"]
        left_out.update(f"{page}: {block.reason}" for block in blocks if block.reason and block.language not in SILENT)
        if here:
            print(f"{page}: {len(here)} blocks, {time.monotonic() - start:.1f} s", flush=True)
    print(f"{ran} blocks run, {sum(left_out.values())} not run:")
    for line, count in left_out.items():
        print(f"  {line}" + (f" ({count} blocks)" if count > 1 else ""))
    return faults


# The map from the paper to the code (docs/paper.md)

CITATION = re.compile(r"\bequations? \(|\bappendix [AB]\b|\balgorithm 1\b|\btheorem [12]\b|\bsection [46](\.\d)?\b", re.IGNORECASE)
OTHER_SECTIONS = {"src/orbitutte/io/off.cpp"}  # cites the manual of a file format


def check_map(root: Path = ROOT) -> list[str]:
    """Every row of docs/paper.md names files that exist and functions or types that are in them; every header that cites the paper is named."""
    page = root / "docs/paper.md"
    if not page.exists():
        return [f"{page.name} is missing"]
    faults, named = [], set()
    for number, line in enumerate(page.read_text().split("\n"), 1):
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|") or len(cells) != 3 or not re.search(r"\.(h|cpp)`", cells[2]):
            continue
        files = re.findall(r"`([\w/]+\.(?:h|cpp))`", cells[2])
        found = {name: root / "src/orbitutte" / name for name in files}
        named.update(files)
        faults += [f"docs/paper.md:{number}: there is no src/orbitutte/{name}" for name, path in found.items() if not path.exists()]
        code = "\n".join(path.read_text() for path in found.values() if path.exists())
        for name in re.findall(r"`(\w+)`", cells[1]):
            if not re.search(rf"\b{name}\b", code):
                faults.append(f"docs/paper.md:{number}: `{name}` is not in {', '.join(files)}")
    if not named:
        faults.append("docs/paper.md: no row names a file")
    for path in sorted((root / "src/orbitutte").rglob("*.h")):
        if CITATION.search(path.read_text()) and str(path.relative_to(root / "src/orbitutte")) not in named:
            faults.append(f"{path.relative_to(root)} cites the paper and is not in docs/paper.md")
    return faults


# Planted faults

def planted(root: Path, name: str, text: str) -> None:
    (root / "docs").mkdir(parents=True, exist_ok=True)
    (root / name).write_text(text)


def outcome(runner: Runner, text: str) -> str:
    """What is found in a set of documents whose README has this text."""
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        (root / "src/orbitutte").mkdir(parents=True)
        (root / "src/orbitutte/a.h").write_text("// theorem 1\nint f();\n")
        planted(root, "CONTRIBUTING.md", "")
        planted(root, "docs/paper.md", "| theorem 1 | `f` | `a.h` |\n")
        planted(root, "README.md", text)
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                return "\n".join(run(runner, root))
        except Fault as fault:
            return str(fault)


def map_outcome(row: str) -> str:
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        (root / "src/orbitutte").mkdir(parents=True)
        (root / "src/orbitutte/a.h").write_text("// theorem 1\nint f();\n")
        planted(root, "docs/paper.md", row + "\n")
        return "\n".join(check_map(root))


def compiles(compiler: str, code: str) -> bool:
    program = cpp_program({"README.md": blocks_of("README.md", f"```cpp\n{code}\n```\n")})
    done = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-x", "c++", "-"], input=program, text=True, stderr=subprocess.DEVNULL)
    return done.returncode == 0


def self_test(compiler: Optional[str]) -> list[str]:
    runner = Runner(Path("/bin/sh"), Path("/"), None)
    sound = {
        "a command": "    echo sound > file\n    test -s file\n",
        "later blocks see what earlier ones made": "    echo 1 > file\n\ntext\n\n```sh\ntest -s file\n```\n\n```python\nassert open('file').read() == '1\\n'\n```\n",
        "blocks in Python share their names": "```python\na = 1\n```\n\n```python\nassert a == 1\n```\n",
        "a marked block": "<!-- not run: needs the moon -->\n\n    false\n",
        "a marked page": "<!-- not run below: needs the moon -->\n\n    false\n\ntext\n\n    false\n",
        "a command that a page takes for granted": "<!-- run first: echo 1 > file -->\n\n    test -s file\n",
        "a list's continuation is no block": "- item\n    false\n",
    }
    broken = {
        "a command that fails": ("    false\n", "README.md:1"),
        "a command that fails before the last": ("    false\n    true\n", "README.md:1"),
        "a command that fails within a pipe": ("    false | true\n", "README.md:1"),
        "the second block": ("    true\n\ntext\n\n    false\n", "README.md:5"),
        "an exception": ("```python\n\nraise ValueError('planted')\n```\n", 'File "README.md", line 3'),
        "a warning in Python": ("```python\nimport warnings\nwarnings.warn('planted')\n```\n", "planted"),
        "an unknown language": ("```cobol\nSTOP RUN.\n```\n", "cobol"),
        "a block without a language": ("```\nfalse\n```\n", "README.md:2"),
        "no reason": ("<!-- not run: -->\n\n    false\n", "without a reason"),
        "a reason without a block": ("<!-- not run: because -->\n\ntext\n", "does not stand before"),
        "a block without an end": ("```sh\ntrue\n", "does not end"),
    }
    faults = [f"{name}: {found}" for name, text in sound.items() if (found := outcome(runner, text))]
    faults += [f"{name} is not found, but {found!r}" for name, (text, expected) in broken.items() if expected not in (found := outcome(runner, text))]
    if found := map_outcome("| theorem 1 | `f` | `a.h` |"):
        faults.append(f"a sound row of the map: {found}")
    for row, expected in (("| theorem 1 | `g` | `a.h` |", "`g` is not in"), ("| theorem 1 | `f` | `b.h` |", "there is no"), ("", "no row"),
                          ("| theorem 1 | `f` | `b.h` |", "cites the paper")):
        if expected not in map_outcome(row):
            faults.append(f"the map {row!r}: {expected!r} is not said")
    if compiler:
        if not compiles(compiler, "#include <vector>\nconst std::vector<int> a = {1};"):
            faults.append("a sound block in C++ does not compile")
        if compiles(compiler, "int a = nothing_of_this_name;"):
            faults.append("a broken block in C++ compiles")
    return faults


def main() -> int:
    parser = argparse.ArgumentParser(description="Runs the code blocks of the documents.")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("write-cpp").add_argument("output", type=Path)
    running = commands.add_parser("run")
    running.add_argument("--program", type=Path, default=ROOT / "build/orbitutte")
    running.add_argument("--python-path", type=Path)
    running.add_argument("--blocks", type=Path)
    commands.add_parser("self-test").add_argument("--compiler")
    arguments = parser.parse_args()
    try:
        if arguments.command == "write-cpp":
            write_if_changed(arguments.output, cpp_program(all_blocks()))
            return 0
        if arguments.command == "run":
            paths = [arguments.program, arguments.python_path, arguments.blocks]
            faults = run(Runner(*[path and path.resolve() for path in paths]))
        else:
            faults = self_test(arguments.compiler)
    except Fault as fault:
        faults = [str(fault)]
    for fault in faults:
        print(f"FAILED  {fault}", file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
