// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "odometry_impl.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "unknowns.hpp"

namespace tumble {

using mapping::StateEstimate, mapping::InsertedPoint, mapping::MotionWindow, mapping::SweepRegistration,
    mapping::Prediction;
using mapping::UpdatedSweep, mapping::WindowSweep;

namespace {

constexpr double kFirstSweepDelayMax_s = 0.5;  // maximum delay between first IMU sample and first sweep
// time step of dead reckoning, and time interval for which the process noise is specified
constexpr TimeNs kStep_ns = 100'000'000;
constexpr double kLongRest_s = 1.0;  // duration of a rest that determines the tilt, if it contradicts the attitude

}  // namespace

Status LidarInertialOdometry::Impl::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns,
                                              SweepResult& report) {
  if (Status status = check_sweep(start_ns, end_ns, returns); !status.ok()) return status;
  if (Status status = initialise_inclination(); !status.ok()) return status;

  if (!mapping::has_started(tracking)) {
    if (Status status = start_map(start_ns, end_ns, returns, report); !status.ok()) return status;
  }
  SweepTrajectory& trajectory = sweep_scratch.trajectory;
  const Registration::Estimate& before = sweep_boundary.state_estimate.mean;
  if (Status status =
          trajectory.build(before.state, inertial_track.samples(), end_ns, before.calibration.gravity_W_m_s2);
      !status.ok())
    return status;
  const int previous_resting_sweeps = resting_sweeps;
  resting_sweeps = is_stationary(inertial_track, trajectory, end_ns) ? resting_sweeps + 1 : 0;
  const MotionWindow motion{
      inertial_track.samples(), end_ns, resting_sweeps,
      resting_sweeps == 0 ? inertial_track.resting_force(end_ns, kLongRest_s) : std::optional<Eigen::Vector3d>()};
  const std::unique_ptr<Prediction> prediction(new Prediction(
      mapping::predict(params, sweep_boundary, motion, trajectory, odometer_reading)));  // too large for the stack

  // A sweep without usable returns gets the inertially predicted pose.
  mapping::SweepPoints& points = sweep_scratch.points;
  mapping::SweepPoints::Counts counts;
  const Status points_status = points.select_returns(params, returns, end_ns - start_ns, before.calibration,
                                                     seconds(start_ns - sweep_boundary.time_ns()), counts);
  report.usable_points = counts.usable_points;
  report.isolated_points_dropped = counts.isolated;
  const auto placed = std::make_unique<SweepRegistration>();
  if (points_status.ok()) register_to_map(*prediction, motion, points, trajectory, report, *placed);
  if (alternative && mapping::contradicts_tracking(tracking, placed->outcome)) {  // repeat without the relocalisation
    revert_to_inertial_pose();
    resting_sweeps = previous_resting_sweeps;
    report = SweepResult{};
    return add_sweep(start_ns, end_ns, returns, report);
  }
  report.verdict = placed->verdict;
  report.in_prior_map = localiser.is_localised();

  const std::unique_ptr<const StateEstimate> start(new StateEstimate(update(motion, *placed, *prediction)));
  if (!placed->alignment) {  // a failed attempt may have changed the trajectory
    const Registration::Estimate& mean = start->mean;
    const Status status = trajectory.build(mean.state, motion.samples, motion.end_ns, mean.calibration.gravity_W_m_s2,
                                           mean.saturation_deficit_rad_s);
    if (!status.ok()) return status;
  }
  const UpdatedSweep sweep{*prediction, *start, trajectory};
  std::vector<InsertedPoint> inserted;
  if (extends_map() && (placed->verdict != SweepVerdict::rejected || placed->map_too_sparse))
    inserted = insert(sweep, points, counts.has_ring_numbers, *placed, report);
  propagate(sweep, *placed, motion, std::move(inserted), report);
  localise(report);
  return points_status;
}

Status LidarInertialOdometry::Impl::check_sweep(TimeNs start_ns, TimeNs end_ns,
                                                std::span<const LidarPoint> returns) const {
  const bool started = mapping::has_started(tracking) || inertial_track.sweep_boundary_ns();
  const std::span<const MotionSample> samples = inertial_track.samples();
  if (end_ns < start_ns) return {ErrorCode::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (started && start_ns < sweep_boundary.time_ns())
    return {ErrorCode::time_order, "start_ns", double(start_ns), double(sweep_boundary.time_ns())};
  if (samples.empty() && returns.empty()) return {ErrorCode::empty, "points", 0.0, 1.0};
  if (samples.empty()) return {ErrorCode::insufficient_data, "imu samples", 0.0, 1.0};
  if (samples.back().time_ns < end_ns) {
    return {ErrorCode::insufficient_data, "imu time_ns", double(samples.back().time_ns), double(end_ns)};
  }
  // A time offset between lidar and IMU may shift the start of the first sweep to a time before the first IMU sample.
  // SweepTrajectory extrapolates the motion to times before the first IMU sample.
  const double early_s = seconds(samples.front().from_ns - start_ns);
  if (!started && early_s > (params.imu_minus_lidar_clock_s != 0.0 ? SweepTrajectory::kExtrapolation_s : 0.0)) {
    return {ErrorCode::insufficient_data, "start_ns", double(start_ns), double(samples.front().from_ns)};
  }
  return mapping::check_time_offsets(end_ns - start_ns, returns);
}

Status LidarInertialOdometry::Impl::initialise_inclination() {
  if (mapping::has_started(tracking) || inertial_track.sweep_boundary_ns()) return {};
  MotionState levelled;
  if (Status status = level_start(levelled); !status.ok()) return status;
  if (start_pose) levelled = mapping::transformed_to_pose(*start_pose, levelled);
  if (!inertial_track.starts_at_rest(OdometryStart::kBiasRest_s)) {
    StateEstimate in_motion = mapping::estimate_before_map(params, levelled);
    if (start_tilt_correction) in_motion = mapping::with_start_tilt(*start_tilt_correction, in_motion);
    world_covariance = mapping::world_at_first_sweep(params, in_motion);
    sweep_boundary.state_estimate = mapping::estimate_at_first_sweep(params, in_motion);
    return {};
  }
  sweep_boundary.state_estimate = mapping::estimate_at_start(params, levelled);
  world_covariance = mapping::WorldCovariance(params.expert.world_covariance, levelled.q_WI, params.T_IL.translation(),
                                              levelled.p_WI_m);
  return {};
}

Status LidarInertialOdometry::Impl::level_start(MotionState& levelled) const {
  if (inertial_track.starts_at_rest(OdometryStart::kBiasRest_s))
    return mapping::start_at_rest(inertial_track.samples(), levelled);
  levelled = mapping::start_in_motion(inertial_track.samples(), params.expert.gravity_m_s2);
  return {};
}

Status LidarInertialOdometry::Impl::start_map(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> returns,
                                              SweepResult& report) {
  const LidarImuCalibration calibration = sweep_boundary.state_estimate.mean.calibration;
  mapping::SweepPoints::Counts counts;
  Status selected = sweep_scratch.points.select_returns(params, returns, end_ns - start_ns, calibration, 0.0, counts);
  report.usable_points = counts.usable_points;
  report.isolated_points_dropped = counts.isolated;
  const std::size_t points = selected.ok() ? sweep_scratch.points.all().size() : 0;
  const bool usable = points >= MatchingParams::kMatchesMin;
  if (usable && world_covariance.tilt_sigma_rad() <= mapping::kStartTiltSigmaMax_rad &&
      !inertial_track.sweep_boundary_ns() && seconds(start_ns - sweep_boundary.time_ns()) <= kFirstSweepDelayMax_s)
    return {};
  if (usable) {
    const std::optional<OdometerReading> sweep_reading = std::exchange(odometer_reading, std::nullopt);
    if (Status status = dead_reckon(start_ns); !status.ok()) return status;
    odometer_reading = sweep_reading;
    StateEstimate reckoned = sweep_boundary.state_estimate;
    if (start_pose) reckoned = mapping::transformed_to_pose(*start_pose, reckoned);
    if (start_tilt_correction) reckoned = mapping::with_start_tilt(*start_tilt_correction, reckoned);
    world_covariance = mapping::world_at_first_sweep(params, reckoned);
    const double tilt_rad = world_covariance.tilt_sigma_rad();
    if (tilt_rad <= mapping::kStartTiltSigmaMax_rad) {
      sweep_boundary.state_estimate = mapping::estimate_at_first_sweep(params, reckoned);
      return {};
    }
    selected = {ErrorCode::insufficient_data, "start_tilt_sigma_rad", tilt_rad, mapping::kStartTiltSigmaMax_rad};
  }
  if (Status status = dead_reckon(end_ns); !status.ok()) return status;
  odometer_reading.reset();
  if (!selected.ok()) return selected;
  return {ErrorCode::insufficient_data, "points", double(points), double(MatchingParams::kMatchesMin)};
}

/// While the IMU is at rest, the mean specific force determines roll and pitch of the dead-reckoned state.
Status LidarInertialOdometry::Impl::dead_reckon(TimeNs end_ns) {
  MotionState levelled;
  if (!inertial_track.sweep_boundary_ns()) {
    if (Status status = level_start(levelled); !status.ok()) return status;
    sweep_boundary.state_estimate = mapping::estimate_before_map(params, levelled);
  }
  if (const std::optional<Eigen::Vector3d> force =
          inertial_track.resting_force(end_ns, StationaryBounds::kLevellingMax_s)) {
    if (Status status = mapping::level_at_rest(*force, levelled); !status.ok()) return status;
    levelled.time_ns = end_ns;
    if (!inertial_track.has_not_moved()) {
      mapping::unknowns::variances(levelled.covariance, mapping::unknowns::velocity)
          .setConstant(std::pow(Standstill::kCreepMax_m_s, 2));
    }
    sweep_boundary = mapping::SweepBoundary{.state_estimate = mapping::estimate_before_map(params, levelled)};
  }
  while (sweep_boundary.time_ns() < end_ns) {
    const TimeNs from_ns = sweep_boundary.time_ns(), to_ns = std::min(end_ns, from_ns + kStep_ns);
    const MotionWindow motion{inertial_track.motion_samples_from(from_ns), to_ns, 0};
    if (Status status =
            continue_by_inertia(motion, inertial_track.is_stationary_between(from_ns, to_ns), sweep_boundary, nullptr);
        !status.ok())
      return status;
    sweep_boundary.state_estimate =
        mapping::reset_origin_and_yaw(sweep_boundary.state_estimate, seconds(to_ns - from_ns));
  }
  inertial_track.prune_until(end_ns);
  return {};
}

/// At rest, the inertially predicted velocity must stay nearly constant. If the estimated attitude is wrong, the
/// predicted velocity changes, because gravity is subtracted in a wrong direction.
bool LidarInertialOdometry::Impl::is_stationary(const mapping::InertialTrack& inertial, const SweepTrajectory& motion,
                                                TimeNs end_ns) const {
  if (!inertial.is_stationary_until(end_ns)) return false;
  const Eigen::Vector3d gained_m_s =
      motion.state(motion.duration_s()).v_WI_m_s - sweep_boundary.state_estimate.mean.state.v_WI_m_s;
  return !(gained_m_s.norm() > StationaryBounds::kForce_m_s2 * motion.duration_s());
}

void LidarInertialOdometry::Impl::register_to_map(const Prediction& prediction, const MotionWindow& motion,
                                                  mapping::SweepPoints& points, SweepTrajectory& trajectory,
                                                  SweepResult& report, SweepRegistration& placed) {
  if (map.empty()) {
    if (points.all().size() >= MatchingParams::kMatchesMin) placed.verdict = SweepVerdict::first;
    return;
  }
  const bool prior_certain = mapping::prior_is_certain(params, sweep_boundary, motion, trajectory);
  points.choose_points_per_voxel(params, trajectory);
  const mapping::RegistrationScene scene{motion.samples, motion.end_ns, points.sampled_points(), map.voxels()};
  const mapping::RegistrationAttempt attempt =
      mapping::attempt_registration(params, {tracking, prediction.prior, rejected_relocalisation()}, scene,
                                    sweep_scratch.sweep_aligner, trajectory, placed.alignment);
  report.points_after_downsampling = scene.points.size();
  report.iterations = attempt.iterations;
  report.inlier_ratio = attempt.inlier_ratio;
  if (placed.alignment) {
    const Registration::Result& aligned = *placed.alignment;
    report.normalised_innovation = mapping::innovation(prediction, aligned.mean);
    placed.agrees_with_prediction =
        mapping::agrees_with_prediction(params, prediction, aligned.mean, report.normalised_innovation);
    report.eigenvalue_ratio = aligned.eigenvalues[5] > 0.0 ? aligned.eigenvalues[0] / aligned.eigenvalues[5] : 0.0;
    report.least_constrained_pose_direction_W = aligned.directions.col(0);
    report.least_constrained_sigma_m = aligned.least_constrained_sigma_m;
    report.mean_saturation_deficit_I_rad_s = aligned.mean.saturation_deficit_rad_s.rowwise().mean();
  }
  mapping::judge_registration(tracking, scene.points.size(), prior_certain, attempt, placed);
}

StateEstimate LidarInertialOdometry::Impl::update(const MotionWindow& motion, const SweepRegistration& placed,
                                                  Prediction& prediction) const {
  if (placed.alignment) return mapping::posterior(prediction, *placed.alignment);
  if (mapping::is_lost(tracking)) predict_stationary(motion, sweep_boundary, prediction);
  return mapping::posterior(prediction);
}

void LidarInertialOdometry::Impl::predict_stationary(const MotionWindow& motion, const mapping::SweepBoundary& from,
                                                     Prediction& prediction) const {
  if (!odometer_reading && inertial_track.is_stationary_until(motion.end_ns))
    mapping::predict_stationary_sweep(from, prediction);
}

std::vector<InsertedPoint> LidarInertialOdometry::Impl::insert(const UpdatedSweep& sweep, mapping::SweepPoints& points,
                                                               bool has_ring_numbers, const SweepRegistration& placed,
                                                               SweepResult& report) {
  const StateEstimate& before = sweep_boundary.state_estimate;
  if (mapping::unknowns::variances(before.prior_weight_covariance, mapping::unknowns::calibration).maxCoeff() > 0.0) {
    const LidarImuCalibration& now = sweep.start.mean.calibration;
    points.apply_calibration_shift(now, now.imu_minus_lidar_clock_s - before.mean.calibration.imu_minus_lidar_clock_s);
  }
  std::vector<InsertedPoint> inserted;
  const bool sure = placed.verdict == SweepVerdict::registered && !mapping::is_lost(tracking) &&
                    !mapping::is_unconfirmed_relocalisation(tracking);
  report.map_points_added =
      map.insert(params, {sweep.trajectory, sweep.start.prior_weight_covariance, points.all(), has_ring_numbers, sure},
                 sweep_scratch.sweep_aligner.registration(), inserted);
  return inserted;
}

void LidarInertialOdometry::Impl::propagate(const UpdatedSweep& sweep, const SweepRegistration& placed,
                                            const MotionWindow& motion, std::vector<InsertedPoint> inserted,
                                            SweepResult& report) {
  const Registration::Result* aligned = placed.alignment ? &*placed.alignment : nullptr;
  const bool unconfirmed_before = mapping::is_unconfirmed_relocalisation(tracking);
  tracking = mapping::tracking_state_after_sweep(tracking, placed.outcome, placed.verdict);
  report.relocalisation_unconfirmed = mapping::is_unconfirmed_relocalisation(tracking);
  propagate_alternative_pose(motion, unconfirmed_before);
  report.consecutive_rejected_sweeps = mapping::consecutive_rejected_sweeps(tracking);
  if (aligned && placed.verdict == SweepVerdict::degenerate && motion.resting_sweeps == 0)
    world_covariance.add_drift(report.least_constrained_sigma_m, report.least_constrained_pose_direction_W);
  report.trajectory = poses_along(sweep.trajectory, motion.end_ns, sweep.start.state_error_covariance);
  const Registration::Matrix to_end = mapping::unknowns_at(sweep.trajectory, sweep.trajectory.duration_s());
  report.position_in_map_sigma_m =
      world_covariance.sigma_in_map_m(mapping::propagate_pose_and_mounting(to_end, sweep.start.state_error_covariance),
                                      report.trajectory.back().position_W_m);
  append_to_lag_window(sweep, motion, sweep_boundary, window).inserted = std::move(inserted);
  if (aligned) {
    window.smooth();
    window.move_inserted_sweeps(map);
  }
  if (window.is_full()) report.final_poses_of_earlier_sweep = poses_of(window.sweeps().front());
  mapping::sweep_boundary_after(params, sweep.start, motion, sweep.trajectory, aligned, sweep_boundary);
  report.pose = sweep_boundary.state_estimate.mean.state.pose();
  report.pose.covariance = report.trajectory.back().covariance;
  report.velocity_covariance_I_m2_s2 = mapping::velocity_covariance_I(
      sweep_boundary.state_estimate.mean.state,
      mapping::unknowns::sub_block(sweep_boundary.state_estimate.state_error_covariance, mapping::unknowns::motion));
  if (placed.verdict != SweepVerdict::first) add_map_drift(sweep, report);
  prune_until(motion.end_ns);
}

void LidarInertialOdometry::Impl::add_map_drift(const UpdatedSweep& sweep, const SweepResult& report) {
  const double inserted_fraction =
      report.usable_points == 0 ? 0.0 : double(report.map_points_added) / double(report.usable_points);
  world_covariance.add_inserted_sweep(inserted_fraction, sweep.trajectory, sweep.start.state_error_covariance,
                                      sweep_boundary.state_estimate.mean.calibration.T_IL.translation());
}

void LidarInertialOdometry::Impl::prune_until(TimeNs end_ns) {
  odometer_reading.reset();
  inertial_track.prune_until(end_ns);
  if (mapping::is_unconfirmed_relocalisation(tracking))
    return;                              // pruning would change the sweep numbers for remove_sweeps_since()
  if (localiser.is_localised()) return;  // the prior map is never pruned
  if (map.prune(params, sweep_boundary.state_estimate.mean.state.p_WI_m)) window.clear_inserted();
}

void LidarInertialOdometry::Impl::propagate_alternative_pose(const MotionWindow& motion, bool unconfirmed_before) {
  const bool relocalisation_unconfirmed = mapping::is_unconfirmed_relocalisation(tracking);
  if (relocalisation_unconfirmed && !unconfirmed_before) {
    mapping::DeadReckoning& reckoning_start =
        alternative.emplace();  // constructed in place, because it is too large for the stack
    reckoning_start.sweep_boundary = sweep_boundary;
    reckoning_start.window = window;
    reckoning_start.window.clear_inserted();
    reckoning_start.world_covariance = world_covariance;
    reckoning_start.first_inserted_sweep = map.sweeps() - 1;
  }
  if (!relocalisation_unconfirmed && !mapping::is_lost(tracking)) alternative.reset();
  if (!alternative) return;
  const bool rests = !odometer_reading && inertial_track.is_stationary_until(motion.end_ns);
  if (!continue_by_inertia(motion, rests, alternative->sweep_boundary, &alternative->window).ok()) alternative.reset();
}

Status LidarInertialOdometry::Impl::continue_by_inertia(const MotionWindow& motion, bool rests,
                                                        mapping::SweepBoundary& at, mapping::LagWindow* into) const {
  const Registration::Estimate& before = at.state_estimate.mean;
  SweepTrajectory trajectory;
  if (Status status = trajectory.build(before.state, motion.samples, motion.end_ns, before.calibration.gravity_W_m_s2);
      !status.ok())
    return status;
  const std::unique_ptr<Prediction> prediction(
      new Prediction(mapping::predict(params, at, motion, trajectory, odometer_reading)));
  if (rests) mapping::predict_stationary_sweep(at, *prediction);
  const std::unique_ptr<const StateEstimate> start(new StateEstimate(mapping::posterior(*prediction)));
  const Registration::Estimate& mean = start->mean;
  if (Status status = trajectory.build(mean.state, motion.samples, motion.end_ns, mean.calibration.gravity_W_m_s2,
                                       mean.saturation_deficit_rad_s);
      !status.ok())
    return status;
  if (into != nullptr) append_to_lag_window({*prediction, *start, trajectory}, motion, at, *into);
  mapping::sweep_boundary_after(params, *start, motion, trajectory, nullptr, at);
  return {};
}

void LidarInertialOdometry::Impl::revert_to_inertial_pose() {
  map.remove_sweeps_since(
      std::exchange(alternative->first_inserted_sweep, 0));  // 0, because pruning changes sweep numbers
  std::swap(sweep_boundary, alternative->sweep_boundary);
  std::swap(window, alternative->window);
  alternative->window.clear_inserted();
  std::swap(world_covariance, alternative->world_covariance);
  tracking = mapping::after_reverted_relocalisation(tracking);
}

const MotionState* LidarInertialOdometry::Impl::rejected_relocalisation() const {
  return alternative && mapping::is_lost(tracking) ? &alternative->sweep_boundary.state_estimate.mean.state : nullptr;
}

WindowSweep& LidarInertialOdometry::Impl::append_to_lag_window(const UpdatedSweep& sweep, const MotionWindow& motion,
                                                               const mapping::SweepBoundary& from,
                                                               mapping::LagWindow& into) {
  WindowSweep& newest = into.append_sweep();
  newest.predicted.mean = sweep.prediction.prior.mean;
  newest.predicted.error_covariance = sweep.prediction.motion_error_covariance;
  newest.jacobian_previous.noalias() = sweep.prediction.boundary_jacobian * from.end_by_start_jacobian;
  newest.filtered.mean = sweep.start.mean;
  newest.filtered.error_covariance = sweep.start.state_error_covariance;
  newest.smoothed = newest.filtered;
  newest.samples.assign(motion.samples.begin(), motion.samples.end());
  newest.end_ns = motion.end_ns;
  return newest;
}

PoseState LidarInertialOdometry::Impl::pose_along(const SweepTrajectory& motion, double t_s,
                                                  const Registration::Matrix& errors) const {
  const Registration::Matrix F = mapping::unknowns_at(motion, t_s);
  PoseState pose = motion.state(t_s).pose();
  pose.covariance = world_covariance.in_world_frame(mapping::propagate_pose_and_mounting(F, errors), pose.position_W_m);
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
  return poses_along(motion, sweep.end_ns, sweep.smoothed.error_covariance);
}

}  // namespace tumble
