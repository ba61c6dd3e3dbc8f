# SPDX-License-Identifier: MIT
# A value at every vertex of one surface, carried over to another one by the map between both, and drawn on both: heat_map.svg. Between the
# landmarks the map follows angles, so it fits where limbs keep their proportions.
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

marks = orbitutte.choose_cones(V, F, "432")  # head, foot and hand
tips = [int(np.argmin(np.linalg.norm(W - with_large_head(V[mark][None]), axis=1))) for mark in marks]
surface_map = orbitutte.map_between((W, G), (V, F), list(zip(tips, marks)))

heat = np.linalg.norm(V - V[marks[2]], axis=1)  # warm at the third landmark
heat = 1 - heat / heat.max()
carried = surface_map.pull(heat)  # at the vertices of the second surface

with open("heat_map.svg", "w", encoding="utf-8") as file:
    file.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 520 320" width="520" height="320"><rect width="100%" height="100%" fill="white"/>\n')
    file.write(drawing(V, F, heat, 140) + "\n" + drawing(W, G, carried, 380) + "\n</svg>\n")
print(f"{len(W)} values carried over, from {carried.min():.3f} to {carried.max():.3f}; see heat_map.svg")
assert surface_map.bijective and carried.min() >= 0 and carried.max() <= 1
assert np.array_equal(carried[tips], heat[marks])  # landmarks are matched exactly
