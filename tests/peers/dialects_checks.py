# SPDX-License-Identifier: BSD-3-Clause
"""Checks that bags.py runs with its packages on the path: dialects_checks.py TUMBLE FOLDER

Reads the bags of `tumble export --for PEER` with rosbags. Checks topics, message types, and fields of points with their
types. Compares each time in the peer's unit with the recording's nanoseconds, which are read from PLY files.
"""
import json
import pathlib
import shutil
import sys
import unittest

import numpy
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from program import run

TUMBLE = FOLDER = None
NUMBERS = {2: "<u1", 4: "<u2", 6: "<u4", 7: "<f4", 8: "<f8"}  # type codes of sensor_msgs/PointField

# peer: bag, topic of the IMU, topic of the points, field of the times, type of the field, unit of the field in ns
WANTED = {"dlio": ("recording.bag", "/os_cloud_node/imu", "/os_cloud_node/points", "t", "<u4", 1),
          "fast-lio": ("recording.bag", "/imu/data", "/velodyne_points", "time", "<f4", 1e9),
          "glim": ("bag", "/os_cloud_node/imu", "/os_cloud_node/points", "t", "<u4", 1),
          "kiss-icp": ("recording.bag", "/imu", "/lidar/points", "t", "<u4", 1),
          "lio-sam": ("recording.bag", "/imu_raw", "/points_raw", "time", "<f4", 1e9),
          "norlab": ("bag", "/imu/data", "/points_in", "t", "<u4", 1),
          "point-lio": ("recording.bag", "/imu/data", "/velodyne_points", "time", "<f4", 1e9),
          "rko-lio": ("bag", "/imu", "/lidar/points", "t", "<u4", 1)}


def tumble(*words):
    return run(TUMBLE, *words)


def make_files():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    tumble("record", "hill", "--seed", 1001, "-o", FOLDER / "a.h5")
    tumble("export", FOLDER / "a.h5", "--format", "ply", "-o", FOLDER / "ply")
    for peer in WANTED:
        tumble("export", FOLDER / "a.h5", "--for", peer, "-o", FOLDER / peer)
    for ending in ("bag", "mcap"):
        tumble("export", FOLDER / "a.h5", "--points", "livox", "-o", FOLDER / f"livox.{ending}")


def given_sweeps():
    """Yields the points of each sweep in the PLY files, in order of time."""
    for path in sorted((FOLDER / "ply").glob("lidar_*.ply")):
        head, body = path.read_bytes().split(b"end_header\n", 1)
        kinds = {"float": "<f4", "ushort": "<u2", "uint": "<u4"}
        fields = [line.split()[1:] for line in head.decode().splitlines() if line.startswith("property")]
        points = numpy.frombuffer(body, numpy.dtype([(name, kinds[kind]) for kind, name in fields]))
        yield points[numpy.argsort(points["offset_ns"], kind="stable")]


def messages(path, topic):
    with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        wanted = [c for c in reader.connections if c.topic == topic]
        for connection, _, raw in reader.messages(connections=wanted):
            yield reader.deserialize(raw, connection.msgtype)


def points_of(cloud):
    kinds = {"names": [f.name for f in cloud.fields], "formats": [NUMBERS[f.datatype] for f in cloud.fields],
             "offsets": [f.offset for f in cloud.fields], "itemsize": cloud.point_step}
    return numpy.frombuffer(cloud.data.tobytes(), numpy.dtype(kinds))


def worst_ns(peer, unit_ns):
    """Returns the largest difference between the times in the bag, in the given unit, and the times of the recording."""
    bag, _, topic, time, kind, _ = WANTED[peer]
    worst = 0.0
    for cloud, given in zip(messages(FOLDER / peer / bag, topic), given_sweeps(), strict=True):
        points = points_of(cloud)
        if points.dtype[time] != numpy.dtype(kind) or len(points) != len(given):
            raise AssertionError(f"{peer}: {points.dtype}, {len(points)} points of {len(given)}")
        worst = max(worst, numpy.abs(points[time].astype(float) * unit_ns - given["offset_ns"]).max())
        for name in ("x", "y", "z", "ring"):
            numpy.testing.assert_array_equal(points[name], given[name])
        numpy.testing.assert_allclose(points["intensity"], 255 * given["intensity"].astype(float), atol=1e-4)
    return worst


class Peers(unittest.TestCase):
    def test_times_are_in_the_peers_unit(self):
        for peer, wanted in WANTED.items():
            with self.subTest(peer):
                self.assertLess(worst_ns(peer, wanted[5]), 4.0)

    def test_another_unit_is_noticed(self):
        for peer, wanted in WANTED.items():
            with self.subTest(peer):
                self.assertGreater(worst_ns(peer, wanted[5] * 1e-3), 1e7)

    def test_one_imu_in_si(self):
        for peer, (bag, imu, *_) in WANTED.items():
            with self.subTest(peer):
                readings = list(messages(FOLDER / peer / bag, imu))
                self.assertEqual(len(readings), 1000)
                force = numpy.median([numpy.hypot(numpy.hypot(m.linear_acceleration.x, m.linear_acceleration.y),
                                                  m.linear_acceleration.z) for m in readings[:100]])
                self.assertAlmostEqual(force, 9.80665, delta=0.1)
                with AnyReader([FOLDER / peer / bag], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
                    kinds = [c.msgtype for c in reader.connections]
                self.assertEqual(kinds.count("sensor_msgs/msg/Imu"), 1)
                self.assertEqual(kinds.count("sensor_msgs/msg/PointCloud2"), 1)

    def test_the_manifest_names_what_is_there(self):
        for peer, (bag, imu, points, time, *_) in WANTED.items():
            with self.subTest(peer):
                said = json.loads((FOLDER / peer / "manifest.json").read_text())
                self.assertEqual((said["bag"]["path"], said["imu"]["topic"], said["lidar"]["topic"]), (bag, imu, points))
                cloud = next(messages(FOLDER / peer / bag, points))
                self.assertEqual([f["name"] for f in said["lidar"]["fields"]], [f.name for f in cloud.fields])
                self.assertEqual(cloud.header.frame_id, said["lidar"]["frame"])
                self.assertTrue(all((FOLDER / peer / name).is_file() for name in said["configuration"]))


class Livox(unittest.TestCase):
    """Reads CustomMsg with the definition that the bag contains."""

    def check(self, path, topic, msgtype):
        count = 0
        for message, given in zip(messages(path, topic), given_sweeps(), strict=True):
            self.assertEqual(message.__msgtype__, msgtype)
            self.assertEqual(message.point_num, len(given))
            self.assertEqual(message.timebase, message.header.stamp.sec * 10**9 + message.header.stamp.nanosec)
            for k in range(0, len(given), 501):
                point = message.points[k]
                self.assertEqual((point.offset_time, point.line, point.tag), (given["offset_ns"][k], given["ring"][k], 0))
                self.assertEqual((point.x, point.y, point.z), tuple(float(given[axis][k]) for axis in "xyz"))
                self.assertEqual(point.reflectivity, round(255 * float(given["intensity"][k])))
                count += 1
        self.assertGreater(count, 1000)

    def test_ros1(self):
        self.check(FOLDER / "livox.bag", "/lidar/points", "livox_ros_driver/msg/CustomMsg")
        store = get_typestore(Stores.ROS1_NOETIC)
        point = "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"
        store.register(get_types_from_msg(point, "livox_ros_driver/msg/CustomPoint"))
        store.register(get_types_from_msg(
            "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
            "livox_ros_driver/CustomPoint[] points\n", "livox_ros_driver/msg/CustomMsg"))
        with AnyReader([FOLDER / "livox.bag"]) as reader:
            digests = {c.digest for c in reader.connections if c.topic == "/lidar/points"}
        self.assertEqual(digests, {store.generate_msgdef("livox_ros_driver/msg/CustomMsg")[1]})

    def test_mcap(self):
        self.check(FOLDER / "livox.mcap", "/lidar/points", "livox_ros_driver2/msg/CustomMsg")


if __name__ == "__main__":
    TUMBLE, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
    make_files()
    passed = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False).result.wasSuccessful()
    if passed:  # several hundred MB
        shutil.rmtree(FOLDER)
    sys.exit(0 if passed else 1)
