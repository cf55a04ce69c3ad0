#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bags that tumble writes, read by other people's packages, and theirs read by tumble.

    bags.py TUMBLE WORK      TUMBLE the program, WORK a folder for the packages and the files

The packages (requirements.txt, pinned with hashes) come from PyPI and are installed once into WORK. Where that cannot be
done the test fails: what was not looked at has not passed.
"""
import hashlib
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


def packages(work):
    """The folder that the packages are in; filled anew when what is asked for has changed."""
    wanted = (HERE / "requirements.txt").read_bytes()
    folder = work / ("packages-" + hashlib.sha256(wanted).hexdigest()[:12])
    done = folder / "complete"
    if done.exists():
        return folder
    fetched = subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps",
                              "--only-binary", ":all:", "--require-hashes", "--upgrade", "--target", str(folder),
                              "-r", str(HERE / "requirements.txt")])
    if fetched.returncode != 0:
        sys.exit("bags.py: the packages of tests/peers/requirements.txt could not be had from PyPI: nothing was checked, "
                 "which is a failure")
    done.touch()
    return folder


def main(program, work):
    work.mkdir(parents=True, exist_ok=True)
    env = {**os.environ, "PYTHONPATH": str(packages(work))}
    wrong = 0
    for checks in ("bags", "dialects"):
        words = [sys.executable, str(HERE / f"{checks}_checks.py"), program, str(work / f"files_{checks}")]
        wrong |= subprocess.run(words, env=env).returncode
    return wrong


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2])))
