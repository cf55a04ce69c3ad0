// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "tumble/mapping/detail/sweep_unknowns.hpp"

namespace tumble {

/// How a registration ended.
enum class RegistrationVerdict : std::uint8_t {
  converged,
  too_few,   ///< matches below the bound: the prior is returned
  diverged,  ///< iterations ran out, the correction of the prior is beyond the bound, or most matches do not fit:
             ///< the prior is returned
};

/// What became of a registration.
struct RegistrationResult {
  RegistrationVerdict verdict = RegistrationVerdict::too_few;
  SweepUnknowns::Estimate mean;
  SweepUnknowns::Matrix covariance =
      SweepUnknowns::Matrix::Zero();  ///< of all unknowns, in order; the prior's where nothing was registered
  /// Covariance of the pull of the surfaces on the unknowns (the gradient of their cost), measured from the
  /// residuals: points within RegistrationExpertParams::cluster_m of each other share the errors of the map, those
  /// farther apart do not (cluster-robust covariance, K. Liang, S. Zeger, 1986). In units of the covariance: that of
  /// independent points would be the correlation_discount times what they add to the normal matrix.
  SweepUnknowns::Matrix score_covariance = SweepUnknowns::Matrix::Zero();
  /// What the normal matrix holds of noise alone, of all unknowns that are free: the normals are fitted to few
  /// points, and their errors add information in every direction of a plane (errors in variables, W. Fuller,
  /// Measurement Error Models, 1987, section 2.2). It holds the iterations where they are; it tells nothing of the
  /// motion.
  SweepUnknowns::Matrix errors_in_variables_information = SweepUnknowns::Matrix::Zero();
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

}  // namespace tumble
