// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

/// Decompositions of symmetric matrices of many unknowns, compiled once: of fixed size each file and each size would
/// have the compiler make Eigen's anew, which took half of the time of the files that did so. Factorisations are to the
/// bit those of the fixed sizes, eigenvalues to rounding. Each call allocates: for once in a sweep or a run.
namespace tumble::dense {

using Symmetric = Eigen::Ref<const Eigen::MatrixXd>;  ///< its lower triangle is read

/// A^-1 in place of B as columns; A positive definite, by Cholesky. Where it is not, `ok()` is false and all else of no
/// use.
class Cholesky {
 public:
  explicit Cholesky(const Symmetric& A);

  bool ok() const { return ok_; }
  double half_log_determinant() const;
  void solve(Eigen::Ref<Eigen::MatrixXd> B) const;
  void solve_vector(Eigen::Ref<Eigen::VectorXd> b) const;

  /// A^-1, as `Matrix`.
  template <class Matrix>
  Matrix inverse() const {
    Matrix out = Matrix::Identity();
    solve(out);
    return out;
  }

 private:
  Eigen::MatrixXd L_;
  bool ok_ = false;
};

/// A^-1 B in place of B, A positive or negative semidefinite, by Cholesky with pivots and without roots (LDLT).
void solve_semidefinite(const Symmetric& A, Eigen::Ref<Eigen::MatrixXd> B);
void solve_semidefinite_vector(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> b);

/// Eigenvalues, ascending, and eigenvectors.
void decompose(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<Eigen::MatrixXd> vectors);
void eigenvalues(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> values);

}  // namespace tumble::dense
