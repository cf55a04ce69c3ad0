// SPDX-License-Identifier: BSD-3-Clause
#include "sim/lidar/lane_noise.hpp"

#include <bit>
#include <cmath>

namespace tumble::sim {

namespace {

constexpr int kBlocks = kLanes / 2;  // four random words per two lanes

struct Words {
  alignas(64) std::uint32_t word[4][kBlocks];
};

[[gnu::target("avx2")]] void philox(std::uint64_t first, std::array<std::uint32_t, 2> key, Words& words) {
  for (int i = 0; i < kBlocks; ++i) {
    const std::uint64_t counter = first + static_cast<std::uint64_t>(i);
    words.word[0][i] = static_cast<std::uint32_t>(counter);
    words.word[1][i] = static_cast<std::uint32_t>(counter >> 32);
    words.word[2][i] = words.word[3][i] = 0;
  }
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < kBlocks; ++i) {
      const std::uint64_t a = std::uint64_t{0xD2511F53u} * words.word[0][i];
      const std::uint64_t b = std::uint64_t{0xCD9E8D57u} * words.word[2][i];
      words.word[0][i] = static_cast<std::uint32_t>(b >> 32) ^ words.word[1][i] ^ key[0];
      words.word[1][i] = static_cast<std::uint32_t>(b);
      words.word[2][i] = static_cast<std::uint32_t>(a >> 32) ^ words.word[3][i] ^ key[1];
      words.word[3][i] = static_cast<std::uint32_t>(a);
    }
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
}

/// Converts a random word to a number in (0, 1]. The number has the full relative precision of float, so the logarithm
/// of a number near 0 is accurate.
float unit_of(std::uint32_t word) {
  return (static_cast<float>(static_cast<std::int32_t>(word >> 1)) + 0.5f) * 0x1p-31f;
}

/// Computes log(x) for x = 2^e m with m in [0.71, 1.41]. The logarithm of m is the series of 2 atanh((m - 1) / (m +
/// 1)), with a relative error of 2e-7.
float log_of(float x) {
  const std::int32_t bits = std::bit_cast<std::int32_t>(x) - 0x3f3504f3;
  const std::int32_t exponent = bits >> 23;
  const float m = std::bit_cast<float>((bits & 0x007fffff) + 0x3f3504f3);
  const float s = (m - 1.0f) / (m + 1.0f), s2 = s * s;
  const float series = s * (2.0f + s2 * (2.0f / 3 + s2 * (2.0f / 5 + s2 * (2.0f / 7 + s2 * (2.0f / 9)))));
  return static_cast<float>(exponent) * 0.693147181f + series;
}

void cos_sin_of(std::uint32_t word, float& cosine, float& sine) {
  const std::uint32_t quadrant = (word + 0x20000000u) >> 30;
  const auto rest = static_cast<std::int32_t>(word - (quadrant << 30));
  const float a = static_cast<float>(rest) * (6.28318531f * 0x1p-32f), a2 = a * a;
  const float s = a * (1.0f - a2 * (1.0f / 6 - a2 * (1.0f / 120 - a2 * (1.0f / 5040))));
  const float c = 1.0f - a2 * (0.5f - a2 * (1.0f / 24 - a2 * (1.0f / 720 - a2 * (1.0f / 40320))));
  const bool swapped = (quadrant & 1u) != 0;
  const float x = swapped ? s : c, y = swapped ? c : s;
  cosine = ((quadrant + 1u) & 2u) != 0 ? -x : x;
  sine = (quadrant & 2u) != 0 ? -y : y;
}

}  // namespace

LaneNoiseSource::LaneNoiseSource(const Stream& stream) {
  const auto block = stream.block(~std::uint64_t{0});
  key_ = {block[0], block[1]};
}

[[gnu::target("avx2")]] void LaneNoiseSource::draw(std::uint64_t index, LaneNoise& noise) const {
  Words words;
  philox(index * kBlocks, key_, words);
  for (int i = 0; i < kBlocks; ++i) {
    const float radius = std::sqrt(-2.0f * log_of(unit_of(words.word[0][i])));
    float cosine, sine;
    cos_sin_of(words.word[1][i], cosine, sine);
    noise.normal[i] = radius * cosine;
    noise.normal[i + kBlocks] = radius * sine;
  }
  for (int i = 0; i < kBlocks; ++i) {
    noise.uniform[i] = (static_cast<float>(static_cast<std::int32_t>(words.word[2][i] >> 9)) + 0.5f) * 0x1p-23f;
    noise.uniform[i + kBlocks] =
        (static_cast<float>(static_cast<std::int32_t>(words.word[3][i] >> 9)) + 0.5f) * 0x1p-23f;
  }
}

}  // namespace tumble::sim
