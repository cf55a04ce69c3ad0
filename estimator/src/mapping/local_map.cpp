// SPDX-License-Identifier: BSD-3-Clause
#include "local_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "unknowns.hpp"

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

constexpr double kPointSigmaMax_m = 0.25;

/// PoseVariance computes the variance of a map point that results from the uncertain trajectory of its sweep:
/// mapping.md (R64).
class PoseVariance {
 public:
  PoseVariance(const Registration::Matrix& covariance, const SweepTrajectory& trajectory)
      : duration_s_(std::max(trajectory.duration_s(), 1e-9)) {
    namespace u = unknowns;
    const SweepTrajectory::Transition step = trajectory.transition(trajectory.duration_s());
    Eigen::Matrix<double, 9, Registration::kFirstCalibrationUnknown> F;
    F << step.jacobian_start, step.jacobian_saturation_deficit_s;
    const Eigen::Matrix<double, 9, 9> end = F * u::sub_block(covariance, u::moving) * F.transpose();
    start_variance_m2_ = u::variances(covariance, u::position).mean();
    start_variance_rad2_ = u::variances(covariance, u::attitude).mean();
    end_variance_m2_ = u::variances(end, u::position).mean();
    end_variance_rad2_ = u::variances(end, u::attitude).mean();
  }
  double position_variance_at_m2(const SweepPoint& point) const {
    const double share = std::clamp(point.t_s / duration_s_, 0.0, 1.0);
    const double m2 = start_variance_m2_ + share * (end_variance_m2_ - start_variance_m2_);
    const double rad2 = start_variance_rad2_ + share * (end_variance_rad2_ - start_variance_rad2_);
    return std::max(m2 + rad2 * point.range_m * point.range_m, 0.0);
  }

 private:
  double duration_s_, start_variance_m2_, start_variance_rad2_, end_variance_m2_, end_variance_rad2_;
};

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

std::size_t LocalMap::insert(const Params& params, const SweepToInsert& sweep, const Registration& noise,
                             std::vector<InsertedPoint>& inserted) {
  const SweepTrajectory& trajectory = sweep.trajectory;
  const std::span<const SweepPoint> points = sweep.points;
  compute_lever_arm_vectors(trajectory, points, levers_W_m_);
  const PoseVariance pose_variance(sweep.covariance, trajectory);
  const std::uint32_t number = sweeps();
  const MotionState middle = trajectory.state(0.5 * trajectory.duration_s());
  const std::uint32_t line =
      scan_lines_.line_number_offset(middle.q_WI * params.T_IL.linear().col(2), sweep.has_ring_numbers);
  const double moved_m =
      (trajectory.gravity_free_position_m(trajectory.duration_s()) - trajectory.gravity_free_position_m(0.0)).norm();
  free_space_.start(middle.p_WI_m.cast<float>(), static_cast<float>(0.5 * moved_m));
  const auto add = [&](double sigma_max_m) {
    std::size_t added = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f position = levers_W_m_[i] + trajectory.gravity_free_position_m(points[i].t_s).cast<float>();
      free_space_.add(position);
      if (map_.is_occupied(position)) continue;  // most points end here
      // See mapping.md (R64).
      const double sigma_m =
          std::sqrt(noise.point_variance_m2(points[i]) + pose_variance.position_variance_at_m2(points[i]));
      if (sigma_m > sigma_max_m) continue;
      const std::uint32_t index =
          map_.add(position, static_cast<float>(sigma_m), number, ScanLines::line(line, points[i].ring));
      if (index == VoxelMap::kNoPoint) continue;
      ++added;
      if (params.expert.window_sweeps > 1) inserted.push_back({index, points[i]});
    }
    return added;
  };
  std::size_t added = add(kPointSigmaMax_m);
  if (empty()) added = add(std::numeric_limits<double>::infinity());  // an uncertain map is better than none
  seen_from_W_m_.push_back(middle.p_WI_m.cast<float>());
  if (sweep.is_pose_certain) check_free_space(free_space_);
  return added;
}

void LocalMap::check_free_space(const FreeSpaceGrid& sight) {
  for (std::uint32_t index = 0; index < map_.index_end(); ++index) {
    if (!map_.exists(index)) continue;
    const FreeSpaceGrid::Verdict verdict = sight.verdict(map_.position_W_m(index), map_.sigma_m(index));
    if (verdict != FreeSpaceGrid::Verdict::unknown_space)
      map_.count_observation(index, verdict == FreeSpaceGrid::Verdict::free_space);
  }
}

void LocalMap::move(const SweepTrajectory& trajectory, const Eigen::Isometry3d& T_IL, double later_s,
                    std::span<const InsertedPoint> inserted) {
  std::size_t hint = 0;
  for (const InsertedPoint& inserted_point : inserted) {
    const double t_s = inserted_point.point.t_s + later_s;
    const SweepTrajectory::PreintegratedMotion at = trajectory.at(t_s, hint);
    const Eigen::Vector3d position = trajectory.gravity_free_position_m(t_s) + at.preintegrated_position_m +
                                     at.q_WI * (T_IL * inserted_point.point.point_L_m.cast<double>());
    map_.move(inserted_point.index, position.cast<float>());
  }
}

void LocalMap::start_from_map_points(const Params& params, std::span<const MapPoint> points,
                                     const Eigen::Isometry3f* T_MW) {
  constexpr float kDistant_m = 1e5f;
  const LocalMap before = std::exchange(*this, LocalMap(params));
  for (int axis = 0; axis < 3; ++axis) {
    for (const float sign : {1.0f, -1.0f}) seen_from_W_m_.push_back(sign * kDistant_m * Eigen::Vector3f::Unit(axis));
  }
  for (const MapPoint& point : points) {
    Eigen::Index axis = 0;
    point.normal_W.cwiseAbs().maxCoeff(&axis);
    const auto sweep = static_cast<std::uint32_t>(2 * axis + (point.normal_W[axis] < 0.0f));
    map_.insert(point.position_W_m, point.sigma_m, sweep);
  }
  if (T_MW == nullptr) return;
  const std::uint32_t first = sweeps();
  for (const Eigen::Vector3f& from : before.seen_from_W_m_) seen_from_W_m_.push_back(*T_MW * from);
  for (std::uint32_t index = 0; index < before.map_.index_end(); ++index) {
    if (!before.map_.exists(index) || before.map_.seen_through_count(index) > 0) continue;
    map_.insert(*T_MW * before.map_.position_W_m(index), before.map_.sigma_m(index), first + before.map_.sweep(index));
  }
}

bool LocalMap::prune(const Params& params, const Eigen::Vector3d& p_WI_m) {
  const Eigen::Vector3f here = p_WI_m.cast<float>();
  const float moved = (here - last_pruning_position_W_m_).norm();
  if (moved < static_cast<float>(LocalMapParams::kPruneRatio * params.expert.map.radius_m)) return false;
  last_pruning_position_W_m_ = here;
  const std::vector<std::uint32_t> kept =
      map_.remove_points_beyond(here, static_cast<float>(params.expert.map.radius_m));
  std::vector<Eigen::Vector3f> from(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) from[i] = seen_from_W_m_[kept[i]];
  seen_from_W_m_.swap(from);
  return true;
}

void LocalMap::remove_sweeps_since(std::uint32_t first_sweep) {
  if (first_sweep >= sweeps()) return;
  map_.remove_sweeps_from(first_sweep);
  seen_from_W_m_.resize(first_sweep);
}

std::vector<MapPoint> LocalMap::to_map_points(const Params& params) const {
  return mapping::to_map_points(map_, seen_from_W_m_, MatchingParams::kNeighbours, params.expert.matching.distance_m);
}

}  // namespace tumble::mapping
