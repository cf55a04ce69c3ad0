// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "element_clipping.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

namespace {

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

StreamingClippingFinder::StreamingClippingFinder(const Params& params, std::size_t readings_max)
    : axis_limit_detector_(params.clipping.axis_limit_params),
      plane_finders_(make_plane_finders(params.clipping)),
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
