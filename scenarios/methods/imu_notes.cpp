// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/imu_notes.hpp"

#include <fmt/format.h>

#include <optional>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/lidar_rotation.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "tumble/attitude/detail/imu_plausibility.hpp"

namespace tumble::scenarios {

namespace {

std::string labels_text(const AxisLabels& labels) {
  SignedAxes axes;
  for (std::size_t j = 0; j < 3; ++j) {
    const auto read = static_cast<std::size_t>(labels.axis[j]);
    axes.axis[read] = static_cast<int>(j);
    axes.sign[read] = static_cast<int>(labels.sign[j]);
  }
  return fmt::format(
      "caution: the gravity that the accelerometer measures rotates as if the accelerometer's axes x, y, z were the "
      "axes {}{}; check the signs and the order of the axes in the driver",
      axes.text(), labels.gyro_flipped ? " of a gyro with opposite sign" : " of the gyro");
}

}  // namespace

std::string imu_note(const sim::ImuRecord& imu, double gravity_m_s2) {
  std::vector<ImuSample> samples;
  // The reader of recordings already reports errors of single readings.
  if (!bridge::imu_samples(imu, samples).ok()) return "";
  ImuPlausibility::Params params;
  params.gravity_m_s2 = gravity_m_s2;
  const ImuPlausibility plausibility(params);
  ImuPlausibility::State state;
  for (const ImuSample& sample : samples) plausibility.step(sample, state);
  if (const double frozen_s = plausibility.frozen_s(state); frozen_s > 0.0)
    return fmt::format(
        "caution: the gyro or the accelerometer repeats exactly the same reading for {} s; the sensor may be frozen",
        rounded(frozen_s));
  if (const std::optional<AxisLabels> labels = plausibility.better_axis_labels(state)) return labels_text(*labels);
  const Status verdict = plausibility.verdict(state);
  return verdict.ok() ? ""
                      : fmt::format("caution: the readings are inconsistent with each other or with gravity: {}",
                                    verdict.message());
}

std::vector<std::string> imu_notes(const Imported& recording) {
  std::vector<std::string> out;
  for (const sim::ImuRecord& imu : recording.sensors.imus) {
    const std::string note = imu_note(imu, recording.sensors.gravity_m_s2);
    if (!note.empty()) out.push_back(imu.name + ": " + note);
  }
  return out;
}

}  // namespace tumble::scenarios
