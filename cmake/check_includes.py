#!/usr/bin/env python3
"""Fails where a file includes against the direction of docs/architecture.md.

Folders have ranks; a file may include its own folder and folders of a lower rank. BESIDE lists the
folders of one rank that may be included beside that, and FORBIDDEN those of a lower rank that may
not.
"""
import os
import re
import subprocess
import sys

RANK = {
    "base": 0,
    "mesh": 1,
    "simplify": 2,
    "strip": 2,
    "partition": 2,
    "morph": 2,
    "view": 2,
    "models": 3,
    "measure": 4,
    "io": 4,
    "render": 4,
    "bindings": 4,
    "apps": 5,
}
BESIDE = {("strip", "simplify"), ("strip", "view"), ("morph", "simplify")}
FORBIDDEN = set()
# What models share; models know nothing else of each other.
SHARED = "models/common"
# Where in the library a header from outside may be included: by the beginning of its name.
HOMES = {
    "CGAL": (),  # GPL: tests and benchmarks only
    "OpenMesh": (),
    "meshoptimizer": (),
    "tbb/": ("base",),
    "xxhash": ("base",),
    "embree": ("measure",),
    "epoxy": ("render",),
    "EGL/": ("render",),
    "GL/": ("render",),
    "stb/": ("render",),
    "zstd": ("io",),
    "nlohmann": ("io",),
    "fast_float": ("io",),
    "filesystem": ("io",),
    "fstream": ("io",),
    "fcntl.h": ("io",),
    "sys/": ("base", "io"),
    "iostream": (),
    "spdlog": (),
    "CLI/": (),
}
# These see the library as a user does.
USERS = ("apps/", "tests/", "examples/", "benchmarks/", "fuzz/")
INCLUDE = re.compile(r'\s*#\s*include\s*["<](varifold|apps|tests|benchmarks|fuzz)/([^">]+)[">]')
QUOTED = re.compile(r'\s*#\s*include\s*"([^"]+)"')
OUTSIDE = re.compile(r"\s*#\s*include\s*<([^>]+)>")


def folder_of(path):
    """The folder of a path below src/varifold, where every model is a folder of its own."""
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] == "models" else parts[0]


def fault_of(folder, included):
    """Why `folder` may not include `included`, or nothing."""
    if folder == included:
        return None
    rank, other = (RANK.get(f.split("/")[0]) for f in (folder, included))
    if rank is None or other is None:
        return f"folder {folder if rank is None else included} has no rank in check_includes.py"
    if other > rank:
        return f"{folder} lies below {included}"
    if other == rank and included != SHARED and (folder, included) not in BESIDE:
        return f"{folder} and {included} lie beside each other"
    if (folder, included) in FORBIDDEN:
        return f"{folder} must not know {included}"
    return None


def home_fault(folder, header):
    """Why a header from outside may not be included in `folder`, or nothing."""
    for beginning, homes in HOMES.items():
        if header.startswith(beginning) and folder not in homes:
            return f"<{header}> belongs in {' and '.join(homes) or 'no folder of the library'}"
    return None


def check(name):
    faults = []
    in_library = name.startswith("src/varifold/")
    with open(name, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            quoted = QUOTED.match(line)
            if in_library and quoted:
                faults.append((number, f'"{quoted.group(1)}" is not included by its full path'))
                continue
            found = INCLUDE.match(line)
            outside = OUTSIDE.match(line)
            if in_library and outside and not found:
                fault = home_fault(folder_of(name[len("src/varifold/"):]), outside.group(1))
                if fault:
                    faults.append((number, fault))
            if not found:
                continue
            root, path = found.groups()
            if root == "varifold":
                if not os.path.exists("src/varifold/" + path):
                    faults.append((number, f"there is no src/varifold/{path}"))
                elif in_library:
                    fault = fault_of(folder_of(name[len("src/varifold/"):]), folder_of(path))
                    if fault:
                        faults.append((number, fault))
            elif in_library:
                faults.append((number, f"the library must not know {root}/"))
            elif name.startswith("apps/") and root != "apps":
                faults.append((number, f"apps must not know {root}/"))
    return faults


def main():
    listed = subprocess.run(
        ["git", "ls-files", "*.h", "*.cpp"], check=True, capture_output=True, text=True
    )
    names = [n for n in listed.stdout.split() if n.startswith(("src/",) + USERS)]
    count = 0
    for name in names:
        if not os.path.exists(name):
            continue
        for number, fault in check(name):
            print(f"{name}:{number}: {fault}")
            count += 1
    print(f"include direction: {len(names)} files, {count} faults")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
