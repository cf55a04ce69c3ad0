# SPDX-License-Identifier: BSD-3-Clause
"""Sheets of devices that the harness has models of, with the sources of each number: models/sensors/NAME.yaml."""
from ._tumble import mid40, mid100, mpu6050, mti30, phidget1044, rs16, vn100

__all__ = ["mid40", "mid100", "mpu6050", "mti30", "phidget1044", "rs16", "vn100"]
