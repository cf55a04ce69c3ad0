// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/rolling/rolling_truth.hpp"
#include "estimator/src/rolling/rolling_window.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/testing.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble {
namespace {

using testing::kLeverArm;

testing::RollingTruth path(double duration_s) {
  return testing::roll({.velocity_m_s = testing::l_shape,
                        .contact_velocity_m_s = testing::no_slip,
                        .duration_s = duration_s,
                        .lever_arm_m = kLeverArm});
}

struct MemoryUse {
  double nodes = 0.0, state = 0.0, at_the_end = 0.0;  ///< bytes; at_the_end is in addition to the state
};

MemoryUse memory_use(double duration_s) {
  const testing::RollingTruth truth = path(duration_s);
  RollingSmoother::Params params;
  params.filter.radius_m = testing::kRadius_m;
  params.filter.lever_arm_m = kLeverArm;
  const RollingSmoother smoother(params);
  std::vector<RollingEstimate> none;
  const std::size_t before = test::allocations.bytes;
  const auto state = std::make_unique<RollingSmoother::State>();
  for (const ImuSample& sample : truth.samples) EXPECT_TRUE(smoother.step(sample, *state, none).ok());
  MemoryUse out;
  out.nodes = static_cast<double>(state->node_modes.size());
  out.state = static_cast<double>(test::allocations.bytes - before);
  test::allocations.peak_bytes = test::allocations.bytes;
  const std::size_t with_state = test::allocations.bytes;
  std::size_t estimates = 0;
  smoother.finish(*state, [&](const RollingEstimate&) { ++estimates; });
  EXPECT_EQ(estimates, truth.samples.size());
  out.at_the_end = static_cast<double>(test::allocations.peak_bytes - with_state);
  return out;
}

TEST(RollingMemory, TheLiveFilterAllocatesNothingPerSample) {
  const testing::RollingTruth truth = path(8.0);
  const RollingFilter filter({.radius_m = testing::kRadius_m, .lever_arm_m = kLeverArm});
  const auto state = std::make_unique<RollingFilter::State>();
  const std::size_t before = test::allocations.count;
  for (const ImuSample& sample : truth.samples) ASSERT_TRUE(filter.step(sample, *state).ok());
  EXPECT_EQ(test::allocations.count, before);
  (void)path(0.1);
  EXPECT_GT(test::allocations.count, before) << "negative control";
}

// The cost of a node is the growth from a run to one of twice the length; a node's record alone is more than 10 KiB.
TEST(RollingMemory, AWholeRunHoldsLittleForEachNode) {
  const MemoryUse one = memory_use(60.0), two = memory_use(120.0);
  const double nodes = two.nodes - one.nodes;
  ASSERT_NEAR(nodes, 3000.0, 2.0);
  // five samples of 64 bytes and a step of 152 bytes, in vectors that double; measured 557
  EXPECT_LT((two.state - one.state) / nodes, 2.0 * (5 * sizeof(ImuSample) + sizeof(RollingSmoother::NodeModes)) + 16.0);
  // two filters in each segment, and a mode and a variance for each node; measured 288
  EXPECT_LT((two.at_the_end - one.at_the_end) / nodes, 320.0);
  EXPECT_GT(sizeof(rolling::FilterNodeRecord), 10'000u) << "the bound says nothing any more";
  EXPECT_LT(two.at_the_end, 5e6);
}

// A lag of three years is within its bound, but its storage is not allocated at once.
TEST(RollingMemory, ALagBeyondAllRunsTakesNoMoreThanARun) {
  RollingSmoother::Params params;
  params.filter.radius_m = testing::kRadius_m;
  params.filter.lever_arm_m = kLeverArm;
  params.lag_s = 0.1 * RollingSmoother::kWholeRecordingLag;
  const RollingSmoother smoother(params);
  const testing::RollingTruth truth = path(2.0);
  std::vector<RollingEstimate> out;
  const std::size_t before = test::allocations.bytes;
  const auto state = std::make_unique<RollingSmoother::State>();
  for (const ImuSample& sample : truth.samples) ASSERT_TRUE(smoother.step(sample, *state, out).ok());
  EXPECT_TRUE(out.empty());
  EXPECT_LT(test::allocations.bytes - before, 300u << 20);  // a million samples and nodes
  EXPECT_GT(test::allocations.bytes - before, 100u << 20) << "the bound says nothing any more";
}

/// Returns all results of the last pass for a path, in one row.
std::vector<double> told(std::span<const ImuSample> samples, std::span<const rolling::ModePathNode> path,
                         std::size_t segment) {
  RollingParams params;
  params.radius_m = testing::kRadius_m;
  params.lever_arm_m = kLeverArm;
  params.radius_sigma_m = 1e-3;
  rolling::FinalSmoothingPass pass(params, samples, path, segment);
  rolling::SmoothingCheckpoint start;
  start.filter.nominal = rolling::start_nominal(params, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
  rolling::set_prior(params, Eigen::Vector3d::Zero(), start.filter.covariance);
  start.reading.next = 1;
  pass.run_to_cut(start, 200);
  EXPECT_EQ(pass.nodes(), path.size());
  std::vector<double> out(pass.horizontal_variance_m2().begin(), pass.horizontal_variance_m2().end());
  const auto add = [&out](const auto& matrix) {
    for (const double entry : matrix.reshaped()) out.push_back(entry);
  };
  add(pass.cut_checkpoint().filter.covariance);
  add(pass.end_filter().covariance);
  pass.report_smoothed(path.size() + 1, [&](const rolling::FinalSmoothingPass::Smoothed& at) {
    out.push_back(static_cast<double>(at.index));
    add(at.smoothed_error);
    add(at.node->smoothed_covariance);
    add(at.nominal.p_WI_m);
    add(at.point.p_WI_m);
  });
  return out;
}

TEST(RollingMemory, TheSizeOfTheBufferChangesNoBit) {
  const testing::RollingTruth truth = path(10.0);
  constexpr std::size_t kNodes = 499;
  std::vector<rolling::ModePathNode> path(kNodes);
  for (std::size_t n = 150; n < 170; ++n) path[n].mode = ContactMode::slip;
  for (std::size_t n = 300; n < kNodes; ++n) path[n].mode = ContactMode::incline;
  const std::vector<double> at_once = told(truth.samples, path, 1000);
  ASSERT_GT(at_once.size(), 100'000u);
  for (const std::size_t segment : {1, 7, 128, 498, 499}) {
    ASSERT_EQ(told(truth.samples, path, segment), at_once) << segment;
  }
}

}  // namespace
}  // namespace tumble
