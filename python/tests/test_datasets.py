# SPDX-License-Identifier: BSD-3-Clause
"""Importers of public data sets: files of known motions in the formats of the data sets, and the real files if they are available."""
import h5py
import numpy as np
import pytest

import tumble
from tumble import optical

DELAY_S, MOUNTING, LEVEL = 0.012, np.array([0.02, -0.03, 0.05]), np.array([0.04, 0.01, 0.0])
HEADER = "Time (s);Vicon Orientation;;;;IMU Acceleration;;;IMU Gyroscope;;;IMU Magnetometer;;;\n;W;X;Y;Z;X;Y;Z;X;Y;Z;X;Y;Z;\n"


def rotation(v):
    angle = np.linalg.norm(v, axis=-1, keepdims=True)
    return np.concatenate([0.5 * v * np.sinc(angle / (2 * np.pi)), np.cos(0.5 * angle)], axis=-1)


def rate_at(t):
    return np.stack([5.0 * np.sin(1.7 * t), 3.0 * np.sin(2.3 * t + 0.4), 2.0 * np.sin(1.3 * t + 1.0)], axis=-1)


class Wand:
    """A wand that a hand turns about a fixed point; attitudes by integration in steps of 1 ms."""

    def __init__(self, seconds):
        self.q = np.empty((round(1e3 * (seconds + 1.0)), 4))
        self.q[0] = rotation(np.array([0.0, 0.3, 0.0]))
        steps = rotation(1e-3 * rate_at(1e-3 * (np.arange(len(self.q)) + 0.5) - 0.5))
        for k in range(1, len(self.q)):
            self.q[k] = optical._product(self.q[k - 1], steps[k - 1])

    def attitude(self, t):
        return self.q[np.round(1e3 * (t + 0.5)).astype(int)]

    def force(self, t):
        return optical._rotated(optical._inverse(self.attitude(t)), np.array([0.0, 0.0, 9.80665]))


def write_wand(path, hz=100.0, gyro_hz=100.0, accel_hz=100.0, decimals=3, flip=None):
    wand, t = Wand(40.0), np.arange(round(40.0 * hz)) / hz
    held = lambda rate_hz: np.floor(t * rate_hz + 1e-9) / rate_hz  # time of the last reading of a sensor with this rate
    q = optical._product(optical._product(rotation(LEVEL), wand.attitude(t - DELAY_S)), rotation(MOUNTING))
    if flip is not None:
        confused = (t >= flip) & (t < flip + 0.15)
        q[confused] = optical._product(q[confused], np.array([0.7071, 0.7071, 0.0, 0.0]))
    rows = np.column_stack([q[:, [3, 0, 1, 2]], wand.force(held(accel_hz)), rate_at(held(gyro_hz)), np.full((len(t), 3), 0.4)])
    path.write_text(HEADER + "".join(f"{stamp:.{decimals}f};" + ";".join(f"{x:.7f}" for x in row) + "\n" for stamp, row in zip(t, rows)))
    return wand


def test_repoimu_delay_rotation_and_tilt_are_removed(tmp_path):
    """Without the corrections, the median rate error would be 0.05 rad/s and the tilt error 0.04."""
    wand = write_wand(tmp_path / "wand.csv", flip=20.0)
    recording = tumble.read_repoimu(tmp_path / "wand.csv")
    imu, truth = recording.first_imu, recording.truth
    t = 1e-9 * imu.time_ns
    error = np.linalg.norm(truth.imus[0].rate - rate_at(t), axis=1)
    assert np.nanmedian(error) < 0.01 and np.nanmax(error) < 0.2  # an attitude confused for 0.15 s would give 20 rad/s
    assert not np.isfinite(error[(t > 20.0) & (t < 20.15)]).any() and np.isfinite(error).mean() > 0.98
    at = np.arange(2000, 18000, 500)
    up = optical._rotated(optical._inverse(truth.quaternion[at]), np.array([0.0, 0.0, 1.0]))
    assert np.abs(up - wand.force(at * 1e-3) / 9.80665).max() < 0.01
    assert "ICCVG 2016; wand.csv" in recording.attribution
    tumble.write(tmp_path / "wand.h5", recording)
    assert np.array_equal(tumble.read(tmp_path / "wand.h5").truth.imus[0].rate, truth.imus[0].rate, equal_nan=True)


def test_repoimu_repeated_readings_and_rounded_stamps_are_repaired(tmp_path):
    wand = write_wand(tmp_path / "held.csv", hz=90.0, gyro_hz=50.0, accel_hz=25.0)
    imu = tumble.read_repoimu(tmp_path / "held.csv").first_imu
    assert abs(len(imu) - 2000) <= 2 and abs(imu.period_ns - 20e6) < 2e5
    t = 1e-9 * imu.time_ns
    assert np.median(np.abs(imu.gyro - rate_at(t))) < 0.03, "the stamp of a reading is at most a row late"
    assert np.median(np.linalg.norm(imu.accel - wand.force(np.minimum(t, 39.9)), axis=1)) < 0.5


def test_other_files_are_rejected(tmp_path):
    (tmp_path / "a.csv").write_text("time;x\n;\n1;2\n")
    with pytest.raises(tumble.TumbleError, match="not a file of RepoIMU"):
        tumble.read_repoimu(tmp_path / "a.csv")
    with pytest.raises(tumble.TumbleError, match="no column timestamp_seconds"):
        tumble.read_airbrakes(tmp_path / "a.csv")
    h5py.File(tmp_path / "a.h5", "w").close()
    with pytest.raises(tumble.TumbleError, match="sampling_rate is missing"):
        tumble.read_broad(tmp_path / "a.h5")


def test_airbrakes_keeps_the_longest_part(tmp_path):
    names = ["letter", "timestamp_seconds", *(f"raw_acceleration_{a}_gs" for a in "xyz"), *(f"raw_angular_rate_{a}_deg_per_s" for a in "xyz"),
             *(f"magnetic_field_{a}_microteslas" for a in "xyz")]
    rows = [f"S,{t},0,0,1,180,0,-90,20,0,-40" for t in ("1.0", "10.5", "10.51", "10.51", "10.52")]
    (tmp_path / "flight.csv").write_text("\n".join([",".join(names), *rows]) + "\n")
    recording = tumble.read_airbrakes(tmp_path / "flight.csv")
    imu = recording.first_imu
    assert imu.time_ns.tolist() == [0, 10_000_000, 20_000_000] and recording.origin_ns == 10_500_000_000
    assert np.allclose(imu.gyro, [np.pi, 0.0, -np.pi / 2]) and np.allclose(imu.accel, [0.0, 0.0, 9.80665])
    assert np.allclose(imu.magnetic_field_t, [20e-6, 0.0, -40e-6]) and recording.truth is None and "MIT" in recording.attribution


def test_broad_reference_agrees_with_the_readings(tmp_path):
    wand, count = Wand(30.0), 8000
    t = np.arange(count) * (1.0 / 285.714)
    q = wand.attitude(t)[:, [3, 0, 1, 2]]
    q[4000:4100] = np.nan  # hidden markers
    with h5py.File(tmp_path / "01_hand.hdf5", "w") as file:
        file.attrs["sampling_rate"] = 285.714
        for name, rows in {"imu_gyr": rate_at(t), "imu_acc": wand.force(t), "imu_mag": np.full((count, 3), 30.0), "opt_quat": q,
                           "opt_pos": np.zeros((count, 3))}.items():
            file[name] = rows
    recording = tumble.read_broad(tmp_path / "01_hand.hdf5")
    imu, truth = recording.first_imu, recording.truth
    assert imu.period_ns == 3_500_004 and abs(imu.time_ns[-1] - 7999e9 / 285.714) < 1 and np.allclose(imu.magnetic_field_t, 30e-6)
    error = np.linalg.norm(truth.imus[0].rate - imu.gyro, axis=1)
    assert np.nanmedian(error) < 0.1 and np.isnan(error[4000:4100]).all() and np.isfinite(error).mean() > 0.97
    assert np.isnan(truth.rate[4000:4100]).all() and np.nanmedian(np.linalg.norm(truth.rate - imu.gyro, axis=1)) < 0.2
    assert recording.attribution.endswith("CC BY 4.0; trial 01_hand")


def test_the_published_files(real_data):
    """Runs if the files are available."""
    if real_data is None:
        return
    wand = tumble.read_repoimu(real_data / "repoimu/TStick_Test05_Trial1.csv")
    assert len(wand.first_imu) == 8813 and np.nanmedian(np.linalg.norm(wand.truth.imus[0].rate - wand.first_imu.gyro, axis=1)) < 0.2
    pendulum = tumble.read_repoimu(real_data / "repoimu/Pendulum_Test02a_Trial1_Segment_3.csv")
    assert len(pendulum.first_imu) == 8681, "of 15630 rows; 44.5 % of the gyro's rows repeat a reading"
    assert np.nanmax(np.linalg.norm(pendulum.truth.imus[0].rate, axis=1)) < 25.0, "jumps of the cameras would be faster"
    for name, count in {"jackpot_launch_3": 7646, "government_work_1_airbrakes": 6853}.items():
        assert len(tumble.read_airbrakes(real_data / f"airbrakes/{name}.csv").first_imu) == count
    trial = tumble.read_broad(real_data / "broad/05_undisturbed_slow_rotation_with_breaks_B.hdf5")
    assert len(trial.first_imu) == 59212 and np.nanmedian(np.linalg.norm(trial.truth.rate - trial.first_imu.gyro, axis=1)) < 0.06
