#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the node of the Python package with ROS 2 from PyPI and compares it with the library. Checks the C++ nodes for errors.
#   node_test.sh TREE BUILD    BUILD contains bin/tumble; the environment (400 MB) and compiled files remain in BUILD/python and BUILD/ros_node
# If the kernel allows it, the nodes run in a separate network namespace, without other ROS nodes.
set -euo pipefail
tree=$1 build=$2 work=$2/ros_node
environment=$work/environment
mkdir -p "$work"
[ -x "$environment/bin/python" ] || /usr/bin/python3 -m venv "$environment"
pip() { "$environment/bin/python" -m pip install --quiet --disable-pip-version-check "$@"; }
pip -r "$tree/tests/ros/requirements.txt"
"$tree/python/make_wheel" "$build/python/wheel"
wheel=$(echo "$build"/python/wheel/dist/*.whl)
pip --force-reinstall --no-deps "$wheel"
pip "$wheel[files]"

# compiles the C++ nodes with the real messages, and with declarations of the parts of rclcpp that they use
check() { g++ -std=c++20 -fsyntax-only -Wall -Werror -I "$work/stand_in" -I "$tree/ros/include" -I "$tree/estimator/include" -isystem /usr/include/eigen3 "${messages[@]}" "$1"; }
messages=()
for folder in "$environment"/include/*/; do messages+=(-isystem "$folder"); done
for header in rclcpp/rclcpp.hpp rclcpp_components/register_node_macro.hpp tf2_ros/{buffer,transform_listener,transform_broadcaster}.h; do
  mkdir -p "$work/stand_in/$(dirname "$header")"
  printf '#include "%s"\n' "$tree/tests/ros/rclcpp_stand_in.hpp" >"$work/stand_in/$header"
done
for node in "$tree"/ros/nodes/*.cpp; do check "$node"; done
sed 's/odometry.twist_B\[0\]/odometry.twist/' "$tree/ros/nodes/odometry_node.cpp" >"$work/wrong.cpp"  # negative control
cp "$tree/ros/nodes/odometry_node.hpp" "$work"
if check "$work/wrong.cpp" 2>/dev/null; then echo 'node_test: an error in a node is not found' >&2; exit 1; fi

# recordings of 6 s: a tumbling rig with a lidar of 16 rings and 1800 columns at 10 Hz, and a rolling sphere
for scenario in hill roll; do
  sed 's/^duration_s: .*$/duration_s: 6/' "$tree/scenarios/catalogue/$scenario.yaml" >"$work/$scenario.yaml"
  [ -f "$work/$scenario.h5" ] || "$build/bin/tumble" record "$work/$scenario.yaml" --seed 1001 -o "$work/$scenario.h5" --quiet
done

export ROS_DOMAIN_ID=77 RMW_IMPLEMENTATION=rmw_fastrtps_cpp ROS_LOG_DIR=$work/log PYTHONUNBUFFERED=1
run=("$environment/bin/python" "$tree/tests/ros/node_test.py" "$work/hill.h5" "$work/roll.h5" "$work")
cd "$work"
if unshare -rn true 2>/dev/null; then
  export ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET
  unshare -rn bash -c 'ip link set lo up multicast on && ip route add 239.0.0.0/8 dev lo && exec "$@"' bash "${run[@]}"
else
  export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST
  "${run[@]}"
fi
