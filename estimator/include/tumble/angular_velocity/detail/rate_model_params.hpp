// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/auxiliary_imu.hpp"
#include "tumble/angular_velocity/detail/rate_model_expert_params.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Parameters of sensors, body and motion that AngularRateSmoother and AngularRateStream share.
struct AngularRateModelParams {
  /// Prior mean of the rig constants: lever arm, biases, inertia ratios and gyro axis directions. The lever arm is
  /// required unless `calibration` is set.
  BodyImuConstants nominal = {.lever_arm_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  double lever_arm_sigma_m = 0.01;
  double gyro_bias_sigma_rad_s = 0.01;
  double accel_bias_sigma_m_s2 = 0.05;
  double inertia_sigma = 0.3;
  /// prior standard deviation of each cross-axis sensitivity of the gyro's sensing elements, before the sensor's
  /// misalignment compensation
  double element_sigma = 0.03;
  /// Calibration from an earlier run, which replaces the prior mean `nominal` and the five prior standard deviations
  /// above.
  std::optional<BodyImuCalibration> calibration = std::nullopt;

  /// Additional IMUs on the body, at most kAuxiliaryImusMax.
  std::vector<AuxiliaryImu> auxiliary_imus = {};

  /// noise density of the gyro [rad/s/sqrt(Hz)]; default: 0.03 deg/s/sqrt(Hz)
  double gyro_noise_density = 5.236e-4;
  /// noise density of the accelerometer [m/s^2/sqrt(Hz)]; default: 60 ug/sqrt(Hz)
  double accel_noise_density = 5.9e-4;
  /// known scale, misalignment, g-sensitivity and delay errors, which are subtracted from the readings
  SensorErrors errors = {};
  /// Largest possible angular rate and angular acceleration of the body, as limits of the estimate while the gyro is
  /// clipped.
  static constexpr double kRateMax_rad_s = 50.0;
  static constexpr double kAccelerationMax_rad_s2 = 5000.0;

  using Expert = AngularRateModelExpertParams;
  Expert expert = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.lever_arm_sigma_m, {"lever_arm_sigma_m", "m", 1e-9, 10.0,
                                "prior standard deviation of the lever arm from the centre of mass to the IMU",
                                ParameterAudience::common_use});
    visit(p.gyro_bias_sigma_rad_s, {"gyro_bias_sigma_rad_s", "rad/s", 1e-9, 10.0,
                                    "prior standard deviation of the gyro bias", ParameterAudience::common_use});
    visit(p.accel_bias_sigma_m_s2,
          {"accel_bias_sigma_m_s2", "m/s^2", 1e-9, 10.0, "prior standard deviation of the accelerometer bias",
           ParameterAudience::common_use});
    visit(p.inertia_sigma,
          {"inertia_sigma", "1", 1e-9, 10.0,
           "prior standard deviation of the inertia ratios; the prior mean is a body with equal moments of inertia",
           ParameterAudience::common_use});
    visit(p.element_sigma, {"element_sigma", "1", 1e-9, 0.2,
                            "prior standard deviation of each cross-axis sensitivity of the gyro's sensing elements, "
                            "before the device's compensation",
                            ParameterAudience::common_use});
    visit(p.gyro_noise_density,
          {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0,
           "noise density of the gyro; a larger value gives gyro readings less weight; default: 0.03 deg/s/sqrt(Hz)"});
    visit(p.accel_noise_density, {"accel_noise_density", "m/s^2/sqrt(Hz)", 1e-9, 10.0,
                                  "noise density of the accelerometer; a larger value gives accelerometer readings "
                                  "less weight; default: 60 ug/sqrt(Hz)"});
    visit.group("", p.expert);
  }
};

inline constexpr std::size_t kAuxiliaryImusMax = 2;

}  // namespace tumble
