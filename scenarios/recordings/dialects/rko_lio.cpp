// SPDX-License-Identifier: BSD-3-Clause
// The file describes RKO-LIO (PRBonn/rko_lio, MIT), with its Python program.
#include <fmt/format.h>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/yaml_numbers.hpp"

namespace tumble::scenarios {

namespace {

ReaderNames rko_lio_names(const SensorFacts&) {
  return {"/imu", "imu", "/lidar/points", "lidar", "base_link", ""};
}

std::vector<ConfigurationFile> rko_lio_configuration(const SensorFacts& facts, const ReaderNames&) {
  const std::string text = fmt::format(R"(# all other values are the authors' defaults
deskew: true
max_range: {}   # m, farthest return
min_range: {}   # m; excludes the robot itself
lidar_timestamps:
  multiplier_to_seconds: 1.0e-9   # t is in ns
  force_absolute: false
  force_relative: true            # times count from the stamp, even if the first return is late
extrinsic_imu2base_quat_xyzw_xyz: {}
extrinsic_lidar2base_quat_xyzw_xyz: {}
)",
                                       decimal(whole_metres(facts.lidar->farthest_m)), decimal(facts.lidar->own_body_m),
                                       quaternion_first(facts.T_BI), quaternion_first(facts.T_BL));
  return {{"rko_lio.yaml", text}};
}

}  // namespace

Dialect rko_lio_dialect() {
  Dialect out{"rko-lio", "rosbag2", "bag"};
  out.takes_empty = false;
  out.names = rko_lio_names;
  out.sweeps = ouster_layout;
  out.configuration = rko_lio_configuration;
  out.run = "rko_lio -c rko_lio.yaml --imu /imu --lidar /lidar/points bag";
  out.notes = {"RKO-LIO needs no noise parameters; its poses are those of base_link"};
  out.sources = {
      {"PRBonn/rko_lio", "rko_lio/core/process_timestamps.cpp", "2250832d5b20fd3cc9e41025da8e9660c24d3c98"},
      {"PRBonn/rko_lio", "rko_lio/python/rko_lio/config.py", "0a4d0eff6583054938b21cf8625e43e002031ccf"},
      {"PRBonn/rko_lio", "rko_lio/python/rko_lio/dataloaders/rosbag.py", "0a4d0eff6583054938b21cf8625e43e002031ccf"},
      {"PRBonn/rko_lio", "rko_lio/ros/utils/point_cloud_read.cpp", "534e0cab25592b5d8b219a2fa9118fb2ec2098b5"}};
  return out;
}

}  // namespace tumble::scenarios
