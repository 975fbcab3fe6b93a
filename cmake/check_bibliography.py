#!/usr/bin/env python3
"""Fails where a source or a page cites a work that docs/bibliography.md does not list, where a key
has another form than [AuthorYear], and where a line "Based on:" names nothing."""
import re
import subprocess
import sys

LIST = "docs/bibliography.md"
ENTRY = re.compile(r"^- \*\*\[([^\]]+)\]\*\*", re.MULTILINE)
# What looks like a key: begins with a name, ends with a year, perhaps with a place behind it.
CITATION = re.compile(r"\[([A-Z][^\[\]\n(]*?(?:1[89]|20)\d\d|Giger)(?:,[^\]\n]*)?\](?!\()")
KEY = re.compile(r"^[A-Za-z]+((1[89]|20)\d\d)?$")
# A heading of the changelog is no citation.
SKIPPED = (LIST, "CHANGELOG.md", "cmake/check_bibliography.py", "docs/bibliography.md")


def main():
    with open(LIST, encoding="utf-8") as file:
        known = ENTRY.findall(file.read())
    faults = []
    if known != sorted(known):
        faults.append(f"{LIST}: not in alphabetical order")
    listed = subprocess.run(
        ["git", "ls-files", "*.h", "*.cpp", "*.md", "*.py", "*.sh"],
        check=True, capture_output=True, text=True,
    )
    cited = set()
    for name in listed.stdout.split():
        if name in SKIPPED:
            continue
        with open(name, encoding="utf-8") as file:
            for number, line in enumerate(file, 1):
                if re.search(r"Based on:\s*$", line):
                    faults.append(f"{name}:{number}: Based on what?")
                for match in CITATION.finditer(line):
                    key = match.group(1)
                    cited.add(key)
                    if not KEY.match(key):
                        faults.append(f"{name}:{number}: [{key}] is not of the form [AuthorYear]")
                    elif key not in known:
                        faults.append(f"{name}:{number}: [{key}] is not in {LIST}")
    for fault in faults:
        print(fault)
    print(f"bibliography: {len(known)} works, {len(cited)} of them cited, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
