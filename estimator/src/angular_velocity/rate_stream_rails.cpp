// SPDX-License-Identifier: BSD-3-Clause
// How the window of a RateStream is read by the rails, as they become known.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "element_clipping.hpp"
#include "near_rails.hpp"
#include "tumble/angular_velocity/detail/rail_shares.hpp"
#include "tumble/angular_velocity/rate_stream.hpp"
#include "unseen_rails.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// Deviations of a plane. So many readings within kBesideRail of the largest of an axis may be at one rail, tilted as
// rails are. A round top of n readings is (n/(n - 1))^2 <= 2.25 times as high as what its readings show; one that is
// cut off more than kKink times, and more than so many deviations of the noise.
constexpr double kOpen = 3.0, kKink = 4.0, kPossibleNoise = 5.0;
constexpr std::ptrdiff_t kPossibleMin = 3;

// Elements' rails lie within this share of each other (3 % on the wand of RepoIMU).
constexpr double kApart = 0.05;

// Whether the largest reading of an element may be its rail, as far as those of the others tell.
bool may_be_rail(const RailPlanes& planes, double peak_rad_s) {
  return std::all_of(planes.element.begin(), planes.element.end(), [&](const auto& element) {
    return !element || peak_rad_s >= (1.0 - kApart) * element->distance_rad_s;
  });
}

// The sample that first says the reading before that of sample k; none where the window does not show it.
std::optional<std::size_t> reading_before(std::size_t k, const std::vector<RateStream::Knot>& window) {
  while (k > 0 && window[k].repeats) --k;
  if (k == 0) return std::nullopt;
  --k;
  while (k > 0 && window[k].repeats) --k;
  return k;
}

// The sample that says the reading after that of sample k first; the window's size where there is none yet.
std::size_t reading_after(std::size_t k, const std::vector<RateStream::Knot>& window) {
  const std::size_t size = window.size();
  if (k >= size) return size;
  ++k;
  while (k < size && window[k].repeats) ++k;
  return k;
}

// Samples whose gyro reads the reading before and after that of a sample, null where there is none.
struct Beside {
  const ImuSample *before = nullptr, *after = nullptr;
};

// Those of sample k by what the gyro says: a reading that is said again has the same neighbours.
Beside readings_beside(std::size_t k, const RateStream::State& state) {
  const std::optional<std::size_t> before = reading_before(k, state.window);
  const std::size_t after = reading_after(k, state.window);
  Beside out;
  if (before) out.before = &state.window[*before].observation.sample;
  if (after < state.window.size()) out.after = &state.window[after].observation.sample;
  return out;
}

}  // namespace

// What upright rails say of the window now that more is known of them.
void RateStream::classify_again(State& state) const {
  RailDetector::State& upright_rails = state.rails.known.upright_rails;
  for (RailDetector::Channel& channel : upright_rails.channels) channel.clipped = false;
  for (Knot& knot : state.window) {
    ImuSample sample = knot.observation.sample;
    sample.specific_force_m_s2 = knot.read.force_m_s2;
    sample.device_clip_flags =
        static_cast<std::uint8_t>((sample.device_clip_flags & kClipGyro) | knot.read.device_clip_flags);
    knot.by_upright_rails = rails_.upright_rails().classify(sample, upright_rails);
    knot.read.clipped = knot.by_upright_rails.accel;
  }
  for (std::size_t k = 0; force_shift(state) != 0 && k < state.window.size(); ++k) pair_force(k, state);
}

// Reads samples of the window with the rails as they are known: from one that has changed on, with those that say the
// reading before, which are judged by what lies beside them too. One that turns out to be clipped starts anew.
void RateStream::judge_from(std::size_t changed, State& state) const {
  const std::size_t first = reading_before(changed, state.window).value_or(0);
  const KnownRails& rails = state.rails.known;
  const RailPlanes planes = rails.planes_in_use(), accel_planes = rails.planes_in_use(Triad::accelerometer);
  const ElementRows accel_rows = rails.rows(Triad::accelerometer, params_.model.element_sigma);
  const double noise = model_.gyro_sigma_rad_s();
  for (std::size_t k = first; k < state.window.size(); ++k) {
    Knot& knot = state.window[k];
    RateObservation& now = knot.observation;
    const Beside gyro = readings_beside(k, state);
    const ImuSample *const before = gyro.before, *const after = gyro.after;
    const ImuSample* const sample_before = k > 0 ? &state.window[k - 1].observation.sample : nullptr;
    const ImuSample* const sample_after =
        k + 1 < state.window.size() ? &state.window[k + 1].observation.sample : nullptr;
    const std::uint8_t read = now.unseen();
    Clipping by_upright_rails = knot.by_upright_rails;
    if (sample_after != nullptr) {
      rails_.upright_rails().add_edge(now.sample, *sample_after, state.window[k + 1].by_upright_rails,
                                      rails.upright_rails, by_upright_rails);
    }
    now.clipping = clip_by_planes(planes, Triad::gyro, by_upright_rails, before, now.sample, after);
    now.clipping =
        clip_by_planes(accel_planes, Triad::accelerometer, now.clipping, sample_before, now.sample, sample_after);
    now.accel_rows = accel_rows;
    mark_subsample_saturation(planes, rails_.upright_rails(), rails.upright_rails, noise, before, now, after);
    knot.near = rails.upright ? std::uint8_t{0} : may_meet_rails(before, now.sample, after, planes);
    doubt_unseen(k, state);
    const bool newest = k + 1 == state.window.size();
    if (!newest && (now.unseen() & ~read) == 0) continue;
    if (!newest) {
      knot.age = 0;
      knot.estimate.soft_bounds = false;
    }
    if (k > 0) guess(knot, state.window[k - 1], state);
  }
}

// Whether a reading may stand at a rail: at one that is hardly known yet, as far as its slopes are open, or, where none
// was seen, at the largest reading so far, which is about the rail of the other elements. rate_stream.md (R94)
bool RateStream::may_clip(const ImuSample& sample, int axis, int sign, const State& state) const {
  const Vector3d& y = sample.angular_velocity_rad_s;
  const RailPlanes planes = state.rails.known.planes_in_use();
  const auto& plane = planes.element[static_cast<std::size_t>(axis)];
  if (sign * y[axis] <= 0.0) return false;
  if (plane && plane->seen(sign)) {
    const Eigen::Vector4d by(y[(axis + 1) % 3], y[(axis + 2) % 3], -sign, -1.0);
    const double open = std::sqrt(std::max(0.0, by.dot(plane->covariance * by)));
    return plane->short_of(y, sign) <= plane->tolerance_rad_s + kOpen * open;
  }
  const double extreme = std::abs(state.extremes[sign > 0 ? 1 : 0][axis]);
  const bool high = extreme >= params_.expert.planes.distance_min_rad_s && may_be_rail(planes, extreme);
  return high && std::abs(y[axis]) >= (1.0 - kBesideRail) * extreme;
}

// What a sample of the window may hide by itself, at a rail near those of the other elements.
void RateStream::doubt_unseen(std::size_t k, State& state) const {
  RateObservation& now = state.window[k].observation;
  now.lone = 0;
  if (state.rails.known.upright) return;
  const auto [before, after] = readings_beside(k, state);
  doubt_unseen_rails(state.rails.known.planes_in_use(), state.least, model_.gyro_sigma_rad_s(), before, now, after);
}

// Takes back the doubts in the window that are refuted by now: by a larger reading, or by a rail that is seen
// elsewhere.
void RateStream::forget_doubts(State& state) const {
  for (std::size_t k = 0; k < state.window.size(); ++k) {
    if (state.window[k].observation.may_hide() == 0) continue;
    state.window[k].observation.doubted = 0;
    doubt_unseen(k, state);
  }
}

// Doubts readings that may clip and that nothing says do: three and more in a row. Anew with each sample.
void RateStream::doubt_possible_rails(State& state) const {
  const unsigned stood = state.window.front().observation.doubted;
  forget_doubts(state);
  for (int j = 0; j < 3; ++j) {
    if (rails_.upright_rails().rail(state.rails.known.upright_rails, j)) continue;
    for (std::size_t k = 0; k < state.window.size();) {
      const int sign = state.window[k].observation.sample.angular_velocity_rad_s[j] < 0.0 ? -1 : 1;
      std::size_t end = k;
      while (end < state.window.size() && may_clip(state.window[end].observation.sample, j, sign, state)) ++end;
      // what is left of a run that was doubted when it was whole
      const bool goes_on = k == 0 && end > k && (stood >> j & 1u) != 0;
      const auto readings = std::count_if(state.window.begin() + static_cast<std::ptrdiff_t>(k),
                                          state.window.begin() + static_cast<std::ptrdiff_t>(end),
                                          [](const Knot& knot) { return !knot.repeats; });
      if (goes_on || readings >= kPossibleMin) doubt_run(j, k, end - 1, state);
      k = std::max(end, k + 1);
    }
  }
}

// The larger of the slopes with which the motion came to a run and left it, per sample; of each the lesser of two
// steps: an impact is one.
double RateStream::run_slope(int axis, std::size_t first, std::size_t last, const State& state) {
  const auto size = [&](std::size_t k) {
    return std::abs(state.window[k].observation.sample.angular_velocity_rad_s[axis]);
  };
  const double in = first > 0 ? state.window[first - 1].approach_rad_s[axis] : state.entry_rad_s[axis];
  const std::size_t one = reading_after(last, state.window), two = reading_after(one, state.window),
                    three = reading_after(two, state.window);
  const bool left = three < state.window.size();
  const auto falls = [&](std::size_t a, std::size_t b) { return (size(a) - size(b)) / static_cast<double>(b - a); };
  const double out = left ? std::min(falls(one, two), falls(two, three)) : 0.0;
  return std::max({in, out, 0.0});
}

// One such run: a smooth motion that is cut off there would have gone on with the slopes at its ends. (R95)
void RateStream::doubt_run(int axis, std::size_t first, std::size_t last, State& state) const {
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
  if (cut < kKink * (highest - lowest) || cut < kPossibleNoise * noise) return;
  for (std::size_t k = first; k <= last; ++k) {
    RateObservation& observation = state.window[k].observation;
    if (((observation.clipping.gyro | observation.clipping.missing_gyro) & bit) != 0) continue;
    observation.lone = static_cast<std::uint8_t>(observation.lone & ~bit);
    observation.doubted = static_cast<std::uint8_t>(observation.doubted | bit);
    // all of the run are cut off together: what they say is one reading's word
    observation.lost_sigma_rad_s[axis] = std::hypot(noise, std::sqrt(samples) * cut);
  }
}

// Of the newest sample. Two steps: an impact is one, and a spin that it leaves behind is no rail. Per sample of the
// log.
Vector3d RateStream::approach(const std::vector<Knot>& window) {
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

// Of a run that goes on in the window after its first reading has left.
void RateStream::remember_entry(const Knot& leaving, const Knot& next, State& state) {
  const auto hidden = [](const Knot& knot, int j) {
    return ((knot.observation.clipping.gyro | knot.observation.read_in_part()) >> j & 1) != 0;
  };
  for (int j = 0; j < 3; ++j) {
    const bool goes_on = hidden(leaving, j) && hidden(next, j);
    state.entry_samples[j] = goes_on ? state.entry_samples[j] + 1.0 : 0.0;
    if (!goes_on) state.entry_rad_s[j] = hidden(next, j) ? leaving.approach_rad_s[j] : 0.0;
  }
}

// What the rails tell of the elements that clip at them: anew with each step, since they become known better.
void RateStream::add_rails(const State& state, arrow::Corner& corner) const {
  const KnownRails& rails = state.rails.known;
  const RailPlanes planes = rails.planes_in_use();
  for (int j = 0; j < 3; ++j) {
    const Eigen::Index first = RigConstants::kElements + 2 * j;
    const auto told = told_slopes(planes, rails.upright, j, model_.prior_covariance().block<2, 2>(first, first));
    if (!told) continue;
    const Eigen::Matrix2d information = told->covariance.inverse();
    corner.matrix.block<2, 2>(first, first) += information;
    corner.gradient.segment<2>(first) -= information * (state.rig.elements.segment<2>(2 * j) - told->slopes);
  }
}

}  // namespace tumble
