# SPDX-License-Identifier: MIT
"""Faults to plant in an embedding (a Ply) and its report: each changes them in place, so that no judge may accept them.

Those of the second part are for limbs: they work at the scale of the edges that are there, down to 1e-30, in offsets where the file
has them. They raise Skip where the embedding has no place for them.
"""
import numpy as np

from trials import Skip


def normalized(rows):
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


def move_across_edge(ply, report):
    """Reflects a vertex inside the tile across the opposite edge of one of its triangles."""
    held = np.zeros(len(ply.vertex), bool)
    for seam in report['seams']:
        held[seam['left']] = held[seam['right']] = True
    face = ply.faces[np.flatnonzero(~held[ply.faces].any(axis=1))[0]]
    x = ply.positions
    normal = normalized(np.cross(x[face[1]], x[face[2]]))
    moved = x[face[0]] - 2 * (x[face[0]] @ normal) * normal
    x[face[0]] = moved / np.linalg.norm(moved)
    ply.positions = x


MIRROR = np.diag([1.0, 1.0, -1.0])


def mirror_positions(ply, report):
    """The positions alone: now the seams do not match either."""
    ply.positions = ply.positions @ MIRROR


def mirror_map(ply, report):
    """Positions and seams: everything still fits, but every triangle is turned over."""
    mirror_positions(ply, report)
    for seam in report['seams']:
        seam['transform'] = (MIRROR @ np.array(seam['transform']) @ MIRROR).tolist()


def claim_another_group_order(ply, report):
    report['orbifold']['group_order'] *= 2


def claim_another_signature(ply, report):
    signature = report['orbifold']['signature']
    other = {'432': '532', '33': '44', '*432': '*532', '3*2': '2*6', '5*': '6*', '3x': '4x', '1': '432', '*': '*432'}[signature]
    orders = {'532': 60, '44': 4, '*532': 120, '2*6': 24, '6*': 12, '4x': 8, '432': 24, '*432': 48}
    report['orbifold'] = {'signature': other, 'group_order': orders[other]}


def claim_another_energy(ply, report):
    report['energy'] *= 1 + 1e-6


def claim_another_area(ply, report):
    report['certificate']['expected_area'] *= 1 + 1e-6


def exchange_seam_transform(ply, report):
    """A seam with a transform that is not its own."""
    seam = report['seams'][0]
    about_x = np.array([[1, 0, 0], [0, np.cos(1), -np.sin(1)], [0, np.sin(1), np.cos(1)]])
    seam['transform'] = (about_x @ np.array(seam['transform']) @ about_x.T).tolist()


def cover_twice(ply, report):
    """Doubles the longitude of a lune onto half the sphere: it covers all of it, every triangle positively oriented."""
    x = ply.positions
    axis = x[report['cones'][0]['copies'][0]]
    right = normalized(np.cross(axis, [0.3, 0.5, 0.7]))
    front = np.cross(right, axis)
    height = x @ axis
    radius = np.sqrt(np.maximum(0, 1 - height**2))
    longitude = 2 * np.arctan2(x @ right, x @ front)
    x = height[:, None] * axis + radius[:, None] * (np.cos(longitude)[:, None] * front + np.sin(longitude)[:, None] * right)
    ply.positions = normalized(x)
    for seam in report['seams']:
        seam['transform'] = (np.array(seam['transform']) @ np.array(seam['transform'])).tolist()


def cover_twice_and_claim_it(ply, report):
    """The same, and the report claims the area that is there."""
    cover_twice(ply, report)
    certificate = report['certificate']
    certificate['signed_area'] = certificate['expected_area'] = 4 * np.pi
    report['orbifold']['group_order'] = 1


# Faults at the scale of a limb's edges.

MOST_OFFSETS = 4


def exact_cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def exact_dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def exact_orientation(ply, face):
    """The sign of det[a b c] of the positions, offsets included."""
    a, b, c = (ply.exact_position(int(v)) for v in face)
    determinant = exact_dot(a, exact_cross(b, c))
    return (determinant > 0) - (determinant < 0)


def exact_length(ply, a, b):
    """The chord, from the exact difference; its square may be too small for a double."""
    difference = [x - y for x, y in zip(ply.exact_position(a), ply.exact_position(b))]
    largest = float(max(map(abs, difference)))
    return largest * float(np.linalg.norm([float(d) / largest for d in difference])) if largest > 0 else 0.0


def longest_edges(ply):
    """The longest chord of every face; exact where a vertex has offsets."""
    x, faces = ply.positions, ply.faces
    lengths = np.stack([np.linalg.norm(x[faces[:, k]] - x[faces[:, k - 2]], axis=1) for k in range(3)], 1)
    touched = np.isin(faces, list(ply.offset_vertices()))
    for f, k in np.argwhere((touched | np.roll(touched, -1, axis=1)) & (lengths < 1e-6)):
        lengths[f, k] = exact_length(ply, int(faces[f, k]), int(faces[f, k - 2]))
    return lengths.max(axis=1)


def seam_vertices(report):
    return sorted({v for seam in report['seams'] for bank in ('left', 'right') for v in seam[bank]})


def reflect_across_edge(ply, face, corner, most_offsets):
    """Moves a corner of a triangle to its mirror image in the plane through the opposite edge and the centre: exactly, then rounded."""
    a, b, c = (ply.exact_position(int(face[(corner + k) % 3])) for k in range(3))
    normal = exact_cross(b, c)
    factor = 2 * exact_dot(a, normal) / exact_dot(normal, normal)
    ply.place(int(face[corner]), [x - factor * n for x, n in zip(a, normal)], most_offsets)


def turn_face(ply, face, corner):
    """Turns the triangle over: in doubles if they can say so and the corner has no offsets, otherwise in offsets."""
    choices = [MOST_OFFSETS] if int(face[corner]) in ply.offset_vertices() else [0, MOST_OFFSETS]
    vertex, offset = ply.vertex, ply.offset
    for most_offsets in choices:
        ply.vertex, ply.offset = vertex.copy(), offset
        reflect_across_edge(ply, face, corner, most_offsets)
        if exact_orientation(ply, face) < 0:
            return
    raise Skip('the triangle cannot be turned over')


def turn_face_of_length(decade):
    """A fault: turns over a triangle whose longest edge is 1e-`decade` or up to ten times that, by a vertex off all seams."""
    def plant(ply, report):
        lengths, seams = longest_edges(ply), seam_vertices(report)
        free = ~np.isin(ply.faces, seams)
        found = np.flatnonzero((lengths >= 10.0**-decade) & (lengths < 10.0**(1 - decade)) & free.any(axis=1))
        if not len(found):
            raise Skip(f'no triangle has edges of 1e-{decade}')
        face = found[len(found) // 2]
        turn_face(ply, ply.faces[face], int(np.flatnonzero(free[face])[0]))
    plant.__name__ = f'turn_face_of_1e-{decade}'
    return plant


def shortest_seam_edge(ply, report):
    """(seam, k): where a left bank's edge from its vertex k to k + 1, both off the cones, is shortest."""
    cones = {v for cone in report['cones'] for v in cone['copies']}
    found = [(exact_length(ply, *seam['left'][k:k + 2]), s, k) for s, seam in enumerate(report['seams'])
             for k in range(len(seam['left']) - 1) if cones.isdisjoint(seam['left'][k:k + 2])]
    if not found:
        raise Skip('no edge of a seam is off the cones')
    _, s, k = min(found)
    return report['seams'][s], k


def exchange_vertices(ply, a, b):
    at_a, at_b = ply.exact_position(a), ply.exact_position(b)
    most_offsets = MOST_OFFSETS if len(ply.offset) else 0
    ply.place(a, at_b, most_offsets)
    ply.place(b, at_a, most_offsets)


def exchange_seam_vertices(ply, report):
    """Two neighbours on a seam where its edges are shortest, on both banks: the seam still matches."""
    seam, k = shortest_seam_edge(ply, report)
    for bank in {tuple(seam['left']), tuple(seam['right'])}:
        exchange_vertices(ply, bank[k], bank[k + 1])


def two_banked_edge(ply, report):
    seam, k = shortest_seam_edge(ply, report)
    if seam['left'] == seam['right']:
        raise Skip('the seam is a mirror')
    return seam['left'][k], seam['left'][k + 1]


def exchange_on_one_bank(ply, report):
    """The same on the left bank alone."""
    exchange_vertices(ply, *two_banked_edge(ply, report))


def part_seam(ply, report):
    """Moves a vertex of one bank alone, by a twentieth of the shortest edge of a seam: all triangles may stay positive."""
    a, b = two_banked_edge(ply, report)
    length, with_offsets = exact_length(ply, a, b), len(ply.offset) > 0
    if length < 1e-12 and not with_offsets:
        raise Skip(f'an edge of {length:.0e}: a twentieth of it is rounding')
    moved = [x + (y - x) / 20 for x, y in zip(ply.exact_position(a), ply.exact_position(b))]
    ply.place(a, moved, MOST_OFFSETS if with_offsets else 0)


def need_offsets(ply):
    if not len(ply.offset):
        raise Skip('the file has no offsets')
    ply.offset = ply.offset.copy()


def lift_off_sphere(ply, report):
    """An offset along the position itself, which no triangle sees; the doubles alone are still on the sphere."""
    need_offsets(ply)
    v = int(ply.offset['vertex'][0])
    along = [(v, *(float(ply.vertex[axis][v]) / 1000 for axis in 'xyz'))]
    ply.offset = np.concatenate([ply.offset, np.array(along, ply.offset.dtype)])


def offset_that_is_no_number(ply, report):
    need_offsets(ply)
    ply.offset['dx'][0] = np.nan


def offset_of_no_vertex(ply, report):
    need_offsets(ply)
    ply.offset['vertex'][0] = len(ply.vertex)


def leave_out_offsets(ply, report):
    """The doubles alone, where they do not suffice."""
    need_offsets(ply)
    touched = np.isin(ply.faces, list(ply.offset_vertices())).any(axis=1)
    ply.offset = ply.offset[:0]
    if all(exact_orientation(ply, face) > 0 for face in ply.faces[touched]):
        raise Skip('the doubles suffice')


LIMB_FAULTS = [*(turn_face_of_length(decade) for decade in range(2, 31)), exchange_seam_vertices, exchange_on_one_bank, part_seam,
               leave_out_offsets, lift_off_sphere, offset_that_is_no_number, offset_of_no_vertex]
