# SPDX-License-Identifier: MIT
"""Maps between two surfaces."""
import json
import pathlib
import struct

import numpy as np
import pytest

import orbitutte


SHARED = pathlib.Path(__file__).resolve().parents[3] / "shared"


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


def shared_pair(name, rows):
    folder = SHARED / "pairs" / name
    if not folder.is_dir():
        pytest.skip(f"{folder} is not there")
    marks = np.loadtxt(folder / "landmarks.tsv", skiprows=1, dtype=int)[list(rows)]
    return orbitutte.read_mesh(folder / "a.off"), orbitutte.read_mesh(folder / "b.off"), marks


def shared_mesh(name):
    path = SHARED / "meshes" / name
    if not path.exists():
        pytest.skip(f"{path} is not there")
    mesh = orbitutte.read_mesh(path)
    return mesh, mesh, [(v, v) for v in orbitutte.choose_cones(*mesh, "2222")]


# With four landmarks limbs of the bodies shrink so far that the last digits of the doubles in between show.
@pytest.mark.parametrize(("made", "bound"), [(lambda: shared_pair("bodies", range(5)), 1e-9), (lambda: shared_pair("bodies", (0, 1, 3, 4)), 1e-8),
                                             (lambda: shared_pair("hands", range(5)), 1e-9), (lambda: shared_mesh("spot.obj"), 1e-9),
                                             (lambda: shared_mesh("itokawa.off"), 1e-9)], ids=["bodies", "bodies by four", "hands", "spot", "itokawa"])
def test_there_and_back_is_the_identity_even_where_limbs_shrink(made, bound):
    A, B, landmarks = made()
    found = orbitutte.map_between(A, B, landmarks, cut_seeds=(0, 7))
    for (V, F), back in ((A, found.to_a(found.to_b())), (B, found.to_b(found.to_a()))):
        size = np.linalg.norm(V.max(axis=0) - V.min(axis=0))
        assert np.linalg.norm(points_in_space((V, F), back) - V, axis=1).max() < bound * size


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


def picture_of(size):
    """Smooth, and different everywhere."""
    rows, columns = np.mgrid[:size, :size] / size
    waves = [np.sin(5 * columns), np.sin(4 * rows), np.sin(3 * (rows + columns))]
    return np.round(127 + 100 * np.stack(waves, axis=2)).astype(np.uint8)


def pixels_at(picture, uv):
    height, width = picture.shape[:2]
    columns = np.clip((uv[:, 0] * width).astype(int), 0, width - 1)
    rows = np.clip(((1 - uv[:, 1]) * height).astype(int), 0, height - 1)
    return picture[rows, columns, :3].astype(int)


def test_the_identity_bakes_a_texture_onto_itself(pair):
    A = pair[0]
    identity = orbitutte.map_between(A, A, [(v, v) for v in orbitutte.choose_cones(*A, "222")])
    picture = picture_of(128)
    grey = np.full((8, 8), 90, np.uint8)
    chart = identity.bake(grey, (np.zeros((1, 2)), np.zeros(3 * len(A[1]), int)))
    assert chart.picture.shape == (8, 8, 4) and np.abs(chart.picture[:, :, 0].astype(int) - 90).max() <= 1
    baked = identity.bake(picture, chart.layout, chart.layout)
    assert baked.picture.shape == (128, 128, 4)
    used = chart.layout.uv[np.unique(chart.layout.of_corner)]
    assert np.abs(pixels_at(baked.picture, used) - pixels_at(picture, used)).max() <= 6


def test_what_is_no_texture_is_refused(pair, surface_map):
    B = pair[1]
    layout = np.zeros((1, 2)), np.zeros(3 * len(B[1]), int)
    with pytest.raises(orbitutte.ArgumentError, match="uint8"):
        surface_map.bake(np.zeros((4, 4)), layout)
    with pytest.raises(orbitutte.MeshError, match="corners"):
        surface_map.bake(picture_of(4), (layout[0], layout[1][:-1]))
    with pytest.raises(orbitutte.ArgumentError, match="do not exist"):
        surface_map.bake(picture_of(4), (layout[0], layout[1] + 1))


def test_texture_coordinates_are_read_from_obj_files(tmp_path):
    head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.5 1\n"
    (tmp_path / "with.obj").write_text(head + "f 1/3 2/1 3/2\n")
    (tmp_path / "without.obj").write_text(head + "f 1 2 3\n")
    layout = orbitutte.read_texture_layout(tmp_path / "with.obj")
    assert layout.of_corner.tolist() == [2, 0, 1] and layout.uv.tolist() == [[0, 0], [1, 0], [0.5, 1]]
    assert orbitutte.read_texture_layout(tmp_path / "without.obj") is None
