// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/lidar_inertial_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "odometry_impl.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"
#include "unknowns.hpp"

namespace tumble {

namespace {

Status check(const ImuSample& sample, const AngularRateState& rate) {
  if (const Status status = check_sample(sample); !status.ok()) return status;
  if (const Status status = check_stamp(sample.time_ns, "time_ns"); !status.ok()) return status;
  if (!rate.w_WI_I_rad_s.allFinite() || !rate.covariance_rad2_s2.allFinite()) {
    return {ErrorCode::non_finite, "rate", std::numeric_limits<double>::quiet_NaN(), 0.0};
  }
  if (rate.time_ns == sample.time_ns) return {};
  return {ErrorCode::out_of_range, "rate.time_ns", double(rate.time_ns), double(sample.time_ns)};
}

/// If the box is empty, no points on the robot itself are removed.
template <class Visitor>
void visit_corners_in_order(const Eigen::AlignedBox3d& box, Visitor& visit) {
  const Eigen::AlignedBox3d none;
  if (box.min() == none.min() && box.max() == none.max()) return;
  visit(box.sizes().x(), {"own_body_L maximum x minus minimum x", "m", 0.0, kUnbounded, ""});
  visit(box.sizes().y(), {"own_body_L maximum y minus minimum y", "m", 0.0, kUnbounded, ""});
  visit(box.sizes().z(), {"own_body_L maximum z minus minimum z", "m", 0.0, kUnbounded, ""});
}

detail::OutOfBoundsParameter out_of_bounds(const OdometryParams& params) {
  detail::OutOfBoundsParameter found;
  detail::BoundsChecker visit(found);
  OdometryParams::fields(params, visit);
  visit(params.range_max_m, {"range_max_m", "m", params.range_min_m, 1e4, ""});
  visit(params.expert.map.spacing_m, {"map_spacing_m", "m", 0.0, params.expert.map.voxel_m, ""});
  visit(params.expert.map.radius_m, {"map_radius_m", "m", params.range_max_m / 10.0, 1e5, ""});
  const Eigen::Matrix3d R = params.T_IL.linear();
  const double orthogonality = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  visit(orthogonality, {"T_IL rotation's distance from orthogonal", "1", 0.0, 1e-6, ""});
  visit(R.determinant(), {"T_IL rotation's determinant", "1", 0.999, 1.001, ""});
  visit_corners_in_order(params.own_body_L, visit);
  visit(params.T_IL.translation().norm(), {"T_IL translation", "m", 0.0, 1e3, ""});
  return found;
}

const OdometryParams& valid(const OdometryParams& params) {
  detail::throw_if_out_of_bounds(out_of_bounds(params));
  return params;
}

}  // namespace

LidarInertialOdometry::Impl::Impl(const Params& given)
    : params(valid(given)),
      inertial_track(given),
      window(given.expert.window_sweeps),
      map(given),
      sweep_scratch(given) {
  sweep_boundary.state_estimate.mean.calibration.T_IL = given.T_IL;
}

LidarInertialOdometry::LidarInertialOdometry(const Params& params) : impl_(std::make_unique<Impl>(params)) {}
LidarInertialOdometry::~LidarInertialOdometry() = default;
LidarInertialOdometry::LidarInertialOdometry(LidarInertialOdometry&&) noexcept = default;
LidarInertialOdometry& LidarInertialOdometry::operator=(LidarInertialOdometry&&) noexcept = default;
LidarInertialOdometry::LidarInertialOdometry(const LidarInertialOdometry& other)
    : impl_(std::make_unique<Impl>(*other.impl_)) {}
LidarInertialOdometry& LidarInertialOdometry::operator=(const LidarInertialOdometry& other) {
  impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}

void LidarInertialOdometry::set_start_pose(const Eigen::Isometry3d& T_WI) {
  impl_->start_pose = T_WI;
}

const std::optional<Eigen::Isometry3d>& LidarInertialOdometry::start_pose() const {
  return impl_->start_pose;
}

std::optional<LidarInertialOdometry::StartTiltCorrection> LidarInertialOdometry::start_tilt_correction() const {
  constexpr double kBetter = 0.5;  // maximum ratio of the standard deviations of the new tilt and the initial tilt
  namespace u = mapping::unknowns;
  const Eigen::Vector3d& gravity = impl_->sweep_boundary.state_estimate.mean.calibration.gravity_W_m_s2;
  const double variance =
      u::variances(impl_->sweep_boundary.state_estimate.state_error_covariance, u::gravity).head<2>().maxCoeff();
  StartTiltCorrection out;
  out.sigma_rad = std::sqrt(variance) / std::max(gravity.norm(), 1e-3);
  const bool in_motion = impl_->start_tilt_correction || impl_->world_covariance.tilt_sigma_rad() >
                                                             impl_->params.expert.world_covariance.tilt_sigma_rad;
  if (!mapping::has_started(impl_->tracking) || impl_->localiser.is_localised() || !in_motion) return std::nullopt;
  if (!(out.sigma_rad <= kBetter * impl_->world_covariance.tilt_sigma_rad())) return impl_->start_tilt_correction;
  out.rotation = Eigen::Quaterniond::FromTwoVectors(gravity, -Eigen::Vector3d::UnitZ());
  if (impl_->start_tilt_correction) out.rotation = (out.rotation * impl_->start_tilt_correction->rotation).normalized();
  return out;
}

void LidarInertialOdometry::set_start_tilt_correction(const StartTiltCorrection& tilt) {
  impl_->start_tilt_correction = tilt;
}

Status LidarInertialOdometry::add_imu(const ImuSample& sample, const AngularRateState& rate) {
  if (Status status = check(sample, rate); !status.ok()) return status;
  if (Status status = impl_->inertial_track.check(sample); !status.ok()) return status;
  impl_->inertial_track.store_sample(impl_->params, sample, rate);
  return {};
}

Status LidarInertialOdometry::set_odometer_reading(const OdometerReading& reading) {
  const Status status = check_odometer_reading(reading);
  if (status.ok()) impl_->odometer_reading = reading;
  return status;
}

Status LidarInertialOdometry::add_sweep(TimeNs lidar_start_ns, TimeNs lidar_end_ns, std::span<const LidarPoint> points,
                                        SweepResult& result) {
  result = SweepResult{};
  if (const Status status = check_stamp(lidar_start_ns, "start_ns"); !status.ok()) return status;
  if (const Status status = check_stamp(lidar_end_ns, "end_ns"); !status.ok()) return status;
  const TimeNs offset_ns = static_cast<TimeNs>(std::llround(impl_->params.imu_minus_lidar_clock_s * 1e9));
  return impl_->add_sweep(lidar_start_ns + offset_ns, lidar_end_ns + offset_ns, points, result);
}

Status LidarInertialOdometry::predict(std::span<const ImuSample> samples, std::span<const AngularRateState> rates,
                                      PoseState& pose, Eigen::Matrix3d* velocity_covariance_I_m2_s2) const {
  const Impl& my = *impl_;
  if (!mapping::has_started(my.tracking)) return {ErrorCode::empty, "sweeps", 0.0, 1.0};
  if (samples.size() != rates.size())
    return {ErrorCode::insufficient_data, "rates", double(rates.size()), double(samples.size())};
  mapping::InertialTrack track = my.inertial_track;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (Status status = check(samples[k], rates[k]); !status.ok()) return status;
    if (Status status = track.check(samples[k]); !status.ok()) return status;
    track.store_sample(my.params, samples[k], rates[k]);
  }
  const auto report_velocity = [&](const mapping::MotionErrors& errors, const MotionState& state) {
    if (velocity_covariance_I_m2_s2) *velocity_covariance_I_m2_s2 = mapping::velocity_covariance_I(state, errors);
  };
  if (track.samples().empty()) {
    report_velocity(mapping::unknowns::sub_block(my.sweep_boundary.state_estimate.state_error_covariance,
                                                 mapping::unknowns::motion),
                    my.sweep_boundary.state_estimate.mean.state);
    return pose_at(my.sweep_boundary.time_ns(), pose);
  }
  const TimeNs end_ns = track.samples().back().time_ns;
  const Registration::Estimate& last = my.sweep_boundary.state_estimate.mean;
  SweepTrajectory trajectory;
  if (Status status = trajectory.build(last.state, track.samples(), end_ns, last.calibration.gravity_W_m_s2);
      !status.ok())
    return status;
  const int resting_sweeps = my.is_stationary(track, trajectory, end_ns) ? my.resting_sweeps + 1 : 0;
  const mapping::MotionWindow motion{track.samples(), end_ns, resting_sweeps};
  const std::unique_ptr<const mapping::Prediction> at_start(
      new mapping::Prediction(mapping::predict(my.params, my.sweep_boundary, motion, trajectory, my.odometer_reading)));
  const Registration::Estimate& mean = at_start->prior.mean;  // already includes an odometer reading
  if (Status status = trajectory.build(mean.state, track.samples(), end_ns, mean.calibration.gravity_W_m_s2,
                                       mean.saturation_deficit_rad_s);
      !status.ok())
    return status;
  pose = my.pose_along(trajectory, trajectory.duration_s(), at_start->motion_error_covariance);
  pose.time_ns = end_ns;
  report_velocity(mapping::marginal_motion_errors(mapping::unknowns_at(trajectory, trajectory.duration_s()),
                                                  at_start->motion_error_covariance),
                  trajectory.state(trajectory.duration_s()));
  return {};
}

LidarImuCalibration LidarInertialOdometry::lidar_calibration() const {
  LidarImuCalibration out = impl_->sweep_boundary.state_estimate.mean.calibration;
  out.imu_minus_lidar_clock_s += impl_->params.imu_minus_lidar_clock_s;
  return out;
}

LidarImuCalibration::Covariance LidarInertialOdometry::lidar_calibration_covariance() const {
  return mapping::unknowns::sub_block(impl_->sweep_boundary.state_estimate.state_error_covariance,
                                      mapping::unknowns::calibration);
}

LidarImuCalibration::Covariance LidarInertialOdometry::next_lidar_calibration_prior_covariance() const {
  return mapping::unknowns::sub_block(impl_->sweep_boundary.state_estimate.prior_weight_covariance,
                                      mapping::unknowns::calibration);
}

Status LidarInertialOdometry::check_gravity_direction() const {
  constexpr double kMost_rad = 0.02;
  namespace u = mapping::unknowns;
  const double variance =
      u::variances(impl_->sweep_boundary.state_estimate.state_error_covariance, u::gravity).head<2>().maxCoeff();
  const double sigma_rad = std::sqrt(variance) / std::max(impl_->params.expert.gravity_m_s2, 1e-3);
  if (!mapping::has_started(impl_->tracking) || !(sigma_rad > kMost_rad)) return {};
  return {ErrorCode::out_of_range, "standard deviation in rad of the map's vertical after a start in motion", sigma_rad,
          kMost_rad};
}

Status LidarInertialOdometry::pose_at(TimeNs time_ns, PoseState& pose) const {
  const auto& window = impl_->window.sweeps();
  if (window.empty()) return {ErrorCode::empty, "sweeps", 0.0, 1.0};
  const TimeNs first_ns = window.front().filtered.mean.state.time_ns;
  if (time_ns < first_ns) return {ErrorCode::out_of_range, "time_ns", double(time_ns), double(first_ns)};
  const auto holds = [&](const mapping::WindowSweep& sweep) { return time_ns <= sweep.end_ns; };
  const auto sweep = std::find_if(window.begin(), window.end(), holds);
  if (sweep == window.end()) return {ErrorCode::out_of_range, "time_ns", double(time_ns), double(window.back().end_ns)};
  SweepTrajectory motion;
  if (Status status = sweep->motion(motion); !status.ok()) return status;
  pose = impl_->pose_along(motion, seconds(time_ns - motion.start_ns()), sweep->smoothed.error_covariance);
  pose.time_ns = time_ns;
  return {};
}

std::vector<std::vector<PoseState>> LidarInertialOdometry::window_trajectories() const {
  std::vector<std::vector<PoseState>> all;
  const mapping::LagWindow& window = impl_->window;
  for (std::size_t k = window.is_full() ? 1 : 0; k < window.sweeps().size(); ++k)
    all.push_back(impl_->poses_of(window.sweeps()[k]));
  return all;
}

std::size_t LidarInertialOdometry::map_memory_bytes() const {
  return impl_->map.bytes();
}

std::vector<MapPoint> LidarInertialOdometry::map() const {
  if (!impl_->extends_map()) return impl_->localiser.map().points;
  return impl_->map.to_map_points(impl_->params);
}

const char* to_string(SweepVerdict verdict) {
  switch (verdict) {
    case SweepVerdict::first:
      return "first";
    case SweepVerdict::registered:
      return "registered";
    case SweepVerdict::degenerate:
      return "degenerate";
    case SweepVerdict::rejected:
      return "rejected";
  }
  return "unknown";
}

Status check_odometry_params(const OdometryParams& params) {
  return out_of_bounds(params).status;
}

}  // namespace tumble
