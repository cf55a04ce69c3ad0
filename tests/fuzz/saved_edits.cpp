// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/saved_edits.hpp"

#include <cctype>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <span>

#include "estimator/src/common/state_bytes.hpp"

namespace tumble::fuzz {

namespace {

constexpr std::size_t kHeader = 40, kLengthAt = 24, kChecksumAt = 32, kEdit = 6;

void put_number(std::uint64_t value, std::size_t at, Bytes& bytes) {
  for (std::size_t k = 0; k < 8; ++k) bytes[at + k] = static_cast<std::byte>(value >> (8 * k));
}

void reseal(Bytes& bytes) {
  put_number(bytes.size() - kHeader, kLengthAt, bytes);
  const std::span<const std::byte> all(bytes);
  put_number(checksum(all.subspan(kHeader), checksum(all.first(kChecksumAt))), kChecksumAt, bytes);
}

/// Values of numbers, lengths, flags and enumerations. The last values are parameters within most bounds, and at the
/// bounds.
constexpr std::uint64_t kNumbers[] = {0,
                                      1,
                                      2,
                                      0xffffffffu,
                                      0x7fffffffffffffffu,
                                      0xffffffffffffffffu,
                                      0x8000000000000000u,
                                      0x7ff0000000000000u,
                                      0x7ff8000000000000u,
                                      0x7fe0000000000000u,
                                      0x7f8000007f800000u,
                                      0x3ee4f8b588e368f1u,   // 1e-5
                                      0x3ff0000000000000u,   // 1
                                      0x4034000000000000u,   // 20
                                      0x408f400000000000u,   // 1e3
                                      0x40f86a0000000000u,   // 1e5
                                      0x4197d78400000000u};  // 1e8

void edit(std::span<const unsigned char> how, Bytes& bytes) {
  const std::uint32_t where = how[1] | how[2] << 8u | how[3] << 16u | std::uint32_t{how[4]} << 24u;
  const std::size_t room = bytes.size() - kHeader;
  if (room < 9) return;
  const std::size_t at = kHeader + where % (room - 8);
  const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
  switch (how[0] % 5) {
    case 0:
      *place = static_cast<std::byte>(how[5]);
      return;
    case 1:
      *place ^= static_cast<std::byte>(how[5]);
      return;
    case 2:
      put_number(kNumbers[how[5] % std::size(kNumbers)], at, bytes);
      return;
    case 3:
      bytes.erase(place, place + 1 + how[5] % 8);
      return;
    default:
      bytes.insert(place, 1 + how[5] % 8, std::byte{0});
  }
}

}  // namespace

Bytes Edits::spoil(Bytes saved) const {
  std::span<const unsigned char> edits(reinterpret_cast<const unsigned char*>(text.data()), text.size());
  for (; edits.size() >= kEdit; edits = edits.subspan(kEdit)) edit(edits, saved);
  if (!edits.empty()) throw scenarios::BadInput("half an edit");
  reseal(saved);
  return saved;
}

Edits read_edits(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (text.empty()) throw scenarios::BadInput("no letter");
  const auto first = static_cast<unsigned char>(text[0]);
  return {static_cast<char>(std::toupper(first)), std::islower(first) != 0, text.substr(1)};
}

}  // namespace tumble::fuzz
