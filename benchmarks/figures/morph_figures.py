#!/usr/bin/env python3
"""morph_figures.py TOOL MESHES OUT: table 6.1 and figure 6.7 of the LodStrips thesis with our figures.

The morphs of the thesis are not to be had. Here a head becomes a planet and a horse a camel, each
with as many vertices as one of those, and a horse runs through its poses. Builds an order of
collapses for each frame, for three groups and for all frames, runs `varifold bench --test morph`, and
writes OUT/extraction.svg and OUT/frames.svg (with gnuplot) and OUT/tables.md. The numbers of tables
and figures are those of [Ramos2008]. Takes two minutes.
"""
import os
import statistics
import subprocess
import sys
import tempfile

from tool import Tool

RUNS = 5  # of which medians are taken
# Of the thesis: vertices, strips, levels, frames, KB a frame on graphics card and processor.
THESIS = {
    "FaceToFace": (10520, 620, 9467, 25, 14.2, 472.1),
    "HorseToMan": (17489, 890, 15738, 26, 22.4, 848.3),
}
SEQUENCES = ["frames", "3", "1"]
COLORS = ["#1b6ca8", "#d1495b", "#66a182", "#edae49", "#5f4b8b", "#333333"]


def supermesh(tool, name, a, b, vertices):
    """A mesh of two shapes with so many vertices."""
    whole, small = tool.file(name + ".glb"), tool.file(name + "_small.glb")
    tool("morph", a, b, "--fit", "-o", whole)
    # A closed surface without handles.
    tool("simplify", whole, "--triangles", str(2 * vertices - 4), "-o", small)
    return small


def reduced(tool, name, mesh, triangles):
    path = tool.file(name + ".ply")
    tool("simplify", mesh, "--triangles", str(triangles), "-o", path)
    return path


def models(tool, meshes):
    """Name, what is built of it, frames, the morph of the thesis that it stands beside."""
    planet = tool.file("planet.ply")
    tool("generate", "planet", "--triangles", "8000", "-o", planet)
    head = reduced(tool, "head", f"{meshes}/igea.ply", 8000)
    horse = reduced(tool, "horse", f"{meshes}/horse.ply", 12000)
    face = supermesh(tool, "head_planet", head, planet, THESIS["FaceToFace"][0])
    beast = supermesh(tool, "horse_camel", horse, f"{meshes}/camel.ply", THESIS["HorseToMan"][0])
    poses = [f"{meshes}/horse_poses/horse_ref.ply"] + [
        f"{meshes}/horse_poses/horse_{i:02}.ply" for i in range(1, 11)]
    return [
        ("head to planet", [face, "--frames", "25"], 25, "FaceToFace"),
        ("horse to camel", [beast, "--frames", "26"], 26, "HorseToMan"),
        ("horse, 11 poses", ["--poses", *poses], 11, None),
    ]


def middle(values):
    return statistics.median(values)


def bench(tool, model, frames):
    """Medians of several runs, by level: ms of each frame, ms of drawing."""
    runs = [tool.json("bench", model, "--test", "morph", "--steps", str(frames))["results"][0]
            for _ in range(RUNS)]
    constant = []
    for i, level in enumerate(runs[0]["constant_levels"]):
        by_frame = zip(*(run["constant_levels"][i]["frames_ms"] for run in runs))
        constant.append((level["fraction"], [middle(ms) for ms in by_frame]))
    changing = []
    for i, level in enumerate(runs[0]["level_every_24_frames"]["levels"]):
        same = [run["level_every_24_frames"]["levels"][i] for run in runs]
        changing.append((level["fraction"], middle([s["extraction_ms"] for s in same]),
                         middle([s["drawing_ms"] for s in same])))
    return constant, changing, runs[0]["device"]


def plot(path, title, x, y, curves, style="lines"):
    lines = ["set terminal svg size 640,400 font 'sans-serif,12' background rgb 'white'",
             f"set output '{path}'", f"set title '{title}'", f"set xlabel '{x}'",
             f"set ylabel '{y}'", "set grid lc rgb '#dddddd'",
             "set key outside bottom center horizontal", "set yrange [0:*]",
             f"set style data {style}"]
    for number, (_, points) in enumerate(curves):
        rows = "\n".join(f"{a:.6g} {b:.6g}" for a, b in points)
        lines.append(f"$curve{number} << END\n{rows}\nEND")
    lines.append("plot " + ", ".join(
        f"$curve{n} lw 2 lc rgb '{COLORS[n % len(COLORS)]}' title '{name}'"
        for n, (name, _) in enumerate(curves)))
    subprocess.run(["gnuplot"], input="\n".join(lines), check=True, text=True)


def share(ms):
    """Percent of a frame of 24 a second."""
    return 100 * ms * 24 / 1000


def size_rows(name, reports, thesis):
    """A row of table 6.1 for each number of sequences, and that of the thesis."""
    rows = []
    for report in reports:
        sequences = report["sequences"]
        frames, shared = report["frames"], report["shared_bytes_per_frame"] / 1024
        own = report["sequence_bytes"] / frames / 1024
        rows.append(f"| {name} | {sequences} | {report['vertices']:,} | "
                    f"{report['strips']:,} | {report['levels']:,} | {frames} | {shared:.1f} | {own:.1f} | "
                    f"{shared + own:.1f} | {report['sequence_bytes'] / report['vertices'] / frames:.2f} |")
    if thesis:
        vertices, strips, levels, frames, card, processor = THESIS[thesis]
        rows.append(f"| *thesis, {thesis}* | {frames} | {vertices:,} | {strips:,} | {levels:,} | {frames} | {card} | "
                    f"{processor} | {card + processor:.1f} | {processor * 1024 / vertices:.2f} |")
    return rows


def time_row(name, sequences, constant, changing):
    means = {fraction: statistics.mean(ms) for fraction, ms in constant}
    finest, coarsest = constant[0], constant[-1]
    extraction = statistics.mean(e for _, e, _ in changing)
    rate = 1000 / statistics.mean(e + d for _, e, d in changing)
    shares = [means[finest[0]], means[coarsest[0]], max(max(ms) for _, ms in constant), extraction]
    return (f"| {name} | {sequences} | " + " | ".join(f"{share(ms):.3f}" for ms in shares)
            + f" | {rate:.0f} |")


def main():
    path, meshes, out = sys.argv[1:4]
    os.makedirs(out, exist_ok=True)
    sizes = ["| morph | sequences | vertices | strips | levels | frames | graphics card, KB a frame | processor, KB "
             "a frame | sum | processor, bytes a vertex and frame |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]
    times = ["| morph | sequences | level 0 | level 0.9 | greatest | a level every 24 frames | "
             "frames per second then |",
             "| --- | --- | --- | --- | --- | --- | --- |"]
    by_frame, rates, device = [], [], ""
    with tempfile.TemporaryDirectory() as folder:
        tool = Tool(path, folder)
        for name, arguments, frames, thesis in models(tool, meshes):
            reports = []
            for sequences in SEQUENCES:
                model = tool.file("model.vfm")
                reports.append(tool.json("build", "framestrips", *arguments, "--sequences", sequences,
                                         "-o", model))
                constant, changing, device = bench(tool, model, frames)
                times.append(time_row(name, reports[-1]["sequences"], constant, changing))
                if sequences != "frames":
                    continue
                rates.append((name, [(i + part, 1000 / (e + d)) for i, (_, e, d) in enumerate(changing)
                                     for part in (0, 1)]))
                if thesis == "FaceToFace":
                    by_frame = [(f"level {1 - fraction:.1f}", [(i, share(t)) for i, t in enumerate(ms)])
                                for fraction, ms in constant[::3]]
            sizes += size_rows(name, reports, thesis)
    times.append("| *thesis, FaceToFace* | 25 | 1.4 at least | 6 | 6 | | |")
    plot(f"{out}/extraction.svg", "head to planet: extraction at constant levels", "frame",
         "percent of a frame of 24 a second", by_frame)
    plot(f"{out}/frames.svg", "a change of level every 24 frames, 0 to 0.9", "level changes",
         "frames per second", rates)
    with open(f"{out}/tables.md", "w", encoding="utf-8") as file:
        file.write("Table 6.1, what models take:\n\n" + "\n".join(sizes)
                   + "\n\nFigure 6.7, extraction in percent of a frame of 24 a second:\n\n"
                   + "\n".join(times) + f"\n\nDrawn by {device}.\n")


if __name__ == "__main__":
    main()
