// SPDX-License-Identifier: BSD-3-Clause
// Compares with Eigen's decompositions of fixed size: factorisations bit for bit, eigenvalues up to rounding.
#include "estimator/src/common/dense.hpp"

#include "tests/testing.hpp"

namespace tumble::dense {

namespace {

constexpr int kSize = 28;
using Matrix = Eigen::Matrix<double, kSize, kSize>;
using Vector = Eigen::Matrix<double, kSize, 1>;

// J' J with a diagonal over ten powers of ten, as in normal equations
Matrix positive() {
  Matrix J;
  for (int i = 0; i < kSize; ++i) {
    for (int j = 0; j < kSize; ++j)
      J(i, j) = std::sin(1.0 + 3.7 * i * i + 11.3 * (i + 2) * j * j) * std::pow(10.0, -5.0 * j / kSize);
  }
  const Matrix H = J.transpose() * J;
  return 0.5 * (H + H.transpose());
}

Vector right() {
  return Vector::LinSpaced(-1.0, 2.0);
}

TEST(Dense, CholeskyHasTheBitsOfTheFixedSize) {
  const Matrix A = positive();
  const Eigen::LLT<Matrix> fixed(A);
  const Cholesky factor(A);
  ASSERT_TRUE(factor.ok());
  EXPECT_EQ(factor.inverse<Matrix>(), Matrix(fixed.solve(Matrix::Identity())));
  Vector b = right();
  factor.solve_vector(b);
  EXPECT_EQ(b, Vector(fixed.solve(right())));
  EXPECT_NEAR(2.0 * factor.half_log_determinant(), fixed.matrixLLT().diagonal().array().log().sum() * 2.0, 1e-9);
}

TEST(Dense, CholeskyRefusesWhatIsNotPositive) {
  Matrix A = positive();
  A(3, 3) = -1.0;
  EXPECT_FALSE(Cholesky(A).ok());
}

TEST(Dense, SemidefiniteHasTheBitsOfTheFixedSize) {
  Matrix A = positive();
  A.row(5).setZero();
  A.col(5).setZero();
  Matrix B = Matrix::Identity();
  solve_semidefinite(A, B);
  EXPECT_EQ(B, Matrix(A.ldlt().solve(Matrix::Identity())));
  Vector b = right();
  solve_semidefinite_vector(A, b);
  EXPECT_EQ(b, Vector(A.ldlt().solve(right())));
  ASSERT_TRUE(b.allFinite());
  EXPECT_EQ(b[5], 0.0);  // an unconstrained unknown is not changed
}

TEST(Dense, EigenvaluesAreThoseOfTheFixedSize) {
  const Matrix A = positive();
  const Vector fixed = Eigen::SelfAdjointEigenSolver<Matrix>(A, Eigen::EigenvaluesOnly).eigenvalues();
  Vector values, alone;
  Matrix vectors;
  decompose(A, values, vectors);
  eigenvalues(A, alone);
  const double rounding = 1e-14 * A.norm();
  EXPECT_LT((values - fixed).cwiseAbs().maxCoeff(), rounding);
  EXPECT_LT((alone - fixed).cwiseAbs().maxCoeff(), rounding);
  EXPECT_LT((vectors * values.asDiagonal() * vectors.transpose() - A).norm(), kSize * rounding);
  EXPECT_LT((vectors.transpose() * vectors - Matrix::Identity()).norm(), kSize * 1e-14);
}

}  // namespace

}  // namespace tumble::dense
