// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"
#include "sim/render/world_mesh.hpp"

namespace tumble::tools {

struct ReplayEstimate {
  std::string name;  ///< for example "slam/tumble"
  const scenarios::Estimate* estimate = nullptr;
};

/// Only the sensors and one motion (truth or estimate) are required.
struct ReplayInput {
  std::string title;                                       ///< for example "hill, seed 6"
  std::vector<std::pair<std::string, std::string>> facts;  ///< pairs of name and value
  const sim::Sensors* sensors = nullptr;
  const sim::Truth* truth = nullptr;           ///< null: colours without error
  const sim::BuiltSituation* built = nullptr;  ///< null: no world, generic robot
  const sim::Surface* surface = nullptr;       ///< null: colours without error
  std::vector<ReplayEstimate> estimates;       ///< in the order of their colours
};

struct Shown {
  std::size_t shown = 0, of = 0;
};

/// Poses of the body at multiples of `Replay::pose_step_ns` from time 0; unknown positions are not finite
struct ReplayTrack {
  std::vector<Eigen::Vector3d> p_WB_m;
  std::vector<Eigen::Quaterniond> q_WB;
};

struct ReplayActor {
  std::string name;
  std::string colour;
  bool is_truth = false;
  ReplayTrack track;  ///< empty without positions
  /// Transform from body axes of the estimator's calibration, in which the points are, to the actor's body axes; the
  /// two axes differ for the truth
  Eigen::Isometry3d T_BB_given = Eigen::Isometry3d::Identity();
  std::vector<float> error_m;               ///< [m]; NaN if unknown
  std::vector<Eigen::Vector3f> rate_rad_s;  ///< axes of the primary IMU; NaN: unknown
};

struct ReplayPoints {
  std::vector<Eigen::Vector3f> p_B_m;  ///< body axes of the calibration
  std::vector<std::int64_t> time_ns;
  std::size_t of = 0;  ///< in the recording, without the robot
};

struct ContactSpan {
  std::int64_t begin_ns = 0, end_ns = 0;
  sim::ContactLabel label = sim::ContactLabel::grip;
};

struct ReplayStrip {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3f> gyro_rad_s;
  std::vector<std::uint8_t> clipped_axes;  ///< bit j: axis j
  std::string clipping;                    ///< source of `clipped_axes`
  std::size_t of = 0;                      ///< in the recording
  std::vector<ContactSpan> contacts;       ///< except in the air
  bool contacts_known = false;
};

struct Replay {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;
  std::int64_t end_ns = 0;              ///< end of the recording, which starts at 0
  std::int64_t from_ns = 0, to_ns = 0;  ///< interval with motion
  std::int64_t pose_step_ns = 0;
  std::vector<sim::MeshPart> world;  ///< in axes of W
  Shown triangles;
  std::vector<sim::MeshPart> robot;  ///< in axes of B
  double robot_radius_m = 0.0;       ///< about the origin of B
  std::vector<ReplayActor> actors;   ///< truth first, if present
  ReplayPoints points;
  ReplayStrip strip;
};

struct ReplayLimits {
  std::size_t bytes = 2'100'000;  ///< all arrays; points use the rest
  std::size_t points = 120'000;
  std::size_t poses = 6'000;  ///< poses per track
  std::size_t strip_samples = 6'000;
  std::size_t triangles = 60'000;  ///< triangles of the world
};

Replay replay_of(const ReplayInput& input, const ReplayLimits& limits = {});

}  // namespace tumble::tools
