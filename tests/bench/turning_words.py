#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Counts false warnings of `tumble score` about the attitude convention of trajectories whose convention is correct.
Must print 0.

    turning_words.py PROGRAM [FIRST LAST]

The script runs four `slam` methods on seeds FIRST to LAST (98302 to 98305) of five scenarios, and scores each
trajectory twice: complete, and with every 20th pose. It prints each warning, then the numbers of trajectories and of
warnings. The changelog contains this number. Takes 15 min on one core.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SCENARIOS = ("hill", "stairs", "cliff", "stroll", "hill_consumer")
METHODS = ("icp", "icp_raw", "constant_velocity", "published")


def call(*words):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True)


def said(program, recording, folder, thinned):
    """Returns the warning about a trajectory, or "" without a warning."""
    frame = json.loads((folder / "estimate.json").read_text())["frame"]
    rows = [row for row in open(folder / "trajectory.tum") if not row.startswith("#")]
    thin = folder / "thinned.tum"
    thin.write_text("".join(rows[::thinned]))
    done = call(program, "score", thin, recording, "--frame", frame)
    return "".join(line for line in done.stderr.splitlines() if "caution" in line)


def main():
    if len(sys.argv) not in (2, 4):
        sys.exit(__doc__)
    program, first, last = sys.argv[1], *(int(word) for word in sys.argv[2:] or (98302, 98305))
    scored = faulted = 0
    with tempfile.TemporaryDirectory() as scratch:
        recording = pathlib.Path(scratch) / "recording.h5"
        for scenario, seed, method in ((s, k, m) for s in SCENARIOS for k in range(first, last + 1) for m in METHODS):
            if method == METHODS[0]:
                recording.unlink(missing_ok=True)
                call(program, "record", scenario, "--seed", seed, "-o", recording)
            out = pathlib.Path(scratch) / f"{scenario}_{seed}_{method}"
            call(program, "estimate", recording, "--method", "slam/" + method, "-o", out)
            for trajectory in out.rglob("trajectory.tum"):
                for thinned in (1, 20):
                    words = said(program, recording, trajectory.parent, thinned)
                    scored += 1
                    if words:
                        faulted += 1
                        print(scenario, seed, method, thinned, words, flush=True)
    print(f"{scored} trajectories, a word on {faulted}")


if __name__ == "__main__":
    main()
