#!/usr/bin/env python3
"""strip_figures.py TOOL MESHES OUT: the charts and tables of the LodStrips thesis with our figures.

Builds every strip model and the progressive mesh of the meshes that are there with the command-line
TOOL, runs the tests of `varifold bench` and writes OUT/*.svg (with gnuplot) and OUT/tables.md.
Numbers in brackets in the tables are those of the thesis. Takes some minutes, most of it
drawing, where no device speeds that up. The figure and table numbers are those of [Ramos2008].
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile

# Name, file, what the thesis has of it or of a mesh of its size: vertices, faces, and per table.
MESHES = [
    ("cow", "cow.obj"),
    ("bunny", "bunny.ply"),
    ("armadillo", "armadillo.ply"),
    ("igea", "igea.ply"),
]
# Kind and options of each model by the name that the charts give it.
MODELS = {
    "progressive mesh": ["pm"],
    "MTS": ["mts"],
    "framework": ["strips"],
    "LodStrips, thesis": ["lodstrips", "--form", "thesis"],
    "LodStrips, grouped": ["lodstrips", "--form", "grouped"],
    "LodStrips, blocks": ["lodstrips", "--form", "blocks"],
}
THESIS = {
    "3.1": {  # "MB" of progressive mesh, MTS, framework
        "cow": (0.27, 0.25, 0.39),
        "bunny": (3.28, 2.96, 3.56),
        "phone": (7.86, 6.76, 8.10),
    },
    "3.2": {  # ms per level of the three, and shares of extraction in percent
        "cow": ((0.711, 26), (0.370, 62), (0.245, 40)),
        "bunny": ((6.625, 3), (4.070, 51), (1.956, 37)),
        "phone": ((16.265, 2), (8.839, 38), (4.705, 34)),
    },
    "4.2": {  # extractions: test in ms, extraction in ms, share in percent
        10: (28.83, 9.48, 32.9),
        100: (210.44, 14.49, 6.9),
        500: (904.46, 19.40, 2.1),
        1000: (1800.52, 24.85, 1.4),
        10000: (16776.4, 49.46, 0.3),
    },
    "4.3": {  # strips, levels, MB of LodStrips; 5.1: MB of the grouped form
        "cow": (136, 2614, 0.22, 0.17),
        "bunny": (1229, 31351, 2.88, 2.21),
        "dragon": (1787, 48865, 4.28, 3.32),
        "phone": (1747, 74740, 6.56, 5.08),
        "isis": (5141, 168880, 15.11, 11.69),
    },
    "5.2": (16.38, 1.64, 1.22),  # s: immediate mode, a call per strip, one call
}
MIB = 1024 * 1024


class Runner:
    """Builds models once and runs benchmarks on them."""

    def __init__(self, tool, folder, work):
        self.tool, self.folder, self.work = tool, folder, work
        self.built = {}

    def run(self, *arguments):
        done = subprocess.run(
            [self.tool, *arguments, "--json"], check=True, capture_output=True, text=True
        )
        return json.loads(done.stdout)

    def build(self, mesh, model, extra=()):
        key = (mesh, model, tuple(extra))
        if key not in self.built:
            path = os.path.join(self.work, f"{len(self.built)}.vfm")
            source = os.path.join(self.folder, dict(MESHES)[mesh])
            report = self.run("build", *MODELS[model], source, "-o", path, "--no-measure", *extra)
            self.built[key] = (path, report)
        return self.built[key]

    def bench(self, mesh, model, test="linear", steps=100, draw="multi", extra=(), runs=1):
        path, _ = self.build(mesh, model, extra)
        arguments = ["bench", path, "--test", test, "--steps", str(steps), "--draw", draw]
        results = [self.run(*arguments)["results"][0] for _ in range(runs)]
        results.sort(key=lambda r: r["seconds_total"])
        middle = results[len(results) // 2]
        middle["samples"] = [
            dict(one, **{k: statistics.median(r["samples"][i][k] for r in results)
                         for k in ("seconds_extraction", "seconds_drawing") if k in one})
            for i, one in enumerate(middle["samples"])
        ]
        return middle


def plot(path, title, x, y, curves, logarithmic=False):
    """Curves: a name and a list of points each."""
    lines = [
        "set terminal svg size 640,400 font 'sans-serif,12' background rgb 'white'",
        f"set output '{path}'",
        f"set title '{title}'",
        f"set xlabel '{x}'",
        f"set ylabel '{y}'",
        "set grid lc rgb '#dddddd'",
        "set key outside bottom center horizontal",
        "set style data lines",
        "set yrange [0:*]" if not logarithmic else "set logscale y",
    ]
    blocks = []
    for number, (name, points) in enumerate(curves):
        rows = "\n".join(f"{a:.6g} {b:.6g}" for a, b in points)
        blocks.append(f"$curve{number} << END\n{rows}\nEND")
    colors = ["#1b6ca8", "#d1495b", "#66a182", "#edae49", "#5f4b8b", "#333333"]
    lines += blocks
    lines.append("plot " + ", ".join(
        f"$curve{n} with lines lw 2 lc rgb '{colors[n % len(colors)]}' title '{name}'"
        for n, (name, _) in enumerate(curves)))
    subprocess.run(["gnuplot"], input="\n".join(lines), check=True, text=True)


def detail(sample, finest):
    """The thesis counts from 0, the finest level, to 1."""
    return 1 - sample["level"] / max(1, finest)


def half(result):
    """The linear test goes down and up; the charts show the way down."""
    samples = result["samples"]
    return samples[: (len(samples) + 1) // 2]


def linear_charts(runner, out, mesh):
    """Figures 3.16 to 3.18 and 4.9: vertices sent and time per level of all models."""
    sent, times = [], []
    for model in MODELS:
        result = runner.bench(mesh, model, steps=100)
        samples = half(result)
        finest = max(s["level"] for s in result["samples"])
        sent.append((model, [(detail(s, finest), s["vertices"]) for s in samples]))
        times.append((model, [(detail(s, finest),
                               1e3 * (s["seconds_extraction"] + s["seconds_drawing"]))
                              for s in samples]))
    x = "level (0 finest, 1 base)"
    plot(f"{out}/linear_{mesh}_vertices.svg", f"{mesh}: vertices sent", x, "vertices", sent)
    plot(f"{out}/linear_{mesh}_time.svg", f"{mesh}: extraction and drawing", x, "ms", times)


def plane_charts(runner, out, mesh):
    """Figures 3.19 to 3.21: the plane test of the framework."""
    result = runner.bench(mesh, "framework", test="plane", steps=101)
    samples = result["samples"]
    points = [(s["step"] / 100, s) for s in samples]
    plot(f"{out}/plane_{mesh}_vertices.svg", f"{mesh}: plane test", "position of the plane",
         "vertices", [("framework", [(x, s["vertices"]) for x, s in points])])
    plot(f"{out}/plane_{mesh}_fps.svg", f"{mesh}: plane test", "position of the plane",
         "frames per second",
         [("framework", [(x, 1 / max(1e-9, s["seconds_extraction"] + s["seconds_drawing"]))
                         for x, s in points])])


def lodstrips_charts(runner, out, mesh):
    """Figures 4.10 to 4.15 and 5.8: drawing and rendering, thesis and grouped form."""
    curves, extraction = [], []
    for name in ("thesis", "grouped", "blocks"):
        result = runner.bench(mesh, f"LodStrips, {name}", steps=100, draw="strips")
        finest = max(s["level"] for s in result["samples"])
        points = [(detail(s, finest), s) for s in half(result)]
        extraction.append((name, [(x, 1e3 * s["seconds_extraction"]) for x, s in points]))
        if name == "blocks":
            continue
        curves.append((f"{name}: drawing", [(x, 1e3 * s["seconds_drawing"]) for x, s in points]))
        curves.append((f"{name}: rendering",
                       [(x, 1e3 * (s["seconds_drawing"] + s["seconds_extraction"]))
                        for x, s in points]))
    x = "level (0 finest, 1 base)"
    plot(f"{out}/lodstrips_{mesh}_time.svg", f"{mesh}: a call per strip", x, "ms", curves)
    plot(f"{out}/lodstrips_{mesh}_extraction.svg", f"{mesh}: extraction", x, "ms", extraction)


def filter_charts(runner, out):
    """Figures 4.6 and 4.7: what removing degenerate runs gains."""
    sent = []
    for name, model in (("removed in the build", "LodStrips, thesis"),
                        ("filtered when drawn", "framework"),
                        ("built from coarse to fine", "LodStrips, blocks"),
                        ("progressive mesh", "progressive mesh")):
        result = runner.bench("bunny", model, steps=100)
        finest = max(s["level"] for s in result["samples"])
        sent.append((name, [(detail(s, finest), s["vertices"]) for s in half(result)]))
    full = sent[1][1][0][1]
    sent.insert(0, ("not filtered", [(0, full), (1, full)]))
    plot(f"{out}/filters_bunny.svg", "bunny: vertices sent", "level (0 finest, 1 base)",
         "vertices", sent)


def decline_chart(runner, out, mesh):
    """Indices per triangle along the levels."""
    curves = []
    for model in MODELS:
        result = runner.bench(mesh, model, test="linear", steps=100, draw="none", runs=1)
        curves.append((model, [(100 * s["triangles"] / result["samples"][0]["triangles"],
                                (s["indices"] if model == "LodStrips, blocks" else
                                 s["vertices"] + s["strips"]) / max(1, s["triangles"]))
                               for s in half(result) if s["triangles"] > 300]))
    plot(f"{out}/decline_{mesh}.svg", f"{mesh}: indices per triangle, restarts counted",
         "triangles, percent", "indices per triangle",
         [(n, [(x, min(y, 6)) for x, y in c]) for n, c in curves])


def cache_chart(runner, out):
    """Figure 5.9: strips by length against strips for the vertex cache."""
    curves = []
    for name in ("length", "cache"):
        result = runner.bench("bunny", "LodStrips, grouped", steps=100,
                              extra=("--stripifier", name))
        finest = max(s["level"] for s in result["samples"])
        curves.append((name, [(detail(s, finest), 1 / max(1e-9, s["seconds_extraction"] +
                                                           s["seconds_drawing"]))
                              for s in half(result)]))
    plot(f"{out}/stripifiers_bunny_fps.svg", "bunny, grouped form", "level (0 finest, 1 base)",
         "frames per second", curves)


def share_chart(runner, out):
    """Figure 4.8: the share of extraction in a linear test of 1,000 levels."""
    rows = []
    for mesh, _ in runner.meshes:
        for form in ("thesis", "grouped", "blocks"):
            result = runner.bench(mesh, f"LodStrips, {form}", steps=1000 if mesh == "bunny" else 200)
            rows.append((mesh, form, 100 * result["extraction_share"]))
    return ["| mesh | thesis | grouped | blocks |", "| --- | --- | --- | --- |"] + [
        f"| {mesh} | " + " | ".join(
            f"{share:.1f} %" for m, _, share in rows if m == mesh) + " |"
        for mesh, _ in runner.meshes]


def table_3_1(runner):
    lines = ["| mesh | vertices | triangles | progressive mesh | MTS | framework |",
             "| --- | --- | --- | --- | --- | --- |"]
    for mesh, _ in runner.meshes:
        cells = []
        for number, model in enumerate(("progressive mesh", "MTS", "framework")):
            report = runner.build(mesh, model)[1]
            cell = f"{report['model_bytes'] / MIB:.2f}"
            if mesh in THESIS["3.1"]:
                cell += f" ({THESIS['3.1'][mesh][number]:.2f})"
            cells.append(cell)
        lines.append(f"| {mesh} | {report['vertices']} | {report['triangles']} | "
                     + " | ".join(cells) + " |")
    return lines


def table_3_2(runner):
    lines = ["| mesh | progressive mesh | MTS | framework | LodStrips, blocks |",
             "| --- | --- | --- | --- | --- |"]
    for mesh, _ in runner.meshes:
        cells = []
        for number, model in enumerate(
                ("progressive mesh", "MTS", "framework", "LodStrips, blocks")):
            result = runner.bench(mesh, model, steps=100, draw="strips")
            cell = (f"{1e3 * result['seconds_total'] / result['steps']:.2f} ms, "
                    f"{100 * result['extraction_share']:.0f} %")
            if mesh in THESIS["3.2"] and number < 3:
                ms, share = THESIS["3.2"][mesh][number]
                cell += f" ({ms:.2f} ms, {share} %)"
            cells.append(cell)
        lines.append(f"| {mesh} | " + " | ".join(cells) + " |")
    return lines


def table_4_2(runner):
    lines = ["| extractions | form | test | extraction | share |",
             "| --- | --- | --- | --- | --- |"]
    for steps, thesis in THESIS["4.2"].items():
        for form in ("thesis", "grouped", "blocks"):
            result = runner.bench("bunny", f"LodStrips, {form}", steps=steps,
                                  draw="none" if steps > 1000 else "multi",
                                  runs=1 if steps > 500 else 3)
            total, extraction = (1e3 * result[k] for k in ("seconds_total", "seconds_extraction"))
            cells = [f"{total:.0f} ms", f"{extraction:.1f} ms",
                     f"{100 * result['extraction_share']:.1f} %"]
            if steps > 1000:
                cells[0] = cells[2] = "not drawn"
            if form == "thesis":
                cells = [f"{cell} ({was})" for cell, was in zip(cells, thesis)]
            lines.append(f"| {steps} | {form} | " + " | ".join(cells) + " |")
    return lines


def table_4_3(runner):
    lines = ["| mesh | strips | levels | thesis form | grouped | saved | blocks | list of triangles |",
             "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for mesh, _ in runner.meshes:
        reports = {form: runner.build(mesh, f"LodStrips, {form}")[1]
                   for form in ("thesis", "grouped", "blocks")}
        one = reports["thesis"]
        sizes = {form: report["model_bytes"] / MIB for form, report in reports.items()}
        # Table 4.1: positions and an indexed list, three words each.
        listed = 12 * (one["vertices"] + one["triangles"]) / MIB
        was = THESIS["4.3"].get(mesh)
        note = (lambda text: f" ({text})") if was else (lambda text: "")
        saved = 100 * (1 - sizes["grouped"] / sizes["thesis"])
        lines.append(
            f"| {mesh} | {one['strips']}{note(was and was[0])} | "
            f"{one['levels']}{note(was and was[1])} | "
            f"{sizes['thesis']:.2f}{note(was and was[2])} | "
            f"{sizes['grouped']:.2f}{note(was and was[3])} | {saved:.0f} % | "
            f"{sizes['blocks']:.2f} | {listed:.2f} |")
    return lines


def table_5_2(runner):
    mesh = "bunny"
    lines = ["| form | a call per strip | one call |", "| --- | --- | --- |"]
    for form in ("grouped", "blocks"):
        cells = []
        for draw in ("strips", "multi"):
            result = runner.bench(mesh, f"LodStrips, {form}", steps=1000, draw=draw, runs=1)
            cells.append(f"{result['seconds_total']:.2f} s "
                         f"({100 * result['extraction_share']:.1f} % extraction)")
        lines.append(f"| {form}, {mesh} | " + " | ".join(cells) + " |")
    was = THESIS["5.2"]
    lines.append(f"| thesis, Isis (immediate mode {was[0]} s) | {was[1]} s | {was[2]} s |")
    return lines


def main():
    tool, folder, out = sys.argv[1:4]
    os.makedirs(out, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        runner = Runner(os.path.abspath(tool), folder, work)
        runner.meshes = [m for m in MESHES if os.path.exists(os.path.join(folder, m[1]))]
        for mesh, _ in runner.meshes:
            linear_charts(runner, out, mesh)
            plane_charts(runner, out, mesh)
            lodstrips_charts(runner, out, mesh)
            decline_chart(runner, out, mesh)
        filter_charts(runner, out)
        cache_chart(runner, out)
        tables = [
            ("Table 3.1: memory in MiB", table_3_1(runner)),
            ("Table 3.2: linear test of 100 levels, a call per strip: time per level, and the "
             "share of extraction", table_3_2(runner)),
            ("Table 4.2: linear tests on the bunny", table_4_2(runner)),
            ("Tables 4.1, 4.3 and 5.1: memory in MiB", table_4_3(runner)),
            ("Figure 4.8: share of extraction in a linear test of 200 levels (bunny: 1,000), one call",
             share_chart(runner, out)),
            ("Table 5.2: linear test of 1,000 levels", table_5_2(runner)),
        ]
    with open(f"{out}/tables.md", "w", encoding="utf-8") as file:
        for title, lines in tables:
            file.write(f"{title}:\n\n" + "\n".join(lines) + "\n\n")


if __name__ == "__main__":
    main()
