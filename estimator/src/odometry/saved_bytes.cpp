// SPDX-License-Identifier: BSD-3-Clause
#include "saved_bytes.hpp"

#include <Eigen/Cholesky>
#include <string_view>

namespace tumble::odometry {

namespace {

constexpr std::string_view kMagic = "tumblest";
constexpr std::size_t kChecksumAt = 32;

std::uint64_t layout_version_of(SavedStateKind kind) {
  return kind == SavedStateKind::map ? 0xdff8c7553cce8be4u : 2u;
}

std::array<std::byte, kChecksumAt> header(SavedStateKind kind, std::uint64_t size) {
  std::array<std::byte, kChecksumAt> out{};
  const auto put = [&](std::uint64_t value, std::size_t at, std::size_t width) {
    for (std::size_t k = 0; k < width; ++k) out[at + k] = static_cast<std::byte>(value >> (8 * k));
  };
  std::transform(kMagic.begin(), kMagic.end(), out.begin(), [](char letter) { return static_cast<std::byte>(letter); });
  put(1, 8, 4);
  put(static_cast<std::uint32_t>(kind), 12, 4);
  put(layout_version_of(kind), 16, 8);
  put(size, 24, 8);
  return out;
}

/// Returns the 64-bit checksum FNV-1a (RFC 9923) of all bytes except the checksum itself. The checksum detects
/// accidental damage, but not deliberate changes.
std::uint64_t checksum_of(std::span<const std::byte> bytes) {
  std::uint64_t out = 0xcbf29ce484222325u;
  const auto add = [&](std::span<const std::byte> part) {
    for (const std::byte byte : part) out = (out ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3u;
  };
  add(bytes.first(kChecksumAt));
  add(bytes.subspan(kSavedHeader));
  return out;
}

std::uint64_t integer_at(std::span<const std::byte> bytes, std::size_t at, std::size_t width) {
  std::uint64_t out = 0;
  for (std::size_t k = width; k-- > 0;) out = out << 8 | std::to_integer<std::uint64_t>(bytes[at + k]);
  return out;
}

Status check_header(SavedStateKind kind, std::span<const std::byte> bytes) {
  constexpr const char* kSize = "number of bytes of the saved state";
  if (bytes.size() < kSavedHeader)
    return {ErrorCode::insufficient_data, kSize, double(bytes.size()), double(kSavedHeader)};
  const auto expected = header(kind, bytes.size() - kSavedHeader);
  struct HeaderField {
    const char* name;
    std::size_t at, byte_count;
  };
  for (const HeaderField& part :
       {HeaderField{"magic number of the saved state", 0, 8}, HeaderField{"version of the saved state", 8, 4},
        HeaderField{"kind of the saved state", 12, 4}, HeaderField{kSize, 24, 8},
        HeaderField{"layout of the saved state", 16, 8}}) {
    const std::uint64_t found = integer_at(bytes, part.at, part.byte_count),
                        wanted = integer_at(expected, part.at, part.byte_count);
    if (found == wanted) continue;
    if (part.at == 24 && found > wanted) return {ErrorCode::insufficient_data, kSize, double(wanted), double(found)};
    return {ErrorCode::out_of_range, part.name, double(found), double(wanted)};
  }
  const std::uint64_t sum = checksum_of(bytes), stated = integer_at(bytes, kChecksumAt, 8);
  if (sum != stated) return {ErrorCode::out_of_range, "checksum of the saved state", double(sum), double(stated)};
  return {};
}

}  // namespace

std::vector<std::byte> SavedStateWriter::finish(SavedStateKind kind) && {
  const auto head = header(kind, bytes_.size() - kSavedHeader);
  std::copy(head.begin(), head.end(), bytes_.begin());
  const std::uint64_t sum = checksum_of(bytes_);
  for (std::size_t k = 0; k < 8; ++k) bytes_[kChecksumAt + k] = static_cast<std::byte>(sum >> (8 * k));
  return std::move(bytes_);
}

SavedStateReader::SavedStateReader(SavedStateKind kind, std::span<const std::byte> bytes)
    : status_(check_header(kind, bytes)) {
  if (status_.ok()) remaining_bytes_ = bytes.subspan(kSavedHeader);
}

void SavedStateReader::require_covariance(const char* name, const Eigen::Ref<const Eigen::MatrixXd>& P) {
  constexpr double kRounding = 1e-9;
  if (!status_.ok()) return;
  const double largest = P.cwiseAbs().maxCoeff(), asymmetry = (P - P.transpose()).cwiseAbs().maxCoeff();
  require_condition(name, asymmetry <= kRounding * largest, asymmetry, kRounding * largest);
  const double least = std::min(P.diagonal().minCoeff(), P.ldlt().vectorD().minCoeff() + kRounding * largest);
  require_condition(name, least >= 0.0, least, 0.0);
}

void check_pose(SavedStateReader& in, const PoseState& pose) {
  const double length = pose.orientation_W.norm();
  in.require_condition("pose.q_WA", std::abs(length - 1.0) < 1e-6, length, 1.0);
  in.require_covariance("pose.covariance", pose.covariance);
}

}  // namespace tumble::odometry
