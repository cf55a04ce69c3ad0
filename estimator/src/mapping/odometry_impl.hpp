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

/// Unknowns at a sweep's start, predicted and updated, and the motion of the latter.
struct UpdatedSweep {
  const Prediction& prediction;
  const Belief& start;
  const SweepTrajectory& trajectory;
};

/// Buffers of a sweep, kept to avoid allocations. Each sweep fills them before reading, and passes their contents
/// between its steps as arguments.
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

  /// Same as LidarInertialOdometry::add_sweep, with stamps in the IMU's clock.
  Status add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns, SweepReport& report);

  Status check_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns) const;
  /// Before the first sweep, initialises the state from the IMU at rest.
  Status level_at_first();
  /// Before there is a map: ok where this sweep starts it; else the state goes on by inertia to the sweep's end.
  Status start_map(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns, SweepReport& report);
  Status dead_reckon(TimeNs end_ns);
  bool rests(const mapping::InertialTrack& heard, const SweepTrajectory& motion, TimeNs end_ns) const;
  /// `trajectory` is the IMU's motion from the boundary on. On return it is that of the alignment, if there is one,
  /// otherwise that of a failed attempt.
  void register_to_map(const mapping::Prediction& prediction, const mapping::MotionWindow& motion,
                       mapping::SweepPoints& points, SweepTrajectory& trajectory, SweepReport& report,
                       mapping::Placed& placed);
  /// Returns the updated state. After tracking failure at rest, the prediction is that of the rest.
  mapping::Belief update(const mapping::MotionWindow& motion, const mapping::Placed& placed,
                         mapping::Prediction& prediction) const;
  std::vector<mapping::InsertedPoint> insert(const mapping::UpdatedSweep& sweep, mapping::SweepPoints& points,
                                             bool rings_differ, const mapping::Placed& placed, SweepReport& report);
  void carry_on(const mapping::UpdatedSweep& sweep, const mapping::Placed& placed, const mapping::MotionWindow& motion,
                std::vector<mapping::InsertedPoint> inserted, SweepReport& report);
  /// Adds a sweep that continues from there.
  static mapping::WindowSweep& enter_window(const mapping::UpdatedSweep& sweep, const mapping::MotionWindow& motion,
                                            const mapping::Border& from, mapping::LagWindow& into);
  /// For tracking failure, if only the IMU provides the motion.
  void stop_at_rest(const mapping::MotionWindow& motion, const mapping::Border& from,
                    mapping::Prediction& prediction) const;
  void carry_on_other(const mapping::MotionWindow& motion, bool doubted_before);
  Status go_on_by_inertia(const mapping::MotionWindow& motion, bool rests, mapping::Border& at,
                          mapping::LagWindow* into) const;
  void go_back_to_inertia();
  /// After tracking failure: the state at the boundary by the contradicted relocalisation; null if there was none.
  const MotionState* by_the_place() const;
  void part_from_world(const mapping::UpdatedSweep& sweep, const SweepReport& report);
  void forget_until(TimeNs end_ns);

  PoseState pose_along(const SweepTrajectory& motion, double t_s, const Registration::Matrix& errors) const;
  /// Returns the poses at the ends of the IMU's windows, and at `end_ns` for the last; `errors` are those of the
  /// unknowns at the start.
  std::vector<PoseState> poses_along(const SweepTrajectory& motion, TimeNs end_ns,
                                     const Registration::Matrix& errors) const;
  std::vector<PoseState> poses_of(const mapping::WindowSweep& sweep) const;

  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);
  /// Checks the invariants between the members. Returns the first violation.
  Status check_state() const;
  Status check_other() const;

  Params params;
  mapping::TrackingState tracking;
  mapping::InertialTrack track;
  mapping::Border border;      // between the last sweep and the next
  mapping::MotionPrior known;  // of the next sweep
  int resting_sweeps = 0;      // consecutive sweeps at rest, by the IMU
  mapping::LagWindow window;
  mapping::LocalMap map;
  mapping::WorldCovariance world;
  std::optional<mapping::DeadReckoning> other;  // during an unconfirmed relocalisation, or after a contradicted one
  mapping::SweepScratch scratch;
};

}  // namespace tumble
