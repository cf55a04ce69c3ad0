// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace tumble {

// The measurement update of a Kalman filter, the only one in the library: by one scalar (several with independent noise
// are taken one after another, which needs no inverse), or by a few numbers at once, as published filters have it. All
// return what is to be added to the state of N numbers and take the measurement into its covariance P (N x N, kept
// symmetric to rounding); O(N^2) for each number, no allocation for fixed N. P must be positive semidefinite and the
// variance of the noise positive (R. E. Kalman, J. Basic Eng. 82, 1960; Joseph's form is not needed where P is well
// conditioned, and is not used).

/// By a measurement with the derivative `row` (N): `innovation` is what was measured minus what was expected.
template <typename Row, int N>
Eigen::Matrix<double, N, 1> scalar_update(const Eigen::MatrixBase<Row>& row, double innovation, double variance,
                                          Eigen::Matrix<double, N, N>& P) {
  EIGEN_STATIC_ASSERT_VECTOR_SPECIFIC_SIZE(Row, N)
  Eigen::Matrix<double, N, 1> h;
  for (int k = 0; k < N; ++k) h[k] = row.derived().coeff(k);
  const Eigen::Matrix<double, N, 1> PHt = P * h;
  const double s = h.dot(PHt) + variance;
  P -= PHt * (PHt / s).transpose();
  return PHt * (innovation / s);
}

/// By a measurement of component `index` of the state itself.
template <int N>
Eigen::Matrix<double, N, 1> component_update(Eigen::Index index, double innovation, double variance,
                                             Eigen::Matrix<double, N, N>& P) {
  const Eigen::Matrix<double, N, 1> column = P.col(index);
  const double s = column[index] + variance;
  P -= column * (column / s).transpose();
  return column * (innovation / s);
}

/// By M numbers with the derivative `H` (M x N) and noise of the covariance `noise` (M x M, may be correlated); M up to
/// 4, beyond which an inverse is not the way.
template <int M, int N>
Eigen::Matrix<double, N, 1> vector_update(const Eigen::Matrix<double, M, N>& H,
                                          const Eigen::Matrix<double, M, 1>& innovation,
                                          const Eigen::Matrix<double, M, M>& noise, Eigen::Matrix<double, N, N>& P) {
  static_assert(M >= 1 && M <= 4);
  const Eigen::Matrix<double, M, M> S = H * P * H.transpose() + noise;
  const Eigen::Matrix<double, N, M> K = P * H.transpose() * S.inverse();
  P -= (K * H * P).eval();
  return K * innovation;
}

}  // namespace tumble
