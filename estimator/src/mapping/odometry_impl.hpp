// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "inertial_track.hpp"
#include "lag_window.hpp"
#include "local_map.hpp"
#include "prediction.hpp"
#include "prior_scene.hpp"
#include "relocalizer.hpp"
#include "state_estimate.hpp"
#include "sweep_points.hpp"

namespace tumble::mapping {

/// DeadReckoning is a second pose hypothesis while a relocalisation is unconfirmed. The second hypothesis ignores the
/// relocalisation and uses only IMU and odometer. If a later sweep contradicts the relocalisation, the odometry
/// continues from the second hypothesis. The pose of the contradicted relocalisation is an additional starting pose of
/// the search in the map.
struct DeadReckoning {
  SweepBoundary sweep_boundary;
  LagWindow window;
  WorldCovariance world_covariance;
  std::uint32_t first_inserted_sweep = 0;  ///< first sweep inserted into the map after the relocalisation
};

// See mapping.md, heading "Inertial noise".

/// Returns the state before a map exists. Before a map exists, gravity is exactly vertical in the world frame, and a
/// tilt error is an attitude error.
StateEstimate estimate_before_map(const LidarInertialOdometry::Params& params, const MotionState& levelled);

/// The map starts only if the standard deviation of the tilt is at most kStartTiltSigmaMax_rad.
inline constexpr double kStartTiltSigmaMax_rad = 0.3;

/// Computes the initial state of an IMU in motion. The direction of the mean specific force of the first 0.5 s
/// determines roll and pitch. The difference between mean specific force and gravity determines the standard deviation
/// of roll and pitch. In flight, the standard deviation of roll and pitch is large enough for all attitudes. `samples`
/// must not be empty.
MotionState start_in_motion(std::span<const MotionSample> samples, double gravity_m_s2);

/// Returns `motion` with the position and heading of `T_WI`, and with unchanged tilt.
MotionState transformed_to_pose(const Eigen::Isometry3d& T_WI, const MotionState& motion);
StateEstimate transformed_to_pose(const Eigen::Isometry3d& T_WI, const StateEstimate& estimate);

/// Replaces roll and pitch by `tilt`, whose errors are independent of all other errors.
StateEstimate with_start_tilt(const LidarInertialOdometry::StartTiltCorrection& tilt, const StateEstimate& estimate);

/// Returns the dead-reckoned state in a new frame with origin and yaw of the current IMU pose. A weak prior on the
/// robot's speed limits the errors of tilt and velocity during minutes of motion. `step_s` is the time since the last
/// call.
StateEstimate reset_origin_and_yaw(const StateEstimate& reckoned, double step_s);

/// Returns the state at the first sweep. The lidar pose of the first sweep defines the map frame, and is therefore
/// exact. In the map frame, the tilt error of dead reckoning becomes an error of gravity's direction.
StateEstimate estimate_at_first_sweep(const LidarInertialOdometry::Params& params, const StateEstimate& reckoned);

/// Returns the covariance of the new map frame relative to the world. The covariance contains the tilt variance of the
/// dead-reckoned state.
WorldCovariance world_at_first_sweep(const LidarInertialOdometry::Params& params, const StateEstimate& reckoned);

}  // namespace tumble::mapping

namespace tumble {

namespace mapping {

struct UpdatedSweep {
  const Prediction& prediction;
  const StateEstimate& start;
  const SweepTrajectory& trajectory;
};

/// SweepScratch contains work buffers that are reused, so that a sweep allocates no memory.
struct SweepScratch {
  explicit SweepScratch(const LidarInertialOdometry::Params& params) : points(params), sweep_aligner(params) {}

  SweepPoints points;
  SweepAligner sweep_aligner;
  SweepTrajectory trajectory;
};

}  // namespace mapping

struct LidarInertialOdometry::Impl {
  explicit Impl(const Params& given);

  /// Registers a sweep like LidarInertialOdometry::add_sweep, with time stamps in the clock of the IMU.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns, SweepResult& report);

  Status check_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns) const;
  /// Computes the initial state from the IMU samples before the first sweep, at rest or in motion.
  Status initialise_inclination();
  Status level_start(MotionState& levelled) const;
  /// Starts the map if the sweep has enough usable points. If the sweep has too few usable points, propagates the state
  /// inertially to the end of the sweep.
  Status start_map(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns, SweepResult& report);
  Status dead_reckon(TimeNs end_ns);
  bool is_stationary(const mapping::InertialTrack& inertial, const SweepTrajectory& motion, TimeNs end_ns) const;
  /// On entry, `trajectory` is the motion predicted from the IMU. On return, `trajectory` is the registered motion, or
  /// the last motion of a failed registration.
  void register_to_map(const mapping::Prediction& prediction, const mapping::MotionWindow& motion,
                       mapping::SweepPoints& points, SweepTrajectory& trajectory, SweepResult& report,
                       mapping::SweepRegistration& placed);
  mapping::StateEstimate update(const mapping::MotionWindow& motion, const mapping::SweepRegistration& placed,
                                mapping::Prediction& prediction) const;
  std::vector<mapping::InsertedPoint> insert(const mapping::UpdatedSweep& sweep, mapping::SweepPoints& points,
                                             bool has_ring_numbers, const mapping::SweepRegistration& placed,
                                             SweepResult& report);
  void propagate(const mapping::UpdatedSweep& sweep, const mapping::SweepRegistration& placed,
                 const mapping::MotionWindow& motion, std::vector<mapping::InsertedPoint> inserted,
                 SweepResult& report);
  static mapping::WindowSweep& append_to_lag_window(const mapping::UpdatedSweep& sweep,
                                                    const mapping::MotionWindow& motion,
                                                    const mapping::SweepBoundary& from, mapping::LagWindow& into);
  void predict_stationary(const mapping::MotionWindow& motion, const mapping::SweepBoundary& from,
                          mapping::Prediction& prediction) const;
  void propagate_alternative_pose(const mapping::MotionWindow& motion, bool unconfirmed_before);
  Status continue_by_inertia(const mapping::MotionWindow& motion, bool rests, mapping::SweepBoundary& at,
                             mapping::LagWindow* into) const;
  void revert_to_inertial_pose();
  /// Returns the IMU state of a relocalisation that later sweeps have contradicted, or null.
  const MotionState* rejected_relocalisation() const;
  void add_map_drift(const mapping::UpdatedSweep& sweep, const SweepResult& report);
  void prune_until(TimeNs end_ns);
  /// If the local map matches the prior map, the odometry continues in the prior map's frame.
  void localise(const SweepResult& report);
  void enter_prior_map(const mapping::FramePose& pose, const PoseState& last);
  bool extends_map() const { return !localiser.is_localised() || localiser.map().extend; }

  PoseState pose_along(const SweepTrajectory& motion, double t_s, const Registration::Matrix& errors) const;
  /// Returns the poses at the ends of the IMU's averaging windows. `errors` is the covariance of the registration's
  /// unknowns at the start of the sweep.
  std::vector<PoseState> poses_along(const SweepTrajectory& motion, TimeNs end_ns,
                                     const Registration::Matrix& errors) const;
  std::vector<PoseState> poses_of(const mapping::WindowSweep& sweep) const;
  Params params;
  std::optional<Eigen::Isometry3d> start_pose;  // position and heading of the IMU where the map starts
  std::optional<StartTiltCorrection> start_tilt_correction;
  mapping::TrackingState tracking;
  mapping::InertialTrack inertial_track;
  mapping::SweepBoundary sweep_boundary;            // boundary between the last sweep and the next sweep
  std::optional<OdometerReading> odometer_reading;  // odometer reading of the next sweep
  int resting_sweeps = 0;                           // number of consecutive sweeps at rest, detected by the IMU
  mapping::LagWindow window;
  mapping::LocalMap map;
  mapping::WorldCovariance world_covariance;
  std::optional<mapping::DeadReckoning> alternative;  // pose hypothesis without the unconfirmed relocalisation
  mapping::MapLocaliser localiser;                    // localiser in a prior map, if any
  std::optional<mapping::PosesBeforeChange> poses_before_localisation;  // empty until localised in the prior map
  mapping::SweepScratch sweep_scratch;
};

}  // namespace tumble
