// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "scenarios/baselines/angular_velocity/accelerometer_rate.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/common/detail/imu_interpolation.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::AccelerometerRate::Params>& rate_accelerometers_settings() {
  static const Settings<baselines::AccelerometerRate::Params> all(
      baselines::AccelerometerRate::Params{}, {.stated = {"gyro_noise_density", "accel_noise_density"}});
  return all;
}

// Computes the specific force that the IMU `other` measures, in its axes, at the time stamps of the primary IMU. The
// force is NaN outside the readings of `other`, and where its accelerometer is clipped. The gyro of `other` is not
// used.
Status auxiliary_imu(const sim::ImuRecord& primary, const sim::ImuRecord& other, AuxiliaryAccelerometer& out) {
  std::vector<ImuSample> there;
  if (Status status = bridge::imu_samples(other, there); !status.ok()) return status;
  const Eigen::Isometry3d T_IO = primary.T_BI.inverse(Eigen::Isometry) * other.T_BI;
  out.p_I_m = T_IO.translation();
  out.specific_force_m_s2.assign(primary.time_ns.size(),
                                 Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()));
  const double rail = unsaturated_range(other.stated_accel_range_m_s2);
  if (there.size() < 2) return {};
  ImuInterpolation interpolation(there);
  for (std::size_t k = 0; k < primary.time_ns.size(); ++k) {
    const ImuNeighbours near = interpolation.around(primary.time_ns[k]);
    const double largest = std::max(there[near.before].specific_force_m_s2.cwiseAbs().maxCoeff(),
                                    there[near.after].specific_force_m_s2.cwiseAbs().maxCoeff());
    if (!near.between() || largest >= rail) continue;
    out.specific_force_m_s2[k] = T_IO.linear() * interpolation.at(primary.time_ns[k], near).specific_force_m_s2;
  }
  return {};
}

Estimate run_rate_accelerometers(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  const sim::ImuRecord& record = sensors.imus.front();
  std::vector<AuxiliaryAccelerometer> auxiliary_imus(sensors.imus.size() - 1);
  baselines::AccelerometerRate::Params params;
  params.accel_noise_density = record.accel_noise_m_s2_sqrt_hz;
  for (std::size_t i = 0; i < auxiliary_imus.size(); ++i) {
    estimate.status = auxiliary_imu(record, sensors.imus[i + 1], auxiliary_imus[i]);
    if (!estimate.status.ok()) return estimate;
    params.accel_noise_density = std::max(params.accel_noise_density, sensors.imus[i + 1].accel_noise_m_s2_sqrt_hz);
  }
  if (!(params.accel_noise_density > 0.0))
    params.accel_noise_density = baselines::AccelerometerRate::Params{}.accel_noise_density;
  params.rails = stated_rails(record);
  if (record.gyro_noise_rad_s_sqrt_hz > 0.0) params.gyro_noise_density = record.gyro_noise_rad_s_sqrt_hz;
  rate_accelerometers_settings().apply(parameters, params);
  estimate.status = baselines::AccelerometerRate(params).estimate(samples, auxiliary_imus, estimate.rates);
  estimate.health["accelerometers"] = static_cast<double>(sensors.imus.size());
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

Method rate_accelerometers() {
  MethodInfo info;
  info.name = "accelerometers";
  info.kind = Kind::rate;
  info.doc =
      "Estimates the rate with an extended Kalman filter from the differences of all accelerometers, including the "
      "reference IMU, and from the unclipped gyro axes. The method is made for long fast rotation with accelerometers "
      "far apart.";
  info.source = "similar to the gyro-free inertial systems of Pachter and Lee";
  info.settings = {&rate_accelerometers_settings()};
  return make_method(std::move(info), run_rate_accelerometers);
}

}  // namespace tumble::scenarios
