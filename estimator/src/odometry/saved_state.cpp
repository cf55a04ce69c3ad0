// SPDX-License-Identifier: BSD-3-Clause
#include "saved_state.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace tumble::odometry {

namespace {

constexpr std::string_view kMagic = "tumblest";
constexpr std::size_t kChecksumAt = 32;

std::vector<std::byte> header(SavedKind kind, std::uint64_t layout, std::uint64_t size) {
  std::vector<std::byte> out;
  StateWriter write(out);
  write.numbers("magic", kMagic.data(), kMagic.size());
  const auto number = static_cast<std::uint32_t>(kind);
  write("version", kSavedVersion);
  write("kind", number);
  write("layout", layout);
  write("size", size);
  return out;
}

std::uint64_t checksum_of(std::span<const std::byte> bytes) {
  return checksum(bytes.subspan(kSavedHeader), checksum(bytes.first(kChecksumAt)));
}

std::uint64_t number_at(std::span<const std::byte> bytes, std::size_t at, std::size_t width) {
  std::uint64_t out = 0;
  for (std::size_t k = width; k-- > 0;) out = out << 8 | std::to_integer<std::uint64_t>(bytes[at + k]);
  return out;
}

}  // namespace

void seal(SavedKind kind, std::uint64_t layout, std::vector<std::byte>& bytes) {
  const std::vector<std::byte> head = header(kind, layout, bytes.size() - kSavedHeader);
  std::copy(head.begin(), head.end(), bytes.begin());
  const std::uint64_t sum = checksum_of(bytes);
  std::vector<std::byte> written;
  StateWriter(written).numbers("checksum", &sum, 1);
  std::copy(written.begin(), written.end(), bytes.begin() + kChecksumAt);
}

Status open(SavedKind kind, std::uint64_t layout, std::span<const std::byte> bytes,
            std::span<const std::byte>& payload) {
  if (bytes.size() < kSavedHeader)
    return {ErrorCode::too_few, "number of bytes of the saved state", double(bytes.size()), double(kSavedHeader)};
  const std::vector<std::byte> expected = header(kind, layout, bytes.size() - kSavedHeader);
  struct Part {
    const char* name;
    std::size_t at, width;
  };
  constexpr std::array<Part, 5> kParts = {
      Part{"magic number of the saved state", 0, 8}, Part{"version of the saved state", 8, 4},
      Part{"kind of the saved state", 12, 4}, Part{"number of bytes of the saved state", 24, 8},
      Part{"layout of the saved state", 16, 8}};
  for (const Part& part : kParts) {
    const std::uint64_t found = number_at(bytes, part.at, part.width),
                        wanted = number_at(expected, part.at, part.width);
    if (found == wanted) continue;
    const bool cut = part.at == 24 && found > wanted;
    return {cut ? ErrorCode::too_few : ErrorCode::out_of_range, part.name, double(cut ? wanted : found),
            double(cut ? found : wanted)};
  }
  const std::uint64_t sum = checksum_of(bytes), stated = number_at(bytes, kChecksumAt, 8);
  if (sum != stated) return {ErrorCode::out_of_range, "checksum of the saved state", double(sum), double(stated)};
  payload = bytes.subspan(kSavedHeader);
  return {};
}

}  // namespace tumble::odometry
