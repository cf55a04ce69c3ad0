// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/src/common/state_bytes.hpp"

#include "estimator/src/common/state_layout.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "estimator/src/common/imu_members.hpp"

namespace tumble {
namespace {

enum class Colour : std::uint8_t { red, green };

struct Held {
  double value = 0.0;
  int count = 0;
  bool on = false;
  Colour colour = Colour::red;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  std::vector<ImuSample> samples;
  std::optional<TimeNs> time_ns;
  std::array<float, 2> pair{};
};

template <StateOf<Held> Self, class Visitor>
void members(Self& s, Visitor& visit) {
  visit("value", s.value);
  visit("count", s.count, 0.0, 10.0);
  visit("on", s.on);
  visit("colour", s.colour, Colour::green);
  visit("vector", s.vector);
  visit("q", s.q);
  visit("samples", s.samples);
  visit("time_ns", s.time_ns);
  visit.with_nan("pair", s.pair);
}

Held some() {
  Held out;
  out.value = -1.5;
  out.count = 7;
  out.on = true;
  out.colour = Colour::green;
  out.vector = {1.0, 2.0, 3.0};
  out.q = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  out.samples.resize(2);
  out.samples[1].time_ns = 5;
  out.time_ns = -3;
  out.pair = {0.25f, std::numeric_limits<float>::quiet_NaN()};
  return out;
}

std::vector<std::byte> bytes_of(const Held& held) {
  std::vector<std::byte> out;
  StateWriter write(out);
  write("held", held);
  return out;
}

Status read(const std::vector<std::byte>& bytes, Held& held) {
  StateReader in(bytes);
  in("held", held);
  return in.status();
}

TEST(StateBytes, AreReadAsTheyWereWritten) {
  Held read_back;
  const std::vector<std::byte> bytes = bytes_of(some());
  ASSERT_TRUE(read(bytes, read_back).ok());
  EXPECT_EQ(bytes_of(read_back), bytes);
  EXPECT_EQ(read_back.samples[1].time_ns, 5);
  EXPECT_EQ(read_back.q.coeffs(), some().q.coeffs());
  EXPECT_EQ(read_back.time_ns, std::optional<TimeNs>(-3));
}

TEST(StateBytes, AreLittleEndian) {
  std::vector<std::byte> bytes;
  StateWriter write(bytes);
  const std::uint32_t number = 0x01020304;
  write("number", number);
  EXPECT_EQ(std::to_integer<int>(bytes[0]), 4);
  EXPECT_EQ(std::to_integer<int>(bytes[3]), 1);
}

TEST(StateBytes, TroubleHasFieldValueAndBound) {
  const std::vector<std::byte> good = bytes_of(some());
  const auto status_with = [&](std::size_t at, std::initializer_list<int> values) {
    std::vector<std::byte> bytes = good;
    for (const int value : values) bytes[at++] = static_cast<std::byte>(value);
    Held held;
    return read(bytes, held);
  };
  // bytes: value 8, count 4, on 1, colour 1
  Status status = status_with(0, {0, 0, 0, 0, 0, 0, 0xf0, 0x7f});
  EXPECT_EQ(status.error_code, ErrorCode::non_finite);
  EXPECT_STREQ(status.field, "value");
  status = status_with(8, {11});
  EXPECT_EQ(status.message(), "out_of_range: count is 11; the bound is 10");
  status = status_with(12, {2});
  EXPECT_EQ(status.message(), "out_of_range: on is 2; the bound is 1");
  status = status_with(13, {2});
  EXPECT_EQ(status.message(), "out_of_range: colour is 2; the bound is 1");
  // a length without matching bytes allocates no memory
  status = status_with(14 + 24 + 32, {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x7f});
  EXPECT_EQ(status.error_code, ErrorCode::out_of_range);
  EXPECT_STREQ(status.field, "samples");
  status = status_with(14 + 24 + 32, {60});
  EXPECT_EQ(status.error_code, ErrorCode::too_few);
}

TEST(StateBytes, AreMatchedNumberByNumber) {
  const std::vector<std::byte> bytes = bytes_of(some());
  const auto differs_in = [&](auto change) {
    Held other = some();
    change(other);
    StateMatcher match(bytes);
    match("held", std::as_const(other));
    return match.status();
  };
  EXPECT_TRUE(differs_in([](Held&) {}).ok());
  const Status status = differs_in([](Held& h) { h.vector.y() = 4.0; });
  EXPECT_EQ(status.message(), "out_of_range: vector is 2; the bound is 4");
  EXPECT_STREQ(differs_in([](Held& h) { h.on = false; }).field, "on");
  EXPECT_STREQ(differs_in([](Held& h) { h.samples.pop_back(); }).field, "samples");
  EXPECT_STREQ(differs_in([](Held& h) { h.time_ns.reset(); }).field, "time_ns");
}

TEST(StateBytes, ChecksumIsFnv1a) {
  const std::string text = "foobar";  // test vector of RFC 9923
  EXPECT_EQ(checksum(std::as_bytes(std::span(text))), 0x85944171f73967e8u);
}

}  // namespace
}  // namespace tumble
