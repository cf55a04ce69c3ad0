# SPDX-License-Identifier: BSD-3-Clause
"""Data sheets of the devices that the simulation models. models/sensors/NAME.yaml has the source of each number."""
from ._tumble import mid40, mid100, mpu6050, mti30, phidget1044, rs16, vn100

__all__ = ["mid40", "mid100", "mpu6050", "mti30", "phidget1044", "rs16", "vn100"]
