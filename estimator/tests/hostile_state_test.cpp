// SPDX-License-Identifier: BSD-3-Clause
// Truncated, corrupted or invented saved states: load() returns a Status and changes nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "kept_stream.hpp"
#include "rolled_sphere.hpp"
#include "thrown_body.hpp"
#include "tumble/tumble.hpp"

namespace tumble {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kHeader = 40, kLengthAt = 24, kChecksumAt = 32;

void put_number(std::uint64_t value, std::size_t at, Bytes& bytes) {
  for (std::size_t k = 0; k < 8; ++k) bytes[at + k] = static_cast<std::byte>(value >> (8 * k));
}

/// Writes a valid length and checksum: FNV-1a by its definition.
void reseal(Bytes& bytes) {
  if (bytes.size() < kHeader) return;
  put_number(bytes.size() - kHeader, kLengthAt, bytes);
  std::uint64_t sum = 14695981039346656037u;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    if (k >= kChecksumAt && k < kHeader) continue;
    sum = (sum ^ std::to_integer<std::uint64_t>(bytes[k])) * 1099511628211u;
  }
  put_number(sum, kChecksumAt, bytes);
}

struct Tumbling {
  using Estimator = TumblingOdometry;
  static constexpr std::size_t kTrials = 400;
  static TumblingOdometry::Params params() {
    TumblingOdometry::Params out;
    out.lever_arm_I_m.setZero();
    out.lag_s = 0.05;
    return out;
  }
  /// With a map, a sweep that waits, and a sweep that was not taken.
  static Estimator some() {
    const test::ThrownBody body;
    Estimator estimator(params());
    for (std::size_t k = 0; k < 45; ++k) EXPECT_TRUE(estimator.add_imu(body.imu()[k]).ok());
    const std::vector<test::ThrownBody::Sweep> sweeps = body.sweeps();
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<LidarPoint> few;
      for (std::size_t p = 0; p < sweeps[k].points.size(); p += 17) few.push_back(sweeps[k].points[p]);
      EXPECT_TRUE(estimator.add_sweep(sweeps[k].start_ns, sweeps[k].end_ns, few).ok());
    }
    EXPECT_TRUE(estimator.add_velocity({460'000'000, {0.1, 0.0, 0.0}, 0.5}).ok());
    MotionReading motion{400'000'000, 450'000'000, Eigen::Isometry3d::Identity(), {}};
    motion.covariance = 1e-4 * Eigen::Matrix<double, 6, 6>::Identity();
    EXPECT_TRUE(estimator.add_motion(motion).ok());
    return estimator;
  }
  static void go_on(Estimator& estimator) {
    const test::ThrownBody body;
    for (std::size_t k = 45; k < 48; ++k) (void)estimator.add_imu(body.imu()[k]);
    PoseState pose;
    (void)estimator.newest(pose);
    while (estimator.take()) continue;
  }
};

struct Rolling {
  using Estimator = RollingOdometry;
  static constexpr std::size_t kTrials = 400;
  static RollingOdometry::Params params() {
    RollingOdometry::Params out = test::params_of({test::kPositions[0]});
    out.lag_s = 0.1;
    return out;
  }
  static Estimator some() {
    Estimator estimator(params());
    const std::vector<ImuSample> samples = test::unit_at(test::kPositions[0]);
    for (std::size_t k = 0; k < 100; ++k) EXPECT_TRUE(estimator.add_imu(samples[k]).ok());
    return estimator;
  }
  static void go_on(Estimator& estimator) {
    const std::vector<ImuSample> samples = test::unit_at(test::kPositions[0]);
    for (std::size_t k = 100; k < 120; ++k) (void)estimator.add_imu(samples[k]);
    (void)estimator.newest();
    while (estimator.take()) continue;
  }
};

template <class Stream>
struct Streaming {
  using Estimator = test::Kept<Stream>;
  static constexpr std::size_t kTrials = 150;
  static auto params() { return test::params_of_stream<Stream>(); }
  static constexpr std::size_t kSome = test::kRolls<Stream> ? 500 : 150;  // in motion
  static Estimator some() {
    Estimator estimator;
    const std::vector<ImuSample> samples = test::samples_of_stream<Stream>();
    for (std::size_t k = 0; k < kSome; ++k) EXPECT_TRUE(estimator.push(samples[k]).ok());
    return estimator;
  }
  static void go_on(Estimator& estimator) {
    const std::vector<ImuSample> samples = test::samples_of_stream<Stream>();
    for (std::size_t k = kSome; k < kSome + 20; ++k) (void)estimator.push(samples[k]);
    estimator.end();
  }
};

template <class Kind>
class HostileState : public testing::Test {};
using Kinds =
    testing::Types<Tumbling, Rolling, Streaming<RateStream>, Streaming<RegimeStream>, Streaming<HandHeldStream>,
                   Streaming<HandHeldPipeline>, Streaming<RollingFilter>, Streaming<RollingSmoother>>;
TYPED_TEST_SUITE(HostileState, Kinds);

TYPED_TEST(HostileState, CutAnywhereIsRefused) {
  const Bytes saved = TypeParam::some().save();
  typename TypeParam::Estimator estimator(TypeParam::params());
  for (std::size_t length = 0; length < saved.size(); length += length < 200 ? 1 : saved.size() / 61) {
    const Status status = estimator.load(std::span(saved).first(length));
    EXPECT_EQ(status.error_code, ErrorCode::too_few) << length << ": " << status.message();
    Bytes resealed(saved.begin(), saved.begin() + static_cast<std::ptrdiff_t>(length));
    reseal(resealed);
    EXPECT_FALSE(estimator.load(resealed).ok()) << length;
  }
  Bytes longer = saved;
  longer.push_back(std::byte{0});
  EXPECT_FALSE(estimator.load(longer).ok());
  reseal(longer);
  EXPECT_STREQ(estimator.load(longer).field, "number of bytes after the saved state");
  ASSERT_TRUE(estimator.load(saved).ok()) << "negative control";
  EXPECT_EQ(estimator.save(), saved);
  EXPECT_FALSE(estimator.load(longer).ok());
  EXPECT_EQ(estimator.save(), saved) << "on trouble it is as it was";
}

TYPED_TEST(HostileState, AnyByteThatFlippedIsRefused) {
  const Bytes saved = TypeParam::some().save();
  typename TypeParam::Estimator estimator(TypeParam::params());
  for (std::size_t at = 0; at < saved.size(); at += at < kHeader ? 1 : saved.size() / 97) {
    Bytes flipped = saved;
    flipped[at] ^= std::byte{0x10};
    const Status status = estimator.load(flipped);
    EXPECT_FALSE(status.ok()) << at;
    EXPECT_STRNE(status.field, "") << at;
  }
}

TYPED_TEST(HostileState, TheHeaderSaysWhatIsWrong) {
  const Bytes saved = TypeParam::some().save();
  typename TypeParam::Estimator estimator(TypeParam::params());
  const auto field_with = [&](std::size_t at, std::uint8_t value) {
    Bytes changed = saved;
    changed[at] = static_cast<std::byte>(value);
    reseal(changed);
    return std::string(estimator.load(changed).field);
  };
  EXPECT_EQ(field_with(0, 'T'), "magic number of the saved state");
  EXPECT_EQ(field_with(8, 99), "version of the saved state");
  EXPECT_EQ(field_with(12, 99), "kind of the saved state");
  // whatever it is: a layout may have any byte
  EXPECT_EQ(field_with(16, static_cast<std::uint8_t>(saved[16]) ^ 0x5au), "layout of the saved state");
}

/// With a valid checksum, load() cannot detect every change: an accepted state saves the same bytes again, and
/// continues.
TYPED_TEST(HostileState, MadeUpNumbersNeverHurt) {
  const Bytes saved = TypeParam::some().save();
  std::uint64_t state = 2026;
  const auto random = [&](std::uint64_t below) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (state >> 33) % below;
  };
  constexpr std::uint64_t kNumbers[] = {0,
                                        1,
                                        0xffu,
                                        0x7fffffffu,
                                        0xffffffffffffffffu,
                                        0x7fffffffffffffffu,
                                        0x8000000000000000u,
                                        0x7ff0000000000000u,
                                        0x7ff8000000000000u,
                                        0x7fe0000000000000u,
                                        0x0000000000100000u};
  std::size_t taken = 0, refused = 0;
  for (std::size_t trial = 0; trial < TypeParam::kTrials; ++trial) {
    Bytes made_up = saved;
    for (std::uint64_t edits = 1 + random(3); edits-- > 0;) {
      const std::size_t at = kHeader + random(made_up.size() - kHeader - 8);
      if (random(2) == 0) {
        made_up[at] = static_cast<std::byte>(random(256));
      } else {
        put_number(kNumbers[random(std::size(kNumbers))], at, made_up);
      }
    }
    reseal(made_up);
    typename TypeParam::Estimator estimator(TypeParam::params());
    const Status status = estimator.load(made_up);
    if (!status.ok()) {
      EXPECT_STRNE(status.field, "");
      ++refused;
      continue;
    }
    ++taken;
    EXPECT_EQ(estimator.save(), made_up) << "trial " << trial;
    TypeParam::go_on(estimator);
  }
  EXPECT_GT(refused, TypeParam::kTrials / 10);
  EXPECT_GT(taken, TypeParam::kTrials / 10);
}

/// Of a log that says readings again: their age is a place in the window.
TEST(HostileHeldReadings, BeyondWhatIsHeldAreRefused) {
  const HandHeldPipeline::Params params = test::params_of_stream<HandHeldPipeline>();
  const HandHeldPipeline stream(params);
  HandHeldPipeline::State good = stream.start();
  std::optional<RateState> out;
  for (std::size_t k = 0; k < 30; ++k) ASSERT_TRUE(stream.push(test::thrown_samples()[k], good, out).ok());
  const auto field_with = [&](auto spoil) {
    HandHeldPipeline::State spoiled = good, loaded = good;
    spoil(spoiled.stream.readings.back().gyro, spoiled.repeat_state.memory[0]);
    return std::string(
        load_state<HandHeldPipeline>(save_state<HandHeldPipeline>(params, spoiled), params, loaded).field);
  };
  using Memory = RepeatDetector::Memory;
  EXPECT_EQ(field_with([](RepeatedReading&, Memory&) {}), "") << "negative control";
  EXPECT_EQ(field_with([](RepeatedReading& held, Memory&) { held.age_samples = 1e300; }), "held.age_samples");
  EXPECT_EQ(field_with([](RepeatedReading& held, Memory&) { held.age_samples = -1.0; }), "held.age_samples");
  EXPECT_EQ(field_with([](RepeatedReading& held, Memory&) { held.period_samples = 11.0; }), "held.period_samples");
  EXPECT_EQ(field_with([](RepeatedReading& held, Memory&) { held.period_samples = 0.0; }), "held.period_samples");
  EXPECT_EQ(field_with([](RepeatedReading&, Memory& memory) { memory.equal_samples = -1e300; }), "hold.run_samples");
  EXPECT_EQ(field_with([](RepeatedReading&, Memory& memory) { memory.moving = 1e300; }), "hold.moving");
  EXPECT_EQ(field_with([](RepeatedReading&, Memory& memory) { memory.repeated = memory.moving + 1.0; }),
            "hold.repeated");
}

/// A second pass that is under way in a run that has not moved: what it counts from is not there.
TEST(HostileSecondPass, WithoutAMotionIsRefused) {
  test::ThrownBody body;
  TumblingOdometry::Params params;
  params.imu.rate_hz = body.imu_hz;
  params.lever_arm_I_m = body.lever_arm_I_m;
  params.expert.second_pass.after_s = 0.9;
  TumblingOdometry estimator(params);
  const std::vector<ImuSample> imu = body.imu();
  const std::vector<test::ThrownBody::Sweep> sweeps = body.sweeps();
  std::size_t next = 0;
  for (std::size_t k = 0; k < 255; ++k) {
    ASSERT_TRUE(estimator.add_imu(imu[k]).ok());
    for (; next < sweeps.size() && sweeps[next].end_ns <= imu[k].time_ns; ++next)
      ASSERT_TRUE(estimator.add_sweep(sweeps[next].start_ns, sweeps[next].end_ns, sweeps[next].points).ok());
    while (estimator.take()) continue;
  }
  ASSERT_FALSE(estimator.second_pass_applied());
  const Bytes saved = estimator.save();
  std::size_t refused = 0;
  for (std::size_t k = 115; k < 140; ++k) {
    Bytes moved(16);  // the optional stamp of a sample at about the first motion, wherever it stands
    put_number(1, 0, moved);
    put_number(static_cast<std::uint64_t>(imu[k].time_ns), 8, moved);
    for (auto at = saved.begin();; ++at) {
      at = std::search(at, saved.end(), moved.begin(), moved.end());
      if (at == saved.end()) break;
      Bytes made_up(saved.begin(), at);
      made_up.resize(made_up.size() + 8);
      made_up.insert(made_up.end(), at + 16, saved.end());
      reseal(made_up);
      refused += std::string(TumblingOdometry(params).load(made_up).field) == "second_pass.moves_ns";
    }
  }
  EXPECT_EQ(refused, 1u);
}

}  // namespace
}  // namespace tumble
