// SPDX-License-Identifier: BSD-3-Clause
#include "unit_rails.hpp"

#include <cstddef>

#include "saved_rails.hpp"

namespace tumble {

namespace {

// number of stored readings per sensor, enough for some seconds of readings near the largest readings
constexpr int kReadings = 512;
constexpr double kStatedMax_rad_s = 1000.0;  // maximum stated range that RailDetector uses

StreamingClippingFinder::Params clipping_finder_params(const ImuSheet& sheet) {
  StreamingClippingFinder::Params out;
  out.readings_max = kReadings;
  if (sheet.gyro_range_rad_s > 0.0 && sheet.gyro_range_rad_s <= kStatedMax_rad_s)
    out.clipping.axis_aligned_rails.stated_gyro_rad_s = sheet.gyro_range_rad_s;
  if (sheet.accel_range_m_s2 > 0.0) out.clipping.axis_aligned_rails.stated_accel_m_s2 = sheet.accel_range_m_s2;
  return out;
}

}  // namespace

UnitRails::UnitRails(std::span<const ImuSheet> sheets) {
  for (const ImuSheet& sheet : sheets)
    units_.push_back({StreamingClippingFinder(clipping_finder_params(sheet)), sheet});
}

void UnitRails::start_from(std::size_t unit, const SaturationLevels& rails) {
  StreamingClippingFinder::Params params = clipping_finder_params(units_[unit].sheet);
  odometry::start_from_rails(rails, params.clipping.axis_aligned_rails, params.clipping.planes,
                             params.clipping.accel_planes);
  units_[unit].watch = StreamingClippingFinder(params);
}

UnitRails::State UnitRails::start() const {
  State out;
  for (std::size_t k = 0; k < units_.size(); ++k) out[k].rails = units_[k].watch.start();
  return out;
}

void UnitRails::flag_clipped(std::span<const ImuSample> samples, const State& state, Samples& out) const {
  for (std::size_t k = 0; k < units_.size() && k < samples.size(); ++k) {
    out[k] = samples[k];
    if (!check_sample(samples[k]).ok()) continue;
    const StreamingClippingFinder::State& rails = state[k].rails;
    const Clipping judged = units_[k].watch.classify(state[k].before ? &*state[k].before : nullptr, samples[k], rails);
    const ConfirmedSaturation certain{.gyro = rails.known.planes_in_use(),
                                      .accel = rails.known.planes_in_use(Triad::accelerometer),
                                      .gyro_range_rad_s = units_[k].sheet.gyro_range_rad_s,
                                      .accel_range_m_s2 = units_[k].sheet.accel_range_m_s2};
    out[k].device_clip_flags = certain.flags(samples[k], judged);
  }
}

void UnitRails::observe(std::span<const ImuSample> samples, State& state) const {
  for (std::size_t k = 0; k < units_.size() && k < samples.size(); ++k) {
    if (!check_sample(samples[k]).ok()) continue;
    StreamingClippingFinder::State& rails = state[k].rails;
    units_[k].watch.observe(samples[k], rails);
    units_[k].watch.axis_aligned_rails().classify(samples[k], rails.known.axis_aligned_rails);
    state[k].before = samples[k];
  }
}

}  // namespace tumble
