// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/clipping_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include "possible_saturation.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"
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

using Eigen::Vector3d;

constexpr double kNearExtremeRatio = 0.9, kStoreRatio = 0.85;
constexpr std::size_t kBeside = 4;
// The buffer keeps the first readings of a run, because the first readings determine the gyro's noise, and the latest
// kLatestReadings readings.
constexpr std::size_t kLatestReadings = 48;
// The search for saturation repeats when the number of large readings has grown by the fraction 1 /
// kSearchGrowthDivisor.
constexpr std::size_t kSearchGrowthDivisor = 8;
// A reading counts as near saturation if the reading exceeds a fraction of the smallest possible saturation level.
// kLowReadingRatios contains one fraction for the gyro and one for the accelerometer.
constexpr double kLowReadingRatios[] = {0.5, 0.9};

std::array<std::optional<double>, 6> saturation_limits_of(const SaturationLimitDetector& axis_aligned_rails,
                                                          const SaturationLimitDetector::State& state) {
  std::array<std::optional<double>, 6> out;
  for (int c = 0; c < 6; ++c) out[static_cast<std::size_t>(c)] = axis_aligned_rails.saturation_limit(state, c);
  return out;
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

StreamingClippingFinder::StreamingClippingFinder(const Params& params, std::size_t readings_max)
    : axis_limit_detector_(params.axis_limit_params),
      plane_finders_(make_plane_finders(params)),
      readings_max_(readings_max) {
  require_valid_fields(params);
}

StreamingClippingFinder::State StreamingClippingFinder::start() const {
  State state;
  for (DistinctReadingMemory& memory : state.distinct_readings) memory.readings.reserve(readings_max_);
  state.search_workspace.reserve(readings_max_);
  state.known_limits.axis_limit_state = axis_limit_detector_.start();
  state.known_limits.gyro_planes = plane_finders_[index_of(Triad::gyro)][0].params().known_limits;
  state.known_limits.accel_saturation_planes = plane_finders_[index_of(Triad::accelerometer)][0].params().known_limits;
  return state;
}

bool StreamingClippingFinder::is_near(const Vector3d& reading, Triad triad, const DistinctReadingMemory& memory,
                                      double share) const {
  const std::size_t i = index_of(triad);
  for (int j = 0; j < 3; ++j) {
    const double magnitude = std::abs(reading[j]);
    const bool high = magnitude >= kLowReadingRatios[i] * plane_finders_[i][0].params().distance_min_rad_s;
    if (high && magnitude >= share * memory.peak[j]) return true;
  }
  return false;
}

// If readings_max_ readings are stored, the function deletes readings far from the largest readings first, and then the
// oldest readings.
void StreamingClippingFinder::store_distinct_reading(const Vector3d& reading, Triad triad,
                                                     DistinctReadingMemory& memory) const {
  std::vector<Vector3d>& readings = memory.readings;
  if (readings.size() == readings_max_) {
    memory.readings_pruned = true;
    std::size_t kept = 0, looked = 0, near_until = 0;
    const std::size_t count = readings.size();
    for (std::size_t k = 0; k < count; ++k) {
      for (; looked < std::min(count, k + kBeside + 1); ++looked) {
        if (is_near(readings[looked], triad, memory, kStoreRatio)) near_until = looked + kBeside + 1;
      }
      const bool keep = k < kLatestReadings || k + kLatestReadings >= count || k < near_until;
      if (keep) readings[kept++] = readings[k];
    }
    readings.resize(kept);
    const std::size_t most = readings_max_ - readings_max_ / 4;
    if (kept > most) {
      const auto oldest = readings.begin() + static_cast<std::ptrdiff_t>(std::min(kLatestReadings, most / 4));
      readings.erase(oldest, oldest + static_cast<std::ptrdiff_t>(kept - most));
    }
  }
  readings.push_back(reading);
  memory.peak = memory.peak.cwiseMax(reading.cwiseAbs());
}

SaturationPlanes StreamingClippingFinder::search_saturation_planes(Triad triad, State& state) const {
  const DistinctReadingMemory& memory = state.distinct_readings[index_of(triad)];
  const SaturationPlanes& known =
      triad == Triad::gyro ? state.known_limits.gyro_planes : state.known_limits.accel_saturation_planes;
  const bool unstated = stated_range_contradicted(axis_limit_detector_, state.known_limits.axis_limit_state, triad);
  SaturationPlanes found =
      plane_finders_[index_of(triad)][unstated ? 1 : 0].find(memory.readings, known, state.search_workspace);
  for (std::size_t j = 0; j < 3 && memory.readings_pruned; ++j) {
    const auto& before = known.sensing_axis[j];
    if (!found.sensing_axis[j] && before && !before->is_contradicted_by_readings(memory.readings))
      found.sensing_axis[j] = before;
  }
  return found;
}

bool StreamingClippingFinder::observe_reading(const Vector3d& reading, Triad triad, State& state) const {
  DistinctReadingMemory& memory = state.distinct_readings[index_of(triad)];
  if (!memory.readings.empty() && memory.readings.back() == reading) return false;
  store_distinct_reading(reading, triad, memory);
  if (is_near(reading, triad, memory, kNearExtremeRatio)) {
    ++memory.near_limit_count;
    ++memory.near_limit_since_search;
    memory.samples_since_search = 0;
  } else {
    ++memory.samples_since_search;
  }
  const bool ended = memory.samples_since_search == kBeside - 1;
  if (memory.near_limit_since_search == 0) return false;
  if (!ended &&
      memory.near_limit_since_search < std::max<std::size_t>(2, memory.near_limit_count / kSearchGrowthDivisor))
    return false;
  memory.near_limit_since_search = 0;
  const SaturationPlanes planes = search_saturation_planes(triad, state);
  const bool upright = are_upright(memory.readings, planes, state.known_limits.axis_limit_state, triad);
  SaturationPlanes& known =
      triad == Triad::gyro ? state.known_limits.gyro_planes : state.known_limits.accel_saturation_planes;
  bool& known_upright = triad == Triad::gyro ? state.known_limits.gyro_clips_after_compensation
                                             : state.known_limits.accel_clips_after_compensation;
  const bool changed = planes != known || upright != known_upright;
  known = planes;
  known_upright = upright;
  return changed;
}

bool StreamingClippingFinder::observe_reading(const ImuSample& sample, State& state) const {
  const auto before = saturation_limits_of(axis_limit_detector_, state.known_limits.axis_limit_state);
  axis_limit_detector_.observe_reading(sample, state.known_limits.axis_limit_state);
  bool changed = before != saturation_limits_of(axis_limit_detector_, state.known_limits.axis_limit_state);
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    if (observe_reading(triad_reading_of(sample, triad), triad, state)) changed = true;
  }
  return changed;
}

Clipping StreamingClippingFinder::classify_clipping(const ImuSample* before, const ImuSample& sample,
                                                    const State& state, const ImuSample* after) const {
  SaturationLimitDetector::State axis_aligned_rails = state.known_limits.axis_limit_state;
  Clipping out = axis_limit_detector_.classify_clipping(sample, axis_aligned_rails);
  if (after != nullptr)
    axis_limit_detector_.add_rising_edge_at_limit(
        sample, *after, axis_limit_detector_.classify_clipping(*after, axis_aligned_rails), axis_aligned_rails, out);
  for (const Triad triad : {Triad::gyro, Triad::accelerometer})
    out = clipping_from_planes(state.known_limits.saturation_planes_in_use(triad), triad, out, before, sample, after);
  return out;
}

}  // namespace tumble
