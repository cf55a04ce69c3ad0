// SPDX-License-Identifier: BSD-3-Clause
#include "prior_scene.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/plane_fit.hpp"
#include "tumble/mapping/detail/spatial_hash.hpp"

namespace tumble::mapping {

namespace {

constexpr VoxelMap::Params kVoxels{.voxel_m = 0.5, .spacing_m = 0.1};
constexpr int kNeighbours = 12;
constexpr float kFitRadius_m = 1.0f;

constexpr float kCell_m = 0.5f;  // edge of a grid cell; larger if the grid would exceed kCellsMax
constexpr double kCellsMax = 32.0 * 1024 * 1024;
constexpr std::uint8_t kOnSurface = 2, kNextToSurface = 1;
constexpr int kYaws = 72;
constexpr std::size_t kCoarsePoints = 240;  // number of surface points for a coarse score
constexpr std::size_t kKept = 4000, kRefined = 96;
constexpr float kApart_m = 1.0f;  // minimum distance of two distinct poses
constexpr double kApart_rad = 0.12;
constexpr float kNormalZ = 0.3f;

constexpr float kCovered_m = 1.0f;  // maximum distance of a covered point from the prior map
constexpr float kNearSurface_m = 0.5f, kAgreeDistance_m = 0.12f, kAgreeNormal = 0.7f;
constexpr std::size_t kRefinePoints = 400;
constexpr float kLastKernel_m = 0.15f;

/// The surface points are sorted into classes by slope, and each class contributes equally many points (normal-space
/// sampling). Without the classes, most points would be on the ground, although trunks and rocks determine the pose
/// better.
int surface_slope_class(const Eigen::Vector3f& normal) {
  const float z = std::abs(normal.z());
  return z < 0.3f ? 0 : z < 0.6f ? 1 : z < 0.85f ? 2 : 3;
}

std::vector<SurfacePoint> select_points_by_slope(const std::vector<SurfacePoint>& points, std::size_t most) {
  std::array<std::vector<std::size_t>, 4> classes;
  for (std::size_t k = 0; k < points.size(); ++k)
    classes[static_cast<std::size_t>(surface_slope_class(points[k].normal_W))].push_back(k);
  std::vector<SurfacePoint> out;
  out.reserve(std::min(most, points.size()));
  for (std::size_t round = 0; out.size() < most; ++round) {
    bool any = false;
    for (const std::vector<std::size_t>& of : classes) {
      if (round >= of.size() || out.size() >= most) continue;
      out.push_back(points[of[round]]);
      any = true;
    }
    if (!any) break;
  }
  return out;
}

bool is_same_pose(const FramePose& a, const FramePose& b, const Eigen::Vector3d& sensor_W_m) {
  if ((a.T_prior_map_world * sensor_W_m - b.T_prior_map_world * sensor_W_m).norm() > kApart_m) return false;
  return Eigen::AngleAxisd(a.T_prior_map_world.linear().transpose() * b.T_prior_map_world.linear()).angle() <
         kApart_rad;
}

}  // namespace

std::vector<SurfacePoint> surface_points(const VoxelMap& map, const Eigen::Vector3f& p_WI_m, float radius_m) {
  struct NearestSurface {
    float distance2_m2;
    std::uint32_t index;
  };
  std::vector<NearestSurface> near;
  SpatialHash taken(1 << 10);
  for (std::uint32_t index = 0; index < map.index_end(); ++index) {
    if (!map.exists(index) || map.seen_through_count(index) > 0) continue;
    const Eigen::Vector3f position = map.position_W_m(index);
    const float distance2 = (position - p_WI_m).squaredNorm();
    if (distance2 > radius_m * radius_m) continue;
    near.push_back({distance2, index});
  }
  std::sort(near.begin(), near.end(), [](const NearestSurface& a, const NearestSurface& b) {
    return a.distance2_m2 != b.distance2_m2 ? a.distance2_m2 < b.distance2_m2 : a.index < b.index;
  });
  std::vector<SurfacePoint> out;
  NearestNeighbours found;
  for (const NearestSurface& candidate : near) {
    const Eigen::Vector3f position = map.position_W_m(candidate.index);
    const std::uint64_t key = SpatialHash::key(voxel_cube_of(position, 1.0f));
    if (taken.find(key) != SpatialHash::kAbsentEntry) continue;
    map.nearest(position, kNeighbours, kFitRadius_m, found);
    const PlaneFit plane = fit_plane(map, found, PlaneFitBounds{});
    if (plane.verdict != PlaneVerdict::plane) continue;
    taken.add(key);
    out.push_back({position, plane.normal_W});
  }
  return out;
}

PriorMapScene::PriorMapScene(PriorMap map) : map_(std::move(map)), voxels_(kVoxels) {
  for (const MapPoint& point : map_.points) {
    const std::uint32_t index = voxels_.add(point.position_W_m, point.sigma_m, 0, VoxelMap::kUnknownScanLine);
    if (index == VoxelMap::kNoPoint) continue;
    if (normals_.size() <= index) normals_.resize(voxels_.index_end(), Eigen::Vector3f::Zero());
    normals_[index] = point.normal_W;
  }
  build_grid();
}

/// The grid of prior map points is larger than the map, so best_candidates() does not check grid indices.
void PriorMapScene::build_grid() {
  Eigen::AlignedBox3f box;
  for (std::uint32_t index = 0; index < voxels_.index_end(); ++index)
    if (voxels_.exists(index)) box.extend(voxels_.position_W_m(index));
  if (box.isEmpty()) return;
  for (cell_m_ = kCell_m;; cell_m_ *= 1.25f) {
    const Eigen::Vector3f margin = Eigen::Vector3f::Constant(kQueryRadius_m * 2.0f + 3.0f * cell_m_);
    lower_corner_prior_map_m_ = box.min() - margin;
    size_ = ((box.max() + margin - lower_corner_prior_map_m_) / cell_m_).array().ceil().cast<int>();
    if (size_.cast<double>().prod() <= kCellsMax) break;
  }
  grid_.assign(static_cast<std::size_t>(size_.cast<std::int64_t>().prod()), 0);
  struct CellSum {
    Eigen::Vector3f position = Eigen::Vector3f::Zero();
    float normal_z = 0.0f;
    int points = 0, normals = 0;
  };
  std::vector<CellSum> sums;
  std::vector<std::int64_t> at;
  SpatialHash number(1 << 12);
  for (std::uint32_t index = 0; index < voxels_.index_end(); ++index) {
    if (!voxels_.exists(index)) continue;
    const Eigen::Vector3f position = voxels_.position_W_m(index);
    const std::uint32_t k =
        number.insert(SpatialHash::key(voxel_cube_of(position - lower_corner_prior_map_m_, 1.0f / cell_m_)),
                      static_cast<std::uint32_t>(sums.size()));
    if (k == sums.size()) {
      sums.emplace_back();
      at.push_back(index_of(position));
    }
    sums[k].position += position;
    ++sums[k].points;
    if (normals_[index].isZero(0.0f)) continue;
    sums[k].normal_z += std::abs(normals_[index].z());
    ++sums[k].normals;
  }
  for (std::size_t k = 0; k < sums.size(); ++k) {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          std::uint8_t& cell =
              grid_[static_cast<std::size_t>(at[k] + (std::int64_t{z} * size_.y() + y) * size_.x() + x)];
          cell = std::max(cell, (x | y | z) == 0 ? kOnSurface : kNextToSurface);
        }
    if (sums[k].normals == 0) continue;
    cells_.push_back({sums[k].position / static_cast<float>(sums[k].points),
                      sums[k].normal_z / static_cast<float>(sums[k].normals), at[k]});
  }
}

std::int64_t PriorMapScene::index_of(const Eigen::Vector3f& position_M_m) const {
  const Eigen::Vector3i cell = voxel_cube_of(position_M_m - lower_corner_prior_map_m_, 1.0f / cell_m_);
  return (std::int64_t{cell.z()} * size_.y() + cell.y()) * size_.x() + cell.x();
}

Eigen::Isometry3d PriorMapScene::pose_of(const PoseCandidate& candidate, const SurfacePoint& anchor) const {
  const double yaw = 2.0 * std::numbers::pi * candidate.yaw / kYaws;
  Eigen::Isometry3d T_MW = Eigen::Isometry3d::Identity();
  T_MW.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T_MW.translation() = cells_[candidate.grid_cell_index].position_prior_map_m.cast<double>() -
                       T_MW.linear() * anchor.position_W_m.cast<double>();
  return T_MW;
}

/// Computes a score for all poses that move the surface point `anchor` to a surface cell of the prior map, for a series
/// of headings.
std::vector<PriorMapScene::PoseCandidate> PriorMapScene::best_candidates(const std::vector<SurfacePoint>& points,
                                                                         const SurfacePoint& anchor,
                                                                         const SearchRegion* region,
                                                                         std::size_t& tried) const {
  const std::vector<SurfacePoint> scored = select_points_by_slope(points, kCoarsePoints);
  std::vector<std::vector<std::int64_t>> steps(kYaws);
  for (int yaw = 0; yaw < kYaws; ++yaw) {
    const Eigen::Matrix3f R =
        Eigen::AngleAxisf(2.0f * std::numbers::pi_v<float> * static_cast<float>(yaw) / kYaws, Eigen::Vector3f::UnitZ())
            .toRotationMatrix();
    for (const SurfacePoint& point : scored) {
      const Eigen::Vector3i cell =
          ((R * (point.position_W_m - anchor.position_W_m)) / cell_m_).array().round().cast<int>();
      steps[static_cast<std::size_t>(yaw)].push_back((std::int64_t{cell.z()} * size_.y() + cell.y()) * size_.x() +
                                                     cell.x());
    }
  }
  const auto is_better = [](const PoseCandidate& a, const PoseCandidate& b) {
    if (a.pose_score != b.pose_score) return a.pose_score > b.pose_score;
    return a.grid_cell_index != b.grid_cell_index ? a.grid_cell_index < b.grid_cell_index : a.yaw < b.yaw;
  };
  std::vector<PoseCandidate> best;
  int least = 0;
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
    if (std::abs(cells_[cell].normal_z - std::abs(anchor.normal_W.z())) > kNormalZ) continue;
    for (std::uint16_t yaw = 0; yaw < kYaws; ++yaw) {
      const PoseCandidate candidate{0, cell, yaw};
      if (region != nullptr) {
        const double angle = std::remainder(2.0 * std::numbers::pi * yaw / kYaws, 2.0 * std::numbers::pi);
        if (std::abs(angle) > region->search_angle_rad) continue;
        const Eigen::Vector3d away = pose_of(candidate, anchor) * region->p_WI_m - region->centre_in_prior_map_m;
        if (away.norm() > region->search_radius_m) continue;
      }
      ++tried;
      int score = 0;
      for (const std::int64_t step : steps[yaw]) score += grid_[static_cast<std::size_t>(cells_[cell].at + step)];
      if (score <= least) continue;
      best.push_back({score, cell, yaw});
      if (best.size() < 2 * kKept) continue;
      std::nth_element(best.begin(), best.begin() + kKept, best.end(), is_better);
      best.resize(kKept);
      least = std::min_element(best.begin(), best.end(), [](const PoseCandidate& a, const PoseCandidate& b) {
                return a.pose_score < b.pose_score;
              })->pose_score;
    }
  }
  std::sort(best.begin(), best.end(), is_better);
  return best;
}

std::vector<FramePose> PriorMapScene::find_candidate_poses(const std::vector<SurfacePoint>& points,
                                                           const Eigen::Vector3d& sensor_W_m, std::size_t attempt,
                                                           const SearchRegion* region, std::size_t& tried) const {
  tried = 0;
  std::vector<SurfacePoint> anchors;
  for (const SurfacePoint& point : points)
    if (surface_slope_class(point.normal_W) >= 2) anchors.push_back(point);
  if (anchors.empty() || cells_.empty()) return {};
  const SurfacePoint anchor = anchors[7 * attempt % anchors.size()];

  std::vector<FramePose> starts;
  for (const PoseCandidate& candidate : best_candidates(points, anchor, region, tried)) {
    FramePose pose;
    pose.T_prior_map_world = pose_of(candidate, anchor);
    const auto same = [&](const FramePose& other) { return is_same_pose(pose, other, sensor_W_m); };
    if (std::any_of(starts.begin(), starts.end(), same)) continue;
    starts.push_back(pose);
    if (starts.size() == kRefined) break;
  }
  std::vector<FramePose> distinct;
  for (const FramePose& start : starts) {
    FramePose pose = refined_pose(start, points, sensor_W_m, 1.0f);
    const auto same = [&](const FramePose& other) { return is_same_pose(pose, other, sensor_W_m); };
    const auto twin = std::find_if(distinct.begin(), distinct.end(), same);
    if (twin == distinct.end()) {
      distinct.push_back(pose);
    } else if (pose.agreeing_point_count > twin->agreeing_point_count) {
      *twin = pose;
    }
  }
  std::stable_sort(distinct.begin(), distinct.end(), [](const FramePose& a, const FramePose& b) {
    return a.agreeing_point_count > b.agreeing_point_count;
  });
  if (distinct.size() > 2) distinct.resize(2);
  return distinct;
}

FramePose PriorMapScene::refined_pose(const FramePose& start, const std::vector<SurfacePoint>& points,
                                      const Eigen::Vector3d& sensor_W_m, float first_kernel_m) const {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  constexpr int kIterations = 18;
  const std::vector<SurfacePoint> used = select_points_by_slope(points, kRefinePoints);
  FramePose pose = start;
  NearestNeighbours found;
  float kernel_m = first_kernel_m;
  Matrix6 H = Matrix6::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    H = 1e-3 * Matrix6::Identity();
    Vector6 g = Vector6::Zero();
    const Eigen::Isometry3f T = pose.T_prior_map_world.cast<float>();
    const Eigen::Vector3f sensor_M = (pose.T_prior_map_world * sensor_W_m).cast<float>();
    for (const SurfacePoint& point : used) {
      const Eigen::Vector3f x = T * point.position_W_m;
      voxels_.nearest(x, 1, std::max(kernel_m, kNearSurface_m), found);
      if (found.count == 0) continue;
      const Eigen::Vector3f& n = normals_[found.index[0]];
      if (n.isZero(0.0f) || std::abs(n.dot(T.linear() * point.normal_W)) < 0.5f) continue;
      const float r = n.dot(x - voxels_.position_W_m(found.index[0]));
      const float k2 = kernel_m * kernel_m;
      const double weight = std::pow(k2 / (k2 + r * r), 2);
      Vector6 J;
      J << n.cast<double>(), (x - sensor_M).cross(n).cast<double>();
      H += weight * J * J.transpose();
      g += weight * double(r) * J;
    }
    const Vector6 step = -H.ldlt().solve(g);
    const Eigen::Vector3d about = sensor_M.cast<double>();
    Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
    moved.linear() = so3::exp(step.tail<3>()).toRotationMatrix();
    moved.translation() = about + step.head<3>() - moved.linear() * about;
    pose.T_prior_map_world = moved * pose.T_prior_map_world;
    pose.T_prior_map_world.linear() =
        Eigen::Quaterniond(pose.T_prior_map_world.linear()).normalized().toRotationMatrix();
    if (kernel_m <= kLastKernel_m && step.head<3>().norm() < 1e-3 && step.tail<3>().norm() < 2e-4) break;
    kernel_m = std::max(kLastKernel_m, 0.75f * kernel_m);
  }
  count(points, pose);
  constexpr double kSigma_m = 0.05;  // standard deviation of a point, with the errors of both maps
  pose.covariance = kSigma_m * kSigma_m * H.inverse();
  return pose;
}

void PriorMapScene::count(const std::vector<SurfacePoint>& points, FramePose& pose) const {
  pose.covered_point_count = pose.agreeing_point_count = 0;
  const Eigen::Isometry3f T = pose.T_prior_map_world.cast<float>();
  NearestNeighbours found;
  for (const SurfacePoint& point : points) {
    const Eigen::Vector3f x = T * point.position_W_m;
    voxels_.nearest(x, 1, kCovered_m, found);
    if (found.count == 0) continue;
    const Eigen::Vector3f& n = normals_[found.index[0]];
    if (n.isZero(0.0f)) continue;  // a point on a rough surface has no normal and supports no pose
    ++pose.covered_point_count;
    if (found.distance2_m2[0] > kNearSurface_m * kNearSurface_m) continue;
    pose.agreeing_point_count += std::abs(n.dot(x - voxels_.position_W_m(found.index[0]))) <= kAgreeDistance_m &&
                                 std::abs(n.dot(T.linear() * point.normal_W)) >= kAgreeNormal;
  }
}

}  // namespace tumble::mapping

namespace tumble {

Status check_map_points(std::span<const MapPoint> points) {
  constexpr double kFarthest_m = 5e4;
  for (const MapPoint& point : points) {
    if (!point.position_W_m.allFinite() || !point.normal_W.allFinite() || !std::isfinite(point.sigma_m))
      return {ErrorCode::non_finite, "prior map's points", std::nan(""), kFarthest_m};
    const double farthest = point.position_W_m.cwiseAbs().maxCoeff();
    if (farthest > kFarthest_m) return {ErrorCode::out_of_range, "prior map's position_m", farthest, kFarthest_m};
    if (point.sigma_m < 0.0f) return {ErrorCode::out_of_range, "prior map's sigma_m", point.sigma_m, 0.0};
    const double length = point.normal_W.norm();
    if (length > 0.0 && std::abs(length - 1.0) > 1e-3)
      return {ErrorCode::out_of_range, "length of a prior map's normal", length, 1.0};
  }
  return {};
}

Status check_prior_map(const PriorMap& map) {
  constexpr std::size_t kLeast = 100;
  if (const Status status = check_map_points(map.points); !status.ok()) return status;
  const auto has_normal = [](const MapPoint& point) { return !point.normal_W.isZero(0.0f); };
  const auto with_normal = static_cast<std::size_t>(std::count_if(map.points.begin(), map.points.end(), has_normal));
  if (with_normal < kLeast)
    return {ErrorCode::insufficient_data, "prior map's points with normals", double(with_normal), double(kLeast)};
  if (!std::isfinite(map.start_position_sigma_m) || !std::isfinite(map.start_heading_sigma_rad) ||
      (map.start_T_MI && !map.start_T_MI->matrix().allFinite()))
    return {ErrorCode::non_finite, "pose in the prior map", std::nan(""), 0.0};
  if (map.start_position_sigma_m < 0.0)
    return {ErrorCode::out_of_range, "start_position_sigma_m", map.start_position_sigma_m, 0.0};
  if (map.start_heading_sigma_rad < 0.0)
    return {ErrorCode::out_of_range, "start_heading_sigma_rad", map.start_heading_sigma_rad, 0.0};
  return {};
}

std::vector<MapPoint> to_map_points(std::span<const Eigen::Vector3f> positions_M_m, float sigma_m) {
  VoxelMap voxels(mapping::kVoxels);
  for (const Eigen::Vector3f& position : positions_M_m)
    if (position.allFinite()) voxels.insert(position, sigma_m, 0);
  std::vector<MapPoint> out;
  NearestNeighbours found;
  for (std::uint32_t index = 0; index < voxels.index_end(); ++index) {
    if (!voxels.exists(index)) continue;
    MapPoint& point = out.emplace_back();
    point.position_W_m = voxels.position_W_m(index);
    point.sigma_m = sigma_m;
    voxels.nearest(point.position_W_m, mapping::kNeighbours, mapping::kFitRadius_m, found);
    const PlaneFit plane = fit_plane(voxels, found, PlaneFitBounds{});
    if (plane.verdict == PlaneVerdict::plane) point.normal_W = plane.normal_W;
  }
  return out;
}

}  // namespace tumble
