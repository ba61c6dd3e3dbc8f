# SPDX-License-Identifier: MIT
"""Files, and the command line's files."""
import json
import pathlib
import runpy
import subprocess

import numpy as np
import orbitutte
import pytest
from conftest import cube


def run(*arguments):
    return subprocess.run([str(argument) for argument in arguments], check=True, capture_output=True, text=True).stdout


def without_what_varies(report):
    report = json.loads(report) if isinstance(report, (str, bytes)) else report
    for key in ("timings", "peak_memory_bytes"):
        del report[key]
    del report["mesh"]["path"], report["environment"]["input_sha256"], report["environment"]["commit"]
    return report


@pytest.mark.parametrize("shape, signature", [("figure", "432"), ("mask", "2*3"), ("boy", "2x")])
def test_the_command_line_writes_the_same(shape, signature, command, tmp_path):
    V, F = orbitutte.sample_mesh(shape, 300)
    orbitutte.write_mesh(tmp_path / "mesh.ply", V, F)
    embedding = orbitutte.embed(V, F, signature, "extremities")
    embedding.save(tmp_path / "python.ply", tmp_path / "python.json")
    run(command, "embed", tmp_path / "mesh.ply", "--orbifold", signature, "--cones", "extremities", "-o", tmp_path / "map.ply",
        "--report", tmp_path / "map.json", "--quiet")
    assert (tmp_path / "python.ply").read_bytes() == (tmp_path / "map.ply").read_bytes()
    assert without_what_varies((tmp_path / "python.json").read_bytes()) == without_what_varies((tmp_path / "map.json").read_bytes())
    # It accepts what Python wrote, and says the same of it.
    verdict = run(command, "verify", tmp_path / "python.ply", tmp_path / "python.json", tmp_path / "mesh.ply", "--json")
    assert json.loads(verdict) == orbitutte.verify(embedding)
    run(command, "tile", tmp_path / "python.ply", tmp_path / "python.json", "-o", tmp_path / "tiling.ply")
    embedding.write_tiling(tmp_path / "python-tiling.ply")
    assert (tmp_path / "python-tiling.ply").read_bytes() == (tmp_path / "tiling.ply").read_bytes()
    # Python reads what it wrote.
    loaded = orbitutte.Embedding.load(tmp_path / "map.ply", tmp_path / "map.json", tmp_path / "mesh.ply")
    assert np.array_equal(loaded.positions, embedding.positions) and loaded.energy == embedding.energy and orbitutte.verify(loaded)["bijective"]
    assert np.array_equal(loaded.weights.w, embedding.weights.w) and np.array_equal(loaded.area_distortion, embedding.area_distortion)
    loaded.save(tmp_path / "again.ply", tmp_path / "again.json")
    for name in ("ply", "json"):
        assert (tmp_path / f"again.{name}").read_bytes() == (tmp_path / f"map.{name}").read_bytes()


def test_info_and_types_are_those_of_the_command_line(command, figure, tmp_path):
    orbitutte.write_mesh(tmp_path / "mesh.obj", *figure)
    theirs = json.loads(run(command, "info", tmp_path / "mesh.obj", "--json"))
    assert {**theirs, "path": ""} == orbitutte.info(*figure)
    assert json.loads(run(command, "types", "--json")) == orbitutte.families()


def test_polygons_through_files(command, tmp_path):
    V, F = cube()
    embedding = orbitutte.embed(V, F, "22", [0, 7])
    orbitutte.write_mesh(tmp_path / "cube.obj", V, F)
    embedding.save(tmp_path / "map.ply", tmp_path / "map.json")
    assert json.loads(run(command, "verify", tmp_path / "map.ply", tmp_path / "map.json", tmp_path / "cube.obj", "--json"))["bijective"]
    loaded = orbitutte.Embedding.load(tmp_path / "map.ply", tmp_path / "map.json", (V, F))
    assert np.array_equal(loaded.faces, embedding.faces) and np.array_equal(loaded.triangles, embedding.triangles)


@pytest.mark.parametrize("ending", ["obj", "off", "ply"])
def test_meshes_read_back_as_they_were_written(ending, figure, tmp_path):
    for V, F in (figure, cube(), (cube()[0], [(0, 1, 3), (0, 3, 2), *map(tuple, cube()[1][1:].tolist())])):
        orbitutte.write_mesh(tmp_path / f"mesh.{ending}", V, F)
        read_V, read_F = orbitutte.read_mesh(tmp_path / f"mesh.{ending}")
        assert np.array_equal(read_V, V) and (read_F == F if isinstance(F, list) else np.array_equal(read_F, F))


def test_what_a_reader_passes_over_is_a_warning(tmp_path, figure):
    path = tmp_path / "figure.stl"
    orbitutte.write_mesh(path, *figure)
    path.write_bytes(path.read_bytes() + b"\n")
    with pytest.warns(orbitutte.MeshWarning, match="1 byte is ignored"):
        V, F = orbitutte.read_mesh(path)
    assert len(F) == len(figure[1])


def test_nothing_is_printed_on_standard_output(capfd):
    angles = 2 * np.pi * np.arange(3200) / 3200
    V = np.vstack([[[0, 0, 1], [0, 0, -1]], np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])])
    k = np.arange(3200)
    F = np.vstack([np.column_stack([0 * k, 2 + k, 2 + (k + 1) % 3200]), np.column_stack([0 * k + 1, 2 + (k + 1) % 3200, 2 + k])])
    assert orbitutte.embed(V, F, "432").bijective
    assert capfd.readouterr().out == ""


def test_an_embedding_without_its_mesh_says_what_it_needs_it_for(embedding, tmp_path):
    embedding.save(tmp_path / "map.ply", tmp_path / "map.json")
    loaded = orbitutte.Embedding.load(tmp_path / "map.ply", tmp_path / "map.json")
    assert loaded.mesh is None and len(orbitutte.tile(loaded).F) == 24 * 500 and loaded.locate([0, 0, 1]).triangle >= 0
    for use in (lambda: orbitutte.verify(loaded), lambda: loaded.weights, lambda: loaded.area_distortion, lambda: loaded.source_points(0, [1, 0, 0])):
        with pytest.raises(orbitutte.ArgumentError, match="mesh"):
            use()
    assert orbitutte.verify(loaded, *embedding.mesh)["bijective"]


def test_an_embedding_of_another_mesh_is_not_certified(embedding, figure):
    V, F = figure
    moved = V.copy()
    moved[3] += 0.05
    assert not orbitutte.verify(embedding, moved, F)["bijective"]  # another energy
    assert not orbitutte.verify(embedding, V, np.roll(F, 1, axis=0))["bijective"]
    with pytest.raises(orbitutte.MeshError):
        orbitutte.verify(embedding, V, np.vstack([F, F[:1]]))
    for faces, pattern in ((np.roll(F, 1, axis=0), "face 0 of the mesh"), (F[:-1], "has 499")):
        with pytest.raises(orbitutte.MeshError, match=pattern):
            embedding.with_mesh(V, faces)


def test_files_appear_whole_or_not_at_all(embedding, figure, tmp_path):
    with pytest.raises(orbitutte.FileError, match="none"):
        embedding.save(tmp_path / "none" / "map.ply")
    with pytest.raises(orbitutte.ArgumentError, match="ending"):
        orbitutte.write_mesh(tmp_path / "mesh.xyz", *figure)
    with pytest.raises(orbitutte.MeshError, match="face 3 names the vertex 9999"):
        orbitutte.write_mesh(tmp_path / "mesh.obj", figure[0], np.vstack([figure[1][:3], [[0, 1, 9999]]]))
    with pytest.raises(ValueError, match="vertex 2 "):
        orbitutte.write_mesh(tmp_path / "mesh.obj", [[0, 0, 0], [1, 0, 0], [np.nan, 0, 0]], [[0, 1, 2]])
    assert list(tmp_path.iterdir()) == []


def test_the_first_steps_of_a_new_user(tmp_path, monkeypatch, capsys):
    script = pathlib.Path(__file__).parents[2] / "examples" / "first_steps.py"
    monkeypatch.chdir(tmp_path)
    try:
        names = runpy.run_path(str(script))
    except orbitutte.ArgumentError as error:
        if "without pictures" not in str(error):
            raise
        pytest.skip(str(error))
    assert names["embedding"].bijective and "bijective" in capsys.readouterr().out
    assert {path.name for path in tmp_path.iterdir()} == {"tiling.obj", "map.ply", "map.json", "map.png"}


@pytest.mark.parametrize("ending", ["npy", "npy.gz"])
def test_whole_numbers_stay_whole_in_an_array(tmp_path, ending):
    path = tmp_path / f"labels.{ending}"
    orbitutte.write_vertex_data(path, np.array([3, 0, 7], dtype=np.uint8))
    read = orbitutte.read_vertex_data(path).values
    assert read.dtype == np.int64 and read[:, 0].tolist() == [3, 0, 7]
    orbitutte.write_vertex_data(path, np.array([3.0, 0.0, 7.0]))
    assert orbitutte.read_vertex_data(path).values.dtype == np.float64


@pytest.mark.parametrize("ending", ["shape.gii", "func.gii.gz", "csv", "txt", "npy"])
def test_values_at_vertices_come_back(ending, tmp_path):
    values = np.random.default_rng(5).normal(size=(50, 2)).astype(np.float32)
    orbitutte.write_vertex_data(tmp_path / f"values.{ending}", values, ["one", "two"])
    read = orbitutte.read_vertex_data(tmp_path / f"values.{ending}")
    assert np.array_equal(read.values, values) and read.labels == []
    assert read.names == ([] if ending in ("txt", "npy") else ["one", "two"])


@pytest.mark.parametrize("ending", ["label.gii", "annot"])
def test_labels_come_back(ending, tmp_path):
    labels = [orbitutte.ValueLabel(0, "unknown", (1.0, 1.0, 1.0, 1.0)), orbitutte.ValueLabel(3, "insula", (1.0, 0.0, 0.0, 1.0))]
    orbitutte.write_vertex_data(tmp_path / f"values.{ending}", [3, 0, 0, 3], labels=labels)
    read = orbitutte.read_vertex_data(tmp_path / f"values.{ending}")
    assert read.values.tolist() == [[3], [0], [0], [3]] and read.labels == labels


def test_values_that_cannot_be_written_are_refused(tmp_path):
    with pytest.raises(orbitutte.ArgumentError, match="ending names no known format of values"):
        orbitutte.write_vertex_data(tmp_path / "thickness", [1.0])
    with pytest.raises(orbitutte.MeshError, match="one map, but there are 2"):
        orbitutte.write_vertex_data(tmp_path / "lh.curv", [[1.0, 2.0]])
    with pytest.raises(orbitutte.ArgumentError, match="shape"):
        orbitutte.write_vertex_data(tmp_path / "a.npy", np.zeros((2, 2, 2)))
    with pytest.raises(orbitutte.FileError):
        orbitutte.read_vertex_data(tmp_path / "no.shape.gii")
    assert list(tmp_path.iterdir()) == []
