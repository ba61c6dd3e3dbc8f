# SPDX-License-Identifier: MIT
"""embed(..., repair=True)."""
import numpy as np
import pytest

import orbitutte


@pytest.fixture(scope="module")
def broken():
    """A figure whose faces have vertices of their own, and a face far away; the figure."""
    V, F = orbitutte.sample_mesh("figure", 500)
    soup = np.vstack([V[F].reshape(-1, 3), [[9, 9, 9], [9, 9.1, 9], [9.1, 9, 9]]])
    return soup, np.arange(len(soup)).reshape(-1, 3), V, F


def test_vertices_keep_their_numbers(broken):
    soup, faces, V, F = broken
    with pytest.raises(orbitutte.MeshError):
        orbitutte.embed(soup, faces)
    cones = orbitutte.choose_cones(V, F, "432")
    corner_of = [int(np.flatnonzero(F.reshape(-1) == cone)[0]) for cone in cones]
    embedding = orbitutte.embed(soup, faces, "432", corner_of, repair=True)
    assert embedding.bijective
    assert [cone.vertex for cone in embedding.cones] == corner_of
    assert {step["step"] for step in embedding.report["repair"]["steps"]} == {"weld", "keep_largest"}
    assert embedding.report["repair"]["added_vertices"] == []
    used = np.unique(embedding.source_vertex[embedding.faces])
    assert len(used) == len(V) and np.array_equal(np.unique(soup[used], axis=0), np.unique(V, axis=0))
    assert embedding.energy == pytest.approx(orbitutte.embed(V, F, "432", cones).energy, rel=1e-9)


def test_marked_vertices_follow(broken):
    soup, faces, V, F = broken
    corners = F.reshape(-1)
    later = next(k for k in range(len(corners)) if 1 < np.flatnonzero(corners == corners[k])[0] < k)
    embedding = orbitutte.embed(soup, faces, "222", [later, 0, 1], repair=True)
    assert embedding.cones[0].vertex == np.flatnonzero(corners == corners[later])[0]
    with pytest.raises(orbitutte.MeshError, match="no face at it is left"):
        orbitutte.embed(soup, faces, "222", [len(soup) - 1, 0, 1], repair=True)


def test_files_are_read_with_the_mesh_as_it_was(broken, tmp_path):
    soup, faces, _, _ = broken
    embedding = orbitutte.embed(soup, faces, repair=True)
    embedding.save(tmp_path / "out.ply", tmp_path / "out.json")
    loaded = orbitutte.Embedding.load(tmp_path / "out.ply", tmp_path / "out.json", (soup, faces))
    assert orbitutte.verify(loaded)["bijective"]
    assert orbitutte.verify(embedding, soup, faces)["bijective"]


def test_a_sound_mesh_stays_as_it_is():
    V, F = orbitutte.sample_mesh("figure", 500)
    plain, repaired = (orbitutte.embed(V, F, "432", "extremities", repair=repair) for repair in (False, True))
    assert np.array_equal(plain.positions, repaired.positions)
    assert repaired.report["repair"] == {"steps": [], "added_vertices": []} and "repair" not in plain.report
    with pytest.raises(TypeError):
        orbitutte.embed(V, F, repair="yes")
