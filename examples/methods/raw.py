# SPDX-License-Identifier: BSD-3-Clause
"""Reads IMU.csv (columns of a sensor_msgs/Imu) and writes the unchanged gyro readings. Write your own method in `rate`."""
import csv
import sys


def rate(gyro_rad_s, specific_force_m_s2):
    """Returns the angular velocity of the IMU in IMU axes."""
    return gyro_rad_s


def main(readings, output):
    with open(readings, newline="") as file, open(output, "w") as out:
        rows = csv.reader(file)
        names = next(rows)
        at = {name: k for k, name in enumerate(names)}
        print("time_ns,wx_rad_s,wy_rad_s,wz_rad_s", file=out)
        for row in rows:
            def numbers(*columns):
                return [float(row[at[column]]) for column in columns]
            time_ns = int(row[at["stamp_s"]]) * 1_000_000_000 + int(row[at["stamp_ns"]])
            w = rate(numbers("wx_rad_s", "wy_rad_s", "wz_rad_s"), numbers("fx_m_s2", "fy_m_s2", "fz_m_s2"))
            print(time_ns, *map(repr, w), sep=",", file=out)


main(*sys.argv[1:])
