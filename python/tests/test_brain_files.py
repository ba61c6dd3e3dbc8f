# SPDX-License-Identifier: MIT
"""Files of brain mappers: nibabel reads what this library writes, and the other way round, all equal."""
import itertools
import json
import subprocess

import numpy as np
import orbitutte
import pytest

nibabel = pytest.importorskip("nibabel", reason="nibabel is missing; see ./setup --tests")
gifti = nibabel.gifti

ENCODINGS = ["ASCII", "B64BIN", "B64GZ"]
ORDERS = ["C", "F"]


@pytest.fixture(scope="module")
def surface():
    """A surface whose positions single precision has, in mm."""
    V, F = orbitutte.sample_mesh("figure", 500)
    return (50 * V).astype(np.float32).astype(np.float64), F


@pytest.fixture(scope="module")
def values():
    return np.random.default_rng(1).normal(size=(252, 3)).astype(np.float32).astype(np.float64)


def image(*arrays, labels=None):
    return gifti.GiftiImage(darrays=list(arrays), labeltable=labels)


def array(data, intent, encoding="B64GZ", order="C", endian="little", dtype=None, meta=None):
    return gifti.GiftiDataArray(np.asarray(data, dtype), intent=f"NIFTI_INTENT_{intent}", encoding=encoding, endian=endian, ordering=order,
                                datatype={"float32": 16, "int32": 8}[np.dtype(dtype).name], meta=meta)


# Surfaces

def test_nibabel_reads_surfaces(surface, tmp_path):
    V, F = surface
    orbitutte.write_mesh(tmp_path / "lh.pial.surf.gii", V, F)
    points, triangles = nibabel.load(tmp_path / "lh.pial.surf.gii").agg_data(("pointset", "triangle"))
    assert np.array_equal(points, V) and np.array_equal(triangles, F) and triangles.dtype == np.int32
    orbitutte.write_mesh(tmp_path / "lh.pial", V, F)
    points, triangles = nibabel.freesurfer.read_geometry(tmp_path / "lh.pial")
    assert np.array_equal(points, V) and np.array_equal(triangles, F)


@pytest.mark.parametrize("encoding, order", itertools.product(ENCODINGS, ORDERS))
def test_surfaces_of_nibabel_are_read(surface, encoding, order, tmp_path):
    V, F = surface
    if encoding == "ASCII" and order == "F":
        pytest.skip("nibabel writes text row by row, whatever it says of the order")
    file = image(array(V, "POINTSET", encoding, order, dtype=np.float32), array(F, "TRIANGLE", encoding, order, dtype=np.int32))
    nibabel.save(file, tmp_path / "lh.surf.gii")
    read_V, read_F = orbitutte.read_mesh(tmp_path / "lh.surf.gii")
    # Text has six digits.
    assert np.allclose(read_V, V, rtol=0, atol=1e-5 if encoding == "ASCII" else 0) and np.array_equal(read_F, F)


def test_freesurfer_surfaces_of_nibabel_are_read(surface, tmp_path):
    nibabel.freesurfer.write_geometry(tmp_path / "lh.white", *surface, create_stamp="created by a test")
    V, F = orbitutte.read_mesh(tmp_path / "lh.white")
    assert np.array_equal(V, surface[0]) and np.array_equal(F, surface[1])


# Measures

def test_nibabel_reads_measures(values, tmp_path):
    orbitutte.write_vertex_data(tmp_path / "a.shape.gii", values, ["one", "two <&>", "drei ä"])
    read = nibabel.load(tmp_path / "a.shape.gii")
    assert np.array_equal(np.column_stack([a.data for a in read.darrays]), values)
    assert [a.meta["Name"] for a in read.darrays] == ["one", "two <&>", "drei ä"]
    assert {a.intent for a in read.darrays} == {2005}  # SHAPE
    orbitutte.write_vertex_data(tmp_path / "a.func.gii", values)
    assert np.array_equal(np.column_stack(nibabel.load(tmp_path / "a.func.gii").agg_data()), values)
    orbitutte.write_vertex_data(tmp_path / "lh.thickness", values[:, 0])
    assert np.array_equal(nibabel.freesurfer.read_morph_data(tmp_path / "lh.thickness"), values[:, 0])
    orbitutte.write_vertex_data(tmp_path / "a.npy", values)
    assert np.array_equal(np.load(tmp_path / "a.npy"), values)
    orbitutte.write_vertex_data(tmp_path / "a.txt", values)
    assert np.array_equal(np.loadtxt(tmp_path / "a.txt"), values)


@pytest.mark.parametrize("encoding, endian", itertools.product(ENCODINGS, ["little", "big"]))
def test_measures_of_nibabel_are_read(values, encoding, endian, tmp_path):
    arrays = [array(column, "SHAPE", encoding, endian=endian, dtype=np.float32, meta=gifti.GiftiMetaData(Name=f"map {k}")) for k, column in enumerate(values.T)]
    nibabel.save(image(*arrays), tmp_path / "a.shape.gii")
    theirs = np.column_stack(nibabel.load(tmp_path / "a.shape.gii").agg_data())
    data = orbitutte.read_vertex_data(tmp_path / "a.shape.gii")
    # Text is read with all its digits.
    assert np.array_equal(data.values.astype(np.float32), theirs) and data.names == ["map 0", "map 1", "map 2"] and data.labels == []


def test_freesurfer_measures_of_nibabel_are_read(values, tmp_path):
    nibabel.freesurfer.write_morph_data(tmp_path / "lh.sulc", values[:, 1])
    assert np.array_equal(orbitutte.read_vertex_data(tmp_path / "lh.sulc").values[:, 0], values[:, 1])


@pytest.mark.parametrize("dtype, order", itertools.product(["<f4", ">f8", "<i2", ">u4", "|u1", "|b1", "<i8"], ORDERS))
def test_arrays_of_numpy_are_read(dtype, order, tmp_path):
    saved = np.asarray(np.arange(12).reshape(4, 3) % 7, dtype=dtype, order=order)
    np.save(tmp_path / "a.npy", saved)
    assert np.array_equal(orbitutte.read_vertex_data(tmp_path / "a.npy").values, saved.astype(float))


# Labels

NAMES = ["unknown", "insula", "gyrus"]
COLOURS = np.array([[25, 5, 25, 0], [255, 192, 32, 0], [0, 0, 255, 128]], dtype=np.int32)


def test_annotations_of_nibabel_are_read(tmp_path):
    labels = np.random.default_rng(2).integers(-1, 3, 252)
    nibabel.freesurfer.write_annot(tmp_path / "lh.test.annot", labels.copy(), COLOURS, NAMES)
    data = orbitutte.read_vertex_data(tmp_path / "lh.test.annot")
    assert np.array_equal(data.values[:, 0], labels)
    assert [label.name for label in data.labels] == NAMES and [label.key for label in data.labels] == [0, 1, 2]
    read = np.array([label.colour for label in data.labels]) * 255
    assert np.allclose(read[:, :3], COLOURS[:, :3]) and np.allclose(255 - read[:, 3], COLOURS[:, 3])


def table(keys=(0, 1, 2)):
    return [orbitutte.ValueLabel(key, name, (*(colour[:3] / 255), 1 - colour[3] / 255)) for key, name, colour in zip(keys, NAMES, COLOURS)]


def test_nibabel_reads_annotations(tmp_path):
    labels = np.random.default_rng(3).integers(-1, 3, 252)
    orbitutte.write_vertex_data(tmp_path / "lh.test.annot", labels, labels=table())
    read, colours, names = nibabel.freesurfer.read_annot(tmp_path / "lh.test.annot")
    assert np.array_equal(read, labels) and np.array_equal(colours[:, :4], COLOURS) and [name.decode() for name in names] == NAMES


def test_label_files(tmp_path):
    keys, labels = (0, 35, 7), np.random.default_rng(4).choice([0, 35, 7], 252)
    orbitutte.write_vertex_data(tmp_path / "a.label.gii", labels, ["parcels"], table(keys))
    read = nibabel.load(tmp_path / "a.label.gii")
    assert np.array_equal(read.agg_data("label"), labels) and read.darrays[0].data.dtype == np.int32
    assert read.labeltable.get_labels_as_dict() == dict(zip(keys, NAMES))
    # nibabel's own copy of it.
    nibabel.save(read, tmp_path / "b.label.gii")
    ours, theirs = orbitutte.read_vertex_data(tmp_path / "a.label.gii"), orbitutte.read_vertex_data(tmp_path / "b.label.gii")
    assert np.array_equal(ours.values, theirs.values) and ours.names == theirs.names == ["parcels"]
    assert [label[:2] for label in ours.labels] == [label[:2] for label in theirs.labels] == list(zip(keys, NAMES))
    assert np.allclose([label.colour for label in ours.labels], [label.colour for label in theirs.labels], atol=1e-6)


# What the command line makes of them

def by_definition(V, sphere, F):
    """Areas around vertices, J, R and edges, as Connectome Workbench defines them: log2 each."""
    def flat(points):
        a, b, c = points[F[:, 0]], points[F[:, 1]], points[F[:, 2]]
        x = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
        rest = c - a - x * np.sum(x * (c - a), axis=1)[:, None]
        return np.stack([np.stack([np.linalg.norm(b - a, axis=1), np.sum(x * (c - a), axis=1)], 1),
                         np.stack([np.zeros(len(F)), np.linalg.norm(rest, axis=1)], 1)], 1)

    P, Q = flat(V), flat(sphere)
    sigma = np.linalg.svd(Q @ np.linalg.inv(P), compute_uv=False)

    def around(of_face):
        return np.bincount(F.ravel(), np.repeat(of_face, 3), len(V))

    def area(points):
        return around(np.linalg.det(flat(points)) / 6)

    edges = np.unique(np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1), axis=0)
    ratio = np.abs(np.log2(np.linalg.norm(np.diff(sphere[edges], axis=1), axis=2) / np.linalg.norm(np.diff(V[edges], axis=1), axis=2)))[:, 0]
    degree = np.bincount(edges.ravel(), minlength=len(V))
    count = around(np.ones(len(F)))
    with np.errstate(invalid="ignore"):  # at vertices without triangles
        return np.column_stack([np.log2(area(sphere) / area(V)), np.log2(around(sigma.prod(axis=1)) / count),
                                np.log2(around(sigma[:, 0] / sigma[:, 1]) / count),
                                np.bincount(edges.ravel(), np.repeat(ratio, 2), len(V)) / degree])


def test_measures_of_a_certified_sphere(surface, command, tmp_path):
    V, F = surface
    # An unused vertex at the front, as a medial wall leaves some, keeps its place.
    V, F = np.vstack([[[0, 0, 0]], V]), np.asarray(F) + 1
    nibabel.freesurfer.write_geometry(tmp_path / "lh.pial", V, F)

    def run(*arguments):
        return subprocess.run([command, *map(str, arguments)], check=True, capture_output=True, text=True, cwd=tmp_path).stdout

    run("embed", "lh.pial", "--orbifold", "1", "-o", "map.ply", "--report", "map.json", "--quiet")
    for name in ("lh.sphere", "lh.sphere.surf.gii"):
        run("export", "map.ply", "map.json", "lh.pial", "-o", name)
    sphere, faces = nibabel.freesurfer.read_geometry(tmp_path / "lh.sphere")
    assert np.array_equal(faces, F) and np.allclose(np.linalg.norm(sphere, axis=1), 100)
    points, triangles = nibabel.load(tmp_path / "lh.sphere.surf.gii").agg_data(("pointset", "triangle"))
    assert np.array_equal(points, sphere) and np.array_equal(triangles, F)
    run("measure", "map.ply", "map.json", "lh.pial", "--radius", "100", "-o", "map.shape.gii")
    read = nibabel.load(tmp_path / "map.shape.gii")
    assert [a.meta["Name"] for a in read.darrays] == ["log2 area", "log2 J", "log2 R", "log2 edge"]
    measured = np.column_stack(read.agg_data())
    assert np.allclose(measured[1:], by_definition(V, sphere.astype(float), F)[1:], atol=1e-4) and not measured[0].any()
    # Scaled to the same area by default, as in the report.
    run("measure", "map.ply", "map.json", "lh.pial", "-o", "map.npy")
    free = np.load(tmp_path / "map.npy")
    shift = measured[1:, 1] - free[1:, 1]
    assert np.allclose(shift, shift[0], atol=1e-5) and np.allclose(free[1:, 2], measured[1:, 2], atol=1e-5)
    report = json.loads((tmp_path / "map.json").read_text())
    assert np.isclose(report["distortion"]["strain"]["J"]["mean"], free[1:, 1].mean(), atol=1e-9)
    assert np.isclose(report["distortion"]["strain"]["R"]["percentiles"]["95"], np.percentile(free[1:, 2], 95), atol=1e-9)
    shown = json.loads(run("measure", "map.ply", "map.json", "lh.pial", "--json"))
    assert shown == report["distortion"]["strain"]
