// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/nearness.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tumble::scenarios {

namespace {

// The key of a grid cell has 21 bits per axis, so cells at a distance of about two million cells have equal keys.
// Points in cells with equal keys may be far apart, so Nearness also tests the distance between the points.
std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  return ((static_cast<std::uint64_t>(x) & kMask) << 42) | ((static_cast<std::uint64_t>(y) & kMask) << 21) |
         (static_cast<std::uint64_t>(z) & kMask);
}

Eigen::Matrix<std::int64_t, 3, 1> cell_of(const Eigen::Vector3f& point, float cell_m) {
  return (point.cast<double>() / static_cast<double>(cell_m)).array().floor().cast<std::int64_t>();
}

std::uint64_t key_of(const Eigen::Vector3f& point, float cell_m) {
  const auto cell = cell_of(point, cell_m);
  return key(cell.x(), cell.y(), cell.z());
}

}  // namespace

Nearness::Nearness(std::span<const Eigen::Vector3f> points_m, float distance_m) : distance_m_(distance_m) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(points_m.size());
  for (std::size_t k = 0; k < points_m.size(); ++k) {
    if (points_m[k].allFinite()) order.emplace_back(key_of(points_m[k], distance_m), static_cast<std::uint32_t>(k));
  }
  std::sort(order.begin(), order.end());
  points_m_.reserve(order.size());
  for (const auto& [cell, index] : order) {
    const auto place = static_cast<std::uint32_t>(points_m_.size());
    const auto next = static_cast<std::uint32_t>(ranges_.size());
    if (cells_.insert(cell, next) == next) ranges_.emplace_back(place, place);
    ranges_.back().second = place + 1;
    points_m_.push_back(points_m[index]);
  }
}

bool Nearness::has_neighbour(const Eigen::Vector3f& point_m) const {
  if (!point_m.allFinite()) return false;
  const auto centre = cell_of(point_m, distance_m_);
  const float limit2 = distance_m_ * distance_m_;
  for (std::int64_t x = -1; x <= 1; ++x) {
    for (std::int64_t y = -1; y <= 1; ++y) {
      for (std::int64_t z = -1; z <= 1; ++z) {
        const std::uint32_t found = cells_.find(key(centre.x() + x, centre.y() + y, centre.z() + z));
        if (found == SpatialHash::kAbsentEntry) continue;
        for (std::uint32_t k = ranges_[found].first; k < ranges_[found].second; ++k) {
          if ((points_m_[k] - point_m).squaredNorm() <= limit2) return true;
        }
      }
    }
  }
  return false;
}

std::vector<Eigen::Vector3f> one_per_cell(std::span<const Eigen::Vector3f> points_m, float cell_m) {
  SpatialHash taken;
  std::vector<Eigen::Vector3f> kept;
  std::optional<std::uint64_t> last;  // neighbouring points often share a cell
  for (const Eigen::Vector3f& point : points_m) {
    if (!point.allFinite()) continue;
    const std::uint64_t cell = key_of(point, cell_m);
    if (cell == last) continue;
    last = cell;
    if (taken.add(cell)) kept.push_back(point);
  }
  return kept;
}

}  // namespace tumble::scenarios
