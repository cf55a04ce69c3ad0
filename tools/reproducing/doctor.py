# SPDX-License-Identifier: BSD-3-Clause
"""Measures how often `tumble doctor` finds a fault that is added to a simulated recording, and how often it reports a fault of a correct recording.

Each recording is exported in one bag format. A third of the recordings tumble, the others are carried by hand. The seeds are fixed.
"""
from __future__ import annotations

import concurrent.futures
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import h5py
import numpy as np

from .page import Table
from .runs import ROOT, RunRejected, Runs

FIRST_SEED = 41001
CARRIED, TUMBLING = 8, 4  # recordings of a bag format
TUMBLES = ("hill", "throw", "stairs", "forest")
HERE = "tools/reproducing"
NS = 1_000_000_000
MOVING_NS = int(2.5 * NS)  # all simulated motions start before this time
POSE_DEG, POSE_M = 10.0, 0.05  # largest error of the lidar pose that a repair names
KINDS = ("carried", "tumbling")


@dataclass
class Format:
    """A bag format: its name on the page, the words of `tumble export`, the file, and the scenario of the carried recordings."""

    title: str
    words: tuple[str, ...]
    bag: str
    carried: str = f"{HERE}/walk.yaml"
    needs_times: bool = True


FORMATS = {
    "fast-lio": Format("ROS 1, `time` in s (`--for fast-lio`)", ("--for", "fast-lio"), "recording.bag"),
    "dlio": Format("ROS 1, `t` in ns (`--for dlio`)", ("--for", "dlio"), "recording.bag"),
    "lio-sam": Format("ROS 1, `time` in s (`--for lio-sam`)", ("--for", "lio-sam"), "recording.bag"),
    "kiss-icp": Format("ROS 1, `t` in ns (`--for kiss-icp`)", ("--for", "kiss-icp"), "recording.bag", needs_times=False),
    "point-lio": Format("ROS 1, Livox CustomMsg (`--for point-lio`)", ("--for", "point-lio"), "recording.bag", f"{HERE}/walk_livox.yaml"),
    "glim": Format("ROS 2, `t` in ns (`--for glim`)", ("--for", "glim"), "bag"),
    "norlab": Format("ROS 2, `t` in ns (`--for norlab`)", ("--for", "norlab"), "bag", needs_times=False),
    "rko-lio": Format("ROS 2, `t` in ns (`--for rko-lio`)", ("--for", "rko-lio"), "bag"),
    "mcap": Format("MCAP (`--format mcap`)", ("--format", "mcap"), "", needs_times=False),
}


class Recording:
    """The readings of a recording file, open for changes."""

    def __init__(self, path: pathlib.Path):
        self.file = h5py.File(path, "r+")
        self.imu, self.lidar = self.file["sensors/imus/0"], self.file["sensors/lidars/0"]

    def set(self, group: h5py.Group, name: str, values: np.ndarray) -> None:
        kind, attributes = group[name].dtype, dict(group[name].attrs)
        del group[name]
        group.create_dataset(name, data=np.asarray(values).astype(kind)).attrs.update(attributes)

    def change(self, group: h5py.Group, *names: str, by: Callable[[np.ndarray], np.ndarray]) -> None:
        for name in names:
            self.set(group, name, by(group[name][:]))

    def keep_readings(self, kept: np.ndarray) -> None:
        self.change(self.imu, "time_ns", *READINGS, "clip_flags", by=lambda rows: rows[kept])

    def keep_sweeps(self, kept: np.ndarray) -> None:
        counts = np.diff(self.lidar["sweep_first"][:].astype(np.int64))
        points = np.repeat(kept, counts)
        self.change(self.lidar, "position_L_m", "range_m", "intensity", "offset_ns", "ring", by=lambda rows: rows[points])
        self.change(self.lidar, "sweep_start_ns", by=lambda rows: rows[kept])
        self.set(self.lidar, "sweep_first", np.concatenate([[0], np.cumsum(counts[kept])]))


READINGS = ("gyro_I_rad_s", "accel_I_m_s2")


@dataclass
class Expected:
    """The row of `tumble doctor` that finds a fault.

    evidence  regular expression of the evidence
    repair    regular expression of evidence and repair
    T_BL      pose of the lidar that the repair must name
    fault     false: the row is a note
    """

    evidence: str
    repair: str
    T_BL: np.ndarray | None = None
    position: bool = False
    fault: bool = True


@dataclass
class Fault:
    """A fault: its name on the page, the function that adds it to a recording, and the conditions of recordings."""

    title: str
    add: Callable[[Recording, np.random.Generator], Expected]
    kinds: tuple[str, ...] = KINDS
    without_times: bool = False


def quarter_turn(rng: np.random.Generator) -> np.ndarray:
    """Returns the rotation by 90 degrees about a random axis in a random direction."""
    axis, sign = int(rng.integers(3)), float(rng.choice([-1.0, 1.0]))
    out = np.zeros((3, 3))
    out[axis, axis] = 1.0
    out[(axis + 1) % 3, (axis + 2) % 3], out[(axis + 2) % 3, (axis + 1) % 3] = -sign, sign
    return out


def pose(R: np.ndarray, T: np.ndarray) -> np.ndarray:
    out = T.copy()
    out[:3, :3] = R
    return out


def accel_in_g(recording: Recording, _: np.random.Generator) -> Expected:
    recording.change(recording.imu, "accel_I_m_s2", by=lambda f: f / 9.80665)
    return Expected("reads the accelerometer in g", "--accel-unit")


def gyro_in_degrees(recording: Recording, _: np.random.Generator) -> Expected:
    recording.change(recording.imu, "gyro_I_rad_s", by=np.rad2deg)
    return Expected("rates may be in deg/s", "--gyro-unit deg/s")


def mirrored_axis(recording: Recording, rng: np.random.Generator) -> Expected:
    axis = int(rng.integers(3))
    recording.change(recording.imu, *READINGS, by=lambda rows: rows * np.where(np.arange(3) == axis, -1.0, 1.0))
    return Expected("mirrored", f"the sign of the {'xyz'[axis]} axis is wrong.*correct the IMU's driver")


def exchange_axes(recording: Recording, rng: np.random.Generator, names: tuple[str, ...]) -> Expected:
    order = ([0, 2, 1], [2, 1, 0], [1, 0, 2])[int(rng.integers(3))]
    recording.change(recording.imu, *names, by=lambda rows: rows[:, order])
    axes = ", ".join("xyz"[k] for k in order)
    return Expected("mirrored", f"the true axes \\(x, y, z\\) are the axes \\({axes}\\) of.*correct the IMU's driver")


def exchanged_axes(recording: Recording, rng: np.random.Generator) -> Expected:
    return exchange_axes(recording, rng, READINGS)


def exchanged_gyro_axes(recording: Recording, rng: np.random.Generator) -> Expected:
    return exchange_axes(recording, rng, READINGS[:1])


def inverted_accel(recording: Recording, _: np.random.Generator) -> Expected:
    recording.change(recording.imu, "accel_I_m_s2", by=lambda f: -f)
    return Expected("axes|signs|inverted", "sign|inverted")


def turned_imu(recording: Recording, rng: np.random.Generator) -> Expected:
    R, T_BI, T_BL = quarter_turn(rng), recording.imu["T_BI"][:], recording.lidar["T_BL"][:]
    recording.change(recording.imu, *READINGS, by=lambda rows: rows @ R.T)
    A = T_BI[:3, :3]
    return Expected("the rotations of lidar and gyro differ", "--T-body-lidar", pose(A @ R @ A.T @ T_BL[:3, :3], T_BL))


def turned_lidar(recording: Recording, rng: np.random.Generator) -> Expected:
    T_BL = recording.lidar["T_BL"][:]
    recording.set(recording.lidar, "T_BL", pose(T_BL[:3, :3] @ quarter_turn(rng), T_BL))
    return Expected("the rotations of lidar and gyro differ", "--T-body-lidar", T_BL)


def inverted_lidar(recording: Recording, _: np.random.Generator) -> Expected:
    T_BL = recording.lidar["T_BL"][:]
    recording.set(recording.lidar, "T_BL", np.linalg.inv(T_BL))
    return Expected("the stated pose may be inverted", "--T-body-lidar", T_BL, position=True)


def late_lidar(recording: Recording, _: np.random.Generator) -> Expected:
    recording.change(recording.lidar, "sweep_start_ns", by=lambda t: t + NS // 5)
    return Expected(r"the lidar measures rotations 0\.(1[789]|2[0123]?)\d* s later", "--imu-minus-lidar-clock -0")


def late_imu(recording: Recording, _: np.random.Generator) -> Expected:
    recording.change(recording.imu, "time_ns", by=lambda t: t + NS // 10)
    return Expected(r"the lidar measures rotations 0\.(0[789]|1[0123]?)\d* s earlier", "--imu-minus-lidar-clock 0")


def drifting_imu_clock(recording: Recording, _: np.random.Generator) -> Expected:
    recording.change(recording.imu, "time_ns", by=lambda t: t[0] + (t - t[0]) * 101 // 100)
    return Expected("clock", "clock")


def jumping_imu_clock(recording: Recording, _: np.random.Generator) -> Expected:
    recording.change(recording.imu, "time_ns", by=lambda t: t + np.where(t > (MOVING_NS + t[-1]) // 2, 3 * NS // 10, 0))
    return Expected("readings are lost", "clock does not jump")


def lost_readings(recording: Recording, _: np.random.Generator) -> Expected:
    recording.keep_readings(np.arange(len(recording.imu["time_ns"])) % 10 != 5)
    return Expected("readings are lost", "record without loss")


def gap_of_imu(recording: Recording, _: np.random.Generator) -> Expected:
    since = recording.imu["time_ns"][:] - MOVING_NS - NS // 2
    recording.keep_readings((since < 0) | (since > 7 * NS // 10))
    return Expected("readings are lost", "record without loss")


def lost_sweeps(recording: Recording, _: np.random.Generator) -> Expected:
    recording.keep_sweeps(np.arange(len(recording.lidar["sweep_start_ns"])) % 7 != 3)
    return Expected("sweeps are lost", "record without loss")


def late_start(recording: Recording, _: np.random.Generator) -> Expected:
    start_ns = recording.lidar["sweep_start_ns"][:]
    recording.keep_sweeps(start_ns >= start_ns[0] + 2 * NS)
    return Expected("this sensor starts .* s after", "start the recording after the lidar has started")


def short_point_times(recording: Recording, _: np.random.Generator) -> Expected:
    recording.change(recording.lidar, "offset_ns", by=lambda t: t // 100)
    return Expected("point times span less than 2 %", "--time-unit")


def no_point_times(recording: Recording, _: np.random.Generator) -> Expected:
    recording.lidar.attrs["point_times"] = "unknown"
    recording.change(recording.lidar, "offset_ns", by=lambda t: 0 * t)
    return Expected("the points have no times", "--time-field")


def low_limit(recording: Recording, name: str) -> None:
    limit = 0.5 * np.abs(recording.imu[name][:]).max()
    recording.change(recording.imu, name, by=lambda rows: np.clip(rows, -limit, limit))


def low_gyro_limit(recording: Recording, _: np.random.Generator) -> Expected:
    low_limit(recording, "gyro_I_rad_s")
    return Expected("the gyro is saturated", "larger gyro range", fault=False)


def low_accel_limit(recording: Recording, _: np.random.Generator) -> Expected:
    low_limit(recording, "accel_I_m_s2")
    return Expected("the accelerometer is saturated", "larger accelerometer range", fault=False)


def freeze(recording: Recording, name: str, axis: int) -> None:
    rows = recording.imu[name][:]
    frozen = recording.imu["time_ns"][:] > MOVING_NS
    rows[frozen, axis] = rows[np.argmax(frozen), axis]
    recording.set(recording.imu, name, rows)


def frozen_gyro_axis(recording: Recording, rng: np.random.Generator) -> Expected:
    axis = int(rng.integers(3))
    freeze(recording, "gyro_I_rad_s", axis)
    return Expected(f"gyro_{'xyz'[axis]}: the axis repeats one reading", "check the sensor")


def frozen_accel_axis(recording: Recording, rng: np.random.Generator) -> Expected:
    axis = int(rng.integers(3))
    freeze(recording, "accel_I_m_s2", axis)
    return Expected(f"accel_{'xyz'[axis]}: the axis repeats one reading", "check the sensor")


def no_rest(recording: Recording, _: np.random.Generator) -> Expected:
    recording.keep_readings(recording.imu["time_ns"][:] >= MOVING_NS)
    recording.keep_sweeps(recording.lidar["sweep_start_ns"][:] >= MOVING_NS)
    return Expected("the robot moves during the first second", "keep the robot still for 1 s")


FAULTS = {
    "accel_in_g": Fault("accelerometer in g", accel_in_g),
    "gyro_in_degrees": Fault("gyro in deg/s", gyro_in_degrees),
    "mirrored_axis": Fault("one axis of the IMU mirrored", mirrored_axis),
    "exchanged_axes": Fault("two axes of the IMU exchanged", exchanged_axes),
    "exchanged_gyro_axes": Fault("two axes of the gyro exchanged", exchanged_gyro_axes),
    "inverted_accel": Fault("accelerometer inverted", inverted_accel),
    "turned_imu": Fault("IMU turned by 90°", turned_imu),
    "turned_lidar": Fault("lidar pose turned by 90°", turned_lidar),
    "inverted_lidar": Fault("lidar pose inverted", inverted_lidar),
    "late_lidar": Fault("lidar clock 0.2 s late", late_lidar),
    "late_imu": Fault("IMU clock 0.1 s late", late_imu),
    "drifting_imu_clock": Fault("IMU clock 1 % fast", drifting_imu_clock),
    "jumping_imu_clock": Fault("IMU clock jumps by 0.3 s", jumping_imu_clock),
    "lost_readings": Fault("one of ten IMU readings lost", lost_readings),
    "gap_of_imu": Fault("IMU readings of 0.7 s lost", gap_of_imu),
    "lost_sweeps": Fault("one of seven sweeps lost", lost_sweeps),
    "late_start": Fault("lidar starts 2 s late", late_start),
    "short_point_times": Fault("point times a hundred times too short", short_point_times),
    "no_point_times": Fault("no point times", no_point_times, without_times=True),
    "low_gyro_limit": Fault("gyro saturates at half of its largest rate (note)", low_gyro_limit),
    "low_accel_limit": Fault("accelerometer saturates at half of its largest reading (note)", low_accel_limit, kinds=("tumbling",)),
    "frozen_gyro_axis": Fault("one gyro axis frozen", frozen_gyro_axis),
    "frozen_accel_axis": Fault("one accelerometer axis frozen", frozen_accel_axis),
    "no_rest": Fault("no rest at the start", no_rest),
}


def prepare(path: pathlib.Path) -> None:
    """Removes the truth and all IMUs but the first, as in a user's bag."""
    with h5py.File(path, "r+") as file:
        del file["truth"]
        file.attrs.modify("has_truth", 0)
        for name in list(file["sensors/imus"])[1:]:
            del file["sensors/imus"][name]
        file.attrs["digest"] = ""
        del file["sensors"].attrs["digest"]


@dataclass
class Case:
    """One recording of a bag format: its number in the format, seed, scenario and kind."""

    format: str
    number: int

    @property
    def seed(self) -> int:
        return FIRST_SEED + list(FORMATS).index(self.format) * (CARRIED + TUMBLING) + self.number

    @property
    def kind(self) -> str:
        return KINDS[self.number >= CARRIED]

    @property
    def scenario(self) -> str:
        return TUMBLES[self.number - CARRIED] if self.kind == "tumbling" else FORMATS[self.format].carried

    def faults(self) -> Iterable[str]:
        """Returns the faults of this recording. Each fault has one carried recording of each format, and a tumbling recording of each third format."""
        for k, (name, fault) in enumerate(FAULTS.items()):
            if self.kind == "tumbling":
                used = self.number == CARRIED + k % TUMBLING and (list(FORMATS).index(self.format) + k) % 3 == 0
            else:
                used = self.number == k % CARRIED
            if used and self.kind in fault.kinds and not (fault.without_times and FORMATS[self.format].needs_times):
                yield name


def angle_deg(R: np.ndarray) -> float:
    return math.degrees(math.acos(min(1.0, max(-1.0, (np.trace(R) - 1.0) / 2.0))))


def names_pose(repair: str, expected: Expected) -> bool:
    found = re.search(r"--T-body-lidar((?: [-+.\de]+){7})", repair)
    if not found or expected.T_BL is None:
        return expected.T_BL is None
    words = [word.rstrip(".") for word in found[1].split()]
    x, y, z, w = map(float, words[3:])
    v = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    R = np.eye(3) + 2.0 * (w * v + v @ v)
    if angle_deg(R.T @ expected.T_BL[:3, :3]) > POSE_DEG:
        return False
    return not expected.position or float(np.abs(np.array(words[:3], float) - expected.T_BL[:3, 3]).max()) < POSE_M


def judged(findings: list[dict], expected: Expected) -> tuple[bool, bool]:
    """Returns whether a row finds the fault, and whether such a row names the repair."""
    rows = [row for row in findings if row["fault"] == expected.fault and re.search(expected.evidence, row["evidence"])]
    texts = [row["evidence"] + ". " + row["repair"] for row in rows]
    return bool(rows), any(re.search(expected.repair, text) and names_pose(text, expected) for text in texts)


class Doctor:
    """Runs `tumble doctor` on the bags of one recording after another, and stores the findings."""

    def __init__(self, runs: Runs):
        self.runs = runs
        self.store = runs.folder / "findings.jsonl"
        lines = self.store.read_text().splitlines() if self.store.is_file() else []
        self.results = {(row["fault"], row["format"], row["seed"]): row for row in map(json.loads, lines)}

    def diagnose(self, recording: pathlib.Path, case: Case) -> list[dict]:
        words = FORMATS[case.format].words
        target = recording.with_suffix(".mcap" if case.format == "mcap" else "")
        self.runs.call("export", recording, *words, "-o", target)
        ended = subprocess.run([str(self.runs.program), "doctor", str(target / FORMATS[case.format].bag), "--json"], capture_output=True, text=True)
        if ended.returncode not in (0, 1):
            return [{"where": "", "evidence": f"exit status {ended.returncode}: {ended.stderr.strip()}", "repair": "", "fault": True}]
        return json.loads(ended.stdout)["findings"]

    def add(self, name: str, case: Case, found: bool, repaired: bool, findings: list[dict]) -> None:
        row = {"fault": name, "format": case.format, "seed": case.seed, "kind": case.kind, "found": found, "repaired": repaired, "findings": findings}
        self.results[name, case.format, case.seed] = row
        with self.store.open("a") as file:
            file.write(json.dumps(row) + "\n")

    def run(self, case: Case, names: Iterable[str]) -> None:
        missing = [name for name in names if (name, case.format, case.seed) not in self.results]
        if not missing:
            return
        folder = self.runs.folder / f"{case.format}_{case.seed}"
        shutil.rmtree(folder, ignore_errors=True)
        try:
            clean = self.runs.record(ROOT / case.scenario if "/" in case.scenario else case.scenario, case.seed, folder / "clean.h5")
        except RunRejected:
            return
        prepare(clean)
        for name in missing:
            used = folder / f"{name or 'used'}.h5"
            shutil.copy(clean, used)
            expected = Expected("", "")
            if name:
                recording = Recording(used)
                expected = FAULTS[name].add(recording, np.random.default_rng([case.seed, list(FAULTS).index(name)]))
                recording.file.close()
            findings = self.diagnose(used, case)
            found, repaired = judged(findings, expected) if name else (False, False)
            print(f"{case.format} {case.seed} {case.scenario.split('/')[-1]} {name or 'clean'}: found {found}, repair {repaired}", file=sys.stderr, flush=True)
            self.add(name, case, found, repaired, findings)
            for each in (used, folder / used.stem):
                shutil.rmtree(each) if each.is_dir() else each.unlink(missing_ok=True)
            used.with_suffix(".mcap").unlink(missing_ok=True)
        shutil.rmtree(folder)


def wilson(count: int, size: int) -> tuple[float, float]:
    """Returns the 95 % interval of a share (Wilson, 1927)."""
    z2 = 1.959964**2
    centre, half = count + z2 / 2.0, math.sqrt(z2 * (count * (size - count) / size + z2 / 4.0))
    return (centre - half) / (size + z2), (centre + half) / (size + z2)


def has_fault(row: dict) -> bool:
    return any(finding["fault"] for finding in row["findings"])


MEASURES = {"found": lambda row: row["found"], "repair named": lambda row: row["repaired"], "any fault reported": has_fault}


def counted(rows: list[dict], measure: Callable[[dict], bool]) -> str:
    return f"{sum(map(measure, rows))}/{len(rows)}" if rows else "–"


def share(rows: list[dict], measure: Callable[[dict], bool]) -> str:
    count, size = sum(map(measure, rows)), len(rows)
    if size == 0:
        return "–"
    low, high = wilson(count, size)
    return f"{count} of {size} ({100.0 * count / size:.1f} %, 95 % interval {100.0 * low:.1f} to {100.0 * high:.1f} %)"


def page(results: Iterable[dict]) -> str:
    rows = list(results)
    table = Table(["fault", *(f"{kind}: {name}" for kind in KINDS for name in MEASURES)])
    for name, fault in FAULTS.items():
        own = [[row for row in rows if row["fault"] == name and row["kind"] == kind] for kind in KINDS]
        table.add(fault.title, *(counted(of_kind, measure) for of_kind in own for measure in MEASURES.values()))
    clean = Table(["bag format", "correct recordings", "false alarms"])
    for name, each in FORMATS.items():
        own = [row for row in rows if row["format"] == name and not row["fault"]]
        clean.add(each.title, str(len(own)), str(sum(map(has_fault, own))))
    summary = ""
    for kind in KINDS:
        faulty = [row for row in rows if row["fault"] and row["kind"] == kind]
        sound = [row for row in rows if not row["fault"] and row["kind"] == kind]
        summary += "".join(f"- {kind}, faults, {name}: {share(faulty, measure)}\n" for name, measure in MEASURES.items())
        summary += f"- {kind}, correct recordings, false alarms: {share(sound, has_fault)}\n"
    return (f"# Faults that `tumble doctor` finds\n\n{summary}\n{table.text()}\n{clean.text()}\n"
            f"Seeds {FIRST_SEED} to {FIRST_SEED + len(FORMATS) * (CARRIED + TUMBLING) - 1}, one for each recording. Command: `tools/reproduce doctor`.\n")


def reproduce(runs: Runs) -> str:
    """Runs all cases and returns the page."""
    runs.folder.mkdir(parents=True, exist_ok=True)
    doctor = Doctor(runs)
    cases = [Case(name, number) for name in FORMATS for number in range(CARRIED + TUMBLING)]
    with concurrent.futures.ThreadPoolExecutor(runs.jobs) as pool:
        for names in (lambda case: case.faults(), lambda case: [""]):
            for _ in pool.map(lambda case, names=names: doctor.run(case, names(case)), cases):
                pass
    return page(doctor.results.values())
