// SPDX-License-Identifier: BSD-3-Clause
#include "oracles/torque_free_rotation.hpp"

#include "oracles/gaussian.hpp"
#include "oracles/jacobi_elliptic.hpp"
#include "tests/testing.hpp"

namespace tumble::oracles {
namespace {

TEST(JacobiElliptic, DegeneratesToTheCircularFunctions) {
  for (double u : {-7.0, -0.3, 0.0, 1e-9, 1.0, 25.0}) {
    const JacobiElliptic j = jacobi_elliptic(u, 0.0);
    EXPECT_DOUBLE_EQ(j.sn, std::sin(u));
    EXPECT_DOUBLE_EQ(j.cn, std::cos(u));
    EXPECT_DOUBLE_EQ(j.dn, 1.0);
  }
}

TEST(JacobiElliptic, InvertsTheEllipticIntegralOfTheStandardLibrary) {
  for (double k : {0.1, 0.5, 0.9, 0.999, 0.9999999}) {
    const double tolerance = 1e-13 + 1e-15 / (1.0 - k);  // rounding of k changes the period; measured a tenth of this
    for (double phi = -6.0; phi < 6.0; phi += 0.37) {
      const JacobiElliptic j = jacobi_elliptic(std::ellint_1(k, phi), k);
      EXPECT_NEAR(j.sn, std::sin(phi), tolerance) << k << " " << phi;
      EXPECT_NEAR(j.cn, std::cos(phi), tolerance) << k << " " << phi;
      EXPECT_NEAR(j.dn, std::sqrt(1.0 - k * k * std::sin(phi) * std::sin(phi)), tolerance) << k << " " << phi;
    }
    EXPECT_NEAR(complete_elliptic_first(k) / std::comp_ellint_1(k), 1.0, tolerance) << k;
  }
}

struct Body {
  Vector3d moments, rate;
};

std::vector<Body> bodies() {
  return {
      {{1.0, 1.1, 1.3}, {1.0, 2.0, 15.0}},  {{1.3, 1.1, 1.0}, {-12.0, 3.0, 4.0}}, {{1.0, 1.4, 1.6}, {3.0, 14.0, 2.0}},
      {{1.0, 1.4, 1.6}, {15.0, -2.0, 1.0}}, {{1.0, 1.0, 1.5}, {2.0, -3.0, 9.0}},  {{1.0, 1.5, 1.5}, {9.0, 2.0, -4.0}},
      {{1.1, 1.3, 1.0}, {-2.0, -5.0, 1.0}}, {{1.0, 1.1, 1.3}, {1e-6, 0.0, 12.0}}, {{1.2, 1.2, 1.2}, {3.0, 4.0, 5.0}},
      {{1.0, 1.1, 1.3}, {0.0, 0.0, 12.0}},  {{1.0, 1.1, 1.3}, {0.0, 0.0, 0.0}}};
}

TEST(TorqueFreeRotation, KeepsEnergyAndAngularMomentumInTheWorld) {
  const Quaterniond q0(Eigen::AngleAxisd(1.0, Vector3d(1, 2, 3).normalized()));
  for (const Body& body : bodies()) {
    const TorqueFreeRotation motion(body.moments, body.rate, q0);
    const Vector3d momentum = q0 * body.moments.cwiseProduct(body.rate).eval();
    const double energy = body.rate.dot(body.moments.cwiseProduct(body.rate));
    for (double t = -3.0; t < 20.0; t += 0.173) {
      const Vector3d w = motion.rate(t);
      const Vector3d now = motion.attitude(t) * body.moments.cwiseProduct(w).eval();
      EXPECT_NEAR(w.dot(body.moments.cwiseProduct(w)), energy, 1e-12 * energy + 1e-300);
      EXPECT_LE((now - momentum).norm(), 1e-12 * momentum.norm()) << body.rate.transpose() << " at " << t;
    }
  }
}

TEST(TorqueFreeRotation, StartsAtTheGivenState) {
  const Quaterniond q0(Eigen::AngleAxisd(-2.0, Vector3d(3, -2, 1).normalized()));
  for (const Body& body : bodies()) {
    const TorqueFreeRotation motion(body.moments, body.rate, q0);
    EXPECT_LE((motion.rate(0.0) - body.rate).norm(), 2e-12 * body.rate.norm()) << body.rate.transpose();
    EXPECT_LE(motion.attitude(0.0).angularDistance(q0), 2e-7);  // square root of rounding, by acos in Eigen
  }
}

// The independent reference integrates Euler's equations and the quaternion's kinematics by RK4.
struct RigidState {
  Vector3d w;
  Eigen::Vector4d q;
};

RigidState derivative(const Vector3d& moments, const RigidState& s) {
  const Quaterniond q(s.q), w(0.0, s.w.x(), s.w.y(), s.w.z());
  return {moments.cwiseProduct(s.w).cross(s.w).cwiseQuotient(moments), 0.5 * (q * w).coeffs()};
}

RigidState rk4(const Vector3d& moments, const RigidState& s, double h) {
  const auto at = [&](const RigidState& d, double f) { return RigidState{s.w + f * d.w, s.q + f * d.q}; };
  const RigidState k1 = derivative(moments, s), k2 = derivative(moments, at(k1, h / 2)),
                   k3 = derivative(moments, at(k2, h / 2)), k4 = derivative(moments, at(k3, h));
  return {s.w + h / 6 * (k1.w + 2 * k2.w + 2 * k3.w + k4.w), s.q + h / 6 * (k1.q + 2 * k2.q + 2 * k3.q + k4.q)};
}

TEST(TorqueFreeRotation, AgreesWithFineRungeKutta) {
  constexpr double kStep = 1e-4;
  for (const Body& body : bodies()) {
    const TorqueFreeRotation motion(body.moments, body.rate);
    RigidState s{body.rate, Quaterniond::Identity().coeffs()};
    for (int k = 1; k <= 30000; ++k) {
      s = rk4(body.moments, s, kStep);
      if (k % 3000 != 0) continue;
      const Quaterniond q = motion.attitude(k * kStep);
      // RK4 with steps of 0.1 ms at 15 rad/s has a local error of (w h)^5 / 120, measured below 5e-11 after 3 s
      EXPECT_LE((motion.rate(k * kStep) - s.w).norm(), 1e-9) << body.rate.transpose() << " at " << k * kStep;
      EXPECT_LE(std::min((q.coeffs() - s.q).norm(), (q.coeffs() + s.q).norm()), 1e-9)
          << body.rate.transpose() << " at " << k * kStep;
    }
  }
}

TEST(TorqueFreeRotation, SpecificForceIsTheSecondDerivativeOfThePathOfThePoint) {
  const Vector3d lever(-0.022, -0.085, 0.055);
  constexpr double kStep = 1e-4;
  for (const Body& body : bodies()) {
    const TorqueFreeRotation motion(body.moments, body.rate);
    for (double t : {0.1, 0.7, 2.3}) {
      const Vector3d before = motion.attitude(t - kStep) * lever, here = motion.attitude(t) * lever,
                     after = motion.attitude(t + kStep) * lever;
      const Vector3d numeric = motion.attitude(t).conjugate() * Vector3d((after - 2 * here + before) / (kStep * kStep));
      // the central differences have a truncation error of w^4 r h^2 / 12 = 4e-6 m/s^2 and a rounding error of 1e-15 r
      // / h^2 = 1e-8 m/s^2
      EXPECT_LE((motion.specific_force(t, lever) - numeric).norm(), 2e-5) << body.rate.transpose();
    }
  }
}

TEST(TorqueFreeRotation, RepeatsItsRateAfterAPeriod) {
  const TorqueFreeRotation motion({1.0, 1.1, 1.3}, {1.0, 2.0, 15.0});
  EXPECT_LE((motion.rate(0.4 + motion.period_s()) - motion.rate(0.4)).norm(), 1e-11);
  EXPECT_GT((motion.rate(0.4 + 0.5 * motion.period_s()) - motion.rate(0.4)).norm(), 0.1);
}

TEST(TorqueFreeRotation, RefusesImpossibleBodiesAndTheSeparatrix) {
  EXPECT_THROW(TorqueFreeRotation({1.0, 1.0, 2.5}, {1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(TorqueFreeRotation({1.0, -1.0, 1.0}, {1, 2, 3}), std::invalid_argument);
  EXPECT_THROW(TorqueFreeRotation({1.0, 1.1, 1.3}, {NAN, 2, 3}), std::invalid_argument);
  const double e3 = std::sqrt(1.0 * (1.1 - 1.0) / (1.3 * (1.3 - 1.1)));  // L^2 = 2 E I2
  EXPECT_THROW(TorqueFreeRotation({1.0, 1.1, 1.3}, {5.0, 1.0, 5.0 * e3}), std::invalid_argument);
}

}  // namespace
}  // namespace tumble::oracles
