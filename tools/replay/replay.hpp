// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/lidar/surface.hpp"
#include "sim/recording.hpp"
#include "sim/render/world_mesh.hpp"

/// What a replay shows, as data: nothing here knows of pages or bytes.
namespace tumble::tools {

struct ReplayEstimate {
  std::string name;  ///< "slam/tumble"
  const scenarios::Estimate* estimate = nullptr;
};

/// What a replay is made from. Only the sensors are needed, and a motion of somebody.
struct ReplayInput {
  std::string title;                                       ///< "hill, seed 6"
  std::vector<std::pair<std::string, std::string>> facts;  ///< name, value
  const sim::Sensors* sensors = nullptr;
  const sim::Truth* truth = nullptr;           ///< null: nobody knows; errors have no colour
  const sim::BuiltSituation* built = nullptr;  ///< null: no world is shown, and a plain body for the robot
  const sim::Surface* surface = nullptr;       ///< null: errors have no colour
  std::vector<ReplayEstimate> estimates;       ///< in the order of their colours
};

/// So much of what there is.
struct Shown {
  std::size_t shown = 0, of = 0;
};

/// Poses of the body at `Replay::pose_step_ns` from time 0; what is not known has a position that is not finite.
struct ReplayTrack {
  std::vector<Eigen::Vector3d> p_WB_m;
  std::vector<Eigen::Quaterniond> q_WB;
};

/// The truth, or an estimate.
struct ReplayActor {
  std::string name;
  std::string colour;  ///< "#rrggbb"
  bool is_truth = false;
  ReplayTrack track;  ///< empty: it says nothing of where the robot is
  /// From body axes by the calibration that estimators are given, in which the points stand, to its own body axes: the
  /// truth knows better how the lidar is mounted.
  Eigen::Isometry3d T_BB_given = Eigen::Isometry3d::Identity();
  std::vector<float> error_m;               ///< of each point as placed by it; NaN: not known; empty: no true surface
  std::vector<Eigen::Vector3f> rate_rad_s;  ///< at the strip's samples, axes of the primary IMU; NaN; empty
};

/// Returns of the first lidar, in the order of time.
struct ReplayPoints {
  std::vector<Eigen::Vector3f> p_B_m;  ///< in body axes by the calibration given
  std::vector<std::int64_t> time_ns;
  std::size_t of = 0;  ///< returns in the recording, the robot's own left out
};

struct ContactSpan {
  std::int64_t begin_ns = 0, end_ns = 0;
  sim::ContactLabel label = sim::ContactLabel::grip;
};

/// What the primary gyro said.
struct ReplayStrip {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3f> gyro_rad_s;
  std::vector<std::uint8_t> clipped_axes;  ///< bit j: axis j
  std::string clipping;                    ///< how that is known; "" when it is not
  std::size_t of = 0;                      ///< samples in the recording
  std::vector<ContactSpan> contacts;       ///< but for air
  bool contacts_known = false;
};

struct Replay {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;
  std::int64_t end_ns = 0;              ///< of the recording; it begins at 0
  std::int64_t from_ns = 0, to_ns = 0;  ///< where something moves
  std::int64_t pose_step_ns = 0;
  std::vector<sim::MeshPart> world;  ///< in W
  Shown triangles;
  std::vector<sim::MeshPart> robot;  ///< in B
  double robot_radius_m = 0.0;       ///< of the ball about B's origin that holds it
  std::vector<ReplayActor> actors;   ///< the truth first, where there is one
  ReplayPoints points;
  ReplayStrip strip;
};

/// How much of it goes into a replay at most.
struct ReplayLimits {
  std::size_t bytes = 2'100'000;  ///< of all arrays together; the points get what the rest leaves
  std::size_t points = 120'000;
  std::size_t poses = 6'000;  ///< a track
  std::size_t strip_samples = 6'000;
  std::size_t triangles = 60'000;  ///< of the world
};

/// Throws BadInput where there is nothing to show (no truth and no estimate that says where the robot is) or where
/// truth and sensors contradict each other. O(points of the recording); the errors cost some microseconds a point and
/// actor.
Replay replay_of(const ReplayInput& input, const ReplayLimits& limits = {});

}  // namespace tumble::tools
