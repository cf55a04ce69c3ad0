#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures the map error caused by jitter of the sweeps' time stamps. Sweeps of a real lidar have such jitter.

    sweep_jitter.py PROGRAM RECORDING.h5 [METHOD]...

The script moves the start of each sweep to a random earlier time, by up to 0, 20 ns, 50 us and 3 ms. The points keep
their times, so the sweeps overlap. It maps with slam/tumble and slam/tumble_lag, or the named methods, and prints
status and end error relative to the truth. Needs the package `tumble` and numpy. The sweeps of RECORDING must have no
gaps, as those of `tumble record stroll --seed 98001`.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import tumble

MOST_NS = (0, 20, 50_000, 3_000_000)
METHODS = ("slam/tumble", "slam/tumble_lag")


def begin_earlier(lidar, most_ns, draws):
    """Returns the recording with jitter, except of the first sweep. The sweep period is increased to contain all points."""
    lidar.sweep_period_ns += most_ns
    by_ns = draws.integers(0, most_ns + 1, len(lidar.sweep_start_ns))
    by_ns[0] = 0
    points = np.diff(np.asarray(lidar.sweep_first).astype(np.int64))
    lidar.sweep_start_ns = np.asarray(lidar.sweep_start_ns) - by_ns
    lidar.offset_ns = (np.asarray(lidar.offset_ns).astype(np.int64) + np.repeat(by_ns, points)).astype(np.uint32)


def end_error(program, recording, method, folder):
    out = folder / method.replace("/", "-")
    done = subprocess.run([program, "estimate", recording, "--method", method, "-o", out], capture_output=True, text=True)
    if done.returncode != 0:
        return done.stderr.strip().splitlines()[-1]
    scored = json.loads(subprocess.run([program, "score", out, recording, "--json"], check=True, capture_output=True,
                                       text=True).stdout)
    values = {row["metric"]: row["value"] for row in scored["scores"]}
    return f"{scored['status']}, end off by {1e3 * values['translation_error_end_m']:.2f} mm"


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    for most_ns in MOST_NS:
        recording = tumble.read(sys.argv[2])
        for lidar in recording.lidars:
            begin_earlier(lidar, most_ns, np.random.default_rng(1))
        with tempfile.TemporaryDirectory() as scratch:
            jittered = pathlib.Path(scratch) / "jittered.h5"
            tumble.write(jittered, recording)
            for method in sys.argv[3:] or METHODS:
                print(f"{most_ns} ns: {method}: {end_error(sys.argv[1], jittered, method, pathlib.Path(scratch))}", flush=True)


if __name__ == "__main__":
    main()
