// SPDX-License-Identifier: BSD-3-Clause
#include "sim/simulate.hpp"

#include "sim/compose.hpp"
#include "sim/engine/physics.hpp"
#include "tests/sim/engine/worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// DeadReckoning contains the attitude, velocity and position integrated from the samples of an ideal IMU, next to the
/// truth at its position.
struct DeadReckoning {
  double attitude_rad, velocity_m_s, position_m, peak_m_s2, peak_rad_s;
};

DeadReckoning integrate(const Recording& recording) {
  const ImuRecord& imu = recording.sensors.imus[0];
  const Truth& truth = recording.truth;
  const Isometry3d& T_BI = truth.imus[0].T_BI;
  const auto true_velocity = [&](std::size_t k) -> Vector3d {
    return truth.v_WB_m_s[k] + truth.q_WB[k] * truth.w_WB_B_rad_s[k].cross(T_BI.translation());
  };
  Quaterniond q = truth.q_WB[0] * Quaterniond(T_BI.linear());
  Vector3d v = true_velocity(0), p = truth.p_WB_m[0] + truth.q_WB[0] * T_BI.translation();
  DeadReckoning out{};
  const double dt = static_cast<double>(imu.period_ns) * 1e-9;
  for (std::size_t i = 0; i < imu.time_ns.size(); ++i) {
    const Vector3d turn = imu.gyro_rad_s[i] * dt;
    const Quaterniond half(Eigen::AngleAxisd(turn.norm() / 2, turn.normalized()));
    const Vector3d a = (q * half) * imu.accel_m_s2[i] - Vector3d(0, 0, 9.80665);
    p += v * dt + a * (dt * dt / 2);
    v += a * dt;
    q = q * half * half;
    out.peak_m_s2 = std::max(out.peak_m_s2, imu.accel_m_s2[i].norm());
    out.peak_rad_s = std::max(out.peak_rad_s, imu.gyro_rad_s[i].norm());
  }
  const std::size_t last = truth.q_WB.size() - 1;
  out.attitude_rad = q.angularDistance(truth.q_WB[last] * Quaterniond(T_BI.linear()));
  out.velocity_m_s = (v - true_velocity(last)).norm();
  out.position_m = (p - truth.p_WB_m[last] - truth.q_WB[last] * T_BI.translation()).norm();
  return out;
}

/// Returns a tumble on bumpy ground with two noisy IMUs, of which one random stream has its own seed.
Recording with_stream(const std::string& stream, std::uint64_t seed) {
  Situation situation = tumble_down(2.0, 200.0);
  situation.sensors.push_back(imu_at("other", "vn100", 200.0));
  for (SensorSpec& sensor : situation.sensors) sensor.values.set("gyro_noise_rad_s_sqrt_hz", 0.01);
  if (!stream.empty()) situation.streams[stream] = seed;
  return simulate(built(situation));
}

TEST(Simulate, TheSeedOfOneStreamMovesThisStreamAlone) {
  const Recording run = with_stream("", 0), noise = with_stream("other", 6), ground = with_stream(kWorldStream, 6);
  EXPECT_EQ(noise.truth.p_WB_m, run.truth.p_WB_m);
  EXPECT_EQ(noise.sensors.imus[0].gyro_rad_s, run.sensors.imus[0].gyro_rad_s);
  EXPECT_NE(noise.sensors.imus[1].gyro_rad_s, run.sensors.imus[1].gyro_rad_s);
  EXPECT_NE(ground.truth.p_WB_m, run.truth.p_WB_m);
  // the seed of the run, stated for a stream, changes nothing
  EXPECT_EQ(with_stream("other", 5).sensors.imus[1].gyro_rad_s, run.sensors.imus[1].gyro_rad_s);
  EXPECT_EQ(with_stream(kWorldStream, 5).truth.p_WB_m, run.truth.p_WB_m);
}

TEST(Simulate, IntegralOfTheSamplesIsTheMotionThroughImpacts) {
  const DeadReckoning r = integrate(simulate(built(tumble_down(4.0, 2000.0))));
  EXPECT_GT(r.peak_m_s2, 60.0);  // it must hit the ground
  EXPECT_GT(r.peak_rad_s, 6.0);
  EXPECT_NEAR(r.attitude_rad, 0.0, 1e-8);
  EXPECT_NEAR(r.velocity_m_s, 0.0, 1e-7);
  EXPECT_NEAR(r.position_m, 0.0, 2e-3);  // trapezoid against RK4 within the 0.5 ms of an impact
}

TEST(Simulate, WindowsOf400HzKeepTheMotionUpToConing) {
  const DeadReckoning r = integrate(simulate(built(tumble_down(4.0, 400.0))));
  EXPECT_LT(r.attitude_rad, 0.01);
  EXPECT_LT(r.velocity_m_s, 0.1);
}

TEST(Simulate, SameSituationTwiceGivesTheSameBits) {
  Situation situation = tumble_down(2.0, 100.0);
  situation.sensors[0].values.set("gyro_noise_rad_s_sqrt_hz", 0.001);
  const Recording a = simulate(built(situation)), b = simulate(built(situation), 2);
  ASSERT_EQ(a.truth.p_WB_m.size(), 4001u);
  EXPECT_EQ(a.truth.p_WB_m, b.truth.p_WB_m);
  EXPECT_EQ(a.truth.f_B_m_s2, b.truth.f_B_m_s2);
  EXPECT_EQ(a.sensors.imus[0].gyro_rad_s, b.sensors.imus[0].gyro_rad_s);
  situation.seed = 6;
  const Recording c = simulate(built(situation));
  EXPECT_NE(a.sensors.imus[0].gyro_rad_s, c.sensors.imus[0].gyro_rad_s);
  EXPECT_NE(a.truth.p_WB_m.back(), c.truth.p_WB_m.back());
}

TEST(Simulate, TruthIsCompleteAndBeginsAtRest) {
  const Recording r = simulate(built(tumble_down(2.0, 100.0)));
  const Truth& truth = r.truth;
  const std::size_t count = 4001;
  EXPECT_EQ(truth.period_ns, 500000);
  EXPECT_EQ(truth.q_WB.size(), count);
  EXPECT_EQ(truth.v_WB_m_s.size(), count);
  EXPECT_EQ(truth.w_WB_B_rad_s.size(), count);
  EXPECT_EQ(truth.f_B_m_s2.size(), count);
  EXPECT_EQ(truth.label.size(), count);
  EXPECT_EQ(r.sensors.imus[0].time_ns.size(), 200u);
  double fastest = 0.0;
  for (std::size_t k = 0; k < 1000; ++k) fastest = std::max(fastest, truth.v_WB_m_s[k].norm());
  EXPECT_LT(fastest, 0.005);  // the push starts at 0.5 s
  ASSERT_FALSE(truth.contacts.empty());
  for (const ContactTruth& contact : truth.contacts) {
    ASSERT_GE(contact.surface_id, 0);
    ASSERT_LT(contact.surface_id, static_cast<int>(truth.surfaces.size()));
    ASSERT_NEAR(contact.normal_W.norm(), 1.0, 1e-9);
    ASSERT_NEAR(contact.normal_W.dot(contact.slip_velocity_W_m_s), 0.0, 1e-9);
  }
  // at rest the contacts carry the weight of 8 kg
  double weight_n = 0.0;
  for (const ContactTruth& contact : truth.contacts) {
    if (contact.time_ns == 250'000'000) weight_n += contact.normal_force_n * contact.normal_W.z();
  }
  EXPECT_NEAR(weight_n, 8.0 * 9.80665, 2.0);  // friction supports a part of it on the relief
}

TEST(Simulate, CentreOfMassOffItsPlaceMovesTheTrueMountingAndNotTheCalibration) {
  Situation situation = tumble_down(1.0, 100.0);
  situation.robot.values.set("com_x_m", 0.004);
  situation.sensors[0].mount_error.set("y_m", 0.002);
  situation.sensors[0].mount_error.set("yaw_rad", 0.01);
  const Recording r = simulate(built(situation));
  EXPECT_NEAR((r.truth.imus[0].T_BI.translation() - Vector3d(-0.026, -0.085, 0.055)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((r.sensors.imus[0].T_BI.translation() - Vector3d(-0.022, -0.083, 0.055)).norm(), 0.0, 1e-12);
  const Eigen::AngleAxisd error(r.truth.imus[0].T_BI.linear().transpose() * r.sensors.imus[0].T_BI.linear());
  EXPECT_NEAR((error.angle() * error.axis() - Vector3d(0, 0, 0.01)).norm(), 0.0, 1e-12);
}

TEST(Simulate, AWarningOfTheEngineFailsTheDraw) {
  engine::World world = engine::compose(resolve(tumble_down(1.0, 100.0)), models_folder());
  engine::Physics physics(world);
  BodyState high;
  high.p_WB_m.z() = 10.0;
  physics.set_state(high);
  physics.step({});
  Wrench broken;
  broken.force_W_n.x() = std::numeric_limits<double>::quiet_NaN();
  try {
    for (int k = 0; k < 3; ++k) physics.step(broken);
    FAIL() << "a force that is not a number went through";
  } catch (const SimulationFailure& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("engine warning: bad number"), HasSubstr(" s")));
  }
}

TEST(Simulate, LeavingTheWorldFailsTheDraw) {
  Situation situation = tumble_down(9.0, 100.0);
  situation.motion.values.set("direction_rad", 3.1);
  situation.motion.values.set("velocity_m_s", 10.0);
  situation.motion.values.set("lift_m_s", 10.0);
  EXPECT_THROW(
      {
        try {
          simulate(built(situation));
        } catch (const SimulationFailure& error) {
          EXPECT_THAT(error.what(), HasSubstr("left its world at"));
          throw;
        }
      },
      SimulationFailure);
}

TEST(Simulate, NeverMovingFailsTheDraw) {
  Situation situation = tumble_down(0.4, 100.0);  // ends before the push
  EXPECT_THROW(simulate(built(situation)), SimulationFailure);
}

TEST(Simulate, StayingInTheGroundFailsTheDraw) {
  Situation situation = tumble_down(4.0, 100.0);
  situation.motion.values.set("lift_m_s", 10.0);
  situation.robot.values.set("contact_time_s", 0.15);  // padding so soft that the cage sinks into the ground
  EXPECT_THROW(
      {
        try {
          simulate(built(situation));
        } catch (const SimulationFailure& error) {
          EXPECT_THAT(error.what(), HasSubstr("'imu' was below the ground for"));
          throw;
        }
      },
      SimulationFailure);
}

TEST(Simulate, StartPoseIsWhereTheTruthBegins) {
  const Situation situation = tumble_down(3.0, 100.0);
  const Truth truth = simulate(built(situation)).truth;
  const Isometry3d T_WB = start_pose(built(situation));
  // the rig settles through 3 mm of gap into its soft contacts and leans on uneven ground (measured: 7 mm, 0.040 rad)
  EXPECT_LT((T_WB.translation() - truth.p_WB_m.front()).norm(), 0.03);
  EXPECT_LT(Quaterniond(T_WB.linear()).angularDistance(truth.q_WB.front()), 0.1);
}

TEST(Simulate, AnUnknownSiteNamesTheNearest) {
  Situation situation = tumble_down(1.0, 100.0);
  for (const auto& [site, told] :
       {std::pair{"mti3", "did you mean 'mti30'"}, std::pair{"nowhere", "(known: mti30 vn100"}}) {
    situation.sensors[0].site = site;
    try {
      simulate(built(situation));
      FAIL() << "site " << site << " was accepted";
    } catch (const InvalidSituation& error) {
      EXPECT_THAT(error.what(), HasSubstr(told));
    }
  }
}

TEST(Simulate, AMissingFolderOfModelsIsOneLine) {
  try {
    simulate(BuiltSituation(resolve(tumble_down(1.0, 100.0)), "/nowhere"));
    FAIL() << "no models, no error";
  } catch (const InvalidSituation& error) {
    EXPECT_THAT(error.what(), HasSubstr("rig.xml"));
    EXPECT_THAT(std::string(error.what()), Not(HasSubstr("\n")));
  }
}

}  // namespace
}  // namespace tumble::sim
