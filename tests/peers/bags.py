#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bags that tumble writes, read by other people's packages, and theirs read by tumble.

    bags.py TUMBLE WORK      TUMBLE the program, WORK a folder for a private Python environment and the files

The packages (requirements.txt, pinned with hashes) come from PyPI and are installed once into WORK. Where that cannot be
done the test fails: what was not looked at has not passed.
"""
import hashlib
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


def environment(work):
    """Python of an environment with the packages; made anew when what is asked for has changed."""
    wanted = (HERE / "requirements.txt").read_bytes()
    folder = work / ("venv-" + hashlib.sha256(wanted).hexdigest()[:12])
    python, done = folder / "bin" / "python", folder / "complete"
    if done.exists():
        return python
    subprocess.run([sys.executable, "-m", "venv", "--clear", str(folder)], check=True)
    fetched = subprocess.run([str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps",
                              "--only-binary", ":all:", "--require-hashes", "-r", str(HERE / "requirements.txt")])
    if fetched.returncode != 0:
        sys.exit("bags.py: the packages of tests/peers/requirements.txt could not be had from PyPI: nothing was checked, "
                 "which is a failure")
    done.touch()
    return python


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    place = pathlib.Path(sys.argv[2])
    place.mkdir(parents=True, exist_ok=True)
    sys.exit(subprocess.run([str(environment(place)), str(HERE / "bags_checks.py"), sys.argv[1], str(place / "files")]).returncode)
