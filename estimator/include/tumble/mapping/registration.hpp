// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/deskew.hpp"
#include "tumble/mapping/executor.hpp"
#include "tumble/mapping/plane_fit.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble {

/// How a registration ended.
enum class RegistrationVerdict : std::uint8_t {
  converged,
  too_few,   ///< matches below the bound: the prior is returned
  diverged,  ///< iterations ran out, the correction of the prior is beyond the bound, or most matches do not fit:
             ///< the prior is returned
};

/// Registers a sweep to a map by point-to-plane distances, together with the motion inside the sweep.
///
/// Unknowns: position, attitude (left perturbation in W) and velocity of the IMU at the start of the trajectory, and,
/// where their prior leaves them free, the saturation deficit of clipped axes and the calibration. A point in the world
/// is X = p + v t + g t^2/2 + Exp(phi) u with the lever u of SweepTrajectory, so that each iteration deskews anew.
/// Cost: robustly weighted squared distances to planes through the k nearest map points, plus the prior's Mahalanobis
/// distance; Gauss-Newton, a 28x28 normal matrix at most. In directions that no surface holds the prior stands.
class Registration {
 public:
  struct Params {
    int neighbours = 8;             ///< k of the plane fit
    double match_distance_m = 1.0;  ///< farther map points are no match
    int iterations_max = 30;
    double step_m = 5e-4;  ///< converged when a step is below this and below step_rad
    double step_rad = 1e-4;
    double rematch_m = 0.05;      ///< a point's plane is searched anew once the point has moved by this
    double range_sigma_m = 0.02;  ///< of a return, at least; grows as range_sigma_share of the range
    double range_sigma_share = 0.0015;
    double skew_sigma_m_s = 0.25;  ///< growth of a point's uncertainty over the sweep (time weighting); 0: none
    double kernel_min_m = 0.1;     ///< least width of the robust kernel (Geman-McClure)
    /// Weight of a point's information: neighbouring returns share the errors of the map and are not independent.
    double correlation_discount = 0.1;
    double cluster_m = 1.0;          ///< points of one cube of this edge are not independent
    std::size_t matches_min = 100;   ///< fewer matches are too few
    double matched_share_min = 0.1;  ///< of the points
    double fitting_share_min =
        0.6;  ///< of the matches within three standard deviations; below it the result is refused
    double correction_max_m = 15.0;
    double correction_max_rad = 1.1;
    PlaneBounds plane;
    ParallelFor parallel_for;  ///< for the search of neighbours and the sums; empty: the calling thread

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.neighbours, {"neighbours", "1", 3, 32, "map points per plane fit", Rank::first});
      visit(p.match_distance_m, {"match_distance_m", "m", 1e-3, 10.0, "farther map points are no match", Rank::first});
      visit(p.iterations_max, {"iterations_max", "1", 1, 200, "most iterations"});
      visit(p.step_m, {"step_m", "m", 1e-12, 1.0, "converged when a step is below this and its turn below step_rad"});
      visit(p.step_rad, {"step_rad", "rad", 1e-12, 1.0, "converged when a step turns by less"});
      visit(p.rematch_m,
            {"rematch_m", "m", 0.0, 10.0, "a point's plane is searched anew once the point has moved by this"});
      visit(p.range_sigma_m, {"range_sigma_m", "m", 1e-6, 10.0, "of a return, at least"});
      visit(p.range_sigma_share, {"range_sigma_share", "1", 0.0, 1.0, "of a return, as a share of its range"});
      visit(p.skew_sigma_m_s, {"skew_sigma_m_s", "m/s", 0.0, 1e3,
                               "growth of a point's uncertainty over the sweep (time weighting); 0: none"});
      visit(p.kernel_min_m, {"kernel_min_m", "m", 1e-6, 1e3, "least width of the robust kernel (Geman-McClure)"});
      visit(p.correlation_discount, {"correlation_discount", "1", 1e-6, 1.0,
                                     "weight of a point's information: neighbouring returns are not independent"});
      visit(p.cluster_m, {"cluster_m", "m", 0.01, 100.0, "points of one cube of this edge are not independent"});
      visit(p.matches_min, {"matches_min", "1", 0, 1e9, "fewer matches are too few"});
      visit(p.matched_share_min, {"matched_share_min", "1", 0.0, 1.0, "fewer of the points matched refuse the result"});
      visit(p.fitting_share_min, {"fitting_share_min", "1", 0.0, 1.0,
                                  "fewer of the matches within three standard deviations refuse the result"});
      visit(p.correction_max_m, {"correction_max_m", "m", 0.0, 1e6, "a larger correction of the prior is refused"});
      visit(p.correction_max_rad,
            {"correction_max_rad", "rad", 0.0, 3.15, "a larger correction of the prior is refused"});
      visit.group("plane_", p.plane);
    }
  };

  static constexpr int kMotion = 9;        ///< position, attitude, velocity
  static constexpr int kExcess = kMotion;  ///< first unknown of the saturation deficit, knot after knot
  static constexpr int kCalibration = kExcess + SweepTrajectory::kExcess;  ///< first unknown of the calibration
  static constexpr int kUnknowns = kCalibration + SweepCalibration::kErrors;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Excess = SweepTrajectory::Excess;

  /// Where the unknowns stand: motion at the start of the trajectory, saturation deficit, calibration.
  struct Estimate {
    MotionState state;  ///< its covariance is not used
    SweepCalibration calibration;
    Excess excess_rad_s = Excess::Zero();

    /// Adds small errors in the order of the unknowns.
    void add(const Vector& error);
    /// The errors that take `other` to this.
    Vector minus(const Estimate& other) const;
  };

  /// What the inertial side believes, and how surely; an unknown of the excess or the calibration with variance 0 is
  /// not estimated.
  struct Prior {
    Estimate mean;
    Matrix covariance = Matrix::Zero();
    Excess excess_start_rad_s = Excess::Zero();  ///< where the iterations begin
    std::optional<MotionState> start;            ///< likewise for the motion; empty: at the mean

    Prior() = default;
    /// The state with its covariance, nothing else to be estimated.
    explicit Prior(const MotionState& state) : mean{state, {}, Excess::Zero()} {
      covariance.topLeftCorner<kMotion, kMotion>() = state.covariance;
    }
  };

  struct Result {
    RegistrationVerdict verdict = RegistrationVerdict::too_few;
    Estimate mean;
    Matrix covariance = Matrix::Zero();  ///< of all unknowns, in order; the prior's where nothing was registered
    /// Covariance of the pull of the surfaces on the unknowns (the gradient of their cost), measured from the
    /// residuals: points within cluster_m of each other share the errors of the map, those farther apart do not
    /// (cluster-robust covariance, K. Liang, S. Zeger, 1986). In units of the covariance: that of independent points
    /// would be the correlation_discount times what they add to the normal matrix.
    Matrix score_covariance = Matrix::Zero();
    /// What the normal matrix holds of noise alone, of all unknowns that are free: the normals are fitted to few
    /// points, and their errors add information in every direction of a plane (errors in variables, W. Fuller,
    /// Measurement Error Models, 1987, section 2.2). It holds the iterations where they are; it tells nothing of the
    /// motion.
    Matrix errors_in_variables_information = Matrix::Zero();
    std::size_t points = 0, matches = 0, inliers = 0;
    double correction_m = 0.0;  ///< of the position at the start; where the correction broke its bound, that value
    double correction_rad = 0.0;
    int iterations = 0;
    /// Normal matrix of (position, attitude scaled to metres at the root-mean-square lever) per unit of weight, without
    /// the prior: eigenvalues ascending, and their directions. The translation part has trace 1.
    Eigen::Matrix<double, 6, 1> eigenvalues = Eigen::Matrix<double, 6, 1>::Zero();
    Eigen::Matrix<double, 6, 6> directions = Eigen::Matrix<double, 6, 6>::Identity();
    /// Standard deviation of the pose in the direction that the surfaces hold least, from the surfaces alone and
    /// without the errors-in-variables information.
    double weakest_sigma_m = std::numeric_limits<double>::infinity();
  };

  explicit Registration(const Params& params);

  /// Aligns `points` (taken with the prior's calibration) with `map`. `trajectory` is rebuilt from `prior` and
  /// `samples` up to `end_ns` and, on return, stands for the result. Trouble of the trajectory is passed on.
  Status align(const Prior& prior, std::span<const MotionSample> samples, TimeNs end_ns,
               std::span<const SweepPoint> points, const VoxelMap& map, SweepTrajectory& trajectory, Result& result);

  /// Variance of a return along its ray together with the skew left after deskewing.
  double point_variance_m2(const SweepPoint& point) const;

  /// Distance of a point to a plane and its derivative by all unknowns, for one point. Public so that it can be checked
  /// against differences.
  static double residual(const SweepTrajectory& trajectory, const SweepCalibration& calibration,
                         const SweepPoint& point, const PlaneFit& plane, std::size_t& hint, Vector& derivative);

 private:
  struct Match {
    PlaneFit plane;
    Eigen::Vector3f searched_at_W_m;
    float map_variance_m2 = 0.0f;
    bool searched = false;
  };
  /// Over the matches of one iteration, of the free unknowns alone.
  struct Sums {
    Matrix H = Matrix::Zero();
    Vector g = Vector::Zero();
    std::size_t matches = 0, inliers = 0;

    void add(const Sums& other);
  };
  struct Unknowns;

  void place(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, const VoxelMap& map);
  void find_match(const VoxelMap& map, std::size_t point, Neighbours& found);
  double kernel_width_m();
  void describe_shape(std::span<const SweepPoint> points, double kernel_m, const Sums& sum, Result& result) const;
  void accumulate(std::span<const SweepPoint> points, const SweepTrajectory& trajectory,
                  const SweepCalibration& calibration, const Unknowns& unknowns, double kernel_m, Sums& sum);
  void accumulate_block(std::span<const SweepPoint> points, std::size_t block, const SweepTrajectory& trajectory,
                        const SweepCalibration& calibration, const Unknowns& unknowns, double kernel_m, Sums& sum);

  static void derivative_along(const SweepTrajectory& trajectory, const SweepCalibration& calibration,
                               const SweepPoint& point, const Eigen::Vector3d& direction_W, std::size_t& hint,
                               Vector& derivative);
  Matrix errors_in_variables_information(const SweepTrajectory& trajectory, const SweepCalibration& calibration,
                                         const Unknowns& unknowns, std::span<const SweepPoint> points,
                                         double kernel_m) const;
  Matrix score_covariance(std::span<const SweepPoint> points, const SweepTrajectory& trajectory,
                          const SweepCalibration& calibration, const Unknowns& unknowns, double kernel_m);
  struct Weight {
    double variance_m2, robust, information;
  };
  Weight weigh(const SweepPoint& point, const Match& match, double distance_m, double kernel_m) const;

  Params params_;
  // memory kept between sweeps; holds nothing that the next result depends on
  std::vector<Eigen::Vector3f> levers_, positions_;
  std::vector<SweepPoint> moved_;
  std::vector<Match> matches_;
  std::vector<float> distances_, sorted_;
  std::vector<Sums> parts_;  // per block of points
  SpatialHash cluster_of_{1 << 10};
  std::vector<Vector> pulls_;  // of the clusters
};

}  // namespace tumble
