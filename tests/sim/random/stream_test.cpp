// SPDX-License-Identifier: BSD-3-Clause
#include "sim/random/stream.hpp"

#include "sim/random/philox.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

using Block = std::array<std::uint32_t, 4>;

// The known answers were published with the authors' Random123 library (kat_vectors, philox4x32 with 10 rounds).
TEST(Philox, GivesThePublishedKnownAnswers) {
  EXPECT_EQ(philox4x32_10({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32_10({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Philox, OneBitOfTheKeyChangesHalfOfTheOutput) {
  int changed = 0;
  for (int bit = 0; bit < 32; ++bit) {
    const Block a = philox4x32_10({1, 2, 3, 4}, {7, 9}), b = philox4x32_10({1, 2, 3, 4}, {7u ^ (1u << bit), 9});
    for (int i = 0; i < 4; ++i) changed += __builtin_popcount(a[i] ^ b[i]);
  }
  // 4096 fair coins have mean 2048 and sigma 32; the bound is 5 sigma, with a false-alarm probability of 6e-7
  EXPECT_NEAR(changed, 2048, 160);
}

TEST(Stream, SameSeedAndNameGiveTheSameSequence) {
  Stream a(42, "terrain"), b(42, "terrain");
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(a.bits(), b.bits()) << "at " << i;
}

TEST(Stream, SeedAndNameBothMatter) {
  std::set<std::uint64_t> first;
  for (const char* name : {"terrain", "terraim", "push", "", "imu.noise", "imu.noisf"}) {
    for (std::uint64_t seed : {0ull, 1ull, 2ull, 1ull << 32, 1ull << 63}) first.insert(Stream(seed, name).bits());
  }
  EXPECT_EQ(first.size(), 30u);
}

TEST(Stream, BlocksAreTheSequenceAndNeedNoHistory) {
  Stream stream(7, "lidar.range");
  const Block later = stream.block(1);  // requested before earlier blocks
  stream.bits();
  stream.bits();
  EXPECT_EQ(stream.bits(), (std::uint64_t{later[1]} << 32) | later[0]);
  EXPECT_EQ(stream.bits(), (std::uint64_t{later[3]} << 32) | later[2]);
}

TEST(Stream, NormalPairIsAFunctionOfTheIndex) {
  const Stream stream(7, "lidar.range");
  const auto once = stream.normal_pair(12345), again = stream.normal_pair(12345), other = stream.normal_pair(12346);
  EXPECT_EQ(once, again);
  EXPECT_NE(once, other);
}

TEST(Stream, CopyGoesOnFromTheSamePlace) {
  Stream stream(3, "push");
  stream.normal();
  stream.bits();
  Stream copy = stream;
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(stream.normal(), copy.normal());
    ASSERT_EQ(stream.bits(), copy.bits());
  }
}

TEST(Stream, UniformIsEvenInItsInterval) {
  Stream stream(1, "test.uniform");
  constexpr int kCells = 100, kDraws = 200000;
  std::vector<int> counts(kCells, 0);
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = stream.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    ++counts[static_cast<int>(u * kCells)];
  }
  double chi2 = 0.0;
  for (const int count : counts) chi2 += std::pow(count - kDraws / kCells, 2) / (static_cast<double>(kDraws) / kCells);
  // chi-square with 99 degrees of freedom has the 1e-6 quantiles 45.6 and 181.1 (Wilson-Hilferty)
  EXPECT_LT(chi2, 181.1);
  EXPECT_GT(chi2, 45.6);
  EXPECT_NEAR(sum / kDraws, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / kDraws));  // false alarm 6e-7
}

TEST(Stream, UniformKeepsItsBounds) {
  Stream stream(1, "test.bounds");
  for (int i = 0; i < 1000; ++i) {
    const double value = stream.uniform(-3.0, 5.0);
    ASSERT_GE(value, -3.0);
    ASSERT_LT(value, 5.0);
  }
}

TEST(Stream, NormalHasTheMomentsAndTailsOfTheNormal) {
  Stream stream(1, "test.normal");
  constexpr int kDraws = 200000;
  double m1 = 0, m2 = 0, m3 = 0, m4 = 0, lag = 0, last = 0;
  int beyond_2 = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = stream.normal();
    m1 += x;
    m2 += x * x;
    m3 += x * x * x;
    m4 += x * x * x * x;
    lag += x * last;
    last = x;
    beyond_2 += std::abs(x) > 2.0;
  }
  const double n = kDraws;
  // each bound is 5 standard errors (variances 1, 2, 15, 96, 1 and binomial): the false-alarm probability is 6e-7 per
  // line
  EXPECT_NEAR(m1 / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(m2 / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(m3 / n, 0.0, 5.0 * std::sqrt(15.0 / n));
  EXPECT_NEAR(m4 / n, 3.0, 5.0 * std::sqrt(96.0 / n));
  EXPECT_NEAR(lag / n, 0.0, 5.0 / std::sqrt(n));
  EXPECT_NEAR(beyond_2 / n, 0.04550026, 5.0 * std::sqrt(0.0455 * 0.9545 / n));
}

TEST(Stream, StreamsOfNeighbouringSeedsAreUncorrelated) {
  Stream a(1, "imu.noise"), b(2, "imu.noise");
  constexpr int kDraws = 100000;
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) sum += a.normal() * b.normal();
  EXPECT_NEAR(sum / kDraws, 0.0, 5.0 / std::sqrt(kDraws));  // false alarm 6e-7
}

}  // namespace
}  // namespace tumble::sim
