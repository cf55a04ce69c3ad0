#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""An independent publisher, which plays a recording in real time like the drivers of an IMU, a lidar and a position sensor.

play.py RECORDING SENT TOPIC...    waits for a subscriber of each topic (imu, points, position), then publishes the messages at their
                                   times. Writes the sending time of each message to SENT (monotonic clock, seconds). From
                                   tumble, the script uses only the reader of recordings.
"""
import array
import json
import pathlib
import sys
import time

import numpy as np
import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Imu, PointCloud2, PointField

import tumble

#: Points of a lidar with 16 rings and 1800 columns, with NaN for rays without a return.
POINTS = 28_800
POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("t", "<u4"), ("ring", "<u2")])
FIELDS = [PointField(name=name, offset=POINT.fields[name][1], datatype=kind, count=1)
          for name, kind in (("x", 7), ("y", 7), ("z", 7), ("intensity", 7), ("t", 6), ("ring", 4))]
SECOND_NS = 1_000_000_000
#: Origin of the recording's world in the frame "map" of the position readings, and the standard deviation of a reading [m].
WORLD_IN_MAP_M, POSITION_SIGMA_M = np.array([100.0, -50.0, 7.0]), 0.01


def put_stamp(message, frame: str, time_ns: int):
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(int(time_ns), SECOND_NS)
    return message


def imu_message(imu, k: int) -> Imu:
    out = put_stamp(Imu(), "imu_link", imu.time_ns[k])
    out.angular_velocity.x, out.angular_velocity.y, out.angular_velocity.z = imu.gyro[k].tolist()
    out.linear_acceleration.x, out.linear_acceleration.y, out.linear_acceleration.z = imu.accel[k].tolist()
    return out


def cloud_message(sweep) -> PointCloud2:
    points = np.zeros(max(POINTS, len(sweep.position)), POINT)
    for axis, name in enumerate("xyz"):
        points[name] = np.nan
        points[name][:len(sweep.position)] = sweep.position[:, axis]
    for name, values in (("intensity", sweep.intensity), ("t", sweep.offset_ns), ("ring", sweep.ring)):
        points[name][:len(sweep.position)] = values
    out = put_stamp(PointCloud2(), "lidar_link", sweep.start_ns)
    out.height, out.width, out.point_step, out.fields = 1, len(points), POINT.itemsize, FIELDS
    out.row_step, out.data = points.nbytes, array.array("B", points.tobytes())
    return out


def position_message(truth, time_ns: int) -> PoseWithCovarianceStamped:
    """Returns the true position of the centre of mass. The orientation is wrong, because the node must ignore it."""
    out = put_stamp(PoseWithCovarianceStamped(), "map", time_ns)
    p = out.pose.pose.position
    p.x, p.y, p.z = (truth.position[time_ns // truth.period_ns] + WORLD_IN_MAP_M).tolist()
    out.pose.pose.orientation.x = 1.0
    for k in range(3):
        out.pose.covariance[7 * k] = POSITION_SIGMA_M**2
    return out


def messages(recording, topics) -> list:
    """Returns (time, topic, message) in the order of a driver: samples at their time stamps, sweeps and positions at the ends of sweeps."""
    imu = recording.imus[0]
    out = [(int(imu.time_ns[k]), "imu", imu_message(imu, k)) for k in range(len(imu))]
    if "points" in topics:
        out += [(int(sweep.end_ns), "points", cloud_message(sweep)) for sweep in recording.sweeps]
    if "position" in topics:
        out += [(int(sweep.end_ns), "position", position_message(recording.truth, int(sweep.end_ns))) for sweep in recording.sweeps]
    return sorted(out, key=lambda each: each[0])


def main(recording: str, sent: str, *topics: str) -> int:
    queue = messages(tumble.read(recording, truth="position" in topics), topics)
    rclpy.init()
    node = rclpy.create_node("player")
    publishers = {"imu": node.create_publisher(Imu, "imu", QoSProfile(depth=2000))}
    if "points" in topics:
        publishers["points"] = node.create_publisher(PointCloud2, "points", QoSProfile(depth=20))
    if "position" in topics:
        publishers["position"] = node.create_publisher(PoseWithCovarianceStamped, "position", QoSProfile(depth=20))
    deadline = time.monotonic() + 60.0
    while any(each.get_subscription_count() == 0 for each in publishers.values()):
        if time.monotonic() > deadline:
            print(f"play.py: no subscriber of {', '.join(publishers)} within 60 s", file=sys.stderr)
            return 1
        time.sleep(0.1)
    time.sleep(3.0)  # until publishers and subscribers have found each other
    times, began = {topic: [] for topic in publishers}, time.monotonic() - 1e-9 * queue[0][0]
    for time_ns, topic, message in queue:
        time.sleep(max(0.0, began + 1e-9 * time_ns - time.monotonic()))
        publishers[topic].publish(message)
        times[topic].append((time_ns, time.monotonic()))
    pathlib.Path(sent).write_text(json.dumps(times))
    time.sleep(2.0)  # until the last messages have arrived
    node.destroy_node()
    rclpy.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
