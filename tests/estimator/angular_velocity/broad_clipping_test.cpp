// SPDX-License-Identifier: BSD-3-Clause
// A real recording without tumbles must not become worse: BROAD trials (a hand-moved sensor) if available, and a
// synthetic replacement, with the gyro clipped at a third of its peak. For a hand-held sensor, only the bounds and the
// smoothness of the motion recover clipped rates.
#include "stand_ins/broad_trial.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/detail/saave.hpp"

namespace tumble {
namespace {

constexpr double kWindowS = 20.0;  // around the peak of the trial, so that the test takes seconds

struct Clipped {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Vector3d> truth_rad_s;  // readings before clipping
  std::vector<bool> clipped;
  double rail_rad_s = 0.0;
};

Clipped clip_at_a_third(const std::vector<ImuSample>& samples) {
  const auto size = [](const ImuSample& s) { return s.angular_velocity_rad_s.cwiseAbs().maxCoeff(); };
  const auto peak = std::max_element(samples.begin(), samples.end(),
                                     [&](const ImuSample& a, const ImuSample& b) { return size(a) < size(b); });
  Clipped out;
  out.rail_rad_s = size(*peak) / 3.0;
  for (const ImuSample& sample : samples) {
    if (std::abs(seconds(sample.time_ns - peak->time_ns)) > 0.5 * kWindowS) continue;
    ImuSample held = sample;
    Eigen::Vector3d& w = held.angular_velocity_rad_s;
    w = w.cwiseMin(out.rail_rad_s).cwiseMax(-out.rail_rad_s);
    out.samples.push_back(held);
    out.truth_rad_s.push_back(sample.angular_velocity_rad_s);
    out.clipped.push_back(w != sample.angular_velocity_rad_s);
  }
  return out;
}

struct Errors {
  double median = 0.0, mean = 0.0, largest = 0.0;
};

template <typename RateOf>
Errors errors(const Clipped& trial, bool clipped, RateOf rate_of) {
  std::vector<double> norms;
  Errors out;
  for (std::size_t k = 0; k < trial.samples.size(); ++k) {
    if (trial.clipped[k] != clipped) continue;
    norms.push_back((rate_of(k) - trial.truth_rad_s[k]).norm());
    out.mean += norms.back();
    out.largest = std::max(out.largest, norms.back());
  }
  if (norms.empty()) return out;
  out.mean /= static_cast<double>(norms.size());
  std::nth_element(norms.begin(), norms.begin() + static_cast<std::ptrdiff_t>(norms.size() / 2), norms.end());
  out.median = norms[norms.size() / 2];
  return out;
}

void expect_no_worse_than_the_clipped_gyro(const std::string& number) {
  const testing::BroadTrial recorded = testing::read_broad_trial(number);
  const Clipped trial = clip_at_a_third(recorded.samples);
  ASSERT_GT(std::count(trial.clipped.begin(), trial.clipped.end(), true), 20);

  AngularRateSmoother::Params params;
  params.model.nominal = {};  // the centre of mass of a hand-held sensor is unknown
  std::vector<AngularRateState> ours, theirs;
  AngularRateReport report;
  ASSERT_TRUE(AngularRateSmoother(params).estimate(trial.samples, ours, report).ok());
  ASSERT_EQ(ours.size(), trial.samples.size());
  SaturationAwareRateEstimator::Params published;
  published.lever_arm_m = {-0.022, -0.085, 0.055};  // lever arm of the published rig
  published.saturation_point_rad_s = 0.999 * trial.rail_rad_s;
  ASSERT_TRUE(SaturationAwareRateEstimator(published).estimate(trial.samples, theirs).ok());

  const auto raw = [&](std::size_t k) { return trial.samples[k].angular_velocity_rad_s; };
  const auto tumble = [&](std::size_t k) { return ours[k].w_WI_I_rad_s; };
  const auto saave = [&](std::size_t k) { return theirs[k].w_WI_I_rad_s; };
  const Errors raw_clipped = errors(trial, true, raw), clipped = errors(trial, true, tumble);
  const Errors free = errors(trial, false, tumble);
  for (const auto& [name, e, f] :
       {std::tuple("raw", raw_clipped, errors(trial, false, raw)), std::tuple("tumble", clipped, free),
        std::tuple("saave", errors(trial, true, saave), errors(trial, false, saave))}) {
    std::printf("%s %-7s clipped %.3f median %.3f mean %.3f max, others %.4f median %.4f mean rad/s\n", number.c_str(),
                name, e.median, e.mean, e.largest, f.median, f.mean);
  }

  // the saturation level is found without a stated range, down to a third of the slowest peak, and no level where
  // nothing clips
  double found = 0.0;
  for (int j = 0; j < 3; ++j)
    found = std::max(found, report.saturation_limits[static_cast<std::size_t>(j)].value_or(0.0));
  EXPECT_NEAR(found, trial.rail_rad_s, 1e-9);
  const SaturationLimitDetector rails(params.saturation_detector);
  SaturationLimitDetector::State whole;
  for (const ImuSample& sample : recorded.samples) rails.observe_reading(sample, whole);
  for (int c = 0; c < 6; ++c) EXPECT_FALSE(rails.saturation_limit(whole, c).has_value()) << c;

  // the noise of this gyro on three axes, which a worse result must exceed
  const double noise = params.model.gyro_noise_density * std::sqrt(3.0 * 285.714);
  EXPECT_LT(clipped.median, raw_clipped.median + noise);
  EXPECT_LT(clipped.mean, raw_clipped.mean + noise);
  EXPECT_LT(clipped.largest, 1.5 * raw_clipped.largest);
  // compared with the reading: the removed bias (0.01 rad/s, as in the prior) and the noise
  EXPECT_LT(free.median, 0.01 + noise);
  EXPECT_LT(free.mean, 0.02 + noise);
}

class BroadClipping : public ::testing::TestWithParam<std::string> {};
class BroadClippingSoak : public BroadClipping {};

TEST_P(BroadClipping, IsNeverWorseThanTheClippedGyro) {
  expect_no_worse_than_the_clipped_gyro(GetParam());
}
TEST_P(BroadClippingSoak, IsNeverWorseThanTheClippedGyro) {
  expect_no_worse_than_the_clipped_gyro(GetParam());
}

INSTANTIATE_TEST_SUITE_P(Trials, BroadClipping, ::testing::ValuesIn(testing::few_broad_trials()));
INSTANTIATE_TEST_SUITE_P(Trials, BroadClippingSoak, ::testing::ValuesIn(testing::broad_trials()));

}  // namespace
}  // namespace tumble
