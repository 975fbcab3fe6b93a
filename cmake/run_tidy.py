#!/usr/bin/env python3
"""run_tidy.py BUILD [FILE...]: clang-tidy over the translation units of src and apps, in parallel.

A unit that was found clean is not looked at again while its preprocessed text, the rules and
clang-tidy itself stay the same; BUILD/clean remembers them.
"""
import concurrent.futures
import hashlib
import json
import os
import shlex
import subprocess
import sys
import time


def units(build, wanted):
    root = os.getcwd()
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        for entry in json.load(file):
            name = os.path.relpath(entry["file"], root)
            if wanted and name not in wanted:
                continue
            if name.startswith(("src/", "apps/")):
                yield name, entry


def fingerprint(entry, rules):
    """A hash of all that the verdict depends on, or nothing where the unit does not compile."""
    command = shlex.split(entry["command"])
    if "ccache" in os.path.basename(command[0]):
        command = command[1:]
    if "-o" in command:
        at = command.index("-o")
        del command[at:at + 2]
    command.remove("-c")
    # -C keeps comments, where NOLINT stands.
    done = subprocess.run(
        command[:1] + ["-E", "-C"] + command[1:], cwd=entry["directory"], capture_output=True
    )
    return hashlib.sha256(done.stdout + rules).hexdigest() if done.returncode == 0 else None


def look_at(build, name, entry, rules):
    mark = fingerprint(entry, rules)
    stamp = os.path.join(build, "clean", mark) if mark else None
    if stamp and os.path.exists(stamp):
        return name, 0, "", 0.0
    start = time.monotonic()
    done = subprocess.run(
        ["clang-tidy", "--quiet", "-p", build, name], capture_output=True, text=True
    )
    if done.returncode == 0 and stamp:
        with open(stamp, "w", encoding="utf-8"):
            pass
    return name, done.returncode, done.stdout + done.stderr, time.monotonic() - start


def main():
    build, wanted = sys.argv[1], set(sys.argv[2:])
    os.makedirs(os.path.join(build, "clean"), exist_ok=True)
    version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True)
    with open(".clang-tidy", "rb") as file:
        rules = file.read() + version.stdout
    faulty = []
    count = looked = 0
    workers = os.cpu_count() or 1
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        jobs = [pool.submit(look_at, build, n, e, rules) for n, e in units(build, wanted)]
        for job in concurrent.futures.as_completed(jobs):
            name, status, output, seconds = job.result()
            count += 1
            looked += seconds > 0
            if status != 0:
                faulty.append(name)
                print(output.strip(), flush=True)
                if status < 0:
                    print(f"clang-tidy was ended by signal {-status}: {name}", flush=True)
            elif seconds > 0:
                print(f"clean: {name} ({seconds:.0f} s)", flush=True)
    print(f"clang-tidy: {count} units, {looked} looked at, {len(faulty)} with faults", *faulty)
    return 1 if faulty or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
