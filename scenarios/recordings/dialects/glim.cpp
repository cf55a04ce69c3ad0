// SPDX-License-Identifier: BSD-3-Clause
// The file describes GLIM (koide3/glim and koide3/glim_ros2, MIT).
#include <nlohmann/json.hpp>

#include "scenarios/recordings/dialects/dialect.hpp"

namespace tumble::scenarios {

namespace {

ReaderNames glim_names(const SensorFacts&) {
  return {"/os_cloud_node/imu", "imu", "/os_cloud_node/points", "lidar", "base_link", ""};
}

/// Returns the noise density of the data sheet, or the value of the authors if the data sheet lacks it.
double density(double stated, double authors) {
  return stated > 0.0 ? stated : authors;
}

std::vector<ConfigurationFile> glim_configuration(const SensorFacts& facts, const ReaderNames& names) {
  const Eigen::Isometry3d T_LI = facts.T_IL().inverse(Eigen::Isometry);
  const Eigen::Quaterniond q = Eigen::Quaterniond(T_LI.linear()).normalized();
  const Eigen::Vector3d p = T_LI.translation();
  nlohmann::ordered_json ros, sensors;
  ros["glim_ros"] = {{"imu_time_offset", 0.0},
                     {"acc_scale", 1.0},
                     {"imu_topic", names.imu_topic},
                     {"points_topic", names.points_topic},
                     {"image_topic", "/image"}};
  sensors["sensors"] = {{"imu_acc_noise", density(facts.imu->accel_noise_m_s2_sqrt_hz, 0.05)},
                        {"imu_gyro_noise", density(facts.imu->gyro_noise_rad_s_sqrt_hz, 0.02)},
                        {"imu_int_noise", 0.001},
                        {"imu_bias_noise", 0.001},
                        {"global_shutter_lidar", false},
                        {"T_lidar_imu", {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}}};
  return {{"config_ros.json", ros.dump(2) + "\n"}, {"config_sensors.json", sensors.dump(2) + "\n"}};
}

}  // namespace

Dialect glim_dialect() {
  Dialect out{"glim", "rosbag2", "bag"};
  out.takes_empty = false;
  out.names = glim_names;
  out.sweeps = ouster_layout;
  out.configuration = glim_configuration;
  out.run =
      "copy these two files into a copy of glim/config; ros2 run glim_ros glim_rosbag bag --ros-args -p "
      "config_path:=COPY";
  out.notes = {
      "imu_acc_noise and imu_gyro_noise are the densities of the data sheet; the authors' values 0.05 and 0.02 are "
      "larger"};
  out.sources = {
      {"koide3/glim", "include/glim/util/ros_cloud_converter.hpp", "0d7f61304db1fdd1e320e4f013fe05cf446f3cd4"},
      {"koide3/glim", "config/config_sensors.json", "d01f6872de4bca40fed0f43da92aab70562c2194"},
      {"koide3/glim", "config/config_ros.json", "ab8854528ea970bd14c585ada9a1118ca6eaab3e"},
      {"koide3/glim_ros2", "src/glim_rosbag.cpp", "013e78184a8e7aa0cfa2cd7678cafe0e79f07b9c"}};
  return out;
}

}  // namespace tumble::scenarios
