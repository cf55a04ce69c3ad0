// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace tumble {

inline double squared(double x) {
  return x * x;
}

// Measurement updates of a Kalman filter (Kalman, Journal of Basic Engineering 82, 1960). All functions return the
// correction of the state vector with N components, and update its covariance P. The cost is O(N^2) per measured
// number, without allocation for fixed N.

/// `row` (N numbers) is the derivative of the measurement with respect to the state, and `innovation` is the
/// measurement minus its prediction.
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

/// The measurement is component `index` of the state vector.
template <int N>
Eigen::Matrix<double, N, 1> kalman_update_of_component(Eigen::Index index, double innovation, double variance,
                                                       Eigen::Matrix<double, N, N>& P) {
  const Eigen::Matrix<double, N, 1> column = P.col(index);
  const double s = column[index] + variance;
  P -= column * (column / s).transpose();
  return column * (innovation / s);
}

/// `H` (M x N) is the derivative of the measured numbers with respect to the state.
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
