// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace tumble {

/// Replaces P by (P + P^T) / 2 in place, because a copy of the matrix would need too much stack.
template <class Matrix>
void make_symmetric(Matrix& P) {
  for (int j = 0; j < P.cols(); ++j) {
    for (int i = 0; i < j; ++i) P(i, j) = P(j, i) = 0.5 * (P(i, j) + P(j, i));
  }
}

}  // namespace tumble

/// The functions in the namespace dense accept matrices of all sizes, because decompositions of fixed-size Eigen
/// matrices would double the compile time. The factorisations are bit-identical to Eigen's factorisations, and the
/// eigenvalues are equal up to rounding. Each decomposition allocates memory.

namespace tumble::dense {

using Symmetric = Eigen::Ref<const Eigen::MatrixXd>;  ///< only the lower triangle is read

/// If the matrix A is not positive definite, `ok()` returns false and all results are undefined.
class Cholesky {
 public:
  explicit Cholesky(const Symmetric& A);

  bool ok() const { return ok_; }
  double half_log_determinant() const;
  void solve(Eigen::Ref<Eigen::MatrixXd> B) const;
  void solve_vector(Eigen::Ref<Eigen::VectorXd> b) const;

  template <class Matrix>
  Matrix inverse() const {
    Matrix out = Matrix::Identity();
    solve(out);
    return out;
  }

 private:
  Eigen::MatrixXd cholesky_factor_;
  bool ok_ = false;
};

/// Solves A X = B in place for a semidefinite A, by pivoted square-root-free Cholesky factorisation (LDLT).
void solve_semidefinite(const Symmetric& A, Eigen::Ref<Eigen::MatrixXd> B);
void solve_semidefinite_vector(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> b);

/// The eigenvalues are in ascending order.
void decompose(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<Eigen::MatrixXd> vectors);
void eigenvalues(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> values);

}  // namespace tumble::dense
