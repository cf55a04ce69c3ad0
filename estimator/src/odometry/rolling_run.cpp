// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "rolling_odometry_impl.hpp"
#include "saved_bytes.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

// standard deviations for a gap of the IMU data: speed, rate about the vertical, and heading after a long gap
constexpr double kGapSpeed_m_s = 0.5, kGapTurn_rad_s = 1.0, kUnknownHeading_rad = 1.8;

/// Removes the tilt from the covariance of the last pose, because a restart levels the attitude.
Eigen::Matrix<double, 6, 6> position_and_heading(Eigen::Matrix<double, 6, 6> covariance) {
  covariance.middleRows<2>(3).setZero();
  covariance.middleCols<2>(3).setZero();
  return covariance;
}

using Kind = HealthFinding::Kind;

constexpr double kUnitSilent_s = 0.5;  // time without readings after which an IMU counts as silent

/// Adds a health finding about the merged IMU if the accelerometers of all IMUs contradict gravity at rest. If only
/// some IMUs contradict gravity, adds the finding `imu_disagrees` for each of these IMUs.
void add_forces_at_rest(const MergedImuChecks& checks, std::size_t count, SensorHealth& health) {
  const auto verdict = [&](std::size_t unit) {
    return checks.rest_gravity.gravity_magnitude_verdict(checks.rest_gravity_state[unit]);
  };
  bool all = true;
  for (std::size_t unit = 0; unit < count; ++unit) all = all && !verdict(unit).ok();
  if (all) health.add(Kind::wrong_force_magnitude_at_rest, verdict(0), "imu");
  for (std::size_t unit = 0; unit < count && !all; ++unit)
    health.add(Kind::imu_contradicts_other_imus, verdict(unit), imu_name(unit, count));
}

/// The bytes of a saved RollingOdometry contain the members of SavedRollingState, followed by the saturation limits of
/// each IMU.
struct SavedRollingState {
  double radius_m = 0.0;                                  ///< stated radius
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< stated position of the merged IMU
  std::uint32_t imu_count = 0;
  std::optional<RollingCalibration> calibration;  ///< empty before the first sample
  std::optional<PoseState> pose;                  ///< pose of the sphere's centre; the covariance omits the tilt
};

template <class Visit, class Saved>
void visit_saved_state(Visit& visit, Saved& saved) {
  constexpr double kConstantMax = 10.0;
  visit("radius_m", saved.radius_m);
  visit("lever_arm_m", saved.lever_arm_m);
  visit("units", saved.imu_count);
  if (visit.presence_flag("calibration", saved.calibration)) {
    visit("constants", saved.calibration->constants, -kConstantMax, kConstantMax);
    visit("covariance of the constants", saved.calibration->covariance, -odometry::kVarianceMax,
          odometry::kVarianceMax);
  }
  if (visit.presence_flag("pose", saved.pose)) odometry::visit_pose(visit, *saved.pose);
}

}  // namespace

void RollingOdometry::Impl::restart_at_newest(double gap_s) {
  const std::size_t before = finished_results_.size();
  end_continuous_run();
  std::optional<PoseState> pose;
  if (const std::optional<Pose> live = newest()) pose = live->pose;
  if (finished_results_.size() > before) {
    const RollingEstimate& last = finished_results_.back();
    pose = {last.time_ns, last.sphere_centre_W_m, last.q_WI, last.sphere_velocity_W_m_s, last.covariance};
  }
  Eigen::Isometry3d T_WG = start_.value_or(Eigen::Isometry3d::Identity());
  RollingRestart restart;
  if (pose) {
    T_WG.linear() = pose->orientation_W.toRotationMatrix();
    T_WG.translation() = pose->position_W_m;
    restart = RollingRestart{T_WG.translation(), position_and_heading(pose->covariance)};
    const double moved_m = gap_s * std::hypot(pose->velocity_W_m_s.norm(), kGapSpeed_m_s);
    const double turned_rad = std::min(gap_s * kGapTurn_rad_s, kUnknownHeading_rad);
    restart.covariance.diagonal().head<2>().array() += moved_m * moved_m;
    restart.covariance(5, 5) += turned_rad * turned_rad;
  }
  start_continuous_run();
  start_ = T_WG;
  ++restart_count_;
  restart_ = restart;
}

void RollingOdometry::Impl::initialise_pose() {
  if (!start_ || !state_->live_filter.started) return;
  const RollingEstimate first = RollingFilter::estimate(state_->live_filter);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(start_->linear()) * first.q_WI.conjugate();
  Eigen::Isometry3d T_WR = Eigen::Isometry3d::Identity();
  T_WR.linear() = so3::exp({0.0, 0.0, 2.0 * std::atan2(turn.z(), turn.w())}).toRotationMatrix();
  T_WR.translation() = start_->translation() - T_WR.linear() * first.sphere_centre_W_m;
  T_world_run_origin_ = T_WR;
  start_.reset();
}

RollingEstimate RollingOdometry::Impl::transform_to_world(RollingEstimate estimate) const {
  estimate.position_uncertain = estimate.position_uncertain || restart_.has_value();
  if (!T_world_run_origin_) return estimate;
  const Eigen::Matrix3d R = T_world_run_origin_->linear();
  Eigen::Matrix<double, 6, 6> both = Eigen::Matrix<double, 6, 6>::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = R;
  estimate.sphere_centre_W_m = *T_world_run_origin_ * estimate.sphere_centre_W_m;
  estimate.q_WI = (Eigen::Quaterniond(R) * estimate.q_WI).normalized();
  estimate.sphere_velocity_W_m_s = R * estimate.sphere_velocity_W_m_s;
  estimate.covariance = both * estimate.covariance * both.transpose();
  if (!restart_) return estimate;
  Eigen::Matrix<double, 6, 6> moved = Eigen::Matrix<double, 6, 6>::Identity();
  moved.topRightCorner<3, 3>() = -so3::hat(estimate.sphere_centre_W_m - restart_->sphere_centre_W_m);
  estimate.covariance += moved * restart_->covariance * moved.transpose();
  return estimate;
}

static_assert(RollingOdometry::kWholeRecording == RollingSmoother::kWholeRecordingLag, "both classes use one value");

RollingSmoother::Params rolling_smoother_params(const RollingOdometry::Params& params, const MergedRecordings& merged) {
  return odometry::rolling_params(params, odometry::merge_setup(params), merged.imus.size(), merged.lever_arm_m);
}

/// Stores a reading until the call of finish(). Ignores non-finite readings.
Status RollingOdometry::Impl::record_sample(std::size_t unit, ImuSample sample) {
  if (!check_sample(sample).ok()) return {};
  std::vector<ImuSample>& samples = recorded_samples_[unit];
  if (!samples.empty() && sample.time_ns <= samples.back().time_ns)
    return {ErrorCode::time_order, "time_ns", double(sample.time_ns), double(samples.back().time_ns)};
  samples.push_back(sample);
  return {};
}

Status RollingOdometry::Impl::finish_whole_recording() {
  std::vector<ImuRecording> recordings;
  for (std::size_t k = 0; k < params_.imus.size(); ++k) {
    std::vector<ImuSample>& samples = recorded_samples_[k];
    const std::vector<bool> inlier = find_inliers(outlier_filters_[k], samples);
    outlier_filter_state_[k].rejected += static_cast<std::size_t>(std::count(inlier.begin(), inlier.end(), false));
    std::size_t next = 0;
    std::erase_if(samples, [&](const ImuSample&) { return !inlier[next++]; });
    std::vector<TimeNs> stamps;
    for (const ImuSample& sample : samples) stamps.push_back(sample.time_ns);
    double jitter_s = 0.0;
    if (Status status = correct_stamps(sample_clock_, stamps, jitter_s); !status.ok()) return status;
    for (std::size_t j = 0; j < samples.size(); ++j) samples[j].time_ns = stamps[j];
    recordings.push_back({params_.imus[k].data_sheet, params_.imus[k].T_BI, std::move(samples)});
  }
  const auto whole = std::make_shared<MergedImuRecording>();
  MergedRecordings& merged = whole->recordings;
  const Status merge_status = merge_recordings(recordings, odometry::merge_setup(params_), merged);
  whole->health = merged.faults;
  whole_recording_result_ = whole;
  if (!merge_status.ok()) return merge_status;
  whole->health = check_merged_imus({.gravity_m_s2 = params_.gravity_m_s2, .is_merged = true}, merged);
  smoother_ = RollingSmoother(rolling_smoother_params(params_, merged));
  for (const ImuSample& sample : merged.samples) {
    const TimeNs last_ns = state_->live_filter.started ? state_->live_filter.last_time_ns : sample.time_ns;
    if (seconds(sample.time_ns - last_ns) > RollingGapParams::kGapMax_s)
      restart_at_newest(seconds(sample.time_ns - last_ns));
    if (Status status = smoother_.step(sample, *state_, finished_results_); !status.ok()) return status;
    initialise_pose();
  }
  return {};
}

SensorHealth RollingOdometry::Impl::health() const {
  if (uses_whole_recording()) return whole_recording_result_ ? whole_recording_result_->health : SensorHealth{};
  SensorHealth out;
  add_frozen_findings(frozen_imus_, out);
  const std::size_t count = params_.imus.size();
  TimeNs newest_ns = 0;
  for (std::size_t unit = 0; unit < count; ++unit) newest_ns = std::max(newest_ns, frozen_imus_[unit].last_time_ns);
  for (std::size_t unit = 0; unit < count; ++unit) {
    const std::string name = imu_name(unit, count);
    const TimeNs last_ns = frozen_imus_[unit].last_time_ns;
    const double silent_s = frozen_imus_[unit].started ? seconds(newest_ns - last_ns) : 0.0;
    if (silent_s >= kUnitSilent_s)
      out.add(Kind::imu_silent, {ErrorCode::out_of_range, "time in s without readings", silent_s, kUnitSilent_s}, name,
              "", last_ns);
    ImuMerge::add_finding(imu_merge_state_->imus[unit], name, out);
  }
  add_forces_at_rest(merged_imu_checks_, count, out);
  add_findings(merged_imu_checks_.plausibility, merged_imu_checks_.plausibility_state, "imu", out);
  ImuMerge::add_findings(imu_merge_state_->imu_sign_check.detected_mirroring(),
                         ImuMerge::lever_arm_agreement(*imu_merge_state_),
                         confirms_gyro(merged_imu_checks_.plausibility, merged_imu_checks_.plausibility_state), out);
  return out;
}

/// If an IMU has a frozen axis and other IMUs replace this IMU, the finding is `imu_frozen` instead of `frozen_axis`.
void RollingOdometry::Impl::add_frozen_findings(const Frozen& frozen, SensorHealth& health) const {
  const std::size_t count = params_.imus.size();
  const auto end = frozen.begin() + static_cast<std::ptrdiff_t>(count);
  const bool replaced = !std::all_of(frozen.begin(), end, FrozenAxes::any_frozen);
  for (std::size_t unit = 0; unit < count; ++unit)
    frozen_axis_detectors_[unit].add_findings(replaced ? Kind::imu_frozen : Kind::frozen_axis, imu_name(unit, count),
                                              frozen[unit], health);
}

std::vector<std::byte> RollingOdometry::Impl::save() const {
  const auto ended = std::make_unique<Impl>(*this);
  if (state_->live_filter.started) ended->restart_at_newest(0.0);
  SavedRollingState saved{
      params_.radius_m, imu_merge_.mean_imu_position_m(), static_cast<std::uint32_t>(params_.imus.size()), {}, {}};
  if (ended->start_) {
    PoseState& pose = saved.pose.emplace();
    pose.time_ns = state_->live_filter.last_time_ns;
    pose.position_W_m = ended->start_->translation();
    pose.orientation_W = Eigen::Quaterniond(ended->start_->linear()).normalized();
    if (ended->restart_) pose.covariance = ended->restart_->covariance;
  }
  if (state_->live_filter.started) {
    saved.calibration = RollingFilter::calibration(state_->live_filter);
  } else if (params_.expert->rolling.filter.calibration) {
    saved.calibration = *params_.expert->rolling.filter.calibration;
  }
  odometry::SavedStateWriter out;
  visit_saved_state(out, std::as_const(saved));
  for (std::size_t k = 0; k < params_.imus.size(); ++k)
    odometry::write_saturation_levels(clipping_states_[k].clipping_state.known_limits, out);
  return std::move(out).finish(odometry::SavedStateKind::rolling);
}

Status RollingOdometry::Impl::load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose) {
  odometry::SavedStateReader in(odometry::SavedStateKind::rolling, bytes);
  SavedRollingState saved;
  visit_saved_state(in, saved);
  if (saved.calibration) in.require_covariance("covariance of the constants", saved.calibration->covariance);
  if (saved.pose) odometry::check_pose(in, *saved.pose);
  in.require_condition("radius_m", saved.radius_m == params_.radius_m, saved.radius_m, params_.radius_m);
  const std::size_t units = params_.imus.size();
  in.require_condition("units", saved.imu_count == units, saved.imu_count, double(units));
  in.require_equal("lever_arm_m", saved.lever_arm_m, imu_merge_.mean_imu_position_m());
  std::vector<SaturationLevels> rails(units);
  for (SaturationLevels& unit : rails) odometry::read_saturation_levels(in, unit);
  in.require_condition("number of bytes after the saved state", in.remaining_bytes().empty(),
                       double(in.remaining_bytes().size()), 0.0);
  if (!in.status().ok()) return in.status();

  Params params = params_;
  if (saved.calibration)
    params.expert->rolling.filter.calibration = std::make_shared<RollingCalibration>(*saved.calibration);
  const auto fresh = std::make_unique<Impl>(params);
  fresh->clipping_finders_ = odometry::clipping_finders_of(params, rails);
  fresh->start_clipping_states();
  if (saved.pose) {
    fresh->start_.emplace(Eigen::Translation3d(saved.pose->position_W_m) * saved.pose->orientation_W);
    fresh->restart_ = RollingRestart{saved.pose->position_W_m, saved.pose->covariance};
  }
  *this = std::move(*fresh);
  if (last_pose) *last_pose = saved.pose;
  return {};
}

}  // namespace tumble
