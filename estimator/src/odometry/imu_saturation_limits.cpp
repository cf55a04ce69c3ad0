// SPDX-License-Identifier: BSD-3-Clause
#include "imu_saturation_limits.hpp"

#include <cstddef>

#include "saved_saturation_levels.hpp"

namespace tumble {

namespace {

// maximum number of stored readings per sensor; sufficient for some seconds of motion near the largest rate or force
constexpr std::size_t kReadings = 512;
constexpr double kStatedMax_rad_s = 1000.0;  // maximum stated range that SaturationLimitDetector uses

StreamingClippingFinder::Params clipping_finder_params(const ImuDataSheet& sheet) {
  StreamingClippingFinder::Params out;
  if (sheet.gyro_range_rad_s > 0.0 && sheet.gyro_range_rad_s <= kStatedMax_rad_s)
    out.clipping.axis_limit_params.stated_gyro_range_rad_s = sheet.gyro_range_rad_s;
  if (sheet.accel_range_m_s2 > 0.0) out.clipping.axis_limit_params.stated_accel_range_m_s2 = sheet.accel_range_m_s2;
  return out;
}

}  // namespace

ImuSaturationLimits::ImuSaturationLimits(std::span<const ImuDataSheet> sheets) {
  for (const ImuDataSheet& sheet : sheets)
    imus_.push_back({StreamingClippingFinder(clipping_finder_params(sheet), kReadings), sheet});
}

void ImuSaturationLimits::start_from_saturation_levels(std::size_t unit, const SaturationLevels& rails) {
  StreamingClippingFinder::Params params = clipping_finder_params(imus_[unit].data_sheet);
  odometry::start_from_saturation_levels(rails, params.clipping.axis_limit_params, params.clipping.gyro_planes,
                                         params.clipping.accel_saturation_planes);
  imus_[unit].clipping_finder = StreamingClippingFinder(params, kReadings);
}

ImuSaturationLimits::State ImuSaturationLimits::start() const {
  State out;
  for (std::size_t k = 0; k < imus_.size(); ++k) out[k].clipping_state = imus_[k].clipping_finder.start();
  return out;
}

void ImuSaturationLimits::flag_clipped(std::span<const ImuSample> samples, const State& state, Samples& out) const {
  for (std::size_t k = 0; k < imus_.size() && k < samples.size(); ++k) {
    out[k] = samples[k];
    if (!check_sample(samples[k]).ok()) continue;
    const StreamingClippingFinder::State& rails = state[k].clipping_state;
    const Clipping judged = imus_[k].clipping_finder.classify_clipping(
        state[k].previous_sample ? &*state[k].previous_sample : nullptr, samples[k], rails);
    const ConfirmedSaturation certain{.gyro = rails.known_limits.saturation_planes_in_use(),
                                      .accel = rails.known_limits.saturation_planes_in_use(Triad::accelerometer),
                                      .gyro_range_rad_s = imus_[k].data_sheet.gyro_range_rad_s,
                                      .accel_range_m_s2 = imus_[k].data_sheet.accel_range_m_s2};
    out[k].device_clip_flags = certain.flags(samples[k], judged);
  }
}

void ImuSaturationLimits::observe_readings(std::span<const ImuSample> samples, State& state) const {
  for (std::size_t k = 0; k < imus_.size() && k < samples.size(); ++k) {
    if (!check_sample(samples[k]).ok()) continue;
    StreamingClippingFinder::State& rails = state[k].clipping_state;
    imus_[k].clipping_finder.observe_reading(samples[k], rails);
    imus_[k].clipping_finder.axis_limit_detector().classify_clipping(samples[k], rails.known_limits.axis_limit_state);
    state[k].previous_sample = samples[k];
  }
}

}  // namespace tumble
