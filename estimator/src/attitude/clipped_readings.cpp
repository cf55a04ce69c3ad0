// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/clipped_readings.hpp"

#include <cstddef>
#include <optional>

#include "../angular_velocity/near_saturation_limits.hpp"

namespace tumble {

void ClippedReadings::mark_suspected_saturation(std::span<const ImuSample> samples,
                                                std::span<const std::uint8_t> axes) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      std::int8_t& sign = clip_signs[k].gyro[static_cast<std::size_t>(j)];
      if ((axes[k] >> j & 1u) != 0 && sign == 0) sign = samples[k].angular_velocity_rad_s[j] < 0.0 ? -1 : 1;
    }
  }
}

void ClippedReadings::mark_partly_saturated(std::span<AngularRateState> rates) const {
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (possibly_clipped_axes[k] != 0 && rates[k].source == AngularRateSource::measured)
      rates[k].source = AngularRateSource::lower_bound_only;
  }
}

ClippedReadings clipped_readings_of(std::span<const ImuSample> samples,
                                    const ClippingFinder::ClippingSearchResult& found) {
  ClippedReadings out;
  out.clip_signs.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k)
    out.clip_signs[k] = clip_signs(samples[k], found.clipping_per_sample[k]);
  out.possibly_clipped_axes =
      possible_partial_saturation(samples, found.saturation_levels.gyro_clips_after_compensation
                                               ? SaturationPlanes{}
                                               : found.saturation_levels.saturation_planes_in_use());
  for (int j = 0; j < 3; ++j) {
    const std::optional<SaturationPlane>& plane =
        found.saturation_levels.gyro_planes.sensing_axis[static_cast<std::size_t>(j)];
    if (plane) out.sensing_directions.row(j) = plane->row.transpose();
  }
  return out;
}

}  // namespace tumble
