// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/clipping_finder.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

#include "element_clipping.hpp"
#include "sample_hold.hpp"
#include "tumble/angular_velocity/detail/rail_ratios.hpp"

namespace tumble {

RailPlanes SaturationLevels::planes_in_use(Triad triad) const {
  const RailPlanes& known = triad == Triad::gyro ? planes : accel_planes;
  return (triad == Triad::gyro ? gyro_clips_after_compensation : accel_clips_after_compensation)
             ? without_plateaus(known, axis_aligned_rails, triad)
             : known;
}

SensingDirections SaturationLevels::rows(Triad triad, double unknown_sigma) const {
  if (triad == Triad::gyro ? gyro_clips_after_compensation : accel_clips_after_compensation) return {};
  return sensing_directions(planes_in_use(triad), unknown_sigma);
}

ElementReading element_reading(const ImuSample& sample, const Clipping& clipping, Triad triad, int axis) {
  const std::uint8_t clipped = triad == Triad::gyro ? clipping.gyro : clipping.accel;
  if (triad == Triad::gyro && (clipping.unusable_gyro >> axis & 1u) != 0) return ElementReading::unreadable;
  if ((clipped >> axis & 1u) == 0) return ElementReading::measured;
  return reading_of(sample, triad)[axis] < 0.0 ? ElementReading::clipped_low : ElementReading::clipped_high;
}

std::uint8_t clip_flags(const Clipping& clipping) {
  constexpr int kAccelFirst = 3;
  return static_cast<std::uint8_t>(clipping.gyro | clipping.unusable_gyro | clipping.accel << kAccelFirst);
}

std::uint8_t ConfirmedSaturation::flags(const ImuSample& sample, const Clipping& judged) const {
  const auto certain = [](double reading, double range, const std::optional<RailPlane>& plane) {
    return range > 0.0 ? std::abs(reading) >= kStatedRailMin * range : plane.has_value();
  };
  const unsigned clipped = clip_flags(judged);
  unsigned out = sample.device_clip_flags;
  for (int axis = 0; axis < 3; ++axis) {
    const auto j = static_cast<std::size_t>(axis);
    const double rate = sample.angular_velocity_rad_s[axis], force = sample.specific_force_m_s2[axis];
    if (certain(rate, gyro_range_rad_s, gyro.element[j])) out |= clipped & static_cast<unsigned>(kClipGyroX << axis);
    if (certain(force, accel_range_m_s2, accel.element[j])) out |= clipped & static_cast<unsigned>(kClipAccelX << axis);
  }
  return static_cast<std::uint8_t>(out);
}

ClippingFinder::ClippingFinder(const Params& params)
    : axis_aligned_rails_(params.axis_aligned_rails), planes_(plane_finders(params)), tilted_(params.tilted) {}

RailPlanes ClippingFinder::find_planes(std::span<const ImuSample> samples, Triad triad,
                                       const RailDetector::State& axis_aligned_rails,
                                       bool& clips_after_compensation) const {
  std::vector<Eigen::Vector3d> readings(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) readings[k] = reading_of(samples[k], triad);
  RailPlaneFinder::Workspace workspace;
  const bool unstated = stated_range_contradicted(axis_aligned_rails_, axis_aligned_rails, triad);
  const RailPlanes planes = planes_[index_of(triad)][unstated ? 1 : 0].find(readings, {}, workspace);
  clips_after_compensation = are_upright(readings, planes, axis_aligned_rails, triad);
  return planes;
}

ClippingFinder::Found ClippingFinder::find(std::span<const ImuSample> samples) const {
  Found out;
  out.clippings.resize(samples.size());
  axis_aligned_rails_.classify_all(samples, out.rails.axis_aligned_rails, out.clippings);
  if (!tilted_) return out;
  out.rails.planes =
      find_planes(samples, Triad::gyro, out.rails.axis_aligned_rails, out.rails.gyro_clips_after_compensation);
  out.rails.accel_planes = find_planes(samples, Triad::accelerometer, out.rails.axis_aligned_rails,
                                       out.rails.accel_clips_after_compensation);
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    const RailPlanes planes = out.rails.planes_in_use(triad);
    if (!planes.any()) continue;
    const std::vector<Neighbours> beside = other_readings(samples, triad);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      out.clippings[k] =
          classify_by_planes(planes, triad, out.clippings[k], beside[k].before, samples[k], beside[k].after);
    }
  }
  return out;
}

}  // namespace tumble
