// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/auxiliary_imu.hpp"
#include "tumble/angular_velocity/rig_constants.hpp"
#include "tumble/angular_velocity/sensor_errors.hpp"

namespace tumble {

/// What is assumed of the sensors, of the body and of its motion; shared by the batch and the streaming smoother.
struct RateModelParams {
  /// What is known of the rig beforehand; the shape of the inertia counts about the centre of mass, in IMU axes. The
  /// lever arm has no default: it is refused until it is stated, unless there is a `calibration`.
  RigConstants nominal = {.lever_arm_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  /// Standard deviations of `nominal`.
  double lever_arm_sigma_m = 0.01;
  double gyro_bias_sigma_rad_s = 0.01;
  double accel_bias_sigma_m_s2 = 0.05;
  double inertia_sigma = 0.3;
  /// Of each entry of RigConstants::elements: cross-axis sensitivity before the device compensates it.
  double element_sigma = 0.03;
  /// What an earlier run has learnt; takes the place of `nominal` and of the five deviations above.
  std::optional<RigCalibration> calibration = std::nullopt;

  /// Other IMUs on the body, at most kAuxiliaryImusMax; their readings come with each sample.
  std::vector<AuxiliaryImu> auxiliary_imus = {};

  /// Noise density of the gyro [rad/s/sqrt(Hz)]; of an industrial MEMS gyro, 0.03 deg/s/sqrt(Hz).
  double gyro_noise_density = 5.236e-4;
  /// Noise density of the accelerometer [m/s^2/sqrt(Hz)]; of an industrial MEMS accelerometer, 60 ug/sqrt(Hz).
  double accel_noise_density = 5.9e-4;
  /// What the flight model misses of the specific force (drag, bias in motion), besides noise [m/s^2].
  double flight_sigma_m_s2 = 0.02;
  /// What the model misses of a force, a torque or a rate lasts so long: samples that come faster say it once between
  /// them, and their noise alone averages out [s].
  double model_error_s = 0.01;
  /// Scale and misalignment of the accelerometer, as a share of the force.
  double accel_scale_error = 1e-3;
  /// What the device makes of the motion, as far as it is known: readings are corrected for it.
  SensorErrors errors = {};
  /// What is left open of it.
  SensorErrorSizes error_sizes = {};
  /// What a gyro's bandwidth and its clock leave open of the time of a reading (a first-order low-pass at 415 Hz is
  /// 0.38 ms late): counted in the covariance, times the angular acceleration [s].
  double gyro_time_sigma_s = 2.5e-4;
  /// What Euler's equation without torque misses of the angular acceleration [rad/s^2].
  double euler_sigma_rad_s2 = 0.3;
  /// Density of the white angular jerk in flight [rad^2/s^5].
  double jerk_psd_flight = 1e4;
  /// In contact the jerk grows by what the force can do to the angular acceleration: rad/s^2 per m/s^2 of specific
  /// force that the flight model cannot explain.
  double contact_gain_rad_m = 4.0;
  /// Impacts are no Gaussian noise: what a fit through one claims to know is widened by this factor.
  double contact_sigma_factor = 1.3;
  /// Euler's equation in contact: a force F turns the body across itself, by up to about this times |F| (mass times
  /// distance of the contact over a third of the trace of the inertia) ....
  double contact_lever_rad_m = 5.0;
  /// ... and about its own direction by a share of that (several contacts, a contact that moves in a window).
  double contact_twist_share = 0.3;
  /// In contact the unknown force is taken for zero with a standard deviation of this times itself (a prior that is
  /// flat in its logarithm has 0.58); 0: nothing is assumed of it.
  double contact_force_share = 1.0;
  /// A sample whose residuals of flight exceed this many standard deviations counts as contact.
  double flight_threshold = 5.0;
  /// Softness of the bound that a clipped reading is [rad/s].
  double rail_sigma_rad_s = 0.05;
  /// A body at rest still trembles, and rest may be found where there is none: deviation of its rate from zero, taken
  /// anew with each sample [rad/s].
  double rest_sigma_rad_s = 0.01;
  /// Rates and accelerations that no body of this kind has; they bound the answer where nothing else does. The first
  /// in [1, 1e4] rad/s, the second in [1, 1e7] rad/s^2.
  double rate_max_rad_s = 50.0;
  double acceleration_max_rad_s2 = 5000.0;

  /// Every number of it, stated once: `rate_model_params_fields.hpp`.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit);
};

inline constexpr std::size_t kAuxiliaryImusMax = 2;

}  // namespace tumble
