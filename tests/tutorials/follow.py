#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Does what a tutorial says: follow.py TUTORIAL.md FOLDER. Ends with 1 at the first command that fails.

A block of code after a line with nothing but `NAME`: is written to NAME; a block of sh is run by bash in FOLDER, which is
made anew; a block after <!-- not run: REASON --> is left out. Blocks of other languages without a name are an error, and
so is a tutorial that runs nothing: it would prove nothing.
"""
import pathlib
import re
import shutil
import subprocess
import sys


def blocks(text):
    """(line number, language, file name or None, reason to leave it out or None, code) of each block."""
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
