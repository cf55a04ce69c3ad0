// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/frozen_axes.hpp"

namespace tumble::scenarios {

std::string to_string(const FrozenAxis& frozen) {
  return std::string(frozen.triad == Triad::gyro ? "gyro_" : "accel_") + "xyz"[frozen.axis];
}

std::vector<FrozenAxis> find_frozen_axes(const sim::ImuRecord& record, std::span<const ImuSample> samples) {
  FrozenAxes::Params params;
  params.gyro_range_rad_s = record.stated_gyro_range_rad_s;
  params.accel_range_m_s2 = record.stated_accel_range_m_s2;
  return tumble::find_frozen_axes(FrozenAxes(params), samples);
}

}  // namespace tumble::scenarios
