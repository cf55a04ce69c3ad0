// SPDX-License-Identifier: BSD-3-Clause
#include "map_localiser.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::mapping {

namespace {

constexpr double kChanceAgreementMax = 0.8;
// The fraction of points that agree at the second best (wrong) pose measures agreement by chance.
constexpr double kChanceMargin = 0.3;
constexpr double kFalseAcceptance = 1e-6;  // maximum probability that a search accepts a wrong pose
constexpr std::size_t kMinPoints = 100;    // minimum number of surface points for a search
constexpr double kMinCoveredRatio = 0.4;   // minimum fraction of surface points that the prior map covers
constexpr int kAcceptSweeps = 3;           // number of successive sweeps that accept a pose
constexpr int kRejectSweeps = 2;           // number of successive sweeps that reject a pose
constexpr int kSearchSweeps = 5;           // number of sweeps between two searches
// half size of the search region around an approximate pose, in standard deviations
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
  const bool moved = T_MI && (!map().T_MI || !T_MI->isApprox(*map().T_MI, 0.0));
  std::shared_ptr<const PriorScene> scene = scene_;
  if (moved) {
    PriorMap map = scene_->map();
    map.T_MI = T_MI;
    scene = std::make_shared<const PriorScene>(std::move(map));
  }
  *this = MapLocaliser();
  scene_ = std::move(scene);
}

std::optional<FramePose> MapLocaliser::observe(const VoxelMap& local, const Eigen::Vector3d& p_WI_m) {
  if (!has_map() || localised_) return std::nullopt;
  ++sweeps_since_search_;
  const bool searches = !T_MW_ && (attempts_ == 0 || sweeps_since_search_ >= kSearchSweeps);
  if (!T_MW_ && !searches) return std::nullopt;
  const std::vector<SurfacePoint> points = surface_points(local, p_WI_m.cast<float>(), kQueryRadius_m);
  if (points.size() < kMinPoints) return std::nullopt;
  if (searches) propose(points, p_WI_m);
  if (!T_MW_) return std::nullopt;

  const FramePose pose = scene_->refined({.T_MW = *T_MW_}, points, p_WI_m, 0.4f);
  const bool enough = double(pose.covered) >= kMinCoveredRatio * double(points.size());
  if (!enough || !passes(pose)) {
    passed_ = 0;
    if (++failed_ >= kRejectSweeps) T_MW_.reset();
    return std::nullopt;
  }
  T_MW_ = pose.T_MW;
  failed_ = 0;
  if (++passed_ < kAcceptSweeps) return std::nullopt;
  localised_ = true;
  return pose;
}

void MapLocaliser::propose(const std::vector<SurfacePoint>& points, const Eigen::Vector3d& p_WI_m) {
  SearchRegion region;
  if (map().T_MI) {  // the stated pose defines the local frame, so the heading of W in M is about zero
    region.p_WI_m = region.p_MI_m = map().T_MI->translation();
    region.reach_m = std::max(kSigmas * map().sigma_m, kMinReach_m);
    region.reach_rad = std::max(kSigmas * map().sigma_rad, kMinReach_rad);
  }
  std::size_t tried = 0;
  const std::vector<FramePose> found =
      scene_->search(points, p_WI_m, static_cast<std::size_t>(attempts_), map().T_MI ? &region : nullptr, tried);
  ++attempts_;
  sweeps_since_search_ = passed_ = failed_ = 0;
  if (found.empty()) return;
  T_MW_ = found.front().T_MW;
  compared_poses_ = std::max(double(tried), 1.0);
  const double second = found.size() > 1 ? found[1].ratio() : 0.0;
  chance_ = std::max(kChanceAgreementMax, second + kChanceMargin * (1.0 - second));
}

/// Returns whether the agreement with the prior map at `pose` is improbable by chance: mapping.md (R74).
bool MapLocaliser::passes(const FramePose& pose) const {
  if (pose.ratio() <= chance_ || chance_ >= 1.0) return false;
  return double(pose.covered) * relative_entropy(pose.ratio(), chance_) >= std::log(compared_poses_ / kFalseAcceptance);
}

Status MapLocaliser::status() const {
  if (!has_map() || localised_) return {};
  return {ErrorCode::degenerate, "number of sweeps that agree with the prior map (too few to localise the run)",
          double(passed_), double(kAcceptSweeps)};
}

}  // namespace tumble::mapping
