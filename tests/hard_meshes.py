# SPDX-License-Identifier: MIT
"""The hard set: generated meshes, the same on every run, of the kinds on which maps into orbifolds have failed.

Each kind is one function, which yields pairs of a variant's name and a function that makes the mesh. All are valid: closed surfaces or
disks with simple edges, and 3-connected but where `arcs` says that faces must become arcs.
"""
import functools
import itertools
import random
from typing import NamedTuple

import numpy as np


class HardMesh(NamedTuple):
    vertices: np.ndarray
    faces: list  # triples of vertices
    orbifold: str
    cones: str  # as --cones takes them
    arcs: int = 0  # so many faces must become arcs, for the mesh is not 3-connected


KINDS = {}


def kind(function):
    KINDS[function.__name__] = function
    return function


def generated():
    """All of the set that is generated: the name KIND/VARIANT -> the function that makes the mesh."""
    return {f'{name}/{variant}': make for name, variants_of in KINDS.items() for variant, make in variants_of()}


def variants(make, *choices):
    """Pairs of the name and the function for every combination of the choices."""
    for combination in itertools.product(*choices):
        yield ','.join(map(str, combination)), functools.partial(make, *combination)


# Surfaces to start from.

def ball(level):
    """An icosahedron, divided `level` times; its corners 0 .. 11 have five neighbours, all others six."""
    golden = (1 + 5**0.5) / 2
    vertices = [(s, t * golden, 0) for t in (1, -1) for s in (-1, 1)]
    vertices += [(0, s, t * golden) for t in (1, -1) for s in (-1, 1)] + [(t * golden, 0, s) for t in (1, -1) for s in (-1, 1)]
    vertices = np.array(vertices) / np.linalg.norm(vertices[0])
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    return sphere_of(vertices, faces, level)


def sphere_of(vertices, faces, level):
    vertices = [np.array(v, float) for v in vertices]
    for _ in range(level):
        middles = {}

        def middle(a, b):
            key = min(a, b), max(a, b)
            if key not in middles:
                middles[key] = len(vertices)
                point = vertices[a] + vertices[b]
                vertices.append(point / np.linalg.norm(point))
            return middles[key]

        divided = []
        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            divided += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = divided
    return outward(np.array(vertices), faces)


def outward(vertices, faces):
    """Turns all faces if the first one looks inward."""
    a, b, c = vertices[list(faces[0])]
    return vertices, faces if np.dot(a, np.cross(b, c)) > 0 else [face[::-1] for face in faces]


def cells_disk(cells):
    """A disk of unit squares, each given by its lower left corner and divided by a diagonal that runs into convex corners.

    Returns vertices, faces, and the vertex at every lattice point.
    """
    cells = sorted(cells)
    inside, at = set(cells), {}
    for i, j in cells:
        for point in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
            at.setdefault(point, len(at))
    faces = []
    for i, j in cells:
        a, b, c, d = (at[point] for point in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)))
        alone = [not inside & {(i + di, j), (i, j + dj), (i + di, j + dj)} for di, dj in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        rising = not (alone[1] or alone[3]) or alone[0] or alone[2]
        faces += [(a, b, c), (a, c, d)] if rising else [(a, b, d), (b, c, d)]
    return np.array([(x, y, 0.0) for x, y in at], float), faces, at


def square(n):
    """A disk of n x n squares, and its four corners counterclockwise."""
    vertices, faces, at = cells_disk(itertools.product(range(n), range(n)))
    return vertices, faces, [at[point] for point in ((0, 0), (n, 0), (n, n), (0, n))]


def words(cones):
    return ','.join(map(str, cones))


# What makes them hard.

def link(faces, vertex):
    """The neighbours of a vertex inside, counterclockwise."""
    after = {}
    for face in faces:
        if vertex in face:
            k = face.index(vertex)
            after[face[k - 2]] = face[k - 1]
    ring = [min(after)]
    while after[ring[-1]] != ring[0]:
        ring.append(after[ring[-1]])
    return ring


def with_limb(vertices, faces, vertex, rings):
    """Draws the star of a vertex inside out to a tube of so many rings; the vertex becomes its tip.

    Returns vertices, faces and the last ring. On a tube of m vertices around, a map that keeps angles shrinks by about exp(-2 pi/m)
    from ring to ring.
    """
    ring = link(faces, vertex)
    points = vertices[ring]
    a, b, c = points[0], points[len(ring) // 3], points[2 * len(ring) // 3]
    normal = np.cross(b - a, c - a)
    step = normal / np.linalg.norm(normal) * np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).mean()
    faces = [face for face in faces if vertex not in face]
    grown, count = [vertices], len(vertices)
    for k in range(1, rings + 1):
        grown.append(points + k * step)
        above = list(range(count, count + len(ring)))
        count += len(ring)
        for p, q, r, s in zip(ring, ring[1:] + ring[:1], above, above[1:] + above[:1]):
            faces += [(p, q, s), (p, s, r)]
        ring = above
    faces = faces + [(p, q, vertex) for p, q in zip(ring, ring[1:] + ring[:1])]
    vertices = np.concatenate(grown)
    vertices[vertex] = points.mean(0) + (rings + 0.5) * step
    return vertices, faces, ring


def with_limbs(vertices, faces, places, rings):
    for vertex in places:
        vertices, faces, _ = with_limb(vertices, faces, vertex, rings)
    return vertices, faces


def with_branches(vertices, faces, vertex, trunk, branches):
    """A limb whose last ring but two has two limbs of its own; returns the tips of all three as well."""
    vertices, faces, ring = with_limb(vertices, faces, vertex, trunk)
    first = ring[0] - 2 * len(ring)
    tips = [vertex, first, first + len(ring) // 2]
    return *with_limbs(vertices, faces, tips[1:], branches), tips


def inner_vertices(faces):
    """The vertices off the boundary, ascending."""
    directed = {(face[k - 1], face[k]) for face in faces for k in range(3)}
    boundary = {v for a, b in directed if (b, a) not in directed for v in (a, b)}
    return sorted({v for face in faces for v in face} - boundary)


def on_dyadic_lattice(vertices):
    """Rounds coordinates so that midpoints of edges are exact."""
    return np.round(vertices * 2**20) / 2**20


def divide_faces(vertices, faces, chosen, place):
    """Puts a vertex, which place(a, b, c) says, into each chosen face."""
    points, result = list(vertices), []
    for f, (a, b, c) in enumerate(faces):
        if f in chosen:
            new = len(points)
            points.append(place(*vertices[[a, b, c]]))
            result += [(a, b, new), (b, c, new), (c, a, new)]
        else:
            result.append((a, b, c))
    return np.array(points), result


# Limbs. The cones of spheres are among the icosahedron's corners 0 .. 11, limbs grow on others.

BODY_CONES = {'532': '0,1,2', '432': '0,3,9', '332': '0,1,2', '223': '0,3,8', '225': '0,3,9', '2,2,12': '0,1,2', '22': '0,3', '44': '0,3',
              '55': '0,8', '442': '0,3,9', '333': '0,1,2', '632': '0,1,2', '2222': '0,1,3,2'}
SQUARE = 8


def disk_cones(signature, corners, inside):
    """Cones of a disk in the order of its symbol: one inside if it has one, then corners counterclockwise."""
    before, _, after = signature.partition('*')
    return words(([inside] if before else []) + corners[:len(after)])


def limb_mesh(orbifold, rings):
    vertices, faces = with_limbs(*ball(1), [6], rings)
    return HardMesh(vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def limb():
    """One limb without a cone; after 37 rings areas are below 1e-40."""
    yield from variants(limb_mesh, ['532', '225', '44', '442'], [6, 10, 14, 18, 22, 26, 30, 34, 38, 42, 50])


def several_limbs_mesh(orbifold, count, rings):
    vertices, faces = with_limbs(*ball(2), [6, 10, 5, 4, 7, 11][:count], rings)
    return HardMesh(vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def several_limbs():
    yield from variants(several_limbs_mesh, ['432', '332', '2222'], [2, 4, 6], [12, 24, 40])


def branching_limb_mesh(orbifold, trunk, branches):
    vertices, faces, _ = with_branches(*ball(1), 6, trunk, branches)
    return HardMesh(vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def branching_limb():
    yield from variants(branching_limb_mesh, ['432', '55'], [8, 16, 24], [8, 20])


def cone_at_tip_mesh(orbifold, rings):
    vertices, faces = with_limbs(*ball(1), [6], rings)
    cones = BODY_CONES[orbifold].split(',')
    return HardMesh(vertices, faces, orbifold, words([*cones[:-1], 6]))


@kind
def cone_at_tip():
    """The cut runs along the limb, which shrinks by the order's root."""
    yield from variants(cone_at_tip_mesh, ['532', '22', '44', '2222', '442'], [12, 24, 36, 48, 72])


def cone_on_branch_mesh(orbifold, trunk, branches):
    vertices, faces, tips = with_branches(*ball(1), 6, trunk, branches)
    cones = BODY_CONES[orbifold].split(',')
    return HardMesh(vertices, faces, orbifold, words([*cones[:-1], tips[1]]))


@kind
def cone_on_branch():
    """The cut runs through the trunk and one branch; the other tips have no cone."""
    yield from variants(cone_on_branch_mesh, ['432', '22', '2222'], [8, 24], [10, 30])


def cones_in_limb_mesh(orbifold, rings):
    """All cones but the first around a limb's end: the whole body is beyond a limb for them."""
    vertices, faces, ring = with_limb(*ball(1), 6, rings)
    cones = [0, 6, ring[0] - len(ring), ring[2] - 2 * len(ring)]
    return HardMesh(vertices, faces, orbifold, words(cones[:len(BODY_CONES[orbifold].split(','))]))


@kind
def cones_in_limb():
    yield from variants(cones_in_limb_mesh, ['432', '532', '2222'], [8, 16, 32])


def disk_limb_mesh(orbifold, rings):
    vertices, faces, corners = square(SQUARE)
    inside = inner_vertices(faces)
    middle = int(np.argmin(np.linalg.norm(vertices - [SQUARE / 2, SQUARE / 2, 0], axis=1)))
    aside = int(np.argmin(np.linalg.norm(vertices - [2, 3, 0], axis=1)))
    assert middle in inside and aside in inside
    vertices, faces = with_limbs(vertices, faces, [middle], rings)
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, corners, aside))


@kind
def disk_limb():
    yield from variants(disk_limb_mesh, ['*432', '3*2', '*22', '4*', '*442', '*2222'], [10, 20, 30, 44])


def cone_at_disk_tip_mesh(orbifold, rings):
    vertices, faces, corners = square(SQUARE)
    middle = int(np.argmin(np.linalg.norm(vertices - [SQUARE / 2, SQUARE / 2, 0], axis=1)))
    vertices, faces = with_limbs(vertices, faces, [middle], rings)
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, corners, middle))


@kind
def cone_at_disk_tip():
    yield from variants(cone_at_disk_tip_mesh, ['3*2', '2*3', '5*'], [12, 30, 48])


def strip_cells(width, length):
    """A square with a strip from the middle of its upper side."""
    cells = set(itertools.product(range(SQUARE), range(SQUARE)))
    return cells | set(itertools.product(range(3, 3 + width), range(SQUARE, SQUARE + length)))


def strip_mesh(orbifold, width, length):
    vertices, faces, at = cells_disk(strip_cells(width, length))
    corners = [at[point] for point in ((0, 0), (SQUARE, 0), (SQUARE, SQUARE), (0, SQUARE))]
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, corners, at[(4, 3)]))


@kind
def strip():
    """A limb between mirrors: a strip of w squares shrinks by about exp(-pi/w) from square to square."""
    yield from variants(strip_mesh, ['*432', '*532', '*2222', '2*3', '4*'], [2, 3], [10, 30])


def corner_at_strip_tip_mesh(orbifold, width, length):
    vertices, faces, at = cells_disk(strip_cells(width, length))
    top = SQUARE + length
    corners = [at[point] for point in ((0, 0), (SQUARE, 0), (3 + width, top), (0, SQUARE))]
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, corners, None))


@kind
def corner_at_strip_tip():
    yield from variants(corner_at_strip_tip_mesh, ['*432', '*2222'], [2, 3], [20, 40])


# Thin and rough faces.

HEIGHTS = [0.1, 0.3, 1, 2, 5, 10, 30, 100, 1000, 10000]


def rough_grid_mesh(orbifold, height):
    n = 16
    vertices, faces, corners = square(n)
    vertices[:, 2] = height * np.random.default_rng(n).uniform(-1, 1, len(vertices))
    inside = int(np.argmin(np.linalg.norm(vertices[:, :2] - n / 2, axis=1)))
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, corners, inside))


@kind
def rough_grid():
    yield from variants(rough_grid_mesh, ['*432', '3*2', '*2222'], HEIGHTS)


def rough_ball_mesh(orbifold, height):
    vertices, faces = ball(3)
    factors = np.random.default_rng(3).uniform(0, 1, len(vertices))
    return HardMesh(vertices * (1 + height * factors)[:, None], faces, orbifold, BODY_CONES[orbifold])


@kind
def rough_ball():
    yield from variants(rough_ball_mesh, ['432', '22'], HEIGHTS)


ASPECTS = [10**k for k in range(1, 11)]


def sliver_mesh(orbifold, aspect):
    """Every eighth face has a vertex just beside the middle of an edge."""
    vertices, faces = ball(2)
    vertices, faces = divide_faces(vertices, faces, range(0, len(faces), 8), lambda a, b, c: (a + b) / 2 * (1 - 1 / aspect) + c / aspect)
    return HardMesh(vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def slivers():
    yield from variants(sliver_mesh, ['432', '55'], ASPECTS)


def stretched_disk_mesh(orbifold, aspect):
    vertices, faces, corners = square(SQUARE)
    return HardMesh(vertices * [aspect, 1, 1], faces, orbifold, disk_cones(orbifold, corners, None))


@kind
def stretched_disk():
    """Every face is a sliver."""
    yield from variants(stretched_disk_mesh, ['*432'], ASPECTS)


# Of the ball's 1,280 faces.
EVERY = [1280, 640, 320, 160, 80, 40, 30, 20, 15, 10]


def smooth_ball(orbifold):
    return HardMesh(*ball(3), orbifold, BODY_CONES[orbifold])


def flat_faces_mesh(orbifold, every):
    """Every so many faces have a vertex exactly in the middle of an edge."""
    vertices, faces = ball(3)
    vertices = on_dyadic_lattice(vertices)
    vertices, faces = divide_faces(vertices, faces, range(0, len(faces), every), lambda a, b, c: (a + b) / 2)
    return HardMesh(vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def flat_faces():
    yield from variants(flat_faces_mesh, ['432', '22'], EVERY)


def flat_disk_faces_mesh(orbifold, every):
    n = 24
    vertices, faces, corners = square(n)
    inside = set(inner_vertices(faces))
    chosen = [f for f, face in enumerate(faces) if inside.issuperset(face)][::every]
    vertices, faces = divide_faces(vertices, faces, set(chosen), lambda a, b, c: (a + b) / 2)
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, corners, None))


@kind
def flat_disk_faces():
    yield from variants(flat_disk_faces_mesh, ['*432'], EVERY)


def coincident_vertices_mesh(orbifold, every):
    """Every so many faces have a vertex at one of their corners: an edge without length, two faces without area."""
    vertices, faces = ball(2)
    vertices, faces = divide_faces(vertices, faces, range(0, len(faces), every), lambda a, b, c: a)
    return HardMesh(vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def coincident_vertices():
    yield from variants(coincident_vertices_mesh, ['432', '55', '2222'], [320, 80, 40, 20, 10])


def collapsed_edges_mesh(orbifold, every):
    """Every so many vertices lie at a neighbour's place."""
    vertices, faces = ball(2)
    taken = {0, 1, 2, 3, 8, 9}
    for v in range(12, len(vertices), every):
        ring = link(faces, v)
        if taken.isdisjoint([v, *ring]):
            vertices[v] = vertices[ring[0]]
            taken.update([v, *ring])
    return HardMesh(vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def collapsed_edges():
    yield from variants(collapsed_edges_mesh, ['432', '22'], [100, 30, 10, 5, 2])


def collapsed_star_mesh(orbifold, stars):
    """All neighbours of a vertex lie at its place."""
    vertices, faces = ball(2)
    for v in [6, 10, 5, 4, 7, 11][:stars]:
        vertices[link(faces, v)] = vertices[v]
    return HardMesh(vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def collapsed_stars():
    yield from variants(collapsed_star_mesh, ['432', '532'], [1, 3, 6])


def spiky_ball_mesh(orbifold, radius, seed):
    """Every third vertex or so sticks out."""
    vertices, faces = ball(2)
    out = np.random.default_rng(seed).random(len(vertices)) < 1 / 3
    return HardMesh(np.where(out[:, None], radius, 1) * vertices, faces, orbifold, BODY_CONES[orbifold])


@kind
def spiky_ball():
    yield from variants(spiky_ball_mesh, ['432', '22'], [2, 5, 20, 100, 1000], [0, 1])


# Hubs.

HUBS = [50, 200, 1000, 3200, 5000]


def circle(n):
    angles = 2 * np.pi * np.arange(n) / n
    return np.column_stack([np.cos(angles), np.sin(angles), np.zeros(n)])


def barrel(n):
    """Vertices 0 .. n - 1 around, n .. 2 n - 1 around above them; 2 n below and 2 n + 1 on top."""
    faces = []
    for k in range(n):
        a, b, c, d = k, (k + 1) % n, (k + 1) % n + n, k + n
        faces += [(a, b, c), (a, c, d), (b, a, 2 * n), (d, c, 2 * n + 1)]
    return np.concatenate([circle(n), circle(n) + [0, 0, 1], [[0, 0, -1], [0, 0, 2]]]), faces


def double_pyramid(n):
    """Vertices 0 .. n - 1 around, n above, n + 1 below."""
    faces = [face for k in range(n) for face in ((k, (k + 1) % n, n), ((k + 1) % n, k, n + 1))]
    return np.concatenate([circle(n), [[0, 0, 1], [0, 0, -1]]]), faces


def hub_mesh(where, edges):
    """Two vertices of so many edges: both cones, one of them, or none."""
    if where == 'both':
        return HardMesh(*double_pyramid(edges), '22', words([edges, edges + 1]))
    if where == 'none':
        return HardMesh(*double_pyramid(edges), '432', words([0, edges // 3, 2 * edges // 3]))
    return HardMesh(*barrel(edges), '225', words([edges, edges + edges // 2, 2 * edges]))


@kind
def hub():
    yield from variants(hub_mesh, ['both', 'one', 'none'], HUBS)


def disk_hub_mesh(orbifold, edges):
    """A wheel: every vertex but the hub is on the boundary."""
    vertices = np.concatenate([circle(edges), [[0, 0, 0.3]]])
    faces = [(k, (k + 1) % edges, edges) for k in range(edges)]
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, [0, edges // 3, 2 * edges // 3], edges))


@kind
def disk_hub():
    yield from variants(disk_hub_mesh, ['*432', '5*'], HUBS)


# Not 3-connected: the number of faces that must become arcs is known.

def with_ears(vertices, faces, sides):
    """A triangle on every one of these boundary edges, each from a to b as its own face runs."""
    points, faces = list(vertices), list(faces)
    for a, b in sides:
        outward_normal = np.cross(vertices[b] - vertices[a], [0, 0, 1.0])
        faces.append((b, a, len(points)))
        points.append((vertices[a] + vertices[b]) / 2 + outward_normal / 2)
    return np.array(points), faces


def ears_mesh(orbifold, count):
    vertices, faces, at = cells_disk(itertools.product(range(SQUARE), range(SQUARE)))
    corners = [at[point] for point in ((0, 0), (SQUARE, 0), (SQUARE, SQUARE), (0, SQUARE))]
    sides = [(at[(i, 0)], at[(i + 1, 0)]) for i in range(SQUARE)] + [(at[(SQUARE, j)], at[(SQUARE, j + 1)]) for j in range(SQUARE)]
    vertices, faces = with_ears(vertices, faces, sides[:count])
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, corners, at[(4, 4)]), arcs=count)


@kind
def ears():
    yield from variants(ears_mesh, ['*432', '3*2', '*2222'], [1, 4, 12])


def corridor(steps):
    """Squares in a line that goes up and down beside a square, two columns apart."""
    column, row, step = SQUARE, SQUARE // 2, 1
    while steps > 0:
        yield column, row
        steps -= 1
        if (column - SQUARE) % 2 == 1:
            column += 1
            step = -step
        elif row == (SQUARE if step > 0 else 0):
            column += 1
        else:
            row += step


def maze_mesh(orbifold, steps):
    """A corridor one square wide: its faces must become arcs, but for those of squares beside the large one."""
    cells = set(itertools.product(range(SQUARE), range(SQUARE)))
    walk = list(corridor(steps))
    vertices, faces, at = cells_disk(cells | set(walk))
    corners = [at[point] for point in ((0, 0), (SQUARE, 0), (SQUARE, SQUARE), (0, SQUARE))]
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, [corners[0], corners[3], at[(0, 4)], at[(0, 2)]], at[(4, 4)]),
                    arcs=2 * sum(column > SQUARE or row >= SQUARE for column, row in walk))


@kind
def maze():
    yield from variants(maze_mesh, ['*432', '2*3'], [3, 20, 60])


def chord_mesh(orbifold, size):
    """A second square that hangs on the first by one edge."""
    cells = set(itertools.product(range(SQUARE), range(SQUARE)))
    beyond = set(itertools.product(range(SQUARE + 1, SQUARE + 1 + size), range(4, 4 + size))) | {(SQUARE, 4)}
    vertices, faces, at = cells_disk(cells | beyond)
    corners = [at[point] for point in ((0, 0), (SQUARE, 0), (SQUARE, SQUARE), (0, SQUARE))]
    return HardMesh(vertices, faces, orbifold, disk_cones(orbifold, [corners[0], corners[3], at[(0, 4)], at[(0, 2)]], at[(4, 4)]),
                    arcs=2 * len(beyond))


@kind
def chord():
    yield from variants(chord_mesh, ['*432', '5*'], [1, 4, 8])


# Octocat, of the meshes beside the repository: six limbs to 2e-21 with the cones of cones.tsv.

OCTOCAT_CONES = '2598,1371,118'


def octocat_choices(faces):
    """Its own cones, and twelve random choices of three vertices."""
    used = sorted({v for face in faces for v in face})
    generator = random.Random(13)
    return [OCTOCAT_CONES] + [words(generator.sample(used, 3)) for _ in range(12)]
