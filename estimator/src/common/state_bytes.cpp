// SPDX-License-Identifier: BSD-3-Clause
#include "state_bytes.hpp"
#include "state_layout.hpp"

#include <algorithm>
#include <bit>

namespace tumble {

namespace {

constexpr std::uint64_t kPrime = 0x100000001b3u;  // FNV-1a, 64 bits

std::uint64_t mixed(std::uint64_t digest, std::uint64_t value) {
  for (int byte = 0; byte < 8; ++byte) digest = (digest ^ (value >> (8 * byte) & 0xffu)) * kPrime;
  return digest;
}

}  // namespace

std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t before) {
  for (const std::byte byte : bytes) before = (before ^ std::to_integer<std::uint64_t>(byte)) * kPrime;
  return before;
}

void detail::copy_little_endian(const std::byte* from, std::byte* to, std::size_t count, std::size_t width) {
  if constexpr (std::endian::native == std::endian::little) {
    std::memcpy(to, from, count * width);
  } else {
    for (std::size_t k = 0; k < count; ++k) std::reverse_copy(from + k * width, from + (k + 1) * width, to + k * width);
  }
}

bool StateReader::take(const char* name, std::byte* to, std::size_t count, std::size_t width, bool are_bools) {
  if (!going()) return false;
  if (left_.size() / width < count) {
    status_ = {ErrorCode::too_few, name, double(left_.size()), double(count * width)};
    return false;
  }
  const std::span<const std::byte> bytes = left_.first(count * width);
  left_ = left_.subspan(count * width);
  for (std::size_t k = 0; are_bools && k < count; ++k) bounded(name, std::to_integer<int>(bytes[k]), 0.0, 1.0);
  if (going()) detail::copy_little_endian(bytes.data(), to, count, width);
  return going();
}

std::size_t StateReader::length(const char* name, std::size_t /*replaced*/) {
  std::uint64_t count = 0;
  if (!take(name, reinterpret_cast<std::byte*>(&count), 1, sizeof count, false)) return 0;
  // each element of the list has at least one byte
  bounded(name, double(count), 0.0, double(left_.size()));
  return going() ? static_cast<std::size_t>(count) : 0;
}

void StateLayout::mix(std::string_view name, std::uint64_t kind, std::uint64_t count) {
  digest_ = checksum(std::as_bytes(std::span(name)), digest_);
  digest_ = mixed(mixed(digest_, kind), count);
}

}  // namespace tumble
