// SPDX-License-Identifier: BSD-3-Clause
#include "lone_returns.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {

namespace {

// Of 10 deg against the beam: steeper is a surface (Bogoslavskyi, Stachniss).
constexpr float kSurfaceSine = 0.17365f;
// Of 2 deg: ground 0.5 m below is seen so at 14 m; less is an edge.
constexpr float kGrazingSine = 0.0349f;
constexpr float kBend = 0.15f;                     // of the way from before to after, in range: ground is not flat
constexpr int kNeighbours = 2;                     // to each side along the ring
constexpr float kReachSteps = kNeighbours + 0.5f;  // angular steps; beyond them lies no neighbour, there were misses
constexpr float kStepMax = 0.05f;                  // rad; rings of 16-channel lidars are 0.035 apart
constexpr float kDeviations = 3.0f;
// Of a sweep in clear air: thin things, edges and far ground are alone as well. Measured: 0.05 % at rest, 0.3 to 0.7 %
// in motion, 1.6 % where a thrown rig sees little of the ground.
constexpr float kClearShare = 0.02f;

float square(float x) {
  return x * x;
}

/// Squared sine of the angle between two beams; 1 from a right angle on.
float sine2_between(const SweepPoint& a, const SweepPoint& b) {
  if (a.x_L_m.dot(b.x_L_m) <= 0.0f) return 1.0f;
  return a.x_L_m.cross(b.x_L_m).squaredNorm() / (square(a.range_m) * square(b.range_m));
}

float variance_m2(const RangeNoise& noise, const SweepPoint& point) {
  return square(std::max(static_cast<float>(noise.sigma_m), static_cast<float>(noise.share) * point.range_m));
}

/// Whether two returns lie at one range: mapping.md (R56).
bool same_range(const RangeNoise& noise, const SweepPoint& a, const SweepPoint& b) {
  return square(a.range_m - b.range_m) <= square(kDeviations) * (variance_m2(noise, a) + variance_m2(noise, b));
}

/// Whether the line between two returns stands against the beam at this angle at least: mapping.md (R57).
bool stands(float sine, const SweepPoint& a, const SweepPoint& b) {
  const float farther = std::max(a.range_m, b.range_m);
  return a.x_L_m.cross(b.x_L_m).squaredNorm() >= square(sine * farther) * (a.x_L_m - b.x_L_m).squaredNorm();
}

/// Whether a return lies where its beam meets the line between one before and one after it: mapping.md (R58).
bool between(const RangeNoise& noise, const SweepPoint& before, const SweepPoint& point, const SweepPoint& after) {
  if (!stands(kGrazingSine, before, after)) return false;
  const float to_before = std::sqrt(sine2_between(before, point)), to_after = std::sqrt(sine2_between(point, after));
  const float share = to_before / std::max(to_before + to_after, 1e-9f);
  const float expected_m = 1.0f / ((1.0f - share) / before.range_m + share / after.range_m);
  const float variance = variance_m2(noise, point) + square(1.0f - share) * variance_m2(noise, before) +
                         square(share) * variance_m2(noise, after);
  const float bend_m = kBend * std::abs(before.range_m - after.range_m);
  return square(point.range_m - expected_m) <= std::max(square(kDeviations) * variance, square(bend_m));
}

/// The neighbours of a return along its ring: up to kNeighbours to each side.
struct Beside {
  std::array<const SweepPoint*, kNeighbours> before, after;
  int before_count = 0, after_count = 0;
};

bool is_borne_out(const RangeNoise& noise, const SweepPoint& point, const Beside& beside) {
  if (beside.before_count > 0 && stands(kSurfaceSine, point, *beside.before[0])) return true;
  if (beside.after_count > 0 && stands(kSurfaceSine, point, *beside.after[0])) return true;
  const auto at_its_range = [&](const SweepPoint* other) { return same_range(noise, point, *other); };
  const auto before_end = beside.before.begin() + beside.before_count;
  const auto after_end = beside.after.begin() + beside.after_count;
  if (std::any_of(beside.before.begin(), before_end, at_its_range)) return true;
  if (std::any_of(beside.after.begin(), after_end, at_its_range)) return true;
  return std::any_of(beside.before.begin(), before_end, [&](const SweepPoint* before) {
    return std::any_of(beside.after.begin(), after_end,
                       [&](const SweepPoint* after) { return between(noise, *before, point, *after); });
  });
}

}  // namespace

/// Indices of the points ring after ring, in order inside of each. Uses up the places where rings begin.
void LoneReturns::sort_by_ring(const std::vector<SweepPoint>& points) {
  ring_next_.assign(1, 0);
  for (const SweepPoint& point : points) {
    if (point.ring + 2u > ring_next_.size()) ring_next_.resize(point.ring + 2u, 0);
    ++ring_next_[point.ring + 1u];
  }
  for (std::size_t ring = 1; ring < ring_next_.size(); ++ring) ring_next_[ring] += ring_next_[ring - 1];
  order_.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) order_[ring_next_[points[i].ring]++] = i;
}

/// Of the squared sines between returns that follow each other on a ring; 1 where there are none.
float LoneReturns::median_step2(const std::vector<SweepPoint>& points) {
  steps2_.clear();
  for (std::size_t i = 1; i < order_.size(); ++i) {
    const SweepPoint &a = points[order_[i - 1]], &b = points[order_[i]];
    if (a.ring == b.ring) steps2_.push_back(sine2_between(a, b));
  }
  if (steps2_.empty()) return 1.0f;
  const auto middle = steps2_.begin() + static_cast<std::ptrdiff_t>(steps2_.size() / 2);
  std::nth_element(steps2_.begin(), middle, steps2_.end());
  return *middle;
}

std::size_t LoneReturns::drop(const RangeNoise& noise, std::vector<SweepPoint>& points) {
  if (points.size() < 3) return 0;
  sort_by_ring(points);
  const float step2 = median_step2(points);
  if (step2 > square(kStepMax)) return 0;
  const float reach2 = square(kReachSteps) * step2;
  alone_.assign(points.size(), 0);
  const auto collect = [&](std::size_t at, int direction, std::array<const SweepPoint*, kNeighbours>& found) {
    const SweepPoint& point = points[order_[at]];
    int count = 0;
    for (int step = 1; step <= kNeighbours; ++step) {
      const std::size_t other = at + static_cast<std::size_t>(direction * step);  // wraps below 0: beyond the end
      if (other >= order_.size() || points[order_[other]].ring != point.ring) break;
      const SweepPoint& neighbour = points[order_[other]];
      if (sine2_between(point, neighbour) > reach2) break;
      found[static_cast<std::size_t>(count++)] = &neighbour;
    }
    return count;
  };
  for (std::size_t at = 0; at < order_.size(); ++at) {
    Beside beside;
    beside.before_count = collect(at, -1, beside.before);
    beside.after_count = collect(at, 1, beside.after);
    alone_[order_[at]] = !is_borne_out(noise, points[order_[at]], beside);
  }
  const auto dropped = static_cast<std::size_t>(std::count(alone_.begin(), alone_.end(), 1));
  if (static_cast<float>(dropped) <= kClearShare * static_cast<float>(points.size())) return 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (alone_[i] == 0) points[kept++] = points[i];
  }
  points.resize(kept);
  return dropped;
}

}  // namespace tumble
