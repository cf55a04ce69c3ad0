# SPDX-License-Identifier: BSD-3-Clause
"""Tests of figures (axes named with units, contents in the right place), and of return positions against a closed form."""
import io
import sys

import numpy as np
import pytest
from conftest import spinning

import tumble

pytest.importorskip("matplotlib", reason="the extra `plots`")


def drawn(figure):
    """Returns the pixels of a figure, (H, W, 3), after a check that every axis has a name with a unit."""
    from matplotlib.image import imread

    for axes in figure.axes:
        assert "[" in axes.get_ylabel() and axes.get_ylabel().endswith("]"), axes.get_ylabel()
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=80)
    picture.seek(0)
    return imread(picture)[:, :, :3]


def coloured(pixels):
    """Returns the share of coloured pixels: neither white, black nor grey."""
    return np.mean(np.ptp(pixels, axis=2) > 0.1)


def turned(angle):
    """Returns a quaternion about z."""
    return np.stack([0 * angle, 0 * angle, np.sin(angle / 2), np.cos(angle / 2)], axis=1)


def carousel(rate_rad_s=3.0):
    """Returns two seconds of a body that rotates about z and rises, with its poses. The returns of its lidar come from ten fixed marks."""
    truth_ns = np.arange(0, 2_000_000_001, 1_000_000, dtype=np.int64)
    t = truth_ns * 1e-9
    position, quaternion = np.stack([0 * t, 0 * t, 0.5 * t], axis=1), turned(rate_rad_s * t)
    marks = np.random.default_rng(1).uniform(-5, 5, (10, 3))
    at = np.arange(1_000, 1_900_000_000, 19_000_000, dtype=np.int64)  # a return every 19 ms
    angle, height = rate_rad_s * at * 1e-9, 0.5e-9 * at
    seen = marks[np.arange(len(at)) % 10] - np.stack([0 * height, 0 * height, height], axis=1)
    c, s = np.cos(angle), np.sin(angle)
    returns = np.stack([c * seen[:, 0] + s * seen[:, 1], -s * seen[:, 0] + c * seen[:, 1], seen[:, 2]], axis=1)
    starts = np.arange(0, 1_900_000_000, 100_000_000, dtype=np.int64)
    first = np.append(np.searchsorted(at, starts), len(at)).astype(np.uint64)
    offset = (at - starts[np.searchsorted(starts, at, side="right") - 1]).astype(np.uint32)
    lidar = tumble.Lidar(starts, first, returns.astype(np.float32), offset, 100_000_000)
    truth = tumble.Truth(1_000_000, position, quaternion, 0 * position, 0 * position, imus=[tumble.ImuTruth()])
    imu = tumble.Imu(truth_ns[::10], np.zeros((201, 3)), np.zeros((201, 3)))
    recording = tumble.Recording(imus=[imu], lidars=[lidar], truth=truth)
    return recording, marks, tumble.Trajectory(truth_ns[::10], position[::10], quaternion[::10])


def test_true_poses_place_returns_where_they_were():
    recording, marks, poses = carousel()
    points, error_m = tumble.point_errors(recording, poses)
    assert len(points) == len(recording.lidars[0].position) and error_m.max() < 1e-5
    assert np.linalg.norm(points - marks[np.arange(len(points)) % 10], axis=1).max() < 1e-5


def test_worlds_are_laid_over_each_other_at_the_start():
    """The error is independent of origin and yaw. A trajectory scaled by 1.1 has the error of this scale."""
    recording, _, poses = carousel()
    yaw = turned(np.array([0.7]))[0]
    x, y, z, w = poses.quaternion.T
    turned_poses = np.stack([yaw[3] * x + yaw[2] * -y, yaw[3] * y + yaw[2] * x, yaw[3] * z + yaw[2] * w, yaw[3] * w - yaw[2] * z], axis=1)
    c, s = np.cos(0.7), np.sin(0.7)
    moved = poses.position @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T + [4.0, -3.0, 2.0]
    assert tumble.point_errors(recording, tumble.Trajectory(poses.time_ns, moved, turned_poses))[1].max() < 1e-5
    long = tumble.Trajectory(poses.time_ns, 1.1 * poses.position, poses.quaternion)
    error_m = tumble.point_errors(recording, long)[1]
    at = recording.lidars[0].sweep_start_ns.repeat(np.diff(recording.lidars[0].sweep_first.astype(int))) + recording.lidars[0].offset_ns
    assert np.allclose(error_m, 0.05e-9 * at, atol=1e-5) and error_m.max() > 0.05


def test_poses_may_begin_before_the_truth():
    recording, _, poses = carousel()
    time_ns = np.insert(poses.time_ns, 0, -50_000_000)
    position, quaternion = (np.insert(all, 0, all[0], axis=0) for all in (poses.position, poses.quaternion))
    error_m = tumble.point_errors(recording, tumble.Trajectory(time_ns, position, quaternion))[1]
    assert len(error_m) == len(recording.lidars[0].position) and error_m.max() < 1e-5


def test_returns_need_a_truth_and_poses():
    recording, _, poses = carousel()
    late = tumble.Trajectory(poses.time_ns + 10**10, poses.position, poses.quaternion)
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.point_errors(recording, late)
    assert (caught.value.trouble, caught.value.field) == ("empty", "poses")
    with pytest.raises(tumble.TumbleError, match="at least 2"):
        tumble.point_errors(recording, tumble.Trajectory(poses.time_ns[:1], poses.position[:1], poses.quaternion[:1]))
    recording.truth = None
    with pytest.raises(tumble.TumbleError, match="truth"):
        tumble.point_errors(recording, poses)


def test_rate():
    time_ns, gyro, accel, true = spinning(rail=8.0)
    imu = tumble.Imu(time_ns, gyro, accel)
    rates = tumble.rate(imu, lever_arm_sigma_m=0.1)
    figure = tumble.plot.rate(imu, rates, true, axes="xz")
    assert [axes.get_ylabel() for axes in figure.axes] == ["rate x [rad/s]", "rate z [rad/s]"] and figure.axes[1].get_xlabel() == "time [s]"
    assert coloured(drawn(figure)) > 0.005
    lines = {line.get_label(): line.get_ydata() for line in figure.axes[1].lines}
    assert set(lines) == {"gyro", "estimate", "truth"} and lines["gyro"].max() <= 8.0 < lines["truth"].max()
    with pytest.raises(tumble.TumbleError, match="axes is 'w'"):
        tumble.plot.rate(imu, rates, axes="w")


def test_trajectory():
    recording, _, poses = carousel()
    figure = tumble.plot.trajectory(poses, recording.truth)
    assert [axes.get_xlabel() for axes in figure.axes] == ["x [m]", "x [m]"] and coloured(drawn(figure)) > 0.0005


def test_map_by_error():
    recording, _, poses = carousel()
    figure = tumble.plot.map_by_error(recording, poses, every=1, worst_m=0.5)
    assert figure.axes[-1].get_ylabel() == "distance from the truth [m]" and coloured(drawn(figure)) > 0.01
    dots = figure.axes[0].collections[0]
    assert len(dots.get_offsets()) == 100 and np.max(dots.get_array()) < 1e-5
    with pytest.raises(tumble.TumbleError, match="truth"):
        recording.truth = None
        tumble.plot.map_by_error(recording, poses)


def frame():
    pandas = pytest.importorskip("pandas", reason="the extra `tables`")
    rows = [("bare", seed, "rate", method, status, "error_m", value) for method, draws in (
        ("good", [("ok", 0.01), ("ok", 0.02), ("ok", 0.03)]), ("bad", [("ok", 2.0), ("diverged", 1.0), ("ok", 3.0)])) for seed, (
        status, value) in enumerate(draws)]
    rows.append(("bare", 0, "rate", "gone", "crashed", None, None))
    return pandas.DataFrame(rows, columns=["scenario", "seed", "kind", "method", "status", "metric", "value"])


def test_scores():
    figure = tumble.plot.scores(frame(), "error_m")
    axes = figure.axes[0]
    assert axes.get_ylabel() == "error [m]" and axes.get_yscale() == "log" and coloured(drawn(figure)) > 0.001
    assert [text.get_text() for text in axes.get_xticklabels()] == ["bad", "gone", "good"]
    ok, lost = ([len(line.get_ydata()) for line in axes.lines if line.get_marker() == marker] for marker in "ox")
    assert ok == [2, 0, 3] and lost == [1, 1, 0]
    medians = [bar.get_segments()[0][0][1] for bar in axes.collections]
    assert medians == [3.0, 6.0, 0.02]  # values 2, 3 and one failure: 3; if all fail, above all values
    with pytest.raises(tumble.TumbleError, match="one of error_m"):
        tumble.plot.scores(frame(), "nobody_m")


def test_without_matplotlib(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ImportError, match=r"tumble\[plots\]|matplotlib"):
        tumble.plot.trajectory(carousel()[2])
