# SPDX-License-Identifier: MIT
# From arrays to a certified embedding, a closed mesh of its copies, and a picture: PYTHONPATH=build/python python3 examples/first_steps.py
import numpy as np
import orbitutte

V, F = orbitutte.sample_mesh("figure", 5000)  # or orbitutte.read_mesh("mesh.obj"), or arrays of your own
print(orbitutte.info(V, F)["embeds_into"])

embedding = orbitutte.embed(V, F, "432")
print(embedding)
print("angle distortion:", np.round(np.percentile(embedding.angle_distortion, [50, 95, 100]), 3))

sphere = orbitutte.tile(embedding)  # 24 copies, welded
orbitutte.write_mesh("tiling.obj", sphere.V, sphere.F)

north = embedding.locate([0, 0, 1])  # what lies at the north pole?
print("north pole: triangle", north.triangle, "of copy", north.copy, "at", embedding.source_points(north.triangle, north.barycentric))

embedding.save("map.ply", "map.json")  # as the command line writes them
embedding.render("map.png", size=(800, 614))  # mesh, sphere, distortion and more on one sheet
