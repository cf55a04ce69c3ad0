// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/imu_check.hpp"

#include <cmath>
#include <string>

#include "scenarios/methods/frozen_axes.hpp"
#include "tumble/attitude/imu_plausibility.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kArmShareMin = 0.5;  // 1: as the places say; 0: no relation; -1: the sign is flipped
// Further from 1, gyros or accelerometers have another scale than they say, which all units share: forces go with the
// square of the rate, so that it is 3 % of a gyro's, three times a sheet's. Good runs of `slip`: 0.999 and 1.002.
constexpr double kArmShareOff = 0.06;

Status told(Status status, Estimate& estimate) {
  if (!status.ok()) estimate.health["imu_implausible"] = 1.0;
  return status;
}

}  // namespace

Status check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate) {
  ImuPlausibility::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  const ImuPlausibility plausibility(params);
  ImuPlausibility::State state;
  for (const ImuSample& sample : samples) plausibility.step(sample, state);
  estimate.health["imu_force_share"] = plausibility.force_share(state);
  estimate.health["imu_turning_unexplained"] = plausibility.unexplained_share(state);
  if (plausibility.frozen_s(state) > 0.0) estimate.health["imu_frozen_s"] = plausibility.frozen_s(state);
  if (const auto labels = plausibility.other_labels(state)) {
    constexpr const char* kKeys[] = {"imu_accel_x_is", "imu_accel_y_is", "imu_accel_z_is"};
    for (std::size_t j = 0; j < 3; ++j) estimate.health[kKeys[labels->axis[j]]] = labels->sign[j] * (1.0 + double(j));
    if (labels->gyro_flipped) estimate.health["imu_gyro_flipped"] = 1.0;
  }
  return told(plausibility.verdict(state), estimate);
}

Status check_imus(const sim::Sensors& sensors, const MergedImus& imus, Estimate& estimate) {
  const Status own = check_imu(sensors, imus.samples, estimate);
  if (!imus.arm_share) return own;
  estimate.health["imu_arm_share"] = *imus.arm_share;
  if (std::abs(*imus.arm_share - 1.0) > kArmShareOff) estimate.health["imu_implausible"] = 1.0;
  if (!own.ok() || *imus.arm_share >= kArmShareMin) return own;
  return told(
      {Trouble::out_of_range, "differences of the IMUs' forces as a share of what the turning makes of their places",
       *imus.arm_share, kArmShareMin},
      estimate);
}

void tell_frozen_axes(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate) {
  for (const FrozenAxis& frozen : find_frozen_axes(sensors.imus.front(), samples)) {
    const std::string key = sensors.imus.front().name + "_" + to_string(frozen) + "_frozen_since_s";
    estimate.health.try_emplace(key, seconds(frozen.from_ns - samples.front().time_ns));
    estimate.health["imu_implausible"] = 1.0;
  }
}

}  // namespace tumble::scenarios
