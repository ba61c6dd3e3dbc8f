#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The command line as its users meet it: misspelt words, names of files, streams that are closed or full, and messages.

usage: tests/command_line.py PROGRAM [UNITTEST OPTION ...]

Needs nothing but the built program, which makes the meshes itself.
"""
import gzip
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

PROGRAM = ''
COMMANDS = ['embed', 'choose', 'info', 'types', 'verify', 'tile', 'export', 'measure', 'render', 'report', 'compare', 'repair', 'map', 'resample', 'batch', 'sample']
IS_A_FILE, IS_WRONG, IS_UNSUITABLE, IS_NOT_CONVERGED, IS_NOT_CERTIFIED = 1, 2, 3, 4, 5


def write_obj(path, vertices, faces):
    lines = [f'v {x!r} {y!r} {z!r}' for x, y, z in vertices] + ['f ' + ' '.join(str(v + 1) for v in face) for face in faces]
    path.write_text('\n'.join(lines) + '\n')


def read_obj(path):
    words = [line.split() for line in path.read_text().splitlines()]
    vertices = [tuple(map(float, line[1:4])) for line in words if line and line[0] == 'v']
    return vertices, [[int(corner.split('/')[0]) - 1 for corner in line[1:]] for line in words if line and line[0] == 'f']


def square_with_ribbon(ribbon, side=4):
    """A square of quads, and a ribbon of so many triangles at one edge of its boundary, all of which must become arcs."""
    across = side + 1
    vertices = [(float(x), float(y), 0.0) for y in range(across) for x in range(across)]
    faces = []
    for y in range(side):
        for x in range(side):
            a = y * across + x
            faces += [[a, a + 1, a + across + 1], [a, a + across + 1, a + across]]
    left, right = 1, 2
    for k in range(ribbon):
        vertices.append((1.0 + k % 2, -1.0 - k // 2, 0.0))
        new = len(vertices) - 1
        faces.append([right, left, new])
        if k % 2 == 0:
            left = new
        else:
            right = new
    return vertices, faces


class CommandLine(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory(prefix='orbitutte-command-line-')
        cls.folder = pathlib.Path(cls.scratch.name)
        for command in (['sample', '--faces', '500', '-o', 'figure.obj'],
                        ['embed', 'figure.obj', '--orbifold', '432', '--cones', 'extremities', '-o', 'map.ply', '--report', 'map.json']):
            subprocess.run([PROGRAM, *command], cwd=cls.folder, check=True, stderr=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def run_program(self, *arguments, **options):
        options = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE, **options}
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True, errors='replace', stdin=subprocess.DEVNULL, **options)

    def expect(self, code, *arguments, says=(), **options):
        """Runs the program; the exit code has to be this one, and standard error has to match each of the patterns."""
        done = self.run_program(*arguments, **options)
        self.assertEqual(done.returncode, code, f'{arguments}: {done.stderr}')
        for pattern in [says] if isinstance(says, str) else says:
            self.assertRegex(done.stderr, pattern, arguments)
        return done

    def embed(self, mesh, *options, orbifold='432', cones='extremities'):
        return ['embed', mesh, '--orbifold', orbifold, '--cones', cones, *options]


class Words(CommandLine):
    def assert_lists_the_commands(self, text):
        self.assertEqual(re.findall(r'^  (\w+) +\w', text, re.MULTILINE), COMMANDS)

    def test_no_command_lists_all(self):
        done = self.expect(IS_WRONG, says='a command is missing')
        self.assert_lists_the_commands(done.stderr)
        self.assertEqual(done.stdout, '')

    def test_a_misspelt_command_names_the_nearest(self):
        for word, meant in {'embde': 'embed', 'emb': 'embed', 'verfy': 'verify', 'tiel': 'tile', 'exports': 'export', 'sampel': 'sample'}.items():
            with self.subTest(word):
                done = self.expect(IS_WRONG, word, 'figure.obj', '--orbifold', '432', says=f"there is no command '{word}'; did you mean '{meant}'")
                self.assert_lists_the_commands(done.stderr)

    def test_a_word_that_is_like_no_command_lists_all(self):
        done = self.expect(IS_WRONG, 'figure.obj', says="there is no command 'figure.obj'\n")
        self.assert_lists_the_commands(done.stderr)

    def test_a_misspelt_option_names_the_nearest(self):
        for command, option, meant in [('embed', '--orbifld', '--orbifold'), ('embed', '--weigths', '--weights'), ('embed', '--cone', '--cones'),
                                       ('embed', '--cut_seed', '--cut-seed'), ('render', '--pannel', '--panel'), ('info', '--jsno', '--json')]:
            for given in ([option, '432'], [f'{option}=432']):
                with self.subTest(given):
                    self.expect(IS_WRONG, command, 'figure.obj', *given,
                                says=[f"orbitutte: {command} has no option '{option}'; did you mean '{meant}'", f"'orbitutte {command} --help'"])
        self.expect(IS_WRONG, '--verison', says="has no option '--verison'; did you mean '--version'")

    def test_an_option_that_is_like_no_other_gets_no_suggestion(self):
        done = self.expect(IS_WRONG, 'info', 'figure.obj', '--quadrangulate', says="has no option '--quadrangulate'")
        self.assertNotIn('did you mean', done.stderr)

    def test_a_word_too_many_is_named(self):
        self.expect(IS_WRONG, 'info', 'figure.obj', 'map.ply', says="'map.ply' is one argument too many")
        self.expect(IS_WRONG, 'embed', 'figure.obj', '--orbifold', 'map.json', 'map.ply',  # '--orbifold *' of a shell
                    says="'map.ply' is one argument too many; 'map.json' is a file, not a symbol: put a symbol with a star in quotes")

    def test_what_is_missing_is_named(self):
        self.expect(IS_WRONG, 'sample', says=['output is required', "'orbitutte sample --help'"])


class Files(CommandLine):
    def setUp(self):
        self.before = {path: path.read_bytes() for path in self.folder.iterdir() if path.is_file()}

    def tearDown(self):
        for path, content in self.before.items():
            self.assertEqual(path.read_bytes(), content, path)

    def test_wrong_endings_are_refused_before_anything_is_read(self):
        embedding = ['no.ply', 'no.json']
        for arguments in (self.embed('no.obj', '-o', 'out.obj'), self.embed('no.obj', '-o', 'out'), self.embed('no.obj', '--report', 'out.txt'),
                          ['tile', *embedding, '-o', 'out.off'], ['export', *embedding, 'no.obj', '-o', 'out.stl'],
                          ['render', *embedding, 'no.obj', '-o', 'out.jpg'], ['report', *embedding, 'no.obj', '-o', 'out.pdf'],
                          ['compare', 'no.obj', '-o', 'out.jpg'], ['sample', '-o', 'out.fbx'],
                          ['measure', *embedding, 'no.obj', '-o', 'out.json']):
            with self.subTest(arguments):
                wrong = arguments[-1]
                self.expect(IS_WRONG, *arguments, says=f"{arguments[-2]} is '{wrong}', but .* is written as [.]\\w+.*; change the ending")
                self.assertFalse((self.folder / wrong).exists())

    def test_right_endings_are_taken_in_capitals_too(self):
        for arguments in (self.embed('no.obj', '-o', 'out.PLY', '--report', 'out.Json'), ['tile', 'no.ply', 'no.json', '-o', 'out.GLB']):
            self.expect(IS_A_FILE, *arguments, says='cannot be read')

    def test_meshes_and_models_may_be_compressed(self):
        for command, name in ((['repair', 'figure.obj'], 'whole.off'), (['sample', '--faces', '500'], 'sample.stl'),
                              (['export', 'map.ply', 'map.json', 'figure.obj'], 'model.obj'), (['export', 'map.ply', 'map.json', 'figure.obj'], 'sphere.gii')):
            with self.subTest(name):
                for ending in ('', '.gz'):
                    self.expect(0, *command, '-o', name + ending)
                self.assertEqual(gzip.decompress((self.folder / f'{name}.gz').read_bytes()), (self.folder / name).read_bytes())
        self.expect(IS_WRONG, 'repair', 'figure.obj', '-o', 'no.txt.gz', says='each also with .gz')
        self.expect(IS_WRONG, 'embed', 'figure.obj', '-o', 'no.ply.gz', says='written as .ply; change')

    def test_devices_and_pipes_may_have_any_name(self):
        done = self.expect(0, *self.embed('figure.obj', '-o', '/dev/null', '--report', '/dev/stdout', '--quiet'))
        self.assertEqual(json.loads(done.stdout)['schema'], 'orbitutte.report/1')
        self.expect(0, *self.embed('figure.obj', '-o', '/dev/null', '--report', '/dev/null'))

    def test_an_output_that_is_an_input_is_refused(self):
        (self.folder / 'sub').mkdir(exist_ok=True)
        (self.folder / 'figure.ply').write_text('a mesh')
        (self.folder / 'weights.ply').write_text('0 1 1\n')
        (self.folder / 'corners.json').write_text('0 1 0 0\n')
        self.before[self.folder / 'figure.ply'] = b'a mesh'
        for name, link in (('soft.ply', os.symlink), ('hard.ply', os.link)):
            if not (self.folder / name).exists():
                link(self.folder / 'figure.ply', self.folder / name)
        for name in ('figure.ply', './figure.ply', 'sub/../figure.ply', './/figure.ply', 'soft.ply', 'hard.ply', self.folder / 'figure.ply'):
            with self.subTest(name):
                self.expect(IS_WRONG, *self.embed('figure.ply', '-o', name), says=f"-o is '{name}', which is the mesh that the command reads")
        self.expect(IS_WRONG, *self.embed('soft.ply', '-o', 'hard.ply'), says='which is the mesh')
        self.expect(IS_WRONG, *self.embed('figure.obj', '-o', 'figure.obj'), says='which is the mesh')
        self.expect(IS_WRONG, *self.embed('figure.obj', '--report', 'figure.obj'), says='--report is .* which is the mesh')
        self.expect(IS_WRONG, *self.embed('figure.obj', '--weights-file', 'weights.ply', '-o', 'weights.ply'), says='which is the weights')
        self.expect(IS_WRONG, 'embed', 'figure.obj', '--orbifold', 'polygon', '--polygon', 'corners.json', '--report', 'corners.json',
                    says='which is the polygon')
        self.expect(IS_WRONG, 'tile', 'map.ply', 'map.json', '-o', './map.ply', says='which is the embedding')
        self.expect(IS_WRONG, 'export', 'map.ply', 'map.json', 'figure.obj', '-o', 'figure.obj', says='which is the mesh')
        for command in ('render', 'report'):
            self.expect(IS_WRONG, command, 'map.ply', 'map.json', 'figure.obj', '-o', 'map.json', says='which is the report')

    def test_two_outputs_in_one_file_are_refused(self):
        os.symlink('later.ply', self.folder / 'early.ply')  # leads to nothing yet
        for first, second in (('a.ply', 'a.ply'), ('a.ply', './a.ply'), ('early.ply', 'later.ply'), ('later.ply', 'early.ply')):
            with self.subTest(second):
                self.expect(IS_WRONG, *self.embed('no.obj', '-o', first, '--report', second), says=f"-o and --report are both '{second}'")

    def test_a_link_to_another_file_is_written_through(self):
        other = self.folder / 'other.ply'
        os.symlink('other.ply', self.folder / 'link.ply')
        self.expect(0, *self.embed('figure.obj', '-o', 'link.ply', '--quiet'))
        self.assertTrue(other.read_bytes().startswith(b'ply'))
        self.assertTrue((self.folder / 'link.ply').is_symlink())



class Maps(CommandLine):
    LANDMARKS = '1:1,60:60,120:120,200:200'

    def map(self, *options, b='figure.obj'):
        return ['map', 'figure.obj', b, *options]

    def test_all_files_are_written(self):
        self.expect(0, *self.map('--landmarks', self.LANDMARKS, '-o', 'onto_itself'), says='certified: bijective')
        names = {path.name for path in (self.folder / 'onto_itself').iterdir()}
        self.assertEqual(names, {'a.ply', 'a.json', 'b.ply', 'b.json', 'map.json', 'a_to_b.txt', 'b_to_a.txt', 'overlay_a.obj', 'overlay_b.obj'})
        found = json.loads((self.folder / 'onto_itself' / 'map.json').read_text(encoding='utf-8'))
        self.assertTrue(found['bijective'])
        self.assertEqual(found['landmarks'], [[1, 1], [60, 60], [120, 120], [200, 200]])
        self.assertLess(found['landmark_error'], 1e-12)
        self.expect(0, 'verify', 'onto_itself/b.ply', 'onto_itself/b.json', 'figure.obj')

    def test_landmarks_may_be_a_file_with_a_header(self):
        (self.folder / 'landmarks.tsv').write_text('a\tb\n1\t1\n60\t60\n120\t120\n', encoding='utf-8')
        self.expect(0, *self.map('--landmarks', 'landmarks.tsv', '--json'), says='3 landmarks')

    def test_bad_landmarks_are_named(self):
        for landmarks, says in {'1:1,60:60,120:60': "landmarks 1 and 2 are both vertex 60 of B", '1:1,60:60,999999:3': 'landmark 2 is vertex 999999 of A',
                                '1:1,60:60': '2 landmarks between two spheres'}.items():
            with self.subTest(landmarks):
                done = self.expect(IS_UNSUITABLE, *self.map('--landmarks', landmarks, '-o', 'nothing'), says=says)
                self.assertEqual(done.stderr.count('\n'), 1)
                self.assertFalse((self.folder / 'nothing').exists())
        self.expect(IS_WRONG, *self.map('--landmarks', '1:1,60'), says="landmark '60' is not two vertices")

    def test_two_projective_planes_are_refused_with_the_reason(self):
        self.expect(0, 'sample', '--shape', 'boy', '--faces', 400, '-o', 'boy.obj')
        self.expect(IS_UNSUITABLE, 'map', 'boy.obj', 'boy.obj', '--landmarks', '1:1,60:60,120:120', says='projective-?plane; .* have one mark alone')

    def test_no_file_of_the_map_replaces_an_input(self):
        (self.folder / 'own').mkdir(exist_ok=True)
        shutil.copy(self.folder / 'figure.obj', self.folder / 'own' / 'overlay_a.obj')
        self.expect(IS_WRONG, 'map', 'own/overlay_a.obj', 'figure.obj', '--landmarks', self.LANDMARKS, '-o', 'own', says='surface A')

    def textured_figure(self):
        """The figure with texture coordinates, and a picture of 8 x 8 pixels that is one colour: paths in the folder."""
        self.expect(0, 'export', 'map.ply', 'map.json', 'figure.obj', '-o', 'textured.obj')
        rows = (b'\0' + bytes((200, 100, 50)) * 8) * 8
        chunks = [(b'IHDR', struct.pack('>IIBBBBB', 8, 8, 8, 2, 0, 0, 0)), (b'IDAT', zlib.compress(rows)), (b'IEND', b'')]
        png = b'\x89PNG\r\n\x1a\n' + b''.join(struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data)) for kind, data in chunks)
        (self.folder / 'picture.png').write_bytes(png)
        return 'textured.obj', 'picture.png'

    def test_what_is_carried_comes_from_the_partner(self):
        V, _ = read_obj(self.folder / 'figure.obj')
        (self.folder / 'values.txt').write_text(''.join(f'{v} {-v}\n' for v in range(len(V))))
        (self.folder / 'labels.txt').write_text(''.join(f'{v % 7}\n' for v in range(len(V))))
        _, faces = read_obj(self.folder / 'figure.obj')
        (self.folder / 'curves.txt').write_text(f'{faces[0][0]} {faces[0][1]} {faces[0][2]}\n')
        mesh, picture = self.textured_figure()
        self.expect(0, *self.map('--landmarks', self.LANDMARKS, '-o', 'carried', '--values', 'values.txt', '--labels', 'labels.txt', '--curves', 'curves.txt',
                                 '--texture', picture, '--colours', 'coloured.ply', '--morph', 'morph.glb', '--page', 'page.html', b=mesh))
        folder = self.folder / 'carried'
        values = [[float(word) for word in line.split()] for line in (folder / 'values_on_a.txt').read_text().splitlines()]
        self.assertEqual(len(values), len(V))
        for a, b in ((1, 1), (60, 60), (120, 120), (200, 200)):
            self.assertEqual(values[a], [b, -b])
            self.assertEqual((folder / 'labels_on_a.txt').read_text().splitlines()[a], str(b % 7))
        write_whole_numbers(self.folder / 'labels.npy', [v % 7 for v in range(len(V))])
        self.expect(0, *self.map('--from', 'carried', '--labels', 'labels.npy', b=mesh))
        self.assertIn(b"'<i4'", (folder / 'labels_on_a.npy').read_bytes()[:128])
        self.assertTrue((folder / 'curves_on_a.obj').read_text().rstrip().splitlines()[-1].startswith('l 1 2'))
        self.assertIn('map_Kd texture.png', (folder / 'textured_a.mtl').read_text())
        self.assertIn('mtllib textured_a.mtl', (folder / 'textured_a.obj').read_text())
        self.assertTrue((folder / 'texture.png').read_bytes().startswith(b'\x89PNG'))
        self.assertTrue((self.folder / 'morph.glb').read_bytes().startswith(b'glTF'))
        self.assertIn('<!doctype html>', (self.folder / 'page.html').read_text(encoding='utf-8'))
        self.expect(0, 'info', 'coloured.ply')

    def test_a_map_is_read_again_and_carries_the_same(self):
        V, _ = read_obj(self.folder / 'figure.obj')
        (self.folder / 'values.txt').write_text(''.join(f'{v}\n' for v in range(len(V))))
        self.expect(0, *self.map('--landmarks', self.LANDMARKS, '-o', 'first', '--values', 'values.txt'))
        self.expect(0, *self.map('--from', 'first', '-o', 'second', '--values', 'values.txt', '--morph', 'frame.ply', '--frames', '3'), says='certified: bijective')
        self.assertEqual((self.folder / 'first/values_on_a.txt').read_bytes(), (self.folder / 'second/values_on_a.txt').read_bytes())
        self.assertEqual({path.name for path in (self.folder / 'second').iterdir()}, {'values_on_a.txt'})
        self.assertTrue(all((self.folder / f'frame_0{k}.ply').exists() for k in range(3)))
        self.expect(0, 'sample', '--shape', 'figure', '--faces', 300, '-o', 'other.obj')
        self.expect(IS_UNSUITABLE, 'map', 'other.obj', 'figure.obj', '--from', 'first', '--colours', 'no.ply',
                    says='first holds the map of another surface than this A')
        printed = self.expect(0, *self.map('--from', 'first', '--values', 'values.txt', '--json'))
        self.assertEqual(printed.stdout, (self.folder / 'first/map.json').read_text(encoding='utf-8'))
        self.expect(IS_WRONG, *self.map('--from', 'first'), says='nothing is to be made of it')
        (self.folder / 'empty.txt').write_text('a b\n')
        self.expect(IS_UNSUITABLE, *self.map('--landmarks', 'empty.txt', '-o', 'none'), says='empty.txt: there is no landmark in it')
        self.expect(IS_WRONG, *self.map('--from', 'first', '--page', 'first/map.json'), says='.html')
        self.expect(IS_WRONG, *self.map('--from', 'first', '--landmarks', self.LANDMARKS, '--page', 'page.html'), says='give one of them')

    def test_what_cannot_be_carried_is_named_before_the_map_is_sought(self):
        (self.folder / 'short.txt').write_text('1\n2\n')
        (self.folder / 'words.txt').write_text('1\none\n')
        (self.folder / 'no.png').write_text('no picture')
        V, _ = read_obj(self.folder / 'figure.obj')
        far = max(range(len(V)), key=lambda v: math.dist(V[v], V[1]))
        (self.folder / 'jump.txt').write_text(f'1 {far}\n')
        mesh, picture = self.textured_figure()
        for code, options, says in ((IS_UNSUITABLE, ['--values', 'short.txt', '-o', 'none'], 'it needs one for each'),
                                    (IS_UNSUITABLE, ['--labels', 'words.txt', '-o', 'none'], 'words.txt: line 2'),
                                    (IS_UNSUITABLE, ['--curves', 'jump.txt', '-o', 'none'], f'from vertex 1 to vertex {far} of B, which share no triangle'),
                                    (IS_WRONG, ['--values', 'short.txt'], 'writes into the folder of -o'),
                                    (IS_UNSUITABLE, ['--texture', picture, '-o', 'none'], 'B has no texture coordinates'),
                                    (IS_WRONG, ['--frames', '4'], '--frames belongs to --morph'),
                                    (IS_WRONG, ['--morph', 'morph.ply'], '--frames says how many'),
                                    (IS_WRONG, ['--new-chart', '--page', 'page.html'], '--new-chart belongs to --texture'),
                                    (IS_WRONG, ['--view', 'front'], '--view and --up belong to --picture'),
                                    (IS_WRONG, ['--page', 'page.png'], '.html')):
            with self.subTest(options):
                self.expect(code, *self.map('--landmarks', self.LANDMARKS, *options), says=says)
                self.assertFalse((self.folder / 'none').exists())
        self.expect(IS_A_FILE, *self.map('--landmarks', self.LANDMARKS, '--texture', 'no.png', '-o', 'none', b=mesh), says='neither a PNG nor a JPEG')
        self.expect(IS_WRONG, *self.map('--landmarks', self.LANDMARKS, '--texture', picture, '--texture-size', 'big', '-o', 'none', b=mesh), says="'big'")

    def test_what_cannot_be_written_is_named_before_the_map_is_sought(self):
        mesh, picture = self.textured_figure()
        for code, options, says in ((IS_WRONG, ['--picture', 'sheet.png', '--view', 'sideways'], "the view is 'sideways'|without pictures"),
                                    (IS_WRONG, ['--picture', 'sheet.png', '--up', 'w'], "the direction up is 'w'|without pictures"),
                                    (IS_WRONG, ['--texture', picture, '--texture-size', '99999', '-o', 'none'], 'a texture of 99999 x 99999 pixels'),
                                    (IS_A_FILE, ['--page', 'nowhere/page.html'], "--page is 'nowhere/page.html', but there is no folder 'nowhere'"),
                                    (IS_A_FILE, ['--morph', 'nowhere/f.ply', '--frames', '3'], "there is no folder 'nowhere'"),
                                    (IS_A_FILE, ['-o', 'figure.obj'], "the folder 'figure.obj' cannot be made: a file has that name")):
            with self.subTest(options):
                done = self.expect(code, *self.map('--landmarks', '1:1,60:60', *options, b=mesh), says=says)  # too few landmarks: not looked at
                self.assertEqual(done.stderr.count('\n'), 1)
                self.assertFalse((self.folder / 'none').exists())

    def test_what_would_change_the_map_is_refused_where_one_is_read(self):
        for option, value in (('--tile', 'regular'), ('--tour', '0,1,2,3'), ('--weights', 'cotan'), ('--clamp', '0.1'), ('--cut-seed-a', '3'),
                              ('--cut-seed-b', '3'), ('--tolerance', '1e-6'), ('--max-iterations', '7'), ('--landmarks', self.LANDMARKS)):
            with self.subTest(option):
                self.expect(IS_WRONG, *self.map('--from', 'no folder', option, value, '--page', 'page.html'), says=f'{option} seeks a map and --from reads one')

    def test_stages_add_up_to_the_total(self):
        done = self.expect(0, *self.map('--landmarks', self.LANDMARKS, '--json'))
        timings = json.loads(done.stdout)['timings']
        total = timings.pop('total')
        self.assertLessEqual(sum(timings.values()), total + 1e-6)
        self.assertGreater(sum(timings.values()), 0.8 * total)


def write_whole_numbers(path, numbers):
    """An .npy of 64-bit whole numbers, or an .npy.gz, as NumPy writes it."""
    header = f"{{'descr': '<i8', 'fortran_order': False, 'shape': ({len(numbers)},), }}".ljust(117).encode() + b'\n'
    content = b'\x93NUMPY\x01\x00' + struct.pack('<H', len(header)) + header + struct.pack(f'<{len(numbers)}q', *numbers)
    path.write_bytes(gzip.compress(content) if path.suffix == '.gz' else content)


class Resampling(CommandLine):
    def resample(self, *options, grid='ico:5', embedding='map'):
        return ['resample', f'{embedding}.ply', f'{embedding}.json', 'figure.obj', '--grid', grid, *options]

    def numbers(self, name):
        return [float(line) for line in (self.folder / name).read_text().split()]

    def setUp(self):
        self.heights = [vertex[1] for vertex in read_obj(self.folder / 'figure.obj')[0]]
        (self.folder / 'height.txt').write_text(''.join(f'{height!r}\n' for height in self.heights))

    def test_values_come_back(self):
        for grid in ('ico:6', 'healpix:64', 'equirectangular:256x128', 'octahedral:200', 'cube:80'):
            with self.subTest(grid):
                self.expect(0, *self.resample('--values', 'height.txt', '-o', 'there.npy', grid=grid), says='there.npy: [0-9]+ points, linear')
                self.expect(0, *self.resample('--values', 'there.npy', '--back', '-o', 'back.txt', grid=grid), says='vertices, linear')
                back = self.numbers('back.txt')
                self.assertEqual(len(back), len(self.heights))
                differences = sorted(abs(a - b) for a, b in zip(self.heights, back))
                self.assertLess(differences[len(back) // 2], 0.01)  # limbs shrink below the distance of the points

    def test_the_integral_is_said_and_kept(self):
        done = self.expect(0, *self.resample('--values', 'height.txt', '--kind', 'conservative', '-o', 'there.npz'))
        before, after = map(float, re.search(r'the integral is (\S+) before and (\S+) after', done.stderr).groups())
        self.assertAlmostEqual(before, after, delta=1e-9 * abs(before) + 1e-10)

    def test_least_squares_come_back_better(self):
        off = {}
        for kind in ('linear', 'least-squares'):
            self.expect(0, *self.resample('--values', 'height.txt', '--kind', kind, '-o', 'there.npy', grid='ico:6'), says=f'40962 points, {kind}')
            self.expect(0, *self.resample('--values', 'there.npy', '--kind', kind, '--back', '-o', 'back.txt', grid='ico:6'), says=f'vertices, {kind}')
            off[kind] = math.dist(self.heights, self.numbers('back.txt'))
        self.assertLess(off['least-squares'], 0.5 * off['linear'])
        self.expect(0, *self.resample('--values', 'height.txt', '--kind', 'least-squares', '-o', 'there.npz'))
        self.assertNotIn(b'indptr', (self.folder / 'there.npz').read_bytes())
        self.expect(IS_WRONG, *self.resample('--kind', 'least-squares', '-o', 'no.npz'), says='least-squares has no table')

    def test_images_are_written_and_read(self):
        self.expect(0, *self.resample('--values', 'height.txt', '-o', 'picture.png', grid='octahedral:64'), says='black is .*, white is ')
        self.assertTrue((self.folder / 'picture.png').read_bytes().startswith(b'\x89PNG'))
        self.expect(0, *self.resample('--values', 'picture.png', '--back', '-o', 'back.txt', grid='octahedral:64'))
        self.assertTrue(all(0 <= value <= 1 for value in self.numbers('back.txt')))

    def test_flat_orbifolds_have_flat_images(self):
        self.expect(0, *self.embed('figure.obj', '-o', 'flat.ply', '--report', 'flat.json', '--quiet', orbifold='442'))
        for grid in ('periodic:64', 'tile:64'):
            self.expect(0, *self.resample('--values', 'height.txt', '--pad', '2', '-o', 'image.npz', grid=grid, embedding='flat'))
        self.expect(IS_WRONG, *self.resample('--values', 'height.txt', '-o', 'no.txt', embedding='flat'), says='take periodic or tile')

    def test_what_is_compressed_is_the_same(self):
        for name in ('there.npy', 'there.txt', 'there.shape.gii'):
            with self.subTest(name):
                for ending in ('', '.gz'):
                    self.expect(0, *self.resample('--values', 'height.txt', '-o', name + ending, grid='octahedral:40'))
                    self.expect(0, *self.resample('--values', name + ending, '--back', '-o', f'back.npy{ending}', grid='octahedral:40'))
                self.assertEqual(gzip.decompress((self.folder / f'{name}.gz').read_bytes()), (self.folder / name).read_bytes())
                self.assertEqual(gzip.decompress((self.folder / 'back.npy.gz').read_bytes()), (self.folder / 'back.npy').read_bytes())

    def test_labels_in_an_array_stay_whole_numbers(self):
        labels = [1000 * (height > 0) + 3 for height in self.heights]
        for name in ('labels.npy', 'labels.npy.gz'):
            with self.subTest(name):
                write_whole_numbers(self.folder / name, labels)
                self.expect(0, *self.resample('--values', name, '-o', 'there.npy', grid='ico:6'), says='nearest')
                self.expect(0, *self.resample('--values', 'there.npy', '--back', '-o', 'back.npy', grid='ico:6'), says='nearest')
                for written in ('there.npy', 'back.npy'):
                    self.assertIn(b"'<i4'", (self.folder / written).read_bytes()[:128])
                numbers = (self.folder / 'back.npy').read_bytes()[128:]
                self.assertEqual(set(struct.unpack(f'<{len(labels)}i', numbers)), {3, 1003})

    def test_labels_of_a_table_keep_their_areas_if_nothing_else_is_asked_for(self):
        labels = ' '.join(str(int(height > 0)) for height in self.heights)
        (self.folder / 'halves.label.gii').write_text(
            '<?xml version="1.0"?><GIFTI Version="1.0" NumberOfDataArrays="1"><LabelTable><Label Key="0"><![CDATA[low]]></Label>'
            '<Label Key="1"><![CDATA[high]]></Label></LabelTable><DataArray Intent="NIFTI_INTENT_LABEL" DataType="NIFTI_TYPE_INT32" '
            f'ArrayIndexingOrder="RowMajorOrder" Dimensionality="1" Dim0="{len(self.heights)}" Encoding="ASCII" Endian="LittleEndian" '
            f'ExternalFileName="" ExternalFileOffset=""><Data>{labels}</Data></DataArray></GIFTI>')
        self.expect(0, *self.resample('--values', 'halves.label.gii', '-o', 'there.label.gii', grid='ico:6'), says='conservative')
        self.expect(0, *self.resample('--values', 'there.label.gii', '--back', '-o', 'back.label.gii', grid='ico:6'), says='conservative')
        self.expect(0, *self.resample('--values', 'halves.label.gii', '--kind', 'nearest', '-o', 'near.label.gii', grid='ico:6'), says='nearest')

    def test_a_sphere_is_a_grid(self):
        self.expect(0, 'embed', 'figure.obj', '--orbifold', 'sphere', '-o', 'sphere.ply', '--report', 'sphere.json', '--quiet')
        self.expect(0, *self.resample('--values', 'height.txt', '-o', 'same.txt', grid='sphere.ply', embedding='sphere'))
        self.assertLess(max(abs(a - b) for a, b in zip(self.heights, self.numbers('same.txt'))), 1e-9)
        self.expect(IS_WRONG, *self.resample('--values', 'height.txt', '-o', 'sphere.txt', grid='sphere.txt', embedding='sphere'), says='which is the sphere')
        self.expect(IS_UNSUITABLE, *self.resample('--values', 'height.txt', '-o', 'no.txt', grid='figure.obj', embedding='sphere'), says='sphere around the origin')

    def test_what_does_not_fit_is_told_and_nothing_is_written(self):
        (self.folder / 'short.txt').write_text('1\n2\n')
        for code, says, options, grid in (
                (IS_UNSUITABLE, 'short.txt has 2 values, but there are [0-9]+ vertices', ['--values', 'short.txt', '-o', 'no.npy'], 'ico:3'),
                (IS_UNSUITABLE, 'has 2 values, but there are 642 points', ['--values', 'short.txt', '--back', '-o', 'no.npy'], 'ico:3'),
                (IS_WRONG, 'it may be ico, healpix', ['--values', 'height.txt', '-o', 'no.npy'], 'mercator:5'),
                (IS_WRONG, 'power of two', ['--values', 'height.txt', '-o', 'no.npy'], 'healpix-nested:5'),
                (IS_WRONG, 'only images can have a margin', ['--values', 'height.txt', '--pad', '1', '-o', 'no.npy'], 'ico:3'),
                (IS_WRONG, 'are no image; write .npy', ['--values', 'height.txt', '-o', 'no.png'], 'ico:3'),
                (IS_WRONG, 'at most 32768 x 32768 pixels', ['--values', 'height.txt', '-o', 'no.png'], 'equirectangular:40000x20'),
                (IS_WRONG, 'at most 32768 x 32768 pixels', ['--values', 'height.txt', '--pad', '20', '-o', 'no.png'], 'equirectangular:32740x20'),
                (IS_WRONG, 'leave out .gz', ['--values', 'height.txt', '-o', 'no.npz.gz'], 'ico:3'),
                (IS_WRONG, 'leave out .gz', ['--values', 'height.txt', '-o', 'no.png.gz'], 'cube:8'),
                (IS_WRONG, 'each also with .gz', ['--values', 'height.txt', '-o', 'no.word.gz'], 'ico:3'),
                (IS_WRONG, 'without --values', ['-o', 'no.npy'], 'ico:3'),
                (IS_WRONG, '--kind is .cubic.; it may be linear', ['--values', 'height.txt', '--kind', 'cubic', '-o', 'no.npy'], 'ico:3'),
                (IS_A_FILE, 'cannot be read', ['--values', 'height.txt', '-o', 'no.npy'], 'none.ply')):
            with self.subTest(says):
                self.expect(code, *self.resample(*options, grid=grid), says=says)
                self.assertFalse((self.folder / options[-1]).exists())


class Streams(CommandLine):
    PRINTING = [['info', 'figure.obj'], ['info', 'figure.obj', '--json'], ['types'], ['types', '--json'], ['verify', 'map.ply', 'map.json', 'figure.obj'],
                ['verify', 'map.ply', 'map.json', 'figure.obj', '--json'], ['compare', 'figure.obj'], ['compare', 'figure.obj', '--json'],
                ['embed', 'figure.obj', '--orbifold', '432', '--cones', 'extremities', '--json'], ['--help'], ['embed', '--help'], ['--version']]

    def test_what_is_printed_arrives_or_the_exit_code_says_no(self):
        for arguments in self.PRINTING:
            with self.subTest(arguments):
                self.assertTrue(self.expect(0, *arguments).stdout)
                with open('/dev/full', 'w') as full:
                    self.expect(IS_A_FILE, *arguments, stdout=full, says='orbitutte: standard output cannot be written: .*space')
                self.expect(IS_A_FILE, *arguments, says='orbitutte: standard output cannot be written: ', stdout=None, preexec_fn=lambda: os.close(1))

    def test_a_command_that_prints_nothing_needs_no_standard_output(self):
        self.expect(0, *self.embed('figure.obj', '-o', 'closed.ply'), stdout=None, preexec_fn=lambda: os.close(1))
        self.assertEqual((self.folder / 'closed.ply').read_bytes(), (self.folder / 'map.ply').read_bytes())

    def test_messages_that_nobody_can_read_change_no_exit_code(self):
        with open('/dev/full', 'w') as full:
            for stderr, prepare in ((full, None), (None, lambda: os.close(2))):
                for code, arguments in ((0, self.embed('figure.obj', '-o', 'quiet.ply')), (IS_A_FILE, ['info', 'no.obj']), (IS_WRONG, ['nothing'])):
                    self.assertEqual(self.run_program(*arguments, stderr=stderr, preexec_fn=prepare).returncode, code, arguments)
        self.assertEqual((self.folder / 'quiet.ply').read_bytes(), (self.folder / 'map.ply').read_bytes())


class Euclidean(CommandLine):
    """The orbifolds of the plane, once they are rows of the table that `types` prints."""

    def setUp(self):
        if not re.search('^2222 ', self.run_program('types').stdout, re.MULTILINE):
            self.skipTest("'orbitutte types' does not list the Euclidean orbifolds yet")
        self.expect(0, 'sample', '--shape', 'mask', '--faces', 500, '-o', 'mask.obj')

    def test_symbols_of_the_plane_are_embedded_like_others(self):
        for symbol in ('333', '442', '632', '2222', '*333', '*442', '*632', '*2222'):
            with self.subTest(symbol):
                mesh = 'mask.obj' if symbol[0] == '*' else 'figure.obj'
                self.expect(0, *self.embed(mesh, '-o', 'flat.ply', '--report', 'flat.json', orbifold=symbol), says='certified: bijective')
                orbifold = json.loads((self.folder / 'flat.json').read_text())['orbifold']
                self.assertEqual((orbifold['signature'], orbifold['space'], orbifold['group_order']), (symbol, 'euclidean', None))
                verified = self.expect(0, 'verify', 'flat.ply', 'flat.json', mesh, '--theorem2')
                self.assertIn(f'theorem 2: not run: the theorem speaks of finite groups of the sphere, and {symbol} has none', verified.stdout)

    def test_compare_has_no_option_of_its_own_for_them(self):
        self.expect(IS_WRONG, 'compare', 'figure.obj', '--flat', '442', says="has no option '--flat'")


    def test_cones_with_the_angles_of_an_orbifold_are_that_orbifold(self):
        energies = []
        for options in (['222'], ['cones', '--angles', 'pi,pi,pi']):
            self.expect(0, 'embed', 'figure.obj', '--cones', 'extremities', '--report', 'cones.json', '--orbifold', *options)
            energies.append(json.loads((self.folder / 'cones.json').read_text())['energy'])
        self.assertAlmostEqual(*energies, delta=1e-9 * energies[0])

    def test_fitted_cones_that_are_not_certified_give_way_to_milder_ones_and_a_warning_says_so(self):
        self.expect(0, 'sample', '--faces', 600, '-o', 'coarse.obj')
        fitted = ['embed', 'coarse.obj', '--orbifold', 'cones', '--angles', 'fitted', '--cones', 'extremities', '--count']
        self.expect(0, *fitted, 16, '--report', 'milder.json', says=['warning: .*not certified; others, of a sigma of .* were taken', 'certified: bijective'])
        report = json.loads((self.folder / 'milder.json').read_text())
        self.assertLessEqual(max(cone['angle'] for cone in report['cones']), 3.2 * math.pi + 1e-9)
        self.assertTrue(any('were taken' in warning for warning in report['warnings']))
        self.assertNotIn('were taken', self.expect(0, *fitted, 5).stderr)


class WholeSphere(CommandLine):
    def setUp(self):
        self.expect(0, 'sample', '--shape', 'mask', '--faces', 500, '-o', 'mask.obj')

    def test_every_command_takes_the_whole_sphere_and_the_hemisphere(self):
        for symbol, name, mesh, order in (('1', 'sphere', 'figure.obj', 1), ('*', 'hemisphere', 'mask.obj', 2)):
            with self.subTest(symbol):
                self.expect(0, 'embed', mesh, '--orbifold', name, '-o', 'whole.ply', '--report', 'whole.json',
                            says=['certified: bijective', 'the quotient of a map onto .*222'])
                report = json.loads((self.folder / 'whole.json').read_text())
                self.assertEqual(report['orbifold'], {'signature': symbol, 'group_order': order, 'space': 'spherical'})
                self.assertEqual((report['quotient'], report['centre'], report['cones'], len(report['seams'])), (True, 'area', [], order - 1))
                files = ['whole.ply', 'whole.json']
                self.expect(0, 'verify', *files, mesh)
                self.expect(0, 'tile', *files, '-o', 'tiling.ply')
                self.expect(0, 'export', *files, mesh, '-o', 'textured.obj')
                self.expect(0, 'report', *files, mesh, '-o', 'page.html')
                self.expect(0, 'render', *files, mesh, '-o', 'sheet.png', '--size', '400x300')

    def test_the_whole_sphere_has_no_stereographic_chart(self):
        self.expect(0, 'embed', 'figure.obj', '--orbifold', '1', '-o', 'whole.ply', '--report', 'whole.json')
        self.expect(IS_WRONG, 'export', 'whole.ply', 'whole.json', 'figure.obj', '-o', 'm.obj', '--chart', 'stereographic',
                    says='at infinity; take equirectangular or octahedral')

    def test_what_asks_for_another_map_is_refused(self):
        for options, says in ((['1', '--cones', '1,2,3'], 'leave out --cones: 1 marks no vertex; --points'),
                              (['1', '--centre', 'middle'], "--centre is 'middle'"),
                              (['432', '--cones', 'best', '--centre', 'area'], '432 is no map to the whole sphere'),
                              (['432', '--cones', 'best', '--quotient'], 'the quotient of a map to 432 is not known')):
            with self.subTest(options):
                self.expect(IS_WRONG, 'embed', 'figure.obj', '--orbifold', *options, says=says)
        self.expect(IS_UNSUITABLE, 'embed', 'mask.obj', '--orbifold', 'sphere', says='fill the hole, or choose an orbifold for a disk')

    def test_points_and_quotients(self):
        (self.folder / 'points.txt').write_text('0 0 0 1\n100 1 0 0\n200 0 1 0\n')
        self.expect(0, 'embed', 'figure.obj', '--orbifold', '1', '--points', 'points.txt', '-o', 'whole.ply', '--report', 'whole.json')
        self.expect(0, 'verify', 'whole.ply', 'whole.json', 'figure.obj')
        report = json.loads((self.folder / 'whole.json').read_text())
        self.assertEqual([at['vertex'] for at in report['points']], [0, 100, 200])
        (self.folder / 'points.txt').write_text('0 0 0 1\n100 0 0 1\n')
        self.expect(IS_WRONG, 'embed', 'figure.obj', '--orbifold', '1', '--points', 'points.txt', says='they or their points are the same')
        self.expect(0, *self.embed('figure.obj', '--quotient', '-o', 'whole.ply', '--report', 'whole.json', orbifold='22'))
        self.expect(0, 'verify', 'whole.ply', 'whole.json', 'figure.obj')

    def test_a_report_that_names_another_centre_is_refused(self):
        self.expect(0, 'embed', 'figure.obj', '--orbifold', '1', '--centre', 'vertices', '-o', 'whole.ply', '--report', 'whole.json')
        report = json.loads((self.folder / 'whole.json').read_text())
        report['centre'] = 'area'
        (self.folder / 'whole.json').write_text(json.dumps(report))
        done = self.run_program('verify', 'whole.ply', 'whole.json', 'figure.obj')
        self.assertEqual(done.returncode, IS_NOT_CERTIFIED)
        self.assertIn('report_centre', done.stdout + done.stderr)


class BrainFiles(CommandLine):
    files = ['map.ply', 'map.json', 'figure.obj']

    def test_measures_are_written_and_printed(self):
        vertices = len(read_obj(self.folder / 'figure.obj')[0])
        done = self.expect(0, 'measure', *self.files, '-o', 'strain.csv')
        lines = (self.folder / 'strain.csv').read_text().splitlines()
        self.assertEqual((lines[0], len(lines)), ('"log2 area","log2 J","log2 R","log2 edge"', vertices + 1))
        self.assertEqual([line.split()[0] for line in done.stdout.splitlines()], ['log2', 'area', 'J', 'R', 'edge'])
        self.assertIn('0 is no distortion', done.stderr)
        self.expect(0, 'measure', *self.files, '--faces', '--measure', 'R', '-o', 'faces.txt', '--quiet')
        elongations = [float(line) for line in (self.folder / 'faces.txt').read_text().splitlines()]
        self.assertEqual(len(elongations), 500)
        self.assertGreaterEqual(min(elongations), 0)
        strain = json.loads((self.folder / 'map.json').read_text())['distortion']['strain']
        self.assertEqual(json.loads(self.expect(0, 'measure', *self.files, '--json').stdout), strain)
        self.expect(0, 'measure', *self.files, '--measure', 'J', '-o', 'lh.J.curv')

    def test_measures_that_cannot_be_written_are_refused(self):
        self.expect(IS_WRONG, 'measure', *self.files, '--measure', 'K', says='area, J, R, edge or all')
        for radius in (-1, 0):
            self.expect(IS_WRONG, 'measure', *self.files, '--radius', radius, says=f'--radius is {radius}; give a positive number')
        self.expect(IS_WRONG, 'measure', *self.files, '--faces', '-o', 'x.shape.gii', says='values of vertices; write those of faces as')
        self.expect(IS_WRONG, 'measure', *self.files, '-o', 'x.curv', says='hold one map, but there are 4')
        self.assertFalse((self.folder / 'x.curv').exists())
        self.expect(0, 'sample', '--faces', 700, '-o', 'other.obj')
        self.expect(IS_UNSUITABLE, 'measure', 'map.ply', 'map.json', 'other.obj', says='does not belong to this mesh')

    def test_the_sphere_is_a_surface_of_radius_100(self):
        self.expect(0, 'embed', 'figure.obj', '--orbifold', '1', '-o', 'whole.ply', '--report', 'whole.json')
        whole = ['whole.ply', 'whole.json', 'figure.obj']
        self.expect(0, 'export', *whole, '-o', 'lh.sphere', says='the sphere of radius 100')
        self.expect(0, 'export', *whole, '-o', 'lh.sphere.surf.gii', '--radius', 2)
        for name, radius in (('lh.sphere', 100), ('lh.sphere.surf.gii', 2)):
            info = json.loads(self.expect(0, 'info', name, '--json').stdout)
            self.assertEqual((info['topology'], info['faces']), ('sphere', 500))
            self.assertLess(abs(info['area'] / (4 * math.pi * radius ** 2) - 1), 0.2)
        self.expect(IS_WRONG, 'export', *whole, '-o', 'x.sphere', '--radius', 0, says='--radius is 0; give a positive number')
        self.expect(IS_WRONG, 'export', *whole, '-o', 'x.sphere', '--radius', 1e300, says='single precision')
        self.expect(0, *self.embed('figure.obj', '-o', 'flat.ply', '--report', 'flat.json', orbifold='442'))
        self.expect(IS_WRONG, 'export', 'flat.ply', 'flat.json', 'figure.obj', '-o', 'x.sphere', says='only spheres are written as surfaces')

    def test_the_page_shows_values(self):
        self.expect(0, 'measure', *self.files, '-o', 'strain.shape.gii', '--quiet')
        self.expect(0, 'report', *self.files, '--values', 'strain.shape.gii', '--map', 'log2 J', '-o', 'page.html', says='colours of vertices from -')
        self.expect(0, 'report', *self.files, '--values', 'strain.shape.gii', '--map', 3, '-o', 'page.html')
        self.expect(IS_WRONG, 'report', *self.files, '--values', 'strain.shape.gii', '--map', 'log2 K', '-o', 'x.html', says="there is no map 'log2 K'")
        (self.folder / 'short.txt').write_text('1\n2\n')
        self.expect(IS_UNSUITABLE, 'report', *self.files, '--values', 'short.txt', '-o', 'x.html', says='values of 2 vertices, but the mesh has')
        self.expect(IS_WRONG, 'report', *self.files, '--map', 'J', '-o', 'x.html', says='--values')
        self.assertFalse((self.folder / 'x.html').exists())


class Messages(CommandLine):
    def mesh(self, name, vertices, faces):
        write_obj(self.folder / name, vertices, faces)
        return name

    def test_what_is_left_out_is_chosen_and_the_report_says_what(self):
        self.expect(0, 'embed', 'figure.obj', '--report', 'best.json', says='chosen of 5 families for the least sigma: --orbifold .* --cones .*')
        report = json.loads((self.folder / 'best.json').read_text())
        rows, taken = report['choice']['choices'], report['choice']['taken']
        self.assertEqual([cone['vertex'] for cone in report['cones']], rows[taken]['cones'])
        self.assertEqual(report['orbifold']['signature'], rows[taken]['orbifold'])
        self.assertTrue(rows[taken]['bijective'])
        self.expect(0, 'embed', 'figure.obj', '--orbifold', '432', '--cones', '5,best,best', '--report', 'kept.json')
        kept = json.loads((self.folder / 'kept.json').read_text())
        self.assertEqual((kept['orbifold']['signature'], kept['cones'][0]['vertex']), ('432', 5))

    def test_the_summary_speaks_of_a_choice_only_where_there_was_one(self):
        for symbol, says in (('432', 'chosen for the least sigma: --orbifold 432 --cones '),
                             ('7,3,2', 'extremities, since nothing predicts better vertices for 7,3,2: --orbifold 7,3,2 --cones ')):
            done = self.expect(0, 'embed', 'figure.obj', '--orbifold', symbol, says=says)
            self.assertNotIn('famil', done.stderr)

    def test_choose_lists_every_family_the_best_first(self):
        table = json.loads(self.expect(0, 'choose', 'figure.obj', '--solved', '1', '--json', '-o', 'table.json').stdout)
        self.assertEqual(table, json.loads((self.folder / 'table.json').read_text()))
        sigmas = [row['predicted']['sigma'] for row in table['choices']]
        self.assertEqual((len(sigmas), sigmas), (5, sorted(sigmas)))
        self.assertEqual([row.get('bijective') for row in table['choices']], [True] + 4 * [None])
        self.assertIn('certified', self.expect(0, 'choose', 'figure.obj', '--orbifold', '432').stdout)

    def test_choose_draws_the_scale_and_the_candidates(self):
        picture = self.folder / 'scale.png'
        self.expect(0, 'choose', 'figure.obj', '--orbifold', '432', '--solved', '1', '--picture', picture)
        self.assertTrue(picture.read_bytes().startswith(b'\x89PNG'))
        self.expect(IS_WRONG, 'choose', 'figure.obj', '--orbifold', '432', '--solved', '0', '--picture', picture, says='--solved')
        self.expect(IS_WRONG, 'choose', 'figure.obj', '--picture', self.folder / 'scale.jpg', says='.png')

    def test_cones_that_no_orbifold_takes_are_refused(self):
        self.expect(IS_WRONG, 'embed', 'figure.obj', '--cones', '1,two,3', says="'best' in place of those")
        self.expect(IS_WRONG, 'embed', 'figure.obj', '--objective', 'least', says='--objective.*sigma')
        self.expect(IS_UNSUITABLE, 'embed', 'figure.obj', '--cones', 'best,best,best,best', says='takes 4 marked vertices')
        self.expect(IS_UNSUITABLE, 'embed', 'figure.obj', '--cones', '99999999,best,best', says='vertex 99999999')
        self.expect(IS_UNSUITABLE, 'embed', 'figure.obj', '--orbifold', '432', '--cones', 'best,best', says='432 needs 3 marked vertices')

    def test_a_file_of_weights_that_the_embedding_does_not_have_is_refused(self):
        self.expect(IS_WRONG, 'verify', 'map.ply', 'map.json', 'figure.obj', '--weights-file', 'map.ply', says='which need no file; leave out')

    def test_every_command_that_writes_a_file_names_it(self):
        self.expect(0, 'render', 'map.ply', 'map.json', 'figure.obj', '--panel', 'histogram', '-o', 'plot.svg', says='plot.svg: histogram of map.ply')
        self.expect(0, 'report', 'map.ply', 'map.json', 'figure.obj', '-o', 'page.html', says='page.html: page of map.ply')

    def test_missing_angles_and_letters_for_orders_are_told(self):
        self.expect(IS_WRONG, 'embed', 'figure.obj', '--orbifold', 'cones', '--cones', '1,2,3', says='one for each marked vertex')
        self.expect(IS_WRONG, 'embed', 'figure.obj', '--orbifold', 'N*', says='put a number for it')

    def test_projective_planes_are_told_in_words(self):
        self.expect(0, 'sample', '--shape', 'boy', '--faces', 500, '-o', 'boy.obj')
        self.expect(0, 'embed', 'boy.obj', '--cones', 'extremities', says=['a projective plane, onto', 'chosen of 3 maps for the least sigma'])

    def test_a_mesh_with_a_small_hole_names_it_and_both_remedies(self):
        vertices, faces = read_obj(self.folder / 'figure.obj')
        hole = faces[7]
        mesh = self.mesh('hole.obj', vertices, faces[:7] + faces[8:])
        for cones in ('extremities', '1,2,3'):
            self.expect(IS_UNSUITABLE, *self.embed(mesh, cones=cones),
                        says=[f'hole of 3 edges, through vertex {min(hole)}\\b', 'fill the hole', r'orbifold for a disk, such as \*432'])

    def test_a_mesh_that_is_inside_out_is_embedded_with_a_warning(self):
        vertices, faces = read_obj(self.folder / 'figure.obj')
        self.assertNotIn('inside out', self.expect(0, *self.embed('figure.obj')).stderr)
        self.expect(0, *self.embed(self.mesh('turned.obj', vertices, [face[::-1] for face in faces])), says='warning: the mesh is inside out.*volume')
        far = [(x + 1e4, y, z) for x, y, z in vertices]  # the volume does not depend on where the mesh is
        self.assertNotIn('inside out', self.expect(0, *self.embed(self.mesh('far.obj', far, faces))).stderr)

    def test_what_is_not_certified_says_how_many_faces_and_what_may_help(self):
        vertices, faces = square_with_ribbon(40)
        mesh = self.mesh('ribbon.obj', vertices, faces)
        for quiet in ([], ['--quiet']):
            done = self.expect(IS_NOT_CERTIFIED, *self.embed(mesh, '--report', 'ribbon.json', *quiet, cones='0,4,24', orbifold='*432'),
                               says=['What may help: mark a vertex.*--cones.*split an edge', '41 faces must become arcs or points.*not 3-connected'])
            count, total, first = map(int, re.search(r'not certified: (\d+) of (\d+) faces are not positive on the sphere, the first face (\d+)',
                                                     done.stderr).groups())
            found = json.loads((self.folder / 'ribbon.json').read_text())['certificate']['nonpositive_faces']
            self.assertEqual((count, total, first), (len(found), len(faces), found[0]))

    def test_what_did_not_converge_says_what_may_help(self):
        self.expect(IS_NOT_CONVERGED, *self.embed('figure.obj', '--max-iterations', 1), says=['not certified', 'What may help: .*--max-iterations'])

    def test_the_summary_has_the_numbers_of_the_report(self):
        done = self.expect(0, *self.embed('figure.obj', '--report', 'summary.json'))
        distortion = json.loads((self.folder / 'summary.json').read_text())['distortion']
        self.assertIn(f"area: within a factor of 4 of the mean scale on {100 * distortion['within_4']:.1f} % of the surface, "
                      f"shrunk by more than 64 on {100 * distortion['below_64']:.1f} %\n", done.stderr)
        self.assertIn(f"angles: median distortion {distortion['angle']['median']:.4g}, where 1 is none\n", done.stderr)
        self.assertTrue(0 < distortion['within_4'] <= 1 and 0 <= distortion['below_64'] <= 1 - distortion['within_4'] and distortion['sigma'] > 0)


class StandardInput(CommandLine):
    def pipe(self, code, *arguments, given, says=()):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, input=given, capture_output=True)
        stderr = done.stderr.decode()
        self.assertEqual(done.returncode, code, f'{arguments}: {stderr}')
        for pattern in [says] if isinstance(says, str) else says:
            self.assertRegex(stderr, pattern)
        return done.stdout.decode()

    def test_every_format_reads_from_a_pipe_as_from_a_file(self):
        expected = self.run_program('info', 'figure.obj', '--json').stdout
        for name, ending in [('off', 'off'), ('ply', 'ply'), ('stl', 'stl'), ('vtk', 'vtk'), ('gifti', 'gii'), ('obj', 'obj')]:
            with self.subTest(name):
                self.run_program('repair', 'figure.obj', '-o', f'in.{ending}')
                content = (self.folder / f'in.{ending}').read_bytes()
                from_file = json.loads(self.run_program('info', f'in.{ending}', '--json').stdout)
                for given in (content, gzip.compress(content)):
                    from_pipe = json.loads(self.pipe(0, 'info', '-', '--format', name, '--json', given=given))
                    self.assertEqual(from_pipe.pop('path', '-'), '-')
                    from_file.pop('path', None)
                    self.assertEqual(from_pipe, from_file)
        self.assertTrue(expected)

    def test_an_embedding_of_a_pipe_is_that_of_the_file(self):
        content = (self.folder / 'figure.obj').read_bytes()
        self.pipe(0, *self.embed('-', '--format', 'obj', '-o', 'piped.ply', '--report', 'piped.json'), given=content)
        self.assertEqual((self.folder / 'piped.ply').read_bytes(), (self.folder / 'map.ply').read_bytes())
        reports = [json.loads((self.folder / name).read_text()) for name in ('piped.json', 'map.json')]
        self.assertEqual(reports[0]['mesh']['path'], '-')
        self.assertEqual(*(report['environment']['input_sha256'] for report in reports))
        self.pipe(0, 'verify', 'piped.ply', 'piped.json', '-', '--format', 'obj', given=content)
        self.pipe(0, 'export', 'piped.ply', 'piped.json', '-', '--format', 'obj', '-o', 'piped.obj', given=content)
        self.pipe(0, 'repair', '-', '--format', 'obj', '-o', 'repaired.off', given=content)

    def test_what_is_missing_or_wrong_is_one_sentence(self):
        for command in (['info', '-'], self.embed('-'), ['repair', '-', '-o', 'x.off'], ['choose', '-'], ['compare', '-'], ['map', '-', 'figure.obj']):
            with self.subTest(command):
                self.pipe(IS_WRONG, *command, given=b'', says='comes from standard input, whose format no ending names; give --format obj, ')
        self.pipe(IS_WRONG, 'info', '-', '--format', 'step', given=b'', says="--format is 'step'; it may be obj")
        self.pipe(IS_UNSUITABLE, 'info', '-', '--format', 'off', given=b'', says='-: the file is empty')
        self.pipe(IS_UNSUITABLE, 'info', '-', '--format', 'off', given=b'OFF 1', says='^orbitutte: -: ')
        self.pipe(IS_WRONG, 'map', '-', '-', '--format', 'obj', given=b'', says='both surfaces come from standard input')

    def test_a_format_goes_before_the_ending(self):
        shutil.copy(self.folder / 'figure.obj', self.folder / 'figure.dat')
        self.expect(IS_WRONG, 'info', 'figure.dat', says='names no known mesh format')
        self.expect(0, 'info', 'figure.dat', '--format', 'obj')


class Repair(CommandLine):
    """embed --repair"""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        vertices, faces = read_obj(cls.folder / 'figure.obj')
        cls.count = len(vertices)
        faces[7] = faces[7][::-1]
        faces.append(faces[3])
        # the corners of the last but one face at vertices of their own
        doubled = faces[-2]
        faces[-2] = [len(vertices) + k for k in range(3)]
        vertices += [vertices[v] for v in doubled]
        # a component of its own
        faces.append([len(vertices) + k for k in range(3)])
        vertices += [(9.0, 9.0, 9.0), (9.0, 9.1, 9.0), (9.1, 9.0, 9.0)]
        write_obj(cls.folder / 'broken.obj', vertices, faces)
        cls.doubled = doubled

    def report(self, name='out.json'):
        return json.loads((self.folder / name).read_text())

    def test_a_broken_mesh_is_embedded_and_the_report_says_what_was_done(self):
        cones = ','.join(str(cone['vertex']) for cone in self.report('map.json')['cones'])
        self.expect(IS_UNSUITABLE, *self.embed('broken.obj', cones=cones))
        self.expect(0, *self.embed('broken.obj', '--repair', '-o', 'out.ply', '--report', 'out.json', cones=cones), says=['^weld: 3 vertices', 'orient: 1 face', 'keep_largest: 1 smaller'])
        report = self.report()
        self.assertEqual([step['step'] for step in report['repair']['steps']], ['weld', 'drop_duplicates', 'orient', 'keep_largest'])
        self.assertEqual(report['repair']['added_vertices'], [])
        self.assertEqual(report['cones'][0]['vertex'], self.report('map.json')['cones'][0]['vertex'])
        self.assertAlmostEqual(report['energy'], self.report('map.json')['energy'], places=9)
        self.expect(0, 'verify', 'out.ply', 'out.json', 'broken.obj')
        self.expect(0, 'export', 'out.ply', 'out.json', 'broken.obj', '-o', 'out.obj')
        self.expect(0, 'report', 'out.ply', 'out.json', 'broken.obj', '-o', 'out.html')

    def test_cones_follow_the_repair(self):
        far = [v for v in range(self.count) if v not in self.doubled][:2]
        done = self.expect(0, *self.embed('broken.obj', '--repair', '--report', 'out.json', cones=f'{self.count},{far[0]},{far[1]}'),
                           says=f'warning: vertex {self.count} was welded to vertex {self.doubled[0]}')
        self.assertEqual(self.report()['cones'][0]['vertex'], self.doubled[0], done.stderr)
        self.expect(IS_UNSUITABLE, *self.embed('broken.obj', '--repair', cones=f'{self.count + 4},{far[0]},{far[1]}'),
                    says=f'vertex {self.count + 4} is marked, but no face at it is left after the repair')

    def test_a_sound_mesh_is_left_as_it_is(self):
        self.expect(0, *self.embed('figure.obj', '--repair', '-o', 'out.ply', '--report', 'out.json'), says='nothing had to be repaired')
        self.assertEqual((self.folder / 'out.ply').read_bytes(), (self.folder / 'map.ply').read_bytes())
        self.assertEqual(self.report()['repair'], {'steps': [], 'added_vertices': []})

    def test_what_cannot_be_repaired_says_so(self):
        (self.folder / 'nothing.off').write_text('OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 0 1\n')
        self.expect(IS_UNSUITABLE, *self.embed('nothing.off', '--repair'), says='no face is left after the repair')


if __name__ == '__main__':
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
