// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "unknowns.hpp"

namespace tumble {

namespace u = mapping::unknowns;

namespace {

// edge length of a cube in which the residuals of lidar returns are assumed correlated
constexpr double kCluster_m = 1.0;

constexpr int kRigid = Registration::kMotionSize;
constexpr float kRounding = 1.0001f;

constexpr std::size_t partial_sum_count(std::size_t points, std::size_t block) {
  return (points + block - 1) / block;
}

void run_parallel(const ParallelFor& parallel_for, std::size_t count, const std::function<void(std::size_t)>& body) {
  if (parallel_for && count > 1) {
    parallel_for(count, body);
  } else {
    for (std::size_t i = 0; i < count; ++i) body(i);
  }
}

class PointMotion {
 public:
  PointMotion(const SweepTrajectory& trajectory, const LidarImuCalibration& calibration, const SweepPoint& point,
              std::size_t& hint);

  /// Computes the derivative of the lidar point's position along `direction_W` with respect to the 28 unknowns of the
  /// registration: mapping.md (R17).
  void derivative_along_normal(const Eigen::Vector3d& direction_W, RegistrationUnknowns::Vector& derivative) const;

  /// Returns the lever vector u of the lidar return in world axes, which is the sum of the displacement S and the
  /// vector from the IMU to the lidar return: mapping.md (R3).
  const Eigen::Vector3d& lever_m() const { return lever_arm_; }

 private:
  double t_s_;
  bool clipped_;
  SweepTrajectory::PreintegratedMotion now_;
  Eigen::Vector3d rotated_point_, lever_arm_, point_from_lidar_I_, velocity_m_s_;
  SweepTrajectory::SaturationDeficitJacobian saturation_deficit_jacobian_;  // used if an axis of the gyro is clipped
};

PointMotion::PointMotion(const SweepTrajectory& trajectory, const LidarImuCalibration& calibration,
                         const SweepPoint& point, std::size_t& hint)
    : t_s_(point.t_s), clipped_(trajectory.clipped_axes() != 0) {
  const Eigen::Vector3d x_I = point.x_I_m.cast<double>();
  now_ = trajectory.at(t_s_, x_I, hint, velocity_m_s_);
  rotated_point_ = now_.q_WI * x_I;
  lever_arm_ = now_.preintegrated_position_m + rotated_point_;
  point_from_lidar_I_ = x_I - calibration.T_IL.translation();
  if (clipped_) saturation_deficit_jacobian_ = trajectory.saturation_deficit_jacobian(t_s_, hint);
}

void PointMotion::derivative_along_normal(const Eigen::Vector3d& n, RegistrationUnknowns::Vector& derivative) const {
  const Eigen::Vector3d n_I = now_.q_WI.conjugate() * n;
  u::segment(derivative, u::position) = n;
  u::segment(derivative, u::attitude) = lever_arm_.cross(n);
  u::segment(derivative, u::velocity) = t_s_ * n;
  auto of_deficit = u::segment(derivative, u::deficit);
  if (clipped_) {
    of_deficit = saturation_deficit_jacobian_.position_jacobian_m_s.transpose() * n +
                 saturation_deficit_jacobian_.attitude_by_deficit_s.transpose() * rotated_point_.cross(n);
  } else {
    of_deficit.setZero();
  }
  u::segment(derivative, u::calibration) << point_from_lidar_I_.cross(n_I), n_I, n.dot(velocity_m_s_),
      (0.5 * t_s_ * t_s_) * n;
}

}  // namespace

Registration::Unknowns::Unknowns(const Matrix& covariance) {
  for (int i = 0; i < kUnknowns; ++i) {
    if (i >= kRigid && covariance(i, i) <= 0.0) continue;
    free_unknowns[static_cast<std::size_t>(count++)] = i;
    deficit_free = deficit_free || (i >= kFirstDeficitUnknown && i < kFirstCalibrationUnknown);
    calibration_free = calibration_free || i >= kFirstCalibrationUnknown;
  }
}

void Registration::Unknowns::expand_to_all_unknowns(const Sums& sum, Matrix& H, Vector& g) const {
  H.setZero();
  g.setZero();
  for (int a = 0; a < count; ++a) {
    const int i = free_unknowns[static_cast<std::size_t>(a)];
    g[i] = sum.gradient[a];
    for (int b = 0; b < count; ++b) H(i, free_unknowns[static_cast<std::size_t>(b)]) = sum.normal_matrix(a, b);
  }
}

void Registration::Unknowns::fix_constrained_unknowns(Matrix& H, Vector& g) const {
  for (int i = 0; i < kUnknowns; ++i) {
    if (is_free_unknown(i)) continue;
    H.row(i).setZero();
    H.col(i).setZero();
    H(i, i) = 1.0;
    g[i] = 0.0;
  }
}

void Registration::Unknowns::clear_fixed_blocks(Matrix& M) const {
  for (int i = 0; i < kUnknowns; ++i) {
    if (is_free_unknown(i)) continue;
    M.row(i).setZero();
    M.col(i).setZero();
  }
}

void Registration::Unknowns::clear_fixed(Matrix& covariance) const {
  for (int i = 0; i < kUnknowns; ++i) {
    if (!is_free_unknown(i)) covariance(i, i) = 0.0;
  }
}

void Registration::Sums::add(const Sums& other) {
  normal_matrix += other.normal_matrix;
  gradient += other.gradient;
  matches += other.matches;
  inliers += other.inliers;
}

/// Returns the variance of a lidar return due to range noise and deskewing: the first two terms of mapping.md (R18).
double Registration::point_variance_m2(const SweepPoint& point) const {
  const double range = std::max(params_.kRangeSigma_m, params_.kRangeSigmaRatio * point.range_m);
  const double skew = params_.skew_sigma_m_s * point.sweep_time_s;
  return range * range + skew * skew;
}

/// See mapping.md (R16), (R17).
double Registration::residual(const SweepTrajectory& trajectory, const LidarImuCalibration& calibration,
                              const SweepPoint& point, const PlaneFit& plane, std::size_t& hint, Vector& derivative) {
  const Eigen::Vector3d n = plane.normal_W.cast<double>();
  const PointMotion motion(trajectory, calibration, point, hint);
  motion.derivative_along_normal(n, derivative);
  return n.dot(trajectory.gravity_free_position_m(point.t_s) + motion.lever_m() -
               plane.plane_centre_W_m.cast<double>());
}

void Registration::find_match(const VoxelMap& map, std::size_t point, NearestNeighbours& found) {
  Match& match = matches_[point];
  const float rematch2 = static_cast<float>(params_.expert.rematch_m * params_.expert.rematch_m);
  float radius_m = static_cast<float>(params_.match_distance_m);
  if (match.plane_searched) {
    const float moved2 = (positions_[point] - match.search_position_W_m).squaredNorm();
    if (moved2 <= rematch2) return;
    // The search for neighbours of a moved point uses a sphere around the point. The sphere is large enough if the
    // sphere contains all neighbours that the previous search found.
    radius_m = std::min(radius_m, kRounding * (match.farthest_neighbour_m + std::sqrt(moved2)));
  }
  match.plane_searched = true;
  match.search_position_W_m = positions_[point];
  map.nearest(positions_[point], params_.neighbours, radius_m, found);
  match.farthest_neighbour_m = found.count == params_.neighbours ? std::sqrt(found.distance2_m2[found.count - 1])
                                                                 : std::numeric_limits<float>::infinity();
  match.plane = fit_plane(map, found, params_.expert.plane);
  if (match.plane.verdict != PlaneVerdict::plane) return;
  float variance = 0.0f;
  for (int k = 0; k < found.count; ++k) {
    const float sigma = map.sigma_m(found.index[k]);
    variance += sigma * sigma;
  }
  // variance of the matched map points: last terms of mapping.md (R18)
  match.map_variance_m2 = variance / static_cast<float>(found.count) + match.plane.thickness_variance_m2;
}

/// See mapping.md (R19), (R21), and Geman and McClure (1987) for the robust weight.
Registration::Weight Registration::compute_weight(const SweepPoint& point, const Match& match, double distance_m,
                                                  double kernel_m) const {
  const double variance = point_variance_m2(point) + match.map_variance_m2;
  const double soft = 1.0 + distance_m * distance_m / (kernel_m * kernel_m);
  const double robust = 1.0 / (soft * soft);
  return {variance, robust, robust * params_.expert.correlation_discount / variance};
}

/// See mapping.md (R3), (R16).
void Registration::match_points(const SweepTrajectory& trajectory, std::span<const SweepPoint> points,
                                const VoxelMap& map) {
  lever_arm_vectors_.resize(points.size());
  positions_.resize(points.size());
  residual_distances_m_.resize(points.size());
  run_parallel(params_.parallel_for, partial_sum_count(points.size(), kPointsPerPartialSum), [&](std::size_t block) {
    NearestNeighbours found;
    const std::size_t begin = block * kPointsPerPartialSum,
                      end = std::min(points.size(), (block + 1) * kPointsPerPartialSum);
    trajectory.lever_arm_vectors(points.subspan(begin, end - begin),
                                 std::span(lever_arm_vectors_).subspan(begin, end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      positions_[i] =
          (trajectory.gravity_free_position_m(points[i].t_s) + lever_arm_vectors_[i].cast<double>()).cast<float>();
      find_match(map, i, found);
      residual_distances_m_[i] = matches_[i].plane.normal_W.dot(positions_[i] - matches_[i].plane.plane_centre_W_m);
    }
  });
}

/// See mapping.md (R20).
double Registration::kernel_width_m() {
  sorted_distances_.clear();
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    if (matches_[i].plane.verdict == PlaneVerdict::plane)
      sorted_distances_.push_back(std::abs(residual_distances_m_[i]));
  }
  if (sorted_distances_.empty()) return params_.expert.kernel_min_m;
  const auto middle = sorted_distances_.begin() + static_cast<std::ptrdiff_t>(sorted_distances_.size() / 2);
  std::nth_element(sorted_distances_.begin(), middle, sorted_distances_.end());
  // For a normal distribution, the median absolute value times 1.4826 is the standard deviation, so the kernel width is
  // three standard deviations.
  return std::max(params_.expert.kernel_min_m, 3.0 * 1.4826 * static_cast<double>(*middle));
}

/// See mapping.md (R23).
void Registration::accumulate_block(std::span<const SweepPoint> points, std::size_t block,
                                    const SweepTrajectory& trajectory, const LidarImuCalibration& calibration,
                                    const Unknowns& unknowns, double kernel_m, Sums& sum) {
  // Each column of `rows` contains the derivatives of a matched point's distance from its plane, times the square root
  // of the match's weight.
  constexpr int kPoints = kPointsPerPartialSum;
  Eigen::Matrix<double, kUnknowns, kPoints> rows;
  Eigen::Matrix<double, kPoints, 1> weighted;
  const bool rigid = !unknowns.deficit_free && !unknowns.calibration_free;
  std::size_t hint = 0;
  int count = 0;
  const std::size_t end = std::min(points.size(), (block + 1) * kPointsPerPartialSum);
  for (std::size_t i = block * kPointsPerPartialSum; i < end; ++i) {
    const Match& match = matches_[i];
    if (match.plane.verdict != PlaneVerdict::plane) continue;
    const double r = residual_distances_m_[i];
    const Weight weight = compute_weight(points[i], match, r, kernel_m);
    const double root = std::sqrt(weight.information);
    const Eigen::Vector3d n = match.plane.normal_W.cast<double>();
    const Eigen::Vector3d lever = lever_arm_vectors_[i].cast<double>();
    Eigen::Matrix<double, kRigid, 1> j;
    j << n, lever.cross(n), static_cast<double>(points[i].t_s) * n;
    if (rigid) {
      rows.col(count).head<kRigid>() = root * j;
    } else {
      Vector full;
      PointMotion(trajectory, calibration, points[i], hint).derivative_along_normal(n, full);
      for (int k = 0; k < unknowns.count; ++k) {
        rows(k, count) = root * full[unknowns.free_unknowns[static_cast<std::size_t>(k)]];
      }
    }
    weighted[count++] = root * r;
    ++sum.matches;
    if (r * r <= 9.0 * weight.variance_m2) ++sum.inliers;
  }
  const int n = unknowns.count;
  sum.normal_matrix.topLeftCorner(n, n).selfadjointView<Eigen::Lower>().rankUpdate(rows.topLeftCorner(n, count));
  sum.gradient.head(n) = rows.topLeftCorner(n, count) * weighted.head(count);
}

void Registration::accumulate(std::span<const SweepPoint> points, const SweepTrajectory& trajectory,
                              const LidarImuCalibration& calibration, const Unknowns& unknowns, double kernel_m,
                              Sums& sum) {
  partial_sums_.assign(partial_sum_count(points.size(), kPointsPerPartialSum), Sums{});
  run_parallel(params_.parallel_for, partial_sums_.size(), [&](std::size_t block) {
    accumulate_block(points, block, trajectory, calibration, unknowns, kernel_m, partial_sums_[block]);
  });
  sum = Sums{};
  for (const Sums& part : partial_sums_) sum.add(part);
  const Matrix lower = sum.normal_matrix;
  sum.normal_matrix = lower.selfadjointView<Eigen::Lower>();
}

/// SurfaceNormalNoise is the part of the registration's normal matrix H that results from errors of the surface
/// normals: mapping.md (R28), (R29). Errors of the surface normals add false information, even in directions of motion
/// that the surfaces do not constrain.
struct Registration::SurfaceNormalNoise {
  const Unknowns& unknowns;
  // The matrix `columns` and the buffers of rankUpdate() are on the heap.
  Eigen::Matrix<double, kUnknowns, Eigen::Dynamic> columns{kUnknowns, 2 * static_cast<int>(kPointsPerPartialSum)};
  int count = 0;
  Matrix lower = Matrix::Zero();

  explicit SurfaceNormalNoise(const Unknowns& of) : unknowns(of) {}

  void add(const PointMotion& motion, const PlaneFit& plane, double root) {
    for (int axis = 0; axis < 2; ++axis) {
      Vector derivative;
      motion.derivative_along_normal(plane.normal_sigma_W.col(axis).cast<double>(), derivative);
      for (int k = 0; k < unknowns.count; ++k)
        columns(k, count) = root * derivative[unknowns.free_unknowns[static_cast<std::size_t>(k)]];
      ++count;
    }
    if (count == columns.cols()) sum_up();
  }

  void sum_up() {
    const int n = unknowns.count;
    lower.topLeftCorner(n, n).selfadjointView<Eigen::Lower>().rankUpdate(columns.topLeftCorner(n, count));
    count = 0;
  }

  Matrix information() {
    sum_up();
    Matrix out = Matrix::Zero();
    for (int a = 0; a < unknowns.count; ++a) {
      for (int b = 0; b < unknowns.count; ++b)
        out(unknowns.free_unknowns[static_cast<std::size_t>(a)], unknowns.free_unknowns[static_cast<std::size_t>(b)]) =
            lower(std::max(a, b), std::min(a, b));
    }
    return out;
  }
};

/// ClusterGradients sums the cost gradients of the lidar returns in each cube of the map, because residuals of nearby
/// returns are correlated. The sums of all cubes give the covariance of the whole gradient: mapping.md (R26).
struct Registration::ClusterGradients {
  SpatialHash& cluster_index;
  std::vector<Vector>& gradients;
  float cubes_per_m;

  void add(const PointMotion& motion, const PlaneFit& plane, const Eigen::Vector3f& position_W_m, double weighted_m) {
    const Eigen::Vector3f cube = (position_W_m * cubes_per_m).array().floor();
    if (!(cube.cwiseAbs().maxCoeff() < static_cast<float>(SpatialHash::kCoordinateLimit - 2))) return;
    const std::uint32_t cluster =
        cluster_index.insert(SpatialHash::key(cube.cast<int>()), static_cast<std::uint32_t>(gradients.size()));
    if (cluster == gradients.size()) gradients.emplace_back(Vector::Zero());
    Vector derivative;
    motion.derivative_along_normal(plane.normal_W.cast<double>(), derivative);
    gradients[cluster] += weighted_m * derivative;
  }

  Matrix covariance(const Unknowns& unknowns) const {
    Matrix lower = Matrix::Zero();
    for (const Vector& pull : gradients) lower.selfadjointView<Eigen::Lower>().rankUpdate(pull);
    Matrix out = lower.selfadjointView<Eigen::Lower>();
    unknowns.clear_fixed_blocks(out);
    return out;
  }
};

void Registration::compute_error_statistics(std::span<const SweepPoint> points, const SweepTrajectory& trajectory,
                                            const LidarImuCalibration& calibration, const Unknowns& unknowns,
                                            double kernel_m, Result& result) {
  point_cluster_index_.clear();
  point_cluster_gradients_.clear();
  SurfaceNormalNoise noise(unknowns);
  ClusterGradients pulls{point_cluster_index_, point_cluster_gradients_, static_cast<float>(1.0 / kCluster_m)};
  std::size_t hint = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Match& match = matches_[i];
    if (match.plane.verdict != PlaneVerdict::plane) continue;
    const double r = residual_distances_m_[i];
    const double information = compute_weight(points[i], match, r, kernel_m).information;
    const PointMotion motion(trajectory, calibration, points[i], hint);
    noise.add(motion, match.plane, std::sqrt(information));
    pulls.add(motion, match.plane, positions_[i], information * r);
  }
  result.surface_normal_noise_information = noise.information();
  result.score_covariance = pulls.covariance(unknowns);
}

}  // namespace tumble
