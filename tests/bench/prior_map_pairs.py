#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures localisation in a prior map over pairs of runs in the same world.

    prior_map_pairs.py TUMBLE FOLDER SCENARIO FIRST..LAST

Run 1 of a pair makes the map. Run 2 has the same world, but its own motion: all numbers of the motion are drawn again,
and the heading is uniform. The map is turned and moved at random, so that no start fits by luck. For each seed, three
runs are localised without an initial pose:

    same     in the map of run 1
    changed  in the map of run 1, with the upright surfaces of a third of its 2 m columns moved by 1.5 m
    wrong    in the map of another draw of the scenario (the previous seed)

A run is relocalised falsely if its first pose in the map is off by more than 1 m or 0.2 rad, or if the map is wrong.
Errors are relative to the truth, in the frame that run 1 defined with its first pose. The time of localisation counts
from the end of the rest. Recordings and maps are kept in FOLDER. Needs numpy and h5py.
"""
import json
import math
import pathlib
import random
import re
import subprocess
import sys

import h5py
import numpy as np

FALSE_M, FALSE_RAD = 1.0, 0.2
MOVES_RAD_S = 0.3


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
    """Returns the scenario with new random numbers for the motion, and a length of 5.5 s."""
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


def rotation(q):
    x, y, z, w = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def transform(R, p):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def turned(yaw, p):
    c, s = math.cos(yaw), math.sin(yaw)
    return transform(np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), p)


def true_pose(recording, time_ns):
    """Returns the pose of the first IMU in the simulated world."""
    with h5py.File(recording) as file:
        truth = file["truth"]
        k = min(int(round(time_ns / truth.attrs["period_ns"])), len(truth["p_WB_m"]) - 1)
        return transform(rotation(truth["q_WB"][k]), truth["p_WB_m"][k]) @ truth["imus/0/T_BI"][:]


def end_of_rest_ns(recording):
    with h5py.File(recording) as file:
        imu = file["sensors/imus/0"]
        moves = np.linalg.norm(imu["gyro_I_rad_s"][:], axis=1) > MOVES_RAD_S
        return int(imu["time_ns"][np.argmax(moves)])


def sweeps_of(folder):
    """Returns time and pose at the end of each sweep of an estimate."""
    rows = np.genfromtxt(folder / "sweeps.csv", delimiter=",", names=True)
    return [(int(r["pose_time_ns"]), transform(rotation(np.array([r["qx"], r["qy"], r["qz"], r["qw"]])),
                                               np.array([r["px_m"], r["py_m"], r["pz_m"]]))) for r in rows]


def make_map(tumble, folder, recording):
    """Returns the points of a run's map (position, normal, sigma), and the pose of the simulated world in the map."""
    estimate = folder / (recording.stem + "_estimate")
    if not (estimate / "estimate.json").exists():
        command(tumble, "estimate", recording, "--method", "slam/tumble_lag", "--quiet", "-o", estimate)
    data = (estimate / "map.ply").read_bytes()
    points = np.frombuffer(data[data.index(b"end_header\n") + 11:], dtype="<f4").reshape(-1, 7)
    time_ns, pose = sweeps_of(estimate)[0]
    T_MS = pose @ np.linalg.inv(true_pose(recording, time_ns))
    yaw = math.atan2(T_MS[1, 0] - T_MS[0, 1], T_MS[0, 0] + T_MS[1, 1])
    level = turned(yaw, np.zeros(3))  # the map is level, so a tilt error belongs to the map
    level[:3, 3] = pose[:3, 3] - level[:3, :3] @ true_pose(recording, time_ns)[:3, 3]
    return points, level


def with_changes(points):
    column = np.floor(points[:, :2] / 2.0).astype(np.int64)
    number = (column[:, 0] * 73856093 ^ column[:, 1] * 19349663) * 2654435761 % 2**32
    moves = (np.abs(points[:, 5]) < 0.6) & (number % 3 == 0)
    out = points.copy()
    out[moves, 0] += np.where(number[moves] >> 8 & 1, 1.5, -1.5)
    out[moves, 1] += np.where(number[moves] >> 9 & 1, 1.5, -1.5)
    return out


def write_ply(path, points, T):
    out = points.copy()
    out[:, :3] = points[:, :3] @ T[:3, :3].T + T[:3, 3]
    out[:, 3:6] = points[:, 3:6] @ T[:3, :3].T
    names = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "sigma"))
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(out)}\n{names}end_header\n"
    path.write_bytes(head.encode() + out.astype("<f4").tobytes())


def localise(tumble, folder, recording, points, T_MS, seed):
    """Returns the result of a run in a map: time of localisation after the rest, or None, with the first and the last error."""
    dice = random.Random(f"frame {seed}")
    X = turned(dice.uniform(-3.1, 3.1), np.array([dice.uniform(-100, 100), dice.uniform(-100, 100), dice.uniform(-10, 10)]))
    write_ply(folder / "prior.ply", points, X)
    out = folder / "localised"
    text = command(tumble, "estimate", recording, "--method", "slam/tumble_live", "--map", folder / "prior.ply", "--json",
                   "--quiet", "-o", out)
    first = int(json.loads(text)["health"]["prior_map_sweep"])
    if first == 0:
        return None, None, None
    sweeps = sweeps_of(out)

    def error(sweep):
        time_ns, pose = sweep
        D = np.linalg.inv(X @ T_MS @ true_pose(recording, time_ns)) @ pose
        return np.linalg.norm(D[:3, 3]), math.acos(max(-1.0, min(1.0, (np.trace(D[:3, :3]) - 1.0) / 2.0)))

    return 1e-9 * (sweeps[first - 1][0] - end_of_rest_ns(recording)), error(sweeps[first]), error(sweeps[-1])


if __name__ == "__main__":
    TUMBLE, FOLDER, SCENARIO = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3]
    CATALOGUE = pathlib.Path(__file__).resolve().parents[2] / "scenarios" / "catalogue"
    FIRST, LAST = (int(n) for n in sys.argv[4].split(".."))
    FOLDER.mkdir(parents=True, exist_ok=True)
    found = {"same": [], "changed": [], "wrong": []}
    for SEED in range(FIRST, LAST + 1):
        wrong, _ = make_map(TUMBLE, FOLDER, record(TUMBLE, FOLDER, CATALOGUE, SCENARIO, SEED - 1)[0])
        mapped, second = record(TUMBLE, FOLDER, CATALOGUE, SCENARIO, SEED)
        right, T_MS = make_map(TUMBLE, FOLDER, mapped)
        for name, prior in (("same", right), ("changed", with_changes(right)), ("wrong", wrong)):
            time_s, at_first, at_end = localise(TUMBLE, FOLDER, second, prior, T_MS, SEED)
            false = time_s is not None and (name == "wrong" or at_first[0] > FALSE_M or at_first[1] > FALSE_RAD)
            found[name].append((time_s, false))
            text = "not localised" if time_s is None else (f"localised after {time_s:.2f} s, error {at_first[0]:.3f} m, at the end "
                                                           f"{at_end[0]:.3f} m {at_end[1]:.4f} rad{', FALSE' if false else ''}")
            print(f"{SCENARIO} {SEED} {name}: {text}", flush=True)
    for name, runs in found.items():
        localised = [time_s for time_s, _ in runs if time_s is not None]
        print(f"{SCENARIO} {name}: {len(localised)} of {len(runs)} localised, {sum(t <= 3.0 for t in localised)} within 3 s, "
              f"{sum(false for _, false in runs)} false")
