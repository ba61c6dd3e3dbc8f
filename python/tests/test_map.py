# SPDX-License-Identifier: MIT
"""Maps between two surfaces."""
import json
import struct

import numpy as np
import pytest

import orbitutte


@pytest.fixture(scope="module")
def pair():
    """Two spheres that resemble each other, and three landmarks."""
    A = orbitutte.sample_mesh("figure", 500)
    B = orbitutte.sample_mesh("figure", 900)
    marks = orbitutte.choose_cones(*A, "222")
    landmarks = [(a, int(np.argmin(np.linalg.norm(B[0] - A[0][a], axis=1)))) for a in marks]
    return A, B, landmarks


@pytest.fixture(scope="module")
def surface_map(pair):
    return orbitutte.map_between(*pair)


def points_in_space(mesh, points):
    V, F = mesh
    return np.einsum("vk,vkd->vd", points.barycentric, V[F[points.triangle]])


def test_landmarks_are_matched(pair, surface_map):
    A, B, landmarks = pair
    assert surface_map.bijective
    images = points_in_space(B, surface_map.to_b())
    for a, b in landmarks:
        assert np.array_equal(images[a], B[0][b])


def test_there_and_back_is_the_identity(pair, surface_map):
    A = pair[0]
    back = surface_map.to_a(surface_map.to_b())
    assert np.abs(points_in_space(A, back) - A[0]).max() < 1e-9


def test_rows_of_the_matrix_sum_to_one(pair, surface_map):
    pytest.importorskip("scipy")
    A, B, _ = pair
    matrix = surface_map.matrix()
    assert matrix.shape == (len(A[0]), len(B[0]))
    assert np.abs(matrix.sum(axis=1) - 1).max() < 1e-12
    assert np.abs(matrix @ B[0] - surface_map.pull(B[0])).max() < 1e-12


def test_labels_come_from_the_nearest_corner(pair, surface_map):
    B = pair[1]
    labels = np.arange(len(B[0]))
    pulled = surface_map.pull(labels, "nearest")
    points = surface_map.to_b()
    nearest = B[1][points.triangle, points.barycentric.argmax(axis=1)]
    assert np.array_equal(pulled, nearest)
    with pytest.raises(orbitutte.ArgumentError, match="linear or nearest"):
        surface_map.pull(labels, "some")
    with pytest.raises(orbitutte.ArgumentError, match="vertices"):
        surface_map.pull(labels[:5])


def test_the_overlay_covers_both_surfaces(pair, surface_map):
    overlay = surface_map.overlay()
    assert overlay.failed_checks == []
    for (V, F), positions in zip(pair[:2], (overlay.on_a, overlay.on_b)):
        def area(V, F):
            return sum(np.linalg.norm(np.cross(V[f[k - 1]] - V[f[0]], V[f[k]] - V[f[0]])) / 2 for f in F for k in range(2, len(f)))
        assert area(positions, overlay.faces) == pytest.approx(area(V, F), rel=1e-9)


def test_morphs_begin_on_one_surface_and_end_on_the_other(surface_map, tmp_path):
    overlay = surface_map.overlay()
    assert np.array_equal(surface_map.morph(0)[0], overlay.on_a)
    assert np.array_equal(surface_map.morph(1)[0], overlay.on_b)
    surface_map.write_morph(tmp_path / "morph.glb")
    data = (tmp_path / "morph.glb").read_bytes()
    assert data[:4] == b"glTF"
    length = struct.unpack("<I", data[12:16])[0]
    model = json.loads(data[20:20 + length])
    primitive = model["meshes"][0]["primitives"][0]
    positions, target = (model["accessors"][attributes["POSITION"]] for attributes in (primitive["attributes"], primitive["targets"][0]))
    assert positions["count"] == target["count"] == len(overlay.on_a)
    assert np.allclose(np.array(target["max"]), (overlay.on_b - overlay.on_a).max(axis=0), atol=1e-5)
    assert model["animations"][0]["channels"][0]["target"]["path"] == "weights"


def test_what_was_saved_is_the_same_map(pair, surface_map, tmp_path):
    surface_map.save(tmp_path / "map")
    loaded = orbitutte.SurfaceMap.load(tmp_path / "map", *pair[:2])
    assert np.array_equal(loaded.landmarks, surface_map.landmarks)
    assert np.array_equal(loaded.to_b().triangle, surface_map.to_b().triangle)
    assert np.array_equal(loaded.to_b().barycentric, surface_map.to_b().barycentric)


def test_five_landmarks(pair):
    A, B, _ = pair
    marks = orbitutte.choose_cones(*A, "2,2,2,2,2")
    landmarks = [(a, int(np.argmin(np.linalg.norm(B[0] - A[0][a], axis=1)))) for a in marks]
    result = orbitutte.map_between(A, B, landmarks)
    assert result.bijective
    assert result.overlay().failed_checks == []


def test_bad_landmarks_are_named(pair):
    A, B, landmarks = pair
    with pytest.raises(orbitutte.ArgumentError, match="k x 2"):
        orbitutte.map_between(A, B, [1, 2, 3])
    with pytest.raises(orbitutte.Error):
        orbitutte.map_between(A, B, [*landmarks[:2], landmarks[0]])
