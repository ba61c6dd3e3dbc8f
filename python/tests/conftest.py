# SPDX-License-Identifier: MIT
import os
import pathlib

import numpy as np
import pytest

import orbitutte


@pytest.fixture(scope="session")
def figure():
    """A sphere of 500 triangles."""
    return orbitutte.sample_mesh("figure", 500)


@pytest.fixture(scope="session")
def mask():
    """A disk of 500 triangles."""
    return orbitutte.sample_mesh("mask", 500)


@pytest.fixture(scope="session")
def embedding(figure):
    return orbitutte.embed(*figure, "432")


@pytest.fixture(scope="session")
def command():
    """The command line, or a skipped test."""
    path = os.environ.get("ORBITUTTE", "")
    if not pathlib.Path(path).is_file():
        pytest.skip("the command line is not there: set ORBITUTTE to its path")
    return path


def cube():
    """Six quadrangles."""
    V = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    F = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    return V, F
