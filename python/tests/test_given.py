# SPDX-License-Identifier: BSD-3-Clause
"""Invalid arguments other than samples raise TumbleError with field, value and bound."""
import copy
import subprocess
import types

import numpy as np
import pytest
from test_files import small

import tumble

COMPLEX = np.zeros((400, 3)) + 1j
MASKED = np.ma.masked_greater(np.arange(1200.0).reshape(400, 3), 5)
POSES = tumble.Trajectory(np.arange(3), np.zeros((3, 3)), np.tile([0, 0, 0, 1.0], (3, 1)))
RATES = types.SimpleNamespace(rate=np.zeros((5, 3)), covariance=np.zeros((5, 3, 3)), clipped_axes=np.zeros(5, np.uint8))


@pytest.fixture(autouse=True)
def no_program(monkeypatch):
    """Fails if the program is called: all arguments below are rejected first."""
    monkeypatch.setenv("TUMBLE_PROGRAM", "/bin/false")


@pytest.mark.parametrize(("call", "field"), [
    (lambda: tumble.rate(None), "imu"),
    (lambda: tumble.rate(small()), "imu"),
    (lambda: tumble.sheet_of(None), "imu"),
    (lambda: tumble.tumbling(None), "recording"),
    (lambda: tumble.tumbling(tumble.Recording()), "imus"),
    (lambda: tumble.tumbling_options(small().imus[0]), "recording"),
    (lambda: tumble.rolling(None), "recording"),
    (lambda: tumble.rolling(tumble.Recording()), "imus"),
    (lambda: tumble.Recording(lidars=small().lidars).T_IL, "imus"),
    (lambda: tumble.read(None), "path"),
    (lambda: tumble.write("a.h5", None), "recording"),
    (lambda: tumble.write(None, small()), "path"),
    (lambda: tumble.read_tum(3.5), "path"),
    (lambda: tumble.read_estimate(None), "folder"),
    (lambda: tumble.write_tum("a.tum", np.eye(4)), "poses"),
    (lambda: tumble.write_tum("a.tum", tumble.Trajectory(np.arange(3) * 1e-9, POSES.position, POSES.quaternion)), "time_ns"),
    (lambda: tumble.write_tum("a.tum", tumble.Trajectory(np.arange(3), POSES.position + 1j, POSES.quaternion)), "position"),
    (lambda: tumble.plot.rate(None, None), "imu"),
    (lambda: tumble.plot.rate(small().imus[0], None), "rates"),
    (lambda: tumble.plot.rate(small().imus[0], RATES), "rates"),
    (lambda: tumble.plot.trajectory(np.zeros((5, 3))), "poses"),
    (lambda: tumble.plot.trajectory(POSES, np.zeros((5, 3))), "truth"),
    (lambda: tumble.plot.scores(None, "ate_m"), "frame"),
    (lambda: tumble.plot.map_by_error(None, POSES), "recording"),
    (lambda: tumble.point_errors(small(), POSES, 0), "every"),
    (lambda: tumble.point_errors(small(), POSES, -3), "every"),
    (lambda: tumble.point_errors(small(), POSES, 1.5), "every"),
    (lambda: tumble.point_errors(small(), None), "poses"),
    (lambda: tumble.record("hill", "a.h5", seed=1.9), "seed"),
    (lambda: tumble.record("hill", "a.h5", seed="a"), "seed"),
    (lambda: tumble.record("hill", "a.h5", seed=True), "seed"),
    (lambda: tumble.record("hill", "a.h5", seed=-1), "seed"),
    (lambda: tumble.record("hill", "a.h5", seed=2**64), "seed"),
    (lambda: tumble.record("--help", "a.h5"), "scenario"),
    (lambda: tumble.record("", "a.h5"), "scenario"),
    (lambda: tumble.record(None, "a.h5"), "scenario"),
    (lambda: tumble.record("hill", None), "path"),
    (lambda: tumble.run("-h"), "scenario"),
    (lambda: tumble.run("hill", seed=None), "seed"),
    (lambda: tumble.run("hill", methods=3), "methods"),
    (lambda: tumble.run("hill", methods=[3]), "methods"),
    (lambda: tumble.estimate("a.h5", "raw", "out", settings=[1]), "settings"),
    (lambda: tumble.estimate("a.h5", "raw", "out", settings={"a": "b"}), "settings"),
    (lambda: tumble.estimate("--version", "raw", "out"), "recording"),
    (lambda: tumble.score(None, "a.h5"), "estimate"),
    (lambda: tumble.sweep("hill", "a.db", seeds=3), "seeds"),
    (lambda: tumble.sweep("hill", "a.db", seeds=(1, 2.5)), "seeds"),
    (lambda: tumble.sweep("hill", "a.db", seeds="12"), "seeds"),
    (lambda: tumble.sweep("hill", "a.db", jobs=0), "jobs"),
    (lambda: tumble.sweep("hill", None), "db"),
    (lambda: tumble.score_rows(None), "db"),
    (lambda: tumble.call("list", [1]), "word"),
    (lambda: tumble.describe_method("m.yaml", "My M", "rate", __file__), "name"),
    (lambda: tumble.describe_method("m.yaml", "a" * 101, "rate", __file__), "name"),
    (lambda: tumble.describe_method("m.yaml", "m", "rate", "no_such.py"), "script"),
    (lambda: tumble.describe_method("m.yaml", "m", "rate", __file__, time_limit_s=-1), "time_limit_s"),
    (lambda: tumble.describe_method("m.yaml", "m", "rate", __file__, time_limit_s=0), "time_limit_s"),
    (lambda: tumble.describe_method("m.yaml", "m", "rate", __file__, time_limit_s=float("nan")), "time_limit_s"),
    (lambda: tumble.describe_method("m.yaml", "m", "rate", __file__, time_limit_s="600"), "time_limit_s"),
    (lambda: tumble.describe_method("m.yaml", "m", "rate", __file__, robots=["rigg"]), "robots"),
])
def test_what_is_wrong_is_named(tmp_path, monkeypatch, call, field):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(tumble.TumbleError) as caught:
        call()
    assert caught.value.field == field and caught.value.bound is not None
    assert str(caught.value.value) in str(caught.value) or caught.value.trouble == "empty"
    assert list(tmp_path.iterdir()) == []


def test_a_name_alone_is_one_method(monkeypatch, tmp_path):
    said = []
    monkeypatch.setattr(subprocess, "run",
                        lambda command, **_: said.append(command) or types.SimpleNamespace(returncode=0, stdout="{}", stderr=""))
    for methods in ("rate/raw", ["rate/raw"], tmp_path / "mine.yaml", iter(("a", "b"))):
        tumble.run("hill", seed=np.uint64(2**64 - 1), methods=methods, settings={"x": np.float32(0.5), "n": np.int64(3)})
    for command, names in zip(said, (["rate/raw"], ["rate/raw"], [str(tmp_path / "mine.yaml")], ["a", "b"]), strict=True):
        assert [word for before, word in zip(command, command[1:], strict=False) if before == "--method"] == names
        assert str(2**64 - 1) in command and "x=0.5" in command and "n=3" in command


def test_a_description_of_one_robot(tmp_path):
    written = tumble.describe_method(tmp_path / "m.yaml", "m_2", "rate", __file__, robots="rig", time_limit_s=np.float64(3))
    assert "robots: [rig]\n" in written.read_text() and "time_limit_s: 3.0\n" in written.read_text()


def change_imu(name, value):
    return lambda r: setattr(r.imus[0], name, value(getattr(r.imus[0], name)))


def swapped(times):
    out = times.copy()
    out[[20, 21]] = out[[21, 20]]
    return out


@pytest.mark.parametrize(("change", "trouble", "field"), [
    (change_imu("gyro", lambda _: COMPLEX), "type", "gyro"),
    (change_imu("gyro", lambda _: MASKED), "type", "gyro"),
    (change_imu("accel", lambda a: a.astype(str)), "type", "accel"),
    (change_imu("clip_flags", lambda f: np.ma.masked_less(f, 3)), "type", "clip_flags"),
    (change_imu("gyro_range_rad_s", lambda _: -1.0), "out_of_range", "gyro_range_rad_s"),
    (change_imu("accel_range_m_s2", lambda _: float("nan")), "out_of_range", "accel_range_m_s2"),
    (change_imu("gyro_noise_rad_s_sqrt_hz", lambda _: np.inf), "out_of_range", "gyro_noise_rad_s_sqrt_hz"),
    (change_imu("accel_noise_m_s2_sqrt_hz", lambda _: "0.1"), "type", "accel_noise_m_s2_sqrt_hz"),
    (change_imu("time_ns", swapped), "time_order", "time_ns"),
    (change_imu("time_ns", lambda t: t + 2 * 10**17), "out_of_range", "time_ns"),
    (change_imu("T_BI", lambda T: 2 * T), "out_of_range", "T_BI"),
    (change_imu("T_BI", lambda T: T[:3]), "shape", "T_BI"),
    (change_imu("period_ns", lambda _: -5), "out_of_range", "period_ns"),
    (change_imu("earth_field_t", lambda _: np.full(3, np.nan)), "non_finite", "earth_field_t"),
    (lambda r: setattr(r.lidars[0], "T_BL", np.zeros((4, 4))), "out_of_range", "T_BL"),
    (lambda r: setattr(r.lidars[0], "sweep_start_ns", np.array([5, 5])), "time_order", "sweep_start_ns"),
    (lambda r: setattr(r.lidars[0], "sweep_period_ns", 0), "out_of_range", "sweep_period_ns"),
    (lambda r: setattr(r, "gravity_m_s2", -9.8), "out_of_range", "gravity_m_s2"),
    (lambda r: setattr(r, "seed", -1), "out_of_range", "seed"),
    (lambda r: setattr(r.truth, "position", r.truth.position + 1j), "type", "p_WB_m"),
])
def test_no_recording_is_written_that_nobody_reads(tmp_path, change, trouble, field):
    pytest.importorskip("h5py", reason="the extra `files`")
    recording = copy.deepcopy(small())
    change(recording)
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.write(tmp_path / "a.h5", recording)
    assert caught.value.trouble == trouble and field in caught.value.field and caught.value.bound is not None
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("result", "field"), [
    (COMPLEX, "rate"), (MASKED, "rate"), ((COMPLEX.real, COMPLEX[:, :, None] * np.ones(3)), "covariance"),
    ((COMPLEX.real, np.tile(np.eye(3) + np.eye(3, k=1), (400, 1, 1))), "covariance"), ((COMPLEX.real,) * 3, "result")])
def test_serving_refuses_what_would_lose_a_part_of_itself(tmp_path, result, field):
    pytest.importorskip("h5py", reason="the extra `files`")
    tumble.write(tmp_path / "a.h5", small())
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.serve("rate", lambda recording: result, [str(tmp_path / "a.h5"), str(tmp_path / "out.csv")])
    assert caught.value.field == field and not (tmp_path / "out.csv").exists()
    tumble.serve("rate", lambda recording: (COMPLEX.real, None), [str(tmp_path / "a.h5"), str(tmp_path / "out.csv")])
    assert (tmp_path / "out.csv").exists()
