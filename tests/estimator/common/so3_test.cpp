// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/types.hpp"

#include "tests/testing.hpp"

namespace tumble::so3 {
namespace {

using Wide = Eigen::Matrix<long double, 3, 3>;

constexpr double kPi = std::numbers::pi;

std::vector<double> angles() {
  return {0.0,  1e-300, 1e-160, 1e-30, 1e-12, 1e-9, 1e-6, 0.9e-4,     0.99999e-4, 1.00001e-4, 1.1e-4, 1e-3,
          0.01, 0.1,    0.499,  0.501, 1.0,   2.0,  3.0,  kPi - 1e-3, kPi - 1e-9, kPi,        4.0,    6.0};
}

std::vector<Vector3d> axes() {
  return {Vector3d::UnitX(), -Vector3d::UnitZ(), Vector3d(1, 2, 3).normalized(),
          Vector3d(-0.3, 0.9, -0.1).normalized()};
}

// sum of a_n [phi]x^n in long double; exp for a_n = 1 / n!, left Jacobian for a_n = 1 / (n + 1)!
Wide series(const Vector3d& phi, int shift) {
  Wide k;
  const Eigen::Matrix<long double, 3, 1> v = phi.cast<long double>();
  k << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  Wide term = Wide::Identity(), sum = Wide::Zero();
  for (int n = 0; n < 80; ++n) {
    sum += term;
    term = (term * k / static_cast<long double>(n + 1 + shift)).eval();
  }
  return sum;
}

double distance(const Matrix3d& a, const Wide& b) {
  return static_cast<double>((a.cast<long double>() - b).cwiseAbs().maxCoeff());
}

TEST(So3, HatIsTheCrossProduct) {
  const Vector3d v(1, -2, 3), w(0.3, 0.5, -0.7);
  EXPECT_EQ(hat(v) * w, v.cross(w));
}

TEST(So3, ExpAgreesWithTheMatrixExponential) {
  for (const Vector3d& axis : axes()) {
    for (double angle : angles()) {
      const Vector3d phi = angle * axis;
      EXPECT_LE(distance(exp(phi).toRotationMatrix(), series(phi, 0)), 2e-15) << angle;  // measured 1e-15
      EXPECT_NEAR(exp(phi).norm(), 1.0, 4e-16) << angle;
    }
  }
}

TEST(So3, ExpKeepsTinyAngles) {
  const Quaterniond q = exp({0.0, 1e-200, 0.0});
  EXPECT_EQ(q.y(), 0.5e-200);
}

TEST(So3, LogInvertsExpUpToPi) {
  for (const Vector3d& axis : axes()) {
    for (double angle : angles()) {
      if (angle >= kPi) continue;
      const Vector3d phi = angle * axis;
      EXPECT_LE((logarithm(exp(phi)) - phi).norm(), 2e-15 * angle) << angle;
    }
  }
}

TEST(So3, LogReturnsTheShortestVector) {
  const Vector3d axis = Vector3d(1, 2, 3).normalized();
  EXPECT_LE((logarithm(exp(4.0 * axis)) - (4.0 - 2.0 * kPi) * axis).norm(), 2e-15);
}

TEST(So3, LogOfBothSignsIsTheSameHalfTurnsIncluded) {
  std::vector<Quaterniond> rotations = {{0.0, 1.0, 0.0, 0.0},  {0.0, 0.0, -1.0, 0.0}, {0.0, 0.0, 0.6, -0.8},
                                        {-0.0, 0.6, 0.0, 0.8}, {1.0, 0.0, 0.0, 0.0},  {0.5, 0.5, -0.5, 0.5}};
  for (const Quaterniond& q : rotations) {
    const Quaterniond opposite(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_EQ(logarithm(q), logarithm(opposite)) << q.coeffs().transpose();
    EXPECT_LE(logarithm(q).norm(), kPi);
  }
  EXPECT_DOUBLE_EQ(logarithm(rotations[1]).y(), kPi);
}

TEST(So3, LeftJacobianAgreesWithItsSeries) {
  for (const Vector3d& axis : axes()) {
    for (double angle : angles()) {
      const Vector3d phi = angle * axis;
      EXPECT_LE(distance(left_jacobian(phi), series(phi, 1)), 1e-15) << angle;  // measured 6e-16
    }
  }
}

TEST(So3, LeftJacobianIsTheDerivativeOfExp) {
  const Vector3d phi(0.4, -1.1, 0.7), d(1e-6, -2e-6, 1.5e-6);
  const Vector3d measured = logarithm(exp(phi + d) * exp(phi).conjugate());
  EXPECT_LE((measured - left_jacobian(phi) * d).norm(), 1e-11);             // second order: |d|^2 = 7e-12
  EXPECT_GT((measured - left_jacobian(phi).transpose() * d).norm(), 1e-7);  // the right Jacobian differs
}

TEST(So3, LeftJacobianInverseIsTheInverse) {
  for (const Vector3d& axis : axes()) {
    for (double angle : angles()) {
      if (angle > 4.0) continue;  // near 2 pi, the inverse Jacobian is unbounded
      const Vector3d phi = angle * axis;
      const Matrix3d product = left_jacobian_inverse(phi) * left_jacobian(phi);
      EXPECT_LE((product - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 2e-15) << angle;
    }
  }
}

TEST(So3, ShortestArcTakesOneVectorToTheOther) {
  const Vector3d from = Vector3d(1, -2, 0.5).normalized(), side = from.unitOrthogonal();
  // from equal to opposite, with the small deviations for which 1 + cos would cancel
  for (double angle : {0.0, 1e-12, 1e-8, 1e-3, 1.0, 3.0, kPi - 1e-3, kPi - 1e-6, kPi - 1e-7, kPi - 1e-9, kPi - 1e-13}) {
    const Vector3d to = std::cos(angle) * from + std::sin(angle) * side;
    const Quaterniond q = shortest_arc(from, to);
    EXPECT_NEAR(q.norm(), 1.0, 1e-15) << angle;
    EXPECT_LE((q * from - to).norm(), 2e-15) << angle;
    EXPECT_NEAR(logarithm(q).norm(), angle, 2e-15) << angle;
  }
}

TEST(So3, ShortestArcOfOppositeVectorsIsAHalfTurn) {
  for (const Vector3d& axis : axes()) {
    const Quaterniond q = shortest_arc(axis, -axis);
    EXPECT_EQ(q.w(), 0.0);
    EXPECT_NEAR(q.vec().dot(axis), 0.0, 1e-15);
    EXPECT_LE((q * axis + axis).norm(), 1e-15);
  }
}

}  // namespace
}  // namespace tumble::so3
