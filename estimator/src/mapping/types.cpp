// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/types.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../common/dense.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/deskew.hpp"

namespace tumble {

void LidarImuCalibration::add(const Eigen::Matrix<double, kErrorCount, 1>& error) {
  const Eigen::Quaterniond turned = (so3::exp(error.segment<3>(0)) * Eigen::Quaterniond(T_IL.linear())).normalized();
  T_IL.linear() = turned.toRotationMatrix();
  T_IL.translation() += error.segment<3>(3);
  imu_minus_lidar_clock_s += error[6];
  gravity_W_m_s2 += error.segment<3>(7);
}

Eigen::Matrix<double, LidarImuCalibration::kErrorCount, 1> LidarImuCalibration::minus(
    const LidarImuCalibration& other) const {
  Eigen::Matrix<double, kErrorCount, 1> error;
  error << so3::logarithm(Eigen::Quaterniond(T_IL.linear() * other.T_IL.linear().transpose()).normalized()),
      T_IL.translation() - other.T_IL.translation(), imu_minus_lidar_clock_s - other.imu_minus_lidar_clock_s,
      gravity_W_m_s2 - other.gravity_W_m_s2;
  return error;
}

double LidarImuCalibrationPrior::distance_in_sigmas(const LidarImuCalibration& estimated) const {
  const auto by = estimated.minus(calibration);
  const auto share = [](double part, double sigma) { return part == 0.0 ? 0.0 : part / sigma; };
  return std::max({share(by.head<3>().norm(), mount_sigma_rad), share(by.segment<3>(3).norm(), mount_sigma_m),
                   share(std::abs(by[6]), time_offset_sigma_s)});
}

Status check_lidar_calibration_distance(double deviations) {
  constexpr double kMost = LidarImuCalibrationPrior::kDistanceMax_sigmas;
  if (deviations <= kMost) return {};
  return {ErrorCode::out_of_range,
          "change of the lidar-IMU calibration in standard deviations of the stated calibration", deviations, kMost};
}

namespace {

constexpr double kRotation = 1e-5;  // tolerance of a rotation matrix that was converted to text or floats

constexpr Status not_finite(const char* field) {
  return {ErrorCode::non_finite, field, std::numeric_limits<double>::quiet_NaN(), 0.0};
}

Status check(const VelocityReading& reading) {
  if (!reading.v_WI_I_m_s.allFinite()) return not_finite("v_WI_I_m_s");
  if (!std::isfinite(reading.sigma_m_s)) return not_finite("sigma_m_s");
  if (!(reading.sigma_m_s > 0.0)) return {ErrorCode::out_of_range, "sigma_m_s", reading.sigma_m_s, 0.0};
  return {};
}

Status check(const RelativePoseReading& reading) {
  if (!reading.imu_T_from_to.matrix().allFinite()) return not_finite("imu_T_from_to");
  if (!reading.covariance.allFinite()) return not_finite("covariance");
  if (reading.to_ns <= reading.from_ns)
    return {ErrorCode::time_order, "to_ns", double(reading.to_ns), double(reading.from_ns)};
  const Eigen::Matrix3d R = reading.imu_T_from_to.linear();
  const double off = (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kRotation) || !(R.determinant() > 0.0))
    return {ErrorCode::out_of_range, "imu_T_from_to", off, kRotation};
  const double least = reading.covariance.diagonal().minCoeff();
  if (!(least > 0.0) || !dense::Cholesky(reading.covariance).ok())
    return {ErrorCode::out_of_range, "covariance", least, 0.0};
  return {};
}

}  // namespace

Status check_odometer_reading(const OdometerReading& reading) {
  return std::visit([](const auto& kind) { return check(kind); }, reading);
}

TimeNs reading_start_ns(const OdometerReading& reading) {
  const auto* const motion = std::get_if<RelativePoseReading>(&reading);
  return motion != nullptr ? motion->from_ns : std::get_if<VelocityReading>(&reading)->time_ns;
}

TimeNs reading_end_ns(const OdometerReading& reading) {
  const auto* const motion = std::get_if<RelativePoseReading>(&reading);
  return motion != nullptr ? motion->to_ns : std::get_if<VelocityReading>(&reading)->time_ns;
}

PoseState PositionFrame::transform(const PoseState& in_W) const {
  PoseState out = in_W;
  const Eigen::Matrix3d R = T_PW.linear();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  out.position_W_m = T_PW * in_W.position_W_m;
  out.orientation_W = (Eigen::Quaterniond(R) * in_W.orientation_W).normalized();
  out.velocity_W_m_s = R * in_W.velocity_W_m_s;
  Eigen::Matrix<double, 6, 4> J = Eigen::Matrix<double, 6, 4>::Zero();
  J.topLeftCorner<3, 3>().setIdentity();
  J.col(3) << up.cross(R * (in_W.position_W_m - covariance_reference_point_W_m)), up;
  out.covariance = J * xyz_yaw_covariance_P * J.transpose();
  const Eigen::Matrix3d attitude = R * in_W.covariance.bottomRightCorner<3, 3>() * R.transpose();
  out.covariance.block<2, 2>(3, 3) += attitude.topLeftCorner<2, 2>();
  return out;
}

}  // namespace tumble
