// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/search/input_shift.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sim/random/stream.hpp"

namespace tumble::scenarios {
namespace {

const std::vector<DrawnNumber> kNumbers = {{"a", {Distribution::Shape::uniform, {0.0, 1.0}}},
                                           {"b", {Distribution::Shape::normal, {10.0, 2.0}}}};

/// Draws without influence, except that `b` is shifted. Each family has `size` draws.
std::vector<ScoredPoint> draws(std::uint64_t seed, std::size_t families, std::size_t size, double shift) {
  sim::Stream stream(seed, "test");
  std::vector<ScoredPoint> out;
  for (std::size_t family = 0; family < families; ++family) {
    const std::vector<double> normals = {stream.normal(), stream.normal() + shift};
    for (std::size_t i = 0; i < size; ++i) out.push_back({{normals, {0}}, 0.0, family});
  }
  return out;
}

TEST(InputShift, TheShiftedParameterIsFirst) {
  const std::vector<InputShift> shifts = input_shifts(kNumbers, draws(1, 40, 1, -2.0));
  ASSERT_EQ(shifts.size(), 2u);
  EXPECT_EQ(shifts[0].number, "b");
  EXPECT_NEAR(shifts[0].shift, -2.0, 4.0 / std::sqrt(40.0)) << "four standard errors";
  EXPECT_LT(shifts[0].corrected, 1e-6);
  EXPECT_GT(shifts[1].corrected, 1e-3);
  EXPECT_NEAR(shifts[0].scenario_median, 10.0, 1e-9);
  EXPECT_NEAR(shifts[0].scenario_high, 10.0 + 2.0 * 1.2816, 1e-3);
  EXPECT_NEAR(shifts[1].scenario_low, 0.1, 1e-9);
  EXPECT_LT(shifts[0].high, 10.0);
}

/// Copies of one draw must not count as independent draws: p-values below 5 % occur in at most 5 % of the cases.
TEST(InputShift, CopiesAreNoEvidence) {
  int significant = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed)
    significant += input_shifts(kNumbers, draws(seed, 4, 25, 0.0)).front().corrected < 0.05 ? 1 : 0;
  EXPECT_LE(significant, 34) << "of 400, where 20 are expected; exceeded with a probability of 1e-3";
  EXPECT_GE(significant, 8);
}

}  // namespace
}  // namespace tumble::scenarios
