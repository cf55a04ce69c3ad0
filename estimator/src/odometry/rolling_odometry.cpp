// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/rolling_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rolling_odometry_params.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

using odometry::filters_of, odometry::merge_params, odometry::rolling_params, odometry::sheets_of, odometry::watches_of;

namespace {

constexpr std::array<std::array<const char*, 6>, ImuMerge::kImus> kFrozenFields = {
    {{{"time in s for which gyro x of IMU 1 repeats one reading",
       "time in s for which gyro y of IMU 1 repeats one reading",
       "time in s for which gyro z of IMU 1 repeats one reading",
       "time in s for which accel x of IMU 1 repeats one reading",
       "time in s for which accel y of IMU 1 repeats one reading",
       "time in s for which accel z of IMU 1 repeats one reading"}},
     {{"time in s for which gyro x of IMU 2 repeats one reading",
       "time in s for which gyro y of IMU 2 repeats one reading",
       "time in s for which gyro z of IMU 2 repeats one reading",
       "time in s for which accel x of IMU 2 repeats one reading",
       "time in s for which accel y of IMU 2 repeats one reading",
       "time in s for which accel z of IMU 2 repeats one reading"}},
     {{"time in s for which gyro x of IMU 3 repeats one reading",
       "time in s for which gyro y of IMU 3 repeats one reading",
       "time in s for which gyro z of IMU 3 repeats one reading",
       "time in s for which accel x of IMU 3 repeats one reading",
       "time in s for which accel y of IMU 3 repeats one reading",
       "time in s for which accel z of IMU 3 repeats one reading"}},
     {{"time in s for which gyro x of IMU 4 repeats one reading",
       "time in s for which gyro y of IMU 4 repeats one reading",
       "time in s for which gyro z of IMU 4 repeats one reading",
       "time in s for which accel x of IMU 4 repeats one reading",
       "time in s for which accel y of IMU 4 repeats one reading",
       "time in s for which accel z of IMU 4 repeats one reading"}}}};

ImuSample at_time(TimeNs time_ns, ImuSample sample) {
  sample.time_ns = time_ns;
  return sample;
}

/// Marks the sample of an IMU as absent.
void leave_out(ImuSample& sample) {
  sample.angular_velocity_rad_s.setConstant(std::numeric_limits<double>::quiet_NaN());
}

bool any_reading(std::span<const ImuSample> samples) {
  return std::any_of(samples.begin(), samples.end(), [](const ImuSample& sample) { return check_sample(sample).ok(); });
}

RollingOdometry::Pose as_pose(const RollingEstimate& estimate) {
  RollingOdometry::Pose out;
  out.pose = {estimate.time_ns, estimate.p_WG_m, estimate.q_WI, estimate.v_WG_m_s, estimate.covariance};
  out.angular_velocity_rad_s = estimate.w_WI_I_rad_s;
  out.mode = estimate.mode;
  out.at_rest = estimate.at_rest;
  out.uncertain = estimate.uncertain;
  return out;
}

}  // namespace

RollingOdometry::RollingOdometry(const Params& params) : RollingOdometry(params, merge_params(params)) {}

RollingOdometry::RollingOdometry(const Params& params, const ImuMerge::Params& merged)
    : params_(params),
      order_(params.expert.rolling.filter.expert.gap.gap_max_s),
      clock_(params.expert.stamps),
      merge_(merged),
      smoother_(rolling_params(params, merged, params.units.size(), merge_.p_C_m())),
      rails_(sheets_of(params)),
      alignment_(params.units.size()),
      merge_state_(std::make_unique<ImuMerge::State>()),
      merged_state_(std::make_unique<ImuMerge::State>()),
      state_(std::make_unique<RollingSmoother::State>()),
      rails_state_(rails_.start()),
      filters_(filters_of(params)),
      watches_(watches_of(params)),
      gravity_({.gravity_m_s2 = params.gravity_m_s2}),
      live_(params.lag_s <= 0.0) {}

RollingOdometry::RollingOdometry(const RollingOdometry& other)
    : params_(other.params_),
      order_(other.order_),
      order_state_(other.order_state_),
      clock_(other.clock_),
      stamps_(other.stamps_),
      merge_(other.merge_),
      smoother_(other.smoother_),
      rails_(other.rails_),
      alignment_(other.alignment_),
      alignment_state_(other.alignment_state_),
      recorded_(other.recorded_),
      merge_state_(std::make_unique<ImuMerge::State>(*other.merge_state_)),
      merged_state_(std::make_unique<ImuMerge::State>()),
      state_(std::make_unique<RollingSmoother::State>(*other.state_)),
      rails_state_(other.rails_state_),
      filters_(other.filters_),
      outliers_(other.outliers_),
      held_(other.held_),
      watches_(other.watches_),
      frozen_(other.frozen_),
      gravity_(other.gravity_),
      gravity_state_(other.gravity_state_),
      done_(other.done_),
      taken_(other.taken_),
      start_(other.start_),
      T_WR_(other.T_WR_),
      gaps_(other.gaps_),
      restarted_(other.restarted_),
      live_(other.live_),
      finished_(other.finished_) {}

RollingOdometry& RollingOdometry::operator=(const RollingOdometry& other) {
  return *this = RollingOdometry(other);
}

Status RollingOdometry::add_imus(std::span<const ImuSample> samples) {
  if (finished_) return {Trouble::out_of_range, "samples after finish()", 1.0, 0.0};
  if (samples.size() != params_.units.size())
    return {Trouble::too_few, "samples", double(samples.size()), double(params_.units.size())};
  if (is_whole()) {
    if (!any_reading(samples)) return check_sample(samples.front());
    Status status;
    for (std::size_t k = 0; k < samples.size() && status.ok(); ++k)
      status = record(k, at_time(samples.front().time_ns, samples[k]));
    return status;
  }
  if (!any_reading(samples)) return add_inliers(samples);  // returns the error
  StampOrder::Verdict verdict{};
  if (const Status status = order_.judge(samples.front().time_ns, order_state_, verdict); !status.ok()) return status;
  if (verdict != StampOrder::Verdict::continues) restart_at_newest();
  if (const Status status = add_held(samples); !status.ok()) return status;
  UnitRails::Samples judged;
  std::copy(samples.begin(), samples.end(), judged.begin());
  bool holds = false;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!check_sample(samples[k]).ok()) continue;
    if (!filters_[k].keeps_back(at_time(samples.front().time_ns, samples[k]), outliers_[k])) continue;
    if (outliers_[k].held) {
      holds = true;
    } else {
      leave_out(judged[k]);
    }
  }
  if (holds) held_ = judged;
  const std::span<const ImuSample> inliers = std::span(judged).first(samples.size());
  return holds || !any_reading(inliers) ? Status{} : add_inliers(inliers);
}

Status RollingOdometry::add_imu(std::size_t unit, const ImuSample& sample) {
  if (finished_) return {Trouble::out_of_range, "samples after finish()", 1.0, 0.0};
  const std::size_t units = params_.units.size();
  if (unit >= units) return {Trouble::out_of_range, "unit", double(unit), double(units - 1)};
  if (is_whole()) return record(unit, sample);
  if (Status status = alignment_.push(unit, sample, alignment_state_); !status.ok()) return status;
  return add_aligned(false);
}

/// Adds the readings at all common times that are complete. If `ended`, no further readings follow.
Status RollingOdometry::add_aligned(bool ended) {
  Status first;
  UnitAlignment::Readings readings;
  while (alignment_.next(alignment_state_, readings, ended)) {
    const Status status = add_imus(std::span(readings).first(params_.units.size()));
    if (first.ok()) first = status;
  }
  return first;
}

/// Adds the delayed samples, except for readings that the outlier filter rejects after comparison with the next
/// samples.
Status RollingOdometry::add_held(std::span<const ImuSample> next) {
  if (!held_) return {};
  for (std::size_t k = 0; k < next.size(); ++k) {
    if (!outliers_[k].held) continue;
    const bool follows = check_sample(next[k]).ok();
    const bool confirmed = follows && filters_[k].settle(at_time(next.front().time_ns, next[k]), outliers_[k]);
    if (!follows) OutlierFilter::finish(outliers_[k]);
    if (!confirmed) leave_out((*held_)[k]);
  }
  const UnitRails::Samples held = *std::exchange(held_, std::nullopt);
  const std::span<const ImuSample> inliers = std::span(held).first(next.size());
  return any_reading(inliers) ? add_inliers(inliers) : Status{};
}

Status RollingOdometry::add_inliers(std::span<const ImuSample> samples) {
  std::optional<ImuSample> merged;
  SampleClock::State stamps = stamps_;
  TimeNs time_ns = 0;
  if (Status status = clock_.push(samples.front().time_ns, stamps, time_ns); !status.ok()) return status;
  UnitRails::Samples flagged;
  rails_.flag(samples, rails_state_, flagged);
  flagged.front().time_ns = time_ns;
  *merged_state_ = *merge_state_;  // either all parts accept the sample or none
  Frozen frozen = frozen_;
  for (std::size_t k = 0; k < samples.size(); ++k) watches_[k].step(samples[k], frozen[k]);
  const std::span<ImuSample> judged = std::span(flagged).first(samples.size());
  if (Status status = exclude_frozen(frozen, judged); !status.ok()) {
    frozen_ = frozen;  // health() reports the frozen axes
    return status;
  }
  if (Status status = merge_.step(judged, *merged_state_, merged); !status.ok()) return status;
  if (Status status = merge_.verdict(*merged_state_); !status.ok()) return status;
  if (merged) {
    if (Status status = take_in(*merged); !status.ok()) return status;
  }
  merge_state_.swap(merged_state_);
  stamps_ = stamps;
  frozen_ = frozen;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    gravity_.step(samples[k], gravity_state_[k]);
    RestGravity::limit_memory(gravity_state_[k]);
  }
  rails_.observe(samples, rails_state_);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (check_sample(samples[k]).ok()) OutlierFilter::pass(at_time(samples.front().time_ns, samples[k]), outliers_[k]);
  }
  StampOrder::accept(samples.front().time_ns, order_state_);
  return {};
}

std::size_t RollingOdometry::rejected_readings() const {
  std::size_t out = 0;
  for (const OutlierFilter::State& unit : outliers_) out += unit.rejected;
  return out;
}

/// Sets the readings of frozen IMUs to NaN. If no IMU remains, returns an error.
Status RollingOdometry::exclude_frozen(const Frozen& states, std::span<ImuSample> samples) const {
  bool any = false, received = false;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool finite = check_sample(samples[k]).ok();
    const bool frozen = finite && !watches_[k].verdict(states[k]).ok();
    if (frozen) leave_out(samples[k]);
    any = any || frozen;
    received = received || (finite && !frozen);
  }
  return any && !received ? frozen_axis(states) : Status{};
}

std::optional<double> RollingOdometry::estimated_jitter_s() const {
  return clock_.corrects_stamps(stamps_) ? SampleClock::jitter_s(stamps_) : std::nullopt;
}

Status RollingOdometry::health() const {
  Status status = frozen_axis(frozen_);
  for (std::size_t unit = 0; unit < watches_.size() && status.ok(); ++unit)
    status = gravity_.size_verdict(gravity_state_[unit]);
  return status;
}

Status RollingOdometry::frozen_axis(const Frozen& frozen) const {
  for (std::size_t unit = 0; unit < watches_.size(); ++unit) {
    Status status = watches_[unit].verdict(frozen[unit]);
    if (status.ok()) continue;
    const auto axes = frozen[unit].axes;
    const auto first = std::find_if(axes.begin(), axes.end(), [](const FrozenAxes::Axis& axis) { return axis.frozen; });
    status.field = kFrozenFields.at(unit).at(static_cast<std::size_t>(first - axes.begin()));
    return status;
  }
  return {};
}

std::optional<RollingOdometry::Pose> RollingOdometry::newest() const {
  if (!state_->live.started) return std::nullopt;
  return as_pose(in_world(RollingFilter::estimate(state_->live)));
}

std::optional<RollingOdometry::Pose> RollingOdometry::take() {
  if (taken_ == done_.size()) return std::nullopt;
  const Pose out = as_pose(done_[taken_++]);
  if (taken_ == done_.size()) {
    done_.clear();
    taken_ = 0;
  }
  return out;
}

RollingOdometry::Calibration RollingOdometry::calibration() const {
  const RollingNominal& constants = live_ ? state_->live.nominal : state_->constants;
  return {-constants.lever_arm_error_m, params_.radius_m + constants.radius_error_m, state_->radius_sigma_m};
}

Status RollingOdometry::finish() {
  if (finished_) return {};
  const Status status = is_whole() ? finish_whole() : add_aligned(true);
  end_run();
  finished_ = true;
  return status;
}

/// Smooths the poses that are still within the lag.
void RollingOdometry::end_run() {
  for (OutlierFilter::State& unit : outliers_) OutlierFilter::finish(unit);
  held_.reset();
  const std::size_t before = done_.size();
  if (!live_ && !is_whole()) smoother_.finish(*state_, done_);
  for (std::size_t k = before; k < done_.size(); ++k) done_[k] = in_world(done_[k]);
}

/// Restarts the run at the newest pose.
void RollingOdometry::restart_at_newest() {
  const std::optional<Pose> pose = newest();
  end_run();
  Eigen::Isometry3d T_WG = start_.value_or(Eigen::Isometry3d::Identity());
  if (pose) {
    T_WG.linear() = pose->pose.q_WA.toRotationMatrix();
    T_WG.translation() = pose->pose.p_WA_m;
  }
  start_run();
  start_ = T_WG;
  ++gaps_;
  restarted_ = true;
}

void RollingOdometry::reset() {
  start_run();
  alignment_state_ = {};
  recorded_ = {};
}

/// Resets all states of a run, except the readings that UnitAlignment has not yet passed on.
void RollingOdometry::start_run() {
  stamps_ = {};
  merge_state_ = std::make_unique<ImuMerge::State>();
  state_ = std::make_unique<RollingSmoother::State>();
  rails_state_ = rails_.start();
  frozen_ = {};
  for (OutlierFilter::State& unit : outliers_) {
    unit.held.reset();
    unit.count = 0;
  }
  held_.reset();
  gravity_state_ = {};
  order_state_ = {};
  start_ = T_WR_ = std::nullopt;
  restarted_ = false;
  finished_ = false;
}

void RollingOdometry::reset(const Eigen::Isometry3d& T_WG) {
  reset();
  start_ = T_WG;
}

/// Computes the pose of the run's origin, from the run's first pose.
void RollingOdometry::place_start() {
  if (!start_ || !state_->live.started) return;
  const RollingEstimate first = RollingFilter::estimate(state_->live);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(start_->linear()) * first.q_WI.conjugate();
  Eigen::Isometry3d T_WR = Eigen::Isometry3d::Identity();
  T_WR.linear() = so3::exp({0.0, 0.0, 2.0 * std::atan2(turn.z(), turn.w())}).toRotationMatrix();
  T_WR.translation() = start_->translation() - T_WR.linear() * first.p_WG_m;
  T_WR_ = T_WR;
  start_.reset();
}

/// Converts an estimate of the filter or the smoother to the world.
RollingEstimate RollingOdometry::in_world(RollingEstimate estimate) const {
  estimate.uncertain = estimate.uncertain || restarted_;
  if (!T_WR_) return estimate;
  const Eigen::Matrix3d R = T_WR_->linear();
  Eigen::Matrix<double, 6, 6> both = Eigen::Matrix<double, 6, 6>::Zero();
  both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = R;
  estimate.p_WG_m = *T_WR_ * estimate.p_WG_m;
  estimate.q_WI = (Eigen::Quaterniond(R) * estimate.q_WI).normalized();
  estimate.v_WG_m_s = R * estimate.v_WG_m_s;
  estimate.covariance = both * estimate.covariance * both.transpose();
  return estimate;
}

Status RollingOdometry::take_in(const ImuSample& merged) {
  const std::size_t before = done_.size();
  Status status;
  if (live_) {
    status = smoother_.filter().step(merged, state_->live);
    if (status.ok()) done_.push_back(RollingFilter::estimate(state_->live));
  } else {
    status = smoother_.step(merged, *state_, done_);
  }
  place_start();
  for (std::size_t k = before; k < done_.size(); ++k) done_[k] = in_world(done_[k]);
  return status;
}

}  // namespace tumble
