// SPDX-License-Identifier: BSD-3-Clause
#include "dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace tumble::dense {

Cholesky::Cholesky(const Symmetric& A) : cholesky_factor_(A) {
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(cholesky_factor_);
  ok_ = factor.info() == Eigen::Success;
}

double Cholesky::half_log_determinant() const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < cholesky_factor_.rows(); ++i) sum += std::log(cholesky_factor_(i, i));
  return sum;
}

void Cholesky::solve(Eigen::Ref<Eigen::MatrixXd> B) const {
  cholesky_factor_.triangularView<Eigen::Lower>().solveInPlace(B);
  cholesky_factor_.adjoint().triangularView<Eigen::Upper>().solveInPlace(B);
}

void Cholesky::solve_vector(Eigen::Ref<Eigen::VectorXd> b) const {
  cholesky_factor_.triangularView<Eigen::Lower>().solveInPlace(b);
  cholesky_factor_.adjoint().triangularView<Eigen::Upper>().solveInPlace(b);
}

void solve_semidefinite(const Symmetric& A, Eigen::Ref<Eigen::MatrixXd> B) {
  B = Eigen::LDLT<Eigen::MatrixXd>(A).solve(B).eval();
}

void solve_semidefinite_vector(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> b) {
  b = Eigen::LDLT<Eigen::MatrixXd>(A).solve(b).eval();
}

void decompose(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<Eigen::MatrixXd> vectors) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(A);
  values = parts.eigenvalues();
  vectors = parts.eigenvectors();
}

void eigenvalues(const Symmetric& A, Eigen::Ref<Eigen::VectorXd> values) {
  values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace tumble::dense
