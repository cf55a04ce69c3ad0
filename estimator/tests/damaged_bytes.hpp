// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tumble/common/status.hpp"

/// Damaged saved runs: every damage must be reported with place, value and bound, and must leave the object unchanged.
namespace tumble::test {

using Bytes = std::vector<std::byte>;

inline void put_number(std::uint64_t value, std::size_t at, Bytes& bytes) {
  for (std::size_t k = 0; k < 8; ++k) bytes[at + k] = static_cast<std::byte>(value >> (8 * k));
}

/// Writes a valid length and checksum: FNV-1a by its definition.
inline void reseal(Bytes& bytes) {
  constexpr std::size_t kHeader = 40, kLengthAt = 24, kChecksumAt = 32;
  if (bytes.size() < kHeader) return;
  put_number(bytes.size() - kHeader, kLengthAt, bytes);
  std::uint64_t sum = 14695981039346656037u;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    if (k >= kChecksumAt && k < kHeader) continue;
    sum = (sum ^ std::to_integer<std::uint64_t>(bytes[k])) * 1099511628211u;
  }
  put_number(sum, kChecksumAt, bytes);
}

/// Checks that `odometry` rejects every damaged copy of `saved`, which it accepts.
template <class Odometry>
void expect_damage_is_refused(const Bytes& saved, Odometry odometry) {
  const Bytes before = odometry.save();
  const auto refusal = [&](const Bytes& bytes) {
    const Status status = odometry.load(bytes);
    EXPECT_FALSE(status.ok());
    EXPECT_STRNE(status.field, "");
    return status;
  };
  const auto changed = [&](std::size_t at, std::byte value) {
    Bytes out = saved;
    out[at] = value;
    reseal(out);
    return out;
  };
  for (std::size_t length = 0; length < saved.size(); length += length < 200 ? 1 : saved.size() / 61) {
    Bytes cut(saved.begin(), saved.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_EQ(refusal(cut).error_code, ErrorCode::insufficient_data) << length;
    reseal(cut);
    refusal(cut);
  }
  for (std::size_t at = 0; at < saved.size(); at += at < 64 ? 1 : saved.size() / 97) {
    Bytes flipped = saved;
    flipped[at] ^= std::byte{0x10};
    refusal(flipped);
  }
  Bytes longer = saved;
  longer.push_back(std::byte{0});
  refusal(longer);
  reseal(longer);
  refusal(longer);
  EXPECT_STREQ(refusal(changed(0, std::byte{'T'})).field, "magic number of the saved state");
  EXPECT_STREQ(refusal(changed(8, std::byte{99})).field, "version of the saved state");
  EXPECT_STREQ(refusal(changed(12, std::byte{99})).field, "kind of the saved state");
  EXPECT_STREQ(refusal(changed(16, std::byte{99})).field, "layout of the saved state");
  // with a valid checksum, an invalid number at any place either is refused, or does no harm
  for (const std::uint64_t number : {std::uint64_t{0x7ff0000000000000u}, std::uint64_t{0x7ff8000000000000u},
                                     std::uint64_t{0x7fe0000000000000u}, std::uint64_t{0xffffffffffffffffu}}) {
    for (std::size_t at = 40; at + 8 <= saved.size(); at += at < 4000 ? 8 : saved.size() / 97) {
      Bytes made_up = saved;
      put_number(number, at, made_up);
      reseal(made_up);
      Odometry other = odometry;
      const Status status = other.load(made_up);
      EXPECT_TRUE(status.ok() || !std::string_view(status.field).empty()) << at;
    }
  }
  EXPECT_EQ(odometry.save(), before) << "a refused run must leave the object unchanged";
  const Status status = odometry.load(saved);
  EXPECT_TRUE(status.ok()) << "negative control: " << status.message();
}

}  // namespace tumble::test
