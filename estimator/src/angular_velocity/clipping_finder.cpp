// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/clipping_finder.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

#include "element_clipping.hpp"
#include "sample_hold.hpp"
#include "tumble/angular_velocity/detail/rail_ratios.hpp"

namespace tumble {

SaturationPlanes SaturationLevels::saturation_planes_in_use(Triad triad) const {
  const SaturationPlanes& known = triad == Triad::gyro ? gyro_planes : accel_saturation_planes;
  return (triad == Triad::gyro ? gyro_clips_after_compensation : accel_clips_after_compensation)
             ? without_planes_from_plateaus(known, axis_limit_state, triad)
             : known;
}

SensingDirections SaturationLevels::rows(Triad triad, double unknown_sigma) const {
  if (triad == Triad::gyro ? gyro_clips_after_compensation : accel_clips_after_compensation) return {};
  return sensing_directions(saturation_planes_in_use(triad), unknown_sigma);
}

SensingAxisReading sensing_axis_reading(const ImuSample& sample, const Clipping& clipping, Triad triad, int axis) {
  const std::uint8_t clipped = triad == Triad::gyro ? clipping.gyro : clipping.accel;
  if (triad == Triad::gyro && (clipping.unusable_gyro >> axis & 1u) != 0) return SensingAxisReading::invalid_reading;
  if ((clipped >> axis & 1u) == 0) return SensingAxisReading::not_clipped;
  return triad_reading_of(sample, triad)[axis] < 0.0 ? SensingAxisReading::clipped_low
                                                     : SensingAxisReading::clipped_high;
}

std::uint8_t clip_flags(const Clipping& clipping) {
  constexpr int kAccelFirst = 3;
  return static_cast<std::uint8_t>(clipping.gyro | clipping.unusable_gyro | clipping.accel << kAccelFirst);
}

std::uint8_t ConfirmedSaturation::flags(const ImuSample& sample, const Clipping& judged) const {
  const auto certain = [](double reading, double range, const std::optional<SaturationPlane>& plane) {
    return range > 0.0 ? std::abs(reading) >= kStatedRailMin * range : plane.has_value();
  };
  const unsigned clipped = clip_flags(judged);
  unsigned out = sample.device_clip_flags;
  for (int axis = 0; axis < 3; ++axis) {
    const auto j = static_cast<std::size_t>(axis);
    const double rate = sample.angular_velocity_rad_s[axis], force = sample.specific_force_m_s2[axis];
    if (certain(rate, gyro_range_rad_s, gyro.sensing_axis[j]))
      out |= clipped & static_cast<unsigned>(kClipGyroX << axis);
    if (certain(force, accel_range_m_s2, accel.sensing_axis[j]))
      out |= clipped & static_cast<unsigned>(kClipAccelX << axis);
  }
  return static_cast<std::uint8_t>(out);
}

ClippingFinder::ClippingFinder(const Params& params, bool use_tilted_planes)
    : axis_limit_detector_(params.axis_limit_params),
      plane_finders_(make_plane_finders(params)),
      use_tilted_planes_(use_tilted_planes) {}

SaturationPlanes ClippingFinder::find_planes(std::span<const ImuSample> samples, Triad triad,
                                             const SaturationLimitDetector::State& axis_aligned_rails,
                                             bool& clips_after_compensation) const {
  std::vector<Eigen::Vector3d> readings(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) readings[k] = triad_reading_of(samples[k], triad);
  SaturationPlaneFinder::Workspace workspace;
  const bool unstated = stated_range_contradicted(axis_limit_detector_, axis_aligned_rails, triad);
  const SaturationPlanes planes = plane_finders_[index_of(triad)][unstated ? 1 : 0].find(readings, {}, workspace);
  clips_after_compensation = are_upright(readings, planes, axis_aligned_rails, triad);
  return planes;
}

ClippingFinder::ClippingSearchResult ClippingFinder::find(std::span<const ImuSample> samples) const {
  ClippingSearchResult out;
  out.clipping_per_sample.resize(samples.size());
  axis_limit_detector_.classify_clipping_of_all(samples, out.saturation_levels.axis_limit_state,
                                                out.clipping_per_sample);
  if (!use_tilted_planes_) return out;
  out.saturation_levels.gyro_planes = find_planes(samples, Triad::gyro, out.saturation_levels.axis_limit_state,
                                                  out.saturation_levels.gyro_clips_after_compensation);
  out.saturation_levels.accel_saturation_planes =
      find_planes(samples, Triad::accelerometer, out.saturation_levels.axis_limit_state,
                  out.saturation_levels.accel_clips_after_compensation);
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    const SaturationPlanes planes = out.saturation_levels.saturation_planes_in_use(triad);
    if (!planes.any_plane_found()) continue;
    const std::vector<Neighbours> beside = neighbouring_readings(samples, triad);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      out.clipping_per_sample[k] = clipping_from_planes(planes, triad, out.clipping_per_sample[k],
                                                        beside[k].previous_sample, samples[k], beside[k].next_sample);
    }
  }
  return out;
}

}  // namespace tumble
