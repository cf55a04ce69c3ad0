// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/common/so3.hpp"

namespace tumble {

void LidarImuCalibration::add(const Eigen::Matrix<double, kErrorCount, 1>& error) {
  const Eigen::Quaterniond turned = (so3::exp(error.segment<3>(0)) * Eigen::Quaterniond(T_IL.linear())).normalized();
  T_IL.linear() = turned.toRotationMatrix();
  T_IL.translation() += error.segment<3>(3);
  time_offset_s += error[6];
  gravity_W_m_s2 += error.segment<3>(7);
}

Eigen::Matrix<double, LidarImuCalibration::kErrorCount, 1> LidarImuCalibration::minus(
    const LidarImuCalibration& other) const {
  Eigen::Matrix<double, kErrorCount, 1> error;
  error << so3::logarithm(Eigen::Quaterniond(T_IL.linear() * other.T_IL.linear().transpose()).normalized()),
      T_IL.translation() - other.T_IL.translation(), time_offset_s - other.time_offset_s,
      gravity_W_m_s2 - other.gravity_W_m_s2;
  return error;
}

double LidarImuCalibrationPrior::distance_in_sigmas(const LidarImuCalibration& estimated) const {
  const auto by = estimated.minus(calibration);
  const auto share = [](double part, double sigma) { return part == 0.0 ? 0.0 : part / sigma; };
  return std::max({share(by.head<3>().norm(), mount_sigma_rad), share(by.segment<3>(3).norm(), mount_sigma_m),
                   share(std::abs(by[6]), time_offset_sigma_s)});
}

Status LidarImuCalibrationPrior::verdict(const LidarImuCalibration& estimated) const {
  return distance_verdict(distance_in_sigmas(estimated));
}

Status distance_verdict(double deviations) {
  constexpr double kMost = LidarImuCalibrationPrior::kDistanceMax_sigmas;
  if (deviations <= kMost) return {};
  return {ErrorCode::out_of_range,
          "change of the lidar-IMU calibration in standard deviations of the stated calibration", deviations, kMost};
}

}  // namespace tumble
