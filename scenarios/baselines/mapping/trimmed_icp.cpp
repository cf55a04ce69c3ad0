// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/mapping/trimmed_icp.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble::baselines {

namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 solve(const Matrix6& H, const Vector6& g) {
  const Eigen::LLT<Matrix6> factor(H);
  if (factor.info() == Eigen::Success) return factor.solve(-g);
  return H.completeOrthogonalDecomposition().solve(-g);  // minimum-norm solution of a singular system
}

}  // namespace

TrimmedIcp::TrimmedIcp(const Params& params) : params_(params) {
  require_valid_fields(params);
  require_in_interval("trim_min", params.trim_min, 1e-3, params.trim_max);
}

std::size_t TrimmedIcp::trim(std::span<const float> sorted_d2, std::size_t slots, const Params& params) {
  if (sorted_d2.empty()) return 0;
  const auto index = [&](double share) {
    return std::min(static_cast<std::size_t>(share * static_cast<double>(slots)), sorted_d2.size());
  };
  const std::size_t low = std::max<std::size_t>(index(params.trim_min), 1);
  const std::size_t high = std::max(index(params.trim_max), low);
  double sum = 0.0, least = 0.0;
  std::size_t best = 0;
  for (std::size_t k = 1; k <= high; ++k) {
    sum += static_cast<double>(sorted_d2[k - 1]);
    if (k < low) continue;
    const double share = static_cast<double>(k) / static_cast<double>(slots);
    const double cost = sum / (static_cast<double>(k) * std::pow(share, 2.0 * params.trim_lambda));
    if (best == 0 || cost < least) {
      least = cost;
      best = k;
    }
  }
  return best;
}

const TrimmedIcp::Normal& TrimmedIcp::normal(const VoxelMap& map, std::uint32_t index) {
  if (normals_.size() < map.index_end()) normals_.resize(map.index_end());
  Normal& entry = normals_[index];
  if (entry.known) return entry;
  entry.known = true;
  NearestNeighbours found;
  map.nearest(map.position_W_m(index), params_.normal_neighbours, static_cast<float>(params_.match_distance_m), found);
  PlaneFitBounds any;
  any.neighbours_min = 3;
  any.collinear_ratio_max = 0.0;
  any.rough_share = 1.0;
  any.off_line_neighbours_min = 0;
  const PlaneFit fit = fit_plane(map, found, any);
  entry.usable = fit.verdict == PlaneVerdict::plane;
  entry.n = fit.normal_W;
  return entry;
}

void TrimmedIcp::match(std::span<const Point> points, const Eigen::Isometry3f& T, const VoxelMap& map) {
  matches_.clear();
  NearestNeighbours found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    map.nearest(T * points[i].position_m, params_.neighbours, static_cast<float>(params_.match_distance_m), found);
    for (int k = 0; k < found.count; ++k) {
      matches_.push_back({static_cast<std::uint32_t>(i), found.index[static_cast<std::size_t>(k)],
                          found.distance2_m2[static_cast<std::size_t>(k)]});
    }
  }
}

TrimmedIcp::Result TrimmedIcp::align(std::span<const Point> points, const Eigen::Isometry3d& prior,
                                     const VoxelMap& map) {
  Result result;
  result.T = prior;
  Eigen::Isometry3d T = prior;
  double last_m = 1e9, last_rad = 1e9;
  for (result.iterations = 1; result.iterations <= params_.iterations_max; ++result.iterations) {
    match(points, T.cast<float>(), map);
    result.matched_slots = matches_.size();
    if (matches_.empty()) return result;
    sorted_.clear();
    for (const Match& match : matches_) sorted_.push_back(match.distance2_m2);
    std::sort(sorted_.begin(), sorted_.end());
    const std::size_t slots =
        params_.count_unmatched_slots ? points.size() * static_cast<std::size_t>(params_.neighbours) : matches_.size();
    const std::size_t kept = trim(sorted_, slots, params_);
    const float limit = sorted_[kept - 1];
    result.kept_share = static_cast<double>(kept) / static_cast<double>(matches_.size());

    Matrix6 H = Matrix6::Zero();
    Vector6 g = Vector6::Zero();
    const Eigen::Vector3d centre = T.translation();
    for (const Match& match : matches_) {
      if (match.distance2_m2 > limit) continue;
      const Normal& surface = normal(map, match.map_index);
      if (!surface.usable) continue;
      const Eigen::Vector3d x = T * points[match.point].position_m.cast<double>();
      const Eigen::Vector3d n = surface.n.cast<double>();
      const double r = n.dot(x - map.position_W_m(match.map_index).cast<double>());
      const double sigma = static_cast<double>(map.sigma_m(match.map_index));
      const double w = 1.0 / (static_cast<double>(points[match.point].variance_m2) + sigma * sigma);
      Vector6 j;
      j << n, (x - centre).cross(n);
      H.selfadjointView<Eigen::Lower>().rankUpdate(j, w);
      g += (w * r) * j;
    }
    const Matrix6 lower = H;
    H = lower.selfadjointView<Eigen::Lower>();
    const Vector6 step = solve(H, g);
    if (!step.allFinite()) {
      result.verdict = RegistrationVerdict::diverged;
      return result;
    }
    const Eigen::Quaterniond turn = so3::exp(step.tail<3>());
    T.linear() = (turn * Eigen::Quaterniond(T.linear())).normalized().toRotationMatrix();
    T.translation() = centre + step.head<3>();

    const Eigen::Isometry3d moved = prior.inverse(Eigen::Isometry) * T;
    if (moved.translation().norm() > params_.correction_max_m ||
        Eigen::AngleAxisd(moved.linear()).angle() > params_.correction_max_rad) {
      result.verdict = RegistrationVerdict::diverged;
      return result;
    }
    const double m = step.head<3>().norm(), rad = step.tail<3>().norm();
    if (0.5 * (m + last_m) < params_.step_m && 0.5 * (rad + last_rad) < params_.step_rad) break;
    last_m = m;
    last_rad = rad;
  }
  result.T = T;
  result.verdict = RegistrationVerdict::converged;
  return result;
}

}  // namespace tumble::baselines
