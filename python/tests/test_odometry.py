# SPDX-License-Identifier: BSD-3-Clause
"""Tests diagnostics of the odometry classes, in addition to poses, rates and map."""
import itertools

import numpy as np
import pytest

import tumble


def as_a_host_stamps(time_ns, most_ns):
    """Adds reproducible jitter of up to `most_ns` in both directions."""
    return time_ns + np.random.default_rng(1).integers(-most_ns, most_ns + 1, len(time_ns))


def test_jitter_of_host_stamps_is_estimated(hill, slip):
    """The expected jitter is the standard deviation of a uniform distribution: half of the width, divided by the square root of three."""
    imu, unit = hill.imus[0], slip.imus[0]
    cases = [(lambda: tumble.TumblingOdometry(**tumble.tumbling_options(hill)), imu, 2_000_000),
             (lambda: tumble.RollingOdometry(units=[(tumble.sheets.phidget1044(), np.eye(4))], radius_m=0.145), unit, 800_000)]
    for make, samples, most_ns in cases:
        own_clock, host_clock = make(), make()
        assert own_clock.estimated_jitter_s is None
        own_clock.add_imu(samples.time_ns, samples.gyro, samples.accel)
        assert own_clock.estimated_jitter_s is None
        host_clock.add_imu(as_a_host_stamps(samples.time_ns, most_ns), samples.gyro, samples.accel)
        assert host_clock.estimated_jitter_s == pytest.approx(1e-9 * most_ns / np.sqrt(3.0), rel=0.3)


def check_base_poses(poses):
    """Compares the poses of a base with a lever arm of 0.3 m with the closed form."""
    T_IB = np.eye(4)
    T_IB[:3, 3] = [0.3, 0.0, 0.0]
    base, rate = poses.transformed_to(T_IB), np.tile([0.0, 0.0, 2.0], (len(poses), 1))
    x, y, z, w = poses.quaternion.T
    ahead = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)], axis=-1)  # x axis of the IMU in W
    left = np.stack([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)], axis=-1)
    assert np.allclose(base.position, poses.position + 0.3 * ahead, atol=1e-12) and np.array_equal(base.time_ns, poses.time_ns)
    assert np.isnan(base.velocity).all()
    assert np.allclose(poses.transformed_to(T_IB, rate).velocity, poses.velocity + 0.6 * left, atol=1e-12)
    J = np.eye(6)
    J[:3, 3:] = np.cross(np.eye(3), 0.3 * ahead[-1]).T  # the column k is e_k x arm
    assert np.allclose(base.covariance[-1], J @ poses.covariance[-1] @ J.T, atol=1e-15) and poses.covariance[-1].any()
    with pytest.raises(tumble.TumbleError, match="rate"):
        poses.transformed_to(T_IB, [1.0, 2.0, 3.0])


def test_diagnostics_of_tumbling_odometry(hill):
    odometry = tumble.TumblingOdometry(**tumble.tumbling_options(hill))
    assert odometry.newest_imu_time_ns is None and odometry.samples_rejected_by_mapper == 0
    assert np.isinf(odometry.lidar_scale.sigma) and odometry.lidar_scale.changes == 0 and not odometry.lidar_scale.is_inconsistent
    assert odometry.lidar_calibration_covariance().shape == (10, 10) and not odometry.lidar_calibration_covariance().any(), "nothing is estimated yet"
    run = tumble.tumbling(hill)
    check_base_poses(run.poses)
    odometry = run.odometry
    assert odometry.newest_imu_time_ns == hill.imus[0].time_ns[-1] and odometry.samples_rejected_by_mapper == 0
    after = odometry.lidar_calibration_covariance()
    assert np.allclose(after, after.T) and np.all(np.linalg.eigvalsh(after) > 0.0)
    assert 0.9 < odometry.lidar_scale.scale < 1.1


def test_diagnostics_of_the_units_of_rolling_odometry(slip):
    units = slip.imus
    sheet = tumble.sheets.phidget1044()
    odometry = tumble.RollingOdometry(units=[(sheet, unit.T_BI) for unit in units], radius_m=slip.sphere_radius_m)
    readings = [unit.gyro.copy() for unit in units], [unit.accel.copy() for unit in units]
    from_on = len(units[0].time_ns) // 3
    for rows in readings:
        rows[1][from_on:] = rows[1][from_on]  # the readings of the second unit are constant from here on
    odometry.add_imu(units[0].time_ns, *readings)
    states = odometry.units
    assert len(states) == len(units)
    assert states[1].frozen and states[1].left_out > 0 and not states[0].frozen and not states[2].disagrees
    assert all(abs(unit.time_offset_s) < 0.01 and unit.rate_bias_rad_s.shape == (3,) and unit.absent == 0 for unit in states)


def test_positions_and_a_second_lidar(hill):
    options, imu = tumble.tumbling_options(hill), hill.imus[0]
    shift, arm = np.array([100.0, -50.0, 7.0]), np.linalg.inv(imu.T_BI)[:3, 3]  # the antenna is in the centre of mass

    def true_position(time_ns):
        return hill.truth.position[time_ns // hill.truth.period_ns]

    sheet = tumble.LidarDataSheet()
    first, second, plain = (tumble.TumblingOdometry(**options, further_lidars=[(sheet, hill.T_IL)]),
                            tumble.TumblingOdometry(**options, further_lidars=[(sheet, hill.T_IL, [[-200, -200, -200], [200, 200, 200]])]),
                            tumble.TumblingOdometry(**options))
    for odometry in (first, second, plain):
        given = 0
        for sweep in itertools.islice(hill.sweeps, 40):
            reached = int(np.searchsorted(imu.time_ns, sweep.end_ns)) + 1
            odometry.add_imu(imu.time_ns[given:reached], imu.gyro[given:reached], imu.accel[given:reached])
            given = reached
            lower = sweep.ring < 8
            parts = [(0, slice(None))] if odometry is plain else [(1, ~lower), (0, lower)]
            for lidar, rows in parts:
                odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.position[rows], sweep.offset_ns[rows], sweep.ring[rows], lidar=lidar)
            if odometry is plain:
                odometry.add_frame_alignment_position(sweep.end_ns, true_position(sweep.end_ns) + shift, 0.01 * np.eye(3), lever_arm=arm)
        odometry.finish()
    done = {id(odometry): odometry.take_all() for odometry in (first, second, plain)}
    end = [done[id(odometry)][-1] for odometry in (first, second, plain)]
    assert end[0].result.usable_points > 1.3 * end[1].result.usable_points, "the box drops all returns of the second lidar"
    assert np.linalg.norm(end[0].result.pose.position - end[2].result.pose.position) < 0.3
    assert end[0].pose_in_position_frame is None
    located = [sweep.pose_in_position_frame for sweep in done[id(plain)] if sweep.pose_in_position_frame is not None]
    antenna = located[-1].matrix[:3, :3] @ arm + located[-1].position
    assert np.linalg.norm(antenna - true_position(located[-1].time_ns) - shift) < 0.5
    with pytest.raises(tumble.TumbleError) as caught:
        first.add_sweep(0, 1, np.zeros((1, 3)), [0], lidar=2)
    assert caught.value.field == "lidar"
    with pytest.raises(tumble.TumbleError) as caught:
        first.add_frame_alignment_position(imu.time_ns[-1], np.zeros(3), np.zeros((3, 3)))
    assert caught.value.trouble == "out_of_range"


def test_a_gap_does_not_end_a_call(hill, slip):
    """The C++ classes reject the first sample after a gap and then continue. A call with many samples continues, too."""
    imu, unit = hill.imus[0], slip.imus[0]
    kept = (imu.time_ns < 1_000_000_000) | (imu.time_ns > 3_000_000_000)
    odometry = tumble.TumblingOdometry(**tumble.tumbling_options(hill))
    odometry.add_imu(imu.time_ns[kept], imu.gyro[kept], imu.accel[kept])
    assert odometry.gaps == 1 and odometry.newest_imu_time_ns == imu.time_ns[-1]
    with pytest.raises(tumble.TumbleError, match="time_order"):
        odometry.add_imu(imu.time_ns[:2], imu.gyro[:2], imu.accel[:2])
    kept = (unit.time_ns < 1_000_000_000) | (unit.time_ns > 3_000_000_000)
    rolling = tumble.RollingOdometry(units=[(tumble.sheets.phidget1044(), np.eye(4))], radius_m=0.145)
    rolling.add_imu(unit.time_ns[kept], unit.gyro[kept], unit.accel[kept])
    assert rolling.newest().time_ns[-1] == unit.time_ns[-1]
