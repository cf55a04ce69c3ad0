// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/mapping_passes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace tumble {

namespace {

constexpr int kExtraPassesMax = 3;
constexpr std::size_t kSweepsPerRejection = 5;
// minimum standard deviations of the lidar mounting in a mapping pass, if the previous pass has contradicted the stated
// mounting
constexpr double kUncertainMountSigma_rad = 0.1, kUncertainMountSigma_m = 0.5;

/// Cuts the last sweep at the end of the IMU data, if at least half of the sweep remains. Without the cut, a small
/// clock offset between lidar and IMU would make the last sweep unusable.
bool shorten_sweep(TimeNs end_ns, WaitingSweep& sweep) {
  if (end_ns >= sweep.end_ns) return true;
  const TimeNs last_marginalised_ns = end_ns - sweep.start_ns, length_ns = sweep.end_ns - sweep.start_ns;
  if (2 * last_marginalised_ns < length_ns) return false;
  // Points beyond the sweep's end remain in the sweep, because the mapper reports such points as a fault of the
  // recording.
  std::erase_if(sweep.points,
                [&](const LidarPoint& p) { return p.offset_ns > last_marginalised_ns && p.offset_ns <= length_ns; });
  sweep.end_ns = end_ns;
  return true;
}

class MappingPass {
 public:
  MappingPass(const MappingInput& input, const LidarInertialOdometry::Params& params)
      : input_(input),
        offset_ns_(static_cast<TimeNs>(std::llround(params.imu_minus_lidar_clock_s * 1e9))),
        out_(params) {
    if (input.start) out_.mapper.set_start_pose(*input.start);
    if (input.start_tilt_correction) out_.mapper.set_start_tilt_correction(*input.start_tilt_correction);
  }

  MappedRecording map_recording() {
    for (std::size_t k = 0; k < input_.sweeps && out_.status.ok(); ++k) add(input_.sweep(k));
    add_time_without_sweeps(input_.samples.back().time_ns - offset_ns_);
    for (std::vector<PoseState>& open : out_.mapper.window_trajectories()) apply_smoothed_poses(std::move(open));
    for (const MappedSweep& sweep : out_.sweeps) {
      if (!sweep.result.trajectory.empty()) out_.localisation.add(sweep.result);
    }
    return std::move(out_);
  }

 private:
  void add(WaitingSweep sweep) {
    add_time_without_sweeps(sweep.start_ns);
    if (!out_.status.ok()) return;
    add_samples(sweep.end_ns + offset_ns_);
    if (!out_.status.ok()) return;
    if (!shorten_sweep(input_.samples.back().time_ns - offset_ns_, sweep)) {
      ++out_.unfinished_sweeps;
      return;
    }
    add_reading(sweep.end_ns + offset_ns_);
    if (out_.status.ok()) add_points(sweep);
  }

  /// While the lidar provides no sweeps, adds empty sweeps, as TumblingOdometry does in live operation.
  void add_time_without_sweeps(TimeNs to_ns) {
    while (out_.status.ok() && last_end_ns_) {
      const TimeNs silent_ns = *last_end_ns_ + offset_ns_ + static_cast<TimeNs>(1e9 * kLidarSilent_s);
      if (silent_ns >= to_ns + offset_ns_) return;
      add_samples(silent_ns + 1);
      const TimeNs end_ns = input_.samples[next_ - 1].time_ns - offset_ns_;
      if (!out_.status.ok() || input_.samples[next_ - 1].time_ns <= silent_ns || end_ns > to_ns) return;
      add_points({.start_ns = end_ns, .end_ns = end_ns, .points = {}});
    }
  }

  void add_samples(TimeNs to_ns) {
    while (next_ < input_.samples.size() && (next_ == 0 || input_.samples[next_ - 1].time_ns < to_ns)) {
      out_.status = out_.mapper.add_imu(input_.samples[next_], input_.rates[next_]);
      if (!out_.status.ok()) return;
      ++next_;
    }
  }

  void add_reading(TimeNs to_ns) {
    if (!input_.reading || !last_pose_time_ns_) return;
    if (const auto reading = input_.reading(*last_pose_time_ns_, to_ns))
      out_.status = out_.mapper.set_odometer_reading(*reading);
  }

  void add_points(const WaitingSweep& sweep) {
    MappedSweep& added = out_.sweeps.emplace_back();
    added.status = out_.mapper.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points, added.result);
    if (added.result.trajectory.empty()) return;
    last_pose_time_ns_ = added.result.pose.time_ns;
    last_end_ns_ = sweep.end_ns;
    apply_smoothed_poses(std::exchange(added.result.final_poses_of_earlier_sweep, {}));
  }

  void apply_smoothed_poses(std::vector<PoseState> smoothed) {
    if (smoothed.empty()) return;
    while (smoothed_ < out_.sweeps.size() && out_.sweeps[smoothed_].result.trajectory.empty()) ++smoothed_;
    if (smoothed_ == out_.sweeps.size()) return;
    SweepResult& report = out_.sweeps[smoothed_++].result;
    report.trajectory = std::move(smoothed);
    report.pose = report.trajectory.back();
  }

  const MappingInput& input_;
  TimeNs offset_ns_;
  MappedRecording out_;
  std::size_t next_ = 0;      ///< index of the next sample
  std::size_t smoothed_ = 0;  ///< index of the next sweep without a smoothed trajectory
  std::optional<TimeNs> last_pose_time_ns_;
  std::optional<TimeNs> last_end_ns_;  ///< end of the last sweep with a pose, in the lidar's clock
};

using Params = LidarInertialOdometry::Params;

LidarImuCalibrationPrior lidar_calibration_prior(const Params& started, const Params& given) {
  LidarImuCalibrationPrior out;
  out.calibration.T_IL = started.T_IL;
  out.calibration.imu_minus_lidar_clock_s = started.imu_minus_lidar_clock_s;
  out.mount_sigma_rad = given.mount_sigma_rad;
  out.mount_sigma_m = given.mount_sigma_m;
  out.time_offset_sigma_s = given.time_offset_sigma_s;
  return out;
}

void set_sigmas(const Eigen::VectorXd& sigma, Params& params) {
  params.mount_sigma_rad = sigma.head<3>().maxCoeff();
  params.mount_sigma_m = sigma.segment<3>(3).maxCoeff();
  params.time_offset_sigma_s = sigma[6];
}

Params with_uncertain_mounting(Params params) {
  if (params.mount_sigma_rad > 0.0) params.mount_sigma_rad = std::max(params.mount_sigma_rad, kUncertainMountSigma_rad);
  if (params.mount_sigma_m > 0.0) params.mount_sigma_m = std::max(params.mount_sigma_m, kUncertainMountSigma_m);
  return params;
}

bool determines_lidar_calibration(const MappedRecording& pass) {
  if (!pass.status.ok()) return false;
  std::size_t rejected = 0, located = 0;
  for (const MappedSweep& sweep : pass.sweeps) {
    if (sweep.result.trajectory.empty()) continue;
    ++located;
    rejected += sweep.result.verdict == SweepVerdict::rejected && sweep.result.usable_points > 0;
  }
  return kSweepsPerRejection * rejected <= located;
}

void start_from_calibration(const LidarImuCalibration& learnt, Params& params) {
  params.T_IL = learnt.T_IL;
  params.imu_minus_lidar_clock_s = learnt.imu_minus_lidar_clock_s;
}

}  // namespace

SaturationLevels flag_saturated_forces(const SaturationLimitDetector::Params& stated, std::span<ImuSample> samples) {
  ClippingFinder::Params params;
  params.axis_limit_params = stated;
  ClippingFinder::ClippingSearchResult found = ClippingFinder(params).find(samples);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const unsigned forces = clip_flags({.accel = found.clipping_per_sample[k].accel});
    samples[k].device_clip_flags = static_cast<std::uint8_t>(samples[k].device_clip_flags | forces);
  }
  return std::move(found.saturation_levels);
}

MappedRecording::MappedRecording(const LidarInertialOdometry::Params& params)
    : mapper(params), localisation(params.expert.matching.distance_m) {}

bool MappedRecording::calibration_is_off() const {
  return !calibration_converged && calibration_deviations > LidarImuCalibrationPrior::kDistanceMax_sigmas;
}

void MappedRecording::add_findings(const LidarScale& scale, SensorHealth& health) const {
  health.add(HealthFinding::Kind::lidar_scale, scale.verdict(), "lidar");
  health.add(HealthFinding::Kind::vertical_unknown, mapper.check_gravity_direction(), "");
  health.add(HealthFinding::Kind::tracking_lost, localisation.verdict(), "");
  if (calibration_is_off())
    health.add(HealthFinding::Kind::lidar_calibration, check_lidar_calibration_distance(calibration_deviations),
               "lidar");
}

double calibration_contradiction(const LidarImuCalibrationPrior& stated, const LidarInertialOdometry& mapper) {
  using Matrix7 = Eigen::Matrix<double, 7, 7>;
  Eigen::Matrix<double, 7, 1> sigma;
  sigma << Eigen::Vector3d::Constant(stated.mount_sigma_rad), Eigen::Vector3d::Constant(stated.mount_sigma_m),
      stated.time_offset_sigma_s;
  constexpr double kRegular = 1e-4;  // fraction of the prior variance; keeps S positive if a pass adds no information
  const Matrix7 S = Matrix7(((1.0 + kRegular) * sigma.cwiseAbs2().array() + 1e-18).matrix().asDiagonal()) -
                    mapper.next_lidar_calibration_prior_covariance().topLeftCorner<7, 7>();
  const auto change = mapper.lidar_calibration().minus(stated.calibration);
  const auto mahalanobis2 = [](const auto& x, const auto& P) { return x.dot(P.ldlt().solve(x)); };
  const Eigen::Vector3d rotation = change.head<3>(), translation = change.segment<3>(3);
  return std::sqrt(std::max({0.0, mahalanobis2(rotation, S.topLeftCorner<3, 3>()),
                             mahalanobis2(translation, S.block<3, 3>(3, 3)), change[6] * change[6] / S(6, 6)}));
}

MappedRecording map_in_one_pass(const MappingInput& input, const LidarInertialOdometry::Params& params) {
  return MappingPass(input, params).map_recording();
}

MappedRecording map_with_calibration(const MappingInput& input, const LidarInertialOdometry::Params& params) {
  Params given = params;
  Params started = given;
  MappedRecording out = map_in_one_pass(input, started);
  int passes = 1;
  MappingInput levelled = input;  // input with the start tilt that the previous pass estimated
  const auto again = [&] {
    levelled.start_tilt_correction = out.mapper.start_tilt_correction();
    out = map_in_one_pass(levelled, started);
    ++passes;
  };
  const bool contradicts = determines_lidar_calibration(out) &&
                           calibration_contradiction(lidar_calibration_prior(started, started), out.mapper) >
                               LidarImuCalibrationPrior::kDistanceMax_sigmas;
  if (contradicts) {
    given = with_uncertain_mounting(params);
    started = given;
    again();
  }
  double moved = 0.0;
  while (determines_lidar_calibration(out)) {
    moved = lidar_calibration_prior(started, given).distance_in_sigmas(out.mapper.lidar_calibration());
    if (moved <= LidarImuCalibrationPrior::kDistanceMax_sigmas || passes > kExtraPassesMax) break;
    start_from_calibration(out.mapper.lidar_calibration(), started);
    again();
  }
  const bool converged = determines_lidar_calibration(out) && moved <= LidarImuCalibrationPrior::kDistanceMax_sigmas;
  if (converged) {
    start_from_calibration(out.mapper.lidar_calibration(), started);
    set_sigmas(out.mapper.next_lidar_calibration_prior_covariance().diagonal().cwiseSqrt(), started);
    again();
  } else if (determines_lidar_calibration(out) && !levelled.start_tilt_correction &&
             out.mapper.start_tilt_correction()) {
    again();
  }
  out.mapping_pass_count = passes;
  out.calibration_deviations =
      lidar_calibration_prior(params, params).distance_in_sigmas(out.mapper.lidar_calibration());
  out.calibration_converged = converged;
  out.calibration_replaced = converged && contradicts;
  return out;
}

LidarScale find_sweep_scale(std::span<const ImuSample> samples, const MappedRecording& mapped, double gravity_m_s2) {
  std::vector<SweepResult> located;
  for (const MappedSweep& sweep : mapped.sweeps) {
    if (!sweep.result.trajectory.empty()) located.push_back(sweep.result);
  }
  return find_sweep_scale(samples, located, gravity_m_s2);
}

}  // namespace tumble
