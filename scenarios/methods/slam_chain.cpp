// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/slam_conclusion.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "scenarios/methods/slam_settings.hpp"
#include "scenarios/methods/sweep_log.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/detail/sweep_scale.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/registration_params.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kMaxDeviations = StatedCalibration::kMaxDeviations;
constexpr int kSearches = 3;  // additional passes for a calibration that has not converged

LidarInertialOdometry::Params odometry_params(const sim::Sensors& sensors, const SlamStage& stage,
                                              const SlamChain& chain) {
  SlamParams params = stage.settings.defaults();
  LidarInertialOdometry::Params& odometry = params.odometry;
  odometry.T_IL = bridge::T_IL(sensors.imus.front(), sensors.lidars.front());
  odometry.expert.gravity_m_s2 = sensors.gravity_m_s2;
  const double accel_range_m_s2 = sensors.imus.front().stated_accel_range_m_s2;
  if (accel_range_m_s2 > 0.0) odometry.expert.rails.accel_m_s2 = unsaturated_range(accel_range_m_s2);
  if (chain.along) {
    odometry.expert.matching.correction_max_m = chain.along->correction_max_m;
    odometry.expert.matching.correction_max_rad = chain.along->correction_max_rad;
  }
  stage.settings.apply(stage.parameters, params);
  if (params.flight_arc) odometry.expert.flight.body.emplace().p_IB_I_m = -bridge::lever_arm_I_m(sensors.imus.front());
  return odometry;
}

/// Cuts a sweep at the end of the IMU data if most of the sweep remains. Without the cut, a clock offset would drop the
/// last sweep.
bool shorten(std::int64_t end_ns, bridge::Sweep& sweep) {
  if (end_ns >= sweep.end_ns) return true;
  const std::int64_t left_ns = end_ns - sweep.start_ns;
  if (2 * left_ns < sweep.end_ns - sweep.start_ns) return false;
  // Points beyond the sweep's end are kept, because they are a fault of the recording that the mapper reports.
  const std::int64_t length_ns = sweep.end_ns - sweep.start_ns;
  std::erase_if(sweep.points, [&](const LidarPoint& p) { return p.offset_ns > left_ns && p.offset_ns <= length_ns; });
  sweep.end_ns = end_ns;
  return true;
}

/// Feeds a recording to the mapper and collects the sweeps in `estimate`.
class SweepFeed {
 public:
  SweepFeed(std::span<const ImuSample> samples, TimeNs offset_ns, const KnownMotion* along,
            LidarInertialOdometry& odometry, Estimate& estimate)
      : samples_(samples), offset_ns_(offset_ns), along_(along), odometry_(odometry), estimate_(estimate) {}

  /// Adds the IMU samples up to the sweep's end, then the sweep. Returns false on error; the status of the estimate
  /// then states the reason.
  bool add(bridge::Sweep sweep) {
    if (!add_samples(sweep.end_ns + offset_ns_)) return false;
    if (!shorten(samples_.back().time_ns - offset_ns_, sweep)) {
      leave_out_unfinished(estimate_);
      return true;
    }
    return add_motion(sweep.end_ns + offset_ns_) && add_points(sweep);
  }

  /// Processes the sweeps that are pending at the end of the recording.
  void finish() {
    for (std::vector<PoseState>& open : odometry_.window_trajectories()) apply_next(std::move(open));
  }

 private:
  /// Adds IMU samples up to the first sample at or after `to_ns`.
  bool add_samples(TimeNs to_ns) {
    while (next_ < samples_.size() && (next_ == 0 || samples_[next_ - 1].time_ns < to_ns)) {
      estimate_.status = odometry_.add_imu(samples_[next_], estimate_.rates[next_]);
      if (!estimate_.status.ok()) return false;
      ++next_;
    }
    return true;
  }

  /// Adds the odometer's motion from the end of the last sweep, if available.
  bool add_motion(TimeNs to_ns) {
    if (!along_ || estimate_.sweeps.empty()) return true;
    const std::optional<MotionReading> motion = along_->between(estimate_.sweeps.back().pose.time_ns, to_ns);
    if (motion) estimate_.status = odometry_.add_reading(*motion);
    return estimate_.status.ok();
  }

  bool add_points(const bridge::Sweep& sweep) {
    SweepReport report;
    const Status status = odometry_.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, report);
    // The IMU readings start after the sweep, so the sweep has no pose.
    if (status.trouble == Trouble::too_few && report.trajectory.empty()) {
      leave_out_unfinished(estimate_);
      return true;
    }
    if (leave_out_before_map(status, report, estimate_)) return true;
    const bool left_the_window = !report.smoothed.empty();
    std::vector<PoseState> smoothed = std::move(report.smoothed);
    const TimeNs end_ns = report.pose.time_ns;
    if (!append_sweep(status, end_ns, std::move(report), estimate_)) return false;
    if (left_the_window) apply_next(std::move(smoothed));
    return true;
  }

  void apply_next(std::vector<PoseState> smoothed) {
    apply_smoothed(std::move(smoothed), estimate_.sweeps[smoothed_++]);
  }

  std::span<const ImuSample> samples_;
  TimeNs offset_ns_;
  const KnownMotion* along_;
  LidarInertialOdometry& odometry_;
  Estimate& estimate_;
  std::size_t next_ = 0;      ///< next sample
  std::size_t smoothed_ = 0;  ///< number of smoothed sweeps
};

/// Processes the whole recording and adds the sweeps to `estimate`.
void run_sweeps(const sim::LidarRecord& lidar, std::span<const ImuSample> samples, LidarInertialOdometry& odometry,
                double time_offset_s, const SlamChain& chain, Estimate& estimate) {
  const auto offset_ns = static_cast<TimeNs>(std::llround(time_offset_s * 1e9));
  SweepFeed feed(samples, offset_ns, chain.along, odometry, estimate);
  const std::size_t sweeps = bridge::sweep_count(lidar);
  for (std::size_t k = 0; k < sweeps; ++k) {
    if (!feed.add(bridge::sweep(lidar, k))) return;
    if (chain.on_sweep) chain.on_sweep(k + 1, sweeps);
  }
  feed.finish();
}

/// Reports how far the calibration moved from its initial value.
void report_calibration(const LidarInertialOdometry& odometry, const sim::Sensors& sensors,
                        std::map<std::string, double>& health) {
  SweepCalibration given;
  given.T_IL = bridge::T_IL(sensors.imus.front(), sensors.lidars.front());
  const auto moved = odometry.calibration().minus(given);
  health["calibration_rotation_rad"] = moved.head<3>().norm();
  health["calibration_translation_m"] = moved.segment<3>(3).norm();
  health["calibration_time_offset_s"] = moved[6];
}

/// Returns the initial calibration of a run with its stated uncertainty.
StatedCalibration stated_calibration(const LidarInertialOdometry::Params& started,
                                     const LidarInertialOdometry::Params& given) {
  StatedCalibration out;
  out.calibration.T_IL = started.T_IL;
  out.calibration.time_offset_s = started.time_offset_s;
  out.mount_sigma_rad = given.mount_sigma_rad;
  out.mount_sigma_m = given.mount_sigma_m;
  out.time_offset_sigma_s = given.time_offset_sigma_s;
  return out;
}

/// Returns true if few enough sweeps were rejected to use the calibration of the run.
bool determines_calibration(const Estimate& run) {
  const auto rejected = std::count_if(run.sweeps.begin(), run.sweeps.end(),
                                      [](const auto& sweep) { return sweep.verdict == SweepVerdict::rejected; });
  return 5 * static_cast<std::size_t>(rejected) <= run.sweeps.size();
}

/// The first pass estimates the calibration. The last pass starts from this calibration and builds a consistent map. If
/// the calibration moves further than its stated uncertainty allows, another pass starts from the new value with the
/// initial uncertainty. Passes repeat until the calibration converges.
Estimate run_passes(const sim::LidarRecord& lidar, std::span<const ImuSample> samples,
                    const LidarInertialOdometry::Params& given, const SlamChain& chain, const Estimate& before,
                    LidarInertialOdometry& odometry, CalibrationVerdict& verdict) {
  LidarInertialOdometry::Params params = given;
  Estimate run = before;
  run_sweeps(lidar, samples, odometry, params.time_offset_s, chain, run);
  if (!chain.calibration) return run;
  double mahalanobis = 0.0;
  int passes = 1;
  const auto again = [&] {
    run = before;
    odometry = LidarInertialOdometry(params);
    run_sweeps(lidar, samples, odometry, params.time_offset_s, chain, run);
    ++passes;
  };
  const auto start_from = [&](const SweepCalibration& learnt) {
    params.T_IL = learnt.T_IL;
    params.time_offset_s = learnt.time_offset_s;
  };
  while (run.status.ok() && determines_calibration(run)) {
    mahalanobis = stated_calibration(params, given).deviations(odometry.calibration());
    if (mahalanobis <= kMaxDeviations || passes > kSearches) break;
    start_from(odometry.calibration());
    again();
  }
  const bool converged = run.status.ok() && determines_calibration(run) && mahalanobis <= kMaxDeviations;
  if (converged) {
    const auto sigma = odometry.calibration_weighting_covariance().diagonal().cwiseSqrt().eval();
    start_from(odometry.calibration());
    params.mount_sigma_rad = sigma.head<3>().maxCoeff();
    params.mount_sigma_m = sigma.segment<3>(3).maxCoeff();
    params.time_offset_sigma_s = sigma[6];
    again();
  }
  if (passes > 1) run.health["passes"] = passes;
  verdict = {stated_calibration(given, given).deviations(odometry.calibration()), converged};
  run.health["lidar_calibration_mahalanobis"] = verdict.moved;
  run.health["calibration_unconverged"] = converged ? 0.0 : 1.0;
  return run;
}

/// Sets the clip flags of saturated accelerometer readings that the device did not flag.
void flag_railed_forces(const sim::ImuRecord& record, std::vector<ImuSample>& samples) {
  ClippingFinder::Params params;
  params.upright_rails = stated_rails(record);
  const std::vector<Clipping> clippings = ClippingFinder(params).find(samples).clippings;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const unsigned forces = clip_flags({.accel = clippings[k].accel});
    samples[k].device_clip_flags = static_cast<std::uint8_t>(samples[k].device_clip_flags | forces);
  }
}

}  // namespace

Method rig_slam(RigSlam what, RunCore run) {
  MethodInfo info;
  info.name = std::move(what.name);
  info.kind = Kind::slam;
  info.doc = std::move(what.doc);
  info.ours = what.ours;
  info.source = std::move(what.source);
  info.settings = std::move(what.settings);
  info.needs_truth = what.needs_truth;
  info.baseline = what.baseline;
  info.robots = {"rig"};
  return make_method(std::move(info), run);
}

Estimate begin_with_rates(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                          const std::function<Status(Estimate&)>& rates) {
  Estimate estimate;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok()) estimate.status = rates(estimate);
  if (!estimate.status.ok()) return estimate;
  inflate_frozen_rates(report_frozen_axes(sensors, samples, estimate), samples, estimate);
  flag_railed_forces(sensors.imus.front(), samples);
  return estimate;
}

LidarInertialOdometry::Params SlamParams::on_the_rig() {
  LidarInertialOdometry::Params params;
  params.own_body_L = presets::rig_body_L();
  params.expert.matching.agreeing_least = RegistrationParams().expert.agreeing_min;  // disables with_few_matches
  return params;
}

SlamParams with_few_matches(SlamParams params) {
  params.odometry.expert.matching.agreeing_least = MatchingParams().agreeing_least;
  return params;
}

// Adds the calibration uncertainties of a hand-assembled rig.
SlamParams with_calibration(SlamParams params) {
  const TumblingOdometry::Params door;
  params.odometry.mount_sigma_rad = door.mount_sigma_rad;
  params.odometry.mount_sigma_m = door.mount_sigma_m;
  params.odometry.time_offset_sigma_s = door.time_offset_sigma_s;
  params.odometry.expert.gravity_sigma_m_s2 = door.expert.mapping.expert.gravity_sigma_m_s2;
  return params;
}

SlamParams with_saturation_deficit(SlamParams params) {
  params.odometry.expert.rails.estimate_deficit = true;
  return params;
}

Settings<SlamParams> slam_settings(const SlamParams& defaults, std::vector<std::string> fixed) {
  return Settings<SlamParams>(defaults, {.stated = {"gravity_m_s2", "accel_rail_m_s2"}, .fixed = std::move(fixed)});
}

bool run_slam_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const SlamStage& stage,
                    const SlamChain& chain, Estimate& estimate) {
  estimate.frame = Frame::imu;
  count_sources(estimate.rates, estimate.health);
  if (sensors.lidars.empty()) {
    estimate.status = {Trouble::empty, "lidars", 0.0, 1.0};
    return false;
  }
  const sim::LidarRecord& lidar = sensors.lidars.front();
  if (bridge::sweep_count(lidar) == 0) {
    estimate.status = {Trouble::empty, "lidar.sweep_start_ns", 0.0, 1.0};
    return false;
  }

  const LidarInertialOdometry::Params params = odometry_params(sensors, stage, chain);
  LidarInertialOdometry odometry(params);
  CalibrationVerdict calibration;
  Estimate run = run_passes(lidar, samples, params, chain, estimate, odometry, calibration);
  estimate = std::move(run);
  if (!estimate.status.ok()) return false;
  if (chain.calibration) report_calibration(odometry, sensors, estimate.health);
  Localisation localisation(params.expert.matching.distance_m);
  for (const SweepReport& sweep : estimate.sweeps) localisation.add(sweep);
  if (!chain.calibration) return conclude(odometry, calibration, localisation, nullptr, estimate);
  const SweepScale scale = find_sweep_scale(samples, estimate.sweeps, sensors.gravity_m_s2);
  return conclude(odometry, calibration, localisation, &scale, estimate);
}

}  // namespace tumble::scenarios
