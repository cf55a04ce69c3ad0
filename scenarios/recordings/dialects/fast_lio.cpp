// SPDX-License-Identifier: BSD-3-Clause
// The file describes FAST-LIO2 (hku-mars/FAST_LIO, GPL-2), with facts about the interface and no text of its sources.
#include <fmt/format.h>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/yaml_numbers.hpp"

namespace tumble::scenarios {

namespace {

std::vector<ConfigurationFile> fast_lio_configuration(const SensorFacts& facts, const ReaderNames& names) {
  const ImuFacts& imu = *facts.imu;
  const LidarFacts& lidar = *facts.lidar;
  const Eigen::Isometry3d T_IL = facts.T_IL();
  const std::string file = lidar.livox ? "avia.yaml" : "velodyne.yaml";
  const std::string text = fmt::format(
      R"(# replaces config/{file}; numbers without a comment are the authors' defaults
common:
  lid_topic: "{points}"
  imu_topic: "{imu}"
  time_sync_en: false
  time_offset_lidar_to_imu: 0.0    # one clock
preprocess:
  lidar_type: {type}                    # 1 Livox CustomMsg, 2 Velodyne
  scan_line: {rings}                    # rings of this lidar
  scan_rate: {scan_rate}
  timestamp_unit: {unit}                # unit of a Velodyne's point times: 0 is s; a CustomMsg has ns
  blind: {blind}                       # m; excludes the robot itself
mapping:
  acc_cov: 0.1                      # variance of a sample by the data sheet: {acc_var}
  gyr_cov: 0.1                      # variance of a sample by the data sheet: {gyr_var}
  b_acc_cov: 0.0001
  b_gyr_cov: 0.0001
  fov_degree: 180.0
  det_range: {range}                 # m, farthest return
  extrinsic_est_en: false
  extrinsic_T: {T}   # pose of the lidar in the IMU, m
  extrinsic_R: {R}
publish:
  path_en: false
  scan_publish_en: true
  dense_publish_en: true
  scan_bodyframe_pub_en: true
pcd_save:
  pcd_save_en: false
  interval: -1
)",
      fmt::arg("file", file), fmt::arg("points", names.points_topic), fmt::arg("imu", names.imu_topic),
      fmt::arg("type", lidar.livox ? 1 : 2), fmt::arg("rings", lidar.rings),
      fmt::arg("scan_rate", std::lround(1.0 / lidar.period_s)), fmt::arg("unit", lidar.livox ? 3 : 0),
      fmt::arg("blind", decimal(lidar.own_body_m)),
      fmt::arg("acc_var", decimal(imu.accel_noise_m_s2_sqrt_hz * imu.accel_noise_m_s2_sqrt_hz / imu.period_s)),
      fmt::arg("gyr_var", decimal(imu.gyro_noise_rad_s_sqrt_hz * imu.gyro_noise_rad_s_sqrt_hz / imu.period_s)),
      fmt::arg("range", decimal(whole_metres(lidar.farthest_m))), fmt::arg("T", translation_of(T_IL)),
      fmt::arg("R", rotation_of(T_IL)));
  return {{file, text}};
}

}  // namespace

Dialect fast_lio_dialect() {
  Dialect out{"fast-lio", "rosbag1", "recording.bag"};
  out.names = fast_lio_names;
  out.sweeps = fast_lio_layout;
  out.configuration = fast_lio_configuration;
  out.run = "roslaunch fast_lio mapping_velodyne.launch (mapping_avia.launch of a Livox); rosbag play recording.bag";
  out.notes = {"FAST-LIO has no saturation model and treats clipped gyro readings as valid"};
  out.sources = {{"hku-mars/FAST_LIO", "src/preprocess.h", "19f2212d16c4ec77e160fe81c3af0d3ea931196a"},
                 {"hku-mars/FAST_LIO", "src/preprocess.cpp", "0a3abe53558847d3981270a24c48677b231fa4cd"},
                 {"hku-mars/FAST_LIO", "src/laserMapping.cpp", "34b50d95da57b240d53e100298a6386aadad81ba"},
                 {"hku-mars/FAST_LIO", "config/velodyne.yaml", "2dc53daee3de5ef8d4f234f0b15625785b153ea4"},
                 {"hku-mars/FAST_LIO", "msg/CustomMsg.msg", "fd54b862260b8b30439eec1b5aff345243425d29"}};
  return out;
}

}  // namespace tumble::scenarios
