# SPDX-License-Identifier: BSD-3-Clause
"""What the doors tell of themselves beside poses, rates and map."""
import numpy as np
import pytest

import tumble


def as_a_host_stamps(time_ns, most_ns):
    """Up to `most_ns` early and late, by the same numbers each time."""
    return time_ns + np.random.default_rng(1).integers(-most_ns, most_ns + 1, len(time_ns))


def test_stamps_of_a_host_are_mended_and_told(hill, slip):
    """A uniform distribution's deviation is its half width over the root of three."""
    imu, unit = hill.imus[0], slip.imus[0]
    doors = [(lambda: tumble.TumblingOdometry(**tumble.tumbling_options(hill)), imu, 2_000_000),
             (lambda: tumble.RollingOdometry(units=[(tumble.sheets.phidget1044(), np.eye(4))], radius_m=0.145), unit, 800_000)]
    for make, samples, most_ns in doors:
        own_clock, host_clock = make(), make()
        assert own_clock.estimated_jitter_s is None
        own_clock.add_imu(samples.time_ns, samples.gyro, samples.accel)
        assert own_clock.estimated_jitter_s is None
        host_clock.add_imu(as_a_host_stamps(samples.time_ns, most_ns), samples.gyro, samples.accel)
        assert host_clock.estimated_jitter_s == pytest.approx(1e-9 * most_ns / np.sqrt(3.0), rel=0.3)


def test_a_tumbling_door_tells_what_it_took(hill):
    door = tumble.TumblingOdometry(**tumble.tumbling_options(hill))
    assert door.newest_ns is None and door.rejected_samples == 0
    assert np.isinf(door.sweep_scale.sigma) and door.sweep_scale.changes == 0 and not door.sweep_scale.is_off
    assert door.calibration_covariance().shape == (10, 10) and not door.calibration_covariance().any(), "nothing is estimated yet"
    door = tumble.tumbling(hill).odometry
    assert door.newest_ns == hill.imus[0].time_ns[-1] and door.rejected_samples == 0
    after = door.calibration_covariance()
    assert np.allclose(after, after.T) and np.all(np.linalg.eigvalsh(after) > 0.0)
    assert 0.9 < door.sweep_scale.scale < 1.1


def test_a_rolling_door_tells_of_its_units(slip):
    units = slip.imus
    sheet = tumble.sheets.phidget1044()
    door = tumble.RollingOdometry(units=[(sheet, unit.T_BI) for unit in units], radius_m=slip.sphere_radius_m)
    readings = [unit.gyro.copy() for unit in units], [unit.accel.copy() for unit in units]
    from_on = len(units[0].time_ns) // 3
    for rows in readings:
        rows[1][from_on:] = rows[1][from_on]  # the second repeats itself from here on
    door.add_imu(units[0].time_ns, *readings)
    told = door.units
    assert len(told) == len(units)
    assert told[1].frozen and told[1].left_out > 0 and not told[0].frozen and not told[2].disagrees
    assert all(abs(unit.time_offset_s) < 0.01 and unit.rate_bias_rad_s.shape == (3,) and unit.absent == 0 for unit in told)
