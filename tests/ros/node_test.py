#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs `python -m tumble.ros` as a process on one core, plays recordings to it, and compares what it publishes with the library.

node_test.py TUMBLE ROLL FOLDER    TUMBLE and ROLL are recordings of the rig and of the sphere; FOLDER receives the logs. The node for the rig is
                                   killed between two plays; the results of both plays must be equal. A third play starts at a
                                   message initialpose, and has position readings.
"""
import json
import pathlib
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import rclpy
import rclpy.parameter
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rcl_interfaces.srv import SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Imu, PointCloud2
from std_srvs.srv import Trigger

import tumble
from tumble import _tumble
from play import POINTS, WORLD_IN_MAP_M, messages

HERE = pathlib.Path(__file__).parent
SHEETS = {"imu_sheet": "mti30", "lidar_sheet": "rs16"}  # of EXAMPLE
EXAMPLE = pathlib.Path(__file__).parents[2] / "ros/config/robot.yaml"
LAG_S, SWEEP_S, SAMPLE_S = 0.2, 0.1, 0.01  # default of lag_s; periods of the recording's lidar and IMU
START = [10.0, 20.0, 1.0, 0.0, 0.0, 0.4794255386042030, 0.8775825618903728]  # heading of 1 rad


def stamp_of(message) -> int:
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec


def sample_of(message) -> tuple:
    w, f = message.angular_velocity, message.linear_acceleration
    return stamp_of(message), w.x, w.y, w.z, f.x, f.y, f.z


def pose_numbers(T: np.ndarray) -> list[float]:
    """Returns x y z qx qy qz qw of a pose."""
    # quaternion as the eigenvector of the largest eigenvalue (I. Bar-Itzhack, J. Guidance 23, 2000)
    R = T[:3, :3]
    K = np.zeros((4, 4))
    K[:3, :3] = R + R.T - np.trace(R) * np.eye(3)
    K[:3, 3] = K[3, :3] = [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]
    K[3, 3] = np.trace(R)
    return [*T[:3, 3].tolist(), *np.linalg.eigh(K / 3.0)[1][:, 3].tolist()]


class Expected:
    """Returns the expected messages, from an adapter in this process that gets the same messages in order of time."""

    def __init__(self) -> None:
        self.poses, self.rates, self.sweeps, self.located, self.delays_s = {}, {}, {}, {}, []
        self.sample_ns = 0

    def tumble(self, recording, parameters: dict, topics: tuple = ("imu", "points"), start: tuple = ()) -> "Expected":
        lists = [parameters.get(key, []) for key in ("own_body", "position_arm", "T_base_imu", "T_base_lidar")]
        adapter = _tumble.TumblingAdapter(self, {"lever_arm_m": parameters["lever_arm_m"]}, *SHEETS.values(), "", *lists)
        if start:
            assert adapter.reset(list(start)) == ""
        for time_ns, topic, message in messages(recording, topics):
            if topic == "imu":
                self.sample_ns = time_ns
                assert adapter.on_imu(*sample_of(message)) == ""
            elif topic == "position":
                p, covariance = message.pose.pose.position, message.pose.covariance
                assert adapter.on_position(time_ns, [p.x, p.y, p.z], [covariance[6 * i + j] for i in range(3) for j in range(3)]) == ""
            else:
                fields = [(each.name, each.offset, each.datatype, each.count) for each in message.fields]
                assert adapter.on_cloud(stamp_of(message), 1, message.width, fields, False, message.point_step, message.row_step, message.data) == ""
        return self

    def roll(self, recording, parameters: dict) -> "Expected":
        adapter = _tumble.RollingAdapter(self, {"radius_m": parameters["radius_m"]}, parameters["imu_sheet"], [parameters["T_base_imu"]])
        for _, _, message in messages(recording, ("imu",)):
            assert adapter.on_imu(0, *sample_of(message)) == ""
        return self

    def wants(self, output: str) -> bool:
        return output == "points"

    def position_pose(self, odometry) -> None:
        self.located[odometry.stamp_ns] = (odometry.position, odometry.orientation, odometry.pose_covariance)

    def odometry(self, odometry) -> None:
        self.delays_s.append(1e-9 * (self.sample_ns - odometry.stamp_ns))
        self.poses[odometry.stamp_ns] = (odometry.position, odometry.orientation, odometry.pose_covariance, odometry.twist, odometry.twist_covariance)

    def imu(self, recovered) -> None:
        self.rates[recovered.stamp_ns] = (recovered.rate, recovered.covariance, recovered.force)

    def points(self, stamp_ns: int, data: bytes) -> None:
        self.sweeps[stamp_ns] = data

    def diagnostics(self, *_) -> None:
        pass


class Received:
    """Stores all messages that the node publishes, with their times of arrival."""

    def __init__(self, node, name: str) -> None:
        self.poses, self.newest, self.rates, self.sweeps, self.maps, self.counts, self.located = {}, {}, {}, {}, [], {}, {}
        quality = QoSProfile(depth=5000)
        self.subscriptions = [
            node.create_subscription(Odometry, f"{name}/odom", lambda m: self.poses.setdefault(stamp_of(m), (m, time.monotonic())), quality),
            node.create_subscription(Odometry, f"{name}/odom_imu", lambda m: self.newest.setdefault(stamp_of(m), (m, time.monotonic())), quality),
            node.create_subscription(Imu, f"{name}/imu", lambda m: self.rates.setdefault(stamp_of(m), m), quality),
            node.create_subscription(PointCloud2, f"{name}/points", lambda m: self.sweeps.setdefault(stamp_of(m), m.data.tobytes()), quality),
            node.create_subscription(PointCloud2, f"{name}/map", self.maps.append, quality),
            node.create_subscription(PoseWithCovarianceStamped, f"{name}/pose", lambda m: self.located.setdefault(stamp_of(m), m), quality),
            node.create_subscription(DiagnosticArray, "/diagnostics", self.diagnose, quality)]

    def diagnose(self, message) -> None:
        self.counts = {each.key: each.value for each in message.status[0].values}

    def close(self, node) -> None:
        for subscription in self.subscriptions:
            node.destroy_subscription(subscription)


def start_node(kind: str, parameters: dict, log: pathlib.Path) -> subprocess.Popen:
    words = [word for key, value in parameters.items() for word in ("-p", f"{key}:={json.dumps(value) if isinstance(value, list) else value}")]
    command = ["taskset", "-c", "0", sys.executable, "-m", "tumble.ros", kind, "--ros-args", *(["--params-file", str(EXAMPLE)] if kind == "tumbling" else []), *words]
    with log.open("w") as file:
        return subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT)


def differences(expected: Expected, received: Received) -> list[str]:
    out = []
    for name, want, got in (("odom", expected.poses, received.poses), ("imu", expected.rates, received.rates)):
        if missing := set(want) - set(got):
            out.append(f"{name}: {len(missing)} of {len(want)} messages are missing, the first at {min(missing)} ns")
    if missing := set(expected.sweeps) - set(received.sweeps):
        out.append(f"points: {len(missing)} of {len(expected.sweeps)} sweeps are missing")
    for stamp, (position, orientation, covariance, twist, twist_covariance) in expected.poses.items():
        message = received.poses.get(stamp, (None,))[0]
        if message is None:
            continue
        p, q, v = message.pose.pose.position, message.pose.pose.orientation, message.twist.twist
        same = ([p.x, p.y, p.z] == position and [q.x, q.y, q.z, q.w] == orientation and list(message.pose.covariance) == covariance
                and [v.linear.x, v.linear.y, v.linear.z, v.angular.x, v.angular.y, v.angular.z] == twist
                and list(message.twist.covariance) == twist_covariance)
        if not same or message.header.frame_id != "odom" or message.child_frame_id != "base_link":
            out.append(f"odom at {stamp} ns differs: {[p.x, p.y, p.z]}, must be {position}")
    if int(received.counts.get("imu messages", 0)) == 0:
        out.append("diagnostics: no samples are counted")
    for stamp, (rate, covariance, force) in expected.rates.items():
        message = received.rates.get(stamp)
        if message is None:
            continue
        w, f = message.angular_velocity, message.linear_acceleration
        if [w.x, w.y, w.z] != rate or list(message.angular_velocity_covariance) != covariance or [f.x, f.y, f.z] != force:
            out.append(f"imu at {stamp} ns differs: {[w.x, w.y, w.z]}, must be {rate}")
    if set(expected.located) != set(received.located):
        out.append(f"pose: {len(received.located)} messages, must be {len(expected.located)} with the same stamps")
    for stamp, message in received.located.items():
        p, q = message.pose.pose.position, message.pose.pose.orientation
        if ([p.x, p.y, p.z], [q.x, q.y, q.z, q.w], list(message.pose.covariance)) != expected.located.get(stamp) or message.header.frame_id != "map":
            out.append(f"pose at {stamp} ns differs")
    out += [f"points at {stamp} ns differ" for stamp, data in expected.sweeps.items() if received.sweeps.get(stamp, data) != data]
    return out


def latencies_s(sent: list, got: dict) -> np.ndarray:
    """Returns the delays between sending a message and receiving the pose at its end."""
    times, ends = np.array([at for at, _ in sent]), np.array([when for _, when in sent])
    return np.array([when - ends[np.abs(times - stamp).argmin()] for stamp, (_, when) in got.items()])


def shown(waits_s: np.ndarray) -> str:
    return f"median {1e3 * np.median(waits_s):.1f} ms, largest {1e3 * waits_s.max():.1f} ms, n = {len(waits_s)}"


def late(turn: str, sent: dict, received: Received) -> list[str]:
    """Compares the median latency of odom with lag_s and one sweep. The load of the computer delays odom and odom_imu alike, and odom_imu
    has no lag, so the median latency of odom_imu is subtracted."""
    sweeps, samples = latencies_s(sent["points"], received.poses), latencies_s(sent["imu"], received.newest)
    print(f"{turn}: latency of odom {shown(sweeps)}; of odom_imu {shown(samples)}")
    more_s = np.median(sweeps) - np.median(samples)
    return [f"{turn}: odom is {more_s:.3f} s later than odom_imu; must be at most {LAG_S + SWEEP_S} s"] if more_s > LAG_S + SWEEP_S else []


def request(node, kind, service: str, content):
    client = node.create_client(kind, service)
    assert client.wait_for_service(20.0), f"no service {service}"
    answer = client.call_async(content)
    deadline = time.monotonic() + 20.0
    while not answer.done() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert answer.done(), f"service {service} does not answer"
    return answer.result()


def call(node, name: str, service: str) -> Trigger.Response:
    return request(node, Trigger, f"{name}/{service}", Trigger.Request())


def set_text(node, name: str, parameter: str, value: str) -> None:
    content = SetParameters.Request(parameters=[rclpy.parameter.Parameter(parameter, value=value).to_parameter_msg()])
    result = request(node, SetParameters, f"{name}/set_parameters", content).results[0]
    assert result.successful, result.reason


def wait_for_node(node, name: str, topics: tuple, process: subprocess.Popen) -> None:
    """Waits until the listener knows the publishers of the node. The player waits for the node's subscriptions."""
    deadline = time.monotonic() + 30.0
    while any(node.count_publishers(f"{name}/{topic}") == 0 for topic in topics):
        assert process.poll() is None and time.monotonic() < deadline, "the node does not publish, see its log"
        time.sleep(0.1)


def play(recording: pathlib.Path, folder: pathlib.Path, name: str, *topics: str) -> dict:
    sent = folder / f"{name}_sent.json"
    subprocess.run([sys.executable, str(HERE / "play.py"), str(recording), str(sent), *topics], check=True, timeout=120)
    return json.loads(sent.read_text())


def rig_parameters(recording) -> dict:
    box = [x for corner in tumble.processing.RIG_BODY_L for x in corner]
    return {"lever_arm_m": list(map(float, recording.imus[0].lever_arm_m)), "own_body": box, "T_base_imu": [0.0] * 6 + [1.0],
            "T_base_lidar": pose_numbers(recording.T_IL), "tf": "none"}


def tumble_problems(node, path: pathlib.Path, folder: pathlib.Path) -> list[str]:
    """Plays the rig twice, with SIGKILL between the plays."""
    name, recording, problems = "/tumbling_odometry", tumble.read(path, truth=False), []
    parameters = rig_parameters(recording) | {"map_file": str(folder / "map.tumblemap"), "calibration_file": str(folder / "calibration.yaml")}
    expected = Expected().tumble(recording, parameters)
    assert len(expected.poses) > 20 and len(expected.rates) > 300, (len(expected.poses), len(expected.rates))
    # in the time of the messages, the latency does not depend on the load: a sweep is published with the sample that completes its lag
    assert max(expected.delays_s) <= LAG_S + SAMPLE_S, max(expected.delays_s)
    for turn in ("first", "after_kill"):
        received = Received(node, name)
        process = start_node("tumbling", parameters, folder / f"{turn}.log")
        wait_for_node(node, name, ("odom", "odom_imu", "imu", "points", "map"), process)
        sent = play(path, folder, turn, "imu", "points")
        problems += [f"{turn}: {each}" for each in differences(expected, received)]
        lost = [len(set(want) - set(got)) for want, got in ((expected.sweeps, received.sweeps), (expected.rates, received.rates))]
        print(f"{turn}: {len(sent['points'])} clouds of {POINTS} points and {len(sent['imu'])} samples sent; "
              f"of {len(expected.sweeps)} deskewed sweeps {lost[0]} are missing, of {len(expected.rates)} rates {lost[1]}")
        problems += late(turn, sent, received)
        if turn == "first":
            problems += [f"{service}: {answer.message}" for service in ("save_map", "save_calibration")
                         if not (answer := call(node, name, service)).success]
            if not received.maps or received.maps[0].header.frame_id != "odom":
                problems.append("no map")
            if call(node, name, "load_map").success:
                problems.append("load_map: succeeds without a file")
            set_text(node, name, "prior_map_file", str(folder / "map.tumblemap"))
            if not (answer := call(node, name, "load_map")).success:
                problems.append(f"load_map: {answer.message}")
            if not (answer := call(node, name, "reset")).success:
                problems.append(f"reset: {answer.message}")
            process.send_signal(signal.SIGKILL)
            process.wait(20)
        else:
            problems += ended_well(process, folder / f"{turn}.log")
        received.close(node)
    # negative controls: the comparison detects another pose and a lost message
    if not problems:
        received.poses[next(iter(expected.poses))][0].pose.pose.position.x += 1e-9
        del received.rates[next(iter(expected.rates))]
        if len(differences(expected, received)) != 2:
            problems.append("a changed pose and a lost sample are not found")
    return problems


def position_problems(node, path: pathlib.Path, folder: pathlib.Path) -> list[str]:
    """Plays the rig from a start pose, with position readings of its centre of mass."""
    name, recording, topics = "/tumbling_odometry", tumble.read(path), ("imu", "points", "position")
    arm = np.linalg.inv(recording.imus[0].T_BI)[:3, 3]  # the base is the IMU
    parameters = rig_parameters(recording) | {"position_arm": arm.tolist()}
    expected = Expected().tumble(recording, parameters, topics, START)
    first = np.array(expected.poses[min(expected.poses)][0])
    assert np.linalg.norm(first - START[:3]) < 0.1, first
    assert len(expected.located) > 10, len(expected.located)
    end_ns = max(expected.located)
    x, y, z, w = expected.located[end_ns][1]
    u = np.array([x, y, z])
    antenna = np.array(expected.located[end_ns][0]) + arm + 2.0 * np.cross(u, np.cross(u, arm) + w * arm)
    error_m = np.linalg.norm(antenna - recording.truth.position[end_ns // recording.truth.period_ns] - WORLD_IN_MAP_M)
    print(f"positions: {len(expected.located)} poses in the frame of the positions; error of the last {error_m:.3f} m")
    problems = [] if error_m < 0.5 else [f"positions: the last pose in the frame of the positions is wrong by {error_m} m"]
    received = Received(node, name)
    process = start_node("tumbling", parameters, folder / "positions.log")
    wait_for_node(node, name, ("odom", "pose"), process)
    send_start(node)
    sent = play(path, folder, "positions", *topics)
    problems += [f"positions: {each}" for each in differences(expected, received)] + late("positions", sent, received)
    problems += ended_well(process, folder / "positions.log")
    received.close(node)
    return problems


def send_start(node) -> None:
    """Publishes START before the play. After SIGKILL, the subscription of the killed node remains for about 20 s, so the function first waits for
    the end of this subscription."""
    publisher = node.create_publisher(PoseWithCovarianceStamped, "initialpose", 1)
    deadline = time.monotonic() + 60.0
    while publisher.get_subscription_count() != 1:
        assert time.monotonic() < deadline, f"initialpose has {publisher.get_subscription_count()} subscriptions, must be 1"
        time.sleep(0.1)
    message = PoseWithCovarianceStamped()
    p, q = message.pose.pose.position, message.pose.pose.orientation
    p.x, p.y, p.z, q.x, q.y, q.z, q.w = START
    for _ in range(15):
        publisher.publish(message)
        time.sleep(0.2)
    node.destroy_publisher(publisher)


def roll_problems(node, path: pathlib.Path, folder: pathlib.Path) -> list[str]:
    """Plays the first IMU of the sphere."""
    name, recording = "/rolling_odometry", tumble.read(path, truth=False)
    parameters = {"imu_sheet": "phidget1044", "radius_m": recording.sphere_radius_m, "T_base_imu": pose_numbers(recording.imus[0].T_BI), "tf": "none"}
    expected = Expected().roll(recording, parameters)
    assert len(expected.poses) > 1000, len(expected.poses)
    received = Received(node, name)
    process = start_node("rolling", parameters, folder / "rolling.log")
    wait_for_node(node, name, ("odom", "odom_imu"), process)
    play(path, folder, "rolling", "imu")
    problems = [f"rolling: {each}" for each in differences(expected, received)] + ended_well(process, folder / "rolling.log")
    print(f"rolling: {len(set(expected.poses) - set(received.poses))} of {len(expected.poses)} poses are missing")
    received.close(node)
    return problems


def ended_well(process: subprocess.Popen, log: pathlib.Path) -> list[str]:
    """Stops the node by Ctrl-C. A node without errors exits with 0 and an empty log."""
    process.send_signal(signal.SIGINT)
    status = process.wait(20)
    return [f"{log}: the node ended with {status} and reports {text[:300]}"] if (text := log.read_text()) or status != 0 else []


def main(tumbled: pathlib.Path, rolled: pathlib.Path, folder: pathlib.Path) -> int:
    folder.mkdir(parents=True, exist_ok=True)
    rclpy.init()
    node = rclpy.create_node("listener")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    spinning = threading.Thread(target=executor.spin)
    spinning.start()
    try:
        problems = tumble_problems(node, tumbled, folder) + position_problems(node, tumbled, folder) + roll_problems(node, rolled, folder)
    finally:
        executor.shutdown()
        spinning.join()
        rclpy.shutdown()
    for problem in problems[:20]:
        print(f"node_test: {problem}", file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*map(pathlib.Path, sys.argv[1:])))
