# SPDX-License-Identifier: MIT
"""Values from surfaces to grids and back."""
import numpy as np
import orbitutte
import pytest


@pytest.fixture(scope="module")
def sphere():
    return orbitutte.embed(*orbitutte.sample_mesh("figure", 3000), "sphere")


@pytest.fixture(scope="module")
def torus():
    V, F = orbitutte.sample_mesh("figure", 1000)
    return orbitutte.embed(V, F, "442", orbitutte.choose_cones(V, F, "442"))


GRIDS = ["ico:5", "healpix:32", "healpix-nested:32", "octahedral:100", "equirectangular:200x100", "cube:40"]


@pytest.mark.parametrize("grid", GRIDS)
def test_positions_on_the_sphere_are_those_of_the_grid(sphere, grid):
    resampler = orbitutte.Resampler(sphere, grid)
    p = sphere.canonical_positions[:len(sphere.mesh[0])]
    values = resampler(p)
    assert values.shape == resampler.shape + (3,)
    flat = values.reshape(-1, 3)
    assert np.abs(flat / np.linalg.norm(flat, axis=1)[:, None] - resampler.points).max() < 1e-12
    assert np.abs(resampler.back(values) - p).max() < 0.02
    assert abs(resampler.areas.sum() - 4 * np.pi) < 1e-11


@pytest.mark.parametrize("grid", GRIDS)
def test_conservative_values_keep_the_integral(sphere, grid):
    V = sphere.mesh[0]
    resampler = orbitutte.Resampler(sphere, grid, "conservative")
    f = np.random.default_rng(3).normal(size=(len(V), 2))
    g = resampler(f).reshape(-1, 2)
    scale = (resampler.vertex_areas @ np.abs(f)).max()
    assert np.abs(resampler.surface_areas @ g - resampler.vertex_areas @ f).max() < 1e-12 * scale
    back = resampler.back(resampler(f))
    assert np.abs(resampler.vertex_areas @ back - resampler.vertex_areas @ f).max() < 1e-12 * scale
    assert np.abs(resampler(np.ones(len(V))) - 1).max() < 1e-13


def test_least_squares_come_back_better_than_linear_values(sphere):
    V = sphere.mesh[0]
    linear, fitted = (orbitutte.Resampler(sphere, "ico:6", kind) for kind in ("linear", "least-squares"))

    off = {resampler.kind: np.linalg.norm(resampler.back(resampler(V)) - V, axis=1) for resampler in (linear, fitted)}
    assert np.linalg.norm(off["least-squares"]) < np.linalg.norm(off["linear"])  # most of it in limbs, below the distance of the points
    assert np.median(off["least-squares"]) < 0.1 * np.median(off["linear"])
    assert np.abs(fitted(np.ones(len(V))) - 1).max() < 1e-12
    with pytest.raises(orbitutte.ArgumentError, match="no product with a table"):
        fitted.table()
    assert (fitted.back_table().weights == linear.back_table().weights).all()
    with pytest.raises(orbitutte.ArgumentError, match="take nearest"):
        fitted(np.zeros(len(V), dtype=int))


def test_conservative_labels_keep_their_areas(sphere):
    V = sphere.mesh[0]
    resampler = orbitutte.Resampler(sphere, "ico:6", "conservative")
    labels = (V[:, 1] > V[:, 1].mean()) + 2 * (V[:, 0] > V[:, 0].mean())
    there = resampler(labels)
    back = resampler.back(there)
    wanted = np.bincount(labels, resampler.vertex_areas)
    assert there.dtype == labels.dtype
    assert np.abs(np.bincount(there, resampler.surface_areas) / wanted - 1).max() < 0.01
    assert np.abs(np.bincount(back, resampler.vertex_areas) / wanted - 1).max() < 0.02


def test_the_table_is_all_that_a_loop_needs(sphere):
    pytest.importorskip("scipy")
    V = sphere.mesh[0]
    resampler = orbitutte.Resampler(sphere, "ico:4")
    table = resampler.table()
    assert table.shape == (2562, len(V)) and table.indices.dtype == np.int32
    assert np.allclose(resampler.matrix() @ V, resampler(V), atol=1e-13)
    assert np.allclose(resampler.back_table().matrix() @ resampler(V), resampler.back(resampler(V)), atol=1e-13)


def test_labels_stay_labels(sphere):
    labels = (sphere.mesh[0][:, 1] > 0).astype(np.uint8) * 7
    on_grid = orbitutte.resample(sphere, labels, "healpix:16")
    assert on_grid.dtype == np.uint8 and set(np.unique(on_grid)) == {0, 7}
    back = orbitutte.Resampler(sphere, "ico:6", "nearest").back(orbitutte.resample(sphere, labels, "ico:6"))
    assert (back != labels).mean() < 0.02


def test_healpix_is_that_of_the_field(sphere):
    healpix = pytest.importorskip("astropy_healpix")
    units = pytest.importorskip("astropy.units")
    random = np.random.default_rng(5)
    for side, order in ((1, "ring"), (4, "ring"), (32, "ring"), (1, "nested"), (32, "nested")):
        pixels = healpix.HEALPix(nside=side, order=order)
        longitude, latitude = pixels.healpix_to_lonlat(np.arange(pixels.npix))
        theirs = np.stack([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=1)
        resampler = orbitutte.Resampler(sphere, f"healpix:{side}" if order == "ring" else f"healpix-nested:{side}")
        assert np.abs(resampler.points - np.asarray(theirs)).max() < 1e-14
        # Between the pixels; they want longitudes from 0.
        values = random.normal(size=pixels.npix)
        p = sphere.canonical_positions[:len(sphere.mesh[0])]
        p_off_poles = np.hypot(p[:, 0], p[:, 1]) > 1e-6  # at a pole they have NaN
        longitude, latitude = np.arctan2(p[:, 1], p[:, 0]) % (2 * np.pi), np.arctan2(p[:, 2], np.hypot(p[:, 0], p[:, 1]))
        theirs = pixels.interpolate_bilinear_lonlat(longitude[p_off_poles] * units.rad, latitude[p_off_poles] * units.rad, values)
        assert np.isfinite(resampler.back(values)).all() and p_off_poles.mean() > 0.99
        assert np.abs(resampler.back(values)[p_off_poles] - theirs).max() < 1e-9


@pytest.mark.parametrize("grid", ["periodic:40", "tile:40"])
def test_margins_are_those_of_the_group(torus, grid):
    """Pixels of the margin lie, up to an element of the group, where they are taken from."""
    resampler = orbitutte.Resampler(torus, grid)
    indices = resampler.pad_indices(3)
    assert indices.shape == (46, 46) and (indices[3:-3, 3:-3] == np.arange(1600).reshape(40, 40)).all()
    image = resampler.points.reshape(40, 40, 3)
    right, down = image[0, 1] - image[0, 0], image[1, 0] - image[0, 0]
    for row, column in ((0, 0), (0, 20), (20, 1), (45, 45), (44, 2), (30, 45)):
        place = image[0, 0] + (column - 3) * right + (row - 3) * down
        images = torus.group @ resampler.points[indices[row, column]]
        assert np.linalg.norm(images - place, axis=1).min() < 1e-12
    assert (resampler.pad(image, 3) == resampler.points[indices]).all()


def test_spheres_of_others_are_grids(sphere):
    V, F = sphere.canonical_positions[:len(sphere.mesh[0])], sphere.triangles
    resampler = orbitutte.Resampler(sphere, (100 * V, F))
    assert np.abs(resampler(sphere.mesh[0]) - sphere.mesh[0]).max() < 1e-9


def test_what_does_not_fit_is_told(sphere, torus):
    with pytest.raises(orbitutte.ArgumentError, match="it may be ico"):
        orbitutte.Resampler(sphere, "icosahedron:3")
    with pytest.raises(orbitutte.ArgumentError, match="kind is 'cubic'"):
        orbitutte.Resampler(sphere, "ico:3", "cubic")
    with pytest.raises(orbitutte.ArgumentError, match="take periodic"):
        orbitutte.Resampler(torus, "ico:3")
    with pytest.raises(orbitutte.ArgumentError, match="there are .* vertices"):
        orbitutte.Resampler(sphere, "ico:3")(np.zeros(7))
    with pytest.raises(orbitutte.ArgumentError, match="that of the grid is"):
        orbitutte.Resampler(sphere, "cube:4").back(np.zeros((4, 4)))
    with pytest.raises(orbitutte.ArgumentError, match="only images"):
        orbitutte.Resampler(sphere, "ico:3").pad_indices(1)
    with pytest.raises(TypeError, match="real numbers"):
        orbitutte.Resampler(sphere, "ico:3")(np.array(["a"] * len(sphere.mesh[0])))
