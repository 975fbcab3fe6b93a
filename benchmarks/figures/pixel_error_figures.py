#!/usr/bin/env python3
"""pixel_error_figures.py PROGRAM OUT: patch trees and a cluster DAG at equal measured errors.

Runs PROGRAM (varifold_patch_pixel_error) over the meshes that are there and writes OUT/
pixel_error_MESH.svg (with gnuplot) and OUT/pixel_error.md, all tables. Takes about ten minutes.
"""
import csv
import os
import subprocess
import sys
import tempfile

COLORS = {"cluster DAG": "#000000", "patches of 128": "#d55e00", "patches of 512": "#0072b2",
          "patches of 1000": "#009e73"}
VIEWS = ["near", "middle", "orbit"]


def chart(path, mesh, rows):
    """Triangles drawn over the error of 99.9 % of the samples, a panel for each kind of view."""
    lines = ["set terminal svg size 960,360 font 'sans-serif,11' background rgb 'white'",
             f"set output '{path}'", "set logscale xy", "set grid",
             f"set multiplot layout 1,{len(VIEWS)}", "set xrange [0.2:8]",
             "set xtics (0.25, 0.5, 1, 2, 4, 8)", "set format y '%.0s %c'",
             "set xlabel 'measured error, px (99.9 %)'", "set key bottom left font ',9'"]
    for view in VIEWS:
        lines.append(f"set title '{mesh}, {view}'")
        lines.append("set ylabel '" + ("triangles drawn" if view == VIEWS[0] else "") + "'")
        plots = []
        for model, color in COLORS.items():
            points = sorted((float(r["most_of_1000"]), float(r["drawn"])) for r in rows
                            if r["views"] == view and r["model"] == model and r["seen"] == "0"
                            and float(r["most_of_1000"]) >= 0.1)
            if not points:
                continue
            name = f"${view}_{model.split()[-1]}"
            lines.append(f"{name} << EOD")
            lines += [f"{x} {y}" for x, y in points]
            lines.append("EOD")
            plots.append(f"{name} with linespoints pt 7 ps 0.4 lw 2 lc rgb '{color}' title '{model}'")
        if plots:
            lines.append("plot " + ", ".join(plots))
    lines.append("unset multiplot")
    subprocess.run(["gnuplot"], input="\n".join(lines), check=True, text=True)


def main():
    program, out = sys.argv[1:]
    os.makedirs(out, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        curves = os.path.join(folder, "curves.csv")
        tables = subprocess.run([program, "-o", curves], check=True, capture_output=True, text=True)
        with open(curves, encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    with open(os.path.join(out, "pixel_error.md"), "w", encoding="utf-8") as file:
        file.write(tables.stdout)
    for mesh in dict.fromkeys(r["mesh"] for r in rows):
        name = mesh.split(".")[0]
        chart(os.path.join(out, f"pixel_error_{name}.svg"), name,
              [r for r in rows if r["mesh"] == mesh])


if __name__ == "__main__":
    main()
