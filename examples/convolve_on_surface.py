# SPDX-License-Identifier: MIT
# Convolutions on a surface that respect its seams: a network needs images, indices and weights, and no geometry. The margins of images are made by
# the group of 442: on the torus that covers the surface four times, and on a single tile.
# PYTHONPATH=build/python python3 examples/convolve_on_surface.py
import numpy as np
import orbitutte

V, F = orbitutte.sample_mesh("figure", 8000)
embedding = orbitutte.embed(V, F, "442", orbitutte.choose_cones(V, F, "442"))
torus = orbitutte.Resampler(embedding, "periodic:128")
tile = orbitutte.Resampler(embedding, "tile:64")


def convolve(image, kernel, indices):
    """image: h x w x c; kernel: 3 x 3 x c x d; indices: (h + 2) x (w + 2), which a training loop keeps. With a ReLU: h x w x d."""
    margin = image.reshape(-1, image.shape[-1])[indices]
    windows = np.lib.stride_tricks.sliding_window_view(margin, (3, 3), axis=(0, 1))
    return np.maximum(0, np.einsum("hwcij,ijcd->hwd", windows, kernel))


def convolve_with_zeros(image, kernel):
    margin = np.pad(image, [(1, 1), (1, 1), (0, 0)])
    windows = np.lib.stride_tricks.sliding_window_view(margin, (3, 3), axis=(0, 1))
    return np.maximum(0, np.einsum("hwcij,ijcd->hwd", windows, kernel))


random = np.random.default_rng(1)
first, second = random.normal(size=(3, 3, 3, 8)), random.normal(size=(3, 3, 8, 2))
around = torus.pad_indices(1)
image = torus(V)  # 128 x 128 x 3: where each pixel lies on the surface
features = convolve(convolve(image, first, around), second, around)

# The torus has no border: a shifted image gives shifted features.
shifted = np.roll(image, (50, 17), axis=(0, 1))
moved = convolve(convolve(shifted, first, around), second, around)
error = np.abs(np.roll(features, (50, 17), axis=(0, 1)) - moved).max() / np.abs(features).max()
zeros = convolve_with_zeros(convolve_with_zeros(image, first), second)
zeros_moved = convolve_with_zeros(convolve_with_zeros(shifted, first), second)
zeros_error = np.abs(np.roll(zeros, (50, 17), axis=(0, 1)) - zeros_moved).max() / np.abs(zeros).max()
print(f"features of a shifted image differ by {error:.1e}; with zeros around the image by {zeros_error:.1e}")

# Four sheets lie over each vertex, turned by right angles; their mean is its feature.
on_surface = torus.back(features)
print(f"features at {on_surface.shape[0]} vertices: {on_surface.shape[1]} each")

# A kernel that looks alike from all sides needs a single tile, whose margin is turned about the cones.
blur = np.array([[1, 2, 1], [2, 4, 2], [1, 2, 1]])[:, :, None, None] / 16 * np.eye(3)
small, large = np.abs(tile(V)), np.abs(image)  # ReLU keeps them
for _ in range(10):
    small, large = convolve(small, blur, tile.pad_indices(1)), convolve(large, blur, around)
error_of_tile = np.abs(small - large[64:, :64]).max()
print(f"after ten blurs, the tile differs from its part of the torus by {error_of_tile:.1e}")
assert error < 1e-12 < zeros_error and error_of_tile < 1e-11
