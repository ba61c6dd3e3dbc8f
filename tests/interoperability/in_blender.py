# SPDX-License-Identifier: MIT
"""Run by Blender: imports every model of a folder and prints what came in."""
import json
import pathlib
import sys

import bpy
import numpy

numpy.bool = bool  # the glTF importer of Debian 12's Blender asks for this name, which its NumPy no longer has

folder = pathlib.Path(sys.argv[sys.argv.index('--') + 1])

IMPORTERS = {'.obj': lambda path: bpy.ops.wm.obj_import(filepath=path, forward_axis='Y', up_axis='Z'),
             '.ply': lambda path: bpy.ops.import_mesh.ply(filepath=path),
             '.glb': lambda path: bpy.ops.import_scene.gltf(filepath=path, merge_vertices=False)}


def imported(path):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    IMPORTERS[path.suffix](str(path))
    meshes = [thing.data for thing in bpy.data.objects if thing.type == 'MESH']
    assert len(meshes) == 1, f'{path.name}: {len(meshes)} meshes'
    mesh = meshes[0]
    assert not mesh.validate(), f'{path.name}: Blender had to mend the mesh'
    return {'positions': [list(v.co) for v in mesh.vertices], 'faces': [list(face.vertices) for face in mesh.polygons],
            'triangles': sum(len(face.vertices) - 2 for face in mesh.polygons),
            'uv': [list(corner.uv) for corner in mesh.uv_layers[0].data] if mesh.uv_layers else [],
            'colours': len(mesh.color_attributes)}


print('ANSWER ' + json.dumps({path.name: imported(path) for name in ('triangles', 'quads')
                              for path in (folder / f'{name}-model.obj', folder / f'{name}-model.ply', folder / f'{name}-model.glb',
                                           folder / f'{name}-tiling.glb')}))
