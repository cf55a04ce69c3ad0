// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/flight_sign_check.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

constexpr double kFlightPeriod_s = 0.01;
const Eigen::Vector3d kFlightArm_m(0.06, -0.05, 0.08);

ImuSample flight_sample(int k, const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& force_m_s2) {
  ImuSample out;
  out.time_ns = static_cast<TimeNs>(k) * 10'000'000;
  out.angular_velocity_rad_s = rate_rad_s;
  out.specific_force_m_s2 = force_m_s2;
  return out;
}

/// Returns a body with three different moments that flies without torque for a second (Euler's equations, small steps)
/// after half a second of rest, with data sheet noise.
std::vector<ImuSample> thrown_flight() {
  constexpr int kSteps = 100;
  const Eigen::Vector3d inertia(2.2, 1.6, 1.0);
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  std::vector<ImuSample> out;
  for (int k = 0; k < 50; ++k) out.push_back(flight_sample(k, Eigen::Vector3d::Zero(), {0.0, 0.0, 9.81}));
  Eigen::Vector3d w(8.0, 3.0, 4.0);
  for (int k = 50; k < 150; ++k) {
    Eigen::Vector3d alpha;
    for (int step = 0; step < kSteps; ++step) {
      alpha = (inertia.cwiseProduct(w).cross(w)).cwiseQuotient(inertia);
      w += kFlightPeriod_s / kSteps * alpha;
    }
    out.push_back(flight_sample(k, w, alpha.cross(kFlightArm_m) + w.cross(w.cross(kFlightArm_m))));
  }
  for (ImuSample& sample : out) {
    for (int axis = 0; axis < 3; ++axis) {
      sample.angular_velocity_rad_s[axis] += 0.005 * noise(random);
      sample.specific_force_m_s2[axis] += 0.05 * noise(random);
    }
  }
  return out;
}

/// Returns a body that a hand swings, without gravity, at 4 rad/s or more; its lever arm from the hand differs from
/// that to the mass centre.
std::vector<ImuSample> swung(const Eigen::Vector3d& arm_m) {
  std::vector<ImuSample> out;
  for (int k = 0; k < 150; ++k) {
    const double t = k * kFlightPeriod_s;
    const Eigen::Vector3d w(4.0 + 2.0 * std::sin(3.0 * t), 5.0 * std::cos(2.0 * t), 3.0),
        alpha(6.0 * std::cos(3.0 * t), -10.0 * std::sin(2.0 * t), 0.0);
    out.push_back(flight_sample(k, w, alpha.cross(arm_m) + w.cross(w.cross(arm_m))));
  }
  return out;
}

FlightSignCheck::Setup flight_setup(FlightSignCheck::BodyMotionType body, double range_rad_s) {
  FlightSignCheck::Setup setup;
  setup.motion_type = body;
  setup.lever_arm_m = kFlightArm_m;
  setup.gyro_range_rad_s = range_rad_s;
  return setup;
}

std::string sense_told(std::vector<ImuSample> samples, FlightSignCheck::BodyMotionType body, double range_rad_s,
                       const std::function<void(ImuSample&)>& harm) {
  const FlightSignCheck sense(flight_setup(body, range_rad_s));
  FlightSignCheck::State state;
  for (ImuSample& sample : samples) {
    harm(sample);
    for (double& rate : sample.angular_velocity_rad_s) rate = std::clamp(rate, -range_rad_s, range_rad_s);
    sense.step(sample, state);
  }
  const Status status = sense.verdict(state);
  return status.ok() ? "" : std::string(status.field).substr(std::string("flight time in s").size());
}

const std::vector<std::pair<std::string, std::function<void(ImuSample&)>>>& other_senses() {
  static const std::vector<std::pair<std::string, std::function<void(ImuSample&)>>> all = {
      {" that agrees with an inverted accelerometer", [](ImuSample& s) { s.specific_force_m_s2 *= -1.0; }},
      {" that agrees with an inverted accelerometer axis x", [](ImuSample& s) { s.specific_force_m_s2.x() *= -1.0; }},
      {" that agrees with an inverted accelerometer axis z", [](ImuSample& s) { s.specific_force_m_s2.z() *= -1.0; }}};
  return all;
}

TEST(FlightSignCheck, EachOtherSensorIsReportedByItsName) {
  EXPECT_EQ(sense_told(thrown_flight(), FlightSignCheck::BodyMotionType::always_thrown, 100.0, [](ImuSample&) {}), "");
  for (const auto& [name, harm] : other_senses())
    EXPECT_EQ(sense_told(thrown_flight(), FlightSignCheck::BodyMotionType::always_thrown, 100.0, harm), name);
}

// The force determines the rate of the clipped axis, and the remaining force determines the sign.
TEST(FlightSignCheck, AFlightInWhichAnAxisClipsShowsAsMuch) {
  constexpr double kRange_rad_s = 6.5;
  std::size_t clipped = 0;
  for (const ImuSample& sample : thrown_flight())
    clipped += (sample.angular_velocity_rad_s.array().abs() > kRange_rad_s).count() == 1 ? 1 : 0;
  ASSERT_GT(clipped, 30U) << "nothing clips";
  EXPECT_EQ(
      sense_told(thrown_flight(), FlightSignCheck::BodyMotionType::always_thrown, kRange_rad_s, [](ImuSample&) {}), "");
  for (const auto& [name, harm] : other_senses())
    EXPECT_EQ(sense_told(thrown_flight(), FlightSignCheck::BodyMotionType::always_thrown, kRange_rad_s, harm), name);
}

// A body that is swung about a point on the other side of the mass centre feels what a mirrored sensor would feel in
// flight.
TEST(FlightSignCheck, OnABodyThatMayBeHandHeldOnlyTheClearestIsReported) {
  const auto nothing = [](ImuSample&) {};
  const Eigen::Vector3d mirrored = kFlightArm_m.cwiseProduct(Eigen::Vector3d(-1.0, 1.0, 1.0));
  const auto x_flipped = [](ImuSample& s) { s.specific_force_m_s2.x() *= -1.0; };
  EXPECT_EQ(sense_told(thrown_flight(), FlightSignCheck::BodyMotionType::possibly_hand_held, 100.0, x_flipped), "");
  EXPECT_EQ(
      sense_told(thrown_flight(), FlightSignCheck::BodyMotionType::possibly_hand_held, 100.0, other_senses()[0].second),
      other_senses()[0].first);
  EXPECT_EQ(sense_told(swung(mirrored), FlightSignCheck::BodyMotionType::possibly_hand_held, 100.0, nothing), "");
  EXPECT_EQ(sense_told(swung(kFlightArm_m), FlightSignCheck::BodyMotionType::always_thrown, 100.0, nothing), "");
  EXPECT_NE(sense_told(swung(-kFlightArm_m), FlightSignCheck::BodyMotionType::always_thrown, 100.0, nothing), "")
      << "the lever arm's own sense";
}

TEST(FlightSignCheck, OfABodyAtRestOrWithoutALeverArmNothingIsSaid) {
  std::vector<ImuSample> rest;
  for (int k = 0; k < 500; ++k) rest.push_back(flight_sample(k, {0.001, 0.0, 0.0}, {0.0, 0.0, -9.81}));
  EXPECT_EQ(sense_told(rest, FlightSignCheck::BodyMotionType::always_thrown, 100.0, [](ImuSample&) {}), "");
  FlightSignCheck::Setup setup = flight_setup(FlightSignCheck::BodyMotionType::always_thrown, 100.0);
  setup.lever_arm_m.setZero();
  const FlightSignCheck sense(setup);
  FlightSignCheck::State state;
  for (const ImuSample& sample : thrown_flight()) sense.step(sample, state);
  EXPECT_TRUE(sense.verdict(state).ok());
}

}  // namespace
}  // namespace tumble
