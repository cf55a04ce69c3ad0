// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/map_drawing.hpp"

#include "tumble/mapping/detail/plane_fit.hpp"

namespace tumble::mapping {

namespace {

// cosine of 0.05 rad: if the lidar's spin axis has rotated less, a ring of the lidar measures the same scan line again
constexpr double kSameLineCosine = 0.9988;
constexpr int kRingBits = 16;
// The exported map excludes points through which beams of at least kSeenThrough sweeps passed. A single sweep is not
// sufficient to exclude a map point, because the nearest return in a direction may be wrong near the edge of a surface.
constexpr std::uint8_t kSeenThrough = 2;

}  // namespace

std::uint32_t ScanLines::line_number_offset(const Eigen::Vector3d& spin_axis_W, bool has_ring_numbers) {
  if (!has_ring_numbers) return VoxelMap::kUnknownScanLine;
  if (spin_axis_W.dot(axis_W_) < kSameLineCosine) {
    axis_W_ = spin_axis_W;
    ++attitude_;
  }
  return attitude_ << kRingBits;
}

std::vector<MapPoint> to_map_points(const VoxelMap& map, std::span<const Eigen::Vector3f> seen_from_W_m, int neighbours,
                                    double match_distance_m) {
  std::vector<MapPoint> out;
  out.reserve(map.size());
  NearestNeighbours found;
  for (std::uint32_t index = 0; index < map.index_end(); ++index) {
    if (!map.exists(index) || map.seen_through_count(index) >= kSeenThrough) continue;
    MapPoint& point = out.emplace_back();
    point.position_W_m = map.position_W_m(index);
    point.sigma_m = map.sigma_m(index);
    map.nearest(point.position_W_m, neighbours, static_cast<float>(match_distance_m), found);
    const PlaneFit plane = fit_plane(map, found, PlaneFitBounds{});
    if (plane.verdict != PlaneVerdict::plane) continue;
    const Eigen::Vector3f towards = seen_from_W_m[map.sweep(index)] - point.position_W_m;
    point.normal_W = plane.normal_W.dot(towards) < 0.0f ? Eigen::Vector3f(-plane.normal_W) : plane.normal_W;
  }
  return out;
}

}  // namespace tumble::mapping
