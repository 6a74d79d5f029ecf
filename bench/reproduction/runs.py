# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The runs behind docs/reproduction.md: every figure comes from a program's report, never from here."""
import json
import os
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

SIZES = (1.0, 0.75, 0.5, 0.25)  # mm: tables 1 and 4
HELD_OUT_SEED = 2200000000000  # from 2^40 on no network was trained on or chosen by


def measure(report, words):
    """Runs a command; its seconds, peak memory (of the largest of its processes) and exit code go to a file."""
    before = time.perf_counter()
    process = subprocess.Popen(words)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - before
    Path(report).write_text(json.dumps({"seconds": seconds, "memory_mb": usage.ru_maxrss / 1024,
                                        "code": os.waitstatus_to_exitcode(status)}))


class Bench:
    """The built programs, and what they are run on."""

    def __init__(self, root, build, data, scratch, alone):
        self.root, self.data, self.scratch = Path(root), Path(data) if data else None, Path(scratch)
        self.program = f"{build}/apps/rhizodont/rhizodont"
        self.peers = f"{build}/bench/reproduction/bench_reproduction"
        self.models = str(self.root / "models")
        self.alone = alone  # words before a command whose time is taken

    def run(self, *words, timed=False):
        """Seconds, peak memory in MB, standard output, what went wrong (a sentence, or none)."""
        output, log, measured = (self.scratch / name for name in ("output", "log", "measured.json"))
        inner = [sys.executable, __file__, str(measured), *map(str, words)]
        with open(output, "w") as out, open(log, "w") as err:
            subprocess.run((self.alone if timed else []) + inner, stdout=out, stderr=err, cwd=self.root, check=True)
        result = json.loads(measured.read_text())
        result["failure"] = None
        if result.pop("code") != 0:
            said = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
            result["failure"] = said[-1] if said else "it ended without a word"
        result["output"] = output.read_text(errors="replace")
        return result

    def must(self, *words, **options):
        result = self.run(*words, **options)
        if result["failure"]:
            raise SystemExit(f"{' '.join(map(str, words))}: {result['failure']}")
        return result

    def check(self, crown, tooth):
        """Exit code 4 is an answer like any other: most peers do not keep the crown."""
        report = self.scratch / "check.json"
        report.unlink(missing_ok=True)
        self.run(self.program, "check", crown, tooth, "--least-kept", 0, "--quiet", "--json", report)
        return json.loads(report.read_text()) if report.exists() else None


def crown_sets(bench):
    """(name, crowns); a crown: file, FDI number, the true tooth if it is known, open as `complete` takes it."""
    def crown(file, truth=None):
        return {"file": file, "fdi": file.stem.split("_")[1], "truth": truth}

    sets = [("samples", [crown(f) for f in sorted((bench.root / "samples").glob("crown_*"))])]
    if bench.data:
        scans = [bench.data / "crowns/patient0" / f"crown_{fdi}.ply" for fdi in range(11, 18)]
        sets.append(("scanned 11-17", [crown(f) for f in scans if f.exists()]))
        real = sorted((bench.data / "validation").glob("crown_*.ply"))
        sets.append(("validation", [crown(f, f.with_name(f.name.replace("crown", "tooth"))) for f in real]))
    for name, crowns in sets:
        for c in crowns:
            c["set"] = name
            c["stem"] = str(bench.scratch / f"{name.replace(' ', '_')}_{c['fdi']}")
            c["open"] = c["stem"] + "_open.ply"
            bench.must(bench.peers, "open", c["file"], c["fdi"], c["open"], bench.models)
    return [s for s in sets if s[1]]


def complete_all(bench, sets, repeats):
    """Per crown and e: the report's figures, the shortest stages and the median whole run."""
    rows = []
    for name, crowns in sets:
        for c in crowns:
            for e in SIZES:
                tooth, report = f"{c['stem']}_{e}.ply", f"{c['stem']}_{e}.json"
                runs, stages = [], []
                for _ in range(1 if e == 0.25 else repeats):
                    runs.append(bench.must(bench.program, "complete", c["file"], "--fdi", c["fdi"], "--e", e, "-o", tooth,
                                           "--report", report, "--models", bench.models, "--quiet", timed=True))
                    said = json.loads(Path(report).read_text())
                    stages.append({s["name"]: s["seconds"] for s in said["stages"]})
                proof = bench.check(c["open"], tooth)
                rows.append({
                    "set": name, "fdi": c["fdi"], "e": e, "tooth": tooth,
                    "seconds": statistics.median(r["seconds"] for r in runs),
                    "memory_mb": max(r["memory_mb"] for r in runs),
                    "stages": {s: min(run[s] for run in stages) for s in stages[0]},
                    "guiding_mean": said["joining"]["crown_to_guiding_surface_mean_mm"],
                    "guiding_max": said["joining"]["crown_to_guiding_surface_max_mm"],
                    "crown_vertices": proof["crown"]["vertices"],
                    "crown_triangles": proof["crown"]["triangles"], "kept_triangles": proof["crown"]["kept_triangles"],
                    "bins": proof["crown"]["deviation"]["bins"], "solid": proof["solid"]["holds"],
                    "new": proof["quality_new_triangles"], "all": proof["quality_all_triangles"],
                })
    return rows


def evaluate(bench, each):
    """Table 2: `evaluate` on real and on generated teeth with known roots."""
    if not bench.data:
        return {}
    made = bench.scratch / "generated"
    bench.must(bench.program, "synth", "--data", bench.data, "--type", *range(11, 19), *range(31, 39), "--count", each,
               "--seed", HELD_OUT_SEED, "--crowns", "--edge", 0.3, "-o", made)
    result = {}
    for name, folder in (("generated", made), ("validation", bench.data / "validation")):
        report = bench.scratch / f"evaluate_{name}.json"
        report.unlink(missing_ok=True)
        bench.run(bench.program, "evaluate", folder, "--templates", bench.data / "templates", "--models", bench.models,
                  "--json", report)
        said = json.loads(report.read_text())
        result[name] = {"cases": len(said["cases"])}
        for who in ("rhizodont", "template"):
            outcomes = [case["outcomes"][who]["figures"] for case in said["cases"]]
            got = [f for f in outcomes if f]
            result[name][who] = {"teeth": len(got), **{
                key: statistics.mean(f[key] for f in got) for key in ("f_score", "chamfer_l2_e3")}}
    return result


MESHLAB_SCRIPT = """<!DOCTYPE FilterScript>
<FilterScript><filter name="Close Holes">
<Param type="RichInt" value="100000" name="MaxHoleSize"/><Param type="RichBool" value="false" name="Selected"/>
<Param type="RichBool" value="true" name="NewFaceSelected"/><Param type="RichBool" value="true" name="SelfIntersection"/>
</filter></FilterScript>
"""


def peer_commands(bench, c):
    """(method, command or none, why there is none), in the order in which they need one another."""
    samples, stem = c["stem"] + ".bin", c["stem"]
    out = {m: f"{stem}_{m}.ply" for m in ("ipsr", "open3d", "cgal", "fill", "meshlab", "template", "union", "remesh")}
    script = bench.scratch / "close_holes.mlx"
    script.write_text(MESHLAB_SCRIPT)
    has_open3d = subprocess.run(["/usr/bin/python3", "-c", "import open3d"], capture_output=True).returncode == 0
    has_meshlab = shutil.which("meshlabserver") and shutil.which("xvfb-run")
    templates = bench.data / "templates" if bench.data else None
    p = bench.peers
    return [
        ("iterative Poisson (IPSR)", out["ipsr"], [p, "iterative-poisson", samples, out["ipsr"]], ""),
        ("Open3D Poisson, depth 8", out["open3d"],
         [p, "open3d-poisson", samples, out["open3d"], bench.scratch] if has_open3d else None, "Open3D is not installed"),
        ("CGAL Poisson", out["cgal"], [p, "cgal-poisson", samples, out["cgal"], 0.2], ""),
        ("CGAL hole filling", out["fill"], [p, "cgal-fill", c["open"], out["fill"]], ""),
        ("MeshLab hole filling", out["meshlab"],
         ["xvfb-run", "-a", "meshlabserver", "-i", c["open"], "-o", out["meshlab"], "-s", script] if has_meshlab else None,
         "MeshLab or xvfb is not installed"),
        ("template fit", out["template"],
         [p, "template", c["open"], c["fdi"], templates, out["template"]] if templates else None, "there is no DATA"),
        ("crown united with the template's root (CGAL)", out["union"],
         [p, "cgal-union", c["open"], c["fdi"], templates, out["union"]] if templates else None, "there is no DATA"),
        ("that union, remeshed (CGAL, 0.25 mm)", out["remesh"],
         [p, "cgal-remesh", out["union"], out["remesh"], 0.25] if templates else None, "there is no DATA"),
    ]


def judged(bench, c, method, mesh, run):
    row = {"method": method, "set": c["set"], "fdi": c["fdi"], "seconds": run["seconds"], "memory_mb": run["memory_mb"],
           "mesh": mesh, "failure": run["failure"]}
    if run["failure"] or not Path(mesh).exists():
        row["failure"] = row["failure"] or "no result"
        return row
    proof = bench.check(c["open"], mesh)
    if proof is None:
        row["failure"] = "the result cannot be read"
        return row
    crown = proof["crown"]
    row.update(solid=proof["solid"]["holds"], failures=proof["failures"], kept_share=crown["kept_share"],
               vertices=crown["vertices"], bins=crown["deviation"]["bins"], deviation_max=crown["deviation"]["max_mm"],
               all=proof["quality_all_triangles"], new=proof["quality_new_triangles"])
    if c["truth"]:
        figures = bench.run(bench.peers, "figures", c["open"], c["truth"], mesh)
        row["figures"] = None if figures["failure"] else json.loads(figures["output"])
    return row


def compare(bench, sets):
    """All methods on all open crowns; of the scanned ones only iterative Poisson, for table 5."""
    rows = []
    for _, crowns in sets:
        for c in crowns:
            bench.must(bench.peers, "cloud", c["open"], c["fdi"], c["stem"] + ".bin", bench.models)
            ours = f"{c['stem']}_ours.ply"
            if c["set"] != "scanned 11-17":
                run = bench.run(bench.program, "complete", c["open"], "--fdi", c["fdi"], "-o", ours, "--models", bench.models,
                                "--quiet", timed=True)
                rows.append(judged(bench, c, "Rhizodont", ours, run))
            for method, mesh, command, missing in peer_commands(bench, c):
                if c["set"] == "scanned 11-17" and method != "iterative Poisson (IPSR)":
                    continue
                if not command:
                    rows.append({"method": method, "set": c["set"], "fdi": c["fdi"], "missing": missing})
                    continue
                Path(mesh).unlink(missing_ok=True)
                rows.append(judged(bench, c, method, mesh, bench.run(*command, timed=True)))
    return rows


if __name__ == "__main__":
    measure(sys.argv[1], sys.argv[2:])
