# SPDX-License-Identifier: MIT
"""The package where its compiled module is missing or is not for this Python."""
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

import orbitutte

PACKAGE = pathlib.Path(orbitutte.__file__).parent


def imported(folder):
    """What Python says of an import from this folder."""
    environment = {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, "-c", "import orbitutte; print(orbitutte.__file__)"], env=environment, cwd=folder, text=True,
                          capture_output=True)


@pytest.fixture
def package(tmp_path):
    """A copy of the package's sources without the compiled module."""
    (tmp_path / "orbitutte").mkdir()
    for source in PACKAGE.glob("*.py"):
        shutil.copy(source, tmp_path / "orbitutte")
    return tmp_path


def test_a_package_without_its_compiled_module_says_what_builds_it(package):
    done = imported(package)
    assert done.returncode != 0
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith("ImportError: ") and "orbitutte_package" in last and "./demo.sh" in last and str(package / "orbitutte") in last


def test_a_compiled_module_that_cannot_be_loaded_says_why(package):
    suffix = next(path.name.removeprefix("_orbitutte") for path in PACKAGE.glob("_orbitutte*.so"))
    (package / "orbitutte" / f"_orbitutte{suffix}").write_bytes(b"no library")
    last = imported(package).stderr.strip().splitlines()[-1]
    assert last.startswith("ImportError: ") and ("invalid ELF header" in last or "file too short" in last)


def test_a_complete_package_is_imported(package):
    for path in PACKAGE.glob("_orbitutte*.so"):
        shutil.copy(path, package / "orbitutte")
    done = imported(package)
    assert done.returncode == 0 and done.stdout.strip() == str(package / "orbitutte" / "__init__.py")
