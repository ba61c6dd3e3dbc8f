#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Draws OBJ files with a picture as their texture beside each other, seen from +z: what docs/make_pictures.sh shows of 'orbitutte map --texture'.

usage: draw_textured.py OUT.png OBJ TEXTURE.png [OBJ TEXTURE.png ...]
"""
import pathlib
import struct
import sys
import zlib

import numpy as np

SIDE, SAMPLES = 620, 2  # pixels, and samples along the side of each
LIGHT = np.array([-0.35, 0.55, 0.8]) / np.linalg.norm([-0.35, 0.55, 0.8])


def read_obj(path):
    """Vertices, texture coordinates, and of every triangle the rows of both."""
    V, T, F = [], [], []
    for line in pathlib.Path(path).read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            V.append([float(x) for x in rest[:3]])
        elif word == "vt":
            T.append([float(x) for x in rest[:2]])
        elif word == "f":
            corners = [[int(index) - 1 for index in corner.split("/")[:2]] for corner in rest]
            F += [[corners[0], corners[k - 1], corners[k]] for k in range(2, len(corners))]
    return np.array(V), np.array(T), np.array(F)


def read_png(path):
    """height x width x 3, of a PNG of 8 bits without interlacing."""
    data = pathlib.Path(path).read_bytes()
    at, packed, header = 8, b"", None
    while at < len(data):
        length, = struct.unpack(">I", data[at:at + 4])
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + length]
        header = struct.unpack(">IIBBBBB", body) if kind == b"IHDR" else header
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    width, height, depth, colours = header[:4]
    channels = {2: 3, 6: 4}[colours]
    assert depth == 8 and header[6] == 0
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + channels * width)
    image = np.zeros((height, channels * width), np.uint8)
    for y in range(height):
        image[y] = unfiltered(int(rows[y, 0]), rows[y, 1:].astype(int), image[y - 1].astype(int) if y else np.zeros(channels * width, int), channels)
    return image.reshape(height, width, channels)[:, :, :3]


def unfiltered(kind, row, above, channels):
    if kind == 0:
        return row
    if kind == 2:
        return (row + above) % 256
    result = row.copy()
    for k in range(len(row)):
        left, corner = (result[k - channels], above[k - channels]) if k >= channels else (0, 0)
        near = min((abs(above[k] - corner), 0, left), (abs(left - corner), 1, above[k]), (abs(left + above[k] - 2 * corner), 2, corner))[2]
        result[k] = (row[k] + {1: left, 3: (left + above[k]) // 2, 4: near}[kind]) % 256
    return result


def write_png(path, image):
    height, width, _ = image.shape
    rows = b"".join(b"\0" + row.tobytes() for row in image)
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    body = b"".join(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks)
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + body)


def normals_of(V, F):
    normals = np.zeros_like(V)
    across = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    for k in range(3):
        np.add.at(normals, F[:, k], across)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)


def bilinear(texture, uv):
    height, width, _ = texture.shape
    x, y = uv[:, 0] * width - 0.5, (1 - uv[:, 1]) * height - 0.5
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    s, t = (x - left)[:, None], (y - top)[:, None]
    pixel = lambda i, j: texture[np.clip(j, 0, height - 1), np.clip(i, 0, width - 1)].astype(float)  # noqa: E731
    return (1 - t) * ((1 - s) * pixel(left, top) + s * pixel(left + 1, top)) + t * ((1 - s) * pixel(left, top + 1) + s * pixel(left + 1, top + 1))


def drawn(path, texture):
    """One mesh as SIDE x SIDE x 3."""
    V, T, F = read_obj(path)
    size = SIDE * SAMPLES
    low, high = V.min(axis=0), V.max(axis=0)
    place = (V - (low + high) / 2) * (0.92 * size / (high - low)[:2].max())
    place = place * [1, -1, 1] + [size / 2, size / 2, 0]
    normals = normals_of(V, F[:, :, 0])
    depth, image = np.full((size, size), -np.inf), np.full((size, size, 3), 255.0)
    for corners in F:
        at = place[corners[:, 0]]
        e, f = at[1, :2] - at[0, :2], at[2, :2] - at[0, :2]
        area = e[0] * f[1] - e[1] * f[0]
        if area >= 0:  # seen from behind, since y points down
            continue
        first, last = np.floor(at[:, :2].min(axis=0)).astype(int), np.ceil(at[:, :2].max(axis=0)).astype(int)
        x, y = np.meshgrid(np.arange(first[0], last[0] + 1), np.arange(first[1], last[1] + 1))
        d = np.stack([x.ravel(), y.ravel()], axis=1) - at[0, :2]
        s, t = (d[:, 0] * f[1] - d[:, 1] * f[0]) / area, (e[0] * d[:, 1] - e[1] * d[:, 0]) / area
        weights = np.stack([1 - s - t, s, t], axis=1)
        inside = weights.min(axis=1) >= -1e-9
        x, y, weights = x.ravel()[inside], y.ravel()[inside], weights[inside]
        z = weights @ at[:, 2]
        nearer = z > depth[y, x]
        x, y, weights = x[nearer], y[nearer], weights[nearer]
        normal = weights @ normals[corners[:, 0]]
        light = 0.45 + 0.55 * np.clip(normal @ LIGHT / np.maximum(np.linalg.norm(normal, axis=1), 1e-300), 0, 1)
        depth[y, x] = z[nearer]
        image[y, x] = bilinear(texture, weights @ T[corners[:, 1]]) * light[:, None]
    return np.clip(image.reshape(SIDE, SAMPLES, SIDE, SAMPLES, 3).mean(axis=(1, 3)), 0, 255).astype(np.uint8)


if __name__ == "__main__":
    if len(sys.argv) < 4 or len(sys.argv) % 2:
        sys.exit(__doc__)
    write_png(sys.argv[1], np.concatenate([drawn(mesh, read_png(texture)) for mesh, texture in zip(sys.argv[2::2], sys.argv[3::2])], axis=1))
