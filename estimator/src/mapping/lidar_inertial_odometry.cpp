// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/lidar_inertial_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "odometry_impl.hpp"
#include "tumble/mapping/sweep_check.hpp"

namespace tumble {

Status LidarInertialOdometry::Impl::check_sweep(TimeNs start_ns, TimeNs end_ns,
                                                std::span<const LidarPoint> given) const {
  if (end_ns < start_ns) return {Trouble::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (started && start_ns < state.time_ns)
    return {Trouble::time_order, "start_ns", double(start_ns), double(state.time_ns)};
  if (samples.empty() && given.empty()) return {Trouble::empty, "points", 0.0, 1.0};
  if (samples.empty()) return {Trouble::too_few, "imu samples", 0.0, 1.0};
  if (samples.back().time_ns < end_ns) {
    return {Trouble::too_few, "imu time_ns", double(samples.back().time_ns), double(end_ns)};
  }
  // a clock known to be off may place the first sweep before the first sample: the rest at the start reaches back
  const double early_s = seconds(samples.front().from_ns - start_ns);
  if (!started && early_s > (params.time_offset_s != 0.0 ? SweepTrajectory::kBeyond_s : 0.0)) {
    return {Trouble::too_few, "start_ns", double(start_ns), double(samples.front().from_ns)};
  }
  return mapping::check_offsets(end_ns - start_ns, given);
}

void LidarInertialOdometry::Impl::finish(TimeNs end_ns, bool aligned, SweepReport& report) {
  lost_sweeps = report.verdict == SweepVerdict::rejected ? lost_sweeps + 1 : 0;
  report.lost_sweeps = lost_sweeps;
  if (aligned) count_drift(report);
  count_errors();
  report.trajectory = describe(trajectory, errors);
  enter_window(end_ns, aligned, report);
  carry_covariance(end_ns);
  // what the sweep adds to the map is off by what the pose was: by so much of it the map moves where the robot is:
  // mapping.md (R49)
  const double drawn_share =
      report.points_used == 0 ? 0.0 : double(report.map_points_added) / double(report.points_used);
  if (report.verdict != SweepVerdict::first) map_covariance += drawn_share * drawn_share * drawing_covariance();
  report.trajectory.back().time_ns = end_ns;
  report.pose = state.pose();
  report.pose.covariance = report.trajectory.back().covariance;

  railed_before = mapping::railed_velocity_variance(params, trajectory, samples);
  odometer.known = false;
  excess_share_at_end.setZero();
  if (aligned) excess_share_at_end = trajectory.excess_share_at_end();
  const auto after = std::find_if(samples.begin(), samples.end(), [&](const auto& s) { return s.time_ns > end_ns; });
  samples.erase(samples.begin(), after);
  forget_far_map();
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

Status LidarInertialOdometry::add_imu(const ImuSample& sample, const RateState& rate) {
  Impl& my = *impl_;
  if (!is_finite(sample)) return {Trouble::non_finite, "imu sample", std::numeric_limits<double>::quiet_NaN(), 0.0};
  if (!rate.w_WI_I_rad_s.allFinite() || !rate.covariance_rad2_s2.allFinite()) {
    return {Trouble::non_finite, "rate", std::numeric_limits<double>::quiet_NaN(), 0.0};
  }
  if (rate.time_ns != sample.time_ns) {
    return {Trouble::out_of_range, "rate.time_ns", double(rate.time_ns), double(sample.time_ns)};
  }
  const TimeNs last_ns = !my.samples.empty() ? my.samples.back().time_ns : my.state.time_ns;
  const bool follows = my.started || !my.samples.empty();
  if (follows && sample.time_ns <= last_ns) {
    return {Trouble::time_order, "time_ns", double(sample.time_ns), double(last_ns)};
  }
  my.take(sample, rate);
  return {};
}

Status LidarInertialOdometry::add_velocity(const Eigen::Vector3d& v_WI_I_m_s, double sigma_m_s) {
  if (!v_WI_I_m_s.allFinite() || !std::isfinite(sigma_m_s)) {
    return {Trouble::non_finite, "velocity", std::numeric_limits<double>::quiet_NaN(), 0.0};
  }
  if (!(sigma_m_s > 0.0)) return {Trouble::out_of_range, "sigma_m_s", sigma_m_s, 0.0};
  impl_->odometer = {v_WI_I_m_s, sigma_m_s, true};
  return {};
}

Status LidarInertialOdometry::add_sweep(TimeNs lidar_start_ns, TimeNs lidar_end_ns, std::span<const LidarPoint> points,
                                        SweepReport& report) {
  Impl& my = *impl_;
  report = SweepReport{};
  const TimeNs offset_ns = static_cast<TimeNs>(std::llround(my.params.time_offset_s * 1e9));
  const TimeNs start_ns = lidar_start_ns + offset_ns, end_ns = lidar_end_ns + offset_ns;
  if (Status status = my.check_sweep(start_ns, end_ns, points); !status.ok()) return status;
  MotionState start = my.state;
  if (!my.started) {
    if (Status status = mapping::start_at_rest(my.samples, my.params.rest_s, start); !status.ok()) return status;
    my.state = start;
    my.start_calibration();
  }
  if (Status status = my.trajectory.build(my.state, my.samples, end_ns, my.calibration.gravity_W_m_s2); !status.ok())
    return status;
  my.started = true;
  my.drawn.clear();
  my.resting_sweeps = my.imu_rests(end_ns) && !my.trajectory_speeds_up() ? my.resting_sweeps + 1 : 0;

  my.prediction = my.predict();
  const PointBounds bounds{my.params.range_min_m, my.params.range_max_m, my.params.own_body_L};
  const PointCounts counts =
      select_points(points, bounds, my.calibration.T_IL,
                    seconds(start_ns - my.state.time_ns) + my.calibration.time_offset_s, my.points);
  report.points_used = counts.used;
  my.unmatched = false;
  Status status = mapping::check_selection(end_ns - start_ns, points, counts);
  // neighbours are those of a ring: a device that does not tell its rings has none
  if (status.ok() && counts.rings_differ) report.points_alone = my.lone_returns.drop(my.range_noise, my.points);
  if (status.ok() && my.points.empty()) status = {Trouble::too_few, "points", 0.0, 1.0};
  const bool first = my.map.size() == 0;
  bool aligned = false;
  if (status.ok() && first && my.points.size() >= my.params.matches_min) {
    report.verdict = SweepVerdict::first;
  } else if (status.ok() && !first) {
    my.choose_points();
    report.points_registered = my.chosen.size();
    aligned = my.register_sweep(end_ns, report);
    if (aligned) report.innovation = my.innovation();
  }
  if (!aligned) {
    if (Status built = my.fall_back_on_inertia(end_ns); !built.ok()) return built;
  }
  // where the map had nothing to say the prior draws on: points that it leaves too uncertain stay out by themselves
  if (report.verdict != SweepVerdict::rejected || my.unmatched)
    report.map_points_added = my.extend_map(counts.rings_differ);
  my.finish(end_ns, aligned, report);
  return status;
}

SweepCalibration LidarInertialOdometry::calibration() const {
  SweepCalibration out = impl_->calibration;
  if (!impl_->started) out.T_IL = impl_->params.T_IL;
  out.time_offset_s += impl_->params.time_offset_s;
  return out;
}

SweepCalibration::Covariance LidarInertialOdometry::calibration_covariance() const {
  return impl_->error_covariance.bottomRightCorner<SweepCalibration::kErrors, SweepCalibration::kErrors>();
}

SweepCalibration::Covariance LidarInertialOdometry::calibration_weight() const {
  return impl_->covariance.bottomRightCorner<SweepCalibration::kErrors, SweepCalibration::kErrors>();
}

std::size_t LidarInertialOdometry::map_bytes() const {
  return impl_->map.bytes() + impl_->seen_from_W_m.capacity() * sizeof(Eigen::Vector3f);
}

}  // namespace tumble
