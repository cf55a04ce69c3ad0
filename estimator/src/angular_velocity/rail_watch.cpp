// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rail_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "element_clipping.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// A reading this near the largest of its axis may be at a rail; which of them are kept; readings beside one that its
// stretch is judged by.
constexpr double kNearShare = 0.9, kKeepShare = 0.85;
constexpr std::size_t kBeside = 4;
// Readings kept whatever they are: the latest, and the first, which tell the noise.
constexpr std::size_t kLatest = 48;
// A new search after this share more of readings near the extremes, two at least.
constexpr std::size_t kMore = 8;
std::array<std::optional<double>, 6> rails_of(const RailDetector& walls, const RailDetector::State& state) {
  std::array<std::optional<double>, 6> out;
  for (int c = 0; c < 6; ++c) out[static_cast<std::size_t>(c)] = walls.rail(state, c);
  return out;
}

}  // namespace

RailWatch::RailWatch(const Params& params)
    : walls_(params.clipping.walls),
      planes_(stated_planes(params.clipping)),
      unstated_(unstated_planes(params.clipping)) {
  require_within("readings_max", params.readings_max, 64, 65536);
  readings_max_ = static_cast<std::size_t>(params.readings_max);
}

RailWatch::State RailWatch::start() const {
  State state;
  state.readings.reserve(readings_max_);
  state.work.reserve(readings_max_);
  state.known.planes = planes_.params().known;
  return state;
}

bool RailWatch::is_near(const Vector3d& reading, const State& state, double share) const {
  for (int j = 0; j < 3; ++j) {
    const double rate = std::abs(reading[j]);
    if (rate >= 0.5 * planes_.params().distance_min_rad_s && rate >= share * state.peak[j]) return true;
  }
  return false;
}

// Where there is no room the dull readings go, and where that makes too little the oldest.
void RailWatch::remember(const Vector3d& reading, State& state) const {
  std::vector<Vector3d>& readings = state.readings;
  if (readings.size() == readings_max_) {
    state.forgot = true;
    std::size_t kept = 0, looked = 0, near_until = 0;
    const std::size_t count = readings.size();
    for (std::size_t k = 0; k < count; ++k) {
      for (; looked < std::min(count, k + kBeside + 1); ++looked) {
        if (is_near(readings[looked], state, kKeepShare)) near_until = looked + kBeside + 1;
      }
      const bool keep = k < kLatest || k + kLatest >= count || k < near_until;
      if (keep) readings[kept++] = readings[k];
    }
    readings.resize(kept);
    const std::size_t most = readings_max_ - readings_max_ / 4;
    if (kept > most) readings.erase(readings.begin(), readings.begin() + static_cast<std::ptrdiff_t>(kept - most));
  }
  readings.push_back(reading);
  state.peak = state.peak.cwiseMax(reading.cwiseAbs());
}

RailPlanes RailWatch::search(State& state) const {
  const bool stated = !stated_range_contradicted(walls_, state.known.walls);
  RailPlanes found = (stated ? planes_ : unstated_).find(state.readings, state.known.planes, state.work);
  for (std::size_t j = 0; j < 3 && state.forgot; ++j) {
    const auto& before = state.known.planes.element[j];
    if (!found.element[j] && before && !before->contradicted_by(state.readings)) found.element[j] = before;
  }
  return found;
}

bool RailWatch::observe(const ImuSample& sample, State& state) const {
  const auto before = rails_of(walls_, state.known.walls);
  walls_.observe(sample, state.known.walls);
  bool changed = before != rails_of(walls_, state.known.walls);
  const Vector3d& reading = sample.angular_velocity_rad_s;
  if (!state.readings.empty() && state.readings.back() == reading) return changed;
  remember(reading, state);
  if (is_near(reading, state, kNearShare)) {
    ++state.near;
    ++state.unsearched;
    state.past = 0;
  } else {
    ++state.past;
  }
  const bool ended = state.past == kBeside - 1;
  if (state.unsearched == 0) return changed;
  if (!ended && state.unsearched < std::max<std::size_t>(2, state.near / kMore)) return changed;
  state.unsearched = 0;
  const RailPlanes planes = search(state);
  const bool upright = are_upright(state.readings, planes, state.known.walls);
  changed = changed || planes != state.known.planes || upright != state.known.upright;
  state.known.planes = planes;
  state.known.upright = upright;
  return changed;
}

bool RailWatch::equal(const State& a, const State& b) {
  return a.known == b.known && a.readings == b.readings && a.peak == b.peak && a.near == b.near &&
         a.unsearched == b.unsearched && a.past == b.past && a.forgot == b.forgot;
}

}  // namespace tumble
