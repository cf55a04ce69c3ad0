// SPDX-License-Identifier: BSD-3-Clause
// Tests the hand-held smoother on real recordings if available, and on synthetic replacements: BROAD with its gyro
// clipped at a third of its peak, and the twirled wand of RepoIMU, whose gyro clips at a tilted level with optical
// truth.
#include "estimator/attitude/hand_held_errors.hpp"
#include "stand_ins/broad_trial.hpp"
#include "stand_ins/stand_ins.hpp"
#include "tests/testing.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/common/types.hpp"

namespace tumble {
namespace {

using testing::quantile;

/// Returns the fraction of the raw error that must be removed.
double share_wanted(const std::string& trial) {
  static const std::map<std::string, double> wanted = {
      {test::kStandInTrial, 0.60},
      // measured 0.735, 0.885, 0.813, 0.781, 0.546, 0.775, 0.631, 0.688, minus 0.02 to 0.08
      {"05", 0.70},
      {"07", 0.84},
      {"09", 0.77},
      {"11", 0.74},
      {"14", 0.51},
      {"16", 0.74},
      {"24", 0.59},
      {"27", 0.61}};
  return wanted.at(trial);
}

void expect_smaller_errors_while_clipped(const std::string& number) {
  const testing::BroadTrial trial = testing::read_broad_trial(number);
  const auto size = [](const ImuSample& s) { return s.angular_velocity_rad_s.cwiseAbs().maxCoeff(); };
  const auto peak = std::max_element(trial.samples.begin(), trial.samples.end(),
                                     [&](const ImuSample& a, const ImuSample& b) { return size(a) < size(b); });
  const double rail = size(*peak) / 3.0;
  std::vector<ImuSample> samples;
  std::vector<Eigen::Vector3d> truth;
  std::vector<ClipSigns> signs;
  for (const ImuSample& sample : trial.samples) {
    if (std::abs(seconds(sample.time_ns - peak->time_ns)) > 20.0) continue;
    samples.push_back(sample);
    truth.push_back(sample.angular_velocity_rad_s);
    ClipSigns sign;
    for (int j = 0; j < 3; ++j) {
      double& w = samples.back().angular_velocity_rad_s[j];
      if (std::abs(w) <= rail) continue;
      sign.gyro[static_cast<std::size_t>(j)] = w > 0.0 ? 1 : -1;
      w = std::clamp(w, -rail, rail);
    }
    signs.push_back(sign);
  }
  std::vector<AngularRateState> rates;
  std::vector<AttitudeState> attitudes;
  HandHeldSmoother::Report report;
  SensingAxisClipSigns clipped;
  clipped.clip_signs = signs;
  ASSERT_TRUE(HandHeldSmoother({}).estimate(samples, clipped, rates, attitudes, report).ok());
  std::vector<double> raw, ours;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (rates[k].clipped_axes == 0) continue;
    raw.push_back((samples[k].angular_velocity_rad_s - truth[k]).norm());
    ours.push_back((rates[k].w_WI_I_rad_s - truth[k]).norm());
  }
  ASSERT_GT(raw.size(), 500u);
  const double share = 1.0 - quantile(ours, 0.5) / quantile(raw, 0.5);
  std::printf("%s: raw %.3f / %.3f, carried %.3f / %.3f rad/s, %.1f %% off\n", number.c_str(), quantile(raw, 0.5),
              quantile(raw, 0.9), quantile(ours, 0.5), quantile(ours, 0.9), 100.0 * share);
  EXPECT_GT(share, share_wanted(number));
}

class HandHeldBroad : public ::testing::TestWithParam<std::string> {};
class HandHeldBroadSoak : public HandHeldBroad {};

TEST_P(HandHeldBroad, TakesOffWhatTheRailHid) {
  expect_smaller_errors_while_clipped(GetParam());
}
TEST_P(HandHeldBroadSoak, TakesOffWhatTheRailHid) {
  expect_smaller_errors_while_clipped(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Trials, HandHeldBroad, ::testing::ValuesIn(testing::few_broad_trials()));
INSTANTIATE_TEST_SUITE_P(Trials, HandHeldBroadSoak, ::testing::ValuesIn(testing::broad_trials()));

struct Wand {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Quaterniond> q_ref;
};

/// Reads two header lines; time, quaternion (w first), specific force, gyro, magnetometer, separated by semicolons.
Wand read_wand(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line), std::getline(file, line);
  Wand out;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ';', ' ');
    std::istringstream row(line);
    double time_s = 0.0, w = 0.0, x = 0.0, y = 0.0, z = 0.0;
    ImuSample sample;
    row >> time_s >> w >> x >> y >> z;
    for (double& f : sample.specific_force_m_s2) row >> f;
    for (double& g : sample.angular_velocity_rad_s) row >> g;
    if (!row) continue;
    sample.time_ns = static_cast<TimeNs>(std::llround(time_s * 1e9));
    out.samples.push_back(sample);
    out.q_ref.emplace_back(w, x, y, z);
  }
  return out;
}

class HandHeldWand : public ::testing::TestWithParam<test::DataFolder> {};

TEST_P(HandHeldWand, RecoversTheTwirl) {
  const bool real = GetParam().real;
  const Wand wand = read_wand(test::written(GetParam()) / (real ? "TStick_Test05_Trial1.csv" : test::kStandInWand));
  ASSERT_GT(wand.samples.size(), 8000u);
  // the plane of the clipped element's readings: x = +-7.2987 - 0.046 + 0.006 y - 0.018 z
  SensingAxisClipSigns clipped;
  clipped.sensing_directions.row(0) << 1.0, -0.006, 0.018;
  std::vector<ClipSigns> signs(wand.samples.size());
  for (std::size_t k = 0; k < signs.size(); ++k) {
    const double x = clipped.sensing_directions.row(0).dot(wand.samples[k].angular_velocity_rad_s) + 0.046;
    if (std::abs(x) > 7.2687) signs[k].gyro[0] = x > 0.0 ? 1 : -1;
  }
  clipped.clip_signs = signs;
  std::vector<AngularRateState> rates;
  std::vector<AttitudeState> attitudes;
  HandHeldSmoother::Report report;
  ASSERT_TRUE(HandHeldSmoother({}).estimate(wand.samples, clipped, rates, attitudes, report).ok());

  std::vector<double> raw, ours, optical(rates.size(), 0.0);
  for (std::size_t k = 1; k + 1 < rates.size(); ++k)
    optical[k] = so3::logarithm(wand.q_ref[k - 1].conjugate() * wand.q_ref[k + 1]).norm() / 0.02;
  std::size_t within = 0;
  for (std::size_t k = 1; k + 1 < rates.size(); ++k) {
    // a sample is no glitch of the reference if its second difference is small, like that of the motion
    const bool sane = optical[k] < 25.0 && std::abs(optical[k] - 0.5 * (optical[k - 1] + optical[k + 1])) < 1.0;
    if (rates[k].clipped_axes == 0 || !sane) continue;
    const Eigen::Vector3d w = rates[k].w_WI_I_rad_s, along = w.normalized();
    raw.push_back(std::abs(wand.samples[k].angular_velocity_rad_s.norm() - optical[k]));
    ours.push_back(std::abs(w.norm() - optical[k]));
    // 0.15: the error of the optical rate, with median 0.12 and 90 % quantile 0.37
    const double sigma = std::sqrt(along.dot(rates[k].covariance_rad2_s2 * along) + 0.15 * 0.15);
    within += ours.back() < 3.0 * sigma ? 1u : 0u;
  }
  ASSERT_GT(ours.size(), real ? 1400u : 300u);
  const double share = static_cast<double>(within) / static_cast<double>(ours.size());
  std::printf("wand: %zu samples, raw %.2f / %.2f, carried %.3f / %.3f rad/s, within 3 sigma %.3f\n", ours.size(),
              quantile(raw, 0.5), quantile(raw, 0.9), quantile(ours, 0.5), quantile(ours, 0.9), share);
  EXPECT_LT(quantile(ours, 0.5), 0.44);  // measured 0.401
  EXPECT_LT(quantile(ours, 0.9), 1.20);  // measured 1.073
  EXPECT_GT(share, 0.97);                // measured 0.995
}

INSTANTIATE_TEST_SUITE_P(Wands, HandHeldWand, ::testing::ValuesIn(test::data_folders("repoimu")), test::FolderName());

/// A filter of the same idea reaches 0.554 degrees in motion on average, with its stated deviation.
class HandHeldBroadAttitude : public ::testing::TestWithParam<test::DataFolder> {};

TEST_P(HandHeldBroadAttitude, IsBetterThanTheFilterOnATrial) {
  const std::string number = GetParam().real ? "11" : test::kStandInTrial;
  const testing::BroadTrial trial = testing::read_broad_trial(number);
  std::vector<AngularRateState> rates;
  std::vector<AttitudeState> attitudes;
  HandHeldSmoother::Report report;
  const HandHeldSmoother smoother({.expert = {.node_s = 0.02}});  // half of the time
  ASSERT_TRUE(smoother.estimate(trial.samples, {}, rates, attitudes, report).ok());
  std::vector<Eigen::Quaterniond> q_WI;
  for (const AttitudeState& attitude : attitudes) q_WI.push_back(attitude.orientation_W);
  const testing::BroadError error = testing::score(trial, q_WI);
  std::printf("trial %s: inclination %.3f deg in motion, %.3f at rest\n", number.c_str(), error.inclination_motion_deg,
              error.inclination_rest_deg);
  EXPECT_LT(error.inclination_motion_deg, 0.30);  // measured 0.26; VQF's 0.42
}

INSTANTIATE_TEST_SUITE_P(Trials, HandHeldBroadAttitude, ::testing::ValuesIn(test::data_folders("broad")),
                         test::FolderName());

}  // namespace
}  // namespace tumble
