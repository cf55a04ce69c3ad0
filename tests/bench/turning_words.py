#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How often `tumble score` finds fault with attitudes that are as stated, however wrong: must be never.

    turning_words.py PROGRAM [FIRST LAST]

Draws FIRST to LAST (98302 to 98305) of five scenarios, four methods of `slam` on each, the trajectory whole and thinned
twentyfold; prints what was said, then trajectories scored and how many of them a word was said of. Behind the changelog's
figure. A quarter of an hour of one core.
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
    """The caution on a trajectory; "" where there is none."""
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
