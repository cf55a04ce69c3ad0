// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/tumble_attitude.hpp"

#include "estimator/attitude/filter_contract.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/vqf.hpp"

namespace tumble {
namespace {

using testing::kGravity_m_s2;
using testing::kPeriod_ns;
using testing::tilt;

TEST(TumbleAttitude, ContractOfEveryFilter) {
  const TumbleAttitude filter({});
  testing::expect_split_runs_equal(filter);
  testing::expect_bad_input_refused(filter);
  testing::expect_sign_of_q_is_free(filter);
}

TEST(TumbleAttitude, RefusesBadParams) {
  EXPECT_THROW(TumbleAttitude({.gravity_m_s2 = 0.0}), InvalidParams);
  EXPECT_THROW(TumbleAttitude({.radius_m = -1.0}), InvalidParams);
  EXPECT_THROW(TumbleAttitude({.radius_m = std::numeric_limits<double>::quiet_NaN()}), InvalidParams);
  EXPECT_THROW(TumbleAttitude({.lever_arm_m = {9.0, 9.0, 0.0}}), InvalidParams) << "longer than 10 m";
}

TEST(TumbleAttitude, AtRestTheBiasIsEstimatedAndTheAttitudeIsConstant) {
  const TumbleAttitude filter({});
  const Eigen::Vector3d bias(0.005, -0.004, 0.006);
  TumbleAttitude::State state, after_2s;
  for (int k = 0; k <= 15000; ++k) {
    // a gyro with noise of 1 deg/s about its bias, an accelerometer with 0.02 m/s^2
    const double noise = k % 2 == 0 ? 1.0 : -1.0;
    const ImuSample sample{
        k * kPeriod_ns, bias + Eigen::Vector3d::Constant(0.017 * noise), {0.02 * noise, 0.0, kGravity_m_s2}, 0};
    ASSERT_TRUE(filter.step(sample, state).ok());
    if (k == 500) after_2s = state;
  }
  EXPECT_TRUE(after_2s.at_rest);
  EXPECT_NEAR((state.bias_rad_s - bias).norm(), 0.0, 1e-4);  // measured 3e-6
  // with a gyro alone, a vertical bias of 0.34 deg/s gives a heading error of 20 deg per minute
  EXPECT_NEAR(so3::logarithm(after_2s.q_WI.conjugate() * state.q_WI).z(), 0.0, 1e-9);
  EXPECT_NEAR(tilt(state.q_WI), 0.0, 1e-4);
}

TEST(TumbleAttitude, SlowTurnAfterTheBiasIsKnownIsNotRest) {
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  const double turn = 0.05;  // 2.9 deg/s, smooth
  for (int k = 0; k <= 5000; ++k) {
    const double rate = k > 1250 ? turn : 0.0;
    ASSERT_TRUE(filter.step({k * kPeriod_ns, {0, 0, rate}, {0, 0, kGravity_m_s2}, 0}, state).ok());
  }
  EXPECT_FALSE(state.at_rest);
  // 15 s; the rotation before its detection is part of a sample's low-pass: measured 3 mrad
  EXPECT_NEAR(so3::logarithm(state.q_WI).z(), turn * 15.0, 0.01);
}

// A sphere that has rolled keeps turning about its contact, too slowly for the detector alone: attitude.md (A16)
TEST(TumbleAttitude, ACreepingTurnAfterTheBiasIsKnownIsNotRest) {
  constexpr double kCreep = 0.02;  // rad/s
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  for (int k = 0; k <= 5000; ++k) {
    const double rate = k <= 1250 ? 0.0 : k <= 1750 ? 6.0 : kCreep;
    ASSERT_TRUE(filter.step({k * kPeriod_ns, {0, 0, rate}, {0, 0, kGravity_m_s2}, 0}, state).ok());
  }
  EXPECT_FALSE(state.at_rest);
  EXPECT_NEAR(state.bias_rad_s.z(), 0.0, 1e-3);
  // negative control: the detector's result without the uncertainty of the bias
  EXPECT_TRUE(state.stationary_state.is_stationary);
}

TEST(TumbleAttitude, AnOscillationTiltsItLessThanVqf) {
  const TumbleAttitude ours({});
  const Vqf other({});
  TumbleAttitude::State a;
  Vqf::State b;
  double worst_a = 0.0, worst_b = 0.0;
  for (int k = 0; k <= 15000; ++k) {
    const double t = k * seconds(kPeriod_ns);
    // velocity amplitude of 0.48 m/s at 1 Hz: 3 m/s^2, an apparent tilt of 17 deg
    const ImuSample sample{
        k * kPeriod_ns, {0, 0, 0}, {3.0 * std::sin(2.0 * std::numbers::pi * t), 0.0, kGravity_m_s2}, 0};
    ASSERT_TRUE(ours.step(sample, a).ok());
    ASSERT_TRUE(other.step(sample, b).ok());
    if (t < 30.0) continue;
    worst_a = std::max(worst_a, tilt(a.q_WI));
    worst_b = std::max(worst_b, tilt(b.q_WI));
  }
  EXPECT_GT(worst_b, 1e-3) << "the input tilts nothing";
  EXPECT_LT(worst_a, 0.5 * worst_b);
}

/// Returns a run down a slope: 2 m/s^2 for 1.5 s, 3 m/s for 1 s, then slowed down; the body turns about its vertical,
/// which is no rest.
std::vector<ImuSample> far_run() {
  std::vector<ImuSample> samples;
  for (int k = 0; k <= 1500; ++k) {
    const double t = k * seconds(kPeriod_ns) - 2.0;
    const double along = t < 0.0 ? 0.0 : t < 1.5 ? 2.0 : t < 2.5 ? 0.0 : t < 4.0 ? -2.0 : 0.0;
    const double heading = t < 0.0 ? 0.0 : 3.0 * t;
    samples.push_back({k * kPeriod_ns,
                       {0.0, 0.0, t < 0.0 ? 0.0 : 3.0},
                       {along * std::cos(heading), -along * std::sin(heading), kGravity_m_s2},
                       0});
  }
  return samples;
}

// attitude.md (A13): 7.5 m are more than a hand's reach, and no tilt within the gyro's uncertainty explains them
TEST(TumbleAttitude, ABodyThatGoesFarIsNotTiltedForIt) {
  const auto worst_tilt = [](const auto& filter) {
    typename std::decay_t<decltype(filter)>::State state;
    double worst = 0.0;
    for (const ImuSample& sample : far_run()) {
      EXPECT_TRUE(filter.step(sample, state).ok());
      worst = std::max(worst, tilt(state.q_WI));
    }
    return worst;
  };
  EXPECT_LT(worst_tilt(TumbleAttitude({})), 0.012);
  EXPECT_GT(worst_tilt(Vqf({})), 0.02);  // negative control: a low-pass of the force
}

/// Returns the state of a body that turns uniformly about its vertical, with a rate about x that is 0.5 rad/s too large
/// between 2 and 2.4 s.
TumbleAttitude::State after_wrong_rates(const TumbleAttitude& filter, const Eigen::Matrix3d& told, double& lost_rad) {
  TumbleAttitude::State state;
  for (int k = 0; k <= 2500; ++k) {
    const bool wrong = k >= 500 && k < 600;
    const ImuSample sample{k * kPeriod_ns, {wrong ? 0.5 : 0.0, 0.0, 0.4}, {0.0, 0.0, kGravity_m_s2}, 0};
    EXPECT_TRUE(filter.step(sample, wrong ? told : Eigen::Matrix3d::Zero(), state).ok());
    if (k == 600) lost_rad = tilt(state.q_WI);
  }
  return state;
}

TEST(TumbleAttitude, ATiltThatARecoveredRateLeavesOpenIsTakenBack) {
  const TumbleAttitude filter({});
  double lost_rad = 0.0;
  const Eigen::Matrix3d told = 0.25 * Eigen::Matrix3d::Identity();
  EXPECT_LT(tilt(after_wrong_rates(filter, told, lost_rad).q_WI), 0.03);
  EXPECT_GT(lost_rad, 0.05);
  // negative control: a rate stated as measured leaves a tilt that the filter treats as motion
  EXPECT_GT(tilt(after_wrong_rates(filter, Eigen::Matrix3d::Zero(), lost_rad).q_WI), 0.06);
}

// attitude.md (A10): an error with deviation s and memory T adds to the heading, after N readings of length h, the
// variance s^2 h^2 (N + 2/(1 - c) (N - 1 - c (1 - c^(N - 1))/(1 - c))) with c = e^(-h/T)
TEST(TumbleAttitude, ARecoveredRatesErrorGrowsAsThatOfItsMemory) {
  constexpr double kSigma_rad_s = 0.1;
  constexpr int kBefore = 100, kReadings = 500;  // both are whole nodes
  const TumbleAttitude filter({});
  const auto after = [&](const Eigen::Matrix3d& told, int last) {
    TumbleAttitude::State state;
    for (int k = 0; k <= last; ++k) {
      const Eigen::Matrix3d covariance = k > kBefore ? told : Eigen::Matrix3d(Eigen::Matrix3d::Zero());
      EXPECT_TRUE(filter.step({k * kPeriod_ns, {0, 0, 0.5}, {0, 0, kGravity_m_s2}, 0}, covariance, state).ok());
    }
    return state;
  };
  const Eigen::Matrix3d told = kSigma_rad_s * kSigma_rad_s * Eigen::Matrix3d::Identity();
  const auto heading_variance = [&](const Eigen::Matrix3d& covariance) {
    return TumbleAttitude::attitude_covariance_rad2(after(covariance, kBefore + kReadings))(2, 2);
  };
  const double h = seconds(kPeriod_ns), c = std::exp(-h / TumbleAttitude::Params::kRecoveredTau_s);
  const double correlated = kReadings - 1.0 - c * (1.0 - std::pow(c, kReadings - 1)) / (1.0 - c);
  const double expected = kSigma_rad_s * kSigma_rad_s * h * h * (kReadings + 2.0 / (1.0 - c) * correlated);
  EXPECT_NEAR(heading_variance(told) - heading_variance(Eigen::Matrix3d::Zero()), expected, 1e-3 * expected);
  // an error that is equal about all axes adds as much to the tilt as to the heading
  const TumbleAttitude::State within_node = after(told, kBefore + kReadings + 5);
  EXPECT_GT(within_node.recovered_angle_variance_rad2[0], 0.0);
  EXPECT_NEAR(within_node.recovered_angle_variance_rad2[0], within_node.recovered_angle_variance_rad2[1], 1e-12);
}

TEST(TumbleAttitude, RefusesACovarianceThatIsNone) {
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  ASSERT_TRUE(filter.step({0, {0, 0, 0}, {0, 0, kGravity_m_s2}, 0}, state).ok());
  const TumbleAttitude::State before = state;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    covariance(1, 1) = bad;
    EXPECT_EQ(filter.step({kPeriod_ns, {0, 0, 0}, {0, 0, kGravity_m_s2}, 0}, covariance, state).error_code,
              ErrorCode::out_of_range);
    EXPECT_TRUE(state == before);
  }
}

TEST(TumbleAttitude, CovarianceStaysAProperOne) {
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  for (const ImuSample& sample : testing::wobble(20000)) {
    ASSERT_TRUE(filter.step(sample, state).ok());
    if (sample.time_ns % 1'000'000'000 != 0) continue;
    const auto eigenvalues =
        Eigen::SelfAdjointEigenSolver<TumbleAttitude::State::Covariance>(state.covariance).eigenvalues();
    // the heading is 0 at the start, and exactly known there
    ASSERT_GT(eigenvalues.minCoeff(), sample.time_ns > 0 ? 0.0 : -1e-15) << seconds(sample.time_ns);
  }
}

TEST(TumbleAttitude, CovarianceShrinksWhereTheForceIsThatOfABodyInPlace) {
  const TumbleAttitude filter({});
  const auto deviation = [&](double shaken_m_s2) {  // back and forth in 5 s
    TumbleAttitude::State state;
    Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
    for (ImuSample sample : testing::wobble(20000)) {
      const Eigen::Quaterniond half = so3::exp(0.5 * seconds(kPeriod_ns) * sample.angular_velocity_rad_s);
      sample.specific_force_m_s2 =
          (q_WI * half).conjugate() *
          Eigen::Vector3d(shaken_m_s2 * std::sin(0.4 * std::numbers::pi * seconds(sample.time_ns)), 0.0, kGravity_m_s2);
      EXPECT_TRUE(filter.step(sample, state).ok());
      q_WI = q_WI * half * half;
    }
    EXPECT_LT(tilt(state.q_WI * q_WI.conjugate()), shaken_m_s2 > 0.0 ? 0.1 : 0.01);
    return std::sqrt(state.covariance(0, 0));
  };
  const double in_place = deviation(0.0);
  EXPECT_LT(in_place, 0.02);
  // negative control: a body that moves 4 m to and fro is less certain
  EXPECT_GT(deviation(6.0), 1.5 * in_place);
}

/// Struck is a body that spins at `before`, is struck within a gap of the readings, and spins at `after`, with its true
/// attitude afterwards.
struct Struck {
  Eigen::Vector3d before_rad_s, after_rad_s;
  double share = 0.5;  ///< time of the strike, as a share of the gap
};

struct BehindGap {
  Eigen::Vector2d tilt_rad = Eigen::Vector2d::Zero();  ///< true minus estimated, axes of W
  double variance_rad2 = 0.0;                          ///< of each tilt axis
  bool at_rest = false;
};

BehindGap behind_gap(const Struck& struck, double gap_s) {
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  TimeNs time_ns = 0;
  const auto step = [&](const Eigen::Vector3d& rate_rad_s) {
    const Eigen::Vector3d up = q.conjugate() * Eigen::Vector3d::UnitZ();
    EXPECT_TRUE(filter.step({time_ns, rate_rad_s, kGravity_m_s2 * up, 0}, state).ok());
  };
  constexpr double kPeriod_s = 4e-3;
  step(struck.before_rad_s);
  for (int k = 0; k < 25; ++k) {
    time_ns += 4'000'000;
    q = (q * so3::exp(kPeriod_s * struck.before_rad_s)).normalized();
    step(struck.before_rad_s);
  }
  time_ns += static_cast<TimeNs>(1e9 * gap_s);
  q = q * so3::exp(struck.share * gap_s * struck.before_rad_s) *
      so3::exp((1.0 - struck.share) * gap_s * struck.after_rad_s);
  step(struck.after_rad_s);
  const Eigen::Vector3d off = so3::logarithm(q * state.q_WI.conjugate());
  return {off.head<2>(), TumbleAttitude::attitude_covariance_rad2(state).diagonal().head<2>().mean(), state.at_rest};
}

// A strike at an unknown time in a gap causes an unknown rotation; attitude.md (A17).
TEST(TumbleAttitude, OverAGapTheCovarianceHoldsWhatAStrikeMakes) {
  std::mt19937 random(11);
  std::normal_distribution<double> rate(0.0, 5.0);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const double gap_s : {0.12, 0.3}) {
    int beyond = 0;
    double sum = 0.0;
    constexpr int kStrikes = 300;
    for (int k = 0; k < kStrikes; ++k) {
      const auto drawn = [&] { return Eigen::Vector3d(rate(random), rate(random), rate(random)); };
      const BehindGap found = behind_gap({drawn(), drawn(), share(random)}, gap_s);
      const double chi2 = found.tilt_rad.squaredNorm() / found.variance_rad2;
      beyond += chi2 > 11.83 ? 1 : 0;  // 99.73 % of two degrees
      sum += chi2;
    }
    EXPECT_LE(beyond, 3) << gap_s;  // measured 0
    EXPECT_GT(sum / kStrikes, 0.4) << gap_s << ": far too wide";
  }
}

// If the rate is equal before and after the gap, the attitude is right, and the variance is that of a random walk.
TEST(TumbleAttitude, OverAGapTheRateGoesOnAndTheVarianceIsThatOfAWalk) {
  constexpr double kGap_s = 0.3;
  const BehindGap found = behind_gap({{3.0, -2.0, 1.0}, {3.0, -2.0, 1.0}}, kGap_s);
  EXPECT_LT(found.tilt_rad.norm(), 0.02);
  const double walk = TumbleAttitude::Params::kGapRateWalk_rad_s_sqrts;
  EXPECT_NEAR(found.variance_rad2, walk * walk * kGap_s * kGap_s * kGap_s / 12.0, 0.1 * found.variance_rad2);
}

TEST(TumbleAttitude, ABodyThatRestsOnBothSidesOfAGapHasRested) {
  const TumbleAttitude filter({});
  TumbleAttitude::State state;
  const auto step = [&](TimeNs time_ns) {
    ASSERT_TRUE(filter.step({time_ns, Eigen::Vector3d::Zero(), {0.0, 0.0, kGravity_m_s2}, 0}, state).ok());
  };
  for (int k = 0; k <= 1000; ++k) step(k * kPeriod_ns);
  ASSERT_TRUE(state.at_rest);
  const double before = TumbleAttitude::attitude_covariance_rad2(state)(0, 0);
  step(1000 * kPeriod_ns + 500'000'000);
  EXPECT_TRUE(state.at_rest);
  EXPECT_LT(TumbleAttitude::attitude_covariance_rad2(state)(0, 0), before + 1e-4);
}

}  // namespace
}  // namespace tumble
