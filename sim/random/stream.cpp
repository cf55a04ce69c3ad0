// SPDX-License-Identifier: BSD-3-Clause
#include "sim/random/stream.hpp"

#include <cmath>
#include <numbers>

#include "sim/random/philox.hpp"

namespace tumble::sim {

namespace {

std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3u;
  }
  return hash;
}

double unit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

std::uint64_t join(std::uint32_t low, std::uint32_t high) {
  return (static_cast<std::uint64_t>(high) << 32) | low;
}

}  // namespace

Stream::Stream(std::uint64_t seed, std::string_view name) {
  // A Philox block combines the seed with a hash of the stream's name, so that similar seeds and similar names give
  // independent random numbers.
  const std::uint64_t hash = fnv1a(name);
  const auto folded = philox4x32_10({static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), 0, 0},
                                    {static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32)});
  key_[0] = folded[0];
  key_[1] = folded[1];
}

std::array<std::uint32_t, 4> Stream::block(std::uint64_t index) const {
  return philox4x32_10({static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), 0, 0},
                       {key_[0], key_[1]});
}

std::array<double, 2> Stream::normal_pair(std::uint64_t index) const {
  const auto b = block(index);
  // Normally distributed numbers are computed by the method of Box and Muller (1958). The number 1 - u is in (0, 1], so
  // the logarithm is finite.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - unit(join(b[0], b[1]))));
  const double angle = 2.0 * std::numbers::pi * unit(join(b[2], b[3]));
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

std::uint64_t Stream::bits() {
  if (left_ == 0) {
    buffer_ = block(next_++);
    left_ = 2;
  }
  const int first = left_ == 2 ? 0 : 2;
  --left_;
  return join(buffer_[first], buffer_[first + 1]);
}

double Stream::uniform() {
  return unit(bits());
}

double Stream::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

double Stream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const auto pair = normal_pair(next_++);
  spare_ = pair[1];
  has_spare_ = true;
  return pair[0];
}

}  // namespace tumble::sim
