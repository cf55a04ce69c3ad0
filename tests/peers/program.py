# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program for the checks of this folder."""
import subprocess


def run(program, *words):
    """Returns the output of the program. Raises RuntimeError with its messages if it fails."""
    done = subprocess.run([program, *map(str, words), "--quiet"], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"tumble {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout
