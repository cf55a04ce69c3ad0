# SPDX-License-Identifier: BSD-3-Clause
"""Data for the tests: a small generated tumble and roll, and recordings of the program if it is available."""
import os
import pathlib
import subprocess

import numpy as np
import pytest

import tumble


@pytest.fixture(scope="session")
def program():
    """Returns the program of this tree, whose path CTest passes. To run the tests without program, use `-m "not program"`."""
    return tumble.program()


@pytest.fixture(scope="session")
def recordings(program, tmp_path_factory):
    """Simulated recordings: a tumble of the rig, the rig twirled by hand, and a slip of the sphere."""
    folder = tmp_path_factory.mktemp("recordings")
    return {name: tumble.record(name, folder / f"{name}.h5", seed=1) for name in ("hill", "slip", "twirl")}


@pytest.fixture(scope="session")
def hill(recordings):
    return tumble.read(recordings["hill"])


@pytest.fixture(scope="session")
def twirl(recordings):
    return tumble.read(recordings["twirl"])


@pytest.fixture(scope="session")
def slip(recordings):
    return tumble.read(recordings["slip"])


@pytest.fixture(scope="session")
def real_data():
    """Returns the folder with the real recordings, which are not part of the project, or None."""
    root = pathlib.Path(os.environ.get("TUMBLE_SHARED_DATA", pathlib.Path(__file__).parents[3] / "shared" / "data"))
    return root if (root / "repoimu").is_dir() else None


def spinning(seconds=4.0, rate_hz=100.0, rail=None, seed=0):
    """An IMU that is stationary for a second, then rotates with increasing rate about a vertical axis at a distance of 5 cm, in closed form.

    Returns time_ns, gyro, accel, true rate. `rail`: the gyro delivers no more than this, rad/s.
    """
    noise = np.random.default_rng(seed)
    k = np.arange(1, round(seconds * rate_hz) + 1)
    time_ns = np.round(k * 1e9 / rate_hz).astype(np.int64)
    t = time_ns * 1e-9 - 0.5 / rate_hz
    acceleration = 6.0 * (t > 1.0)
    w = np.where(t > 1.0, 6.0 * (t - 1.0), 0.0)
    rate = np.stack([np.zeros_like(w), np.zeros_like(w), w], axis=1)
    accel = np.stack([-0.05 * w**2, 0.05 * acceleration, np.full_like(w, 9.80665)], axis=1)
    gyro = rate + noise.normal(0.0, 2e-3, rate.shape)
    accel = accel + noise.normal(0.0, 0.01, accel.shape)
    if rail is not None:
        gyro = np.clip(gyro, -rail, rail)
    return time_ns, gyro, accel, rate


@pytest.fixture
def spin():
    return spinning()


def run_script(path, folder, *arguments, timeout=250):
    """Runs a Python script in a folder and returns its output. Fails with the output on an error."""
    import sys

    ended = subprocess.run([sys.executable, str(path), *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=timeout)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout
