#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far a body's velocity and rate go while its IMU is silent, by the truth of recordings of simulations.

    gap_walks.py RECORDING.h5...

While the body turns (from the first sample beyond 2 rad/s to the last) and for gaps of 0.05 to 0.5 s: root mean square, per
axis, of the change of velocity over the root of the gap [m/s/sqrt(s)], and over the gap [m/s^2]; of the rate in the middle
less the mean of both ends, over half of the root of the gap, which is the walk of a Brownian bridge [rad/s/sqrt(s)]. These
are what gap_velocity_walk_m_s_sqrt_s and gap_rate_walk_rad_s_sqrt_s stand for: docs/maths/mapping.md (R44), (R43).
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
