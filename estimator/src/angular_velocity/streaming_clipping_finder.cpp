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
// The first readings of a run determine the gyro's noise.
constexpr std::size_t kLatestReadings = 48;
// The search for saturation repeats when the number of large readings has grown by the fraction 1 /
// kSearchGrowthDivisor.
constexpr std::size_t kSearchGrowthDivisor = 8;
// minimum reading of gyro and accelerometer near saturation, as a fraction of the smallest possible saturation level
constexpr double kLowReadingRatios[] = {0.5, 0.9};

std::array<std::optional<double>, 6> rails_of(const RailDetector& axis_aligned_rails,
                                              const RailDetector::State& state) {
  std::array<std::optional<double>, 6> out;
  for (int c = 0; c < 6; ++c) out[static_cast<std::size_t>(c)] = axis_aligned_rails.rail(state, c);
  return out;
}

}  // namespace

StreamingClippingFinder::StreamingClippingFinder(const Params& params)
    : axis_aligned_rails_(params.clipping.axis_aligned_rails), planes_(plane_finders(params.clipping)) {
  require_valid_fields(params);
  readings_max_ = static_cast<std::size_t>(params.readings_max);
}

StreamingClippingFinder::State StreamingClippingFinder::start() const {
  State state;
  for (Memory& memory : state.memory) memory.readings.reserve(readings_max_);
  state.work.reserve(readings_max_);
  state.known.axis_aligned_rails = axis_aligned_rails_.start();
  state.known.planes = planes_[index_of(Triad::gyro)][0].params().known;
  state.known.accel_planes = planes_[index_of(Triad::accelerometer)][0].params().known;
  return state;
}

bool StreamingClippingFinder::is_near(const Vector3d& reading, Triad triad, const Memory& memory, double share) const {
  const std::size_t i = index_of(triad);
  for (int j = 0; j < 3; ++j) {
    const double magnitude = std::abs(reading[j]);
    const bool high = magnitude >= kLowReadingRatios[i] * planes_[i][0].params().distance_min_rad_s;
    if (high && magnitude >= share * memory.peak[j]) return true;
  }
  return false;
}

// Above readings_max_ readings, those far from the largest readings are dropped first, then the oldest.
void StreamingClippingFinder::store(const Vector3d& reading, Triad triad, Memory& memory) const {
  std::vector<Vector3d>& readings = memory.readings;
  if (readings.size() == readings_max_) {
    memory.pruned = true;
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

RailPlanes StreamingClippingFinder::search(Triad triad, State& state) const {
  const Memory& memory = state.memory[index_of(triad)];
  const RailPlanes& known = triad == Triad::gyro ? state.known.planes : state.known.accel_planes;
  const bool unstated = stated_range_contradicted(axis_aligned_rails_, state.known.axis_aligned_rails, triad);
  RailPlanes found = planes_[index_of(triad)][unstated ? 1 : 0].find(memory.readings, known, state.work);
  for (std::size_t j = 0; j < 3 && memory.pruned; ++j) {
    const auto& before = known.element[j];
    if (!found.element[j] && before && !before->contradicted_by(memory.readings)) found.element[j] = before;
  }
  return found;
}

bool StreamingClippingFinder::observe(const Vector3d& reading, Triad triad, State& state) const {
  Memory& memory = state.memory[index_of(triad)];
  if (!memory.readings.empty() && memory.readings.back() == reading) return false;
  store(reading, triad, memory);
  if (is_near(reading, triad, memory, kNearExtremeRatio)) {
    ++memory.near;
    ++memory.unsearched_near_extremes;
    memory.samples_since_search = 0;
  } else {
    ++memory.samples_since_search;
  }
  const bool ended = memory.samples_since_search == kBeside - 1;
  if (memory.unsearched_near_extremes == 0) return false;
  if (!ended && memory.unsearched_near_extremes < std::max<std::size_t>(2, memory.near / kSearchGrowthDivisor))
    return false;
  memory.unsearched_near_extremes = 0;
  const RailPlanes planes = search(triad, state);
  const bool upright = are_upright(memory.readings, planes, state.known.axis_aligned_rails, triad);
  RailPlanes& known = triad == Triad::gyro ? state.known.planes : state.known.accel_planes;
  bool& known_upright =
      triad == Triad::gyro ? state.known.gyro_clips_after_compensation : state.known.accel_clips_after_compensation;
  const bool changed = planes != known || upright != known_upright;
  known = planes;
  known_upright = upright;
  return changed;
}

bool StreamingClippingFinder::observe(const ImuSample& sample, State& state) const {
  const auto before = rails_of(axis_aligned_rails_, state.known.axis_aligned_rails);
  axis_aligned_rails_.observe(sample, state.known.axis_aligned_rails);
  bool changed = before != rails_of(axis_aligned_rails_, state.known.axis_aligned_rails);
  for (const Triad triad : {Triad::gyro, Triad::accelerometer}) {
    if (observe(reading_of(sample, triad), triad, state)) changed = true;
  }
  return changed;
}

Clipping StreamingClippingFinder::classify(const ImuSample* before, const ImuSample& sample, const State& state,
                                           const ImuSample* after) const {
  RailDetector::State axis_aligned_rails = state.known.axis_aligned_rails;
  Clipping out = axis_aligned_rails_.classify(sample, axis_aligned_rails);
  if (after != nullptr)
    axis_aligned_rails_.add_rising_edge(sample, *after, axis_aligned_rails_.classify(*after, axis_aligned_rails),
                                        axis_aligned_rails, out);
  for (const Triad triad : {Triad::gyro, Triad::accelerometer})
    out = classify_by_planes(state.known.planes_in_use(triad), triad, out, before, sample, after);
  return out;
}

}  // namespace tumble
