// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "aligner.hpp"
#include "dead_reckoning.hpp"
#include "inertial_track.hpp"
#include "lag_window.hpp"
#include "local_map.hpp"
#include "prediction.hpp"
#include "relocalizer.hpp"
#include "sweep_points.hpp"
#include "tracking.hpp"
#include "world_covariance.hpp"

namespace tumble {

namespace mapping {

void require_params(const LidarInertialOdometry::Params& params);

/// Unknowns at a sweep's start, predicted and updated, and the motion of the updated unknowns.
struct UpdatedSweep {
  const Prediction& prediction;
  const StateEstimate& start;
  const SweepTrajectory& trajectory;
};

/// Buffers of a sweep, kept to avoid allocations. Each sweep fills the buffers before reading them, and passes their
/// contents between its steps as arguments.
struct SweepScratch {
  explicit SweepScratch(const LidarInertialOdometry::Params& params) : points(params), aligner(params) {}

  SweepPoints points;
  Aligner aligner;
  SweepTrajectory trajectory;
};

}  // namespace mapping

/// State of the odometry between sweeps, and the steps of processing a sweep: README.md.
struct LidarInertialOdometry::Impl {
  explicit Impl(const Params& given);

  /// Registers a sweep as LidarInertialOdometry::add_sweep does, with stamps in the IMU's clock.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns, SweepReport& report);

  Status check_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns) const;
  /// Before the first sweep, initialises the state from the IMU at rest.
  Status level_at_first();
  Status level_start(MotionState& levelled) const;
  /// Starts the map if the sweep is suitable, and returns ok. If the sweep is not suitable, the state is propagated
  /// inertially to the sweep's end.
  Status start_map(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns, SweepReport& report);
  Status dead_reckon(TimeNs end_ns);
  bool rests(const mapping::InertialTrack& inertial, const SweepTrajectory& motion, TimeNs end_ns) const;
  /// Registers a sweep. `trajectory` is the IMU's motion from the boundary on. On return, `trajectory` is that of the
  /// alignment, or that of a failed attempt if there is no alignment.
  void register_to_map(const mapping::Prediction& prediction, const mapping::MotionWindow& motion,
                       mapping::SweepPoints& points, SweepTrajectory& trajectory, SweepReport& report,
                       mapping::Placed& placed);
  /// Returns the updated state. After tracking failure at rest, the prediction assumes the rest.
  mapping::StateEstimate update(const mapping::MotionWindow& motion, const mapping::Placed& placed,
                                mapping::Prediction& prediction) const;
  std::vector<mapping::InsertedPoint> insert(const mapping::UpdatedSweep& sweep, mapping::SweepPoints& points,
                                             bool rings_differ, const mapping::Placed& placed, SweepReport& report);
  void propagate(const mapping::UpdatedSweep& sweep, const mapping::Placed& placed, const mapping::MotionWindow& motion,
                 std::vector<mapping::InsertedPoint> inserted, SweepReport& report);
  /// Adds a sweep to the window that continues from the updated sweep's start.
  static mapping::WindowSweep& enter_window(const mapping::UpdatedSweep& sweep, const mapping::MotionWindow& motion,
                                            const mapping::SweepBoundary& from, mapping::LagWindow& into);
  /// Stops the predicted motion at rest, after tracking failure, if only the IMU provides the motion.
  void stop_at_rest(const mapping::MotionWindow& motion, const mapping::SweepBoundary& from,
                    mapping::Prediction& prediction) const;
  void propagate_alternative(const mapping::MotionWindow& motion, bool unconfirmed_before);
  Status go_on_by_inertia(const mapping::MotionWindow& motion, bool rests, mapping::SweepBoundary& at,
                          mapping::LagWindow* into) const;
  void go_back_to_inertia();
  /// Returns the state at the boundary by the contradicted relocalisation, after tracking failure. Returns null if no
  /// relocalisation was contradicted.
  const MotionState* rejected_relocalisation() const;
  void add_map_drift(const mapping::UpdatedSweep& sweep, const SweepReport& report);
  void prune_until(TimeNs end_ns);

  PoseState pose_along(const SweepTrajectory& motion, double t_s, const Registration::Matrix& errors) const;
  /// Returns the poses at the ends of the IMU's windows, and at `end_ns` for the last window. `errors` is the
  /// covariance of the unknowns at the sweep's start.
  std::vector<PoseState> poses_along(const SweepTrajectory& motion, TimeNs end_ns,
                                     const Registration::Matrix& errors) const;
  std::vector<PoseState> poses_of(const mapping::WindowSweep& sweep) const;

  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);
  /// Checks the invariants between the members. Returns the first violated invariant.
  Status check_state() const;
  Status check_other() const;

  Params params;
  std::optional<Eigen::Isometry3d> start_pose;  // position and heading of the IMU where the map starts
  mapping::TrackingState tracking;
  mapping::InertialTrack track;
  mapping::SweepBoundary boundary;  // between the last sweep and the next
  mapping::MotionPrior known;       // of the next sweep
  int resting_sweeps = 0;           // consecutive sweeps at rest, by the IMU
  mapping::LagWindow window;
  mapping::LocalMap map;
  mapping::WorldCovariance world;
  std::optional<mapping::DeadReckoning> other;  // during an unconfirmed relocalisation, or after a contradicted one
  mapping::SweepScratch scratch;
};

}  // namespace tumble
