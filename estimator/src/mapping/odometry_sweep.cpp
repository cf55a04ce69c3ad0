// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <variant>

#include "before_map.hpp"
#include "odometry_impl.hpp"
#include "tumble/mapping/detail/sweep_check.hpp"
#include "unknowns.hpp"

namespace tumble {

using mapping::StateEstimate, mapping::InsertedPoint, mapping::MotionWindow, mapping::Placed, mapping::Prediction;
using mapping::UpdatedSweep, mapping::WindowSweep;

namespace {

constexpr double kFirstSweepDelayMax_s = 0.5;  // maximum delay between first sample and first sweep
constexpr TimeNs kStep_ns = 100'000'000;       // step of dead reckoning, for which the inertial noise is stated

}  // namespace

Status LidarInertialOdometry::Impl::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns,
                                              SweepReport& report) {
  if (Status status = check_sweep(start_ns, end_ns, returns); !status.ok()) return status;
  if (Status status = level_at_first(); !status.ok()) return status;

  if (std::holds_alternative<mapping::ConstantVelocity>(known)) track.exclude_accelerometer(end_ns);
  if (!mapping::has_started(tracking)) {
    if (Status status = start_map(start_ns, end_ns, returns, report); !status.ok()) return status;
  }
  SweepTrajectory& trajectory = scratch.trajectory;
  const Registration::Estimate& before = boundary.state_estimate.mean;
  if (Status status = trajectory.build(before.state, track.samples(), end_ns, before.calibration.gravity_W_m_s2);
      !status.ok())
    return status;
  const int previous_resting_sweeps = resting_sweeps;
  resting_sweeps = rests(track, trajectory, end_ns) ? resting_sweeps + 1 : 0;
  const MotionWindow motion{track.samples(), end_ns, resting_sweeps};
  const std::unique_ptr<Prediction> prediction(
      new Prediction(mapping::predict(params, boundary, motion, trajectory, known)));  // too large for the stack

  // A sweep without usable returns gets the inertially predicted pose.
  mapping::SweepPoints& points = scratch.points;
  mapping::SweepPoints::Counts counts;
  const Status points_status = points.select(params, returns, end_ns - start_ns, before.calibration,
                                             seconds(start_ns - boundary.time_ns()), counts);
  report.points_used = counts.used;
  report.isolated_points = counts.isolated;
  const auto placed = std::make_unique<Placed>();
  if (points_status.ok()) register_to_map(*prediction, motion, points, trajectory, report, *placed);
  if (other && mapping::contradicts(tracking, placed->placement)) {  // restart from tracking failure
    revert_to_inertia();
    resting_sweeps = previous_resting_sweeps;
    report = SweepReport{};
    return add_sweep(start_ns, end_ns, returns, report);
  }
  report.verdict = placed->verdict;
  report.in_prior_map = localiser.is_localised();

  const std::unique_ptr<const StateEstimate> start(new StateEstimate(update(motion, *placed, *prediction)));
  if (!placed->alignment) {  // a failed attempt may have changed the trajectory
    const Registration::Estimate& mean = start->mean;
    const Status status = trajectory.build(mean.state, motion.samples, motion.end_ns, mean.calibration.gravity_W_m_s2,
                                           mean.deficit_rad_s);
    if (!status.ok()) return status;
  }
  const UpdatedSweep sweep{*prediction, *start, trajectory};
  // If the map has too few points for a registration, the sweep is inserted at its predicted pose.
  std::vector<InsertedPoint> inserted;
  if (extends_map() && (placed->verdict != SweepVerdict::rejected || placed->map_too_sparse))
    inserted = insert(sweep, points, counts.has_ring_numbers, *placed, report);
  propagate(sweep, *placed, motion, std::move(inserted), report);
  localise(report);
  return points_status;
}

Status LidarInertialOdometry::Impl::check_sweep(TimeNs start_ns, TimeNs end_ns,
                                                std::span<const LidarPoint> returns) const {
  const bool started = mapping::has_started(tracking) || track.border_ns();
  const std::span<const MotionSample> samples = track.samples();
  if (end_ns < start_ns) return {ErrorCode::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (started && start_ns < boundary.time_ns())
    return {ErrorCode::time_order, "start_ns", double(start_ns), double(boundary.time_ns())};
  if (samples.empty() && returns.empty()) return {ErrorCode::empty, "points", 0.0, 1.0};
  if (samples.empty()) return {ErrorCode::too_few, "imu samples", 0.0, 1.0};
  if (samples.back().time_ns < end_ns) {
    return {ErrorCode::too_few, "imu time_ns", double(samples.back().time_ns), double(end_ns)};
  }
  // If the lidar's clock is wrong, the first sweep may start before the first IMU sample. Before the first IMU sample,
  // the robot is assumed to be at rest.
  const double early_s = seconds(samples.front().from_ns - start_ns);
  if (!started && early_s > (params.time_offset_s != 0.0 ? SweepTrajectory::kExtrapolation_s : 0.0)) {
    return {ErrorCode::too_few, "start_ns", double(start_ns), double(samples.front().from_ns)};
  }
  return mapping::check_offsets(end_ns - start_ns, returns);
}

Status LidarInertialOdometry::Impl::level_at_first() {
  if (mapping::has_started(tracking) || track.border_ns()) return {};
  MotionState levelled;
  if (Status status = level_start(levelled); !status.ok()) return status;
  if (start_pose) levelled = mapping::moved_to(*start_pose, levelled);
  if (!track.starts_at_rest(params.expert.start.bias_rest_s)) {
    StateEstimate in_motion = mapping::estimate_before_map(params, levelled);
    if (start_tilt) in_motion = mapping::with_tilt(*start_tilt, in_motion);
    world = mapping::world_at_first_sweep(params, in_motion);
    boundary.state_estimate = mapping::estimate_at_first_sweep(params, in_motion);
    return {};
  }
  boundary.state_estimate = mapping::estimate_at_start(params, levelled);
  world = mapping::WorldCovariance(params.expert.world, levelled.q_WI, params.T_IL.translation(), levelled.p_WI_m);
  return {};
}

Status LidarInertialOdometry::Impl::level_start(MotionState& levelled) const {
  const Status status = mapping::start_at_rest(params, track.samples(), levelled);
  if (status.ok() && !track.starts_at_rest(params.expert.start.bias_rest_s)) mapping::widen_for_motion(levelled);
  return status;
}

/// If the first sweep begins after the first IMU sample, dead reckoning provides the state at its start (mapping.md,
/// "Start").
Status LidarInertialOdometry::Impl::start_map(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns,
                                              SweepReport& report) {
  const SweepCalibration calibration = boundary.state_estimate.mean.calibration;
  mapping::SweepPoints::Counts counts;
  const Status selected = scratch.points.select(params, returns, end_ns - start_ns, calibration, 0.0, counts);
  report.points_used = counts.used;
  report.isolated_points = counts.isolated;
  const std::size_t points = selected.ok() ? scratch.points.all().size() : 0;
  const bool usable = points >= params.expert.matching.matches_min;
  if (usable && !track.border_ns() && seconds(start_ns - boundary.time_ns()) <= kFirstSweepDelayMax_s) return {};
  if (usable) {
    const mapping::MotionPrior sweep_prior = std::exchange(known, mapping::InertialPrior{});
    if (Status status = dead_reckon(start_ns); !status.ok()) return status;
    known = sweep_prior;
    if (start_pose) boundary.state_estimate = mapping::moved_to(*start_pose, boundary.state_estimate);
    if (start_tilt) boundary.state_estimate = mapping::with_tilt(*start_tilt, boundary.state_estimate);
    world = mapping::world_at_first_sweep(params, boundary.state_estimate);
    boundary.state_estimate = mapping::estimate_at_first_sweep(params, boundary.state_estimate);
    return {};
  }
  if (Status status = dead_reckon(end_ns); !status.ok()) return status;
  known = mapping::InertialPrior{};
  if (!selected.ok()) return selected;
  return {ErrorCode::too_few, "points", double(points), double(params.expert.matching.matches_min)};
}

/// While the IMU is at rest, the measured gravity levels the attitude.
Status LidarInertialOdometry::Impl::dead_reckon(TimeNs end_ns) {
  MotionState levelled;
  if (!track.border_ns()) {
    if (Status status = level_start(levelled); !status.ok()) return status;
    boundary.state_estimate = mapping::estimate_before_map(params, levelled);
  }
  if (const std::optional<Eigen::Vector3d> force = track.resting_force(end_ns, params.expert.rest.levelling_max_s)) {
    if (Status status = mapping::level_at_rest(params, *force, levelled); !status.ok()) return status;
    levelled.time_ns = end_ns;
    if (!track.has_not_moved()) {
      mapping::unknowns::variances(levelled.covariance, mapping::unknowns::velocity)
          .setConstant(std::pow(Standstill::kCreepMax_m_s, 2));
    }
    boundary = mapping::SweepBoundary{.state_estimate = mapping::estimate_before_map(params, levelled)};
  }
  while (boundary.time_ns() < end_ns) {
    const TimeNs from_ns = boundary.time_ns(), to_ns = std::min(end_ns, from_ns + kStep_ns);
    const MotionWindow motion{track.samples_from(from_ns), to_ns, 0};
    if (Status status = continue_by_inertia(motion, track.rests_between(from_ns, to_ns), boundary, nullptr);
        !status.ok())
      return status;
    boundary.state_estimate = mapping::reset_origin_and_yaw(boundary.state_estimate, seconds(to_ns - from_ns));
  }
  track.prune_until(end_ns);
  return {};
}

/// A robot at rest measures only gravity, in the direction that the estimated attitude predicts.
bool LidarInertialOdometry::Impl::rests(const mapping::InertialTrack& inertial, const SweepTrajectory& motion,
                                        TimeNs end_ns) const {
  if (!inertial.rests_until(end_ns)) return false;
  const Eigen::Vector3d gained_m_s =
      motion.state(motion.duration_s()).v_WI_m_s - boundary.state_estimate.mean.state.v_WI_m_s;
  return !(gained_m_s.norm() > params.expert.rest.force_m_s2 * motion.duration_s());
}

void LidarInertialOdometry::Impl::register_to_map(const Prediction& prediction, const MotionWindow& motion,
                                                  mapping::SweepPoints& points, SweepTrajectory& trajectory,
                                                  SweepReport& report, Placed& placed) {
  if (map.empty()) {
    if (points.all().size() >= params.expert.matching.matches_min) placed.verdict = SweepVerdict::first;
    return;
  }
  const bool prior_certain = mapping::prior_is_certain(params, boundary, motion, trajectory);
  points.choose(params, trajectory);
  const mapping::Scene scene{motion.samples, motion.end_ns, points.chosen(), map.voxels()};
  const mapping::Attempt attempt = mapping::attempt(params, {tracking, prediction.prior, rejected_relocalisation()},
                                                    scene, scratch.aligner, trajectory, placed.alignment);
  report.points_registered = scene.points.size();
  report.iterations = attempt.iterations;
  report.inlier_ratio = attempt.inlier_ratio;
  if (placed.alignment) {
    const Registration::Result& aligned = *placed.alignment;
    report.innovation = mapping::innovation(prediction, aligned.mean);
    placed.expected = mapping::is_expected(params, prediction, aligned.mean, report.innovation);
    report.eigenvalue_ratio = aligned.eigenvalues[5] > 0.0 ? aligned.eigenvalues[0] / aligned.eigenvalues[5] : 0.0;
    report.least_constrained_direction = aligned.directions.col(0);
    report.least_constrained_sigma_m = aligned.least_constrained_sigma_m;
    report.saturation_deficit_rad_s = aligned.mean.deficit_rad_s.rowwise().mean();
  }
  mapping::judge(params, tracking, scene.points.size(), prior_certain, attempt, placed);
}

/// At rest after a tracking failure, update() also corrects `prediction`, because the lag window uses `prediction`.
StateEstimate LidarInertialOdometry::Impl::update(const MotionWindow& motion, const Placed& placed,
                                                  Prediction& prediction) const {
  if (placed.alignment) return mapping::posterior(prediction, *placed.alignment);
  if (mapping::is_lost(tracking)) predict_stationary(motion, boundary, prediction);
  return mapping::posterior(prediction);
}

void LidarInertialOdometry::Impl::predict_stationary(const MotionWindow& motion, const mapping::SweepBoundary& from,
                                                     Prediction& prediction) const {
  if (std::holds_alternative<mapping::InertialPrior>(known) && track.rests_until(motion.end_ns))
    mapping::predict_rest(from, prediction);
}

std::vector<InsertedPoint> LidarInertialOdometry::Impl::insert(const UpdatedSweep& sweep, mapping::SweepPoints& points,
                                                               bool has_ring_numbers, const Placed& placed,
                                                               SweepReport& report) {
  const StateEstimate& before = boundary.state_estimate;
  if (mapping::unknowns::variances(before.weight, mapping::unknowns::calibration).maxCoeff() > 0.0) {
    const SweepCalibration& now = sweep.start.mean.calibration;
    points.move(now, now.time_offset_s - before.mean.calibration.time_offset_s);
  }
  std::vector<InsertedPoint> inserted;
  const bool sure =
      placed.verdict == SweepVerdict::registered && !mapping::is_lost(tracking) && !mapping::is_unconfirmed(tracking);
  report.map_points_added =
      map.insert(params, {sweep.trajectory, sweep.start.weight, points.all(), has_ring_numbers, sure},
                 scratch.aligner.registration(), inserted);
  return inserted;
}

/// enter_window() needs the state at the end of the previous sweep, which boundary_after() replaces.
void LidarInertialOdometry::Impl::propagate(const UpdatedSweep& sweep, const Placed& placed, const MotionWindow& motion,
                                            std::vector<InsertedPoint> inserted, SweepReport& report) {
  const Registration::Result* aligned = placed.alignment ? &*placed.alignment : nullptr;
  const bool unconfirmed_before = mapping::is_unconfirmed(tracking);
  tracking = mapping::after_sweep(tracking, placed.placement, placed.verdict);
  report.relocalisation_unconfirmed = mapping::is_unconfirmed(tracking);
  propagate_alternative(motion, unconfirmed_before);
  report.consecutive_rejected_sweeps = mapping::consecutive_rejected_sweeps(tracking);
  if (aligned && placed.verdict == SweepVerdict::degenerate && motion.resting_sweeps == 0)
    world.add_drift(report.least_constrained_sigma_m, report.least_constrained_direction);
  report.trajectory = poses_along(sweep.trajectory, motion.end_ns, sweep.start.error);
  const Registration::Matrix to_end = mapping::unknowns_at(sweep.trajectory, sweep.trajectory.duration_s());
  report.map_sigma_m = world.sigma_in_map_m(mapping::propagate_pose_and_mounting(to_end, sweep.start.error),
                                            report.trajectory.back().p_WA_m);
  enter_window(sweep, motion, boundary, window).inserted = std::move(inserted);
  if (aligned) {
    window.smooth();
    window.move_inserted(map);
  }
  // The oldest sweep leaves the lag window with the next sweep, so the pose of the oldest sweep is final.
  if (window.is_full()) report.smoothed = poses_of(window.sweeps().front());
  mapping::boundary_after(params, sweep.start, motion, sweep.trajectory, aligned, boundary);
  report.pose = boundary.state_estimate.mean.state.pose();
  report.pose.covariance = report.trajectory.back().covariance;
  report.velocity_covariance_I_m2_s2 = mapping::velocity_covariance_I(
      boundary.state_estimate.mean.state,
      mapping::unknowns::block(boundary.state_estimate.error, mapping::unknowns::motion));
  if (placed.verdict != SweepVerdict::first) add_map_drift(sweep, report);
  prune_until(motion.end_ns);
}

void LidarInertialOdometry::Impl::add_map_drift(const UpdatedSweep& sweep, const SweepReport& report) {
  const double inserted_fraction =
      report.points_used == 0 ? 0.0 : double(report.map_points_added) / double(report.points_used);
  world.add_insertion(inserted_fraction, sweep.trajectory, sweep.start.error,
                      boundary.state_estimate.mean.calibration.T_IL.translation());
}

void LidarInertialOdometry::Impl::prune_until(TimeNs end_ns) {
  known = mapping::InertialPrior{};
  track.prune_until(end_ns);
  if (mapping::is_unconfirmed(tracking)) return;  // pruning would change the sweep numbers for remove_sweeps_since()
  if (localiser.is_localised()) return;           // the prior map is never pruned
  if (map.prune(params, boundary.state_estimate.mean.state.p_WI_m)) window.clear_inserted();
}

void LidarInertialOdometry::Impl::propagate_alternative(const MotionWindow& motion, bool unconfirmed_before) {
  const bool relocalisation_unconfirmed = mapping::is_unconfirmed(tracking);
  if (relocalisation_unconfirmed && !unconfirmed_before) {
    mapping::DeadReckoning& reckoning_start =
        other.emplace();  // constructed in place, because it is too large for the stack
    reckoning_start.boundary = boundary;
    reckoning_start.window = window;
    reckoning_start.window.clear_inserted();
    reckoning_start.world = world;
    reckoning_start.inserted_from = map.sweeps() - 1;
  }
  if (!relocalisation_unconfirmed && !mapping::is_lost(tracking)) other.reset();
  if (!other) return;
  const bool rests = std::holds_alternative<mapping::InertialPrior>(known) && track.rests_until(motion.end_ns);
  if (!continue_by_inertia(motion, rests, other->boundary, &other->window).ok()) other.reset();
}

/// Propagates the state over a sweep without using lidar points. If `into` is not null, the sweep also enters the lag
/// window `into`.
Status LidarInertialOdometry::Impl::continue_by_inertia(const MotionWindow& motion, bool rests,
                                                        mapping::SweepBoundary& at, mapping::LagWindow* into) const {
  const Registration::Estimate& before = at.state_estimate.mean;
  SweepTrajectory trajectory;
  if (Status status = trajectory.build(before.state, motion.samples, motion.end_ns, before.calibration.gravity_W_m_s2);
      !status.ok())
    return status;
  const std::unique_ptr<Prediction> prediction(new Prediction(mapping::predict(params, at, motion, trajectory, known)));
  if (rests) mapping::predict_rest(at, *prediction);
  const std::unique_ptr<const StateEstimate> start(new StateEstimate(mapping::posterior(*prediction)));
  const Registration::Estimate& mean = start->mean;
  if (Status status = trajectory.build(mean.state, motion.samples, motion.end_ns, mean.calibration.gravity_W_m_s2,
                                       mean.deficit_rad_s);
      !status.ok())
    return status;
  if (into != nullptr) enter_window({*prediction, *start, trajectory}, motion, at, *into);
  mapping::boundary_after(params, *start, motion, trajectory, nullptr, at);
  return {};
}

/// Removes the map points that were inserted since a wrong relocalisation, and continues from the inertial pose. The
/// wrong pose remains a starting pose of the search after a tracking failure.
void LidarInertialOdometry::Impl::revert_to_inertia() {
  map.remove_sweeps_since(std::exchange(other->inserted_from, 0));  // 0, because pruning changes sweep numbers
  std::swap(boundary, other->boundary);
  std::swap(window, other->window);
  other->window.clear_inserted();
  std::swap(world, other->world);
  tracking = mapping::after_reverted_relocalisation(tracking);
}

const MotionState* LidarInertialOdometry::Impl::rejected_relocalisation() const {
  return other && mapping::is_lost(tracking) ? &other->boundary.state_estimate.mean.state : nullptr;
}

WindowSweep& LidarInertialOdometry::Impl::enter_window(const UpdatedSweep& sweep, const MotionWindow& motion,
                                                       const mapping::SweepBoundary& from, mapping::LagWindow& into) {
  WindowSweep& newest = into.enter();
  newest.predicted.mean = sweep.prediction.prior.mean;
  newest.predicted.errors = sweep.prediction.errors;
  newest.jacobian_previous.noalias() = sweep.prediction.jacobian_boundary * from.end_start_jacobian;
  newest.filtered.mean = sweep.start.mean;
  newest.filtered.errors = sweep.start.error;
  newest.smoothed = newest.filtered;
  newest.samples.assign(motion.samples.begin(), motion.samples.end());
  newest.end_ns = motion.end_ns;
  return newest;
}

PoseState LidarInertialOdometry::Impl::pose_along(const SweepTrajectory& motion, double t_s,
                                                  const Registration::Matrix& errors) const {
  const Registration::Matrix F = mapping::unknowns_at(motion, t_s);
  PoseState pose = motion.state(t_s).pose();
  pose.covariance = world.in_world(mapping::propagate_pose_and_mounting(F, errors), pose.p_WA_m);
  return pose;
}

std::vector<PoseState> LidarInertialOdometry::Impl::poses_along(const SweepTrajectory& motion, TimeNs end_ns,
                                                                const Registration::Matrix& errors) const {
  std::vector<PoseState> poses;
  for (std::size_t i = 0; i < motion.intervals(); ++i)
    poses.push_back(pose_along(motion, std::min(motion.interval_end_s(i), motion.duration_s()), errors));
  poses.back().time_ns = end_ns;
  return poses;
}

std::vector<PoseState> LidarInertialOdometry::Impl::poses_of(const WindowSweep& sweep) const {
  SweepTrajectory motion;
  if (!sweep.motion(motion).ok()) return {};
  return poses_along(motion, sweep.end_ns, sweep.smoothed.errors);
}

}  // namespace tumble
