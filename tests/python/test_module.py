# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The Python module, beside the command line: the same bytes, the same sentences."""

import gc
import json
import os
import pathlib
import subprocess
import threading

import numpy as np
import pytest

import rhizodont

SOURCE = pathlib.Path(os.environ["RHIZODONT_SOURCE"])
PROGRAM = os.environ["RHIZODONT_PROGRAM"]
CROWN = SOURCE / "samples" / "crown_11.stl"


@pytest.fixture(scope="module")
def crown():
    return rhizodont.load(CROWN)


@pytest.fixture(scope="module")
def tooth(crown, models):
    return rhizodont.complete(crown, models, fdi=11, e=1)


def resident_mb():
    for line in open("/proc/self/status"):
        if line.startswith("VmRSS"):
            return int(line.split()[1]) / 1024
    raise AssertionError("no resident memory in /proc")


def run(*words):
    subprocess.run([PROGRAM, *words, "--quiet"], check=True)


@pytest.mark.parametrize("ending", ["ply", "stl", "obj", "glb"])
def test_files_are_byte_for_byte_those_of_the_program(tooth, tmp_path, ending):
    tooth.save(tmp_path / f"module.{ending}")
    run("complete", CROWN, "--fdi", "11", "--e", "1", "-o", tmp_path / f"program.{ending}")
    assert (tmp_path / f"module.{ending}").read_bytes() == (tmp_path / f"program.{ending}").read_bytes()


def test_candidates_are_byte_for_byte_those_of_the_program(crown, models, tmp_path):
    run("complete", CROWN, "--fdi", "11", "--e", "2", "--candidates", "3", "-o", tmp_path / "tooth.ply")
    for candidate, name in zip(rhizodont.candidates(crown, models, 3, fdi=11, e=2), ("", "_2", "_3")):
        candidate.save(tmp_path / "module.ply")
        assert (tmp_path / "module.ply").read_bytes() == (tmp_path / f"tooth{name}.ply").read_bytes(), name


def test_the_same_bytes_for_any_number_of_threads(crown, models, tooth):
    for threads in (1, 2, 4):
        again = rhizodont.complete(crown, models, fdi=11, e=1, threads=threads)
        assert again.vertices.tobytes() == tooth.vertices.tobytes()
        assert again.triangles.tobytes() == tooth.triangles.tobytes()
        assert again.uncertainty.tobytes() == tooth.uncertainty.tobytes()


def test_every_stage_is_repeatable_from_its_steps(crown, models):
    prepared = rhizodont.prepare(crown, models, fdi=11, e=2)
    first, second = prepared.finish(root_length=14), prepared.finish(root_length=14)
    assert first.vertices.tobytes() == second.vertices.tobytes()
    for made in (first, second):
        kept = made.kept_vertices
        assert made.vertices[: len(kept)].tobytes() == crown.vertices[kept].tobytes()


def test_teeth_of_an_arch_are_byte_for_byte_those_of_the_program(crown, models, tmp_path):
    apart = np.array([9.0, 0, 0], dtype=np.float32)
    vertices = np.vstack([crown.vertices, (crown.vertices + apart).astype(np.float32)])
    scan = rhizodont.Mesh(vertices, np.vstack([crown.triangles, crown.triangles + len(crown.vertices)]))
    labels = [11] * len(crown.vertices) + [21] * len(crown.vertices)
    scan.save(tmp_path / "scan.ply")
    (tmp_path / "scan.json").write_text(json.dumps({"jaw": "upper", "labels": labels, "instances": labels}))
    run("arch", tmp_path / "scan.ply", "-o", tmp_path / "out", "--e", "2", "--output-format", "stl")
    for one in rhizodont.complete_arch(scan, models, labels, e=2).teeth:
        one.tooth.save(tmp_path / "module.stl")
        program = rhizodont.load(tmp_path / "out" / f"tooth_{one.fdi}.stl")
        module = rhizodont.load(tmp_path / "module.stl")
        assert module.vertices.tobytes() == program.vertices.tobytes()
        assert module.triangles.tobytes() == program.triangles.tobytes()


def test_crown_is_kept_bit_for_bit(tooth, crown):
    kept = tooth.kept_vertices
    assert len(kept) == len(crown.vertices)
    assert tooth.vertices[: len(kept)].tobytes() == crown.vertices[kept].tobytes()
    assert np.array_equal(tooth.triangles[: len(crown.triangles)], crown.triangles)
    assert np.all(tooth.source[: len(kept)] == rhizodont.SCAN)
    assert np.all(tooth.uncertainty[: len(kept)] == 0)
    assert tooth.check(crown)["holds"]
    assert rhizodont.check(crown, (tooth.vertices, tooth.triangles))["holds"]


def test_check_finds_a_moved_vertex(tooth, crown):
    vertices = tooth.vertices.copy()
    vertices[0, 0] = np.nextafter(vertices[0, 0], np.inf)
    found = rhizodont.check(crown, (vertices, tooth.triangles))["crown"]
    assert found["vertices"] - found["kept_vertices"] == 1
    assert 0 < found["triangles"] - found["kept_triangles"] < 20


def test_arrays_are_views_that_outlive_the_tooth(crown, models):
    tooth = rhizodont.complete(crown, models, fdi=11, e=2)
    vertices = tooth.vertices
    assert not vertices.flags.owndata and not vertices.flags.writeable
    before = vertices.copy()
    del tooth
    gc.collect()
    assert np.array_equal(vertices, before)


def test_report_has_the_tooth(tooth):
    report = tooth.report
    assert report["fdi"] == {"number": 11, "guessed": False}
    low, high = tooth.root_interval
    assert low <= tooth.root_length <= high
    assert tooth.options["e_mm"] == 1


def test_steering_is_that_of_complete(crown, models):
    fine = rhizodont.prepare(crown, models, fdi=11, e=1)
    assert fine.finish(root_length=15).root_length == pytest.approx(15, abs=0.4)  # edges are 0.5 mm long
    prepared = rhizodont.prepare(crown, models, fdi=11, e=2)
    longer = prepared.finish(root_length=15, tip=5)
    assert longer.root_interval is None
    whole = rhizodont.complete(crown, models, fdi=11, e=2, root_length=15, tip=5)
    assert longer.vertices.tobytes() == whole.vertices.tobytes()


def test_candidates_spread_over_the_interval(crown, models):
    teeth = rhizodont.candidates(crown, models, 3, fdi=11, e=2)
    assert len(teeth) == 3
    assert teeth[1].root_length < teeth[0].root_length < teeth[2].root_length


def test_progress_names_stages_and_what_it_raises_comes_through(crown, models):
    stages = []
    rhizodont.complete(crown, models, fdi=11, e=2, progress=stages.append)
    assert stages[0] == "crown" and "joining" in stages

    class Stop(Exception):
        pass

    def stop(stage):
        if stage == "joining":
            raise Stop(stage)

    with pytest.raises(Stop):
        rhizodont.complete(crown, models, fdi=11, e=2, progress=stop)


def test_other_threads_run_meanwhile(crown, models):
    counted = []
    done = threading.Event()

    def count():
        while not done.is_set():
            counted.append(1)
            done.wait(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    rhizodont.complete(crown, models, fdi=11, e=1)
    done.set()
    thread.join()
    assert len(counted) > 20


def test_errors_are_exceptions_with_ids(crown, models, tmp_path):
    with pytest.raises(rhizodont.UsageError, match="e = 9"):
        rhizodont.complete(crown, models, e=9)
    with pytest.raises(TypeError):
        rhizodont.complete(crown, models, edge=1)
    with pytest.raises(rhizodont.InputError, match="n x 3"):
        rhizodont.complete((np.zeros((3, 2)), np.zeros((1, 3))), models)
    with pytest.raises(TypeError, match="root_length"):
        rhizodont.prepare(crown, models, fdi=11, root_length=12)
    with pytest.raises(rhizodont.InputError, match="whole numbers"):
        rhizodont.complete((crown.vertices, crown.triangles + 0.5), models)
    with pytest.raises(rhizodont.InputError, match="Labels must be whole"):
        rhizodont.complete_arch(crown, models, np.full(len(crown.vertices), 11.5))
    for value in (float("nan"), float("inf")):
        with pytest.raises(rhizodont.UsageError, match="finite"):
            rhizodont.complete(crown, models, e=value)
    bad = crown.vertices.copy()
    bad[7, 1] = np.nan
    with pytest.raises(rhizodont.InputError) as caught:
        rhizodont.complete((bad, crown.triangles), models)
    assert 7 in caught.value.elements and caught.value.kind == "vertices"
    assert isinstance(caught.value, rhizodont.Error)
    with pytest.raises(rhizodont.InputError):
        rhizodont.load(tmp_path / "nothing.stl")
    with pytest.raises(rhizodont.OutputError):
        rhizodont.complete(crown, models, fdi=11, e=2).save("/proc/nowhere/tooth.ply")
    with pytest.raises(rhizodont.InputError):
        rhizodont.Models(tmp_path)
    with pytest.raises(TypeError):
        rhizodont.mesh_of(3)


def test_meshes_of_others(crown):
    class Trimesh:
        vertices, faces = crown.vertices.tolist(), crown.triangles.astype(np.int64)

    class Open3d:
        vertices, triangles = crown.vertices, crown.triangles

    for other in (Trimesh(), Open3d(), (crown.vertices, crown.triangles), CROWN, str(CROWN)):
        mesh = rhizodont.mesh_of(other)
        assert mesh.vertices.tobytes() == crown.vertices.tobytes()
        assert np.array_equal(mesh.triangles, crown.triangles)


def test_open3d_mesh(crown):
    open3d = pytest.importorskip("open3d")
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(crown.vertices), open3d.utility.Vector3iVector(crown.triangles)
    )
    assert rhizodont.mesh_of(mesh).vertices.tobytes() == crown.vertices.tobytes()
    of_tensors = open3d.t.geometry.TriangleMesh.from_legacy(mesh)
    assert np.array_equal(rhizodont.mesh_of(of_tensors).triangles, crown.triangles)


def test_options_of_numpy(crown, models):
    plain = rhizodont.complete(crown, models, fdi=11, e=2, root_length=13)
    numbers = rhizodont.complete(crown, models, fdi=np.array([11])[0], e=np.float64(2), root_length=np.float32(13))
    assert plain.vertices.tobytes() == numbers.vertices.tobytes()
    assert rhizodont.check(crown, plain, dropped_vertices=np.array([], dtype=int))["holds"]


def test_measure_is_that_of_the_program(crown):
    printed = subprocess.run([PROGRAM, "measure", "--json", CROWN], check=True, capture_output=True, text=True).stdout
    program = json.loads(printed)
    ours = rhizodont.measure(crown)
    assert ours == program


def test_arch_of_two_crowns(models, crown):
    shift = np.array([9.0, 0, 0])
    scan = rhizodont.Mesh(
        np.vstack([crown.vertices, crown.vertices + shift]),
        np.vstack([crown.triangles, crown.triangles + len(crown.vertices)]).astype(np.int32),
    )
    labels = [11] * len(crown.vertices) + [21] * len(crown.vertices)
    seen = []
    arch = rhizodont.complete_arch(
        scan, models, labels, e=2, root_lengths={11: 14.0}, progress=lambda done, teeth, fdi: seen.append((done, teeth))
    )
    assert [tooth.fdi for tooth in arch.teeth] == [11, 21]
    assert seen[-1] == (2, 2)
    for tooth in arch.teeth:
        assert tooth.tooth is not None, tooth.refusal
        assert tooth.tooth.check(tooth.crown)["holds"]
        assert tooth.crown.vertices.tobytes() == scan.vertices[tooth.scan_vertices].tobytes()
    assert arch[11].tooth.root_length == pytest.approx(14, abs=0.2)
    assert {arch.clearances[0].first, arch.clearances[0].second} == {11, 21}
    with pytest.raises(KeyError):
        arch[36]
    with pytest.raises(rhizodont.InputError):
        rhizodont.complete_arch(scan, models, labels[:-1])


def test_segment_refuses_a_crown(models, crown):
    with pytest.raises(rhizodont.InputError):
        rhizodont.segment(crown, models)
    with pytest.raises(rhizodont.UsageError):
        rhizodont.segment(crown, models, jaw="left")


def test_memory_stays_flat(crown, models):
    for _ in range(3):
        rhizodont.complete(crown, models, fdi=11, e=2)
    gc.collect()
    before = resident_mb()
    teeth = int(os.environ.get("RHIZODONT_TEETH", "12"))
    for _ in range(teeth):
        rhizodont.complete(crown, models, fdi=11, e=2)
    gc.collect()
    more = resident_mb() - before
    print(f"{teeth} teeth after the first three: {more:+.1f} MB of {before:.0f} MB")
    assert more < 25
