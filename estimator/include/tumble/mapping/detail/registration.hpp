// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/detail/registration_params.hpp"
#include "tumble/mapping/detail/registration_result.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"

namespace tumble {

namespace mapping {
template <int Rows, int Columns>
class OuterProducts;
}  // namespace mapping

/// Registers a sweep to a map by point-to-plane distances, and estimates the motion within the sweep:
/// docs/maths/mapping.md.
///
/// The unknowns are position, attitude and velocity of the IMU at the start of the trajectory. The saturation deficit
/// (true rate minus clipped reading) and the calibration are additional unknowns if their prior is uncertain. Each
/// Gauss-Newton iteration deskews the points with the current estimate. The cost is the sum of robustly weighted
/// squared distances to planes through the nearest map points, and the squared Mahalanobis distance from the prior. The
/// prior determines the directions that no surface constrains.
class Registration {
  static constexpr std::size_t kPointsPerPartialSum =
      128;  // points per partial sum; independent of the number of threads

 public:
  using Params = RegistrationParams;
  using Result = RegistrationResult;
  using Estimate = RegistrationUnknowns::Estimate;
  using Prior = RegistrationUnknowns::Prior;
  using Vector = RegistrationUnknowns::Vector;
  using Matrix = RegistrationUnknowns::Matrix;
  static constexpr int kMotionSize = RegistrationUnknowns::kMotionSize;
  static constexpr int kFirstDeficitUnknown = RegistrationUnknowns::kFirstDeficitUnknown;
  static constexpr int kFirstCalibrationUnknown = RegistrationUnknowns::kFirstCalibrationUnknown;
  static constexpr int kUnknowns = RegistrationUnknowns::kUnknowns;

  explicit Registration(const Params& params);

  /// Aligns the points of a sweep to a map. `points` must have been computed with the calibration of `prior`.
  /// `trajectory` is rebuilt from `prior` and `samples` up to `end_ns`, and contains the aligned motion. Returns `ok`
  /// or an error of SweepTrajectory::build().
  Status align(const Prior& prior, std::span<const MotionSample> samples, TimeNs end_ns,
               std::span<const SweepPoint> points, const VoxelMap& map, SweepTrajectory& trajectory, Result& result);

  /// Returns the variance of a lidar return along its ray, including the motion distortion that remains after
  /// deskewing.
  double point_variance_m2(const SweepPoint& point) const;

  /// Computes the distance of a point from a plane, and its derivatives with respect to all unknowns. Public for tests.
  static double residual(const SweepTrajectory& trajectory, const LidarImuCalibration& calibration,
                         const SweepPoint& point, const PlaneFit& plane, std::size_t& hint, Vector& derivative);

 private:
  struct Match {
    PlaneFit plane;
    Eigen::Vector3f search_position_W_m = Eigen::Vector3f::Zero();
    float map_variance_m2 = 0.0f;
    float farthest_neighbour_m =
        std::numeric_limits<float>::infinity();  // distance to the farthest neighbour, if all neighbours were found
    bool plane_searched = false;
  };
  /// normal equations of the estimated unknowns, summed over the matches of one iteration
  struct Sums {
    Matrix normal_matrix = Matrix::Zero();
    Vector gradient = Vector::Zero();
    std::size_t matches = 0, inliers = 0;

    void add(const Sums& other);
  };
  using Products = mapping::OuterProducts<kUnknowns, int{kPointsPerPartialSum}>;
  struct Unknowns;
  struct RegistrationProblem;
  struct IterationState;

  Status iterate(const RegistrationProblem& problem, IterationState& at, SweepTrajectory& trajectory, Result& result);
  RegistrationVerdict registration_verdict(const RegistrationProblem& problem, const IterationState& at) const;
  Status finalise(const RegistrationProblem& problem, const IterationState& at, SweepTrajectory& trajectory,
                  Result& result);
  void match_points(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, const VoxelMap& map);
  void find_match(const VoxelMap& map, std::size_t point, NearestNeighbours& found);
  double kernel_width_m();
  void compute_eigenvalues(std::span<const SweepPoint> points, double kernel_m, const Sums& sum, Result& result) const;
  void accumulate(std::span<const SweepPoint> points, const SweepTrajectory& trajectory,
                  const LidarImuCalibration& calibration, const Unknowns& unknowns, double kernel_m, Sums& sum);
  void accumulate_block(std::span<const SweepPoint> points, std::size_t block, const SweepTrajectory& trajectory,
                        const LidarImuCalibration& calibration, const Unknowns& unknowns, double kernel_m,
                        Products& products, Sums& sum);

  struct SurfaceNormalNoise;
  struct ClusterGradients;
  void compute_error_statistics(std::span<const SweepPoint> points, const SweepTrajectory& trajectory,
                                const LidarImuCalibration& calibration, const Unknowns& unknowns, double kernel_m,
                                Result& result);
  struct Weight {
    double variance_m2, robust, information;
  };
  Weight compute_weight(const SweepPoint& point, const Match& match, double distance_m, double kernel_m) const;

  Params params_;
  // buffers, which do not influence results
  std::vector<Eigen::Vector3f> lever_arm_vectors_, positions_;
  std::vector<SweepPoint> transformed_points_;
  std::vector<Match> matches_;
  std::vector<float> residual_distances_m_, sorted_distances_;
  std::vector<Sums> partial_sums_;  // one per block of points
  SpatialHash point_cluster_index_{1 << 10};
  std::vector<Vector> point_cluster_gradients_;  // gradients of the point clusters
};

}  // namespace tumble
