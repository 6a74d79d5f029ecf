# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Open3D's screened Poisson reconstruction, for bench_poisson.

usage: open3d_poisson.py SAMPLES.bin DEPTH THREADS RUNS MESH.bin
SAMPLES.bin: rows of six doubles, point and normal. Prints the seconds of the fastest of RUNS runs; MESH.bin gets the
numbers of vertices and triangles (two 64-bit integers), the vertices (doubles) and the triangles (32-bit integers).
"""
import sys
import time

import numpy as np
import open3d

rows = np.fromfile(sys.argv[1]).reshape(-1, 6)
cloud = open3d.geometry.PointCloud()
cloud.points = open3d.utility.Vector3dVector(rows[:, :3])
cloud.normals = open3d.utility.Vector3dVector(rows[:, 3:])
best = float("inf")
for _ in range(int(sys.argv[4])):
    start = time.perf_counter()
    mesh, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(
        cloud, depth=int(sys.argv[2]), n_threads=int(sys.argv[3]))
    best = min(best, time.perf_counter() - start)
vertices = np.asarray(mesh.vertices, dtype=np.float64)
triangles = np.asarray(mesh.triangles, dtype=np.int32)
with open(sys.argv[5], "wb") as out:
    np.array([len(vertices), len(triangles)], dtype=np.int64).tofile(out)
    vertices.tofile(out)
    triangles.tofile(out)
print(best)
