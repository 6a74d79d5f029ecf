# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of docs/reproduction.md, by `rhizodont render`; of sample and generated teeth alone."""
import shutil

FIGURE_8 = ("11", "13", "15", "16", "36", "37")
FIGURE_10 = ("11", "16", "36")
# tooth, seed, what life did to it
FIGURE_11 = (("21", 1, "none"), ("24", 1, "none"), ("36", 1, "none"), ("26", 1, "bracket"), ("35", 2, "worn-bracket"),
             ("36", 3, "worn"))
MOST_DEVIATION = 0.1  # mm: the yellow end of figure 10


def draw(bench, out, name, meshes, *options):
    bench.must(bench.program, "render", *meshes, "-o", out / f"{name}.png", *options)


def complete(bench, crown, fdi, tooth, *options):
    bench.must(bench.program, "complete", crown, "--fdi", fdi, "-o", tooth, "--models", bench.models, "--quiet", *options)
    return tooth


def smoothing(bench, out):
    """Figure 7: the border of a completed crown without and with the biharmonic band."""
    crown, parts = bench.root / "samples/crown_36.stl", []
    rough = complete(bench, crown, "36", bench.scratch / "rough.ply", "--transition", 0)
    smooth = complete(bench, crown, "36", bench.scratch / "smooth.ply")
    for mesh in (rough, smooth):
        parts.append(mesh.with_name("seam_" + mesh.name))
        bench.must(bench.peers, "seam", mesh, smooth, parts[-1], 1.6)
    draw(bench, out, "figure_7", parts, "--views", "front", "--per-row", 2, "--width", 520, "--height", 260, "--wireframe", "--axis", "0,0,1")


def completion(bench, out):
    """Figure 8: crown, completed tooth, true tooth, for a type each."""
    if not bench.data:
        return False
    made = bench.scratch / "generated"  # of table 2
    tiles = []
    for fdi in FIGURE_8:
        crown = min(made.glob(f"crown_{fdi}_*.ply"))
        tiles += [crown, complete(bench, crown, fdi, bench.scratch / f"figure_8_{fdi}.ply"), crown.with_name(crown.name.replace("crown", "tooth"))]
    draw(bench, out, "figure_8", tiles, "--views", "front", "--per-row", 9, "--width", 150, "--height", 300)
    return True


def deviation(bench, out):
    """Figure 10: crowns coloured by their distance from the result; a row a tooth, ours first."""
    tiles = []
    for fdi in FIGURE_10:
        stem = bench.scratch / f"samples_{fdi}"
        for method in ("ours", "ipsr", "open3d", "cgal", "remesh"):
            mesh = f"{stem}_{method}.ply"
            if not (bench.scratch / mesh).exists():
                continue
            tiles.append(f"{stem}_{method}_deviation.ply")
            bench.must(bench.peers, "deviation", f"{stem}_open.ply", mesh, tiles[-1], MOST_DEVIATION)
    draw(bench, out, "figure_10", tiles, "--views", "oblique", "--per-row", len(tiles) // len(FIGURE_10), "--width", 190,
         "--height", 165, "--color-by", "deviation_mm", "--axis", "0,0,1")


def diverse(bench, out):
    """Figure 11: crowns and their teeth: an incisor, a bicuspid, a molar, and what life does to crowns."""
    tiles = []
    if bench.data:
        for fdi, seed, mark in FIGURE_11:
            crown, truth = (bench.scratch / f"{what}_{fdi}_{mark}.ply" for what in ("marked_crown", "marked_tooth"))
            bench.must(bench.peers, "marked", bench.data, fdi, seed, mark, crown, truth)
            tiles += [crown, complete(bench, crown, fdi, bench.scratch / f"marked_made_{fdi}_{mark}.ply")]
    else:
        for fdi, ending in (("11", "stl"), ("34", "ply"), ("36", "stl"), ("23", "ply")):
            crown = bench.root / f"samples/crown_{fdi}.{ending}"
            tiles += [crown, complete(bench, crown, fdi, bench.scratch / f"diverse_{fdi}.ply")]
    draw(bench, out, "figure_11", tiles, "--views", "back", "--per-row", 6, "--width", 170, "--height", 300)


def triangles(bench, out):
    """Figure 13: teeth coloured by the quality of the triangles at each vertex: iterative Poisson above, ours below."""
    tiles = []
    for method in ("ipsr", "ours"):
        for fdi in FIGURE_10:
            tiles.append(bench.scratch / f"samples_{fdi}_{method}_quality.ply")
            bench.must(bench.peers, "quality", bench.scratch / f"samples_{fdi}_{method}.ply", tiles[-1])
    draw(bench, out, "figure_13", tiles, "--views", "front", "--per-row", len(FIGURE_10), "--width", 200, "--height", 290,
         "--color-by", "quality", "--axis", "0,0,1")


def more(bench, out):
    """Figure 14: a whole scan: as scanned, its teeth found, every tooth with its root."""
    scan = bench.scratch / "scan.ply"
    shutil.copy(bench.root / "samples/scan_lower.ply", scan)
    bench.must(bench.program, "segment", scan, "-o", bench.scratch / "scan_labels.ply", "--models", bench.models, "--quiet")
    folder = bench.scratch / "arch"
    bench.must(bench.program, "arch", scan, "-o", folder, "--models", bench.models, "--quiet", "--overwrite")
    draw(bench, out, "figure_14", [scan, bench.scratch / "scan_labels.ply", folder / "arch.ply"], "--per-row", 3, "--views",
         "oblique", "--width", 420, "--height", 340)


def draw_all(bench, out):
    """The names of the pictures that there are."""
    out.mkdir(parents=True, exist_ok=True)
    drawn = {"figure_7", "figure_10", "figure_11", "figure_13", "figure_14"}
    smoothing(bench, out)
    if completion(bench, out):
        drawn.add("figure_8")
    deviation(bench, out)
    diverse(bench, out)
    triangles(bench, out)
    more(bench, out)
    return sorted(drawn)
