# SPDX-License-Identifier: BSD-3-Clause
"""The program, run by the checks of this folder."""
import subprocess


def run(program, *words):
    """What it prints; RuntimeError with what it says where it fails."""
    done = subprocess.run([program, *map(str, words), "--quiet"], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"tumble {' '.join(map(str, words))}: {done.stderr}")
    return done.stdout
