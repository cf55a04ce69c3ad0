// SPDX-License-Identifier: BSD-3-Clause
// Tests the motion type on motion in closed form: the body spins about its own axis; the force is that of a hand, of
// flight or of the ground, in the order that the test names.
#include "tumble/attitude/detail/regimes.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

const Vector3d kLever_m(-0.02, -0.085, 0.055);
const Matrix3d kLeverCovariance_m2 = 1e-6 * Matrix3d::Identity();
constexpr double kG = 9.80665;

enum class Regime { flight, contact, hand_held };

struct RegimeRecording {
  std::vector<ImuSample> samples;
  std::vector<AngularRateState> rates;

  /// Adds more of this regime at 100 Hz: gravity rotating in the sensor, a hand or the ground pushing by `push_m_s2`,
  /// or neither.
  void go_on(Regime regime, double length_s, double push_m_s2 = 2.0) {
    std::normal_distribution<double> noise;
    for (int i = 0; i < static_cast<int>(100.0 * length_s + 0.5); ++i) {
      const double t = 0.01 * static_cast<double>(samples.size());
      const Vector3d w(11.0 + std::sin(2.0 * t), 0.6 * std::cos(3.0 * t), -0.5);
      ImuSample sample;
      sample.time_ns = static_cast<TimeNs>(samples.size()) * 10'000'000;
      sample.angular_velocity_rad_s = w;
      const Vector3d alpha(2.0 * std::cos(2.0 * t), -1.8 * std::sin(3.0 * t), 0.0);
      const Vector3d turning = alpha.cross(kLever_m) + w.cross(w.cross(kLever_m));
      const Vector3d up(0.2, std::sin(11.0 * t), std::cos(11.0 * t));
      const double z = noise(gen), y = noise(gen), x = noise(gen);
      const Vector3d random(x, y, z);
      if (regime == Regime::hand_held) sample.specific_force_m_s2 = kG * up.normalized() + push_m_s2 * random;
      if (regime == Regime::flight) sample.specific_force_m_s2 = turning + 0.05 * random;
      if (regime == Regime::contact) sample.specific_force_m_s2 = turning + push_m_s2 * random;
      AngularRateState rate;
      rate.time_ns = sample.time_ns;
      rate.w_WI_I_rad_s = w;
      rate.covariance_rad2_s2 = 1e-4 * Matrix3d::Identity();
      rate.clipped_axes = 1;
      samples.push_back(sample);
      rates.push_back(rate);
      truth.push_back(regime);
    }
  }

  std::vector<RegimeProbabilities> found() const {
    std::vector<RegimeProbabilities> out;
    EXPECT_TRUE(MotionRegimeEvidence({}).find(samples, rates, kLever_m, kLeverCovariance_m2, out).ok());
    return out;
  }

  /// Returns the fraction of the samples of `regime` that are classified as hand-held, except within 0.1 s of a change.
  double called_carried(Regime regime) const {
    const std::vector<RegimeProbabilities> probabilities = found();
    double of = 0.0, called = 0.0;
    for (std::size_t k = 10; k + 10 < truth.size(); ++k) {
      if (truth[k] != regime || truth[k - 10] != regime || truth[k + 10] != regime) continue;
      of += 1.0;
      called += probabilities[k].hand_held > 0.5 ? 1.0 : 0.0;
    }
    EXPECT_GT(of, 5.0);
    return called / of;
  }

  std::vector<Regime> truth;
  std::mt19937 gen{7};
};

TEST(Regimes, EachAloneIsFound) {
  for (const Regime regime : {Regime::flight, Regime::hand_held}) {
    RegimeRecording motion;
    motion.go_on(regime, 3.0);
    std::size_t right = 0;
    double off = 0.0;
    for (const RegimeProbabilities& probabilities : motion.found()) {
      right += (regime == Regime::flight ? probabilities.flight : probabilities.hand_held) > 0.5;
      off = std::max(off, std::abs(probabilities.flight + probabilities.contact + probabilities.hand_held - 1.0));
    }
    EXPECT_EQ(right, motion.samples.size());
    EXPECT_LT(off, 1e-12);
  }
}

TEST(Regimes, AHandHeldBodyThatIsThrownIsDetectedInFlight) {
  RegimeRecording motion;
  motion.go_on(Regime::hand_held, 3.0);
  motion.go_on(Regime::flight, 0.6);
  motion.go_on(Regime::hand_held, 3.0);
  EXPECT_EQ(motion.called_carried(Regime::flight), 0.0);
  EXPECT_EQ(motion.called_carried(Regime::hand_held), 1.0);
}

TEST(Regimes, ABodyThatIsCaughtInFlightIsFoundInTheHand) {
  RegimeRecording motion;
  motion.go_on(Regime::flight, 0.6);
  motion.go_on(Regime::hand_held, 3.0);
  motion.go_on(Regime::flight, 0.6);
  EXPECT_EQ(motion.called_carried(Regime::flight), 0.0);
  EXPECT_EQ(motion.called_carried(Regime::hand_held), 1.0);
}

TEST(Regimes, ATumbleIsNoHand) {
  RegimeRecording motion;
  for (int i = 0; i < 10; ++i) {
    motion.go_on(Regime::flight, 0.3);
    motion.go_on(Regime::contact, 0.06, 60.0);
  }
  // except for the first and last moments, beyond which any motion is possible
  EXPECT_EQ(motion.called_carried(Regime::flight), 0.0);
  double most = 0.0;
  const std::vector<RegimeProbabilities> probabilities = motion.found();
  for (std::size_t k = 30; k + 30 < probabilities.size(); ++k) most = std::max(most, probabilities[k].hand_held);
  EXPECT_LT(most, 1e-3);
}

TEST(Regimes, AQuietMomentOnTheGroundBetweenFlightsIsNoHand) {
  // as gentle as a hand: only the neighbouring samples decide
  RegimeRecording motion;
  motion.go_on(Regime::flight, 0.5);
  motion.go_on(Regime::hand_held, 0.3);
  motion.go_on(Regime::flight, 0.5);
  EXPECT_EQ(motion.called_carried(Regime::hand_held), 0.0);
}

TEST(Regimes, ARoughHandIsAHand) {
  RegimeRecording motion;
  motion.go_on(Regime::hand_held, 4.0, 8.0);
  EXPECT_EQ(motion.called_carried(Regime::hand_held), 1.0);
}

TEST(Regimes, ABodyThatDoesNotTurnSaysNothingOfWhoHoldsIt) {
  RegimeRecording motion;
  motion.go_on(Regime::hand_held, 2.0, 0.0);
  for (AngularRateState& rate : motion.rates) rate.w_WI_I_rad_s *= 0.01;
  double most = 0.0;
  for (const RegimeProbabilities& probabilities : motion.found()) most = std::max(most, probabilities.hand_held);
  EXPECT_NEAR(most, 1.0 / 3.0, 0.01);
}

TEST(Regimes, EitherHoldsBothAnswers) {
  AngularRateState first, second;
  first.covariance_rad2_s2 = 0.01 * Matrix3d::Identity();
  second.covariance_rad2_s2 = 0.04 * Matrix3d::Identity();
  second.w_WI_I_rad_s = Vector3d(3.0, 0.0, 0.0);
  second.source = AngularRateSource::lower_bound_only;
  const AngularRateState sure = mix_rate_states(first, second, 0.0);
  EXPECT_EQ(sure.w_WI_I_rad_s, first.w_WI_I_rad_s);
  EXPECT_EQ(sure.covariance_rad2_s2, first.covariance_rad2_s2);
  const AngularRateState open = mix_rate_states(first, second, 0.6);
  EXPECT_EQ(open.w_WI_I_rad_s, second.w_WI_I_rad_s);
  EXPECT_EQ(open.source, AngularRateSource::lower_bound_only);
  // 0.4 * 0.01 + 0.6 * 0.04 + 0.4 * 3^2, about the reported rate
  EXPECT_NEAR(open.covariance_rad2_s2(0, 0), 3.628, 1e-12);
  EXPECT_NEAR(open.covariance_rad2_s2(1, 1), 0.028, 1e-12);
}

TEST(Regimes, RefusesWhatDoesNotBelongTogether) {
  RegimeRecording motion;
  motion.go_on(Regime::flight, 0.1);
  std::vector<RegimeProbabilities> out(3);
  const MotionRegimeEvidence evidence({});
  EXPECT_EQ(evidence.find({}, {}, kLever_m, kLeverCovariance_m2, out).error_code, ErrorCode::empty);
  motion.rates.pop_back();
  EXPECT_EQ(evidence.find(motion.samples, motion.rates, kLever_m, kLeverCovariance_m2, out).error_code,
            ErrorCode::out_of_range);
  EXPECT_TRUE(out.empty());
  EXPECT_THROW(MotionRegimeEvidence({.gravity_m_s2 = 0.0}), InvalidParams);
}

}  // namespace
}  // namespace tumble
