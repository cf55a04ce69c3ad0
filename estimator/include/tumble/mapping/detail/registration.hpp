// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/detail/plane_fit.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/detail/voxel_map.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Unknowns of the registration in this order: position, attitude (left perturbation in world axes) and velocity of the
/// IMU at the start of the trajectory, saturation deficit of the gyro, LidarImuCalibration.
struct RegistrationUnknowns {
  static constexpr int kMotionSize = 9;
  static constexpr int kFirstDeficitUnknown = kMotionSize;  ///< saturation deficit, one support point after another
  static constexpr int kFirstCalibrationUnknown =
      kFirstDeficitUnknown + SweepTrajectory::kDeficitUnknowns;  ///< LidarImuCalibration
  static constexpr int kUnknowns = kFirstCalibrationUnknown + LidarImuCalibration::kErrorCount;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Deficit = SweepTrajectory::Deficit;

  struct Estimate {
    MotionState state;  ///< the covariance is not used
    LidarImuCalibration calibration;
    Deficit saturation_deficit_rad_s = Deficit::Zero();

    void add(const Vector& error);
    /// Returns the difference between this estimate and `other`, in the order of the unknowns.
    Vector minus(const Estimate& other) const;
  };

  /// Prior distribution of the registration's unknowns, from the inertial prediction. A saturation deficit or
  /// calibration value with variance 0 is not estimated.
  struct Prior {
    Estimate mean;
    Matrix covariance = Matrix::Zero();
    Deficit initial_saturation_deficit_rad_s = Deficit::Zero();  ///< value in the first iteration
    std::optional<MotionState> start;                            ///< motion in the first iteration; empty: the mean

    Prior() = default;
    /// Prior without estimation of saturation deficit and calibration.
    explicit Prior(const MotionState& state) : mean{state, {}, Deficit::Zero()} {
      covariance.topLeftCorner<kMotionSize, kMotionSize>() = state.covariance;
    }
  };
};

/// Values that the calling estimator sets; they are not parameters for users.
struct RegistrationExpertParams {
  int iterations_max = 30;
  std::size_t matches_min = 100;
  double correction_max_m = 15.0;  ///< a larger correction of the predicted pose is rejected
  double correction_max_rad = 1.1;
  double step_m = 5e-4;  ///< converged if a step is below `step_m` and `step_rad`
  double step_rad = 1e-4;
  double step_s = 1e-5;
  double rematch_m = 0.05;    ///< the plane of a point is searched again after a motion of the point by this distance
  double kernel_min_m = 0.1;  ///< minimum width of the robust kernel (Geman-McClure)
  /// weight of the information of one point; below 1, because errors of neighbouring returns are correlated
  double correlation_discount = 0.1;
  /// Minimum number of matches for a registration that agrees with the prior. Other registrations need `matches_min`
  /// matches, and matches for a tenth of the points. The large default disables this exception.
  std::size_t agreeing_matches_needed = 1'000'000'000;
  /// minimum fraction of matched points within three standard deviations of their plane
  double inlier_ratio_min = 0.6;
  PlaneFitBounds plane;
};

struct RegistrationParams {
  static constexpr double kMatchDistanceMax_m = 10.0;
  int neighbours = 8;
  double match_distance_m = 1.0;
  static constexpr double kRangeSigma_m =
      0.02;  ///< the standard deviation of a range is max(kRangeSigma_m, kRangeSigmaRatio * range)
  static constexpr double kRangeSigmaRatio = 0.0015;
  double skew_sigma_m_s =
      0.25;  ///< growth rate of a point's standard deviation during the sweep, for errors of the deskewing
  ParallelFor parallel_for;  ///< runs neighbour search and sums on threads of the caller; empty: on the calling thread

  using Expert = RegistrationExpertParams;
  Expert expert = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.neighbours,
          {"neighbours", "1", 3, 32, "number of map points used for each plane fit", ParameterAudience::common_use});
    visit(p.match_distance_m,
          {"match_distance_m", "m", 1e-3, kMatchDistanceMax_m,
           "maximum distance between a point and its matches in the map", ParameterAudience::common_use});
    visit(p.skew_sigma_m_s,
          {"skew_sigma_m_s", "m/s", 0.0, 1e3,
           "growth of a point's standard deviation with the time since the start of the sweep; 0: no growth"});
  }
};

enum class RegistrationVerdict : std::uint8_t {
  converged,
  too_few_matches,  ///< the result is the prior
  diverged,         ///< no convergence, too large a correction, or too few inliers; the result is the prior
};

struct RegistrationResult {
  RegistrationVerdict verdict = RegistrationVerdict::too_few_matches;
  RegistrationUnknowns::Estimate mean;
  RegistrationUnknowns::Matrix covariance = RegistrationUnknowns::Matrix::Zero();
  /// Covariance of the cost gradient with respect to the unknowns, measured from the point-to-plane residuals
  /// (cluster-robust covariance, Liang and Zeger, 1986). Points within a cube of 1 m have correlated errors, because
  /// they share errors of the map. If all points were independent, the covariance would equal correlation_discount
  /// times the points' contribution to the normal matrix.
  RegistrationUnknowns::Matrix score_covariance = RegistrationUnknowns::Matrix::Zero();
  /// Part of the information in the normal equations that results only from noise of the fitted plane normals. Source:
  /// errors in variables (Fuller, Measurement Error Models, 1987, section 2.2).
  RegistrationUnknowns::Matrix surface_normal_noise_information = RegistrationUnknowns::Matrix::Zero();
  std::size_t points = 0, matches = 0, inliers = 0;
  double correction_m =
      0.0;  ///< correction of the position at the start of the trajectory, even if rejected as too large
  double correction_rad = 0.0;
  int iterations = 0;
  /// Ascending eigenvalues and eigenvectors (columns) of the information matrix of the pose from the lidar points,
  /// without the prior. The attitude is scaled to metres by the root-mean-square distance of the points. The matrix is
  /// scaled so that its translation part has trace 1.
  Eigen::Matrix<double, 6, 1> eigenvalues = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> directions = Eigen::Matrix<double, 6, 6>::Identity();
  /// Standard deviation of the pose in its least constrained direction, without the inertial prediction.
  double least_constrained_sigma_m = std::numeric_limits<double>::infinity();
};

/// Registers a sweep to a map by point-to-plane distances, and estimates the motion within the sweep:
/// docs/maths/mapping.md.
///
/// The unknowns are position, attitude and velocity of the IMU at the start of the trajectory. Additional unknowns with
/// an uncertain prior are the saturation deficit (true minus estimated rate), pose and time offset of the lidar, and
/// gravity. Each Gauss-Newton iteration deskews the points with the current estimate. The cost is the sum of robustly
/// weighted squared distances to planes through the nearest map points, plus the squared Mahalanobis distance from the
/// prior (inertial prediction).
class Registration {
  static constexpr std::size_t kPointsPerPartialSum =
      128;  // number of points per partial sum; fixed, so that sums do not depend on the number of threads

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

  /// Aligns the points of a sweep to a map. `points` must be computed with the lidar calibration in `prior`.
  /// `trajectory` receives the aligned motion from the start of `prior` to `end_ns`. Returns `ok` or an error of
  /// SweepTrajectory::build().
  Status align(const Prior& prior, std::span<const MotionSample> samples, TimeNs end_ns,
               std::span<const SweepPoint> points, const VoxelMap& map, SweepTrajectory& trajectory, Result& result);

  /// Returns the variance of a lidar return, including the motion distortion that remains after deskewing.
  double point_variance_m2(const SweepPoint& point) const;

  /// Computes the distance of a lidar point from a plane, and the derivatives of this distance with respect to all
  /// unknowns. Public for tests.
  static double residual(const SweepTrajectory& trajectory, const LidarImuCalibration& calibration,
                         const SweepPoint& point, const PlaneFit& plane, std::size_t& hint, Vector& derivative);

 private:
  struct Match {
    PlaneFit plane;
    Eigen::Vector3f search_position_W_m = Eigen::Vector3f::Zero();
    float map_variance_m2 = 0.0f;
    float farthest_neighbour_m = std::numeric_limits<float>::infinity();  // distance to the farthest neighbour;
                                                                          // infinite if too few neighbours were found
    bool plane_searched = false;
  };
  /// Normal equations of the estimated unknowns, summed over the matches of one iteration.
  struct Sums {
    Matrix normal_matrix = Matrix::Zero();
    Vector gradient = Vector::Zero();
    std::size_t matches = 0, inliers = 0;

    void add(const Sums& other);
  };
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
                        const LidarImuCalibration& calibration, const Unknowns& unknowns, double kernel_m, Sums& sum);

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
  std::vector<Sums> partial_sums_;
  SpatialHash point_cluster_index_{1 << 10};
  std::vector<Vector> point_cluster_gradients_;
};

}  // namespace tumble
