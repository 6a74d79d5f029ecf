# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/reproduction.md from the figures of a run; words here, numbers from the run and from the paper."""
import datetime
import os
import re
import statistics
import subprocess

from paper import TABLE_1, TABLE_2, TABLE_3, TABLE_4, TABLE_5

QUALITY = ("q_avg", "q_min", "theta_avg", "theta_min", "percent_below_30")
TABLE_4_SIZES = (1.0, 0.75, 0.5)


def said_by(*words):
    try:
        return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def stamp(root, build, data):
    git = ("git", "-C", str(root))
    cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(), re.M))
    kind = cache.get("CMAKE_BUILD_TYPE", "")
    # The cache's flags are not those that CMakeLists.txt sets.
    rules = build / "build.ninja"
    used = re.search(r"^ *FLAGS = (.*)$", rules.read_text() if rules.exists() else "", re.M)
    flags = " ".join(flag for flag in used.group(1).split() if not flag.startswith("-W")) if used else "unknown"
    changed = said_by(*git, "status", "--porcelain", "--", "src", "include", "apps", "models", "bench")
    memory = int(re.search(r"MemTotal: *(\d+)", open("/proc/meminfo").read()).group(1)) / 2**20
    processor = re.search(r"^Model name: *(.*)$", said_by("lscpu"), re.M)

    def version(package):
        return said_by("dpkg-query", "-W", "-f=${Version}", package) or "not installed"

    system = re.search(r'PRETTY_NAME="(.*)"', open("/etc/os-release").read()).group(1)
    return {
        "Commit": said_by(*git, "rev-parse", "--short=10", "HEAD") + (" with changes" if changed else "") +
                  "; the product as of " + said_by(*git, "log", "-1", "--format=%h", "--", "src", "include", "apps", "models"),
        "Compiler and flags": said_by("c++", "--version").splitlines()[0] + f", {kind}: `{flags}`",
        "Machine": f"{processor.group(1) if processor else 'unknown'}, {os.cpu_count()} cores, {memory:.0f} GB",
        "System": f"{system}, CGAL {version('libcgal-dev')}, Open3D {version('python3-open3d')}, MeshLab {version('meshlab')}",
        "Date": datetime.datetime.now(datetime.timezone.utc).strftime("%F"),
        "data": data is not None,
        "load": os.getloadavg()[0],
    }


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] +
                     ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def of_size(completed, e):
    return [r for r in completed if r["e"] == e]


def by_set(rows):
    groups = {}
    for row in rows:
        groups.setdefault(row["set"], []).append(row)
    return groups


def mean(values):
    return statistics.mean(values)


def standing(ours, theirs, lower_is_better=True):
    if ours == theirs:
        return "even"
    return "ahead" if (ours < theirs) == lower_is_better else "**behind**"


NAMES = {"samples": "sample crowns (generated)", "scanned 11-17": "teeth 11 to 17 of one scanned person",
         "validation": "validation teeth (one person, CBCT)"}


def named(name):
    return NAMES.get(name, name)


def distance_means(completed, e):
    here = of_size(completed, e)
    vertices = sum(r["crown_vertices"] for r in here)
    return sum(r["guiding_mean"] * r["crown_vertices"] for r in here) / vertices, max(r["guiding_max"] for r in here)


def summary(result):
    """A row a claim: the paper's figure, ours, and who is ahead."""
    completed = result["completed"]
    here = of_size(completed, 0.5)
    d_avg, d_max = distance_means(completed, 0.5)
    rows = [("[1](#table-1-guiding-surface-and-crown)", "d_avg at e = 0.5, mm", f"{d_avg:.2e}", f"{TABLE_1[0.5][0]:.2e}", standing(d_avg, TABLE_1[0.5][0])),
            ("1", "d_max at e = 0.5, mm", f"{d_max:.3f}", f"{TABLE_1[0.5][1]:.2f}", standing(d_max, TABLE_1[0.5][1]))]
    number = "[2](#table-2-predicted-teeth-beside-true-ones)"
    for name, sets in result["evaluated"].items():
        for key, label, lower in (("f_score", "F-score", False), ("chamfer_l2_e3", "Chamfer-L2 x 1000", True)):
            ours = round(sets["rhizodont"][key], 2)
            rows.append((number, f"{label}, {name} teeth", f"{ours:.2f}", TABLE_2[key], standing(ours, TABLE_2[key], lower)))
            number = "2"
    exact = share(sum(r["bins"][0] for r in here), sum(r["crown_vertices"] for r in here))
    theirs = share(sum(t[1] for t in TABLE_3.values()), sum(t[0] for t in TABLE_3.values()))
    rows.append(("[3](#table-3-the-crown-after-joining)", "crown vertices within 1e-3 mm, %", f"{exact:.1f}", f"{theirs:.1f}", standing(exact, theirs, False)))
    slowest = max(mean(r["seconds"] for r in group) for group in by_set(here).values())
    fastest = min(t[2] for t in TABLE_4.values())
    rows.append(("[4](#table-4-seconds-for-a-tooth)", "seconds at e = 0.5: our slowest set, its fastest", f"{slowest:.2f}", f"{fastest:.2f}", standing(slowest, fastest)))
    number = "[5](#table-5-triangles)"
    for kind in ("new", "all"):
        for key, label, lower in (("q_avg", "Q avg", False), ("theta_min", "theta min", False), ("percent_below_30", "% of angles < 30", True)):
            worst, best = (max, min) if lower else (min, max)
            ours = worst(r[kind][key] for r in here)
            its = best(dict(zip(QUALITY, paper))[key] for _, paper in TABLE_5.values())
            rows.append((number, f"{label}, {kind} triangles: our worst tooth, its best", f"{ours:.3g}", f"{its:.3g}", standing(ours, its, lower)))
            number = "5"
    behind = [f"{row[1]} (table {row[0].strip('[')[0]})" for row in rows if "behind" in row[-1]]
    words = f"Behind the paper's printed figures in: {'; '.join(behind)}." if behind else "Behind the paper's printed figures in none of these."
    words += (" Of all triangles the scan's own are counted too, which an exact crown keeps as they are: where a scan has slivers, the tooth has them. "
              "The worst tooth is chosen for each row by itself.")
    if result["evaluated"]:
        words += (" Roots of the generated teeth vary as published populations do, and a crown tells little of its root ([roots.md](roots.md)); the paper "
                  "does not say whether the six cuts of one tooth may lie on both sides of its split into training and test.")
    return "## Summary\n\n" + words + "\n\n" + table(("table", "what", "ours", "paper", "we are"), rows)


def table_1(completed):
    rows = []
    for e, (paper_mean, paper_most) in TABLE_1.items():
        d_avg, d_max = distance_means(completed, e)
        rows.append((e, f"{d_avg:.2e}", f"{paper_mean:.2e}", f"{d_max:.3f}", f"{paper_most:.2f}",
                     standing(d_avg, paper_mean), standing(d_max, paper_most)))
    return "## Table 1: guiding surface and crown\n\n" + (
        f"Distance in mm of the crown's vertices from the guiding surface, over {len(of_size(completed, 0.5))} teeth. The paper does "
        "not say over which. Ours is drawn onto the crown and split where it misses it, and near the crown its cells follow the "
        "crown's shape rather than e.\n\n") + table(
            ("e, mm", "d_avg", "paper", "d_max", "paper", "d_avg", "d_max"), rows)


def table_2(evaluated):
    text = "## Table 2: predicted teeth beside true ones\n\n"
    if not evaluated:
        return text + "Not made: the samples have no true roots. `scripts/reproduce.sh DATA` makes it.\n"
    rows = [("paper", "a fifth of its own teeth", "", TABLE_2["f_score"], TABLE_2["chamfer_l2_e3"], "", "")]
    where = {"generated": "generated teeth of all 16 types, never trained on", "validation": named("validation")}
    for name, sets in evaluated.items():
        for who, label in (("rhizodont", "Rhizodont"), ("template", "template fit")):
            got = sets[who]
            rows.append((label, where[name], f"{got['teeth']} of {sets['cases']}", f"{got['f_score']:.2f}",
                         f"{got['chamfer_l2_e3']:.2f}",
                         standing(round(got["f_score"], 2), TABLE_2["f_score"], False),
                         standing(round(got["chamfer_l2_e3"], 2), TABLE_2["chamfer_l2_e3"])))
    return text + (
        "F-score (at 1 %, higher is better) and Chamfer-L2 x 1000 (lower is better), lengths in units of the true tooth's bounding-box "
        "diagonal, between points on the surfaces of the finished meshes. The paper compares the network's points "
        "with a fifth of its own teeth and says neither its unit nor its threshold, so that its figures may not be of the same scale as "
        "ours. The generated teeth are nearest to its own test, for they are made as the training teeth were; the validation teeth are "
        "those of a real person, of whom nothing was trained on (nor are they quite blind: see the [model card](../models/completion.md)).\n\n") + table(
            ("method", "teeth", "completed", "F-score", "Chamfer-L2 x 1000", "F beside paper", "Chamfer beside paper"), rows)


def table_3(completed):
    rows = [("paper", tooth, total, *bins, "", f"{100 * bins[0] / total:.1f} %") for tooth, (total, *bins) in TABLE_3.items()]
    here = of_size(completed, 0.5)
    for r in here:
        total = r["crown_vertices"]
        rows.append((named(r["set"]), r["fdi"], total, *r["bins"], f"{100 * r['bins'][0] / total:.1f} %"))
    kept, triangles = sum(r["kept_triangles"] for r in here), sum(r["crown_triangles"] for r in here)
    total, exact = sum(r["crown_vertices"] for r in here), sum(r["bins"][0] for r in here)
    paper_total, paper_exact = (sum(t[k] for t in TABLE_3.values()) for k in (0, 1))
    return "## Table 3: the crown after joining\n\n" + (
        f"Crown vertices by their distance in mm from the finished tooth: {exact} of {total} within 1e-3 mm, where the paper has "
        f"{paper_exact} of {paper_total} ({100 * paper_exact / paper_total:.1f} %). {kept} of {triangles} crown triangles are in the "
        "tooth bit for bit. Crowns of the scanned person are closed by a cap; what is counted is the crown without it. The "
        "paper's intervals add up to its totals: its skirts, which are farther off, are not counted either.\n\n") + table(
            ("teeth", "tooth", "total", "to 1e-3", "to 1e-2", "to 1e-1", "over", "exact"), rows)


def table_4(completed):
    rows = [("paper", f"set {number}", *(f"{s:.2f}" for s in seconds), "") for number, seconds in TABLE_4.items()]
    for name, group in by_set(completed).items():
        times = [mean(r["seconds"] for r in of_size(group, e)) for e in TABLE_4_SIZES]
        rows.append(("Rhizodont", named(name), *(f"{t:.2f}" for t in times),
                     f"{max(r['memory_mb'] for r in group if r['e'] in TABLE_4_SIZES):.0f}"))
    stages = list(completed[0]["stages"])
    steps = [(f"{e:g}", *(f"{mean(r['stages'][s] for r in of_size(completed, e)):.3f}" for s in stages),
              f"{mean(sum(r['stages'].values()) for r in of_size(completed, e)):.2f}") for e in TABLE_1]
    return "## Table 4: seconds for a tooth\n\n" + (
        "Whole process from crown file to checked tooth with its report, networks loaded anew each time (the median of the runs, mean "
        "over the teeth); memory is the largest. The paper names neither its processor nor its stages; it has an NVIDIA 3090 Ti for "
        "training. Two machines are compared here, not two programs on one. Crowns that are closed by a cap, as those of the scanned person, "
        "take longer: the cap is looked for first.\n\n") + table(
            ("method", "teeth", "e = 1", "e = 0.75", "e = 0.5", "MB at most"), rows) + (
        "\nBy stage, mean over all teeth of the shortest of the runs:\n\n") + table(("e, mm", *stages, "sum"), steps)


def quality_cells(q):
    return (f"{q['q_avg']:.3f}", f"{q['q_min']:.2g}", f"{q['theta_avg']:.2f}", f"{q['theta_min']:.3g}", f"{q['percent_below_30']:.2f}")


def mean_quality(figures):
    """Means, and of what is a minimum the least."""
    return {k: (min if k.endswith("min") else mean)([f[k] for f in figures]) for k in QUALITY}


def table_5(completed, peers):
    ipsr = {(r["set"], r["fdi"]): r["all"] for r in peers if r["method"].startswith("iterative") and not r.get("failure")}
    here = {(r["set"], r["fdi"]): r for r in of_size(completed, 0.5)}
    rows = []
    for tooth, (theirs, paper) in TABLE_5.items():
        for label, q in (("IPSR, paper", theirs), ("paper", paper)):
            rows.append((label, tooth, *quality_cells(dict(zip(QUALITY, q)))))
        key = ("scanned 11-17", str(tooth))
        if key in here:
            rows.append(("IPSR, our own", tooth, *quality_cells(ipsr[key])) if key in ipsr else ("IPSR, our own", tooth, *["no result"] * 5))
            rows.append(("Rhizodont, new triangles", tooth, *quality_cells(here[key]["new"])))
            rows.append(("Rhizodont, all", tooth, *quality_cells(here[key]["all"])))
    for name, group in by_set(here.values()).items():
        if name == "scanned 11-17":
            continue
        others = [ipsr[key] for key in here if key[0] == name and key in ipsr]
        if others:
            rows.append(("IPSR, our own", named(name), *quality_cells(mean_quality(others))))
        rows.append(("Rhizodont, new triangles", named(name), *quality_cells(mean_quality([r["new"] for r in group]))))
        rows.append(("Rhizodont, all", named(name), *quality_cells(mean_quality([r["all"] for r in group]))))
    return "## Table 5: triangles\n\n" + (
        "Q and the smallest angle of a triangle, in degrees, as in the paper; last the share of all angles that are under 30 degrees. "
        "The paper's teeth 11 to 17 and ours are different persons'. \"All\" has the scan's own triangles too, which are not ours to better; "
        "sets have the mean, of minima the least. IPSR is the project's own program for it (`bench/poisson/iterative_poisson.cpp`), on the "
        "points from which our own surface is made; its shares are about a third of the paper's. One triangle has three angles: the paper "
        "may have counted triangles with such an angle, which would make its own 2.8 % about 0.9 % of angles.\n\n") + table(
            ("method", "tooth", "Q avg", "Q min", "theta avg", "theta min", "% < 30"), rows)


def share(part, whole):
    return 100 * part / whole if whole else 0.0


def peer_tables(peers):
    methods = list(dict.fromkeys(r["method"] for r in peers))
    fate, truth, remarks = [], [], []
    for method in methods:
        tried = [r for r in peers if r["method"] == method and r["set"] != "scanned 11-17"]
        missing = next((r["missing"] for r in tried if "missing" in r), None)
        if missing:
            remarks.append(f"- {method}: not run, {missing}.")
        tried = [r for r in tried if "missing" not in r]
        got = [r for r in tried if not r["failure"]]
        if not tried:
            continue
        for reason in dict.fromkeys(r["failure"] for r in tried if r["failure"]):
            teeth = ", ".join(r["fdi"] for r in tried if r["failure"] == reason)
            remarks.append(f"- {method}, no result on {teeth}: {reason.rstrip('.')}.")
        if not got:
            continue
        q = mean_quality([r["all"] for r in got])
        exact = share(sum(r["bins"][0] for r in got), sum(r["vertices"] for r in got))
        whole = sum(1 for r in got if r["kept_share"] == 1)
        fate.append((method, f"{len(got)} of {len(tried)}", sum(r["solid"] for r in got), f"{whole}",
                     f"{100 * mean(r['kept_share'] for r in got):.1f}", f"{exact:.1f}", f"{max(r['deviation_max'] for r in got):.3f}",
                     f"{q['q_avg']:.3f}", f"{q['theta_min']:.2g}", f"{q['percent_below_30']:.2f}",
                     f"{statistics.median(r['seconds'] for r in got):.2f}", f"{max(r['memory_mb'] for r in got):.0f}"))
        known = [r["figures"] for r in got if r.get("figures")]
        rootless = sum(1 for r in got if "figures" in r and not r["figures"])
        if rootless:
            remarks.append(f"- {method}: on {rootless} teeth nothing below the crown that could be compared with a root.")
        if known:
            truth.append((method, len(known), f"{mean(abs(f['root_length_error_mm']) for f in known):.2f}",
                          f"{mean(f['matched_apex_distance_mm'] for f in known):.2f}", f"{mean(f['root_chamfer_mm'] for f in known):.2f}",
                          f"{mean(f['chamfer_l2_e3'] for f in known):.2f}", f"{mean(f['f_score'] for f in known):.2f}"))
    text = "## Peers: the same crowns in other programs\n\n" + (
        "Open crowns (samples and, with DATA, validation teeth), each method a process of its own from files to a file: seconds are the "
        "median of one run each, memory that of the largest of its processes. Poisson reconstructions get the points with normals from which our own surface is made (iterative "
        "Poisson without the normals), so that prediction is not in their time and is in ours; so are our check and the networks. Hole filling "
        "closes the crown and gives no root; the time of remeshing is that beside the union's. For the union the crown is closed, and the template, laid on the crown, is cut 1 mm above the middle of the crown's border. \"Crown whole\": every triangle bit for bit. Kept and exact are shares in percent of the crown's triangles, "
        "and of its vertices that lie within 1e-3 mm of the result. Figures of triangles are those of the whole mesh.\n\n")
    text += table(("method", "results", "solids", "crown whole", "triangles kept, %", "vertices exact, %", "farthest crown vertex, mm",
                   "Q avg", "theta min", "% < 30", "s", "MB"), fate)
    if truth:
        text += ("\nBeside the true validation teeth: root length error (mean of absolute values), apices off and root Chamfer in mm; the last two "
                 "in units of the bounding box's diagonal.\n\n") + table(
                     ("method", "teeth", "length error", "apex off", "root Chamfer", "Chamfer-L2 x 1000", "F at 1 %"), truth)
    if remarks:
        text += "\n" + "\n".join(remarks) + "\n"
    return text + ("\nPoissonRecon and manifold have no Debian 12 package and are not here: the former's method is in Open3D, the latter's union is "
                   "made by CGAL's corefinement. For the indicator function at equal depth and noise, with ratios in one run, see "
                   "[benchmarks.md](benchmarks.md).\n")


CAPTIONS = {
    "figure_7": ("Figure 7: biharmonic smoothing", "The border of a completed lower first molar (`samples/crown_36.stl`): left without the smoothed band "
                 "(`--transition 0`), right with it. Pale: crown, as scanned; then transition and predicted root."),
    "figure_8": ("Figure 8: completion", "Teeth 11, 13, 15, 16, 36 and 37, generated and never trained on: crown, completed tooth, true tooth. The paper shows "
                 "points; here are the finished meshes."),
    "figure_10": ("Figure 10: what happens to the crown", "Teeth 11, 16 and 36 of the samples, a row each, coloured by the distance of each crown vertex from the result: dark 0, "
                  "yellow 0.1 mm and more. From the left: Rhizodont, iterative Poisson, and, where they were run, Open3D Poisson, CGAL Poisson, and the remeshed union "
                  "with a template's root."),
    "figure_11": ("Figure 11: diverse crowns", "Crown and completed tooth from the cheek's side. With DATA they are generated: incisor, bicuspid, molar, molar with an attachment, worn bicuspid with a bracket, worn "
                  "molar; without, four of the samples. The paper shows scans of patients."),
    "figure_13": ("Figure 13: triangles", "Teeth 11, 16 and 36 of the samples, coloured by the worst triangle at each vertex: dark Q = 0, yellow Q = 1. Above iterative Poisson, below "
                  "Rhizodont, whose crown has the scan's triangles."),
    "figure_14": ("Figure 14: more", "The sample scan of a lower jaw: as scanned, with the teeth found in it, and every tooth with its root."),
}


def figures(names):
    text = "## Figures\n"
    for name in sorted(names, key=lambda n: int(n.split("_")[1])):
        title, caption = CAPTIONS[name]
        text += f"\n### {title}\n\n![{title}](reproduction/{name}.png)\n\n{caption}\n"
    return text


HEAD = """<!--
SPDX-FileCopyrightText: Rhizodont contributors
SPDX-License-Identifier: GPL-3.0-or-later
-->
# The paper's experiments

Section 4 of "Completing Dental Models While Preserving Crown Geometry and Meshing Topology" (called the paper), made again on the data at hand, our
tables beside the paper's, and the same crowns in other programs. Written by `scripts/reproduce.sh`{arguments}; only times change when it is run
again on such a machine.

"""

DIFFERENCES = """## What differs

- The paper's teeth are private: 50 sets of real teeth by CBCT, of which each was cut at six heights for training and test, and intraoral scans of 100,000
  to 150,000 vertices. None of them is here, so no row of ours is of the same tooth as one of the paper's. {data}
- The paper's network learned from real teeth; ours has seen generated ones alone ([model card](../models/completion.md)). Its crowns are a half to an
  eighth of the tooth; ours are cut near the gum line.
- Skirts are not taken off here: the crowns are cut already. That stage has its own page, [skirt.md](skirt.md).
- Section 4.6, a survey of technicians, is not repeated, nor figure 9, whose detail table 5 and figure 13 have.
- "Ahead" and "behind" compare printed figures, on different teeth and machines.

"""


def write(result):
    about = dict(result["stamp"])
    data, load, minutes = about.pop("data"), about.pop("load"), about.pop("minutes")
    about["Run"] = f"{minutes:.0f} minutes; load before {load:.1f}"
    completed = result["completed"]
    sets = [f"{len(of_size(group, 0.5))} {named(name)}" for name, group in by_set(completed).items()]
    words = ("Here: " + "; ".join(sets) + ("." if data else ". There was no DATA: what needs true roots or templates is left out."))
    parts = [HEAD.format(arguments=" with DATA" if data else " without DATA") + table(("What", "Which"), about.items()),
             summary(result), DIFFERENCES.format(data=words).rstrip() + "\n", table_1(completed), table_2(result["evaluated"]), table_3(completed),
             table_4(completed), table_5(completed, result["peers"]), peer_tables(result["peers"]), figures(result["pictures"])]
    return "\n".join(parts)
