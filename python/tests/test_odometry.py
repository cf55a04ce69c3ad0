# SPDX-License-Identifier: BSD-3-Clause
"""Tests diagnostics of the odometry classes, in addition to poses, rates and map."""
import numpy as np
import pytest

import tumble


def as_a_host_stamps(time_ns, most_ns):
    """Adds reproducible jitter of up to `most_ns` in both directions."""
    return time_ns + np.random.default_rng(1).integers(-most_ns, most_ns + 1, len(time_ns))


def test_jitter_of_host_stamps_is_estimated(hill, slip):
    """The standard deviation of a uniform distribution is its half width divided by the square root of three."""
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


def test_diagnostics_of_tumbling_odometry(hill):
    odometry = tumble.TumblingOdometry(**tumble.tumbling_options(hill))
    assert odometry.newest_ns is None and odometry.rejected_samples == 0
    assert np.isinf(odometry.sweep_scale.sigma) and odometry.sweep_scale.changes == 0 and not odometry.sweep_scale.is_inconsistent
    assert odometry.calibration_covariance().shape == (10, 10) and not odometry.calibration_covariance().any(), "nothing is estimated yet"
    odometry = tumble.tumbling(hill).odometry
    assert odometry.newest_ns == hill.imus[0].time_ns[-1] and odometry.rejected_samples == 0
    after = odometry.calibration_covariance()
    assert np.allclose(after, after.T) and np.all(np.linalg.eigvalsh(after) > 0.0)
    assert 0.9 < odometry.sweep_scale.scale < 1.1


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
