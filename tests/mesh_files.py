# SPDX-License-Identifier: MIT
"""Binary little-endian PLY files of triangles as the program writes them, with offsets where doubles do not suffice; and OFF files."""
import pathlib
from fractions import Fraction

import numpy as np

from trials import expect

PLY_TYPES = {'char': 'i1', 'uchar': 'u1', 'short': '<i2', 'ushort': '<u2', 'int': '<i4', 'uint': '<u4', 'float': '<f4',
             'double': '<f8', 'int8': 'i1', 'uint8': 'u1', 'int16': '<i2', 'uint16': '<u2', 'int32': '<i4', 'uint32': '<u4',
             'float32': '<f4', 'float64': '<f8'}

OFFSET_PROPERTIES = ['property int vertex', 'property double dx', 'property double dy', 'property double dz']
NO_OFFSETS = np.zeros(0, [('vertex', '<i4'), ('dx', '<f8'), ('dy', '<f8'), ('dz', '<f8')])


def row_type(properties):
    """The type of one row of an element; a list has three entries, for all faces are triangles."""
    fields = []
    for line in properties:
        words = line.split()
        if words[1] == 'list':
            fields += [('corners', PLY_TYPES[words[2]]), (words[4], PLY_TYPES[words[3]], 3)]
        else:
            fields.append((words[2], PLY_TYPES[words[1]]))
    return np.dtype(fields)


class Ply:
    """The elements of a file as structured arrays, and its header as lines.

    The position of a vertex is the exact sum of its own doubles and of all of its rows of `offset`.
    """

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        end = data.index(b'end_header\n') + len(b'end_header\n')
        self.before, self.properties, counts = [], {}, {}
        for line in data[:end].decode().splitlines()[:-1]:
            words = line.split()
            if words[0] == 'element':
                counts[words[1]], self.properties[words[1]] = int(words[2]), []
            elif words[0] == 'property':
                self.properties[list(counts)[-1]].append(line)
            else:
                expect(words[0] != 'format' or words[1] == 'binary_little_endian', f'{path}: {line}')
                self.before.append(line)
        expect(list(counts) in (['vertex', 'face'], ['vertex', 'face', 'offset']), f'{path}: elements {list(counts)}')
        arrays = {}
        for name, count in counts.items():
            arrays[name] = np.frombuffer(data, row_type(self.properties[name]), count, end).copy()
            end += arrays[name].nbytes
        expect(end == len(data), f'{path}: {len(data) - end} bytes too many')
        self.vertex, self.face = arrays['vertex'], arrays['face']
        self.offset = arrays.get('offset', NO_OFFSETS)
        expect((self.face['corners'] == 3).all(), f'{path}: not all faces are triangles')
        self.faces = self.face['vertex_indices'].astype(np.int64)

    @property
    def positions(self):
        """The doubles alone."""
        return np.stack([self.vertex[axis] for axis in 'xyz'], 1)

    @positions.setter
    def positions(self, values):
        for k, axis in enumerate('xyz'):
            self.vertex[axis] = values[:, k]

    def offset_vertices(self):
        return set(self.offset['vertex'].tolist())

    def exact_position(self, v):
        """Three fractions."""
        position = [Fraction(float(self.vertex[axis][v])) for axis in 'xyz']
        for row in self.offset[self.offset['vertex'] == v]:
            position = [x + Fraction(float(row[axis])) for x, axis in zip(position, ('dx', 'dy', 'dz'))]
        return position

    def place(self, v, position, most_offsets):
        """Stores fractions as doubles and as so many rows of offsets as it takes, but not more than `most_offsets`."""
        self.offset = self.offset[self.offset['vertex'] != v]
        stored = [float(x) for x in position]
        for k, axis in enumerate('xyz'):
            self.vertex[axis][v] = stored[k]
        rows = []
        rest = [x - Fraction(d) for x, d in zip(position, stored)]
        while any(rest) and len(rows) < most_offsets:
            row = [float(x) for x in rest]
            rest = [x - Fraction(d) for x, d in zip(rest, row)]
            rows.append((v, *row))
        self.offset = np.concatenate([self.offset, np.array(rows, self.offset.dtype)])

    def save(self, path):
        arrays = {'vertex': self.vertex, 'face': self.face}
        if len(self.offset):
            arrays['offset'] = self.offset
        header = list(self.before)
        for name, array in arrays.items():
            header += [f'element {name} {len(array)}', *self.properties.get(name, OFFSET_PROPERTIES)]
        text = '\n'.join([*header, 'end_header', ''])
        pathlib.Path(path).write_bytes(text.encode() + b''.join(array.tobytes() for array in arrays.values()))


def write_off(path, vertices, faces):
    lines = ['OFF', f'{len(vertices)} {len(faces)} 0']
    lines += [' '.join(map(repr, vertex)) for vertex in vertices.tolist()]
    lines += [' '.join(map(str, [len(face), *face])) for face in faces]
    pathlib.Path(path).write_text('\n'.join(lines) + '\n')


def read_off_triangles(path):
    words = pathlib.Path(path).read_text().split()
    n, m = int(words[1]), int(words[2])
    faces = np.array(words[4 + 3 * n:4 + 3 * n + 4 * m], np.int64).reshape(m, 4)
    return np.array(words[4:4 + 3 * n], float).reshape(n, 3), faces[:, 1:]


def half_edges(faces):
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
