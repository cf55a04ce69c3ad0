// SPDX-License-Identifier: BSD-3-Clause
// A robot reboots: a run that was saved, and loaded into a new object, is the run that was not.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "thrown_body.hpp"
#include "thrown_params.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using test::ThrownBody;

struct SavedRunInput {
  std::vector<ImuSample> imu;
  std::vector<ThrownBody::Sweep> sweeps;
};

SavedRunInput input_of(const ThrownBody& body) {
  return {body.imu(), body.sweeps()};
}

struct SavedRunResults {
  std::vector<TumblingOdometry::Sweep> sweeps;
  std::vector<PoseState> newest;
};

/// Adds samples `from` to `to` - 1 and the sweeps that end by then. Stores the newest pose after every seventh sample.
void feed(const SavedRunInput& input, std::size_t from, std::size_t to, TumblingOdometry& odometry,
          SavedRunResults& results) {
  for (std::size_t k = from; k < to; ++k) {
    (void)odometry.add_imu(input.imu[k]);  // the first sample after a gap is not accepted
    const TimeNs before_ns = k == 0 ? 0 : input.imu[k - 1].time_ns;
    for (const ThrownBody::Sweep& sweep : input.sweeps) {
      if (sweep.end_ns > before_ns && sweep.end_ns <= input.imu[k].time_ns)
        (void)odometry.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points);
    }
    while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) results.sweeps.push_back(std::move(*sweep));
    PoseState pose;
    if (k % 7 == 0 && odometry.newest(pose).ok()) results.newest.push_back(pose);
  }
}

void finish(TumblingOdometry& odometry, SavedRunResults& results) {
  odometry.finish();
  while (std::optional<TumblingOdometry::Sweep> sweep = odometry.take()) results.sweeps.push_back(std::move(*sweep));
}

void expect_same(const PoseState& a, const PoseState& b) {
  EXPECT_EQ(a.time_ns, b.time_ns);
  EXPECT_EQ(a.p_WA_m, b.p_WA_m);
  EXPECT_EQ(a.q_WA.coeffs(), b.q_WA.coeffs());
  EXPECT_EQ(a.v_WA_m_s, b.v_WA_m_s);
  EXPECT_EQ(a.covariance, b.covariance);
}

void expect_same(const std::vector<PoseState>& a, const std::vector<PoseState>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) expect_same(a[k], b[k]);
}

/// `late` is the end of `whole`.
void expect_same_end(const SavedRunResults& whole, const SavedRunResults& late) {
  ASSERT_LE(late.sweeps.size(), whole.sweeps.size());
  const std::size_t first = whole.sweeps.size() - late.sweeps.size();
  for (std::size_t k = 0; k < late.sweeps.size(); ++k) {
    const TumblingOdometry::Sweep &a = whole.sweeps[first + k], &b = late.sweeps[k];
    EXPECT_EQ(a.status.message(), b.status.message());
    EXPECT_EQ(a.report.verdict, b.report.verdict);
    expect_same(a.report.pose, b.report.pose);
    expect_same(a.report.trajectory, b.report.trajectory);
    expect_same(a.report.smoothed, b.report.smoothed);
  }
  ASSERT_LE(late.newest.size(), whole.newest.size());
  expect_same({whole.newest.end() - static_cast<std::ptrdiff_t>(late.newest.size()), whole.newest.end()}, late.newest);
}

void expect_same_map(const TumblingOdometry& a, const TumblingOdometry& b) {
  const std::vector<MapPoint> one = a.mapper().map(), other = b.mapper().map();
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t k = 0; k < one.size(); ++k) {
    ASSERT_EQ(one[k].position_W_m, other[k].position_W_m);
    ASSERT_EQ(one[k].normal_W, other[k].normal_W);
    ASSERT_EQ(one[k].sigma_m, other[k].sigma_m);
  }
}

/// Checks that the run is in the state that a split is meant to test.
using Precondition = bool (*)(const TumblingOdometry&);

struct Split {
  std::size_t at;
  Precondition precondition;
};

/// Compares an uninterrupted run, which is saved at each split, with runs that continue from the saved states.
void expect_splits(const TumblingOdometry::Params& params, const SavedRunInput& input,
                   const std::vector<Split>& splits) {
  TumblingOdometry whole(params);
  SavedRunResults results;
  std::vector<std::vector<std::byte>> saved;
  std::size_t k = 0;
  for (const Split& split : splits) {
    feed(input, k, split.at, whole, results);
    k = split.at;
    EXPECT_TRUE(split.precondition(whole)) << "the split at " << split.at << " tests nothing";
    saved.push_back(whole.save());
  }
  feed(input, k, input.imu.size(), whole, results);
  finish(whole, results);
  for (std::size_t i = 0; i < splits.size(); ++i) {
    SCOPED_TRACE(testing::Message() << "split at " << splits[i].at);
    TumblingOdometry rebooted(params);
    const Status status = rebooted.load(saved[i]);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(rebooted.save(), saved[i]);
    SavedRunResults late;
    feed(input, splits[i].at, input.imu.size(), rebooted, late);
    finish(rebooted, late);
    expect_same_end(results, late);
    expect_same_map(whole, rebooted);
    EXPECT_EQ(rebooted.save(), whole.save());
  }
}

TumblingOdometry::Params one_pass(const ThrownBody& body) {
  TumblingOdometry::Params params = params_of(body);
  params.expert.second_pass.after_s = 0.0;
  return params;
}

bool gyro_clips(const TumblingOdometry& odometry) {
  return odometry.newest_rate() && odometry.newest_rate()->clipped_axes != 0;
}
bool always(const TumblingOdometry&) {
  return true;
}

TEST(SavedTumblingOdometry, GoesOnFromRestAndFromFlightWithAClippedGyro) {
  const ThrownBody body;
  expect_splits(one_pass(body), input_of(body),
                {{1, always}, {60, [](const TumblingOdometry& o) { return !gyro_clips(o); }}, {183, gyro_clips}});
}

TEST(SavedTumblingOdometry, GoesOnInTheMiddleOfTheSecondPass) {
  const ThrownBody body;
  TumblingOdometry::Params params = one_pass(body);
  params.lever_arm_I_m += Eigen::Vector3d(0.006, -0.006, 0.006);
  params.expert.second_pass.after_s = 0.9;
  expect_splits(params, input_of(body),
                {{200, [](const TumblingOdometry& o) { return !o.second_pass_applied(); }},
                 {255, [](const TumblingOdometry& o) { return !o.second_pass_applied(); }}});
}

TEST(SavedTumblingOdometry, GoesOnWhileItIsLost) {
  ThrownBody body;
  SavedRunInput lost = input_of(body);
  for (ThrownBody::Sweep& sweep : lost.sweeps) {
    if (sweep.start_ns < 1'300'000'000 || sweep.end_ns > 2'700'000'000) continue;
    for (LidarPoint& point : sweep.points)
      point.position_L_m =
          point.position_L_m.cwiseAbs().cwiseProduct(Eigen::Vector3f(1.0f, 0.37f, 0.71f));  // another world
  }
  std::size_t seen_lost = 0;
  TumblingOdometry probe(one_pass(body));
  SavedRunResults results;
  feed(lost, 0, 240, probe, results);
  for (const auto& sweep : results.sweeps) seen_lost += sweep.report.verdict == SweepVerdict::rejected;
  ASSERT_GT(seen_lost, 0u) << "else this test asks nothing";
  ASSERT_EQ(results.sweeps.back().report.verdict, SweepVerdict::rejected);
  expect_splits(one_pass(body), lost, {{240, always}});
}

TEST(SavedTumblingOdometry, GoesOnInAGapAndWithSweepsThatNobodyTook) {
  ThrownBody body;
  body.rest_s = 4.2;
  body.end_s = 5.0;
  SavedRunInput gapped = input_of(body);
  std::erase_if(gapped.imu, [](const ImuSample& s) { return s.time_ns > 1'500'000'000 && s.time_ns < 3'200'000'000; });
  // one sample after the gap is held back; the next will bear it out
  expect_splits(one_pass(body), gapped,
                {{151, [](const TumblingOdometry& o) { return o.restart_count() == 0; }},
                 {152, [](const TumblingOdometry& o) { return o.restart_count() == 1; }}});

  TumblingOdometry first(one_pass(body)), second(one_pass(body));
  for (std::size_t k = 0; k < 100; ++k) ASSERT_TRUE(first.add_imu(gapped.imu[k]).ok());
  ASSERT_TRUE(first.add_sweep(0, 1'000'000, {}).ok());
  const std::vector<LidarPoint> misses(
      5, LidarPoint{.position_L_m = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())});
  ASSERT_TRUE(first.add_sweep(100'000'000, 200'000'000, misses).ok());
  ASSERT_TRUE(first.add_sweep(900'000'000, 990'000'000, misses).ok());  // waits
  ASSERT_TRUE(second.load(first.save()).ok());
  for (std::size_t k = 100; k < 140; ++k) {
    ASSERT_TRUE(first.add_imu(gapped.imu[k]).ok());
    ASSERT_TRUE(second.add_imu(gapped.imu[k]).ok());
  }
  for (std::optional<TumblingOdometry::Sweep> sweep = first.take(); sweep; sweep = first.take()) {
    const std::optional<TumblingOdometry::Sweep> same = second.take();
    ASSERT_TRUE(same);
    EXPECT_FALSE(sweep->status.ok());
    EXPECT_EQ(sweep->status.message(), same->status.message());
  }
  EXPECT_FALSE(second.take());
}

TEST(SavedTumblingOdometry, ANewOneIsAsItWas) {
  const ThrownBody body;
  TumblingOdometry one(one_pass(body)), other(one_pass(body));
  ASSERT_TRUE(other.load(one.save()).ok());
  EXPECT_EQ(other.save(), one.save());
  ASSERT_TRUE(one.add_imu(body.imu()[0]).ok());
  EXPECT_NE(other.save(), one.save()) << "negative control: a sample makes a difference";
}

TEST(SavedTumblingOdometry, OtherParametersAreNamed) {
  const ThrownBody body;
  TumblingOdometry::Params params = one_pass(body);
  const std::vector<std::byte> saved = TumblingOdometry(params).save();
  const auto refusal = [&](const TumblingOdometry::Params& other) {
    TumblingOdometry odometry(other);
    const Status status = odometry.load(saved);
    EXPECT_FALSE(status.ok());
    return std::string(status.field);
  };
  TumblingOdometry::Params other = params;
  other.lever_arm_sigma_m = 0.02;
  TumblingOdometry odometry(other);
  const Status status = odometry.load(saved);
  EXPECT_STREQ(status.field, "lever_arm_sigma_m");
  EXPECT_EQ(status.value, 0.01);
  EXPECT_EQ(status.bound, 0.02);
  other = params;
  other.T_IL.translation().y() = 0.1;
  EXPECT_EQ(refusal(other), "T_IL");
  other = params;
  other.expert.mapping.expert.matching.neighbours = 11;
  EXPECT_EQ(refusal(other), "neighbours");
  other = params;
  other.expert.mapping.expert.flight.body = FlyingBody{};
  EXPECT_EQ(refusal(other), "body");
  other = params;
  other.expert.rate.rate.model.calibration = RigCalibration{};
  EXPECT_EQ(refusal(other), "calibration");
  other = params;
  other.own_body_L = Eigen::AlignedBox3d(-Eigen::Vector3d::Ones(), Eigen::Vector3d::Ones());
  EXPECT_EQ(refusal(other), "own_body_L");
  other = params;
  other.expert.mapping.parallel_for = [](std::size_t count, const std::function<void(std::size_t)>& body_of) {
    for (std::size_t k = 0; k < count; ++k) body_of(k);
  };
  EXPECT_TRUE(TumblingOdometry(other).load(saved).ok()) << "threads are the caller's";
}

}  // namespace
}  // namespace tumble
