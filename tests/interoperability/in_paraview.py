# SPDX-License-Identifier: MIT
"""Run by pvpython: opens the models of a folder as ParaView does and prints what came in."""
import json
import pathlib
import sys

from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

folder = pathlib.Path(sys.argv[1])


def names(data):
    return [data.GetArrayName(k) for k in range(data.GetNumberOfArrays())]


def opened(path):
    reader = simple.OpenDataFile(str(path))
    reader.UpdatePipeline()
    data = simple.servermanager.Fetch(reader)
    result = {'points': data.GetNumberOfPoints(), 'cells': data.GetNumberOfCells(),
              'point_arrays': names(data.GetPointData()), 'cell_arrays': names(data.GetCellData())}
    if path.suffix == '.vtp':
        radius = (vtk_to_numpy(data.GetPointData().GetArray('sphere')) ** 2).sum(axis=1) ** 0.5
        vertices = vtk_to_numpy(data.GetPointData().GetArray('source_vertex'))
        result['radius'] = [float(radius.min()), float(radius.max())]
        result['source_vertices'] = [int(vertices.min()), int(vertices.max())]
    return result


print('ANSWER ' + json.dumps({path.name: opened(path) for name in ('triangles', 'quads')
                              for path in (folder / f'{name}-model.vtp', folder / f'{name}-model.ply')}))
