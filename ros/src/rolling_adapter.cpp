// SPDX-License-Identifier: BSD-3-Clause
#include "tumble_ros/rolling_adapter.hpp"

#include <optional>

#include "adapter_values.hpp"

namespace tumble::ros {

namespace {

double rate_variance(const ImuDataSheet& sheet) {
  return sheet.gyro_noise_rad_s_sqrt_hz * sheet.gyro_noise_rad_s_sqrt_hz * sheet.rate_hz;
}

}  // namespace

/// Converts a pose of the sphere. The base frame is the sphere.
Odometry RollingAdapter::odometry_of(const RollingOdometry::Pose& sphere) const {
  AngularRateState rate;
  rate.w_WI_I_rad_s = sphere.angular_velocity_B_rad_s;
  rate.covariance_rad2_s2 = rate_variance_rad2_s2_ * Eigen::Matrix3d::Identity();
  return base_odometry(sphere.pose, sphere.velocity_covariance_B_m2_s2, rate, Eigen::Isometry3d::Identity());
}

RollingAdapter::RollingAdapter(const Params& params, Publisher& publisher)
    : units_(params.odometry.imus.size()),
      publisher_(publisher),
      odometry_(params.odometry),
      rate_variance_rad2_s2_(rate_variance(params.odometry.imus.front().data_sheet)),
      diagnostics_(params.adapter.diagnostics_period_s) {
  require_valid_fields(params.adapter);
}

Status RollingAdapter::on_imu(std::size_t unit, const ImuSample& sample) {
  const Status status =
      imu_.count(units_ == 1 && unit == 0 ? odometry_.add_imu(sample) : odometry_.add_imu(unit, sample));
  while (const std::optional<RollingOdometry::Pose> pose = odometry_.take()) publisher_.odometry(odometry_of(*pose));
  const std::optional<RollingOdometry::Pose> newest = odometry_.newest();
  if (newest && newest->pose.time_ns != newest_ns_ && publisher_.wants(Output::odometry_imu)) {
    newest_ns_ = newest->pose.time_ns;
    publisher_.odometry_imu(odometry_of(*newest));
  }
  if (diagnostics_.is_due(sample.time_ns)) publish_diagnostics(sample.time_ns);
  return status;
}

void RollingAdapter::reset(const Eigen::Isometry3d& T_OB) {
  odometry_.reset(T_OB);
}

void RollingAdapter::publish_diagnostics(TimeNs time_ns) {
  const SensorHealth health = odometry_.health();
  const std::optional<RollingOdometry::Pose> newest = odometry_.newest();
  Diagnostics out;
  out.ok = health.ok() && newest && !newest->position_uncertain;
  out.message = !health.ok()                           ? health.worst_message()
                : newest && newest->position_uncertain ? "position is uncertain"
                                                       : "ok";
  if (!newest) out.message = "no pose yet";
  add_findings(out, health);
  add_input(out, "imu", imu_);
  add(out, "restarts after a gap or a step of the clock", odometry_.restart_count());
  add(out, "outliers among the IMU samples", odometry_.rejected_readings());
  publisher_.diagnostics(time_ns, out);
}

}  // namespace tumble::ros
