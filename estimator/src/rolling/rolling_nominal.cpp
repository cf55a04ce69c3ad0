// SPDX-License-Identifier: BSD-3-Clause
#include "rolling_node.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"
#include "tumble/rolling/detail/rolling_params.hpp"

namespace tumble::rolling {

Eigen::Matrix<double, RollingCalibration::kSize, 1> constants_of(const RollingNominalState& nominal) {
  Eigen::Matrix<double, RollingCalibration::kSize, 1> out;
  out << nominal.gyro_bias_rad_s, nominal.accel_bias_m_s2, nominal.accel_scale.reshaped(),
      nominal.gyro_scale.reshaped(), nominal.accel_delay_s, nominal.lever_arm_error_m, nominal.floor_slope,
      nominal.radius_error_m;
  return out;
}

/// See rolling.md (R1).
void move_linearisation_point(const Vector& x, RollingNominalState& nominal) {
  nominal.q_WI = (so3::exp(x.segment<3>(kAttitude)) * nominal.q_WI).normalized();
  nominal.v_WI_m_s += x.segment<3>(kVelocity);
  nominal.p_WI_m += x.segment<3>(kPosition);
  nominal.gyro_bias_rad_s += x.segment<3>(kGyroBias);
  nominal.accel_bias_m_s2 += x.segment<3>(kAccelBias);
  nominal.accel_scale += Eigen::Map<const Eigen::Matrix3d>(x.data() + kAccelScale);
  nominal.gyro_scale += Eigen::Map<const Eigen::Matrix3d>(x.data() + kGyroScale);
  nominal.accel_delay_s += x[kDelay];
  nominal.lever_arm_error_m += x.segment<3>(kLeverArm);
  nominal.floor_slope += x.segment<2>(kSlope);
  nominal.radius_error_m += x[kRadius];
}

}  // namespace tumble::rolling

namespace tumble {

void require_valid(const RollingParams& p) {
  require_valid_fields(p);
  require_in_interval("lever_arm_m", p.lever_arm_m.norm(), 0.0, 10.0);
  if (p.q_WI_start) require_in_interval("q_WI_start", p.q_WI_start->norm(), 1.0 - 1e-6, 1.0 + 1e-6);
}

}  // namespace tumble
