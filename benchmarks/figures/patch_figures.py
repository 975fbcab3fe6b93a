#!/usr/bin/env python3
"""patch_figures.py TOOL MESHES OUT: the figures and results of the patch tree paper, with ours.

Builds patch trees with the command-line TOOL and writes OUT/figure_*.png and OUT/results.md. The
numbers of the figures are those of [Birkholz2007]. Figure 2 and 4 of the paper are drawings.
"""
import os
import sys
import tempfile

from tool import Tool

PATCH = "100"  # triangles, as in the paper
SIZE = ["--size", "400x300"]


def figures(tool, meshes, out):
    def picture(name, source, *options):
        tool("render", source, "-o", os.path.join(out, name + ".png"), *SIZE, *options)

    bunny = os.path.join(meshes, "bunny.ply")
    armadillo = os.path.join(meshes, "armadillo.ply")
    planet = tool.file("planet.ply")
    tool("generate", "planet", "--triangles", "2100000", "-o", planet)

    rough, _ = tool.build("rough", bunny, "--patch-triangles", PATCH, "--no-smoothing")
    smooth, bunny_report = tool.build("bunny", bunny, "--patch-triangles", PATCH)
    ear = ["--eye", "0.06,0.2,0.2", "--target", "-0.03,0.12,0", "--fovy", "40", "--color", "patch"]
    picture("figure_1_initial", rough, *ear)
    picture("figure_1_smoothed", smooth, *ear)

    for step in range(4):
        level = str(bunny_report["levels"] - 1 - 2 * step)
        picture(f"figure_3_level_{step}", smooth, "--color", "patch", "--level", level)

    near = ["--eye", "0.02,0.16,0.14", "--target", "-0.06,0.14,0", "--fovy", "60"]
    picture("figure_5_cracks", smooth, *near, "--pixels", "1.5", "--no-border-switch")
    picture("figure_5_closed", smooth, *near, "--pixels", "1.5")

    armadillo_tree, armadillo_report = tool.build("armadillo", armadillo, "--patch-triangles", PATCH)
    planet_tree, planet_report = tool.build("planet", planet, "--patch-triangles", PATCH)
    picture("figure_6_armadillo", armadillo_tree, "--color", "patch", "--azimuth", "200")
    picture("figure_6_planet", planet_tree, "--color", "patch")

    # The front of a view from the left, seen from there and from the side. The paper shows 80,000
    # of 346,000 triangles; this armadillo has 86,000.
    front = tool.file("front.ply")
    view = ["--eye", "-0.75,0.1,-0.25", "--target", "0,0,0", "--fovy", "60"]
    tool("extract", armadillo_tree, "-o", front, *view, "--triangles", "20000", "--pixels", "0")
    picture("figure_7_view", front, *view, "--wireframe")
    picture("figure_7_overall", front, "--azimuth", "200", "--wireframe")
    return [("Bunny", smooth, bunny_report), ("Armadillo", armadillo_tree, armadillo_report),
            ("Rough Planet", planet_tree, planet_report)]


def results(tool, trees, out):
    lines = ["| mesh | triangles | nodes | levels | built, triangles/s | file, B/triangle | front, triangles"
             " | patches | from the roots, us | from the last frame, us |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    for name, model, report in trees:
        bench = tool.json("bench", model, "--test", "camera", "--path", "orbit", "--pixels", "0",
                          "--triangles", str(min(500000, report["triangles"] // 4)))
        camera = bench["results"][0]
        lines.append("| {} | {:,} | {:,} | {} | {:.0f}k | {:.1f} | {:,.0f} | {:,.0f} | {:.1f} | {:.1f} |"
                     .format(name, report["triangles"], report["nodes"], report["levels"],
                             report["triangles_per_second"] / 1e3,
                             report["file_bytes_per_triangle"], camera["triangles_mean"],
                             camera["patches_mean"], 1e3 * camera["from_roots_ms_p50"],
                             1e3 * camera["adapt_ms_p50"]))
    with open(os.path.join(out, "results.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def main():
    path, meshes, out = sys.argv[1:]
    os.makedirs(out, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        tool = Tool(path, folder)
        trees = figures(tool, meshes, out)
        results(tool, trees, out)


if __name__ == "__main__":
    main()
