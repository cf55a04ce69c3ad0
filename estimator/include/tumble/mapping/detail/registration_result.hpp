// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "tumble/mapping/detail/sweep_unknowns.hpp"

namespace tumble {

enum class RegistrationVerdict : std::uint8_t {
  converged,
  too_few_matches,  ///< too few matches; the result is the prior
  diverged,         ///< no convergence, too large a correction, or too few fitting matches; the result is the prior
};

struct RegistrationResult {
  RegistrationVerdict verdict = RegistrationVerdict::too_few_matches;
  RegistrationUnknowns::Estimate mean;
  RegistrationUnknowns::Matrix covariance = RegistrationUnknowns::Matrix::Zero();  ///< covariance of all unknowns
  /// Covariance of the cost gradient with respect to the unknowns, measured from the residuals (cluster-robust
  /// covariance, Liang and Zeger, 1986). Points within a cube of 1 m share the map's errors, and
  /// points farther apart are independent. If all points were independent, the covariance would equal
  /// correlation_discount times the points' contribution to the normal matrix.
  RegistrationUnknowns::Matrix score_covariance = RegistrationUnknowns::Matrix::Zero();
  /// Apparent information in the Gauss-Newton normal equations that comes from noise of the fitted plane normals.
  /// Source: errors in variables (Fuller, Measurement Error Models, 1987, section 2.2).
  RegistrationUnknowns::Matrix surface_normal_noise_information = RegistrationUnknowns::Matrix::Zero();
  std::size_t points = 0, matches = 0, inliers = 0;
  double correction_m = 0.0;  ///< position correction at the start, even if rejected as too large
  double correction_rad = 0.0;
  int iterations = 0;
  /// Ascending eigenvalues and eigenvectors (columns) of the pose's information from the lidar, without the prior. The
  /// attitude is scaled to metres by the root-mean-square lever arm. The information matrix of the pose is scaled so
  /// that its translation part has trace 1.
  Eigen::Matrix<double, 6, 1> eigenvalues = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 6> directions = Eigen::Matrix<double, 6, 6>::Identity();
  /// Standard deviation of the pose in its least constrained direction, without the inertial prediction.
  double least_constrained_sigma_m = std::numeric_limits<double>::infinity();
};

}  // namespace tumble
