# SPDX-License-Identifier: BSD-3-Clause
"""ROS 2 nodes in Python, for robots on which nothing is compiled.

    python -m tumble.ros tumbling --ros-args -p imu_sheet:=mti30 -p "lever_arm_m:=[-0.022, -0.085, 0.055]" -r imu:=/imu/data -r points:=/rslidar_points
    python -m tumble.ros rolling --ros-args -p radius_m:=0.145

Topics, services and parameters: ros/README.md. The node converts messages. The adapters of the compiled module contain the logic, which
the C++ nodes share. Needs rclpy, sensor_msgs, nav_msgs, diagnostic_msgs and std_srvs: from a ROS 2 installation, or from PyPI (ros-jazzy-rclpy, …).
/tf and extrinsics from TF need tf2_ros, which PyPI lacks.
"""
from __future__ import annotations

import array
import functools
import importlib
import math
import pathlib
import sys
from collections.abc import Sequence
from typing import Any

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Imu, PointCloud2, PointField
from std_srvs.srv import Trigger

from . import _tumble

try:
    import tf2_ros
except ImportError:  # the packages of PyPI lack tf2
    tf2_ros = None

IDENTITY = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
#: Queue lengths for messages that arrive while a sweep is registered: two seconds of a 1 kHz IMU, and of ten sweeps per second.
IMU_DEPTH, CLOUD_DEPTH = 2000, 20


def to_ns(stamp: Any) -> int:
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def put_stamp(stamp: Any, time_ns: int) -> None:
    stamp.sec, stamp.nanosec = divmod(time_ns, 1_000_000_000)


def cloud(frame: str, stamp_ns: int, names: Sequence[str], data: bytes) -> PointCloud2:
    """Returns a cloud of float32 fields."""
    out = PointCloud2(height=1, point_step=4 * len(names), is_dense=True)
    out.header.frame_id = frame
    put_stamp(out.header.stamp, stamp_ns)
    out.fields = [PointField(name=name, offset=4 * k, datatype=PointField.FLOAT32, count=1) for k, name in enumerate(names)]
    out.width = len(data) // out.point_step
    out.row_step = len(data)
    out.data = array.array("B", data)
    return out


class OdometryNode(Node):
    """Base class of both nodes, with parameters, /tf, odometry and diagnostics. The node is the publisher of its adapter."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.text: dict[str, Any] = {}
        for key, default, count, meaning, at_start in _tumble.node_texts():
            described = ParameterDescriptor(description=meaning, read_only=at_start, dynamic_typing=count > 0)
            self.text[key] = self.declare_parameter(key, [] if count > 0 else default, described).value
        if self.text["tf"] not in ("imu", "sweep", "none"):
            raise ValueError(f"parameter tf is '{self.text['tf']}'; it must be imu, sweep or none")
        self.frames = {"imu": self.text["imu_frame"], "lidar": self.text["lidar_frame"]}
        self.buffer = tf2_ros.Buffer() if tf2_ros else None
        self.listener = tf2_ros.TransformListener(self.buffer, self) if tf2_ros else None
        self.broadcaster = tf2_ros.TransformBroadcaster(self) if tf2_ros else None
        self.odometry_publisher = self.create_publisher(Odometry, "~/odom", 10)
        self.odometry_imu_publisher = self.create_publisher(Odometry, "~/odom_imu", IMU_DEPTH)
        self.diagnostics_publisher = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", self.on_initial_pose, 1)
        self.create_service(Trigger, "~/reset", self.on_reset)
        self.inputs: list[tuple[Any, str, Any, int]] = []
        self.create_timer(0.2, self.subscribe)

    def subscribe(self) -> None:
        """Subscribes to each input that has a publisher. The subscription is reliable if all publishers are reliable, because a best-effort
        subscription would lose large clouds."""
        for each in list(self.inputs):
            kind, topic, callback, depth = each
            publishers = self.get_publishers_info_by_topic(self.resolve_topic_name(topic))
            if publishers:
                quality = QoSProfile(depth=depth, reliability=ReliabilityPolicy.BEST_AVAILABLE)
                self.subscribe_input(publishers[0].topic_type, kind, topic, callback, quality)
                self.inputs.remove(each)

    def subscribe_input(self, published_type: str, kind: Any, topic: str, callback: Any, quality: QoSProfile) -> None:
        self.create_subscription(kind, topic, callback, quality)

    def numbers(self, parameters: list[_tumble.Parameter]) -> dict[str, Any]:
        """Declares the numbers of the library, and returns the values that the user sets. A number without default is NaN until the user sets the number."""
        out: dict[str, Any] = {}
        for each in parameters:
            default = list(map(float, each.default)) if isinstance(each.default, (tuple, np.ndarray)) else each.default
            described = ParameterDescriptor(description=f"{each.meaning} [{each.unit}]", read_only=True)
            if isinstance(default, float) and each.low <= default <= each.high:
                described.floating_point_range = [FloatingPointRange(from_value=each.low, to_value=each.high)]
            value = self.declare_parameter(each.name, default, described).value
            values = list(value) if isinstance(default, list) else [value]
            if not any(isinstance(x, float) and math.isnan(x) for x in values):
                out[each.name] = values if isinstance(default, list) else value
        return out

    def mounting(self, key: str, frame: str) -> list[float] | None:
        """Returns the pose of a sensor in the base frame, from the parameter or else from TF. Returns None while TF lacks the pose."""
        if len(self.text[key]) > 0:
            return list(self.text[key])
        if not frame:
            return None
        if frame == self.text["base_frame"]:
            return IDENTITY
        if self.buffer is None:
            raise RuntimeError(f"the parameter {key} is empty and tf2_ros is not installed: set {key} to x y z qx qy qz qw")
        try:
            found = self.buffer.lookup_transform(self.text["base_frame"], frame, rclpy.time.Time()).transform
        except tf2_ros.TransformException as error:
            self.get_logger().warning(f"waiting for TF: {error}; or set {key}", throttle_duration_sec=5.0)
            return None
        p, q = found.translation, found.rotation
        return [p.x, p.y, p.z, q.x, q.y, q.z, q.w]

    def report(self, topic: str, error: str) -> None:
        if error:
            self.get_logger().warning(f"{topic}: {error}", throttle_duration_sec=1.0)

    # the adapter calls these methods

    def wants(self, output: str) -> bool:
        if output == "odometry_imu":
            return self.text["tf"] == "imu" or bool(self.odometry_imu_publisher.get_subscription_count() > 0)
        return False

    def message(self, odometry: _tumble.BaseOdometry, from_imu: bool) -> Odometry:
        out = Odometry(child_frame_id=self.text["base_frame"])
        out.header.frame_id = self.text["odom_frame"]
        put_stamp(out.header.stamp, odometry.stamp_ns)
        p, q, v = out.pose.pose.position, out.pose.pose.orientation, out.twist.twist
        p.x, p.y, p.z = odometry.position
        q.x, q.y, q.z, q.w = odometry.orientation
        v.linear.x, v.linear.y, v.linear.z, v.angular.x, v.angular.y, v.angular.z = odometry.twist
        out.pose.covariance = odometry.pose_covariance
        out.twist.covariance = odometry.twist_covariance
        if self.broadcaster is not None and self.text["tf"] == ("imu" if from_imu else "sweep"):
            moved = TransformStamped(header=out.header, child_frame_id=out.child_frame_id)
            moved.transform.translation.x, moved.transform.translation.y, moved.transform.translation.z = p.x, p.y, p.z
            moved.transform.rotation = q
            self.broadcaster.sendTransform(moved)
        return out

    def odometry(self, odometry: _tumble.BaseOdometry) -> None:
        self.odometry_publisher.publish(self.message(odometry, from_imu=False))

    def odometry_imu(self, odometry: _tumble.BaseOdometry) -> None:
        self.odometry_imu_publisher.publish(self.message(odometry, from_imu=True))

    def diagnostics(self, stamp_ns: int, ok: bool, message: str, values: list[tuple[str, str]]) -> None:
        out = DiagnosticArray()
        put_stamp(out.header.stamp, stamp_ns)
        status = DiagnosticStatus(level=DiagnosticStatus.OK if ok else DiagnosticStatus.WARN, name=self.get_name(), message=message)
        status.values = [KeyValue(key=key, value=value) for key, value in values]
        out.status = [status]
        self.diagnostics_publisher.publish(out)

    # these services and topics change the run

    adapter: Any = None

    def start_again(self, *start: Any) -> str:
        """Starts a new run at a pose with standard deviations. If the list is empty, the run starts at the origin, or anywhere in a prior map."""
        return str(self.adapter.reset(*start)) if self.adapter is not None else "no data yet"

    def on_reset(self, _: Trigger.Request, answer: Trigger.Response) -> Trigger.Response:
        error = self.start_again([])
        answer.success, answer.message = not error, error or "started again"
        return answer

    def on_initial_pose(self, given: PoseWithCovarianceStamped) -> None:
        p, q = given.pose.pose.position, given.pose.pose.orientation
        covariance = given.pose.covariance  # order: position x y z, rotations about x y z
        sigma_m, sigma_rad = math.sqrt(max(covariance[0], covariance[7], 0.0)), math.sqrt(max(covariance[35], 0.0))
        try:
            self.report("initialpose", self.start_again([p.x, p.y, p.z, q.x, q.y, q.z, q.w], sigma_m, sigma_rad))
        except ValueError as error:
            self.report("initialpose", str(error))

    def path(self, parameter: str) -> pathlib.Path:
        """Returns the path in a parameter, which may have changed since the start."""
        return pathlib.Path(self.get_parameter(parameter).value).absolute()

    def write(self, parameter: str, content: bytes, answer: Trigger.Response) -> Trigger.Response:
        path = self.path(parameter)
        try:
            path.write_bytes(content)
            answer.success, answer.message = True, f"wrote {path}"
        except OSError as error:
            answer.success, answer.message = False, f"{error}; set the parameter {parameter}"
        return answer


class TumblingNode(OdometryNode):
    """Runs TumblingOdometry with the topics imu and points."""

    def __init__(self) -> None:
        super().__init__("tumbling_odometry")
        sheets = self.text["imu_sheet"], self.text["lidar_sheet"]
        self.given = self.numbers(_tumble.TumblingAdapter.parameters(*sheets))
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.imu_publisher = self.create_publisher(Imu, "~/imu", IMU_DEPTH)
        self.points_publisher = self.create_publisher(PointCloud2, "~/points", 10)
        self.map_publisher = self.create_publisher(PointCloud2, "~/map", latched)
        self.create_service(Trigger, "~/save_map", self.on_save_map)
        self.create_service(Trigger, "~/load_map", self.on_load_map)
        self.create_service(Trigger, "~/save_calibration", self.on_save_calibration)
        self.position_publisher = self.create_publisher(PoseWithCovarianceStamped, "~/pose", 10)
        self.position_frame = ""
        self.inputs = [(Imu, "imu", self.on_imu, IMU_DEPTH), (PointCloud2, "points", self.on_points, CLOUD_DEPTH),
                       (PoseWithCovarianceStamped, "position", self.on_position, CLOUD_DEPTH)]
        self.start()  # if the parameters state the mounting, start() reports wrong parameters immediately

    def start(self) -> bool:
        """Creates the adapter when the mounting of both sensors is known."""
        if self.adapter is not None:
            return True
        T_base_imu, T_base_lidar = self.mounting("T_base_imu", self.frames["imu"]), self.mounting("T_base_lidar", self.frames["lidar"])
        if T_base_imu is None or T_base_lidar is None:
            return False
        self.adapter = _tumble.TumblingAdapter(self, self.given, self.text["imu_sheet"], self.text["lidar_sheet"], self.text["time_field"],
                                               list(self.text["own_body"]), list(self.text["position_arm"]), T_base_imu, T_base_lidar)
        if self.text["prior_map_file"] and (error := self.load_map()):
            raise ValueError(error)
        return True

    def load_map(self) -> str:
        """Reads `prior_map_file` and starts a run in this map. Returns an empty text, or the error."""
        path = self.path("prior_map_file")
        try:
            error = self.adapter.load_map(path.read_bytes())
        except OSError as unreadable:
            return f"{unreadable}; set the parameter prior_map_file"
        return f"{path}: {error}" if error else ""

    def on_imu(self, message: Imu) -> None:
        self.frames["imu"] = self.frames["imu"] or message.header.frame_id
        if self.start():
            w, f = message.angular_velocity, message.linear_acceleration
            self.report("imu", self.adapter.on_imu(to_ns(message.header.stamp), w.x, w.y, w.z, f.x, f.y, f.z))

    def on_points(self, message: PointCloud2) -> None:
        self.frames["lidar"] = self.frames["lidar"] or message.header.frame_id
        if self.start():
            fields = [(field.name, field.offset, field.datatype, field.count) for field in message.fields]
            self.report("points", self.adapter.on_cloud(to_ns(message.header.stamp), message.height, message.width, fields, message.is_bigendian,
                                                        message.point_step, message.row_step, message.data))

    def on_position(self, message: PoseWithCovarianceStamped) -> None:
        self.position_frame = message.header.frame_id
        p, covariance = message.pose.pose.position, message.pose.covariance
        if self.start():
            rows = [covariance[6 * i + j] for i in range(3) for j in range(3)]
            self.report("position", self.adapter.on_position(to_ns(message.header.stamp), [p.x, p.y, p.z], rows))

    def on_livox(self, message: bytes) -> None:
        self.frames["lidar"] = self.frames["lidar"] or _tumble.livox_frame(message)
        if self.start():
            self.report("points", self.adapter.on_livox(message))

    def subscribe_input(self, published_type: str, kind: Any, topic: str, callback: Any, quality: QoSProfile) -> None:
        if kind is PointCloud2 and published_type.endswith("/CustomMsg"):  # the type is installed with the driver
            livox = importlib.import_module(published_type.split("/")[0] + ".msg").CustomMsg
            self.create_subscription(livox, topic, self.on_livox, quality, raw=True)
        else:
            super().subscribe_input(published_type, kind, topic, callback, quality)

    def wants(self, output: str) -> bool:
        if output == "points":
            return bool(self.points_publisher.get_subscription_count() > 0)
        return output == "map" or super().wants(output)

    def imu(self, recovered: _tumble.RecoveredImu) -> None:
        out = Imu()
        out.header.frame_id = self.frames["imu"]
        put_stamp(out.header.stamp, recovered.stamp_ns)
        w, f = out.angular_velocity, out.linear_acceleration
        w.x, w.y, w.z = recovered.rate
        f.x, f.y, f.z = recovered.force
        out.angular_velocity_covariance = recovered.covariance
        out.linear_acceleration_covariance = [recovered.force_variance if k % 4 == 0 else 0.0 for k in range(9)]
        out.orientation_covariance[0] = -1.0  # sensor_msgs/Imu: no orientation
        self.imu_publisher.publish(out)

    def position_pose(self, odometry: _tumble.BaseOdometry) -> None:
        out = PoseWithCovarianceStamped()
        out.header.frame_id = self.position_frame
        put_stamp(out.header.stamp, odometry.stamp_ns)
        p, q = out.pose.pose.position, out.pose.pose.orientation
        p.x, p.y, p.z = odometry.position
        q.x, q.y, q.z, q.w = odometry.orientation
        out.pose.covariance = odometry.pose_covariance
        self.position_publisher.publish(out)

    def points(self, stamp_ns: int, data: bytes) -> None:
        self.points_publisher.publish(cloud(self.frames["lidar"], stamp_ns, ("x", "y", "z", "intensity"), data))

    def map(self, stamp_ns: int, data: bytes) -> None:
        names = ("x", "y", "z", "normal_x", "normal_y", "normal_z", "sigma")
        self.map_publisher.publish(cloud(self.text["odom_frame"], stamp_ns, names, data))

    def on_save_map(self, _: Trigger.Request, answer: Trigger.Response) -> Trigger.Response:
        return self.write("map_file", self.adapter.map_file(str(self.path("map_file"))), answer) if self.adapter else answer

    def on_load_map(self, _: Trigger.Request, answer: Trigger.Response) -> Trigger.Response:
        error = self.load_map() if self.adapter else "no data yet"
        answer.success, answer.message = not error, error or f"localises in {self.path('prior_map_file')}"
        return answer

    def on_save_calibration(self, _: Trigger.Request, answer: Trigger.Response) -> Trigger.Response:
        return self.write("calibration_file", self.adapter.calibration_yaml().encode(), answer) if self.adapter else answer


class RollingNode(OdometryNode):
    """Runs RollingOdometry. The topic is imu for one IMU, or imu_1 to imu_4 for several IMUs. T_base_imu has seven numbers for each IMU."""

    def __init__(self) -> None:
        super().__init__("rolling_odometry")
        given = self.numbers(_tumble.RollingAdapter.parameters())
        poses = list(self.text["T_base_imu"])
        count = len(poses) // 7
        if count < 1 or len(poses) % 7 > 0:
            raise ValueError(f"parameter T_base_imu has {len(poses)} numbers; it must have 7 for each IMU: x y z qx qy qz qw")
        self.adapter = _tumble.RollingAdapter(self, given, self.text["imu_sheet"], [poses[7 * k:7 * k + 7] for k in range(count)])
        self.inputs = [(Imu, "imu" if count == 1 else f"imu_{unit + 1}", functools.partial(self.on_imu, unit), IMU_DEPTH) for unit in range(count)]

    def on_imu(self, unit: int, message: Imu) -> None:
        w, f = message.angular_velocity, message.linear_acceleration
        self.report(f"imu {unit + 1}", self.adapter.on_imu(unit, to_ns(message.header.stamp), w.x, w.y, w.z, f.x, f.y, f.z))


NODES: dict[str, type[TumblingNode] | type[RollingNode]] = {"tumbling": TumblingNode, "rolling": RollingNode}


def main(words: Sequence[str]) -> int:
    """Runs the node until Ctrl-C. Returns 2 for a wrong parameter."""
    if len(words) < 2 or words[1] not in NODES:
        print(f"usage: python -m tumble.ros {'|'.join(NODES)} [--ros-args -p NAME:=VALUE -r TOPIC:=TOPIC ...]", file=sys.stderr)
        return 2
    rclpy.init(args=list(words))
    node = None
    try:
        node = NODES[words[1]]()
        rclpy.spin(node)
    except (ValueError, RuntimeError) as error:
        print(f"tumble.ros: {error}", file=sys.stderr)
        return 2
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        if node is not None:
            node.adapter = None  # node and adapter refer to each other
        if rclpy.ok():
            rclpy.shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
