// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "tumble/mapping/detail/sweep_unknowns.hpp"

namespace tumble {

/// RegistrationVerdict is `converged`, or the reason why the result is the prior.
enum class RegistrationVerdict : std::uint8_t {
  converged,
  too_few,   ///< too few matches; the result is the prior
  diverged,  ///< no convergence, too large a correction, or too few fitting matches; the result is the prior
};

/// RegistrationResult contains the estimate and the diagnostics of a registration.
struct RegistrationResult {
  RegistrationVerdict verdict = RegistrationVerdict::too_few;
  SweepUnknowns::Estimate mean;
  SweepUnknowns::Matrix covariance = SweepUnknowns::Matrix::Zero();  ///< covariance of all unknowns
  /// Covariance of the cost gradient with respect to the unknowns, measured from the residuals (cluster-robust
  /// covariance, Liang and Zeger, 1986). Points within a cube of 1 m share the map's errors, and
  /// points farther apart are independent. If all points were independent, the covariance would equal
  /// correlation_discount times the points' contribution to the normal matrix.
  SweepUnknowns::Matrix score_covariance = SweepUnknowns::Matrix::Zero();
  /// Part of the normal matrix that noise of the fitted normals causes, for all estimated unknowns. The errors of
  /// normals that are fitted to few points add apparent information in every direction of a plane. Source: errors in
  /// variables (Fuller, Measurement Error Models, 1987, section 2.2). The apparent information stabilises the
  /// iterations, but contains no information about the motion.
  SweepUnknowns::Matrix normal_noise_information = SweepUnknowns::Matrix::Zero();
  std::size_t points = 0, matches = 0, inliers = 0;
  double correction_m = 0.0;  ///< position correction at the start, even if rejected as too large
  double correction_rad = 0.0;
  int iterations = 0;
  /// Ascending eigenvalues of the normal matrix of the pose, without the prior. The attitude is scaled to metres by the
  /// root-mean-square lever arm. The matrix is scaled so that its translation part has trace 1. The columns of
  /// `directions` are its eigenvectors.
  Eigen::Matrix<double, 6, 1> eigenvalues = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> directions = Eigen::Matrix<double, 6, 6>::Identity();
  /// Standard deviation of the pose in its least constrained direction, from the surfaces alone. The standard deviation
  /// least_constrained_sigma_m excludes the apparent information from noise of the normals.
  double least_constrained_sigma_m = std::numeric_limits<double>::infinity();
};

}  // namespace tumble
