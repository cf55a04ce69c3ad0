# SPDX-License-Identifier: BSD-3-Clause
"""Uses the installed package without the program `tumble` and without pytest: tools/release runs this file with the new wheel."""
import numpy as np

import tumble


def test_an_odometry_is_constructed():
    odometry = tumble.TumblingOdometry(imu=tumble.sheets.mti30(), T_IL=np.eye(4), lever_arm_m=(0.0, 0.0, 0.0))
    assert not list(odometry.take_all())


if __name__ == "__main__":
    test_an_odometry_is_constructed()
    print(tumble.__version__)
