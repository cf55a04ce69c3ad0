// SPDX-License-Identifier: BSD-3-Clause
// Streams that were saved anywhere go on with the same bits; hostile_state_test.cpp has the bytes of strangers.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "kept_stream.hpp"

namespace tumble {
namespace {

using test::Kept;

template <class Stream>
class SavedStreams : public testing::Test {};
using Streams =
    testing::Types<RateStream, RegimeStream, HandHeldStream, HandHeldPipeline, RollingFilter, RollingSmoother>;
TYPED_TEST_SUITE(SavedStreams, Streams);

TYPED_TEST(SavedStreams, GoOnFromAnywhere) {
  const std::vector<ImuSample> samples = test::samples_of_stream<TypeParam>();
  Kept<TypeParam> whole;
  struct Cut {
    std::size_t at, results;
    std::vector<std::byte> saved;
  };
  std::vector<Cut> cuts;
  // before the first, while the window fills, in the fastest part, about the gap, and at the end
  const std::size_t step = samples.size() / 9;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k < 3 || k % step == 0 || k + 1 == samples.size()) cuts.push_back({k, whole.results.size(), whole.save()});
    const Status status = whole.push(samples[k]);
    ASSERT_TRUE(status.ok()) << k << ": " << status.message();
  }
  const std::vector<std::byte> last = whole.save();
  whole.end();
  ASSERT_GT(whole.results.size(), 1000u);
  for (const Cut& cut : cuts) {
    SCOPED_TRACE(cut.at);
    Kept<TypeParam> rebooted;
    const Status status = rebooted.load(cut.saved);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(rebooted.save(), cut.saved);
    for (std::size_t k = cut.at; k < samples.size(); ++k) ASSERT_TRUE(rebooted.push(samples[k]).ok());
    EXPECT_EQ(rebooted.save(), last);
    rebooted.end();
    const std::vector<double> rest(whole.results.begin() + static_cast<std::ptrdiff_t>(cut.results),
                                   whole.results.end());
    EXPECT_EQ(rebooted.results, rest);
  }
}

TYPED_TEST(SavedStreams, BytesContainTheirParameters) {
  typename TypeParam::Params params = test::params_of_stream<TypeParam>(), restored;
  if constexpr (std::is_same_v<TypeParam, RateStream>) {
    params.rails.stated_gyro_rad_s = 10.0;
    params.model.calibration.emplace().constants.lever_arm_m.x() = 0.1;
    params.calibrated_errors = std::make_shared<KnownSensorErrors>();
  }
  if constexpr (std::is_same_v<TypeParam, HandHeldPipeline>)
    params.rails.clipping.axis_aligned_rails.stated_gyro_rad_s = 10.0;
  if constexpr (std::is_same_v<TypeParam, RollingFilter>) params.q_WI_start = Eigen::Quaterniond(0.6, 0.8, 0.0, 0.0);
  Kept<TypeParam> first(params);
  for (const ImuSample& sample : test::samples_of_stream<TypeParam>()) (void)first.push(sample);
  const std::vector<std::byte> saved = first.save();
  const Status status = saved_params<TypeParam>(saved, restored);
  ASSERT_TRUE(status.ok()) << status.message();
  Kept<TypeParam> again(restored);
  ASSERT_TRUE(again.load(saved).ok());
  EXPECT_EQ(again.save(), saved);
  for (const std::size_t length : {0u, 39u, 100u})
    EXPECT_EQ(saved_params<TypeParam>(std::span(saved).first(length), restored).error_code, ErrorCode::too_few);
}

/// Forces that wait for the rates of their instants are part of it.
TEST(SavedStreams, ALateAccelerometerGoesOn) {
  RateStream::Params params = test::params_of_stream<RateStream>();
  params.model.errors.accel_delay_s = 1.3 * params.period_s;
  const std::vector<ImuSample> samples = test::thrown_samples();
  Kept<RateStream> whole(params);
  std::vector<std::byte> saved;
  std::size_t results = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k == samples.size() / 3) saved = whole.save(), results = whole.results.size();
    ASSERT_TRUE(whole.push(samples[k]).ok());
  }
  Kept<RateStream> rebooted(params);
  ASSERT_TRUE(rebooted.load(saved).ok());
  for (std::size_t k = samples.size() / 3; k < samples.size(); ++k) ASSERT_TRUE(rebooted.push(samples[k]).ok());
  EXPECT_EQ(rebooted.results,
            std::vector<double>(whole.results.begin() + static_cast<std::ptrdiff_t>(results), whole.results.end()));
  EXPECT_EQ(rebooted.save(), whole.save());
}

TEST(SavedStreams, OtherParametersAndStreamsAreNamed) {
  RateStream::Params params = test::params_of_stream<RateStream>();
  const std::vector<std::byte> saved = Kept<RateStream>(params).save();
  params.lag_s = 0.2;
  EXPECT_STREQ(Kept<RateStream>(params).load(saved).field, "lag_s");
  EXPECT_STREQ(Kept<HandHeldStream>().load(saved).field, "kind of the saved state");
  RateStream::Params restored;
  EXPECT_STREQ(saved_params<RateStream>(Kept<RegimeStream>().save(), restored).field, "kind of the saved state");
}

/// Checks that an estimator can be constructed from its saved bytes alone.
template <class Estimator>
void expect_params_of(const typename Estimator::Params& params, Estimator& estimator) {
  const std::vector<std::byte> saved = estimator.save();
  typename Estimator::Params restored;
  const Status status = Estimator::saved_params(saved, restored);
  ASSERT_TRUE(status.ok()) << status.message();
  Estimator again(restored);
  ASSERT_TRUE(again.load(saved).ok());
  EXPECT_EQ(again.save(), saved);
  EXPECT_EQ(restored.lag_s, params.lag_s);
}

TEST(SavedOdometry, ContainsItsParameters) {
  const test::ThrownBody body;
  TumblingOdometry::Params params;
  params.imu.rate_hz = body.imu_hz;
  params.lever_arm_I_m = body.lever_arm_I_m;
  params.lag_s = 0.07;
  params.T_IL.translate(Eigen::Vector3d(0.1, 0.2, 0.3));
  TumblingOdometry estimator(params);
  for (const ImuSample& sample : body.imu()) ASSERT_TRUE(estimator.add_imu(sample).ok());
  expect_params_of(params, estimator);

  const RollingOdometry::Params rolling = test::params_of(test::kPositions);
  RollingOdometry sphere(rolling);
  std::vector<std::vector<ImuSample>> units;
  for (const Eigen::Vector3d& position_m : test::kPositions) units.push_back(test::unit_at(position_m));
  for (std::size_t k = 0; k < 400; ++k)
    ASSERT_TRUE(sphere.add_imus(std::vector{units[0][k], units[1][k], units[2][k]}).ok());
  expect_params_of(rolling, sphere);
}

}  // namespace
}  // namespace tumble
