// SPDX-License-Identifier: BSD-3-Clause
// The file describes Point-LIO (hku-mars/Point-LIO, GPL-2), with facts about the interface and no text of its sources.
#include <fmt/format.h>

#include <algorithm>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/yaml_numbers.hpp"

namespace tumble::scenarios {

namespace {

/// Returns the saturation threshold for the published estimator. If a reading exceeds the range in the data sheet, the
/// threshold is the largest reading.
double rail(double stated, double largest) {
  return std::max(stated, largest);
}

std::vector<ConfigurationFile> point_lio_configuration(const SensorFacts& facts, const ReaderNames& names) {
  const ImuFacts& imu = *facts.imu;
  const LidarFacts& lidar = *facts.lidar;
  const Eigen::Isometry3d T_IL = facts.T_IL();
  const std::string text = fmt::format(
      R"(# replaces config/{file}; numbers without a comment are the authors' defaults
common:
  lid_topic: "{points}"
  imu_topic: "{imu}"
  con_frame: false
  con_frame_num: 1
  cut_frame: false
  cut_frame_time_interval: 0.1
  time_diff_lidar_to_imu: 0.0      # one clock
preprocess:
  lidar_type: {type}                    # 1 Livox CustomMsg, 2 Velodyne
  scan_line: {rings}                    # rings of this lidar
  scan_rate: {scan_rate}
  timestamp_unit: {unit}                # unit of a Velodyne's point times: 0 is s; a CustomMsg has ns
  blind: {blind}                       # m; excludes the robot itself
mapping:
  imu_en: true
  extrinsic_est_en: false
  imu_time_inte: {imu_period}           # s, period of this IMU
  lidar_time_inte: {sweep_period}
  satu_acc: {satu_acc}                 # m/s^2: the stated {stated_acc}, or the largest reading if larger
  satu_gyro: {satu_gyro}               # rad/s: the stated {stated_gyro}, or the largest reading if larger
  acc_norm: 9.81                    # readings are in m/s^2
  lidar_meas_cov: 0.01
  acc_cov_output: 500.0
  gyr_cov_output: 1000.0
  b_acc_cov: 0.0001
  b_gyr_cov: 0.0001
  imu_meas_acc_cov: 0.1             # variance of a sample by the data sheet: {acc_var}
  imu_meas_omg_cov: 0.1             # variance of a sample by the data sheet: {gyr_var}
  gyr_cov_input: 0.01
  acc_cov_input: 0.1
  plane_thr: 0.1
  match_s: 81.0
  fov_degree: 180.0
  det_range: {range}                 # m, farthest return
  gravity: [0.0, 0.0, -9.81]
  gravity_init: [0.0, 0.0, -9.81]
  extrinsic_T: {T}   # pose of the lidar in the IMU, m
  extrinsic_R: {R}
odometry:
  publish_odometry_without_downsample: false
publish:
  path_en: true
  scan_publish_en: true
  scan_bodyframe_pub_en: false
pcd_save:
  pcd_save_en: false
  interval: -1
)",
      fmt::arg("file", lidar.livox ? "avia.yaml" : "velody16.yaml"), fmt::arg("points", names.points_topic),
      fmt::arg("imu", names.imu_topic), fmt::arg("type", lidar.livox ? 1 : 2), fmt::arg("rings", lidar.rings),
      fmt::arg("scan_rate", std::lround(1.0 / lidar.period_s)), fmt::arg("unit", lidar.livox ? 3 : 0),
      fmt::arg("blind", decimal(lidar.own_body_m)), fmt::arg("imu_period", decimal(imu.period_s)),
      fmt::arg("sweep_period", decimal(lidar.period_s)),
      fmt::arg("satu_acc", decimal(rail(imu.stated_accel_range_m_s2, imu.largest_accel_m_s2))),
      fmt::arg("satu_gyro", decimal(rail(imu.stated_gyro_range_rad_s, imu.largest_gyro_rad_s))),
      fmt::arg("stated_acc", decimal(imu.stated_accel_range_m_s2)),
      fmt::arg("stated_gyro", decimal(imu.stated_gyro_range_rad_s)),
      fmt::arg("acc_var", decimal(imu.accel_noise_m_s2_sqrt_hz * imu.accel_noise_m_s2_sqrt_hz / imu.period_s)),
      fmt::arg("gyr_var", decimal(imu.gyro_noise_rad_s_sqrt_hz * imu.gyro_noise_rad_s_sqrt_hz / imu.period_s)),
      fmt::arg("range", decimal(whole_metres(lidar.farthest_m))), fmt::arg("T", translation_of(T_IL)),
      fmt::arg("R", rotation_of(T_IL)));
  return {{lidar.livox ? "avia.yaml" : "velody16.yaml", text}};
}

}  // namespace

Dialect point_lio_dialect() {
  const char* commit = "1eb182282229734cfd9c39508d5ab66fbf09ee66";
  Dialect out{"point-lio", "rosbag1", "recording.bag"};
  out.names = fast_lio_names;
  out.sweeps = fast_lio_layout;
  out.configuration = point_lio_configuration;
  out.run = "roslaunch point_lio mapping_velody16.launch (mapping_avia.launch of a Livox); rosbag play recording.bag";
  out.notes = {"check_satu is on by default: the update ignores an axis at or above 0.99 of satu_gyro or satu_acc"};
  out.sources = {{"hku-mars/Point-LIO", "src/preprocess.h", commit},
                 {"hku-mars/Point-LIO", "src/preprocess.cpp", commit},
                 {"hku-mars/Point-LIO", "src/parameters.cpp", commit},
                 {"hku-mars/Point-LIO", "config/velody16.yaml", "1d93d28e49c976ecedc0422de77eed4d303a5bc2"}};
  return out;
}

}  // namespace tumble::scenarios
