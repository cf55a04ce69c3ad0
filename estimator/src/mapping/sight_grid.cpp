// SPDX-License-Identifier: BSD-3-Clause
#include "sight_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble::mapping {

namespace {

// FreeSpaceGrid computes the direction of each lidar return from one sensor position, although the sensor moves during
// the sweep. If the range exceeds ten times the distance that the sensor moves, the direction error is below 0.1 rad,
// about three bins.
constexpr float kMinRangePerMotion = 10.0f;
constexpr int kEmptyBinsMax = 4;  // maximum number of empty bins out of nine; rings may be further apart than bins
// kBeyond_m and kBeyondRatio define a tolerance of the range. The tolerance of the range covers the relative pose error
// of two sweeps, range noise, and sloped ground within a bin.
constexpr float kBeyond_m = 0.3f, kBeyondRatio = 0.03f;
constexpr float kDeviations = 3.0f;

}  // namespace

void FreeSpaceGrid::start(const Eigen::Vector3f& from_W_m, float moved_m) {
  origin_W_m_ = from_W_m;
  range_min_m_ = kMinRangePerMotion * moved_m;
  nearest_return_m_.assign(std::size_t{6} * kBins * kBins, std::numeric_limits<float>::infinity());
}

std::optional<FreeSpaceGrid::Direction> FreeSpaceGrid::direction(const Eigen::Vector3f& lever_m) {
  Eigen::Index axis = 0;
  const float along = lever_m.cwiseAbs().maxCoeff(&axis);
  if (!(along > 0.0f) || !std::isfinite(along)) return std::nullopt;
  const auto bin = [&](Eigen::Index across) {
    const float share = 0.5f * (lever_m[(axis + across) % 3] / along + 1.0f);
    return std::min(static_cast<int>(share * kBins), kBins - 1);
  };
  return Direction{2 * static_cast<int>(axis) + (lever_m[axis] < 0.0f ? 1 : 0), bin(1), bin(2)};
}

void FreeSpaceGrid::add(const Eigen::Vector3f& return_W_m) {
  const Eigen::Vector3f lever_m = return_W_m - origin_W_m_;
  const std::optional<Direction> towards = direction(lever_m);
  if (!towards) return;
  float& nearest_m = nearest_return_m_[towards->direction_bin_index()];
  nearest_m = std::min(nearest_m, lever_m.norm());
}

/// Returns the smallest range of the returns in and around a direction, or 0 if the range is unknown.
float FreeSpaceGrid::free_space_range_m(const Direction& towards) const {
  float nearest_m = std::numeric_limits<float>::infinity();
  int empty = 0;
  for (int v = towards.row - 1; v <= towards.row + 1; ++v) {
    for (int u = towards.column - 1; u <= towards.column + 1; ++u) {
      if (u < 0 || v < 0 || u >= kBins || v >= kBins) return 0.0f;
      const float beside_m = nearest_return_m_[Direction{towards.cube_face, u, v}.direction_bin_index()];
      if (std::isfinite(beside_m)) {
        nearest_m = std::min(nearest_m, beside_m);
      } else if (++empty > kEmptyBinsMax) {
        return 0.0f;
      }
    }
  }
  return nearest_m;
}

/// See mapping.md (R65).
FreeSpaceGrid::Verdict FreeSpaceGrid::verdict(const Eigen::Vector3f& point_W_m, float sigma_m) const {
  const Eigen::Vector3f lever_m = point_W_m - origin_W_m_;
  const float range_m = lever_m.norm();
  if (!(range_m > range_min_m_)) return Verdict::unknown_space;
  const std::optional<Direction> towards = direction(lever_m);
  if (!towards) return Verdict::unknown_space;
  const float beyond_m = kBeyond_m + kBeyondRatio * range_m + kDeviations * sigma_m;
  const float there_m = nearest_return_m_[towards->direction_bin_index()];
  if (there_m > range_m + beyond_m)  // for most points, no further test is necessary
    return free_space_range_m(*towards) > range_m + beyond_m ? Verdict::free_space : Verdict::unknown_space;
  return there_m > range_m - beyond_m ? Verdict::occupied : Verdict::unknown_space;
}

}  // namespace tumble::mapping
