# SPDX-License-Identifier: BSD-3-Clause
"""Measures the localisation of simulated runs in a prior map of the same world.

For each scenario and seed, run 1 draws the map. The other runs have the same world, but their own motion: all random numbers of the motion are drawn
again, with a uniform heading. The map is rotated and moved at random, so that no start pose fits by chance. All runs search without an initial pose:

    same     in the map of run 1
    late     in the map of run 1; the sensors start 3 s later, so that the run starts elsewhere and often in motion
    changed  in the map of run 1, in which the upright surfaces of a third of all columns of 2 m are moved by 1.5 m
    wrong    in the map of another seed

A localisation is false if the map is wrong, or if the last pose has an error of more than 1 m or 0.2 rad.
"""
from __future__ import annotations

import json
import math
import pathlib
import random
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import h5py
import numpy as np
import yaml

from .page import Table, number
from .runs import ROOT, RunRejected, Runs

SCENARIOS = ("hill", "scree", "stairs", "cliff", "throw", "forest")
CATALOGUE = ROOT / "scenarios" / "catalogue"
RUNS_PER_MAP = 10
DURATION_S, LATE_S = 5.5, 3.0
FALSE_M, FALSE_RAD = 1.0, 0.2
MOVES_RAD_S = 0.3  # rate at which the rest has ended
IN_TIME_S = 3.0


@dataclass
class Prior:
    """Map of run 1: rows of position, normal and standard deviation, and the pose of the simulated world in the map."""

    points: np.ndarray
    T_MS: np.ndarray


@dataclass
class Localisation:
    """Result of a search: time from the end of the rest [s], and errors of the last pose in the map [m, rad]. No time: not localised."""

    time_s: float | None = None
    last: tuple[float, float] = (math.nan, math.nan)

    def is_false(self, case: str) -> bool:
        return self.time_s is not None and (case == "wrong" or self.last[0] > FALSE_M or self.last[1] > FALSE_RAD)


def motion_of(scenario: str) -> dict[str, object]:
    content = yaml.safe_load((CATALOGUE / f"{scenario}.yaml").read_text())
    own = content.get("motion", {})
    if "extends" not in content or "type" in own:
        return own
    return {**motion_of(content["extends"]), **own}


def drawn(distribution: dict[str, list[float]], dice: random.Random) -> float:
    (kind, arguments), = distribution.items()
    if kind == "uniform":
        return dice.uniform(*arguments)
    if kind == "log_uniform":
        return math.exp(dice.uniform(*map(math.log, arguments)))
    if kind == "choice":
        return dice.choice(arguments)
    value = dice.gauss(*arguments[:2])
    return min(max(value, arguments[2]), arguments[3]) if len(arguments) == 4 else value


def second_scenario(scenario: str, name: str, late_s: float) -> str:
    dice = random.Random(f"motion {name}")
    motion = {key: drawn(value, dice) for key, value in motion_of(scenario).items() if isinstance(value, dict)}
    motion["yaw_rad"] = dice.uniform(-3.1, 3.1)
    out: dict[str, object] = {"extends": scenario, "name": name, "doc": f"Another run in the world of {scenario}.", "duration_s": DURATION_S + late_s, "motion": motion}
    if late_s > 0.0:
        out["sensors"] = [{"name": sensor, "start_delay_s": late_s} for sensor in ("imu", "imu_reference", "lidar")]
    return yaml.safe_dump(out)


def transform(R: np.ndarray, p: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def rotation(q: np.ndarray) -> np.ndarray:
    x, y, z, w = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def heading(yaw: float) -> np.ndarray:
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def true_pose(recording: pathlib.Path, time_ns: int) -> np.ndarray:
    """Returns the true pose of the first IMU in the simulated world."""
    with h5py.File(recording) as file:
        truth = file["truth"]
        k = min(int(round(time_ns / truth.attrs["period_ns"])), len(truth["p_WB_m"]) - 1)
        return transform(rotation(truth["q_WB"][k]), truth["p_WB_m"][k]) @ truth["imus/0/T_BI"][:]


def end_of_rest_ns(recording: pathlib.Path) -> int:
    with h5py.File(recording) as file:
        imu = file["sensors/imus/0"]
        return int(imu["time_ns"][np.argmax(np.linalg.norm(imu["gyro_I_rad_s"][:], axis=1) > MOVES_RAD_S)])


def sweeps_of(folder: pathlib.Path) -> list[tuple[int, np.ndarray]]:
    """Returns the time and the pose at the end of each sweep of an estimate."""
    rows = np.atleast_1d(np.genfromtxt(folder / "sweeps.csv", delimiter=",", names=True))
    return [(int(row["pose_time_ns"]), transform(rotation(np.array([row[f"q{axis}"] for axis in "xyzw"])),
                                                 np.array([row[f"p{axis}_m"] for axis in "xyz"]))) for row in rows]


def make_map(runs: Runs, scenario: str, seed: int) -> Prior:
    recording = runs.record(scenario, seed, runs.folder / f"{scenario}_{seed}.h5")
    estimate = runs.estimate(recording, "slam/tumble_lag", runs.folder / f"{scenario}_{seed}")
    data = (estimate / "map.ply").read_bytes()
    points = np.frombuffer(data[data.index(b"end_header\n") + 11:], dtype="<f4").reshape(-1, 7)
    time_ns, pose = sweeps_of(estimate)[0]
    truth = true_pose(recording, time_ns)
    R = pose[:3, :3] @ truth[:3, :3].T
    level = heading(math.atan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1]))  # the map is level, so a tilt error of run 1 counts as an error of the map
    return Prior(points, transform(level, pose[:3, 3] - level @ truth[:3, 3]))


def with_changes(prior: Prior) -> Prior:
    points = prior.points.copy()
    column = np.floor(points[:, :2] / 2.0).astype(np.int64)
    hashed = (column[:, 0] * 73856093 ^ column[:, 1] * 19349663) * 2654435761 % 2**32
    moved = (np.abs(points[:, 5]) < 0.6) & (hashed % 3 == 0)
    points[moved, 0] += np.where(hashed[moved] >> 8 & 1, 1.5, -1.5)
    points[moved, 1] += np.where(hashed[moved] >> 9 & 1, 1.5, -1.5)
    return Prior(points, prior.T_MS)


def write_ply(path: pathlib.Path, points: np.ndarray, T: np.ndarray) -> None:
    out = points.copy()
    out[:, :3] = points[:, :3] @ T[:3, :3].T + T[:3, 3]
    out[:, 3:6] = points[:, 3:6] @ T[:3, :3].T
    names = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "sigma"))
    path.write_bytes(f"ply\nformat binary_little_endian 1.0\nelement vertex {len(out)}\n{names}end_header\n".encode() + out.astype("<f4").tobytes())


def localise(runs: Runs, recording: pathlib.Path, prior: Prior, case: str) -> Localisation:
    name = f"{recording.stem}_{case}"
    dice = random.Random(f"frame {name}")
    X = transform(heading(dice.uniform(-3.1, 3.1)), np.array([dice.uniform(-100, 100), dice.uniform(-100, 100), dice.uniform(-10, 10)]))
    map_file, folder = runs.folder / f"{name}.ply", runs.folder / name
    if not (folder / "estimate.json").is_file():
        write_ply(map_file, prior.points, X)
        runs.call("estimate", recording.name, "--method", "slam/tumble_live", "--map", map_file.name, "-o", name)
        map_file.unlink()
    first = int(json.loads((folder / "estimate.json").read_text())["health"].get("prior_map_sweep", 0))
    if first == 0:
        return Localisation()
    sweeps = sweeps_of(folder)

    def error(time_ns: int, pose: np.ndarray) -> tuple[float, float]:
        D = np.linalg.inv(X @ prior.T_MS @ true_pose(recording, time_ns)) @ pose
        return float(np.linalg.norm(D[:3, 3])), math.acos(max(-1.0, min(1.0, (np.trace(D[:3, :3]) - 1.0) / 2.0)))

    time_s = 1e-9 * (sweeps[max(first - 2, 0)][0] - end_of_rest_ns(recording))  # the sweep before the first one in the map localises the run
    return Localisation(time_s, error(*sweeps[-1]))


def runs_in_maps(runs: Runs, scenario: str) -> dict[str, list[Localisation]]:
    with ThreadPoolExecutor(runs.jobs) as pool:
        priors = dict(zip(runs.draws, pool.map(lambda seed: make_map(runs, scenario, seed), runs.draws)))
        pending: list[tuple[str, object]] = []
        for place, seed in enumerate(runs.draws):
            others = {"late": (priors[seed], LATE_S), "changed": (with_changes(priors[seed]), 0.0), "wrong": (priors[runs.draws[place - 1]], 0.0)}
            for run in range(1, RUNS_PER_MAP + 1):
                pending.append(("same", pool.submit(run_2, runs, scenario, seed, run, priors[seed], "same", 0.0)))
            for case, (prior, late_s) in others.items():
                pending.append((case, pool.submit(run_2, runs, scenario, seed, 1, prior, case, late_s)))
        out: dict[str, list[Localisation]] = {}
        for case, result in pending:
            if result.result() is not None:
                out.setdefault(case, []).append(result.result())
    return out


def run_2(runs: Runs, scenario: str, seed: int, run: int, prior: Prior, case: str, late_s: float) -> Localisation | None:
    """Simulates a further run and localises it. Returns nothing if the simulator rejects the motion."""
    name = f"{scenario}_{seed}_{run}{'_late' if late_s > 0.0 else ''}"
    file, recording = runs.folder / f"{name}.yaml", runs.folder / f"{name}.h5"
    file.write_text(second_scenario(scenario, name, late_s))
    try:
        runs.record(file.name, seed, recording)
    except RunRejected:
        return None
    return localise(runs, recording, prior, case)


def row(table: Table, title: str, case: str, found: list[Localisation]) -> None:
    times = [each.time_s for each in found if each.time_s is not None]
    errors = sorted(each.last[0] for each in found if each.time_s is not None)
    table.add(title, case, str(len(found)), str(len(times)), str(sum(time <= IN_TIME_S for time in times)),
              str(sum(each.is_false(case) for each in found)), number(float(np.median(times)) if times else math.nan),
              number(100.0 * float(np.median(errors)) if errors else math.nan))


def reproduce(runs: Runs) -> str:
    """Runs all searches and returns the table."""
    table = Table(["scenario", "map", "runs", "localised", "within 3 s", "false", "median time [s]", "median error at the end [cm]"])
    all_cases: dict[str, list[Localisation]] = {}
    for scenario in SCENARIOS:
        found = runs_in_maps(runs, scenario)
        for case, each in found.items():
            all_cases.setdefault(case, []).extend(each)
        row(table, scenario, "same", found["same"])
    for case, found in all_cases.items():
        row(table, "all", case, found)
    return table.text()
