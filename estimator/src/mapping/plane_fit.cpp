// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/plane_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

int max_points_on_line(const VoxelMap& map, const NearestNeighbours& neighbours) {
  std::array<std::uint32_t, NearestNeighbours::kMaxNeighbours> line;
  for (int i = 0; i < neighbours.count; ++i) line[i] = map.line(neighbours.index[i]);
  int most = 1;
  for (int i = 0; i < neighbours.count; ++i) {
    if (line[i] == VoxelMap::kUnknownScanLine) continue;
    int same = 0;
    for (int j = i; j < neighbours.count; ++j) same += line[j] == line[i];
    most = std::max(most, same);
  }
  return most;
}

}  // namespace

PlaneFit fit_plane(const VoxelMap& map, const NearestNeighbours& neighbours, const PlaneFitBounds& bounds) {
  PlaneFit fit;
  const int n = neighbours.count;
  if (n < bounds.neighbours_min || n < 3) return fit;

  if (n - max_points_on_line(map, neighbours) < bounds.off_line_neighbours_min) {
    fit.verdict = PlaneVerdict::one_scan_line;
    return fit;
  }

  // The plane fit uses positions relative to the nearest map point. Relative positions are small, so rounding errors of
  // single-precision numbers are small even far from the origin.
  const Eigen::Vector3f origin = map.position_W_m(neighbours.index[0]);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f square = Eigen::Matrix3f::Zero();
  for (int i = 1; i < n; ++i) {
    const Eigen::Vector3f d = map.position_W_m(neighbours.index[i]) - origin;
    sum += d;
    square(0, 0) += d.x() * d.x();
    square(1, 0) += d.y() * d.x();
    square(2, 0) += d.z() * d.x();
    square(1, 1) += d.y() * d.y();
    square(2, 1) += d.z() * d.y();
    square(2, 2) += d.z() * d.z();
  }
  const float share = 1.0f / static_cast<float>(n);
  const Eigen::Vector3d mean = (sum * share).cast<double>();
  const Eigen::Matrix3f lower = square * share;
  const Eigen::Matrix3d second = lower.selfadjointView<Eigen::Lower>().toDenseMatrix().cast<double>();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(second - mean * mean.transpose());
  const Eigen::Vector3d l = solver.eigenvalues().cwiseMax(0.0);

  fit.plane_centre_W_m = origin + mean.cast<float>();
  fit.thickness_variance_m2 = static_cast<float>(l[0]);
  if (!(l[1] >= bounds.collinear_ratio_max * l[2]) || !(l[2] > 0.0)) {
    fit.verdict = PlaneVerdict::collinear;
    return fit;
  }
  // The plane fit estimates three parameters from n points, which leaves n - 3 degrees of freedom: mapping.md (R27).
  const double noise2 = l[0] / std::max(n - 3, 1);
  for (int axis = 0; axis < 2; ++axis) {
    fit.normal_sigma_W.col(axis) =
        (std::sqrt(noise2 / l[axis + 1]) * solver.eigenvectors().col(axis + 1)).cast<float>();
  }
  fit.normal_W = solver.eigenvectors().col(0).cast<float>().normalized();
  fit.verdict = l[0] > bounds.rough_share * l[1] ? PlaneVerdict::plane_too_thick : PlaneVerdict::plane;
  return fit;
}

}  // namespace tumble
