# SPDX-License-Identifier: BSD-3-Clause
"""Tests which input estimators accept and reject. Every error contains field, value and bound."""
import copy
import pickle
import threading

import numpy as np
import pytest

import tumble

LEVER = (0.05, 0.0, 0.0)
STREAMS = {
    "regime": lambda: tumble.MotionRegimeStream(lever_arm_m=LEVER),
    "rate": lambda: tumble.AngularRateStream(lever_arm_m=LEVER),
    "vqf": tumble.Vqf,
    "tumble": tumble.TumbleAttitude,
    "strapdown": tumble.Strapdown,
    "rolling": lambda: tumble.RollingSmoother(radius_m=0.145, lag_s=0.2),
}
BATCHES = {
    "smoother": lambda *s: tumble.AngularRateSmoother(lever_arm_m=LEVER).estimate(*s),
    "regimes": lambda *s: tumble.MotionRegimeSmoother(lever_arm_m=LEVER).estimate(*s),
    "saave": lambda *s: tumble.Saave(lever_arm_m=LEVER, saturation_point_rad_s=10.0).estimate(*s),
    "carried_batch": lambda *s: tumble.HandHeldSmoother().estimate(*s),
    "rails": lambda *s: tumble.find_rails(*s),
}
TAKERS = BATCHES | {name: (lambda make: lambda *s: make().add_imu(*s))(make) for name, make in STREAMS.items()}


@pytest.mark.parametrize("take", TAKERS.values(), ids=TAKERS.keys())
def test_takes_a_recording(take, spin):
    """The estimator accepts a valid recording: positive control for the rejections below."""
    take(*spin[:3])


@pytest.mark.parametrize("take", TAKERS.values(), ids=TAKERS.keys())
@pytest.mark.parametrize(("column", "field"), [(1, "angular_velocity"), (2, "specific_force")])
def test_refuses_nan(take, spin, column, field):
    samples = [rows.copy() for rows in spin[:3]]
    samples[column][7, 1] = np.nan
    with pytest.raises(tumble.TumbleError) as caught:
        take(*samples)
    assert (caught.value.trouble, caught.value.index) == ("non_finite", 7)
    assert field in caught.value.field
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize("take", TAKERS.values(), ids=TAKERS.keys())
def test_refuses_time_that_goes_back(take, spin):
    times = spin[0].copy()
    times[20] = times[19] - 5
    with pytest.raises(tumble.TumbleError) as caught:
        take(times, *spin[1:3])
    assert caught.value.trouble == "time_order"
    assert (caught.value.value, caught.value.bound, caught.value.index) == (times[20], times[19], 20)


@pytest.mark.parametrize("take", TAKERS.values(), ids=TAKERS.keys())
def test_times_since_1970_are_told_to_the_nanosecond(take, spin):
    """Error messages contain exact times that doubles cannot represent, for example 1753351234567890005."""
    times = spin[0] + 1_753_351_234_567_890_123
    times[20] = times[19] - 5
    with pytest.raises(tumble.TumbleError) as caught:
        take(times, *spin[1:3])
    said = caught.value
    assert (type(said.value), said.value, type(said.bound), said.bound) == (int, times[20], int, times[19])
    assert f"time_ns is {times[20]}; the bound is {times[19]}" in str(said)


def test_times_of_another_call_are_told_to_the_nanosecond(spin):
    """The bound is the time of an earlier sample, also after a copy."""
    times = spin[0] + 1_753_351_234_567_890_123
    for make in STREAMS.values():
        stream = make()
        stream.add_imu(times[:50], spin[1][:50], spin[2][:50])
        for other in (stream, copy.copy(stream)):
            with pytest.raises(tumble.TumbleError) as caught:
                other.add_imu(times[49:], spin[1][49:], spin[2][49:])
            assert (caught.value.value, caught.value.bound, caught.value.index) == (times[49], times[49], 0)


@pytest.mark.parametrize("take", TAKERS.values(), ids=TAKERS.keys())
@pytest.mark.parametrize("column", [0, 1, 2])
def test_refuses_what_is_masked(take, spin, column):
    samples = [np.ma.masked_array(rows) if k == column else rows for k, rows in enumerate(spin[:3])]
    take(*samples)  # no value is masked yet
    samples[column][5] = np.ma.masked
    with pytest.raises(tumble.TumbleError) as caught:
        take(*samples)
    assert (caught.value.trouble, caught.value.value) == ("type", "masked")


@pytest.mark.parametrize("rows", [[[0.0], [0.0, 1.0]], [object()] * 3, "abc"])
def test_refuses_what_is_no_array(spin, rows):
    for samples in ((spin[0], rows, spin[2]), (rows, *spin[1:3])):
        with pytest.raises(tumble.TumbleError) as caught:
            tumble.Vqf().add_imu(*samples)
        assert caught.value.trouble == "type"


@pytest.mark.parametrize("take", TAKERS.values(), ids=TAKERS.keys())
@pytest.mark.parametrize(("change", "trouble", "field"), [
    (lambda t, g, a: (t * 1e-9, g, a), "type", "time_ns"),  # seconds
    (lambda t, g, a: (t // 1000, g, a), "out_of_range", "time_ns (median step, ns)"),  # microseconds
    (lambda t, g, a: (np.arange(len(t)) + 1_700_000_000, g, a), "out_of_range", "time_ns (median step, ns)"),  # whole seconds
    (lambda t, g, a: (t.astype(float), g, a), "type", "time_ns"),
    (lambda t, g, a: (t.astype(np.uint64), g, a), "type", "time_ns"),
    (lambda t, g, a: (t, g[:-1], a), "shape", "gyro_rad_s"),
    (lambda t, g, a: (t, g, a[:, :2]), "shape", "accel_m_s2"),
    (lambda t, g, a: (t, g.T, a), "shape", "gyro_rad_s"),
    (lambda t, g, a: (t, g.ravel(), a), "shape", "gyro_rad_s"),
    (lambda t, g, a: (t, g.astype(str), a), "type", "gyro_rad_s"),
    (lambda t, g, a: (t, g + 0j, a), "type", "gyro_rad_s"),
    (lambda t, g, a: (t, g, a, np.zeros(3, np.uint8)), "shape", "clip_flags"),
    (lambda t, g, a: (t, g, a, np.full(len(t), 256)), "out_of_range", "clip_flags"),
    (lambda t, g, a: (t, g, a, np.zeros(len(t))), "type", "clip_flags"),
    (lambda t, g, a: (t[:, None], g, a), "shape", "time_ns"),
])
def test_refuses_arrays_that_do_not_fit(take, spin, change, trouble, field):
    with pytest.raises(tumble.TumbleError) as caught:
        take(*change(*spin[:3]))
    assert (caught.value.trouble, caught.value.field) == (trouble, field)
    assert caught.value.bound is not None


@pytest.mark.parametrize("take", BATCHES.values(), ids=BATCHES.keys())
def test_batches_refuse_nothing_at_all(take):
    with pytest.raises(tumble.TumbleError) as caught:
        take(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 3)))
    assert caught.value.trouble in ("empty", "insufficient_data")


def test_layouts_and_types_of_numbers_give_the_same_bits(spin):
    time_ns, gyro, accel = spin[:3]
    plain = tumble.Vqf().add_imu(time_ns, gyro, accel).quaternion
    assert np.array_equal(tumble.Vqf().add_imu(time_ns.tolist(), gyro.tolist(), accel.tolist()).quaternion, plain)
    assert np.array_equal(tumble.Vqf().add_imu(time_ns, np.asfortranarray(gyro), accel).quaternion, plain)
    wide = np.repeat(np.repeat(gyro, 2, axis=0), 2, axis=1)
    assert np.array_equal(tumble.Vqf().add_imu(time_ns, wide[::2, ::2], accel).quaternion, plain)
    single = gyro.astype(np.float32)
    assert np.array_equal(tumble.Vqf().add_imu(time_ns, single, accel).quaternion,
                          tumble.Vqf().add_imu(time_ns, single.astype(float), accel).quaternion)
    for array in (time_ns, gyro, accel):
        array.flags.writeable = False
    assert np.array_equal(tumble.Vqf().add_imu(time_ns, gyro, accel).quaternion, plain)


@pytest.mark.parametrize("make", STREAMS.values(), ids=STREAMS.keys())
def test_sample_by_sample_is_the_array(make, spin):
    """The results are the same if samples are added in pieces, or if a copy continues midway."""
    whole, single, cut = make(), make(), make()
    kind = type(whole.add_imu(*(r[:1] for r in spin[:3])))
    rows = [name for name in ("rate", "quaternion", "position") if hasattr(kind, name)]
    at_once = whole.add_imu(*(r[1:] for r in spin[:3]))
    one_by_one = [single.add_imu(int(t), g, a) for t, g, a in zip(*spin[:3], strict=True)]
    cut.add_imu(*(r[:150] for r in spin[:3]))
    copied = copy.copy(cut)
    rest = copied.add_imu(*(r[150:] for r in spin[:3]))
    deep = copy.deepcopy(cut).add_imu(*(r[150:] for r in spin[:3]))
    assert rows
    for name in rows:
        expected = getattr(at_once, name)
        assert len(expected) > 100
        joined = np.concatenate([getattr(out, name) for out in one_by_one])
        assert np.array_equal(joined[-len(expected):], expected)
        assert np.array_equal(getattr(rest, name), expected[-len(getattr(rest, name)):])
        assert np.array_equal(getattr(deep, name), getattr(rest, name))
    assert len(cut.add_imu(*(r[150:151] for r in spin[:3]))) <= 1, "the original did not go on with its copy"


def test_trouble_in_the_middle_keeps_what_came_before(spin):
    gyro = spin[1].copy()
    gyro[200, 0] = np.inf
    vqf = tumble.Vqf()
    with pytest.raises(tumble.TumbleError) as caught:
        vqf.add_imu(spin[0], gyro, spin[2])
    assert caught.value.index == 200
    assert np.array_equal(caught.value.so_far.quaternion, tumble.Vqf().add_imu(*(r[:200] for r in spin[:3])).quaternion)
    with pytest.raises(tumble.TumbleError, match="time_order"):
        vqf.add_imu(*(r[199:] for r in spin[:3]))
    assert len(vqf.add_imu(*(r[200:] for r in spin[:3]))) == len(spin[0]) - 200


@pytest.mark.parametrize("time_ns", [1.5, "1", True, np.float64(3.0), 2**63])
def test_refuses_a_time_that_is_no_count_of_nanoseconds(time_ns):
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.Vqf().add_imu(time_ns, np.zeros(3), np.ones(3))
    assert caught.value.field == "time_ns"


def test_refuses_none(spin):
    """Calls with a wrong signature raise TypeError."""
    for samples in ((None, *spin[1:3]), (spin[0], None, spin[2])):
        with pytest.raises(TypeError):
            tumble.Vqf().add_imu(*samples)


def test_results_are_views_that_stay(spin):
    rate = tumble.MotionRegimeStream(lever_arm_m=LEVER).add_imu(*spin[:3]).rate
    before = rate.copy()
    junk = [np.ones((500, 3)) for _ in range(50)]
    assert np.array_equal(rate, before) and len(junk) == 50
    assert not rate.flags.writeable
    with pytest.raises(ValueError, match="read-only"):
        rate[0, 0] = 1.0


def test_covariances_are_in_place():
    """The covariance of a state is symmetric and positive, so rows and columns are in the correct order."""
    from conftest import spinning
    rates = tumble.rate(tumble.Imu(*spinning(rail=7.0)[:3]))
    assert rates.covariance.shape == (len(rates), 3, 3)
    assert np.allclose(rates.covariance, rates.covariance.transpose(0, 2, 1), rtol=1e-9)
    assert (np.linalg.eigvalsh(rates.covariance) > 0).all()


def test_rows_are_joined(spin):
    parts = [tumble.Vqf().add_imu(*(r[:n] for r in spin[:3])) for n in (3, 5)]
    joined = tumble.Attitudes.joined(parts)
    assert np.array_equal(joined.quaternion, np.concatenate([part.quaternion for part in parts]))
    assert len(tumble.Attitudes.joined([])) == 0
    with pytest.raises((tumble.TumbleError, TypeError)):
        tumble.Attitudes.joined([None])
    with pytest.raises(TypeError):
        tumble.Attitudes.joined([tumble.Rates.joined([])])


def test_empty_results_are_empty_arrays():
    none = tumble.Rates.joined([])
    assert none.rate.shape == (0, 3) and none.covariance.shape == (0, 3, 3) and none.time_ns.dtype == np.int64
    assert tumble.MotionRegimeStream(lever_arm_m=LEVER).newest().rate.shape == (0, 3)


def test_threads_share_an_estimator(spin):
    """Concurrent calls wait for each other. Each sample is accepted once or rejected."""
    vqf, taken, refused = tumble.Vqf(), [], []

    def work(k):
        for i in range(k, len(spin[0]), 4):
            try:
                vqf.add_imu(int(spin[0][i]), spin[1][i], spin[2][i])
                taken.append(i)
            except tumble.TumbleError as error:
                assert error.trouble == "time_order"
                refused.append(i)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert taken and len(taken) + len(refused) == len(spin[0])


def test_interpreter_goes_on_in_long_calls():
    """Another Python thread runs while one thread smooths."""
    from conftest import spinning
    long = spinning(seconds=100.0, rate_hz=400.0, rail=7.0)
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1

    thread = threading.Thread(target=count)
    stream = tumble.MotionRegimeStream(lever_arm_m=LEVER, period_s=0.0025)
    thread.start()
    before = counted[0]
    stream.add_imu(*long[:3])
    within = counted[0] - before
    done.set()
    thread.join()
    assert within > 1000, "the lock of the interpreter was held"


def test_errors_and_rigs_travel(spin):
    report = tumble.AngularRateSmoother(lever_arm_m=LEVER).estimate(*spin[:3])[1]
    rig = pickle.loads(pickle.dumps(report.calibration))
    assert np.array_equal(rig.constants, report.calibration.constants)
    assert np.array_equal(rig.covariance, report.calibration.covariance)
    stream = tumble.MotionRegimeStream(lever_arm_m=LEVER, calibration=rig)
    assert np.array_equal(stream.body_imu_calibration().lever_arm_m, rig.lever_arm_m)
    with pytest.raises(tumble.TumbleError, match="positive definite"):
        tumble.BodyImuCalibration(rig.constants, -rig.covariance)
    with pytest.raises(tumble.TumbleError, match="shape|must be"):
        tumble.BodyImuCalibration(rig.constants[:5], rig.covariance)
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.MotionRegimeStream(lever_arm_m=LEVER, calibration=3)
    assert caught.value.field == "calibration"


def test_sensors_of_a_sphere(slip):
    sheet = tumble.sheets.phidget1044()
    make = lambda **more: tumble.RollingOdometry(**({"units": [(sheet, np.eye(4))], "radius_m": 0.145} | more))
    one = slip.imus[0]
    odometry = make()
    odometry.add_imu(one.time_ns[:300], one.gyro[:300], one.accel[:300])
    assert len(odometry.take()) == 300
    assert len(copy.copy(odometry).newest()) == 1
    for wrong in ({"units": []}, {"units": [(sheet, np.eye(4))] * 5}, {"units": [(3, np.eye(4))]}, {"units": [sheet]},
                  {"units": [(sheet, 2 * np.eye(4))]}, {"radius_m": -1.0}, {"rolling_radius_m": 0.1}):
        with pytest.raises(tumble.TumbleError):
            make(**wrong)
    two = make(units=[(sheet, np.eye(4))] * 2)
    with pytest.raises(tumble.TumbleError, match="list of 2"):
        two.add_imu(one.time_ns, one.gyro, one.accel)
    with pytest.raises(tumble.TumbleError):
        two.add_imu(one.time_ns, [one.gyro, one.gyro[:5]], [one.accel, one.accel])


def test_sweeps(hill):
    odometry = tumble.TumblingOdometry(**tumble.tumbling_options(hill))
    imu, sweep = hill.imus[0], hill.sweeps[2]
    points = sweep.position, sweep.offset_ns
    with pytest.raises(tumble.TumbleError) as caught:
        odometry.newest()
    assert caught.value.trouble == "empty"
    odometry.add_imu(*(rows[:40] for rows in imu.samples))
    for arguments, trouble, field in [
            ((sweep.end_ns, sweep.start_ns, *points), "time_order", "end_ns"),
            ((np.array([1, 2]), sweep.end_ns, *points), "type", "start_ns"),
            ((float(sweep.start_ns), sweep.end_ns, *points), "type", "start_ns"),
            ((sweep.start_ns, sweep.end_ns, points[0][:, :2], points[1]), "shape", "position_L_m"),
            ((sweep.start_ns, sweep.end_ns, points[0], points[1][:-1]), "shape", "offset_ns"),
            ((sweep.start_ns, sweep.end_ns, points[0], -points[1].astype(np.int64) - 1), "out_of_range", "offset_ns"),
            ((sweep.start_ns, sweep.end_ns, points[0], points[1] * 1e-9), "type", "offset_ns"),
            ((sweep.start_ns, sweep.start_ns + 5, *points), "out_of_range", "offset_ns")]:
        with pytest.raises(tumble.TumbleError) as caught:
            odometry.add_sweep(*arguments)
        assert caught.value.trouble == trouble and field in caught.value.field, arguments
    odometry.add_sweep(sweep.start_ns, sweep.end_ns, points[0].astype(float), points[1].astype(np.int64), sweep.ring)
    assert odometry.take() is None or odometry.take() is None


def test_doubt_names_what_cannot_be_believed(hill, slip):
    imu, unit = hill.imus[0], slip.imus[0]
    from_on = 3 * len(imu.time_ns) // 10  # the reading is below the saturation limit there
    frozen = imu.gyro.copy()
    frozen[from_on:, 0] = frozen[from_on, 0]
    for make in (lambda: tumble.TumblingOdometry(**tumble.tumbling_options(hill)), STREAMS["rate"], STREAMS["regime"]):
        sound, harmed = make(), make()
        sound.add_imu(imu.time_ns, imu.gyro, imu.accel)
        assert sound.health() == []
        harmed.add_imu(imu.time_ns, frozen, imu.accel)
        finding = harmed.health()[0]
        assert (finding.kind, finding.sensor, finding.axis) == ("frozen_axis", "imu", "gyro_x")
        assert finding.value > finding.bound and finding.since_ns == imu.time_ns[from_on] and "gyro x" in finding.text
    sphere = tumble.RollingOdometry(units=[(tumble.sheets.phidget1044(), np.eye(4))], radius_m=0.145)
    sphere.add_imu(unit.time_ns, unit.gyro, unit.accel)
    assert sphere.health() == []


def test_mapper_alone(hill):
    """Compares LidarInertialOdometry with rates of a stream and with the gyro alone."""
    imu, until = hill.imus[0], 8
    rates = tumble.rate(imu)
    mapper, believing = (tumble.LidarInertialOdometry(T_IL=hill.T_IL) for _ in range(2))
    covered = int(np.searchsorted(imu.time_ns, hill.sweeps[until].end_ns)) + 1
    head = [rows[:covered] for rows in imu.samples[:3]]
    with pytest.raises(tumble.TumbleError) as caught:
        mapper.add_imu(*head, rates)
    assert (caught.value.trouble, caught.value.field) == ("shape", "rates")
    given = tumble.MotionRegimeStream(lever_arm_m=imu.lever_arm_m)
    given = tumble.Rates.joined([given.add_imu(*head), given.flush()])
    mapper.add_imu(*head, given)
    believing.add_imu(*head)
    for odometry in (mapper, believing):
        for k in range(1, until):
            sweep = hill.sweeps[k]
            report = odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.position, sweep.offset_ns, sweep.ring)
        assert report.verdict in (tumble.SweepVerdict.registered, tumble.SweepVerdict.degenerate)
        assert np.linalg.norm(report.pose.position) < 0.02, "it still rests"
        assert len(odometry.map()) > 1000
    assert mapper.pose_at(hill.sweeps[until - 1].end_ns).matrix.shape == (4, 4)
    assert mapper.lidar_calibration().T_IL.shape == (4, 4)
    with pytest.raises(tumble.TumbleError, match="time_order"):
        mapper.add_sweep(0, 1, np.zeros((1, 3), np.float32), [0])
