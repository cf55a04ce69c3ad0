# SPDX-License-Identifier: BSD-3-Clause
"""Checks that bags.py runs with the packages of programs.txt on the path: programs_checks.py TUMBLE FOLDER

Runs two external estimators in the folder that `tumble export stroll.h5 --for PEER --with-truth` writes, by the command
in its manifest. Compares their last poses with `truth.tum`.
"""
import json
import pathlib
import shlex
import shutil
import subprocess
import sys
import unittest

import numpy
import yaml

from program import run

TUMBLE = FOLDER = None
PACKAGES = pathlib.Path(numpy.__file__).resolve().parent.parent
# Bound of the end error on a path of 11 m in a hall. The measured errors are 0.051 m (kiss-icp 1.3.0) and 0.046 m
# (rko-lio 0.4.0).
# The papers report about 1 % of the path; the stated lidar mounting, with errors of 1 cm and 1 deg, increases the error
BOUND_M = 0.3
PEERS = {"kiss-icp": "lidar", "rko-lio": "body"}  # frame of the estimated poses


def tumble(*words):
    return run(TUMBLE, *words)


def make_files():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    tumble("record", "stroll", "--seed", 61003, "-o", FOLDER / "a.h5")
    for peer in PEERS:
        tumble("export", FOLDER / "a.h5", "--for", peer, "--with-truth", "-o", FOLDER / peer)


def said(peer):
    return json.loads((FOLDER / peer / "manifest.json").read_text())


def start(peer):
    """Runs the command of the manifest and returns the trajectory that it writes, or None."""
    shutil.rmtree(FOLDER / peer / "results", ignore_errors=True)
    program, *words = shlex.split(said(peer)["run"])
    ran = subprocess.run([sys.executable, PACKAGES / "bin" / program, *words], cwd=FOLDER / peer, capture_output=True, text=True)
    left = sorted((FOLDER / peer / "results").rglob("*_tum.txt"))
    if ran.returncode != 0 or len(left) != 1:
        print(f"{peer}: status {ran.returncode}, {len(left)} trajectories; {(ran.stdout + ran.stderr)[-600:]}")
        return None
    return left[0]


def pose(p_m, q_xyzw):
    x, y, z, w = numpy.asarray(q_xyzw) / numpy.linalg.norm(q_xyzw)
    out = numpy.eye(4)
    out[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                   [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                   [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    out[:3, 3] = p_m
    return out


def poses(path):
    rows = numpy.loadtxt(path, ndmin=2)
    return rows[:, 0], [pose(row[1:4], row[4:8]) for row in rows]


def end_error_m(peer, trajectory, frame):
    """Returns the position error of the last pose relative to the first pose, from the truth of `frame` at the same times."""
    T = said(peer)["extrinsics"]["T_body_lidar"]
    mounting = pose(T["p_m"], T["q_xyzw"]) if frame == "lidar" else numpy.eye(4)
    stamps, given = poses(trajectory)
    true_stamps, true = poses(FOLDER / peer / "truth.tum")
    # both estimators use the time of the sweep's last point as the time of the pose
    ends = [true[numpy.abs(true_stamps - stamp).argmin()] @ mounting for stamp in (stamps[0], stamps[-1])]
    if len(given) < 150:
        raise AssertionError(f"{peer}: {len(given)} poses of 200 sweeps")
    off = numpy.linalg.inv(given[0]) @ given[-1] - numpy.linalg.inv(ends[0]) @ ends[1]
    return float(numpy.linalg.norm(off[:3, 3]))


class Programs(unittest.TestCase):
    def test_started_as_the_manifest_says_they_follow(self):
        for peer, frame in PEERS.items():
            with self.subTest(peer):
                trajectory = start(peer)
                self.assertIsNotNone(trajectory)
                error_m = end_error_m(peer, trajectory, frame)
                print(f"{peer}: {error_m:.3f} m at the end, at most {BOUND_M}")
                self.assertLess(error_m, BOUND_M)
                # negative control: the wrong frame exceeds the bound
                self.assertGreater(end_error_m(peer, trajectory, {"lidar": "body", "body": "lidar"}[frame]), BOUND_M)

    def test_a_key_that_the_program_does_not_know_is_noticed(self):
        file = FOLDER / "rko-lio" / "rko_lio.yaml"
        text = file.read_text()
        try:
            words = yaml.safe_load(text)
            file.write_text(yaml.safe_dump({**words, "timestamps": words.pop("lidar_timestamps")}))
            self.assertIsNone(start("rko-lio"))
        finally:
            file.write_text(text)


if __name__ == "__main__":
    TUMBLE, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
    make_files()
    unittest.main(argv=sys.argv[:1])
