// SPDX-License-Identifier: BSD-3-Clause
// The file describes norlab_icp_mapper_ros (norlab-ulaval, BSD-3), the mapper by the authors of the published rig.
#include <fmt/format.h>

#include "scenarios/recordings/dialects/dialect.hpp"
#include "scenarios/recordings/dialects/yaml_numbers.hpp"

namespace tumble::scenarios {

namespace {

ReaderNames norlab_names(const SensorFacts&) {
  return {"/imu/data", "imu", "/points_in", "lidar", "base_link", "odom"};
}

std::string node_file(const ReaderNames& names) {
  return fmt::format(R"(mapper_node:
  ros__parameters:
    use_sim_time: true
    odom_frame: "{}"
    robot_frame: "{}"
    mapping_config: "mapper.yaml"   # its full path
    initial_map_file_name: ""
    final_map_file_name: "map.vtk"
    final_trajectory_file_name: "trajectory.vtk"
    map_publish_rate: 10.0
    map_tf_publish_rate: 10.0
    max_idle_time: 10.0
    is_mapping: true
    is_online: false
    is_3D: true
    save_map_cells_on_hard_drive: false
    publish_tfs_between_registrations: true
)",
                     names.fixed_frame, names.body_frame);
}

std::string mapper_file(const SensorFacts& facts) {
  return fmt::format(R"(# numbers without a comment are the authors' defaults
mapper:
  updateCondition:
    type: distance
    value: 0.5
  sensorMaxRange: {range}   # m, farthest return
  mapperModule:
    - PointDistanceMapperModule:
        minDistNewPoint: 0.1
input:
  - BoundingBoxDataPointsFilter:   # the robot itself
      xMin: -{near}
      xMax: {near}
      yMin: -{near}
      yMax: {near}
      zMin: -{near}
      zMax: {near}
      removeInside: 1
  - SamplingSurfaceNormalDataPointsFilter:
      ratio: 0.5
      knn: 7
      samplingMethod: 0
      maxBoxDim: inf
      averageExistingDescriptors: 1
      keepNormals: 1
      keepDensities: 0
      keepEigenValues: 0
      keepEigenVectors: 0
icp:
  outlierFilters:
    - TrimmedDistOutlierFilter:
        ratio: 0.75
  matcher:
    KDTreeMatcher:
      knn: 3
      epsilon: 1
      searchType: 1
      maxDist: 2.0                 # m; of the authors' 200 and 2
  errorMinimizer:
    PointToPlaneErrorMinimizer:
      force4DOF: 0                 # the authors use 1, for a vehicle that does not tumble
  transformationCheckers:
    - CounterTransformationChecker:
        maxIterationCount: 40
    - DifferentialTransformationChecker:
        minDiffRotErr: 0.001
        minDiffTransErr: 0.001
        smoothLength: 3
  inspector: NullInspector
  logger: NullLogger
post:
)",
                     fmt::arg("range", decimal(whole_metres(facts.lidar->farthest_m))),
                     fmt::arg("near", decimal(facts.lidar->own_body_m)));
}

std::vector<ConfigurationFile> norlab_configuration(const SensorFacts& facts, const ReaderNames& names) {
  return {{"mapper_node.yaml", node_file(names)}, {"mapper.yaml", mapper_file(facts)}};
}

}  // namespace

Dialect norlab_dialect() {
  const char* repository = "norlab-ulaval/norlab_icp_mapper_ros";
  Dialect out{"norlab", "rosbag2", "bag"};
  out.needs_imu = out.needs_times = false;
  out.names = norlab_names;
  out.sweeps = ouster_layout;
  out.configuration = norlab_configuration;
  out.run = "ros2 run norlab_icp_mapper_ros mapper_node --ros-args --params-file mapper_node.yaml; ros2 bag play bag";
  out.notes = {
      "the mapper needs the pose of the lidar in odom for each cloud. The bag's /tf_static keeps base_link fixed in "
      "odom, so the prior is the previous pose; replace this transform by an odometry on /tf if available",
      "the mapper does not deskew; the point time t is exported as a descriptor that the mapper's converter does not "
      "read as a time"};
  out.sources = {
      {repository, "src/mapper_node.cpp", "00cedbe643e593a0f151909728953f715100e568"},
      {repository, "launch/mapper.launch.py", "0597a99fe485f93dc6684fa267c68c53fa1a966d"},
      {repository, "config/mapper.yaml", "c14c5d901656fb397fcd3ad667e36f8b4c602a80"},
      {repository, "config/_mapper_robosense.yaml", "1a9e035ae9a4ca34488b58361600d8c4a2aee566"},
      {"norlab-ulaval/libpointmatcher_ros", "src/PointMatcher_ROS.cpp", "933dff0ba9111b387453597f261ed7ddc86469ee"}};
  return out;
}

}  // namespace tumble::scenarios
