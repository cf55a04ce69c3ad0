#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures localisation in a prior map over pairs of runs in the same world.

    prior_map_pairs.py TUMBLE FOLDER SCENARIO FIRST..LAST

Run 1 of a pair makes the map. Run 2 has the same world, but its own motion: all numbers of the motion are drawn again,
and the heading is uniform. The map is turned and moved at random, so that no start fits by luck. For each seed, four
runs are localised without an initial pose:

    same     in the map of run 1
    moving   in the map of run 1; the recording starts in the motion, elsewhere in the world and without rest
    changed  in the map of run 1 with a third of its upright objects moved by 1.5 m
    wrong    in the map of another draw of the scenario (the previous seed)

A run is relocalised falsely if the first pose in the map is off by more than 1 m or 0.2 rad. Errors are relative to the
truth, in the frame that run 1 defined with its first pose. Recordings and maps are kept in FOLDER. Needs numpy and h5py.
"""
import json
import math
import pathlib
import random
import re
import struct
import subprocess
import sys

import h5py
import numpy as np

FALSE_M, FALSE_RAD = 1.0, 0.2
MOVING_S = 0.6  # after the end of the rest
USEFUL_RAD_S = 0.3


def drawn(distribution, dice):
    kind, _, arguments = distribution.strip("{} ").partition(":")
    values = [float(v) for v in arguments.strip(" []").split(",")]
    if kind == "uniform":
        return dice.uniform(*values)
    if kind == "log_uniform":
        return math.exp(dice.uniform(math.log(values[0]), math.log(values[1])))
    if kind == "choice":
        return dice.choice(values)
    value = dice.gauss(values[0], values[1])
    return min(max(value, values[2]), values[3]) if len(values) == 4 else value


def second_scenario(text, seed):
    """The scenario with every number of the motion drawn anew, and 5.5 s long."""
    dice = random.Random(f"second run {seed}")
    out, inside = [], False
    for line in text.splitlines():
        if re.match(r"\S", line):
            inside = line.startswith("motion:")
        number = re.match(r"(\s+\w+:\s*)(\{.*\})", line)
        if inside and number:
            value = drawn(number[2], dice)
            if "yaw_rad" in number[1] or "heading_rad" in number[1]:
                value = dice.uniform(-3.1, 3.1)
            line = f"{number[1]}{value:.6f}"
        out.append("duration_s: 5.5" if line.startswith("duration_s:") else line)
    return "\n".join(out) + "\n"


def command(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip().splitlines()[-1] if done.stderr else str(words))
    return done.stdout


def record(tumble, folder, catalogue, scenario, seed):
    first, second = folder / f"{scenario}_{seed}_1.h5", folder / f"{scenario}_{seed}_2.h5"
    if not first.exists():
        command(tumble, "record", scenario, "--seed", seed, "--quiet", "-o", first)
    if not second.exists():
        file = folder / f"{scenario}_{seed}_2.yaml"
        file.write_text(second_scenario((catalogue / f"{scenario}.yaml").read_text(), seed))
        command(tumble, "record", file, "--seed", seed, "--quiet", "-o", second)
    return first, second


if __name__ == "__main__":
    TUMBLE, FOLDER = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    CATALOGUE = pathlib.Path(__file__).resolve().parents[2] / "scenarios" / "catalogue"
    FIRST, LAST = (int(n) for n in sys.argv[4].split(".."))
    for SEED in range(FIRST, LAST + 1):
        print(*record(TUMBLE, FOLDER, CATALOGUE, sys.argv[3], SEED), flush=True)
