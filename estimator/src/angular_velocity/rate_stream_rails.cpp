// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "element_clipping.hpp"
#include "near_rails.hpp"
#include "possible_saturation.hpp"
#include "tumble/angular_velocity/detail/rail_ratios.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// At an unsaturated parabolic maximum, the slopes predict at most 2.25 times the measured difference between largest
// and smallest reading.
constexpr double kSlopeSigmasMax = 3.0, kHeightRatioMin = 4.0, kHeightNoiseSigmas = 5.0;
constexpr std::ptrdiff_t kPlateauReadingsMin = 3;

// maximum relative difference between two elements' saturation levels; the wand of the data set RepoIMU has 3 %
constexpr double kLevelDifferenceMax = 0.05;

bool is_near_other_rails(const RailPlanes& planes, double peak_rad_s) {
  return std::all_of(planes.element.begin(), planes.element.end(), [&](const auto& element) {
    return !element || peak_rad_s >= (1.0 - kLevelDifferenceMax) * element->distance_rad_s;
  });
}

// Returns nothing if `window` does not contain the previous reading.
std::optional<std::size_t> reading_before(std::size_t k, const std::vector<RateStream::Knot>& window) {
  while (k > 0 && window[k].repeats) --k;
  if (k == 0) return std::nullopt;
  --k;
  while (k > 0 && window[k].repeats) --k;
  return k;
}

std::size_t reading_after(std::size_t k, const std::vector<RateStream::Knot>& window) {
  const std::size_t size = window.size();
  if (k >= size) return size;
  ++k;
  while (k < size && window[k].repeats) ++k;
  return k;
}

struct Beside {
  const ImuSample *before = nullptr, *after = nullptr;
};

Beside neighbour_readings(std::size_t k, const RateStream::State& state) {
  const std::optional<std::size_t> before = reading_before(k, state.window);
  const std::size_t after = reading_after(k, state.window);
  Beside out;
  if (before) out.before = &state.window[*before].observation.sample;
  if (after < state.window.size()) out.after = &state.window[after].observation.sample;
  return out;
}

}  // namespace

void RateStream::reclassify_window(State& state) const {
  RailDetector::State& axis_aligned_rails = state.rails.known.axis_aligned_rails;
  for (RailDetector::Channel& channel : axis_aligned_rails.channels) channel.clipped = false;
  for (Knot& knot : state.window) {
    ImuSample sample = knot.observation.sample;
    sample.specific_force_m_s2 = knot.read.force_m_s2;
    sample.device_clip_flags =
        static_cast<std::uint8_t>((sample.device_clip_flags & kClipGyro) | knot.read.device_clip_flags);
    knot.by_axis_aligned_rails = rails_.axis_aligned_rails().classify(sample, axis_aligned_rails);
    knot.read.clipped = knot.by_axis_aligned_rails.accel;
  }
  for (std::size_t k = 0; force_shift(state) != 0 && k < state.window.size(); ++k) pair_force(k, state);
}

// A new reading may show whether the previous reading is clipped.
void RateStream::classify_from(std::size_t changed, State& state) const {
  const std::size_t first = reading_before(changed, state.window).value_or(0);
  const SaturationLevels& rails = state.rails.known;
  const RailPlanes planes = rails.planes_in_use(), accel_planes = rails.planes_in_use(Triad::accelerometer);
  const SensingDirections accel_rows = rails.rows(Triad::accelerometer, params_.model.element_sigma);
  const double noise = model_.gyro_sigma_rad_s();
  for (std::size_t k = first; k < state.window.size(); ++k) {
    Knot& knot = state.window[k];
    RateObservation& now = knot.observation;
    const Beside gyro = neighbour_readings(k, state);
    const ImuSample *const before = gyro.before, *const after = gyro.after;
    const ImuSample* const sample_before = k > 0 ? &state.window[k - 1].observation.sample : nullptr;
    const ImuSample* const sample_after =
        k + 1 < state.window.size() ? &state.window[k + 1].observation.sample : nullptr;
    const std::uint8_t read = now.unmeasured_axes();
    Clipping by_axis_aligned_rails = knot.by_axis_aligned_rails;
    if (sample_after != nullptr) {
      rails_.axis_aligned_rails().add_rising_edge(now.sample, *sample_after, state.window[k + 1].by_axis_aligned_rails,
                                                  rails.axis_aligned_rails, by_axis_aligned_rails);
    }
    now.clipping = classify_by_planes(planes, Triad::gyro, by_axis_aligned_rails, before, now.sample, after);
    now.clipping =
        classify_by_planes(accel_planes, Triad::accelerometer, now.clipping, sample_before, now.sample, sample_after);
    now.accel_rows = accel_rows;
    mark_subsample_saturation(planes, rails_.axis_aligned_rails(), rails.axis_aligned_rails, noise, before, now, after);
    knot.near = rails.gyro_clips_after_compensation ? std::uint8_t{0}
                                                    : possible_partial_saturation(before, now.sample, after, planes);
    mark_undetected_clipping(k, state);
    const bool newest = k + 1 == state.window.size();
    if (!newest && (now.unmeasured_axes() & ~read) == 0) continue;
    if (!newest) {
      knot.age = 0;
      knot.estimate.soft_bounds = false;
    }
    if (k > 0) guess(knot, state.window[k - 1], state);
  }
}

// See rate_stream.md (R93).
bool RateStream::may_clip(const ImuSample& sample, int axis, int sign, const State& state) const {
  const Vector3d& y = sample.angular_velocity_rad_s;
  const RailPlanes planes = state.rails.known.planes_in_use();
  const auto& plane = planes.element[static_cast<std::size_t>(axis)];
  if (sign * y[axis] <= 0.0) return false;
  if (plane && plane->seen(sign)) {
    const Eigen::Vector4d by(y[(axis + 1) % 3], y[(axis + 2) % 3], -sign, -1.0);
    const double open = std::sqrt(std::max(0.0, by.dot(plane->covariance * by)));
    return plane->margin_rad_s(y, sign) <= plane->tolerance_rad_s + kSlopeSigmasMax * open;
  }
  const double extreme = std::abs(state.extremes[sign > 0 ? 1 : 0][axis]);
  const bool high = extreme >= params_.expert.planes.distance_min_rad_s && is_near_other_rails(planes, extreme);
  return high && std::abs(y[axis]) >= (1.0 - kNearRailRatio) * extreme;
}

void RateStream::mark_undetected_clipping(std::size_t k, State& state) const {
  RateObservation& now = state.window[k].observation;
  now.isolated_high_axes = 0;
  if (state.rails.known.gyro_clips_after_compensation) return;
  const auto [before, after] = neighbour_readings(k, state);
  inflate_possible_saturation(state.rails.known.planes_in_use(), state.min_levels, model_.gyro_sigma_rad_s(), before,
                              now, after);
}

// A later, larger reading or a newly detected saturation level may show that suspect readings are unsaturated.
void RateStream::clear_suspects(State& state) const {
  for (std::size_t k = 0; k < state.window.size(); ++k) {
    if (state.window[k].observation.possibly_saturated_axes() == 0) continue;
    state.window[k].observation.suspect = 0;
    mark_undetected_clipping(k, state);
  }
}

// Marks runs of three or more unflagged readings that may be saturated.
void RateStream::mark_possible_saturation(State& state) const {
  const unsigned stood = state.window.front().observation.suspect;
  clear_suspects(state);
  for (int j = 0; j < 3; ++j) {
    if (rails_.axis_aligned_rails().rail(state.rails.known.axis_aligned_rails, j)) continue;
    for (std::size_t k = 0; k < state.window.size();) {
      const int sign = state.window[k].observation.sample.angular_velocity_rad_s[j] < 0.0 ? -1 : 1;
      std::size_t end = k;
      while (end < state.window.size() && may_clip(state.window[end].observation.sample, j, sign, state)) ++end;
      const bool goes_on = k == 0 && end > k && (stood >> j & 1u) != 0;
      const auto readings = std::count_if(state.window.begin() + static_cast<std::ptrdiff_t>(k),
                                          state.window.begin() + static_cast<std::ptrdiff_t>(end),
                                          [](const Knot& knot) { return !knot.repeats; });
      if (goes_on || readings >= kPlateauReadingsMin) mark_suspect_run(j, k, end - 1, state);
      k = std::max(end, k + 1);
    }
  }
}

// Returns the slope of the readings per sample at the ends of a run of possibly saturated readings. Each slope is the
// smaller of two consecutive rate changes, because an impact causes a single large change.
double RateStream::run_slope(int axis, std::size_t first, std::size_t last, const State& state) {
  const auto size = [&](std::size_t k) {
    return std::abs(state.window[k].observation.sample.angular_velocity_rad_s[axis]);
  };
  const double in =
      first > 0 ? state.window[first - 1].reading_growth_rad_s[axis] : state.slope_before_clipping_rad_s[axis];
  const std::size_t one = reading_after(last, state.window), two = reading_after(one, state.window),
                    three = reading_after(two, state.window);
  const bool left = three < state.window.size();
  const auto falls = [&](std::size_t a, std::size_t b) { return (size(a) - size(b)) / static_cast<double>(b - a); };
  const double out = left ? std::min(falls(one, two), falls(two, three)) : 0.0;
  return std::max({in, out, 0.0});
}

// Estimates the saturation deficit from the slopes before and after the suspect readings: rate_stream.md (R94).
void RateStream::mark_suspect_run(int axis, std::size_t first, std::size_t last, State& state) const {
  const auto size = [&](std::size_t k) {
    return std::abs(state.window[k].observation.sample.angular_velocity_rad_s[axis]);
  };
  const auto bit = static_cast<std::uint8_t>(1u << axis);
  double highest = 0.0, lowest = size(first);
  for (std::size_t k = first; k <= last; ++k) {
    highest = std::max(highest, size(k));
    lowest = std::min(lowest, size(k));
  }
  const double slope = run_slope(axis, first, last, state);
  const double samples = static_cast<double>(last - first + 1) + (first > 0 ? 0.0 : state.entry_samples[axis]);
  const double cut = 0.25 * samples * slope;
  const double noise = model_.gyro_sigma_rad_s();
  if (cut < kHeightRatioMin * (highest - lowest) || cut < kHeightNoiseSigmas * noise) return;
  for (std::size_t k = first; k <= last; ++k) {
    RateObservation& observation = state.window[k].observation;
    if (((observation.clipping.gyro | observation.clipping.unusable_gyro) & bit) != 0) continue;
    observation.isolated_high_axes = static_cast<std::uint8_t>(observation.isolated_high_axes & ~bit);
    observation.suspect = static_cast<std::uint8_t>(observation.suspect | bit);
    // The errors of all saturated readings of a run are correlated, so the run counts as one reading.
    observation.expected_deficit_sigma_rad_s[axis] = std::hypot(noise, std::sqrt(samples) * cut);
  }
}

// Returns the smaller of two consecutive increases of the gyro reading, because an impact causes one large increase.
Vector3d RateStream::reading_growth(const std::vector<Knot>& window) {
  const std::optional<std::size_t> one = reading_before(window.size() - 1, window);
  const std::optional<std::size_t> two = one ? reading_before(*one, window) : std::nullopt;
  if (!two) return Vector3d::Zero();
  const auto size = [&](std::size_t k) -> Vector3d {
    return window[k].observation.sample.angular_velocity_rad_s.cwiseAbs();
  };
  const std::size_t newest = reading_after(*one, window);
  const Vector3d now = (size(newest) - size(*one)) / static_cast<double>(newest - *one);
  const Vector3d before = (size(*one) - size(*two)) / static_cast<double>(*one - *two);
  return now.cwiseMin(before).cwiseMax(0.0);
}

// Stores the slope of the gyro readings before a saturation when these readings leave the window of RateStream.
void RateStream::store_slope_before_clipping(const Knot& leaving, const Knot& next, State& state) {
  const auto hidden = [](const Knot& knot, int j) {
    return ((knot.observation.clipping.gyro | knot.observation.partly_saturated_axes()) >> j & 1) != 0;
  };
  for (int j = 0; j < 3; ++j) {
    const bool goes_on = hidden(leaving, j) && hidden(next, j);
    state.entry_samples[j] = goes_on ? state.entry_samples[j] + 1.0 : 0.0;
    if (!goes_on) state.slope_before_clipping_rad_s[j] = hidden(next, j) ? leaving.reading_growth_rad_s[j] : 0.0;
  }
}

void RateStream::add_rails(const State& state, arrow::Corner& corner) const {
  const SaturationLevels& rails = state.rails.known;
  const RailPlanes planes = rails.planes_in_use();
  for (int j = 0; j < 3; ++j) {
    const Eigen::Index first = RigConstants::kElements + 2 * j;
    const auto prior_slopes = estimated_slopes(planes, rails.gyro_clips_after_compensation, j,
                                               model_.prior_covariance().block<2, 2>(first, first));
    if (!prior_slopes) continue;
    const Eigen::Matrix2d information = prior_slopes->covariance.inverse();
    corner.matrix.block<2, 2>(first, first) += information;
    corner.gradient.segment<2>(first) -= information * (state.rig.elements.segment<2>(2 * j) - prior_slopes->slopes);
  }
}

}  // namespace tumble
