# SPDX-License-Identifier: BSD-3-Clause
"""Starts the node for a tumbling robot, and optionally a bag and RViz.

ros2 launch tumble_ros tumbling.launch.py params_file:=robot.yaml [bag:=FOLDER] [rviz:=true] [python:=true] [imu:=TOPIC] [points:=TOPIC]

Without imu or points, the launch file takes the only topic of the type, from the bag's metadata or from the running publishers.
"""
import pathlib
import sys
import time

import yaml
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

TYPES = {"imu": "sensor_msgs/msg/Imu", "points": "sensor_msgs/msg/PointCloud2"}
SEARCH_S = 5.0  # the discovery of topics takes a second or two


def topics_of_bag(bag: str) -> list[tuple[str, str]]:
    """Returns (name, type) of the topics of a ROS 2 bag."""
    information = yaml.safe_load((pathlib.Path(bag) / "metadata.yaml").read_text())["rosbag2_bagfile_information"]
    listed = [each["topic_metadata"] for each in information["topics_with_message_count"]]
    return [(each["name"], each["type"]) for each in listed]


def topics_of_robot() -> list[tuple[str, str]]:
    import rclpy

    rclpy.init()
    node = rclpy.create_node("tumble_topics")
    found: list[tuple[str, str]] = []
    deadline = time.monotonic() + SEARCH_S
    while time.monotonic() < deadline:
        time.sleep(0.2)
        found = [(name, kind) for name, kinds in node.get_topic_names_and_types() for kind in kinds if node.count_publishers(name) > 0]
        if all(any(kind == wanted for _, kind in found) for wanted in TYPES.values()):
            break
    node.destroy_node()
    rclpy.shutdown()
    return found


def only_topic(argument: str, topics: list[tuple[str, str]]) -> str:
    """Returns the only topic of the type. The error names the candidates."""
    found = [name for name, kind in topics if kind == TYPES[argument] and not name.startswith("/tumbling_odometry/")]
    if len(found) != 1:
        raise RuntimeError(f"{len(found)} topics of type {TYPES[argument]} ({', '.join(found) or 'none'}): name one with {argument}:=TOPIC")
    print(f"tumble_ros: {argument} is {found[0]}", file=sys.stderr)
    return found[0]


def start(context, *_):
    value = {name: LaunchConfiguration(name).perform(context) for name in ("params_file", "bag", "rviz", "python", "imu", "points")}
    if not value["imu"] or not value["points"]:
        topics = topics_of_bag(value["bag"]) if value["bag"] else topics_of_robot()
        value |= {name: value[name] or only_topic(name, topics) for name in TYPES}
    parameters = [{"use_sim_time": bool(value["bag"])}] + ([value["params_file"]] if value["params_file"] else [])
    remappings = [(name, value[name]) for name in TYPES]
    if value["python"] == "true":
        words = [word for name, to in remappings for word in ("-r", f"{name}:={to}")]
        words += ["-p", f"use_sim_time:={bool(value['bag'])}"] + (["--params-file", value["params_file"]] if value["params_file"] else [])
        actions = [ExecuteProcess(cmd=[sys.executable, "-m", "tumble.ros", "tumbling", "--ros-args", *words], output="screen")]
    else:
        actions = [Node(package="tumble_ros", executable="tumbling_node", name="tumbling_odometry", parameters=parameters, remappings=remappings,
                        output="screen")]
    if value["bag"]:
        actions.append(ExecuteProcess(cmd=["ros2", "bag", "play", value["bag"], "--clock"], output="screen"))
    if value["rviz"] == "true":
        layout = pathlib.Path(get_package_share_directory("tumble_ros")) / "config" / "tumbling.rviz"
        actions.append(Node(package="rviz2", executable="rviz2", arguments=["-d", str(layout)]))
    return actions


def generate_launch_description() -> LaunchDescription:
    described = {"params_file": "parameters of the node", "bag": "folder of a ROS 2 bag to play", "rviz": "true: start RViz",
                 "python": "true: start python -m tumble.ros", "imu": "IMU topic", "points": "PointCloud2 topic"}
    return LaunchDescription([*(DeclareLaunchArgument(name, default_value="", description=text) for name, text in described.items()),
                              OpaqueFunction(function=start)])
