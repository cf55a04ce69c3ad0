# SPDX-License-Identifier: BSD-3-Clause
"""Tests of files of recordings and estimates: lossless writing and reading, and errors that name the place in the file."""
import dataclasses

import numpy as np
import pytest
from conftest import spinning

import tumble

h5py = pytest.importorskip("h5py", reason="the extra `files`")


def small():
    """Returns a recording with all members set."""
    time_ns, gyro, accel, _ = spinning()
    count = len(time_ns)
    random = np.random.default_rng(1)
    pose = np.eye(4)
    pose[:3, 3] = 0.1, 0.2, 0.3
    imu = tumble.Imu(time_ns, gyro, accel, T_BI=pose, clip_flags=(np.arange(count) % 64).astype(np.uint8), name="first", device="mti30",
                     period_ns=10_000_000, gyro_range_rad_s=7.85, magnetic_field_t=random.normal(size=(count, 3)),
                     earth_field_t=np.array([2e-5, 0.0, -4e-5]))
    lidar = tumble.Lidar(np.array([0, 10**8]), np.array([0, 3, 7], np.uint64), random.normal(size=(7, 3)).astype(np.float32),
                         np.arange(7, dtype=np.uint32), 10**8, T_BL=pose)
    rows = lambda n, *columns: random.normal(size=(n, *columns))
    imu_truth = tumble.ImuTruth("first", pose, *(rows(count, 3) for _ in range(6)), gyro_elements=rows(3, 3),
                                gyro_element_offset_rad_s=rows(3), accel_elements=rows(3, 3), accel_element_offset_m_s2=rows(3),
                                magnetic_field_t=rows(count, 3))
    lidar_truth = tumble.LidarTruth("lidar", pose, rows(7, 3).astype(np.float32), np.array([-2, -1, 0, 1, 0, 1, 0], np.int32))
    units = {"pressure_pa": "Pa", "temperature_k": "K"}
    series = tumble.Series(np.array([5, 7, 11]), {name: rows(3) for name in units}, units, {"pressure_pa": 2.0, "temperature_k": 0.0},
                           {"ground_pressure_pa": 101325.0}, pose, "barometer", "barometer", "bmp388", 20_000_000)
    series_truth = tumble.SeriesTruth("barometer", pose, {name: rows(3) for name in units}, units)
    contacts = tumble.Contacts(np.array([0, 5, 5], np.int64), rows(3, 3), rows(3, 3), rows(3, 3), rows(3), np.array([0, 1, -1], np.int32))
    quaternion = rows(9, 4)
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    truth = tumble.Truth(500_000, rows(9, 3), quaternion, rows(9, 3), rows(9, 3), (np.arange(9) % 4).astype(np.uint8), rows(3), [imu_truth],
                         [lidar_truth], rows(9, 3), contacts, ["terrain", "Fels_Ä"], [series_truth])
    return tumble.Recording([imu], [lidar], robot="rig", gravity_m_s2=9.8, scenario="hill", seed=2**64 - 1, situation_yaml="a: 1",
                            attribution="unknown author", origin_ns=1_234_567_890_123_456_789, tumble_version="0.1", engine_version="3", truth=truth, series=[series])


def same(a, b, place="recording"):
    """Compares all members of two recordings, in type and bits."""
    if dataclasses.is_dataclass(a):
        assert type(a) is type(b), place
        for each in dataclasses.fields(a):
            same(getattr(a, each.name), getattr(b, each.name), f"{place}.{each.name}")
    elif isinstance(a, list):
        assert len(a) == len(b), place
        for k, (own, other) in enumerate(zip(a, b, strict=True)):
            same(own, other, f"{place}[{k}]")
    elif isinstance(a, dict):
        assert list(a) == list(b), place
        for key, own in a.items():
            same(own, b[key], f"{place}[{key!r}]")
    elif isinstance(a, np.ndarray):
        assert a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes(), place
    else:
        assert a == b, place


def test_there_and_back(tmp_path):
    first = small()
    assert all(getattr(first.truth.imus[0], each.name) is not None for each in dataclasses.fields(tumble.ImuTruth)), "everything is in it"
    tumble.write(tmp_path / "a.h5", first)
    back = tumble.read(tmp_path / "a.h5")
    assert list(tmp_path.iterdir()) == [tmp_path / "a.h5"]
    same(back, first)
    back.truth.contacts.normal_force_n[1] += 1e-9
    with pytest.raises(AssertionError, match="normal_force_n"):
        same(back, first)


def test_what_an_estimator_may_see_alone(tmp_path):
    first = small()
    tumble.write(tmp_path / "a.h5", first, truth=False)
    with h5py.File(tmp_path / "a.h5") as file:
        assert "truth" not in file and file.attrs["has_truth"] == 0
    back = tumble.read(tmp_path / "a.h5")
    assert back.truth is None
    same(back, dataclasses.replace(first, truth=None))


def test_a_reference_that_knows_poses_alone(tmp_path):
    """Truth of a real recording: no rows for unknown quantities, NaN for times without a measurement."""
    first = small()
    known = first.truth
    known.position[3], known.quaternion[3] = np.nan, np.nan
    first.truth = tumble.Truth(known.period_ns, known.position, known.quaternion, known.velocity, known.rate,
                               imus=[tumble.ImuTruth(rate=known.imus[0].rate)], lidars=[tumble.LidarTruth()],
                               series=[tumble.SeriesTruth()])
    tumble.write(tmp_path / "a.h5", first)
    back = tumble.read(tmp_path / "a.h5")
    same(back, first)
    assert len(back.truth.label) == len(back.truth.contacts) == len(back.truth.imus[0].gyro_bias) == 0
    assert back.truth.imus[0].gyro_elements is None and np.array_equal(back.truth.imu_T_BI[0], np.eye(4))


def test_a_series(tmp_path):
    """Tests a sensor that is neither IMU nor lidar: quantities by name, no group without a quantity, errors for invalid quantities."""
    recording = small()
    barometer = recording.series[0]
    assert len(barometer) == 3 and barometer["pressure_pa"] is barometer.values["pressure_pa"]
    tumble.write(tmp_path / "none.h5", dataclasses.replace(recording, series=[], truth=dataclasses.replace(recording.truth, series=[])))
    with h5py.File(tmp_path / "none.h5") as file:
        assert "series" not in file["sensors"] and "series" not in file["truth"]
    assert tumble.read(tmp_path / "none.h5").series == []
    for wrong, about in (({"values": {"a,b": np.zeros(3)}}, "a,b"), ({"values": {"a_m": np.zeros(2)}}, r"\(2,\)"), ({"T_BX": np.zeros((4, 4))}, "T_BX"),
                         ({"noise": {"pressure_pa": -1.0}}, "noise"), ({"constants": {"a_m": np.nan}}, "a_m"),
                         ({"constants": {"a m": 1.0}}, "a m"), ({"time_ns": np.array([3, 2, 1])}, "time_ns")):
        with pytest.raises(tumble.TumbleError, match=about):
            tumble.write(tmp_path / "wrong.h5", dataclasses.replace(recording, series=[dataclasses.replace(barometer, **wrong)], truth=None))
    recording.truth.series = []
    with pytest.raises(tumble.TumbleError, match="truth.series has 0 entries; it must have 1"):
        tumble.write(tmp_path / "wrong.h5", recording)
    assert not (tmp_path / "wrong.h5").exists()


def test_sweeps_are_views():
    recording = small()
    sweeps = list(recording.sweeps)
    assert [len(sweep.position) for sweep in sweeps] == [3, 4]
    assert np.shares_memory(sweeps[1].position, recording.sweeps.position)
    assert sweeps[1].end_ns - sweeps[1].start_ns == 10**8
    assert recording.sweeps[-1].start_ns == sweeps[1].start_ns
    with pytest.raises(IndexError):
        recording.sweeps[2]
    recording.lidars[0].point_times = "not_skewed"
    assert recording.sweeps[0].end_ns == recording.sweeps[0].start_ns
    with pytest.raises(tumble.TumbleError, match="lidars"):
        tumble.Recording().sweeps


def test_frames():
    """T_IL of two rotated and translated sensors agrees with the transform of a lidar point through body axes."""
    recording = small()
    turned = np.array([[0.0, -1, 0, 0.4], [1, 0, 0, 0.5], [0, 0, 1, 0.6], [0, 0, 0, 1]])
    recording.imus[0].T_BI = turned
    point = np.array([1.0, 2.0, 3.0, 1.0])
    assert np.allclose(turned @ recording.T_IL @ point, recording.sweeps.T_BL @ point)
    assert np.allclose(recording.imus[0].lever_arm_m, [0.5, -0.4, 0.6])


def broken(change):
    def do(path):
        tumble.write(path, small())
        with h5py.File(path, "r+") as file:
            change(file)
    return do


def retype(name, dtype):
    def change(file):
        rows, attributes = file[name][()], dict(file[name].attrs)
        del file[name]
        file.create_dataset(name, data=rows.astype(dtype)).attrs.update(attributes)
    return change


def replace(name, rows):
    def change(file):
        del file[name]
        file[name] = rows
    return change


def drop(name):
    def change(file):
        del file[name]
    return change


def drop_attribute(group, name):
    def change(file):
        del file[group].attrs[name]
    return change


IMU, LIDAR = "sensors/imus/0", "sensors/lidars/0"


@pytest.mark.parametrize(("damage", "place"), [
    (lambda path: path.write_bytes(b""), "a.h5"),
    (lambda path: path.write_bytes(b"hello" * 100), "a.h5"),
    (broken(lambda file: file.attrs.__setitem__("format", "something else")), "something else"),
    (broken(lambda file: file.attrs.__delitem__("format")), "format"),
    (broken(drop("sensors")), "/sensors"),
    (broken(drop(f"{IMU}/gyro_I_rad_s")), "gyro_I_rad_s"),
    (broken(retype(f"{IMU}/gyro_I_rad_s", "f4")), "gyro_I_rad_s"),
    (broken(retype(f"{IMU}/time_ns", "f8")), "time_ns"),
    (broken(replace(f"{IMU}/gyro_I_rad_s", np.zeros((5, 3)))), "gyro_I_rad_s"),
    (broken(replace(f"{IMU}/accel_I_m_s2", np.zeros((400, 2)))), "accel_I_m_s2"),
    (broken(drop_attribute(IMU, "name")), "name"),
    (broken(drop_attribute("sensors", "gravity_m_s2")), "gravity_m_s2"),
    (broken(replace(f"{LIDAR}/sweep_first", np.array([0, 9, 7], np.uint64))), "sweep_first"),
    (broken(replace(f"{LIDAR}/sweep_first", np.array([0, 7], np.uint64))), "sweep_first"),
    (broken(replace(f"{LIDAR}/sweep_first", np.array([0, 3, 2**63], np.uint64))), "sweep_first"),
    (broken(replace(f"{LIDAR}/ring", np.zeros(3, np.uint16))), "ring"),
    (broken(lambda file: (file.__delitem__(f"{IMU}/T_BI"), file.create_group(f"{IMU}/T_BI"))), "T_BI"),
    (broken(drop("truth")), "truth"),
    (broken(drop("truth/f_B_m_s2")), "f_B_m_s2"),
    (broken(drop("truth/contacts")), "contacts"),
    (broken(drop("truth/surfaces")), "surfaces"),
    (broken(replace("truth/surfaces", np.zeros(2))), "surfaces"),
    (broken(replace("truth/label", np.zeros(5, np.uint8))), "label"),
    (broken(replace("truth/p_BG_m", np.zeros((2, 3)))), "p_BG_m"),
    (broken(replace("truth/contacts/normal_W", np.zeros((2, 3)))), "normal_W"),
    (broken(retype("truth/lidars/0/hit_W_m", "f8")), "hit_W_m"),
    (broken(replace("truth/imus/0/gyro_elements_I", np.eye(3)[:2])), "gyro_elements_I"),
    (broken(drop_attribute("truth/imus/0", "name")), "name"),
])
def test_refuses_by_place(tmp_path, damage, place):
    damage(tmp_path / "a.h5")
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.read(tmp_path / "a.h5")
    assert caught.value.trouble == "file" and place in str(caught.value) and "a.h5" in str(caught.value)


def test_truncated_at_any_place(tmp_path):
    tumble.write(tmp_path / "a.h5", small())
    whole = (tmp_path / "a.h5").read_bytes()
    refused = 0
    for cut in range(0, len(whole), max(1, len(whole) // 60)):
        (tmp_path / "b.h5").write_bytes(whole[:cut])
        with pytest.raises(tumble.TumbleError):
            tumble.read(tmp_path / "b.h5")
        refused += 1
    assert refused >= 60


def test_no_such_file(tmp_path):
    with pytest.raises(tumble.TumbleError, match="none.h5"):
        tumble.read(tmp_path / "none.h5")


@pytest.mark.parametrize(("change", "trouble"), [
    (lambda r: setattr(r.imus[0], "time_ns", r.imus[0].time_ns * 1e-9), "type"),
    (lambda r: setattr(r.imus[0], "gyro", r.imus[0].gyro[:-1]), "shape"),
    (lambda r: setattr(r.lidars[0], "offset_ns", r.lidars[0].offset_ns * 0.5), "type"),
    (lambda r: setattr(r.lidars[0], "offset_ns", -1 - r.lidars[0].offset_ns.astype(np.int64)), "out_of_range"),
    (lambda r: r.truth.imus.append(tumble.ImuTruth()), "shape"),
    (lambda r: r.truth.lidars.clear(), "shape"),
    (lambda r: setattr(r.truth, "label", r.truth.label[:-1]), "shape"),
    (lambda r: setattr(r.truth, "label", r.truth.label + np.float64(0.5)), "type"),
    (lambda r: setattr(r.truth, "label", r.truth.label + np.int64(300)), "out_of_range"),
    (lambda r: setattr(r.truth, "quaternion", r.truth.quaternion[:, :3]), "shape"),
    (lambda r: setattr(r.truth, "p_BG_m", np.zeros(2)), "shape"),
    (lambda r: setattr(r.truth.imus[0], "rate", r.truth.imus[0].rate[1:]), "shape"),
    (lambda r: setattr(r.truth.imus[0], "gyro_bias", r.truth.imus[0].gyro_bias[1:]), "shape"),
    (lambda r: setattr(r.truth.imus[0], "gyro_elements", np.eye(2)), "shape"),
    (lambda r: setattr(r.truth.lidars[0], "hit", r.truth.lidars[0].hit[1:]), "shape"),
    (lambda r: setattr(r.truth.contacts, "surface_id", r.truth.contacts.surface_id * 0.5), "type"),
])
def test_nothing_is_left_half_written(tmp_path, change, trouble):
    tumble.write(tmp_path / "a.h5", small())
    before = (tmp_path / "a.h5").read_bytes()
    recording = small()
    change(recording)
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.write(tmp_path / "a.h5", recording)
    assert caught.value.trouble == trouble
    assert (tmp_path / "a.h5").read_bytes() == before and list(tmp_path.iterdir()) == [tmp_path / "a.h5"]


def test_tum_there_and_back(tmp_path):
    random = np.random.default_rng(2)
    first = tumble.Trajectory(np.array([-1_500_000_001, 0, 1_234_567_890_123_456_789], np.int64), random.normal(size=(3, 3)),
                              random.normal(size=(3, 4)))
    tumble.write_tum(tmp_path / "a.tum", first)
    back = tumble.read_tum(tmp_path / "a.tum")
    for name in ("time_ns", "position", "quaternion"):
        assert np.array_equal(getattr(back, name), getattr(first, name)), name
    (tmp_path / "b.tum").write_text("# t x y z qx qy qz qw\n\n1e-3 1 2 3 0 0 0 1\n0.0000000015 1 2 3 0 0 0 1\n")
    assert tumble.read_tum(tmp_path / "b.tum").time_ns.tolist() == [1_000_000, 2]


@pytest.mark.parametrize("line", ["1 2 3", "a 1 2 3 0 0 0 1", "1 nan 2 3 0 0 0 1", "nan 1 2 3 0 0 0 1", "inf 1 2 3 0 0 0 1",
                                  "1 1 2 3 0 0 0 1 9", "9e99 1 2 3 0 0 0 1"])
def test_tum_refuses_by_line(tmp_path, line):
    (tmp_path / "a.tum").write_text("0 1 2 3 0 0 0 1\n" + line + "\n")
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.read_tum(tmp_path / "a.tum")
    assert caught.value.trouble == "file"


def test_tum_writes_no_nonsense(tmp_path):
    for position in (np.zeros((2, 3)), np.full((3, 3), np.nan)):
        with pytest.raises(tumble.TumbleError):
            tumble.write_tum(tmp_path / "a.tum", tumble.Trajectory(np.arange(3), position, np.zeros((3, 4))))
    assert list(tmp_path.iterdir()) == []


def test_estimates_refuse_by_place(tmp_path):
    with pytest.raises(tumble.TumbleError, match="estimate"):
        tumble.read_estimate(tmp_path)
    (tmp_path / "estimate.json").write_text("{}")
    with pytest.raises(tumble.TumbleError, match="method"):
        tumble.read_estimate(tmp_path)


def test_without_h5py_the_error_says_what_to_install(monkeypatch):
    import sys
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(ImportError):
        tumble.read("a.h5")


@pytest.mark.parametrize("result", [np.zeros((5, 3)), np.zeros((400, 2)), (np.zeros((400, 3)), np.zeros((400, 3)))])
def test_serving_refuses_what_does_not_fit(tmp_path, result):
    tumble.write(tmp_path / "a.h5", small())
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.serve("rate", lambda recording: result, [str(tmp_path / "a.h5"), str(tmp_path / "out.csv")])
    assert caught.value.trouble == "shape" and not (tmp_path / "out.csv").exists()


def test_serving_a_rate_with_its_covariance(tmp_path):
    recording = small()
    tumble.write(tmp_path / "a.h5", recording)
    rates = tumble.MotionRegimeStream(lever_arm_m=(0.1, 0, 0))
    expected = rates.add_imu(*recording.imus[0].samples)
    expected = tumble.Rates.joined([expected, rates.flush()])

    def answer(seen):
        assert seen.truth is None
        return expected

    tumble.serve("rate", answer, [str(tmp_path / "a.h5"), str(tmp_path / "out.csv")])
    rows = np.loadtxt(tmp_path / "out.csv", delimiter=",", skiprows=1)
    assert rows.shape == (400, 10)
    assert np.array_equal(rows[:, 1:4], expected.rate) and np.array_equal(rows[:, 4], expected.covariance[:, 0, 0])
    with pytest.raises(tumble.TumbleError, match="kind"):
        tumble.serve("rates", answer, ["a", "b"])
    with pytest.raises(SystemExit, match="usage"):
        tumble.serve("rate", answer, ["a"])


def test_a_recording_is_printed_by_its_shapes():
    recording = small()
    text = repr(recording)
    assert len(text) < 6000, "arrays would take tens of kilobytes"
    assert f"gyro=<float64 {len(recording.imus[0])} x 3>" in text
    assert "scenario='hill'" in text
    assert repr(recording.truth.contacts).startswith("Contacts(time_ns=<int64 3>, ")
