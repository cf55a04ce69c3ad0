// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "aligner.hpp"
#include "dead_reckoning.hpp"
#include "frame_change.hpp"
#include "inertial_track.hpp"
#include "lag_window.hpp"
#include "local_map.hpp"
#include "map_localiser.hpp"
#include "prediction.hpp"
#include "relocalizer.hpp"
#include "sweep_points.hpp"
#include "tracking.hpp"
#include "world_covariance.hpp"

namespace tumble {

namespace mapping {

void require_params(const LidarInertialOdometry::Params& params);

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
