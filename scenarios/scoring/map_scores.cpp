// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/scoring/nearness.hpp"

namespace tumble::scenarios {

namespace {

constexpr float kToleranceM = 0.25f;     // limit for outliers (Deschenes et al.)
constexpr float kFineToleranceM = 0.1f;  // for the sharpness of the map
constexpr double kOutliersMax = 0.15;    // failed above (Deschenes et al.)
constexpr double kCoverageMin = 0.5;     // failed below
constexpr float kSurfaceCellM = 0.1f;    // each surface cell counts once
constexpr float kErrorLimitM = 0.5f;     // upper bound of an error
constexpr float kSamePointM = 1e-3f;     // cell of duplicate points
constexpr double kSeenRangeM = 100.0;    // farther surfaces are not required

static_assert(kErrorLimitM > kToleranceM && kErrorLimitM > kFineToleranceM,
              "kErrorLimitM, the upper bound of a map error, must exceed kToleranceM and kFineToleranceM");

std::vector<Eigen::Vector3f> map_in_world(const ScoredEstimate& scored) {
  const Estimate& estimate = scored.estimate();
  const Eigen::Isometry3d to_world = paired_track(scored).alignment.transform();
  std::vector<Eigen::Vector3f> points;
  points.reserve(estimate.map.size());
  for (const MapPoint& point : estimate.map) {
    points.push_back((to_world * point.position_W_m.cast<double>()).cast<float>());
  }
  return points;
}

std::vector<Eigen::Vector3f> seen_surface(const sim::Truth& truth) {
  std::vector<Eigen::Vector3f> hits;
  const sim::LidarTruth& lidar = truth.lidars.front();
  const Eigen::Vector3f start = truth.p_WB_m.front().cast<float>();
  for (std::size_t k = 0; k < lidar.hit_W_m.size() && k < lidar.surface_id.size(); ++k) {
    if (lidar.surface_id[k] >= 0 && (lidar.hit_W_m[k] - start).norm() <= kSeenRangeM) hits.push_back(lidar.hit_W_m[k]);
  }
  return one_per_cell(hits, kSurfaceCellM);
}

std::vector<float> map_distances_m(const ScoredEstimate& scored) {
  std::vector<Eigen::Vector3f> finite;
  for (const Eigen::Vector3f& point : scored.once(map_in_world)) {
    if (point.allFinite()) finite.push_back(point);
  }
  return scored.surface()->distances(finite, kErrorLimitM);
}

bool overlap_within(const ScoredEstimate& scored, float tolerance_m, double& value) {
  if (scored.surface() == nullptr || scored.estimate().map.empty()) return false;
  const std::vector<float>& distances = scored.once(map_distances_m);
  const auto within = std::count_if(distances.begin(), distances.end(), [&](float d) { return d <= tolerance_m; });
  value = static_cast<double>(within) / static_cast<double>(scored.estimate().map.size());
  return true;
}

bool overlap(const ScoredEstimate& scored, double& value) {
  return overlap_within(scored, kToleranceM, value);
}

bool fine_overlap(const ScoredEstimate& scored, double& value) {
  return overlap_within(scored, kFineToleranceM, value);
}

bool mean_error(const ScoredEstimate& scored, double& value) {
  const std::vector<MapPoint>& map = scored.estimate().map;
  if (scored.surface() == nullptr || map.empty()) return false;
  const std::vector<float>& distances = scored.once(map_distances_m);
  double sum = 0.0;
  for (const float distance : distances) sum += std::min(distance, kErrorLimitM);
  const bool finite = distances.size() == map.size();
  value = finite ? sum / static_cast<double>(map.size()) : kErrorLimitM;
  return true;
}

bool unique_share(const ScoredEstimate& scored, double& value) {
  if (scored.estimate().map.empty()) return false;
  std::vector<Eigen::Vector3f> points;
  for (const MapPoint& point : scored.estimate().map) points.push_back(point.position_W_m);
  value = static_cast<double>(one_per_cell(points, kSamePointM).size()) / static_cast<double>(points.size());
  return true;
}

// Returns the fraction of the surface with lidar hits that the estimated map covers; returns nothing without a map or
// without true hits.
std::optional<double> covered_share(const ScoredEstimate& scored) {
  if (scored.estimate().map.empty() || scored.truth().lidars.empty()) return std::nullopt;
  const std::vector<Eigen::Vector3f> surface = seen_surface(scored.truth());
  if (surface.empty()) return std::nullopt;
  const Nearness map(scored.once(map_in_world), kToleranceM);
  const auto covered =
      std::count_if(surface.begin(), surface.end(), [&](const Eigen::Vector3f& p) { return map.has_neighbour(p); });
  return static_cast<double>(covered) / static_cast<double>(surface.size());
}

bool map_coverage(const ScoredEstimate& scored, double& value) {
  const std::optional<double>& share = scored.once(covered_share);
  if (share) value = *share;
  return share.has_value();
}

// The value is 1 for a method that returned no map. An external program that returns only a trajectory gets no value.
bool failed(const ScoredEstimate& scored, double& value) {
  const Estimate& estimate = scored.estimate();
  if (scored.surface() == nullptr || (estimate.sweeps.empty() && estimate.map.empty())) return false;
  double share = 0.0, coverage = 1.0;
  const bool has_map = overlap(scored, share);
  (void)map_coverage(scored, coverage);
  value = has_map && 1.0 - share <= kOutliersMax && coverage >= kCoverageMin ? 0.0 : 1.0;
  return true;
}

}  // namespace

std::vector<Metric> map_metrics() {
  return {
      {{"map_overlap", Unit::share, "share of map points within 0.25 m of the true surface", Sense::higher,
        Place::headline, kNoTarget, Compared::by_difference},
       Kind::slam,
       overlap},
      {{"map_overlap_0_10", Unit::share, "share of map points within 0.10 m of the true surface", Sense::higher,
        Place::held, kNoTarget, Compared::by_difference},
       Kind::slam,
       fine_overlap},
      {{"map_coverage", Unit::share,
        "share of the surface hit by the lidar (in cells of 0.1 m) that has a map point within 0.25 m", Sense::higher,
        Place::held, kNoTarget, Compared::by_difference},
       Kind::slam,
       map_coverage},
      {{"map_error_mean_m", Unit::m,
        "mean distance of map points to the true surface; distances above 0.5 m count as 0.5 m", Sense::lower,
        Place::held},
       Kind::slam,
       mean_error},
      {{"map_unique_share", Unit::share,
        "number of cells of 1 mm that contain map points, divided by the number of map points; below 1 if points are "
        "inserted twice",
        Sense::higher, Place::held, kNoTarget, Compared::by_difference},
       Kind::slam,
       unique_share},
      {{"map_failed", Unit::verdict,
        "1 if the map failed, otherwise 0. A failed map is missing, covers less than half of the surface hit by the "
        "lidar, or has over 15 % of points farther than 0.25 m from the surface",
        Sense::lower, Place::held},
       Kind::slam,
       failed},
  };
}

}  // namespace tumble::scenarios
