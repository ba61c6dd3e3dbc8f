# SPDX-License-Identifier: MIT
"""An embedding as a map of points."""
import numpy as np
import orbitutte
import pytest


def directions(count, seed=1):
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


@pytest.mark.parametrize("shape, signature", [("figure", "532"), ("mask", "*332"), ("mask", "2*3"), ("boy", "3x"), ("figure", "1"), ("mask", "*")])
def test_every_direction_is_located_and_comes_back(shape, signature):
    embedding = orbitutte.embed(*orbitutte.sample_mesh(shape, 300), signature)
    points = directions(5000)
    found = embedding.locate(points)
    assert np.abs(embedding.map_points(*found) - points).max() < 1e-12
    assert set(found.copy) == set(range(len(embedding.group)))
    # The same by hand: the group element applied to the normalised combination.
    corners = embedding.positions[embedding.triangles[found.triangle]]
    flat = np.einsum("ki,kij->kj", found.barycentric, corners)
    images = np.einsum("kij,kj->ki", embedding.group[found.copy], flat / np.linalg.norm(flat, axis=1)[:, None])
    assert np.abs(images - points).max() < 1e-12


def test_points_in_space_lie_on_the_faces(embedding, figure):
    V, F = figure
    middle = np.full((len(F), 3), 1 / 3)
    assert np.allclose(embedding.source_points(np.arange(len(F)), middle), V[F].mean(axis=1))
    assert np.allclose(embedding.source_points(4, [0, 1, 0]), V[F[4, 1]])


def test_a_single_point_is_a_point(embedding):
    triangle, barycentric, copy = embedding.locate([0, 0, 2])
    assert isinstance(triangle, int) and barycentric.shape == (3,) and isinstance(copy, int)
    assert np.allclose(embedding.map_points(triangle, barycentric, copy), [0, 0, 1], atol=1e-14)
    assert embedding.map_points(triangle, barycentric).shape == (3,)
    assert len(embedding.locate(np.empty((0, 3))).triangle) == 0


def test_what_is_nowhere_is_told(embedding):
    found = embedding.locate([[0, 0, 0], [np.nan, 0, 1], [0, 1, 0]])
    assert found.triangle.tolist()[:2] == [-1, -1] and found.triangle[2] >= 0
    assert np.isnan(embedding.map_points(*found)[:2]).all() and np.isnan(embedding.source_points(*found[:2])[:2]).all()


def test_points_that_are_none_are_named(embedding):
    with pytest.raises(orbitutte.ArgumentError, match="point 1 names the triangle 500"):
        embedding.map_points([0, 500], [[1, 0, 0], [1, 0, 0]])
    with pytest.raises(orbitutte.ArgumentError, match="point 0 .* add up to 1"):
        embedding.map_points([0], [[1, 1, 0]])
    with pytest.raises(orbitutte.ArgumentError, match="copy 24"):
        embedding.map_points(0, [1, 0, 0], 24)
    with pytest.raises(orbitutte.ArgumentError, match="2 triangles, 1 rows"):
        embedding.map_points([0, 1], [[1, 0, 0]])
    with pytest.raises(orbitutte.ArgumentError, match="point 0 names the triangle 500"):
        embedding.source_points([500], [[1, 0, 0]])


def test_old_names_work_with_a_warning(embedding):
    found = embedding.locate(directions(3))
    tiling = orbitutte.tile(embedding)
    for old, new in ((lambda: found.face, found.triangle), (lambda: found.element, found.copy), (lambda: tiling.element, tiling.copy)):
        with pytest.warns(DeprecationWarning, match="its name is now"):
            assert np.array_equal(old(), new)
    with pytest.warns(DeprecationWarning, match="argument face of map_points .* triangle"):
        images = embedding.map_points(face=found.triangle, barycentric=found.barycentric, element=found.copy)
    assert np.array_equal(images, embedding.map_points(*found))
    with pytest.warns(DeprecationWarning, match="argument face of source_points"):
        points = embedding.source_points(face=found.triangle, barycentric=found.barycentric)
    assert np.array_equal(points, embedding.source_points(*found[:2]))
    with pytest.warns(DeprecationWarning), pytest.raises(TypeError, match="both triangle and face"):
        embedding.map_points(triangle=0, face=0, barycentric=[1, 0, 0])
    with pytest.warns(DeprecationWarning, match="families"):
        assert orbitutte.signatures() == orbitutte.families()
