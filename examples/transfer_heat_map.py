# SPDX-License-Identifier: MIT
# A value at every vertex of one surface, carried over to another one through common cones, and drawn on both: heat_map.svg. Between the cones
# the map follows angles, so it fits where limbs keep their proportions.
# PYTHONPATH=build/python python3 examples/transfer_heat_map.py
import numpy as np
import orbitutte


def with_large_head(V):
    """The figure after an inversion in a sphere above its head, mirrored back: another shape with the same angles."""
    centre = np.array([0, 3.5, 0])
    away = V - centre
    moved = centre + 11 * away / (away**2).sum(axis=1, keepdims=True)
    return moved * [1, -1, 1]


def drawing(V, F, values, left):
    """The triangles as SVG, seen from +z, the farthest first; values 0..1 from blue over white to red."""
    points = np.stack([left + 125 * V[:, 0], 165 - 125 * V[:, 1]], axis=1)
    normals = np.cross(V[F[:, 1]] - V[F[:, 0]], V[F[:, 2]] - V[F[:, 0]])
    light = 0.35 + 0.65 * np.abs(normals @ [0.3, 0.4, 0.87]) / np.linalg.norm(normals, axis=1)
    t = values[F].mean(axis=1)
    bands = np.where(np.floor(t * 24) % 2, 0.8, 1.0)
    rgb = np.stack([np.minimum(1, 2 * t), 1 - np.abs(2 * t - 1), np.minimum(1, 2 - 2 * t)], axis=1) * (light * bands)[:, None]
    lines = []
    for f in np.argsort(V[F].mean(axis=1)[:, 2]):
        colour = "#%02x%02x%02x" % tuple((255 * rgb[f]).astype(int))
        corners = " ".join("%.1f,%.1f" % tuple(point) for point in points[F[f]])
        lines.append(f'<polygon points="{corners}" fill="{colour}" stroke="{colour}" stroke-width="0.4"/>')
    return "\n".join(lines)


V, F = orbitutte.sample_mesh("figure", 8000)
W, G = orbitutte.sample_mesh("figure", 6000)  # other vertices, other triangles, another shape
W = with_large_head(W)

first = orbitutte.embed(V, F, "432", orbitutte.choose_cones(V, F, "432"))
tips = [int(np.argmin(np.linalg.norm(W - with_large_head(V[cone.vertex][None]), axis=1))) for cone in first.cones]
second = orbitutte.embed(W, G, "432", tips)

heat = np.linalg.norm(V - V[first.cones[2].vertex], axis=1)  # warm at the third cone
heat = 1 - heat / heat.max()

where = first.locate(second.canonical_positions[: len(W)])  # every vertex of the second surface, on the first one
corners = first.source_vertex[first.triangles[where.triangle]]
carried = np.einsum("vk,vk->v", heat[corners], where.barycentric)

with open("heat_map.svg", "w", encoding="utf-8") as file:
    file.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 520 320" width="520" height="320"><rect width="100%" height="100%" fill="white"/>\n')
    file.write(drawing(V, F, heat, 140) + "\n" + drawing(W, G, carried, 380) + "\n</svg>\n")
print(f"{len(W)} values carried over, from {carried.min():.3f} to {carried.max():.3f}; see heat_map.svg")
assert first.bijective and second.bijective and carried.min() >= 0 and carried.max() <= 1
