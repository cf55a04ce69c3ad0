// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/common/status.hpp"

namespace tumble {

namespace {

constexpr int kPlateauSamples = 4;
// largest difference between the readings of a plateau (a run of equal readings), relative to the saturation limit
constexpr double kPlateauSpreadRatio = 2e-5;
// A plateau is a run of equal readings. A gyro plateau below kLowGyroPlateau_rad_s must have at least twice
// kPlateauSamples readings, and a jump of the readings at its start or end.
constexpr double kLowGyroPlateau_rad_s = 1.0;
constexpr double kGyroPlateauMin_rad_s = 0.02;
constexpr double kAccelPlateauMin_m_s2 = 15.0;  // greater than gravity, so that rest is no plateau
// minimum jump of the reading at the start or end of a gyro plateau below kLowGyroPlateau_rad_s, in steps of the
// sensor's resolution
constexpr double kJumpMinDigits = 8.0;
// A reading above (1 - kClipEnterRatio) times the saturation limit is clipped. Next to a clipped reading, a reading
// above (1 - kClipLeaveRatio) times the saturation limit is also clipped.
constexpr double kClipEnterRatio = 0.003, kClipLeaveRatio = 0.02;
constexpr double kRangeContradictionRatio = 0.02;  // minimum relative difference that contradicts the stated range

double reading(const ImuSample& sample, int c) {
  return c < 3 ? sample.angular_velocity_rad_s[c] : sample.specific_force_m_s2[c - 3];
}

void set_bit(std::uint8_t& bits, int j) {
  bits = static_cast<std::uint8_t>(bits | 1u << j);
}

}  // namespace

SaturationLimitDetector::SaturationLimitDetector(const Params& params) : params_(params) {
  if (params.stated_gyro_range_rad_s)
    require_in_interval("stated_gyro_rad_s", *params.stated_gyro_range_rad_s, 1e-6, 1000.0);
  if (params.stated_accel_range_m_s2)
    require_in_interval("stated_accel_m_s2", *params.stated_accel_range_m_s2, 1e-6, 1e5);
}

SaturationLimitDetector::State SaturationLimitDetector::start() const {
  State state;
  for (std::size_t c = 0; c < state.channels.size(); ++c) state.channels[c].plateau_limit = params_.known[c];
  return state;
}

std::optional<double> SaturationLimitDetector::stated_saturation_limit(int c) const {
  return c < 3 ? params_.stated_gyro_range_rad_s : params_.stated_accel_range_m_s2;
}

void SaturationLimitDetector::observe_reading(const ImuSample& sample, State& state) const {
  for (int c = 0; c < 6; ++c) {
    Channel& channel = state.channels[static_cast<std::size_t>(c)];
    const double value = reading(sample, c), magnitude = std::abs(value);
    const double spread = kPlateauSpreadRatio * magnitude;
    const double change = std::abs(value - channel.previous_reading);
    const bool continues = channel.run_length > 0 && std::abs(value - channel.plateau_first_reading) <= spread;
    if (channel.run_length > 0 && !continues) {
      if (channel.min_reading_change == 0.0 || change < channel.min_reading_change) channel.min_reading_change = change;
      if (magnitude < channel.peak && plateau(c, channel, change))
        channel.plateau_limit = std::abs(channel.plateau_first_reading);
    }
    channel.peak = std::max(channel.peak, magnitude);
    if (channel.plateau_limit > 0.0 && channel.peak > channel.plateau_limit * (1.0 + kRangeContradictionRatio))
      channel.plateau_limit = 0.0;
    if (!continues) {
      channel.entry_change = channel.run_length > 0 ? change : 0.0;
      channel.plateau_first_reading = value;
    }
    channel.run_length = continues ? channel.run_length + 1 : 1;
    channel.previous_reading = value;
    if (plateau(c, channel, channel.entry_change)) channel.plateau_limit = std::abs(channel.plateau_first_reading);
  }
}

bool SaturationLimitDetector::plateau(int c, const Channel& channel, double jump) const {
  const double magnitude = std::abs(channel.plateau_first_reading);
  if (magnitude < channel.peak * (1.0 - kRangeContradictionRatio)) return false;
  if (channel.run_length < kPlateauSamples) return false;
  if (c >= 3) return magnitude >= kAccelPlateauMin_m_s2;
  if (magnitude >= kLowGyroPlateau_rad_s) return true;
  return magnitude >= kGyroPlateauMin_rad_s && channel.run_length >= 2 * kPlateauSamples &&
         jump > kJumpMinDigits * channel.min_reading_change;
}

std::optional<double> SaturationLimitDetector::saturation_limit(const State& state, int c) const {
  const Channel& channel = state.channels[static_cast<std::size_t>(c)];
  if (channel.plateau_limit > 0.0) return channel.plateau_limit;
  const double below = channel.peak / (1.0 + kRangeContradictionRatio);
  double sibling = 0.0;
  for (int i = c / 3 * 3; i < c / 3 * 3 + 3; ++i) {
    sibling = std::max(sibling, state.channels[static_cast<std::size_t>(i)].plateau_limit);
  }
  if (sibling > 0.0 && sibling >= below) return sibling;
  const std::optional<double> given = stated_saturation_limit(c);
  if (given && *given >= below) return given;
  return std::nullopt;
}

bool SaturationLimitDetector::disagrees(const State& state, int c) const {
  const std::optional<double> given = stated_saturation_limit(c);
  if (!given) return false;
  const Channel& channel = state.channels[static_cast<std::size_t>(c)];
  if (channel.peak > *given * (1.0 + kRangeContradictionRatio)) return true;
  return channel.plateau_limit > 0.0 && channel.plateau_limit < *given * (1.0 - kRangeContradictionRatio);
}

Clipping SaturationLimitDetector::classify_clipping(const ImuSample& sample, State& state) const {
  Clipping out;
  for (int c = 0; c < 6; ++c) {
    Channel& channel = state.channels[static_cast<std::size_t>(c)];
    const double value = reading(sample, c);
    bool clipped = (sample.device_clip_flags >> c & 1u) != 0;
    bool flipped = false;
    if (const std::optional<double> level = saturation_limit(state, c)) {
      const double share = channel.is_clipped ? kClipLeaveRatio : kClipEnterRatio;
      clipped = clipped || std::abs(value) >= *level * (1.0 - share);
      // A change from the positive to the negative saturation level within one sample is a numeric overflow, not a
      // motion.
      flipped = c < 3 && channel.is_clipped && value * channel.last < 0.0 && std::abs(value) >= 0.9 * *level;
    }
    if (flipped) {
      set_bit(out.unusable_gyro, c);
      continue;  // `last` keeps the sign before the overflow
    }
    channel.is_clipped = clipped;
    channel.last = value;
    if (clipped) set_bit(c < 3 ? out.gyro : out.accel, c % 3);
  }
  return out;
}

void SaturationLimitDetector::classify_clipping_of_all(std::span<const ImuSample> samples, State& state,
                                                       std::span<Clipping> out) const {
  for (const ImuSample& sample : samples) observe_reading(sample, state);
  for (std::size_t k = 0; k < samples.size(); ++k) out[k] = classify_clipping(samples[k], state);
  for (std::size_t k = samples.size(); k-- > 1;)
    add_rising_edge_at_limit(samples[k - 1], samples[k], out[k], state, out[k - 1]);
}

void SaturationLimitDetector::add_rising_edge_at_limit(const ImuSample& sample, const ImuSample& next,
                                                       const Clipping& of_next, const State& state,
                                                       Clipping& clipping) const {
  for (int c = 0; c < 6; ++c) {
    const std::uint8_t after = c < 3 ? of_next.gyro : of_next.accel;
    if ((after >> (c % 3) & 1u) == 0) continue;
    const std::optional<double> level = saturation_limit(state, c);
    if (!level) continue;
    const double value = reading(sample, c);
    const bool near = std::abs(value) >= *level * (1.0 - kClipLeaveRatio) && value * reading(next, c) > 0.0;
    if (near) set_bit(c < 3 ? clipping.gyro : clipping.accel, c % 3);
  }
}

}  // namespace tumble
