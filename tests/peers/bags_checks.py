# SPDX-License-Identifier: BSD-3-Clause
"""Checks that bags.py runs with its packages on the path: bags_checks.py TUMBLE FOLDER"""
import csv
import pathlib
import shutil
import subprocess
import sys
import unittest

import numpy
from mcap.reader import make_reader
from mcap.records import ChunkIndex, MessageIndex, Schema
from mcap.stream_reader import CRCValidationError, StreamReader, get_chunk_data_stream
from mcap.writer import CompressionType, Writer
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from program import run

TUMBLE = FOLDER = None
BAGS = {"mcap": "a.mcap", "rosbag1": "a.bag", "rosbag2": "rosbag2", "rosbag2_mcap": "rosbag2_mcap"}
POINTS = numpy.dtype({"names": ["x", "y", "z", "intensity", "ring", "time", "offset_ns"],
                      "formats": ["<f4", "<f4", "<f4", "<f4", "<u2", "<f4", "<u4"],
                      "offsets": [0, 4, 8, 12, 16, 18, 22], "itemsize": 26})


def tumble(*words):
    return run(TUMBLE, *words)


def make_files():
    """Writes a recording of a fall and its estimate, in every bag format and as text."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    tumble("record", "hill", "--seed", 1001, "-o", FOLDER / "a.h5")
    tumble("estimate", FOLDER / "a.h5", "--method", "slam/icp_raw", "-o", FOLDER / "estimate")
    for form, name in BAGS.items():
        tumble("export", FOLDER / "a.h5", "--format", form, "--with-truth", "--estimate", FOLDER / "estimate",
               "-o", FOLDER / name)
    for form in ("csv", "ply"):
        tumble("export", FOLDER / "a.h5", "--format", form, "-o", FOLDER / form)
    tumble("export", FOLDER / "a.h5", "-o", FOLDER / "truth.tum")


def imu_rows(path):
    """Yields time stamp in ns, rate and specific force of each IMU sample in the CSV file."""
    with open(path) as lines:
        for row in csv.DictReader(lines):
            yield (int(row["stamp_s"]) * 10**9 + int(row["stamp_ns"]),
                   [float(row[f"w{axis}_rad_s"]) for axis in "xyz"], [float(row[f"f{axis}_m_s2"]) for axis in "xyz"])


def stamp(header):
    return header.stamp.sec * 10**9 + header.stamp.nanosec


def vector(xyz):
    return [xyz.x, xyz.y, xyz.z]


def sweep_of_ply(path):
    """Returns the fields of a sweep in the PLY file."""
    raw = path.read_bytes()
    head, body = raw.split(b"end_header\n", 1)
    sizes = {"float": "<f4", "ushort": "<u2", "uint": "<u4", "uint16": "<u2", "uint32": "<u4", "float32": "<f4"}
    fields = [line.split()[1:] for line in head.decode().splitlines() if line.startswith("property")]
    return numpy.frombuffer(body, numpy.dtype([(name, sizes[kind]) for kind, name in fields]))


class Reading(unittest.TestCase):
    """Tests that rosbags reads the same numbers from each bag format as from the text files."""

    def messages(self, form):
        found = {}
        with AnyReader([FOLDER / BAGS[form]], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            for connection, time, raw in reader.messages():
                found.setdefault(connection.topic, []).append((time, reader.deserialize(raw, connection.msgtype)))
        return found

    def check_imu(self, found):
        rows = list(imu_rows(FOLDER / "csv" / "imu.csv"))
        self.assertGreater(len(rows), 500)
        self.assertEqual([row[0] for row in rows], [stamp(m.header) for _, m in found["/imu"]])
        self.assertEqual([row[1] for row in rows], [vector(m.angular_velocity) for _, m in found["/imu"]])
        self.assertEqual([row[2] for row in rows], [vector(m.linear_acceleration) for _, m in found["/imu"]])
        self.assertTrue(all(m.orientation_covariance[0] == -1 for _, m in found["/imu"]))

    def check_points(self, found):
        sweeps = sorted((FOLDER / "ply").glob("lidar_*.ply"))
        self.assertEqual(len(sweeps), len(found["/lidar/points"]))
        for path, (time, cloud) in zip(sweeps, found["/lidar/points"]):
            self.assertEqual([f.name for f in cloud.fields], list(POINTS.names))
            self.assertEqual([f.offset for f in cloud.fields], [POINTS.fields[n][1] for n in POINTS.names])
            self.assertEqual(cloud.point_step, POINTS.itemsize)
            points, given = numpy.frombuffer(cloud.data.tobytes(), POINTS), sweep_of_ply(path)
            for name in ("x", "y", "z", "intensity", "ring", "offset_ns"):
                numpy.testing.assert_array_equal(points[name], given[name])
            self.assertLess(numpy.abs(points["time"].astype(float) - 1e-9 * points["offset_ns"]).max(), 4e-9)
            self.assertGreaterEqual(time, stamp(cloud.header) + int(points["offset_ns"].max()))

    def check_truth(self, found):
        rows = [line.split() for line in (FOLDER / "truth.tum").read_text().splitlines() if not line.startswith("#")]
        truth = {int(row[0].replace(".", "")): [float(x) for x in row[1:]] for row in rows}
        self.assertGreater(len(found["/truth"]), 500)
        transforms = {stamp(t.header): t for _, m in found["/tf"] for t in m.transforms if t.child_frame_id == "body"}
        for _, pose in found["/truth"]:
            q = pose.pose.pose.orientation
            mine = vector(pose.pose.pose.position) + [q.x, q.y, q.z, q.w]
            self.assertEqual(mine, truth[stamp(pose.header)])
            moved = transforms[stamp(pose.header)].transform
            q = moved.rotation
            self.assertEqual(mine, vector(moved.translation) + [q.x, q.y, q.z, q.w])

    def check_frames(self, found):
        parents = {}
        for topic in ("/tf_static", "/tf"):
            for _, message in found[topic]:
                for each in message.transforms:
                    parents.setdefault(each.child_frame_id, set()).add(each.header.frame_id)
        self.assertEqual(parents, {"imu": {"body"}, "imu_reference": {"body"}, "lidar": {"body"}, "body": {"world"},
                                   "slam_icp_raw": {"world"}})
        self.assertEqual(len(found["/tf_static"]), 1)
        self.assertEqual(found["/tf_static"][0][0], min(time for rows in found.values() for time, _ in rows))

    def check_estimate(self, found):
        poses, clouds = found["/slam_icp_raw"], found["/slam_icp_raw/points"]
        self.assertGreater(len(poses), 500)
        self.assertGreater(len(clouds), 50)
        errors = []
        for _, cloud in clouds:
            self.assertEqual([f.name for f in cloud.fields], ["x", "y", "z", "error_m"])
            self.assertEqual(cloud.header.frame_id, "world")
            errors.append(numpy.frombuffer(cloud.data.tobytes(), "<f4").reshape(-1, 4)[:, 3])
        self.assertLess(numpy.median(errors[0]), 0.1)  # the paths are aligned at the start, at rest
        self.assertTrue(all(numpy.isfinite(e).all() and (e >= 0).all() for e in errors))

    def check_clock(self, found):
        ticks = [m.clock.sec * 10**9 + m.clock.nanosec for _, m in found["/clock"]]
        self.assertEqual(ticks, [time for time, _ in found["/clock"]])
        self.assertGreater(len(ticks), 500)
        self.assertGreaterEqual(min(numpy.diff(ticks)), 10**7)

    def test_each_kind(self):
        for form in BAGS:
            with self.subTest(form):
                found = self.messages(form)
                for check in (self.check_imu, self.check_points, self.check_truth, self.check_frames,
                              self.check_estimate, self.check_clock):
                    check(found)


class Definitions(unittest.TestCase):
    """Compares the message definitions in the bags with those of rosbags."""

    def test_ros1(self):
        store = get_typestore(Stores.ROS1_NOETIC)
        store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms\n", "tf2_msgs/msg/TFMessage"))
        with AnyReader([FOLDER / BAGS["rosbag1"]]) as reader:
            self.assertEqual(len({c.msgtype for c in reader.connections}), 5)
            for connection in reader.connections:
                self.assertEqual(connection.digest, store.generate_msgdef(connection.msgtype)[1], connection.topic)
            latched = [c.topic for c in reader.connections if c.ext.latching]
        self.assertEqual(latched, ["/tf_static"])

    def test_ros2(self):
        store = get_typestore(Stores.ROS2_HUMBLE)
        with open(FOLDER / BAGS["mcap"], "rb") as stream:
            schemas = make_reader(stream).get_summary().schemas.values()
        self.assertEqual(len(schemas), 5)
        for schema in schemas:
            self.assertEqual(schema.encoding, "ros2msg")
            for name, (_, fields) in get_types_from_msg(schema.data.decode(), schema.name).items():
                self.assertEqual(fields, store.fielddefs[name][1], name)

    def test_ros2_bags_bring_their_own(self):
        for form in ("rosbag2", "rosbag2_mcap"):
            with self.subTest(form), AnyReader([FOLDER / BAGS[form]]) as reader:
                first = {}
                for connection, _, raw in reader.messages():
                    first.setdefault(connection.topic, reader.deserialize(raw, connection.msgtype))
                self.assertEqual(first["/imu"].header.frame_id, "imu")
                self.assertGreater(first["/lidar/points"].width, 0)

    def test_offered_qos(self):
        for form in ("mcap", "rosbag2", "rosbag2_mcap"):
            with AnyReader([FOLDER / BAGS[form]], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
                qos = {c.topic: c.ext.offered_qos_profiles for c in reader.connections}
            self.assertEqual(qos["/tf_static"][0].durability.name, "TRANSIENT_LOCAL")
            self.assertEqual(qos["/imu"], [])


class McapFile(unittest.TestCase):
    """Tests structure, checksums and index with mcap, the reference implementation."""
    path = property(lambda self: FOLDER / BAGS["mcap"])

    def test_every_checksum_holds(self):
        with open(self.path, "rb") as stream:
            records = list(StreamReader(stream, validate_crcs=True, emit_chunks=True).records)
        stated = {type(r).__name__: r for r in records}
        self.assertNotEqual(stated["DataEnd"].data_section_crc, 0)
        self.assertNotEqual(stated["Footer"].summary_crc, 0)
        chunks = [r for r in records if type(r).__name__ == "Chunk"]
        self.assertGreater(len(chunks), 10)
        self.assertTrue(all(c.uncompressed_crc != 0 and c.compression == "lz4" for c in chunks))

    def test_a_spoiled_byte_is_noticed(self):
        whole = self.path.read_bytes()
        spoiled = FOLDER / "spoiled.mcap"
        for at in (len(whole) // 3, len(whole) // 2):
            spoiled.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1:])
            with open(spoiled, "rb") as stream, self.assertRaises((CRCValidationError, RuntimeError)):
                for _ in StreamReader(stream, validate_crcs=True).records:
                    pass
            refused = subprocess.run([TUMBLE, "import", spoiled, "-o", FOLDER / "x.h5"], capture_output=True, text=True)
            self.assertEqual(refused.returncode, 2)
            self.assertEqual(refused.stderr.count("\n"), 1)

    def test_the_index_names_what_is_there(self):
        with open(self.path, "rb") as stream:
            summary = make_reader(stream).get_summary()
            counts = {}
            for index in summary.chunk_indexes:
                self.check_chunk(stream, index, counts)
        self.assertEqual(counts, dict(summary.statistics.channel_message_counts))
        self.assertEqual(sum(counts.values()), summary.statistics.message_count)
        self.assertEqual(min(i.message_start_time for i in summary.chunk_indexes), summary.statistics.message_start_time)
        self.assertEqual(max(i.message_end_time for i in summary.chunk_indexes), summary.statistics.message_end_time)

    def check_chunk(self, stream, index, counts):
        self.assertIsInstance(index, ChunkIndex)
        stream.seek(index.chunk_start_offset)
        chunk = next(StreamReader(stream, skip_magic=True, emit_chunks=True).records)
        data, size = get_chunk_data_stream(chunk, validate_crc=True)
        self.assertEqual(size, index.uncompressed_size)
        plain = data.read(size)
        stream.seek(index.chunk_start_offset + index.chunk_length)
        behind = StreamReader(stream, skip_magic=True).records
        for channel in sorted(index.message_index_offsets):
            entries = next(behind)
            self.assertIsInstance(entries, MessageIndex)
            self.assertEqual(entries.channel_id, channel)
            for time, offset in entries.records:
                self.assertEqual(plain[offset], 5)
                self.assertEqual(int.from_bytes(plain[offset + 9:offset + 11], "little"), channel)
                self.assertEqual(int.from_bytes(plain[offset + 15:offset + 23], "little"), time)
                self.assertTrue(index.message_start_time <= time <= index.message_end_time)
            counts[channel] = counts.get(channel, 0) + len(entries.records)

    def test_messages_are_decoded_in_order(self):
        seen, last = {}, 0
        with open(self.path, "rb") as stream:
            reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
            self.assertEqual(reader.get_header().profile, "ros2")
            for schema, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
                self.assertIsInstance(schema, Schema)
                self.assertGreaterEqual(message.log_time, last)
                last = message.log_time
                self.assertEqual(message.sequence, seen.get(channel.topic, 0))
                seen[channel.topic] = seen.get(channel.topic, 0) + 1
        self.assertEqual(set(seen), {"/imu", "/imu_reference", "/lidar/points", "/truth", "/slam_icp_raw",
                                     "/slam_icp_raw/points", "/tf", "/tf_static", "/clock"})

    def test_rerun_finds_nothing_wrong(self):
        check = [sys.executable, "-m", "rerun_cli", "mcap", "check"]
        found = subprocess.run([*check, self.path], capture_output=True, text=True)
        self.assertEqual(found.returncode, 0, found.stderr)
        rows = [line for line in (found.stdout + found.stderr).splitlines() if " /" in line]
        self.assertEqual(len(rows), 9)
        self.assertTrue(all(row.startswith("ok ") for row in rows), rows)
        cut = FOLDER / "cut.mcap"
        cut.write_bytes(self.path.read_bytes()[:100000])
        found = subprocess.run([*check, cut], capture_output=True, text=True)
        self.assertFalse([line for line in (found.stdout + found.stderr).splitlines() if line.startswith("ok ")])


class Importing(unittest.TestCase):
    """Tests that tumble imports the same readings from files that mcap writes with different options."""

    def rewritten(self, name, **how):
        path = FOLDER / name
        with open(FOLDER / BAGS["mcap"], "rb") as source, open(path, "wb") as target:
            writer, channels = Writer(target, **how), {}
            writer.start("ros2", "a test")
            for schema, channel, message in make_reader(source).iter_messages(topics=["/imu", "/lidar/points"]):
                if channel.topic not in channels:
                    number = writer.register_schema(schema.name, schema.encoding, schema.data)
                    channels[channel.topic] = writer.register_channel(channel.topic, channel.message_encoding, number)
                writer.add_message(channels[channel.topic], message.log_time, message.data, message.publish_time)
            writer.finish()
        return path

    def test_every_way_of_writing(self):
        ways = {"zstd": {}, "lz4": {"compression": CompressionType.LZ4}, "plain": {"compression": CompressionType.NONE},
                "loose": {"use_chunking": False}, "small": {"chunk_size": 10000, "enable_data_crcs": True},
                "bare": {"use_statistics": False, "repeat_channels": False, "repeat_schemas": False, "use_summary_offsets": False}}
        for name, how in ways.items():
            with self.subTest(name):
                back, out = FOLDER / (name + ".h5"), FOLDER / (name + "_csv")
                tumble("import", self.rewritten(name + ".mcap", **how), "-o", back)
                tumble("export", back, "--format", "csv", "-o", out)
                self.assertEqual(list(imu_rows(out / "imu.csv")), list(imu_rows(FOLDER / "csv" / "imu.csv")))
                sweeps = FOLDER / (name + "_ply")
                tumble("export", back, "--format", "ply", "-o", sweeps)
                for path in (FOLDER / "ply").glob("*.ply"):
                    self.assertEqual(path.read_bytes(), (sweeps / path.name).read_bytes(), path.name)
                shutil.rmtree(sweeps)


if __name__ == "__main__":
    TUMBLE, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
    make_files()
    passed = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False).result.wasSuccessful()
    if passed:  # several hundred MB
        shutil.rmtree(FOLDER)
    sys.exit(0 if passed else 1)
