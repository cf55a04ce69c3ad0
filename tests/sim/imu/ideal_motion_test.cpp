// SPDX-License-Identifier: BSD-3-Clause
// The test checks the ideal signal: an IMU without errors measures the true motion, in flight and through impacts, at
// any rate.
#include "oracles/torque_free_rotation.hpp"
#include "sim/imu/imu_simulation.hpp"
#include "sim/simulate.hpp"
#include "tests/sim/engine/worlds.hpp"
#include "tests/sim/imu/simulated_imu.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

constexpr double kStep_s = 0.0005;

Isometry3d mounting(const Vector3d& p_BI_m) {
  Isometry3d T_BI = Eigen::Isometry3d::Identity();
  T_BI.linear() = Eigen::AngleAxisd(0.7, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  T_BI.translation() = p_BI_m;
  return T_BI;
}

/// Returns free flight at 18 rad/s near the unstable axis of a body like the rig, in closed form.
Truth flight(double duration_s) {
  const oracles::TorqueFreeRotation rotation({0.14, 0.161, 0.154}, {0.3, 0.2, 18.0});
  Truth truth;
  for (int k = 0; k <= std::lround(duration_s / kStep_s); ++k) {
    const double t = k * kStep_s;
    const Vector3d g(0, 0, -kGravity_m_s2), v0(1.5, -0.5, 8.0);
    truth.q_WB.push_back(rotation.attitude(t));
    truth.w_WB_B_rad_s.push_back(rotation.rate(t));
    truth.v_WB_m_s.push_back(v0 + g * t);
    truth.p_WB_m.push_back(v0 * t + 0.5 * g * t * t);
  }
  return truth;
}

/// Returns the same flight with impacts: every 0.1 s velocity and rate jump within one step, and the body spins on from
/// there.
Truth flight_with_impacts(double duration_s) {
  Truth truth;
  Quaterniond q = Quaterniond::Identity();
  Vector3d v(1.5, -0.5, 8.0), w(0.3, 0.2, 18.0), p = Vector3d::Zero();
  for (int k = 0; k <= std::lround(duration_s / kStep_s); ++k) {
    if (k % 200 == 37) {
      v += Vector3d(0.8, -0.3 * (k % 7), 1.1);
      w = Vector3d(w.y(), 0.7 * w.z(), -0.9 * w.x() - 9.0);
    }
    truth.q_WB.push_back(q);
    truth.w_WB_B_rad_s.push_back(w);
    truth.v_WB_m_s.push_back(v);
    truth.p_WB_m.push_back(p);
    q = q * Quaterniond(Eigen::AngleAxisd(w.norm() * kStep_s, w.normalized()));
    v.z() -= kGravity_m_s2 * kStep_s;
    p += v * kStep_s;
  }
  return truth;
}

SimulatedImu ideal_imu(const Truth& truth, double rate_hz, const Isometry3d& T_BI) {
  SensorSpec sensor = imu_at("imu", "", rate_hz);
  sensor.values = resolve("sensors.imu", sensor.values, imu_parameters());
  return simulated(truth, sensor, T_BI);
}

struct Departure {
  double attitude_rad = 0.0, velocity_m_s = 0.0;
};

/// Returns the largest deviation, over all samples, of the integrated samples from the true attitude and velocity at
/// T_BI.
Departure dead_reckon(const ImuRecord& imu, const Truth& truth, const Isometry3d& T_BI) {
  const auto velocity = [&](std::size_t k) -> Vector3d {
    return truth.v_WB_m_s[k] + truth.q_WB[k] * truth.w_WB_B_rad_s[k].cross(T_BI.translation());
  };
  const Quaterniond q_BI(T_BI.linear());
  Quaterniond q = truth.q_WB[0] * q_BI;
  Vector3d v = velocity(0);
  Departure worst;
  const double dt = static_cast<double>(imu.period_ns) * 1e-9;
  for (std::size_t i = 0; i < imu.time_ns.size(); ++i) {
    const Vector3d turn = imu.gyro_rad_s[i] * dt;
    const Quaterniond half(Eigen::AngleAxisd(turn.norm() / 2, turn.normalized()));
    v += ((q * half) * imu.accel_m_s2[i] - Vector3d(0, 0, kGravity_m_s2)) * dt;
    q = q * half * half;
    const auto k = static_cast<std::size_t>(imu.time_ns[i] / truth.period_ns);
    worst.attitude_rad = std::max(worst.attitude_rad, q.angularDistance(truth.q_WB[k] * q_BI));
    worst.velocity_m_s = std::max(worst.velocity_m_s, (v - velocity(k)).norm());
  }
  return worst;
}

TEST(IdealMotion, CentreOfMassFeelsNothingInFlight) {
  const Truth truth = flight(2.0);
  for (const double rate_hz : {100.0, 200.0, 250.0, 400.0, 2000.0}) {
    const SimulatedImu r = ideal_imu(truth, rate_hz, mounting(Vector3d::Zero()));
    ASSERT_EQ(r.record.accel_m_s2.size(), static_cast<std::size_t>(2.0 * rate_hz));
    for (const Vector3d& f : r.record.accel_m_s2) ASSERT_LT(f.norm(), 1e-6) << rate_hz;  // measured 4e-12
  }
}

TEST(IdealMotion, AMillimetreBesideTheCentreOfMassIsFelt) {
  // negative control of the test above: away from the axis there is w^2 r = 0.32 m/s^2
  const SimulatedImu r = ideal_imu(flight(0.5), 100.0, mounting({0.001, 0, 0}));
  ASSERT_FALSE(r.record.accel_m_s2.empty());
  for (const Vector3d& f : r.record.accel_m_s2) ASSERT_GT(f.norm(), 1e-3);
}

TEST(IdealMotion, LeverArmFeelsWhatTheClosedFormSays) {
  // at 2000 Hz a step turns by 9 mrad: its mean differs from the middle by (9e-3)^2/24 and by the jerk, together 1e-5
  const oracles::TorqueFreeRotation rotation({0.14, 0.161, 0.154}, {0.3, 0.2, 18.0});
  const Isometry3d T_BI = mounting({-0.022, -0.085, 0.055});
  const SimulatedImu r = ideal_imu(flight(0.5), 2000.0, T_BI);
  ASSERT_EQ(r.record.accel_m_s2.size(), 1000u);
  for (std::size_t i = 0; i < 1000; ++i) {
    const double middle_s = (static_cast<double>(i) + 0.5) * kStep_s;
    const Vector3d f = T_BI.linear().transpose() * rotation.specific_force(middle_s, T_BI.translation());
    const Vector3d w = T_BI.linear().transpose() * rotation.rate(middle_s);
    ASSERT_NEAR((r.record.accel_m_s2[i] - f).norm(), 0.0, 1e-3);  // of 28 m/s^2
    ASSERT_NEAR((r.record.gyro_rad_s[i] - w).norm(), 0.0, 1e-4);
  }
}

TEST(IdealMotion, SamplesIntegrateToTheMotionThroughImpactsAtEveryRate) {
  const Truth truth = flight_with_impacts(2.0);
  const Isometry3d T_BI = mounting({-0.022, -0.085, 0.055});
  for (const double rate_hz : {100.0, 200.0, 250.0, 400.0, 2000.0}) {
    const SimulatedImu r = ideal_imu(truth, rate_hz, T_BI);
    const Departure d = dead_reckon(r.record, truth, T_BI);
    EXPECT_LT(d.attitude_rad, 1e-7) << rate_hz;  // acos near 1 resolves 1.5e-8
    EXPECT_LT(d.velocity_m_s, 1e-9) << rate_hz;
  }
}

TEST(IdealMotion, SamplesIntegrateToTheMotionOfTheEngine) {
  const Recording recording = simulate(built(tumble_down(3.0, 100.0)));
  const ImuTruth& imu_truth = recording.truth.imus[0];
  const Departure d = dead_reckon(recording.sensors.imus[0], recording.truth, imu_truth.T_BI);
  EXPECT_LT(d.attitude_rad, 1e-7);
  EXPECT_LT(d.velocity_m_s, 1e-9);
  double peak_m_s2 = 0.0;
  for (const Vector3d& f : recording.sensors.imus[0].accel_m_s2) peak_m_s2 = std::max(peak_m_s2, f.norm());
  EXPECT_GT(peak_m_s2, 40.0);  // it must hit the ground
}

TEST(IdealMotion, PlainMeansWouldNotIntegrateToTheMotion) {
  // negative control: the means of the steps' rates ignore that the window turns
  const Truth truth = flight_with_impacts(2.0);
  const Isometry3d T_BI = mounting({-0.022, -0.085, 0.055});
  const SimulatedImu fine = ideal_imu(truth, 2000.0, T_BI);
  SimulatedImu coarse = ideal_imu(truth, 100.0, T_BI);
  for (std::size_t i = 0; i < coarse.record.time_ns.size(); ++i) {
    coarse.record.gyro_rad_s[i].setZero();
    coarse.record.accel_m_s2[i].setZero();
    for (std::size_t k = 20 * i; k < 20 * i + 20; ++k) {
      coarse.record.gyro_rad_s[i] += fine.record.gyro_rad_s[k] / 20.0;
      coarse.record.accel_m_s2[i] += fine.record.accel_m_s2[k] / 20.0;
    }
  }
  const Departure d = dead_reckon(coarse.record, truth, T_BI);
  EXPECT_GT(d.attitude_rad, 1e-3);
  EXPECT_GT(d.velocity_m_s, 1e-2);
}

TEST(IdealMotion, ImpulseAndTimeOfAnImpactDoNotDependOnTheSamplingPhase) {
  // a body at rest is struck within one step; the window with that step contains the whole impulse
  const Vector3d struck_m_s(0.7, -0.2, 1.3);
  double mean_error_s = 0.0;
  constexpr std::size_t kPhases = 20;
  for (std::size_t phase = 0; phase < kPhases; ++phase) {
    Truth truth;
    const std::size_t impact = 200 + phase;  // the step that ends with this sample
    for (std::size_t k = 0; k <= 600; ++k) {
      truth.q_WB.push_back(Quaterniond::Identity());
      truth.w_WB_B_rad_s.push_back(Vector3d::Zero());
      truth.p_WB_m.push_back(Vector3d::Zero());
      truth.v_WB_m_s.push_back(k >= impact ? struck_m_s : Vector3d::Zero());
    }
    const SimulatedImu r = ideal_imu(truth, 100.0, Eigen::Isometry3d::Identity());
    Vector3d impulse_m_s = Vector3d::Zero();
    double moment = 0.0;
    for (std::size_t i = 0; i < r.record.time_ns.size(); ++i) {
      const Vector3d gained = (r.record.accel_m_s2[i] - Vector3d(0, 0, kGravity_m_s2)) * 0.01;
      impulse_m_s += gained;
      moment += gained.norm() * (static_cast<double>(r.record.time_ns[i]) * 1e-9 - 0.005);
    }
    ASSERT_NEAR((impulse_m_s - struck_m_s).norm(), 0.0, 1e-12) << "phase " << phase;
    const double error_s = moment / struck_m_s.norm() - (static_cast<double>(impact) - 0.5) * kStep_s;
    EXPECT_LE(std::abs(error_s), 0.005 - 0.5 * kStep_s + 1e-12) << "phase " << phase;  // half a window, no step late
    mean_error_s += error_s / kPhases;
  }
  EXPECT_NEAR(mean_error_s, 0.0, 1e-12);  // one step late would give 0.5 ms
}

}  // namespace
}  // namespace tumble::sim
