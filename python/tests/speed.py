# SPDX-License-Identifier: BSD-3-Clause
"""Compares the processor time for a whole recording in Python with the time of the same method in the program: speed.py
[RUNS]

The time of the program is its metric estimate_cpu_s, for the estimate alone. The time of Python is that of the call that receives the
recording's arrays. Each result is the smallest of RUNS (5). Run this script by hand; no test asserts computing times.
"""
import pathlib
import sys
import tempfile
import time

import tumble


def least(run, runs):
    taken = []
    for _ in range(runs):
        began = time.process_time()
        run()
        taken.append(time.process_time() - began)
    return min(taken)


def of_program(recording, method, runs, folder):
    """Measures the program by sweeps over the recording; each sweep stores the time of its estimate."""
    taken = []
    kind = method.split("/")[0]
    for k in range(runs):
        suite = folder / f"{kind}_{k}.yaml"
        suite.write_text(f"name: {kind}_{k}\ndoc: one recording\nrecordings: [{recording.name}]\nmethods: [{method}]\n")
        tumble.call("sweep", suite, "--data", recording.parent, "--db", folder / f"{method.replace('/', '_')}_{k}.db", "--examples", 0)
        rows = tumble.score_rows(folder / f"{method.replace('/', '_')}_{k}.db")
        taken += [row["value"] for row in rows if row["metric"] == "estimate_cpu_s"]
    return min(taken)


runs = int(sys.argv[1]) if len(sys.argv) > 1 else 5
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    path = tumble.record("hill", folder / "hill.h5", seed=1)
    hill = tumble.read(path)
    for method, call in (("rate/tumble_lag", lambda: tumble.rate(hill.imus[0], hill.gravity_m_s2, live=True)),
                         ("slam/tumble_lag", lambda: tumble.tumbling(hill))):
        ours, theirs = least(call, runs), of_program(path, method, runs, folder)
        print(f"{method}: {ours:.3f} s from Python, {theirs:.3f} s in the program, {ours / theirs:.2f} times")
