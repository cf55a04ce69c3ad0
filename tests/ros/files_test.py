#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the launch file, the layouts and the example parameters of the ROS 2 package without ROS.

files_test.py TREE    runs the launch file with stand-ins of `launch`, which record the arguments of each action, and compares all topics
                      in the layouts with the topics of the nodes.
"""
import json
import pathlib
import py_compile
import re
import sys
import tempfile
import types

import yaml

TREE = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
ROS = TREE / "ros"
BAG = {"rosbag2_bagfile_information": {"topics_with_message_count": [
    {"topic_metadata": {"name": name, "type": kind}}
    for name, kind in (("/imu/data", "sensor_msgs/msg/Imu"), ("/front/points", "sensor_msgs/msg/PointCloud2"), ("/tf", "tf2_msgs/msg/TFMessage"))]}}


class Action:
    """Records its arguments."""

    def __init__(self, *words, **named):
        self.words, self.named = words, named


class Configuration(Action):
    def perform(self, context):
        return context[self.words[0]]


def stand_ins() -> None:
    names = {"launch": {"LaunchDescription": Action}, "launch.actions": {name: type(name, (Action,), {}) for name in ("DeclareLaunchArgument", "ExecuteProcess", "OpaqueFunction")},
             "launch.substitutions": {"LaunchConfiguration": Configuration}, "launch_ros": {}, "launch_ros.actions": {"Node": type("Node", (Action,), {})},
             "ament_index_python": {}, "ament_index_python.packages": {"get_package_share_directory": lambda package: str(TREE / {"tumble_ros": "ros"}[package])}}
    for name, members in names.items():
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(members)


def launch_file(folder: pathlib.Path):
    path = ROS / "launch/tumbling.launch.py"
    py_compile.compile(str(path), cfile=str(folder / "launch.pyc"), doraise=True)
    module = types.ModuleType("tumbling_launch")
    exec(compile(path.read_text(), str(path), "exec"), vars(module))
    return module


def check_launch(folder: pathlib.Path) -> None:
    stand_ins()
    launch = launch_file(folder)
    (folder / "metadata.yaml").write_text(yaml.safe_dump(BAG))
    described = launch.generate_launch_description().words[0]
    declared = [each.words[0] for each in described[:-1]]
    assert all(type(each).__name__ == "DeclareLaunchArgument" and each.named["default_value"] == "" and each.named["description"] for each in described[:-1])
    assert described[-1].named["function"] is launch.start, "the last entity starts the node"

    def start(**given: str) -> list:
        return launch.start(dict.fromkeys(declared, "") | given)  # a missing declaration is a KeyError

    executables = set(re.findall(r"EXECUTABLE (\w+)", (ROS / "CMakeLists.txt").read_text()))
    names = set(re.findall(r'OdometryNode\("(\w+)"', "".join(each.read_text() for each in (ROS / "nodes").glob("*.cpp"))))
    node, bag = start(bag=str(folder), params_file="robot.yaml")
    assert node.named["package"] == "tumble_ros" and node.named["executable"] in executables and node.named["name"] in names, node.named
    assert dict(node.named["remappings"]) == {"imu": "/imu/data", "points": "/front/points"}, node.named["remappings"]
    assert node.named["parameters"] == [{"use_sim_time": True}, "robot.yaml"]
    assert bag.named["cmd"] == ["ros2", "bag", "play", str(folder), "--clock"]
    node, rviz = start(imu="/a", points="/b", rviz="true")
    assert dict(node.named["remappings"]) == {"imu": "/a", "points": "/b"} and node.named["parameters"] == [{"use_sim_time": False}]
    assert rviz.named["package"] == "rviz2" and pathlib.Path(rviz.named["arguments"][1]).is_file(), rviz.named
    (python,) = start(imu="/a", points="/b", python="true", params_file="robot.yaml")
    command = python.named["cmd"]
    assert command[:4] == [sys.executable, "-m", "tumble.ros", "tumbling"] and (TREE / "python/src/tumble/ros.py").is_file()
    assert command[4:] == ["--ros-args", "-r", "imu:=/a", "-r", "points:=/b", "-p", "use_sim_time:=False", "--params-file", "robot.yaml"], command
    BAG["rosbag2_bagfile_information"]["topics_with_message_count"].append({"topic_metadata": {"name": "/imu/raw", "type": "sensor_msgs/msg/Imu"}})
    (folder / "metadata.yaml").write_text(yaml.safe_dump(BAG))
    try:
        start(bag=str(folder))
    except RuntimeError as error:
        assert "/imu/data, /imu/raw" in str(error), error
    else:
        raise AssertionError("two IMU topics must be an error")


def topics() -> set:
    """Returns the topics that the nodes publish or subscribe to, from the source of the Python node."""
    source = (TREE / "python/src/tumble/ros.py").read_text()
    named = re.findall(r'create_(?:publisher|subscription)\(\w+, "([^"]+)"', source)
    assert len(named) >= 7, named
    return {name.replace("~", "/tumbling_odometry") if name[0] in "~/" else f"/{name}" for name in named}


def check_layouts() -> None:
    known = topics()
    rviz = yaml.safe_load((ROS / "config/tumbling.rviz").read_text())["Visualization Manager"]
    shown = [each["Topic"]["Value"] for each in [*rviz["Displays"], *rviz["Tools"]] if "Topic" in each]
    assert len(shown) == 4 and set(shown) <= known, set(shown) - known
    assert rviz["Global Options"]["Fixed Frame"] == "odom"
    latched = [each["Topic"]["Durability Policy"] for each in rviz["Displays"] if each.get("Name") == "Map"]
    assert latched == ["Transient Local"], latched
    foxglove = json.loads((ROS / "config/foxglove.json").read_text())
    panels = foxglove["configById"]

    def placed(layout) -> set:
        return {layout} if isinstance(layout, str) else placed(layout["first"]) | placed(layout["second"])

    assert placed(foxglove["layout"]) == set(panels), "each panel is placed once"
    shown = [*panels["3D!tumble"]["topics"], *(each["value"].split(".")[0] for each in panels["Plot!tumble"]["paths"]),
             panels["DiagnosticSummary!tumble"]["topicToRender"]]
    assert set(shown) <= known, set(shown) - known
    assert not {"/tumbling_odometry/nothing"} <= known, "negative control"


def check_example() -> None:
    example = yaml.safe_load((ROS / "config/robot.yaml").read_text())["/**"]["ros__parameters"]
    texts = set(re.findall(r'^ +\{"(\w+)",', (ROS / "src/node_params.cpp").read_text(), re.MULTILINE))
    assert {"imu_sheet", "T_base_lidar", "own_body"} <= texts, texts
    assert set(example) <= texts | {"lever_arm_m"}, set(example) - texts
    for name, length in (("lever_arm_m", 3), ("T_base_imu", 7), ("T_base_lidar", 7), ("own_body", 6)):
        assert len(example[name]) == length and all(isinstance(x, float) for x in example[name]), name


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        check_launch(pathlib.Path(scratch))
    check_layouts()
    check_example()
