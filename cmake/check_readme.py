#!/usr/bin/env python3
"""check_readme.py [--update]: fails where a block of code in README.md is not the file that the
comment before it names; with --update the files are copied into it. Also fails where README.md or a
page of docs links to a file that is not there."""
import glob
import os
import re
import sys

BLOCK = re.compile(r"(<!-- (\S+\.cpp) -->\n```cpp\n)(.*?)(```\n)", re.DOTALL)
LINK = re.compile(r"\]\((?!https?:|#)([^)#\s]+)(?:#[^)]*)?\)")


def check_blocks(text, faults):
    def exchange(match):
        name = match.group(2)
        if not os.path.exists(name):
            faults.append(f"README.md: there is no {name}")
            return match.group(0)
        with open(name, encoding="utf-8") as file:
            code = file.read()
        if code != match.group(3):
            faults.append(f"README.md: its code is not that of {name}; run check_readme.py --update")
        return match.group(1) + code + match.group(4)

    if not BLOCK.search(text):
        faults.append("README.md: shows no code of an example")
    return BLOCK.sub(exchange, text)


def check_links(faults):
    for name in sorted(glob.glob("*.md") + glob.glob("docs/**/*.md", recursive=True)):
        with open(name, encoding="utf-8") as file:
            for target in LINK.findall(file.read()):
                if not os.path.exists(os.path.join(os.path.dirname(name), target)):
                    faults.append(f"{name}: links to {target}, which is not there")


def main():
    os.chdir(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
    faults = []
    with open("README.md", encoding="utf-8") as file:
        text = file.read()
    updated = check_blocks(text, faults)
    if "--update" in sys.argv[1:]:
        with open("README.md", "w", encoding="utf-8") as file:
            file.write(updated)
        faults.clear()
        check_blocks(updated, faults)
    check_links(faults)
    for fault in faults:
        print(fault)
    print(f"README.md and links: {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
