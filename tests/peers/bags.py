#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""External packages and estimators read bags that tumble writes, and tumble reads bags that external packages write.

    bags.py TUMBLE WORK      TUMBLE: the program; WORK: folder for the packages and the files

The packages come from PyPI, pinned with hashes (requirements.txt; for estimators, programs.txt), and are installed once
to WORK. The test fails if they cannot be installed.
"""
import hashlib
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


# file with the packages of each group of checks
CHECKS = {"bags": "requirements.txt", "dialects": "requirements.txt", "programs": "programs.txt"}


def packages(work, listed):
    """Returns the folder with the listed packages. A changed list is installed to a new folder."""
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
