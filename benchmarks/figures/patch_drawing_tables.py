#!/usr/bin/env python3
"""patch_drawing_tables.py TOOL MESHES: the tables of docs/algorithms/patch_drawing.md on geomorphs.

Builds patch trees with the command-line TOOL, flies along camera paths with `varifold bench`, and
prints the tables. All numbers but times are the same on any machine.
"""
import os
import sys
import tempfile

from tool import Tool


def build(tool, mesh, triangles):
    name = f"{os.path.basename(mesh)}.{triangles}"
    return tool.build(name, mesh, "--patch-triangles", str(triangles))[0]


def dive(tool, frames):
    path = tool.file(f"dive{frames}.json")
    tool("generate", "path", "dive", "--frames", str(frames), "-o", path)
    return path


def fly(tool, model, path, pixels, size, band):
    options = ["--morph-band", str(band)] if band else []
    return tool.json("bench", model, "--test", "camera", "--path", path, "--pixels", str(pixels),
                     "--size", size, *options)["results"][0]


def spread(values, form):
    low, high = form.format(min(values)), form.format(max(values))
    return low if low == high else f"{low} to {high}"


def turned(tool, planet, meshes):
    """What blending turns over, by the width of the band."""
    path = dive(tool, 60)
    models = [build(tool, mesh, size)
              for mesh in (planet, os.path.join(meshes, "armadillo.ply"),
                           os.path.join(meshes, "bunny.ply")) for size in (100, 500)]
    lines = ["| band | vertices on their way | triangles turned, per million | seen, over 0.05 pixels, a frame |",
             "|---|---|---|---|"]
    for band in (1.1, 1.25, 1.5, 2):
        told = [fly(tool, model, path, pixels, "1920x1080", band)
                for model in models for pixels in (0.5, 1.5, 4.5)]
        lines.append("| {} | {} % | {} | {} |".format(
            band, spread([100 * one["moving_vertices_part"] for one in told], "{:.0f}"),
            spread([one["turned_per_million_triangles"] for one in told], "{:,.0f}"),
            spread([one["turned_seen_mean"] for one in told], "{:.1f}")))
    triangles = [one["triangles_mean"] for one in told]
    lines.append(f"({spread(triangles, '{:,.0f}')} triangles a frame)")
    return lines


def jumps(tool, planet):
    """How far vertices and surfaces jump from frame to frame, in pixels."""
    model = build(tool, planet, 200)
    lines = ["| frames | tolerance | | vertices: 99 %, greatest | surface: 50 %, 99 %, greatest |",
             "|---|---|---|---|---|"]
    for frames in (300, 3000):
        path = dive(tool, frames)
        for pixels in (3, 1):
            for band in (None, 1.25, 2):
                one = fly(tool, model, path, pixels, "640x480", band)
                lines.append("| {:,} | {} | {} | {:.2f}, {:.2f} | {:.2f}, {:.2f}, {:.2f} |".format(
                    frames, pixels, f"band {band}" if band else "plain", one["jump_pixels_p99"],
                    one["max_jump_pixels"], one["surface_jump_pixels_p50"],
                    one["surface_jump_pixels_p99"], one["max_surface_jump_pixels"]))
    return lines


def main():
    path, meshes = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        tool = Tool(path, folder)
        planet = tool.file("planet.ply")
        tool("generate", "planet", "--triangles", "200000", "-o", planet)
        for table in (jumps(tool, planet), turned(tool, planet, meshes)):
            print("\n".join(table) + "\n", flush=True)


if __name__ == "__main__":
    main()
