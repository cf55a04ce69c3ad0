// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/detail/scalar_update.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

using Matrix4 = Eigen::Matrix4d;
using Vector4 = Eigen::Vector4d;

const Matrix4 kPrior = [] {
  Matrix4 root;
  root << 1.0, 0.2, -0.3, 0.4, 0.0, 0.7, 0.5, -0.1, 0.0, 0.0, 1.3, 0.2, 0.0, 0.0, 0.0, 0.4;
  return Matrix4(root * root.transpose());
}();

/// In information form, the inverse covariance gains h h^T / variance, and the correction is the new covariance times h
/// innovation / variance.
void expect_bayes(const Vector4& h, double innovation, double variance, const Vector4& correction, const Matrix4& P) {
  const Matrix4 expected = (kPrior.inverse() + h * h.transpose() / variance).inverse();
  EXPECT_LT((P - expected).norm(), 1e-12);
  EXPECT_LT((correction - expected * h * (innovation / variance)).norm(), 1e-12);
}

TEST(ScalarUpdate, IsBayesRuleForADirection) {
  const Eigen::RowVector4d row(0.3, -1.1, 0.0, 2.0);
  Matrix4 P = kPrior;
  const Vector4 correction = scalar_update(row, 0.7, 0.05, P);
  expect_bayes(row.transpose(), 0.7, 0.05, correction, P);
  Matrix4 other = kPrior;  // a column vector gives the same
  EXPECT_EQ(scalar_update(Vector4(row.transpose()), 0.7, 0.05, other), correction);
  EXPECT_EQ(other, P);
  Eigen::Matrix<double, 2, 4> rows;  // one row is not contiguous
  rows << Eigen::RowVector4d::Ones(), row;
  Matrix4 again = kPrior;
  EXPECT_EQ(scalar_update(rows.row(1), 0.7, 0.05, again), correction);
}

TEST(ScalarUpdate, IsBayesRuleForAComponent) {
  for (int index = 0; index < 4; ++index) {
    Matrix4 P = kPrior;
    const Vector4 correction = kalman_update_of_component(index, -0.4, 0.2, P);
    expect_bayes(Vector4::Unit(index), -0.4, 0.2, correction, P);
  }
}

TEST(ScalarUpdate, CheckDetectsAnotherVariance) {
  Matrix4 P = kPrior;
  kalman_update_of_component(1, 0.0, 0.2, P);
  EXPECT_GT((P - (kPrior.inverse() + Matrix4(Vector4::Unit(1) * Vector4::Unit(1).transpose() / 0.3)).inverse()).norm(),
            1e-3);
}

/// Reference by Bayes' rule for several measurements: the inverse covariance increases by H^T noise^-1 H.
TEST(VectorUpdate, IsBayesRuleForCorrelatedNoise) {
  Eigen::Matrix<double, 2, 4> H;
  H << 0.3, -1.1, 0.0, 2.0, 1.0, 0.4, -0.2, 0.0;
  Eigen::Matrix2d noise;
  noise << 0.05, 0.02, 0.02, 0.03;
  const Eigen::Vector2d innovation(0.7, -0.4);
  Matrix4 P = kPrior;
  const Vector4 correction = vector_update<2, 4>(H, innovation, noise, P);
  const Matrix4 expected = (kPrior.inverse() + H.transpose() * noise.inverse() * H).inverse();
  EXPECT_LT((P - expected).norm(), 1e-12);
  EXPECT_LT((correction - expected * H.transpose() * noise.inverse() * innovation).norm(), 1e-12);
}

TEST(VectorUpdate, OfIndependentNoiseIsScalarsOneAfterAnother) {
  Eigen::Matrix<double, 2, 4> H;
  H << 0.3, -1.1, 0.0, 2.0, 1.0, 0.4, -0.2, 0.0;
  const Eigen::Vector2d innovation(0.7, -0.4), variances(0.05, 0.03);
  Matrix4 once = kPrior, twice = kPrior;
  const Vector4 at_once = vector_update<2, 4>(H, innovation, variances.asDiagonal(), once);
  Vector4 in_turn = scalar_update(H.row(0), innovation[0], variances[0], twice);
  in_turn += scalar_update(H.row(1), innovation[1] - H.row(1).dot(in_turn), variances[1], twice);
  EXPECT_LT((once - twice).norm(), 1e-12);
  EXPECT_LT((at_once - in_turn).norm(), 1e-12);
  // for correlated noise, the scalar updates differ
  Eigen::Matrix2d noise = variances.asDiagonal();
  noise(0, 1) = noise(1, 0) = 0.02;
  Matrix4 correlated = kPrior;
  EXPECT_GT((vector_update<2, 4>(H, innovation, noise, correlated) - in_turn).norm(), 1e-3);
}

}  // namespace
}  // namespace tumble
