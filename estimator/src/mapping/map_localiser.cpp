// SPDX-License-Identifier: BSD-3-Clause
#include "map_localiser.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::mapping {

namespace {

constexpr double kChanceAgreementMin = 0.7;
// The second-best pose of a search is probably wrong. The fraction of points that agree at the second-best pose
// therefore estimates the agreement by chance.
constexpr double kChanceMargin = 0.3;
constexpr double kFalseAcceptance = 1e-6;  // maximum probability that a search accepts a wrong pose
constexpr std::size_t kMinPoints = 100;    // minimum number of surface points for a search
constexpr double kMinCoveredRatio = 0.4;   // minimum fraction of surface points that the prior map covers
constexpr int kAcceptSweeps = 3;           // number of successive sweeps that accept a pose
constexpr int kRejectSweeps = 2;           // number of successive sweeps that reject a pose
constexpr int kSearchSweeps = 5;           // number of sweeps between two searches
// half of the size of the search region around an approximate pose, in standard deviations
constexpr double kSigmas = 3.0;
constexpr double kMinReach_m = 1.0, kMinReach_rad = 0.15;

double relative_entropy(double share, double chance) {
  double out = 0.0;
  if (share > 0.0) out += share * std::log(share / chance);
  if (share < 1.0) out += (1.0 - share) * std::log((1.0 - share) / (1.0 - chance));
  return out;
}

}  // namespace

void MapLocaliser::restart(const std::optional<Eigen::Isometry3d>& T_MI) {
  if (!has_map()) return;
  const bool moved = T_MI && (!map().start_T_MI || !T_MI->isApprox(*map().start_T_MI, 0.0));
  std::shared_ptr<const PriorMapScene> scene = prior_scene_;
  if (moved) {
    PriorMap map = prior_scene_->map();
    map.start_T_MI = T_MI;
    scene = std::make_shared<const PriorMapScene>(std::move(map));
  }
  *this = MapLocaliser();
  prior_scene_ = std::move(scene);
}

std::optional<FramePose> MapLocaliser::match_local_map(const VoxelMap& local, const Eigen::Vector3d& p_WI_m) {
  if (!has_map() || localised_) return std::nullopt;
  ++sweeps_since_search_;
  const bool searches = !T_prior_map_world_ && (attempts_ == 0 || sweeps_since_search_ >= kSearchSweeps);
  if (!T_prior_map_world_ && !searches) return std::nullopt;
  const std::vector<SurfacePoint> points = surface_points(local, p_WI_m.cast<float>(), kQueryRadius_m);
  if (points.size() < kMinPoints) return std::nullopt;
  if (searches) propose_map_pose(points, p_WI_m);
  if (!T_prior_map_world_) return std::nullopt;

  const FramePose pose = prior_scene_->refined_pose({.T_prior_map_world = *T_prior_map_world_}, points, p_WI_m, 0.4f);
  const bool enough = double(pose.covered_point_count) >= kMinCoveredRatio * double(points.size());
  if (!enough || !matches_prior_map(pose)) {
    successive_passed_tests_ = 0;
    if (++successive_failed_tests_ >= kRejectSweeps) T_prior_map_world_.reset();
    return std::nullopt;
  }
  T_prior_map_world_ = pose.T_prior_map_world;
  successive_failed_tests_ = 0;
  if (++successive_passed_tests_ < kAcceptSweeps) return std::nullopt;
  localised_ = true;
  return pose;
}

void MapLocaliser::propose_map_pose(const std::vector<SurfacePoint>& points, const Eigen::Vector3d& p_WI_m) {
  SearchRegion region;
  if (map().start_T_MI) {  // the given start pose also defines frame W, so W and M have nearly equal headings
    region.p_WI_m = region.centre_in_prior_map_m = map().start_T_MI->translation();
    region.search_radius_m = std::max(kSigmas * map().start_position_sigma_m, kMinReach_m);
    region.search_angle_rad = std::max(kSigmas * map().start_heading_sigma_rad, kMinReach_rad);
  }
  std::size_t tried = 0;
  const std::vector<FramePose> found = prior_scene_->find_candidate_poses(
      points, p_WI_m, static_cast<std::size_t>(attempts_), map().start_T_MI ? &region : nullptr, tried);
  ++attempts_;
  sweeps_since_search_ = successive_passed_tests_ = successive_failed_tests_ = 0;
  if (found.empty()) return;
  T_prior_map_world_ = found.front().T_prior_map_world;
  compared_pose_count_ = std::max(double(tried), 1.0);
  const double second = found.size() > 1 ? found[1].agreement_ratio() : 0.0;
  random_agreement_fraction_ = std::max(kChanceAgreementMin, second + kChanceMargin * (1.0 - second));
}

/// See mapping.md (R74).
bool MapLocaliser::matches_prior_map(const FramePose& pose) const {
  if (pose.agreement_ratio() <= random_agreement_fraction_ || random_agreement_fraction_ >= 1.0) return false;
  return double(pose.covered_point_count) * relative_entropy(pose.agreement_ratio(), random_agreement_fraction_) >=
         std::log(compared_pose_count_ / kFalseAcceptance);
}

Status MapLocaliser::status() const {
  if (!has_map() || localised_) return {};
  return {ErrorCode::degenerate, "number of sweeps that agree with the prior map (too few to localise the run)",
          double(successive_passed_tests_), double(kAcceptSweeps)};
}

}  // namespace tumble::mapping
