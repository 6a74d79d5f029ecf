#!/usr/bin/env python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts the teeth out of labelled arches: one binary PLY a tooth.

cut_labelled.py OUTPUT_FOLDER SCAN.ply...   with SCAN.json beside each (Teeth3DS: "labels", an FDI number or 0 per vertex)

A triangle belongs to a tooth if its three corners bear the tooth's label; of several pieces the one with most triangles
is written. Files are named SCAN_FDI.ply.
"""

import json
import pathlib
import struct
import sys

FEWEST_TRIANGLES = 50  # fewer are no tooth
STRUCT_OF = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f",
             "double": "d", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I",
             "float32": "f", "float64": "d"}


def read_ply(path):
    """Vertices (x, y, z) and triangles of a binary little-endian PLY file whose faces are all triangles."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii").split("\n")
    if "format binary_little_endian 1.0" not in header:
        raise SystemExit(f"{path}: only binary little-endian PLY is read here")
    counts, properties, element = {}, {}, None
    for line in header:
        words = line.split()
        if words[:1] == ["element"]:
            element = words[1]
            counts[element], properties[element] = int(words[2]), []
        elif words[:1] == ["property"]:
            properties[element].append(words[1:])
    row = struct.Struct("<" + "".join(STRUCT_OF[p[0]] for p in properties["vertex"]))
    names = [p[1] for p in properties["vertex"]]
    place = [names.index(axis) for axis in "xyz"]
    vertices = [tuple(row.unpack_from(data, end + i * row.size)[k] for k in place) for i in range(counts["vertex"])]
    at = end + counts["vertex"] * row.size
    face = struct.Struct("<" + STRUCT_OF[properties["face"][0][1]] + 3 * STRUCT_OF[properties["face"][0][2]])
    triangles = []
    for _ in range(counts["face"]):
        corners = face.unpack_from(data, at)
        if corners[0] != 3:
            raise SystemExit(f"{path}: a face is no triangle")
        triangles.append(corners[1:])
        at += face.size
    return vertices, triangles


def largest_piece(triangles):
    parent = {}

    def find(v):
        while parent.setdefault(v, v) != v:
            parent[v] = parent[parent[v]]
            v = parent[v]
        return v

    for a, b, c in triangles:
        parent[find(a)] = find(b)
        parent[find(b)] = find(c)
    pieces = {}
    for t in triangles:
        pieces.setdefault(find(t[0]), []).append(t)
    return max(pieces.values(), key=len, default=[])


def write_ply(path, vertices, triangles):
    used = sorted({v for t in triangles for v in t})
    number = {v: i for i, v in enumerate(used)}
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(used)}\nproperty float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    body = b"".join(struct.pack("<3f", *vertices[v]) for v in used)
    body += b"".join(struct.pack("<B3i", 3, *(number[v] for v in t)) for t in triangles)
    path.write_bytes(header.encode("ascii") + body)


def main():
    if len(sys.argv) < 3:
        raise SystemExit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for scan in map(pathlib.Path, sys.argv[2:]):
        vertices, triangles = read_ply(scan)
        labels = json.loads(scan.with_suffix(".json").read_text())["labels"]
        if len(labels) != len(vertices):
            raise SystemExit(f"{scan}: {len(labels)} labels for {len(vertices)} vertices")
        for fdi in sorted(set(labels) - {0}):
            tooth = largest_piece([t for t in triangles if all(labels[v] == fdi for v in t)])
            if len(tooth) >= FEWEST_TRIANGLES:
                write_ply(folder / f"{scan.stem}_{fdi}.ply", vertices, tooth)


if __name__ == "__main__":
    main()
