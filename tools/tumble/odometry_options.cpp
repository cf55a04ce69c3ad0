// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/odometry_options.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "tools/tumble/chosen_method.hpp"

namespace tumble::tools {

using scenarios::BadInput;

namespace {

/// Without the option, only returns from our own simulated rig are removed, because the shape of other robots is
/// unknown.
Eigen::AlignedBox3d own_body(const OdometryOptions& options, const std::string& robot) {
  if (options.own_body_m.empty())
    return robot == "rig" ? scenarios::presets::rig_body_L()
                          : Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const Eigen::Vector3d min = Eigen::Vector3d::Map(options.own_body_m.data()),
                        max = Eigen::Vector3d::Map(options.own_body_m.data() + 3);
  if (!((min.array() <= max.array()).all()))
    throw BadInput("--own-body: the first corner must not exceed the second corner in any coordinate");
  return {min, max};
}

std::string method_name(const OdometryOptions& options) {
  if (options.live && !options.method.empty())
    throw BadInput("--live and --method exclude each other; --live means --method slam/tumble_live");
  if (!options.method.empty()) return options.method;
  if (options.live) return "slam/tumble_live";
  return options.prior_map.map.empty() ? "slam/tumble" : "slam/tumble_lag";
}

bool has_parameter(const scenarios::MethodInfo& info, std::string_view name) {
  return std::ranges::count(info.parameters, name, &sim::Parameter::name) > 0;
}

std::vector<std::string> parameter_texts(const OdometryOptions& options, const scenarios::MethodInfo& info,
                                         bool states_lidar_pose, const Eigen::AlignedBox3d& own_body_L) {
  std::vector<std::string> texts = options.parameters;
  const auto assume = [&](const std::string& name, double value) {
    const std::string parameter = full_name(info) + "." + name + "=";
    const bool given = std::ranges::any_of(texts, [&](const std::string& text) { return text.starts_with(parameter); });
    if (!given && has_parameter(info, name)) texts.push_back(fmt::format("{}{}", parameter, value));
  };
  if (!states_lidar_pose) {
    assume("mount_sigma_m", kAssumedLidarSigma_m);
    assume("mount_sigma_rad", kAssumedLidarSigma_rad);
  }
  if (own_body_L.isApprox(scenarios::presets::rig_body_L())) return texts;  // default of the methods
  const std::string prefix = has_parameter(info, "mapping_own_body_min_x_m") ? "mapping_own_body" : "own_body";
  for (int k = 0; k < 3; ++k) {
    assume(fmt::format("{}_min_{}_m", prefix, "xyz"[k]), own_body_L.min()[k]);
    assume(fmt::format("{}_max_{}_m", prefix, "xyz"[k]), own_body_L.max()[k]);
  }
  return texts;
}

}  // namespace

void declare_odometry_options(VerbOptions& verb, OdometryOptions& options) {
  declare_sensors(verb, options.input);
  verb.add_flag("--live", options.live, "uses past data only, as on the robot: runs slam/tumble_live");
  verb.add("--method", options.method,
           "runs this slam method ('tumble list methods') [default: slam/tumble; slam/tumble_lag with --map]");
  declare_prior_map(verb, options.prior_map);
  verb.add("--own-body", options.own_body_m,
           "sets a box around the robot by two opposite corners X Y Z X Y Z in lidar axes, m; drops returns inside the "
           "box [default: no box; for recordings of our simulated rig -0.5 -0.4 -0.27 0.5 0.4 0.23]")
      .words(6);
  verb.add(
          "--T-base-imu", options.T_base_imu,
          "writes poses of the base frame instead of the IMU to trajectory.tum. The numbers are the pose of the IMU in "
          "the base frame: X Y Z in m, then the quaternion QX QY QZ QW. The frame of the map is unchanged")
      .words(7);
  verb.add("--base-frame", options.input.base_frame,
           "replaces --T-base-imu by the name of a frame in a bag's /tf_static, for example base_link");
  verb.add("--set", options.parameters,
           "sets a parameter of the method: METHOD.PARAMETER=NUMBER; repeat the option for more parameters ('tumble "
           "list "
           "methods NAME' lists them)")
      .one_at_a_time();
}

void check_odometry_options(const OdometryOptions& options) {
  (void)own_body(options, "");
  (void)method_name(options);
  (void)pose_of("--T-base-imu", options.T_base_imu);
  if (!options.T_base_imu.empty() && !options.input.base_frame.empty())
    throw BadInput("--T-base-imu and --base-frame exclude each other; give only one");
}

OdometrySetup set_up_odometry(const Session& session, const OdometryOptions& options, OpenRecording& recording) {
  const sim::Sensors& sensors = recording.content.sensors;
  const scenarios::Method method =
      with_prior_map(*chosen_method(method_name(options), {sensors.robot, true}), options.prior_map);
  if (!options.T_base_imu.empty()) recording.content.T_base_imu = pose_of("--T-base-imu", options.T_base_imu);
  OdometrySetup setup;
  const Eigen::AlignedBox3d own_body_L = own_body(options, sensors.robot);
  setup.found = complete_recording(session, recording, own_body_L, !options.own_body_m.empty());
  const scenarios::MethodPointer chosen[] = {scenarios::unowned(method)};
  setup.method = scenarios::with_parameters(
                     chosen, parameter_texts(options, method.info, states_lidar_pose(setup.found), own_body_L))
                     .front();
  return setup;
}

}  // namespace tumble::tools
