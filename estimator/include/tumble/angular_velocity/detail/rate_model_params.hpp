// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/auxiliary_imu.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

struct FlightRateParams {
  double sigma_m_s2 =
      0.02;  ///< standard deviation of the specific force in flight, besides noise: air drag, accelerometer errors
  double euler_sigma_rad_s2 = 0.3;  ///< error of the angular acceleration from Euler's equation without torque
  static constexpr double kJerkPsd_rad2_s5 = 1e4;
  static constexpr double kThreshold =
      5.0;  ///< a sample with larger flight residuals, in standard deviations, is in contact

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.sigma_m_s2, {"flight_sigma_m_s2", "m/s^2", 1e-6, 100.0,
                         "standard deviation of the force error of the flight model", ParameterAudience::common_use});
    visit(p.euler_sigma_rad_s2,
          {"euler_sigma_rad_s2", "rad/s^2", 1e-6, 1e6,
           "standard deviation of the angular acceleration that Euler's equation without torque does not explain",
           ParameterAudience::common_use});
  }
};

struct ContactRateParams {
  /// assumed angular acceleration per unit of contact force [rad/s^2 per m/s^2]
  static constexpr double kGain_rad_m = 4.0;
  /// factor on the standard deviation of rates during impacts, because their errors are not Gaussian
  static constexpr double kSigmaFactor = 1.3;
  /// Largest angular acceleration about axes perpendicular to a contact force, per unit of specific force.
  static constexpr double kLever_rad_m = 5.0;
  /// Ratio of the angular acceleration about the direction of a contact force to the angular acceleration perpendicular
  /// to this direction.
  static constexpr double kTwistRatio = 0.3;
  /// standard deviation of the unknown contact force, relative to the specific force
  static constexpr double kForceShare = 1.0;
};

struct AngularRateModelExpertParams {
  /// correlation time of the model errors of specific force, torque and rate
  static constexpr double kModelError_s = 0.01;
  /// standard deviation of the zero-rate measurement per sample at rest; covers vibration and false detections of rest
  static constexpr double kRestSigma_rad_s = 0.01;
  SensorErrorPriors error_priors = {};
  /// relative scale and misalignment error of the accelerometer
  static constexpr double kAccelScaleError = 1e-3;
  /// Standard deviation of the time of a gyro reading, due to the gyro's bandwidth and clock.
  static constexpr double kGyroTimeSigma_s = 2.5e-4;
  static constexpr double kRailSigma_rad_s =
      0.05;  ///< standard deviation of the lower bound that a clipped reading gives
  FlightRateParams flight = {};
  ContactRateParams contact = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.flight);
    visit.group("error_sizes_", p.error_priors);
  }
};

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
