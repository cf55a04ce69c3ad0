// SPDX-License-Identifier: BSD-3-Clause
// The file describes the recording format of DLIO (vectr-ucla/direct_lidar_inertial_odometry, MIT).
#include <fmt/format.h>

#include <algorithm>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/yaml_numbers.hpp"

namespace tumble::scenarios {

namespace {

ReaderNames dlio_names(const SensorFacts&) {
  return {"/os_cloud_node/imu", "imu", "/os_cloud_node/points", "lidar", "base_link", ""};
}

std::string sensors_file(const SensorFacts& facts) {
  return fmt::format(R"(# replaces cfg/dlio.yaml; numbers without a comment are the authors' defaults
dlio:
  version: 1.1.1
  adaptive: true
  pointcloud:
    deskew: true
    voxelize: true
  imu:
    calibration: true
    intrinsics:
      accel:
        bias: [0.0, 0.0, 0.0]
        sm: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
      gyro:
        bias: [0.0, 0.0, 0.0]
  extrinsics:               # poses in base_link, m
    baselink2imu:
      t: {}
      R: {}
    baselink2lidar:
      t: {}
      R: {}
)",
                     translation_of(facts.T_BI), rotation_of(facts.T_BI), translation_of(facts.T_BL),
                     rotation_of(facts.T_BL));
}

std::string params_file(const SensorFacts& facts, const ReaderNames& names) {
  constexpr double kAuthors_s = 3.0, kLeast_s = 0.1;
  const double rest_s = std::clamp(facts.imu->still_at_start_s, kLeast_s, kAuthors_s);
  return fmt::format(R"(# replaces cfg/params.yaml; numbers without a comment are the authors' defaults
dlio:
  frames:
    odom: odom
    baselink: {}
    lidar: {}
    imu: {}
  map:
    waitUntilMove: true
    dense:
      filtered: false
    sparse:
      leafSize: 0.25
  odom:
    gravity: {}             # m/s^2, of this recording
    imu:
      approximateGravity: true  # the body does not start level
      calibration:
        gyro: true
        accel: true
        time: {}            # s, rest at the start, at most 3
      bufferSize: 5000
    preprocessing:
      cropBoxFilter:
        size: {}            # m; excludes the robot itself
      voxelFilter:
        res: 0.25
    keyframe:
      threshD: 1.0
      threshR: 45.0
    submap:
      keyframe:
        knn: 10
        kcv: 10
        kcc: 10
    gicp:
      minNumPoints: 64
      kCorrespondences: 16
      maxCorrespondenceDistance: 0.5
      maxIterations: 32
      transformationEpsilon: 0.01
      rotationEpsilon: 0.01
      initLambdaFactor: 1.0e-9
    geo:
      Kp: 4.5
      Kv: 11.25
      Kq: 4.0
      Kab: 2.25
      Kgb: 1.0
      abias_max: 5.0
      gbias_max: 0.5
)",
                     names.body_frame, names.lidar_frame, names.imu_frame, decimal(facts.gravity_m_s2), decimal(rest_s),
                     decimal(facts.lidar->own_body_m));
}

std::vector<ConfigurationFile> dlio_configuration(const SensorFacts& facts, const ReaderNames& names) {
  return {{"dlio.yaml", sensors_file(facts)}, {"params.yaml", params_file(facts, names)}};
}

}  // namespace

Dialect dlio_dialect() {
  const char* repository = "vectr-ucla/direct_lidar_inertial_odometry";
  Dialect out{"dlio", "rosbag1", "recording.bag"};
  out.takes_empty = false;
  out.names = dlio_names;
  out.sweeps = ouster_layout;
  out.configuration = dlio_configuration;
  out.run = "roslaunch direct_lidar_inertial_odometry dlio.launch; rosbag play recording.bag";
  out.notes = {"DLIO needs a rest at the start, because it levels the attitude with averaged IMU readings"};
  out.sources = {{repository, "include/dlio/dlio.h", "07bf91ed0e1adb726765cb82a466dca0dccb1e18"},
                 {repository, "src/dlio/odom.cc", "1637f88cf078775d2a92608297555bba7f22e683"},
                 {repository, "cfg/dlio.yaml", "044f8440818ab1dc2b161220ec5b29236f95a748"},
                 {repository, "cfg/params.yaml", "07bf91ed0e1adb726765cb82a466dca0dccb1e18"},
                 {repository, "launch/dlio.launch", "002f04858713f08eb0931471f05bf89e70dca055"}};
  return out;
}

}  // namespace tumble::scenarios
