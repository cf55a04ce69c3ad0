// SPDX-License-Identifier: BSD-3-Clause
// The file describes the recording format of LIO-SAM (TixiaoShan/LIO-SAM, BSD-3).
#include <fmt/format.h>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/yaml_numbers.hpp"

namespace tumble::scenarios {

namespace {

ReaderNames lio_sam_names(const SensorFacts&) {
  return {"/imu_raw", "imu", "/points_raw", "lidar", "base_link", ""};
}

/// Returns the noise density of the data sheet, or the value of the authors if the data sheet lacks it.
std::string density_text(double stated, const char* authors) {
  return stated > 0.0 ? decimal(stated) : authors;
}

std::vector<ConfigurationFile> lio_sam_configuration(const SensorFacts& facts, const ReaderNames& names) {
  const ImuFacts& imu = *facts.imu;
  const LidarFacts& lidar = *facts.lidar;
  const Eigen::Isometry3d T_LI = facts.T_IL().inverse(Eigen::Isometry);
  const std::string R = rotation_of(T_LI);
  const std::string text = fmt::format(
      R"(# replaces config/params.yaml; numbers without a comment are the authors' defaults
lio_sam:
  pointCloudTopic: "{points}"
  imuTopic: "{imu}"
  odomTopic: "odometry/imu"
  gpsTopic: "odometry/gpsz"
  lidarFrame: "{frame}"          # poses are the lidar's
  baselinkFrame: "{frame}"
  odometryFrame: "odom"
  mapFrame: "map"
  useImuHeadingInitialization: false   # these readings have no attitude
  useGpsElevation: false
  gpsCovThreshold: 2.0
  poseCovThreshold: 25.0
  savePCD: false
  savePCDDirectory: "/Downloads/LOAM/"
  sensor: velodyne
  N_SCAN: {rings}                  # rings of this lidar
  Horizon_SCAN: {columns}            # firings of a ring in a sweep
  downsampleRate: 1
  lidarMinRange: {near}           # m; excludes the robot itself
  lidarMaxRange: {far}           # m, farthest return
  imuAccNoise: {acc}   # m/s^2/sqrt(Hz), density of the data sheet
  imuGyrNoise: {gyr}   # rad/s/sqrt(Hz), density of the data sheet
  imuAccBiasN: 6.4356659353532566e-05
  imuGyrBiasN: 3.5640318696367613e-05
  imuGravity: {gravity}           # m/s^2, of this recording
  imuRPYWeight: 0.0               # these readings have no attitude
  extrinsicTrans: {T}   # position of the IMU in the lidar, m
  extrinsicRot: {R}   # turns the IMU's axes to the lidar's
  extrinsicRPY: {R}
  edgeThreshold: 1.0
  surfThreshold: 0.1
  edgeFeatureMinValidNum: 10
  surfFeatureMinValidNum: 100
  odometrySurfLeafSize: 0.4
  mappingCornerLeafSize: 0.2
  mappingSurfLeafSize: 0.4
  z_tollerance: 1000.0
  rotation_tollerance: 1000.0
  numberOfCores: 4
  mappingProcessInterval: 0.15
  surroundingkeyframeAddingDistThreshold: 1.0
  surroundingkeyframeAddingAngleThreshold: 0.2
  surroundingKeyframeDensity: 2.0
  surroundingKeyframeSearchRadius: 50.0
  loopClosureEnableFlag: true
  loopClosureFrequency: 1.0
  surroundingKeyframeSize: 50
  historyKeyframeSearchRadius: 15.0
  historyKeyframeSearchTimeDiff: 30.0
  historyKeyframeSearchNum: 25
  historyKeyframeFitnessScore: 0.3
  globalMapVisualizationSearchRadius: 1000.0
  globalMapVisualizationPoseDensity: 10.0
  globalMapVisualizationLeafSize: 1.0
)",
      fmt::arg("points", names.points_topic), fmt::arg("imu", names.imu_topic), fmt::arg("frame", names.lidar_frame),
      fmt::arg("rings", lidar.rings), fmt::arg("columns", lidar.columns), fmt::arg("near", decimal(lidar.own_body_m)),
      fmt::arg("far", decimal(whole_metres(lidar.farthest_m))),
      fmt::arg("acc", density_text(imu.accel_noise_m_s2_sqrt_hz, "3.9939570888238808e-03")),
      fmt::arg("gyr", density_text(imu.gyro_noise_rad_s_sqrt_hz, "1.5636343949698187e-03")),
      fmt::arg("gravity", decimal(facts.gravity_m_s2)), fmt::arg("T", translation_of(T_LI)), fmt::arg("R", R));
  return {{"params.yaml", text}};
}

}  // namespace

Dialect lio_sam_dialect() {
  Dialect out{"lio-sam", "rosbag1", "recording.bag"};
  out.needs_rings = true;
  out.takes_empty = false;
  out.names = lio_sam_names;
  out.sweeps = velodyne_layout;
  out.configuration = lio_sam_configuration;
  out.run = "roslaunch lio_sam run.launch; rosbag play recording.bag";
  out.notes = {
      "LIO-SAM needs an IMU with attitude, but these readings have no attitude (identity, covariance -1). LIO-SAM "
      "therefore assumes that the IMU is level at the start, and imuRPYWeight is 0"};
  out.sources = {{"TixiaoShan/LIO-SAM", "src/imageProjection.cpp", "bfb271dcd13b708620269d06e5962a2e3e9a070f"},
                 {"TixiaoShan/LIO-SAM", "src/imuPreintegration.cpp", "041f4e63d5bee3a54bb646b0cfb704cdb1bd7147"},
                 {"TixiaoShan/LIO-SAM", "include/utility.h", "0d9d8f82c5297d36354255303cd9ea717e3eddeb"},
                 {"TixiaoShan/LIO-SAM", "config/params.yaml", "3410cf53d1c6e3ca87edcab8584d8b0b5c3548c2"}};
  return out;
}

}  // namespace tumble::scenarios
