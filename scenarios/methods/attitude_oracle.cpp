// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/methods/attitude_tumble.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::scenarios {

namespace {

/// Returns the sensor data with the true gyro readings before clipping. The accelerometer stays clipped.
sim::Sensors unclipped_gyros(const sim::Sensors& sensors, const sim::Truth& truth) {
  if (truth.imus.size() < sensors.imus.size()) throw BadInput("the truth lacks an IMU of the recording");
  sim::Sensors out;
  out.robot = sensors.robot;
  out.sphere_radius_m = sensors.sphere_radius_m;
  out.gravity_m_s2 = sensors.gravity_m_s2;
  out.imus = sensors.imus;
  for (std::size_t i = 0; i < out.imus.size(); ++i) {
    sim::ImuRecord& imu = out.imus[i];
    if (truth.imus[i].gyro_unclipped_rad_s.size() != imu.time_ns.size()) {
      throw BadInput(fmt::format("the truth of imu '{}' must have one reading per sample", imu.name));
    }
    imu.gyro_rad_s = truth.imus[i].gyro_unclipped_rad_s;
    imu.stated_gyro_range_rad_s = 0.0;
    for (std::uint8_t& flags : imu.clip_flags) flags = static_cast<std::uint8_t>(flags & ~kClipGyro);
  }
  return out;
}

Estimate run_attitude_oracle(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  // The clipped readings are checked too: where no method can succeed, the oracle (a method with true input) must also
  // fail.
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  return run_attitude_tumble(unclipped_gyros(sensors, *oracle.truth), parameters);
}

}  // namespace

Method attitude_oracle() {
  MethodInfo info;
  info.name = "oracle";
  info.kind = Kind::attitude;
  info.doc =
      "Gives an upper bound of the accuracy: applies attitude/tumble to gyro readings without saturation. Noise, bias "
      "and bandwidth are unchanged.";
  info.ours = true;
  info.settings = {&attitude_tumble_settings()};
  info.needs_truth = true;
  return make_method(std::move(info), at_sample_times<run_attitude_oracle>);
}

}  // namespace tumble::scenarios
