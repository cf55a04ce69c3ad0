#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures how much velocity and angular rate change during a gap in the IMU data, from the truth of simulated
recordings.

    gap_walks.py RECORDING.h5...

The script uses the samples while the body rotates (from the first to the last sample above 2 rad/s), and gaps of 0.05
to 0.5 s. It prints these root mean squares per axis:

    change of velocity divided by the square root of the gap [m/s/sqrt(s)]
    change of velocity divided by the gap [m/s^2]
    rate in the middle minus the mean rate of both ends, divided by half the square root of the gap [rad/s/sqrt(s)]: the
    random walk of a Brownian bridge

The parameters gap_velocity_walk_m_s_sqrt_s and gap_rate_walk_rad_s_sqrt_s have these units: docs/maths/mapping.md
(R44), (R43).
"""
import sys

import h5py
import numpy as np

TURNS_RAD_S = 2.0
GAPS_S = (0.05, 0.1, 0.2, 0.3, 0.5)


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for name in sys.argv[1:]:
        with h5py.File(name) as file:
            period_s = 1e-9 * file["truth"].attrs["period_ns"]
            rate, velocity = file["truth/w_WB_B_rad_s"][:], file["truth/v_WB_m_s"][:]
        turning = np.flatnonzero(np.linalg.norm(rate, axis=1) > TURNS_RAD_S)
        for gap_s in GAPS_S:
            count = round(gap_s / period_s)
            start = np.arange(turning[0], turning[-1] - count, 20)
            change = rms(velocity[start + count] - velocity[start])
            bridge = rms(rate[start + count // 2] - 0.5 * (rate[start] + rate[start + count]))
            print(f"{name} {gap_s:4.2f} s: velocity {change / gap_s**0.5:.1f} m/s/sqrt(s), {change / gap_s:.1f} m/s^2;"
                  f" rate {2 * bridge / gap_s**0.5:.1f} rad/s/sqrt(s)")


if __name__ == "__main__":
    main()
