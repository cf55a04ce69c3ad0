// SPDX-License-Identifier: BSD-3-Clause
// The file describes the recording format of KISS-ICP (PRBonn/kiss-icp, MIT).
#include <fmt/format.h>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/yaml_numbers.hpp"

namespace tumble::scenarios {

namespace {

ReaderNames kiss_icp_names(const SensorFacts&) {
  return {"/imu", "imu", "/lidar/points", "lidar", "base_link", ""};
}

std::vector<ConfigurationFile> kiss_icp_configuration(const SensorFacts& facts, const ReaderNames&) {
  const std::string text = fmt::format(R"(# all other values are the authors' defaults
data:
  deskew: {}
  min_range: {}   # m; excludes the robot itself
)",
                                       facts.lidar->timed, decimal(facts.lidar->own_body_m));
  return {{"kiss_icp.yaml", text}};
}

}  // namespace

Dialect kiss_icp_dialect() {
  // KISS-ICP 1.3.0 reads ROS 1 bags, and ROS 2 bags with message definitions, with packages from PyPI only. In MCAP
  // files, mcap-ros2-support 0.5.7 and 0.6.0 cannot find the point fields.
  Dialect out{"kiss-icp", "rosbag1", "recording.bag"};
  out.needs_imu = out.needs_times = false;
  out.takes_empty = false;
  out.names = kiss_icp_names;
  out.sweeps = ouster_layout;
  out.configuration = kiss_icp_configuration;
  out.run = "kiss_icp_pipeline --topic /lidar/points --config kiss_icp.yaml recording.bag";
  out.notes = {
      "pip install kiss-icp pyyaml rosbags: PyYAML reads its configuration and rosbags reads bags, but kiss-icp does "
      "not install them",
      "KISS-ICP converts point times to a share of the sweep; its poses are the poses at the last point of a sweep",
      "max_range is 100 m, as in the authors' configuration; the voxel size is a hundredth of max_range"};
  out.sources = {
      {"PRBonn/kiss-icp", "python/kiss_icp/tools/point_cloud2.py", "f396813d0806980a08b701f6fab73bb63a8d65ce"},
      {"PRBonn/kiss-icp", "python/kiss_icp/datasets/rosbag.py", "02c2fce874aa90ff59a3d2a8f5162557912fac88"},
      {"PRBonn/kiss-icp", "python/kiss_icp/config/config.py", "0a9b916b37a2d0345bd8071e1a4fa1342a892fa4"},
      {"PRBonn/kiss-icp", "python/kiss_icp/config/parser.py", "072df9ca7b72dedefb1b89ab949735e3fd23004a"}};
  return out;
}

}  // namespace tumble::scenarios
