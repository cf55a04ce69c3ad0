// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <string>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "sim/imu/imu_simulation.hpp"

namespace tumble::scenarios {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSegment_m = 0.25, kMass_kg = 0.3;

class Chain {
 public:
  Chain(double segment_m, double gravity_m_s2) : length_m_(segment_m) {
    for (int i = 0; i < 3; ++i) {
      const double below = 2.0 - i;  // number of bars below
      weight_nm_[i] = kMass_kg * gravity_m_s2 * segment_m * (0.5 + below);
      for (int j = 0; j <= i; ++j) {
        coupling_(i, j) = kMass_kg * segment_m * segment_m * (i == j ? 1.0 / 3.0 + below : 0.5 + below);
        coupling_(j, i) = coupling_(i, j);
      }
    }
  }

  Matrix3d mass(const Vector3d& angle) const {
    Matrix3d out;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out(i, j) = coupling_(i, j) * std::cos(angle[i] - angle[j]);
    }
    return out;
  }

  double energy_j(const Vector3d& angle, const Vector3d& rate) const {
    return 0.5 * rate.dot(mass(angle) * rate) + weight_nm_.dot((1.0 - angle.array().cos()).matrix());
  }

  Vector3d acceleration(const Vector3d& angle, const Vector3d& rate) const {
    Vector3d moment = -weight_nm_.cwiseProduct(angle.array().sin().matrix());
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) moment[i] -= coupling_(i, j) * std::sin(angle[i] - angle[j]) * rate[j] * rate[j];
    }
    return mass(angle).ldlt().solve(moment);
  }

  Vector3d specific_force_W(const Vector3d& angle, const Vector3d& rate, const Vector3d& p_B_m,
                            double gravity_m_s2) const {
    const Vector3d alpha = acceleration(angle, rate);
    Vector3d f_W(0.0, 0.0, gravity_m_s2);
    for (int i = 0; i < 3; ++i) {
      const Vector3d down(-std::sin(angle[i]), 0.0, -std::cos(angle[i]));
      f_W += turned(i < 2 ? length_m_ * down : 0.5 * length_m_ * down, rate[i], alpha[i]);
    }
    const Eigen::Quaterniond q_WB(Eigen::AngleAxisd(angle[2], Vector3d::UnitY()));
    return f_W + turned(q_WB * p_B_m, rate[2], alpha[2]);
  }

  Eigen::GeneralizedSelfAdjointEigenSolver<Matrix3d> modes() const {
    return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix3d>(Matrix3d(weight_nm_.asDiagonal()), coupling_);
  }

 private:
  static Vector3d turned(const Vector3d& arm_W_m, double rate, double acceleration) {
    const Vector3d w(0.0, rate, 0.0);
    return Vector3d(0.0, acceleration, 0.0).cross(arm_W_m) + w.cross(w.cross(arm_W_m));
  }

  double length_m_;
  Matrix3d coupling_;
  Vector3d weight_nm_;
};

class Pendulum {
 public:
  Pendulum(const CertificateInput& input, sim::Integrator integrator)
      : trial_(build(input, situation()), {0.0, integrator}) {}

  sim::Trial& trial() { return trial_; }
  void set(const Vector3d& angle, const Vector3d& rate) {
    for (int i = 0; i < 3; ++i) {
      trial_.set_joint(hinge(i), angle[i] - (i > 0 ? angle[i - 1] : 0.0), rate[i] - (i > 0 ? rate[i - 1] : 0.0));
    }
  }
  Vector3d angle() const {
    Vector3d out(trial_.joint_rad(hinge(0)), trial_.joint_rad(hinge(1)), trial_.joint_rad(hinge(2)));
    return summed(out);
  }
  Vector3d rate() const {
    Vector3d out(trial_.joint_rate_rad_s(hinge(0)), trial_.joint_rate_rad_s(hinge(1)),
                 trial_.joint_rate_rad_s(hinge(2)));
    return summed(out);
  }

 private:
  static std::string hinge(int i) { return "hinge_" + std::to_string(i + 1); }
  static Vector3d summed(const Vector3d& v) { return {v[0], v[0] + v[1], v.sum()}; }
  static sim::Situation situation() {
    sim::Situation out = bare_room("pendulum");
    out.robot.values.set("segment_m", kSegment_m);
    out.robot.values.set("segment_mass_kg", kMass_kg);
    out.robot.values.set("hinge_damping_nm_s", 0.0);
    out.robot.values.set("hinge_friction_nm", 0.0);
    return out;
  }

  sim::Trial trial_;
};

const Vector3d kWildAngle(1.2, 1.6, 0.3), kWildRate(-2.0, 3.0, 6.0);

CertificateEntry energy(const CertificateInput& input, const PendulumSetup& setup) {
  Pendulum pendulum(input, setup.integrator);
  const Chain chain(setup.stated_segment_m > 0.0 ? setup.stated_segment_m : kSegment_m,
                    pendulum.trial().gravity_m_s2());
  pendulum.set(kWildAngle, kWildRate);
  const double start_j = chain.energy_j(pendulum.angle(), pendulum.rate());
  double drift = 0.0;
  const std::int64_t steps = std::llround(setup.duration_s / pendulum.trial().step_s());
  for (std::int64_t k = 0; k < steps; ++k) {
    pendulum.trial().step();
    drift = larger(drift, std::abs(chain.energy_j(pendulum.angle(), pendulum.rate()) / start_j - 1.0));
  }
  return {"pendulum_energy",
          "pendulum",
          "a pendulum without friction keeps its energy; the value is the maximum relative change in 5 s",
          "1",
          drift,
          0.0,
          1e-8,
          ""};
}

double measured_period_s(Pendulum& pendulum, double expected_s) {
  constexpr int kPeriods = 10;
  double before = pendulum.angle()[2], first_s = 0.0;
  int rises = 0;
  while (pendulum.trial().state().time_s < (kPeriods + 3) * expected_s) {
    pendulum.trial().step();
    const double now = pendulum.angle()[2], time_s = pendulum.trial().state().time_s;
    if (before < 0.0 && now >= 0.0) {
      const double crossed_s = time_s - pendulum.trial().step_s() * now / (now - before);
      if (rises == 0) first_s = crossed_s;
      if (rises++ == kPeriods) return (crossed_s - first_s) / kPeriods;
    }
    before = now;
  }
  return std::nan("");
}

CertificateEntry periods(const CertificateInput& input, const PendulumSetup& setup) {
  constexpr double kSmall_rad = 0.001;
  double worst = 0.0;
  for (int mode = 0; mode < 3; ++mode) {
    Pendulum pendulum(input, setup.integrator);
    const auto modes =
        Chain(setup.stated_segment_m > 0.0 ? setup.stated_segment_m : kSegment_m, pendulum.trial().gravity_m_s2())
            .modes();
    const Vector3d shape = modes.eigenvectors().col(mode);
    const double expected_s = 2.0 * std::numbers::pi / std::sqrt(modes.eigenvalues()[mode]);
    pendulum.set(kSmall_rad / shape.cwiseAbs().maxCoeff() * shape, Vector3d::Zero());
    worst = larger(worst, std::abs(measured_period_s(pendulum, expected_s) / expected_s - 1.0));
  }
  return {"pendulum_period",
          "pendulum",
          "the periods of the three modes of small oscillation equal the analytic solution; the value is the maximum "
          "relative difference",
          "1",
          worst,
          0.0,
          1e-5,
          ""};
}

struct Joints {
  Vector3d angle, rate;
};

Vector3d mean_force(const Chain& chain, const Joints& before, const Joints& after, double step_s,
                    const Vector3d& lever_m, double gravity_m_s2) {
  const Joints middle{0.5 * (before.angle + after.angle) + 0.125 * step_s * (before.rate - after.rate),
                      1.5 / step_s * (after.angle - before.angle) - 0.25 * (before.rate + after.rate)};
  const auto at = [&](const Joints& now) { return chain.specific_force_W(now.angle, now.rate, lever_m, gravity_m_s2); };
  const Vector3d f_W = (at(before) + 4.0 * at(middle) + at(after)) / 6.0;
  return Eigen::AngleAxisd(-0.5 * (before.angle[2] + after.angle[2]), Vector3d::UnitY()) * f_W;
}

CertificateEntry force(const CertificateInput& input, const PendulumSetup& setup) {
  constexpr double kDuration_s = 3.0;
  const Vector3d lever_m(0.0, 0.017, 0.02);
  Pendulum pendulum(input, setup.integrator);
  const double gravity_m_s2 = pendulum.trial().gravity_m_s2();
  const Chain chain(kSegment_m, gravity_m_s2);

  pendulum.set(kWildAngle, kWildRate);
  std::vector<Vector3d> expected;
  Joints before{pendulum.angle(), pendulum.rate()};
  const std::int64_t steps = std::llround(kDuration_s / pendulum.trial().step_s());
  for (std::int64_t k = 0; k < steps; ++k) {
    pendulum.trial().step();
    const Joints after{pendulum.angle(), pendulum.rate()};
    expected.push_back(mean_force(chain, before, after, pendulum.trial().step_s(), lever_m, gravity_m_s2));
    before = after;
  }

  Pendulum again(input, setup.integrator);
  again.set(kWildAngle, kWildRate);
  const sim::Truth truth = fly(again.trial(), kDuration_s);
  sim::SensorSpec ideal;
  ideal.name = "imu";
  ideal.kind = "imu";
  ideal.values.set("output_rate_hz", 1.0 / again.trial().step_s());
  ideal.values = sim::resolve("certificate.imu", ideal.values, sim::imu_parameters());
  Eigen::Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.translation() = lever_m + Vector3d(0.0, 0.0, setup.lever_arm_error_m);
  sim::ImuRecord record;
  sim::ImuTruth imu_truth;
  sim::simulate_imu(truth, ideal, T_BI, gravity_m_s2, 1, record, imu_truth);

  double largest_m_s2 = record.accel_m_s2.size() == expected.size() ? 0.0 : std::nan("");
  for (std::size_t k = 0; k < expected.size(); ++k) {
    largest_m_s2 = larger(largest_m_s2, (record.accel_m_s2.at(k) - expected[k]).norm());
  }
  return {"pendulum_specific_force",
          "pendulum",
          "an ideal accelerometer on the lowest segment agrees with Lagrange's equations; the value is the maximum "
          "difference",
          "m/s^2",
          largest_m_s2,
          0.0,
          1e-5,
          ""};
}

}  // namespace

std::vector<CertificateEntry> certify_pendulum(const CertificateInput& input, const PendulumSetup& setup) {
  return {energy(input, setup), periods(input, setup), force(input, setup)};
}

}  // namespace tumble::scenarios
