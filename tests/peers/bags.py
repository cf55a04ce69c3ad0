#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bags that tumble writes, read by other people's packages and by peers as they are started, and theirs read by tumble.

    bags.py TUMBLE WORK      TUMBLE the program, WORK a folder for the packages and the files

The packages (requirements.txt, of the peers programs.txt, pinned with hashes) come from PyPI and are installed once into
WORK. Where that cannot be done the test fails: what was not looked at has not passed.
"""
import hashlib
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


# what is asked with them: its packages
CHECKS = {"bags": "requirements.txt", "dialects": "requirements.txt", "programs": "programs.txt"}


def packages(work, listed):
    """The folder that the packages of a list are in; filled anew when what is asked for has changed."""
    wanted = (HERE / listed).read_bytes()
    folder = work / ("packages-" + hashlib.sha256(wanted).hexdigest()[:12])
    done = folder / "complete"
    if done.exists():
        return folder
    fetched = subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps",
                              "--only-binary", ":all:", "--require-hashes", "--upgrade", "--target", str(folder),
                              "-r", str(HERE / listed)])
    if fetched.returncode != 0:
        sys.exit(f"bags.py: the packages of tests/peers/{listed} could not be had from PyPI: nothing was checked, "
                 "which is a failure")
    done.touch()
    return folder


def main(program, work):
    work.mkdir(parents=True, exist_ok=True)
    wrong = 0
    for checks, listed in CHECKS.items():
        env = {**os.environ, "PYTHONPATH": str(packages(work, listed))}
        words = [sys.executable, str(HERE / f"{checks}_checks.py"), program, str(work / f"files_{checks}")]
        wrong |= subprocess.run(words, env=env).returncode
    return wrong


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], pathlib.Path(sys.argv[2])))
