#!/usr/bin/python3
# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program and the oracle on pairs of crown and tooth and ends with 1 where they disagree."""
import json
import math
import os
import subprocess
import sys
import tempfile

import numpy
from meshtools import read_any, write_ply
from judge import judge

SOLID = {  # ours: the oracle's
    "vertices": "vertices",
    "triangles": "faces",
    "unreferenced_vertices": "unused",
    "border_edges": "boundary_edges",
    "non_manifold_edges": "nonmanifold_edges",
    "misoriented_edges": "misoriented_edges",
    "non_manifold_vertices": "nonmanifold_vertices",
    "components": "components",
    "euler_number": "euler",
}
QUALITY = {
    "q_avg": "Q_avg",
    "q_min": "Q_min",
    "theta_avg": "theta_avg",
    "theta_min": "theta_min",
    "theta_max": "theta_max",
    "percent_below_30": "below30",
}


def run(program, *arguments):
    """The figures the program prints, and its exit code."""
    done = subprocess.run([program, *arguments, "--json"], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 4):
        raise SystemExit(f"{arguments}: exit {done.returncode}: {done.stderr}")
    return json.loads(done.stdout), done.returncode


def equal(what, ours, theirs, problems, tolerance=0.0):
    """Notes a difference."""
    if ours is None or theirs is None:
        same = ours is None and theirs is None
    else:
        same = math.isclose(ours, theirs, rel_tol=tolerance, abs_tol=tolerance)
    if not same:
        problems.append(f"{what}: {ours} here, {theirs} there")


def compare(program, crown, tooth):
    """The differences on one pair, as sentences."""
    crown_v, crown_f, _ = read_any(crown)
    tooth_v, tooth_f, _ = read_any(tooth)
    theirs = judge(crown_v, crown_f, tooth_v, tooth_f)
    ours, code = run(program, "check", crown, tooth, "--least-kept", "0")
    measured, _ = run(program, "measure", tooth)
    problems = []
    equal("crown triangles", ours["crown"]["triangles"], theirs["crown"]["faces"], problems)
    equal("kept", ours["crown"]["kept_triangles"], theirs["crown"]["kept"], problems)
    equal("broken", len(ours["crown"]["broken_triangles"]), theirs["crown"]["broken"], problems)
    for mine, other in SOLID.items():
        equal(mine, ours["solid"][mine], theirs["topology"][other], problems)
        equal("measured " + mine, measured["topology"][mine], theirs["topology"][other], problems)
    if not theirs["topology"]["boundary_edges"]:
        equal("volume", ours["solid"]["volume_mm3"], theirs["topology"]["volume"], problems, 1e-6)
    # The oracle works with rounding, ours is exact: they must agree on whether there are any. A triangle that is there
    # twice meets itself for us, and for the oracle is a neighbour of itself.
    pairs = theirs["topology"]["self_intersections"]
    if pairs is not None and not theirs["topology"]["nonmanifold_edges"]:
        equal("cuts itself", bool(ours["solid"]["self_intersections"]), bool(pairs), problems)
    for key, other in (("quality_new_triangles", "quality_root"), ("quality_all_triangles", "quality_all")):
        for mine, name in QUALITY.items():
            left = ours[key][mine] if ours[key] else None
            right = theirs[other][name] if theirs[other] else None
            equal(f"{key} {mine}", left, right, problems, 1e-6)
    for mine, name in QUALITY.items():
        equal(f"measured {mine}", measured["quality"][mine], theirs["quality_all"][name], problems, 1e-6)
    promised = theirs["topology"]["ok"] and theirs["crown"]["kept"] > 0 and theirs["crown"]["broken"] == 0
    equal("promises hold", ours["holds"], promised, problems)
    equal("exit code", code, 0 if promised else 4, problems)
    return problems


def ball(levels=3):
    """A sphere of radius 4 mm as vertices and faces."""
    vertices = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    vertices = [numpy.array(v, float) for v in vertices]
    for _ in range(levels):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(vertices)
                m = vertices[a] + vertices[b]
                vertices.append(m / numpy.linalg.norm(m))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        faces = finer
    return numpy.array(vertices) * 4, numpy.array(faces)


def broken_pairs(folder):
    """Pairs that break a promise in one way each, written to a folder."""
    v, f = ball()
    crown_faces = f[(v[f][:, :, 2] > 0.5).all(1)]
    root = numpy.flatnonzero((v[f][:, :, 2] < -1).all(1))
    top = numpy.flatnonzero((v[f][:, :, 2] > 2).all(1))
    pairs = {"good": (v, f)}
    pairs["open"] = (v, numpy.delete(f, root[0], 0))
    pairs["inside_out"] = (v, f[:, ::-1])
    flipped = f.copy()
    flipped[top[0]] = flipped[top[0], ::-1]
    pairs["flipped"] = (v, flipped)
    moved = v.copy()
    moved[f[top[3], 0]] += 0.01
    pairs["moved"] = (moved, f)
    pierced = v.copy()
    pierced[5, 2] = 4.5
    pairs["pierced"] = (pierced, f)
    pairs["two"] = (numpy.r_[v, v + [20, 0, 0]], numpy.r_[f, f + len(v)])
    pairs["unused"] = (numpy.r_[v, [[9, 9, 9]]], f)
    pairs["doubled"] = (v, numpy.r_[f, f[root[:1]]])
    a, b, c = f[top[5]]
    middle = v[[a, b, c]].mean(0)
    split = numpy.delete(f, top[5], 0)
    n = len(v)
    pairs["steiner"] = (numpy.r_[v, [middle]], numpy.r_[split, [[a, b, n], [b, c, n], [c, a, n]]])
    for name, (vertices, faces) in pairs.items():
        write_ply(os.path.join(folder, f"crown_{name}.ply"), v, crown_faces, {})
        write_ply(os.path.join(folder, f"tooth_{name}.ply"), vertices, faces, {})


def pairs_in(folder):
    """crown_NAME.* and tooth_NAME.* of one folder."""
    found = {}
    for file in sorted(os.listdir(folder)):
        stem, extension = os.path.splitext(file)
        kind, _, name = stem.partition("_")
        if kind in ("crown", "tooth") and extension in (".ply", ".stl", ".obj"):
            found.setdefault(name, {})[kind] = os.path.join(folder, file)
    return [(name, pair["crown"], pair["tooth"]) for name, pair in found.items() if len(pair) == 2]


def main():
    program, folders = sys.argv[1], sys.argv[2:]
    count, wrong = 0, 0
    with tempfile.TemporaryDirectory() as made:
        if not folders:
            broken_pairs(made)
            folders = [made]
            data = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../shared/data/validation")
            folders += [data] if os.path.isdir(data) else []
        for folder in folders:
            for name, crown, tooth in pairs_in(folder):
                problems = compare(program, crown, tooth)
                count += 1
                wrong += bool(problems)
                print(f"{name}: " + ("; ".join(problems) if problems else "agreed"))
    print(f"{count - wrong} of {count} pairs agreed")
    return 1 if wrong or not count else 0


if __name__ == "__main__":
    sys.exit(main())
