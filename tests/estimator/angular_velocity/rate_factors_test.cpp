// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rate_observation.hpp"

#include "oracles/gaussian.hpp"
#include "oracles/torque_free_rotation.hpp"
#include "tests/testing.hpp"

namespace tumble {
namespace {

using Derivative = Eigen::Matrix<double, 3, 6 + BodyImuConstants::kSize>;
using Factor = std::function<AngularRateFactor(const AngularRateKnot&, const BodyImuConstants&)>;

struct Point {
  AngularRateKnot knot;
  BodyImuConstants rig;
};

Point random_point(oracles::Gaussian& noise) {
  Point p;
  p.knot = {10.0 * noise.vector(), 100.0 * noise.vector()};
  BodyImuConstants::Vector v;
  for (double& x : v) x = 0.1 * noise();
  p.rig.add(v);
  return p;
}

Derivative analytic(const Factor& factor, const Point& p) {
  const AngularRateFactor f = factor(p.knot, p.rig);
  Derivative d;
  d << f.jacobian_knot, f.jacobian_calibration;
  return d;
}

Derivative numeric(const Factor& factor, const Point& p) {
  Derivative d;
  for (int i = 0; i < d.cols(); ++i) {
    constexpr double kStep = 1e-4;
    const auto moved = [&](double h) {
      Point q = p;
      if (i < 3) q.knot.rate_rad_s[i] += h;
      if (i >= 3 && i < 6) q.knot.acceleration_rad_s2[i - 3] += h;
      if (i >= 6) q.rig.add(h * BodyImuConstants::Vector::Unit(i - 6));
      return factor(q.knot, q.rig).residual;
    };
    d.col(i) = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
  }
  return d;
}

// Returns the largest difference relative to the largest entry, for the tests below.
double disagreement(const Derivative& a, const Derivative& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

const Vector3d kReading = {3.0, -40.0, 7.0};

std::vector<Factor> factors() {
  return {[](const AngularRateKnot& k, const BodyImuConstants& r) { return gyro_factor(k, r, kReading); },
          [](const AngularRateKnot& k, const BodyImuConstants& r) { return sensing_axis_factor(k, r, kReading); },
          [](const AngularRateKnot& k, const BodyImuConstants& r) { return flight_force_factor(k, r, kReading); },
          [](const AngularRateKnot& k, const BodyImuConstants& r) { return euler_equation_factor(k, r); }};
}

TEST(RateFactors, DerivativesAreThoseOfTheResiduals) {
  oracles::Gaussian noise(11);
  for (const Factor& factor : factors()) {
    for (int i = 0; i < 20; ++i) {
      const Point p = random_point(noise);
      // the residuals are at most quadratic in each unknown, so central differences are exact except for rounding, 1e-9
      EXPECT_LT(disagreement(analytic(factor, p), numeric(factor, p)), 1e-7);
    }
  }
}

TEST(RateFactors, TheCheckerSeesAWrongSignInAnyNonZeroEntry) {
  oracles::Gaussian noise(12);
  for (const Factor& factor : factors()) {
    const Point p = random_point(noise);
    const Derivative right = analytic(factor, p), reference = numeric(factor, p);
    int checked = 0;
    for (Eigen::Index i = 0; i < right.size(); ++i) {
      // entries below a thousandth of the largest hardly affect the solution
      if (std::abs(right.reshaped()[i]) < 1e-3 * reference.cwiseAbs().maxCoeff()) continue;
      Derivative wrong = right;
      wrong.reshaped()[i] *= -1.0;
      EXPECT_GT(disagreement(wrong, reference), 1e-4) << i;
      ++checked;
    }
    EXPECT_GT(checked, 5);
  }
}

TEST(RateFactors, VanishOnATorqueFreeBody) {
  const Eigen::Matrix3d R_IB = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Vector3d moments(2.0, 2.4, 3.0);
  const oracles::TorqueFreeRotation body(moments, {3.0, 12.0, -5.0});
  BodyImuConstants rig;
  rig.lever_arm_m = {-0.022, -0.085, 0.055};
  rig.gyro_bias_rad_s = {0.1, 0.2, 0.3};
  rig.accel_bias_m_s2 = {0.5, -0.4, 0.3};
  rig.inertia_coordinates = BodyImuConstants::inertia_basis_coordinates(R_IB * moments.asDiagonal() * R_IB.transpose());
  const Vector3d lever_B = R_IB.transpose() * rig.lever_arm_m;
  for (double t : {0.0, 0.3, 1.7}) {
    const AngularRateKnot knot{R_IB * body.rate(t), R_IB * body.acceleration(t)};
    const Vector3d gyro = knot.rate_rad_s + rig.gyro_bias_rad_s;
    const Vector3d accel = R_IB * body.specific_force(t, lever_B) + rig.accel_bias_m_s2;
    EXPECT_LT(gyro_factor(knot, rig, gyro).residual.norm(), 1e-12);
    EXPECT_LT(flight_force_factor(knot, rig, accel).residual.norm(), 1e-12);
    EXPECT_LT(euler_equation_factor(knot, rig).residual.norm(), 1e-10);
    EXPECT_GT(euler_equation_factor(knot, BodyImuConstants{}).residual.norm(),
              1.0);  // a sphere would rotate differently
  }
}

// Lever arm and inertia absorb most of a gyro's scale error in flight: rate_smoother.md (R46), (R47). For a spin about
// a principal axis, they absorb all of it.
TEST(RateFactors, AScaleOfTheGyroShowsByTheAccelerationAlone) {
  constexpr double k = 0.01;
  const Vector3d moments(2.0, 2.4, 3.0);
  BodyImuConstants rig, other;
  rig.lever_arm_m = {-0.022, -0.085, 0.055};
  rig.inertia_coordinates = BodyImuConstants::inertia_basis_coordinates(moments.asDiagonal());
  other.lever_arm_m = rig.lever_arm_m / ((1.0 + k) * (1.0 + k));
  other.inertia_coordinates = rig.inertia_coordinates / (1.0 + k);
  for (const Vector3d& start : {Vector3d(3.0, 12.0, -5.0), Vector3d(0.0, 0.0, 14.0)}) {
    const oracles::TorqueFreeRotation body(moments, start);
    for (const double t : {0.0, 0.3, 1.7}) {
      const Vector3d a = body.acceleration(t);
      const AngularRateKnot scaled{(1.0 + k) * body.rate(t), (1.0 + k) * a};
      const Vector3d force_status =
          flight_force_factor(scaled, other, body.specific_force(t, rig.lever_arm_m)).residual;
      EXPECT_LT((force_status + k * a.cross(rig.lever_arm_m)).norm(), 1e-9 + 1.1 * k * k * a.norm() * 0.11);
      const Vector3d of_torque = euler_equation_factor(scaled, other).residual;
      EXPECT_LT((of_torque + k * (rig.inertia_matrix_with_trace_3() - Eigen::Matrix3d::Identity()) * a).norm(), 1e-9);
      if (start.x() == 0.0) {
        EXPECT_LT(force_status.norm() + of_torque.norm(), 1e-9);
      } else {
        // without changes of lever arm and inertia, the scale error would be clearly visible
        EXPECT_GT(flight_force_factor(scaled, rig, body.specific_force(t, rig.lever_arm_m)).residual.norm(),
                  3.0 * force_status.norm());
      }
    }
  }
}

TEST(BodyImuConstants, InertiaIsFreeOfScaleAndItsCoordinatesComeBack) {
  Eigen::Matrix3d J;
  J << 3.0, 0.1, -0.2, 0.1, 2.5, 0.3, -0.2, 0.3, 2.0;
  BodyImuConstants rig;
  rig.inertia_coordinates = BodyImuConstants::inertia_basis_coordinates(J);
  EXPECT_LT((rig.inertia_matrix_with_trace_3() - 3.0 / J.trace() * J).norm(), 1e-14);
  EXPECT_LT((BodyImuConstants::inertia_basis_coordinates(7.0 * J) - rig.inertia_coordinates).norm(), 1e-14);
  EXPECT_EQ(BodyImuConstants{}.inertia_matrix_with_trace_3(), Eigen::Matrix3d::Identity());
}

// Returns the rotation without torque after some time, at fourth order in small steps.
AngularRateKnot turned(AngularRateKnot knot, const BodyImuConstants& rig, double time_s) {
  const Eigen::Matrix3d J = rig.inertia_matrix_with_trace_3();
  const auto slope = [&](const Vector3d& w) -> Vector3d { return -J.inverse() * w.cross(Vector3d(J * w)); };
  constexpr int kSteps = 20;
  const double h = time_s / kSteps;
  Vector3d w = knot.rate_rad_s;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d a = slope(w), b = slope(w + 0.5 * h * a), c = slope(w + 0.5 * h * b), d = slope(w + h * c);
    w += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
  }
  return {w, slope(w)};
}

Point flying_point(oracles::Gaussian& noise) {
  Point p = random_point(noise);
  p.knot.acceleration_rad_s2 = turned(p.knot, p.rig, 0.0).acceleration_rad_s2;
  return p;
}

TEST(LateFlight, DerivativesAreThoseOfTheResidual) {
  oracles::Gaussian noise(12);
  for (int i = 0; i < 20; ++i) {
    const Point p = flying_point(noise);
    const double delay_s = 0.005 * noise();
    const Factor factor = [&](const AngularRateKnot& k, const BodyImuConstants& r) {
      return delayed_flight_force_factor(k, r, kReading, delay_s, nullptr);
    };
    // a polynomial of low degree in all unknowns except the inertia: differences have an error of the squared step
    EXPECT_LT(disagreement(analytic(factor, p), numeric(factor, p)), 1e-5);
    Vector3d jacobian_delay;
    (void)delayed_flight_force_factor(p.knot, p.rig, kReading, delay_s, &jacobian_delay);
    constexpr double kStep_s = 1e-6;
    const Vector3d moved = delayed_flight_force_factor(p.knot, p.rig, kReading, delay_s + kStep_s, nullptr).residual -
                           delayed_flight_force_factor(p.knot, p.rig, kReading, delay_s - kStep_s, nullptr).residual;
    EXPECT_LT((moved / (2.0 * kStep_s) - jacobian_delay).norm(), 1e-5 * (1.0 + jacobian_delay.norm()));
  }
}

TEST(LateFlight, IsTheFlightOfTheEarlierInstant) {
  oracles::Gaussian noise(13);
  for (int i = 0; i < 20; ++i) {
    const Point p = flying_point(noise);
    EXPECT_EQ(delayed_flight_force_factor(p.knot, p.rig, kReading, 0.0, nullptr).residual,
              flight_force_factor(p.knot, p.rig, kReading).residual);
    const auto off = [&](double delay_s) {
      const AngularRateKnot earlier = turned(p.knot, p.rig, -delay_s);
      return (delayed_flight_force_factor(p.knot, p.rig, kReading, delay_s, nullptr).residual -
              flight_force_factor(earlier, p.rig, kReading).residual)
          .norm();
    };
    const double now = (flight_force_factor(turned(p.knot, p.rig, -0.002), p.rig, kReading).residual -
                        flight_force_factor(p.knot, p.rig, kReading).residual)
                           .norm();
    EXPECT_LT(off(0.002), 0.1 * now);
    // the remaining error is of second order: the change of the angular jerk
    EXPECT_NEAR(off(0.001) / off(0.0005), 4.0, 0.5);
  }
}

// Weighing and moving a sample use one residual.
TEST(LateFlight, ByTheRigAloneIsTheSameToTheBit) {
  oracles::Gaussian noise(13);
  for (const double delay_s : {0.0, 5e-4, 3e-3}) {
    const Point p = random_point(noise);
    const AngularRateFactor whole = delayed_flight_force_factor(p.knot, p.rig, kReading, delay_s, nullptr),
                            part = delayed_flight_calibration_jacobian(p.knot, p.rig, kReading, delay_s);
    EXPECT_EQ(part.residual, whole.residual);
    EXPECT_EQ(part.jacobian_calibration.leftCols<9>(), whole.jacobian_calibration.leftCols<9>());
    EXPECT_TRUE(part.jacobian_knot.isZero(0.0));
    EXPECT_TRUE(part.jacobian_calibration.rightCols<BodyImuConstants::kSize - 9>().isZero(0.0));
    EXPECT_FALSE(whole.jacobian_calibration.middleCols<5>(9).isZero(0.0) && delay_s > 0.0) << "by inertia too";
  }
}

TEST(LateFlight, CurvatureIsTheSecondDerivativeOfTheForce) {
  oracles::Gaussian noise(14);
  for (int i = 0; i < 20; ++i) {
    const Point p = flying_point(noise);
    constexpr double kStep_s = 1e-3;
    const auto force = [&](double time_s) -> Vector3d {
      return flight_force_factor(turned(p.knot, p.rig, time_s), p.rig, Vector3d::Zero()).residual;
    };
    const Vector3d want = (force(kStep_s) - 2.0 * force(0.0) + force(-kStep_s)) / (kStep_s * kStep_s);
    EXPECT_LT((flight_angular_jerk(p.knot, p.rig) - want).norm(), 1e-2 * want.norm());
  }
}

}  // namespace
}  // namespace tumble
