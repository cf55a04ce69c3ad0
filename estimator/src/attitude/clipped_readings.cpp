// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/clipped_readings.hpp"

#include <cstddef>
#include <optional>

#include "../angular_velocity/near_rails.hpp"

namespace tumble {

void ClippedReadings::mark_suspect(std::span<const ImuSample> samples, std::span<const std::uint8_t> axes) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      std::int8_t& sign = signs[k].gyro[static_cast<std::size_t>(j)];
      if ((axes[k] >> j & 1u) != 0 && sign == 0) sign = samples[k].angular_velocity_rad_s[j] < 0.0 ? -1 : 1;
    }
  }
}

void ClippedReadings::mark_partly_saturated(std::span<RateState> rates) const {
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (near[k] != 0 && rates[k].source == RateSource::measured) rates[k].source = RateSource::bounded_only;
  }
}

ClippedReadings to_clipped_readings(std::span<const ImuSample> samples, const ClippingFinder::Found& found) {
  ClippedReadings out;
  out.signs.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) out.signs[k] = clip_signs(samples[k], found.clippings[k]);
  out.near = possible_partial_saturation(
      samples, found.rails.gyro_clips_after_compensation ? RailPlanes{} : found.rails.planes_in_use());
  for (int j = 0; j < 3; ++j) {
    const std::optional<RailPlane>& plane = found.rails.planes.element[static_cast<std::size_t>(j)];
    if (plane) out.rows.row(j) = plane->row.transpose();
  }
  return out;
}

}  // namespace tumble
