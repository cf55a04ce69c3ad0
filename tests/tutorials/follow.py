#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the commands of a tutorial: follow.py TUTORIAL.md FOLDER. Exits with 1 at the first command that fails.

A block of code after a line that contains only `NAME`: is written to the file NAME. A block of the language sh is run
by bash in FOLDER, which is created empty. A block after <!-- not run: REASON --> is skipped. A block of another
language without a name is an error. A tutorial without commands is an error, too.
"""
import pathlib
import re
import shutil
import subprocess
import sys


def blocks(text):
    """Returns (line number, language, file name or None, reason to skip or None, code) of each block."""
    name = reason = None
    lines = iter(enumerate(text.splitlines(), start=1))
    for number, line in lines:
        if match := re.fullmatch(r"`([^`/]+)`:", line):
            name = match.group(1)
        elif match := re.fullmatch(r"<!-- not run: (.+) -->", line):
            reason = match.group(1)
        elif match := re.fullmatch(r"```(\w*)", line):
            code = []
            for _, inner in lines:
                if inner == "```":
                    break
                code.append(inner)
            else:
                raise SystemExit(f"line {number}: the block is not closed")
            yield number, match.group(1), name, reason, "\n".join(code) + "\n"
            name = reason = None
        elif line:
            name = reason = None


def main():
    tutorial, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    ran = 0
    for number, language, name, reason, code in blocks(tutorial.read_text(encoding="utf-8")):
        if reason:
            continue
        if name:
            (folder / name).write_text(code, encoding="utf-8")
        elif language == "sh":
            done = subprocess.run(["bash", "-euxo", "pipefail", "-c", code], cwd=folder, text=True, errors="replace",
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            print(done.stdout)
            if done.returncode != 0:
                print(f"{tutorial}:{number}: ended with {done.returncode}:\n{code}")
                return 1
            ran += 1
        else:
            print(f"{tutorial}:{number}: a block of '{language}' that is neither a file nor run")
            return 1
    print(f"{tutorial.name}: {ran} blocks run")
    return 0 if ran > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
