// SPDX-License-Identifier: BSD-3-Clause
#include "saved_bytes.hpp"

#include <Eigen/Cholesky>
#include <string_view>
#include <utility>

#include "tumble/mapping/types.hpp"
#include "tumble/odometry/tumbling_odometry.hpp"

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

template <class Visit, class Rails>
void visit_saturation_levels(Visit& visit, Rails& rails) {
  constexpr double kLimitMax = 1e6, kCountMax = 1e9, kSlopeMax = 1.0;
  for (auto& channel : rails.axis_limit_state.channels)
    visit("saturation limit", channel.plateau_limit, 0.0, kLimitMax);
  for (auto* const planes : {&rails.gyro_planes, &rails.accel_saturation_planes}) {
    for (auto& plane : planes->sensing_axis) {
      if (!visit.presence_flag("saturation plane", plane)) continue;
      visit("plane.row", plane->row, -kSlopeMax, kSlopeMax);
      visit("plane.distance_rad_s", plane->saturation_limit_rad_s, 0.0, kLimitMax);
      visit("plane.offset_rad_s", plane->offset_rad_s, -kLimitMax, kLimitMax);
      visit("plane.covariance", plane->covariance, -kVarianceMax, kVarianceMax);
      for (auto& count : plane->samples) visit("plane.samples", count, 0.0, kCountMax);
      for (auto& count : plane->segments) visit("plane.segments", count, 0.0, kCountMax);
      visit("plane.deviation_rad_s", plane->deviation_rad_s, 0.0, kLimitMax);
      visit("plane.tolerance_rad_s", plane->tolerance_rad_s, 0.0, kLimitMax);
      visit("plane.log_odds", plane->log_odds);
    }
  }
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

/// If a sensor clips after misalignment compensation, each output has a fixed saturation limit, and saturation planes
/// (SaturationPlane) are not needed.
void write_saturation_levels(const SaturationLevels& rails, SavedStateWriter& out) {
  SaturationLevels kept = rails;
  if (rails.gyro_clips_after_compensation) kept.gyro_planes = {};
  if (rails.accel_clips_after_compensation) kept.accel_saturation_planes = {};
  visit_saturation_levels(out, std::as_const(kept));
}

void read_saturation_levels(SavedStateReader& in, SaturationLevels& rails) {
  visit_saturation_levels(in, rails);
  for (const SaturationPlanes* const planes : {&rails.gyro_planes, &rails.accel_saturation_planes}) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::optional<SaturationPlane>& plane = planes->sensing_axis[j];
      if (!plane || !in.status().ok()) continue;
      const double own = plane->row[static_cast<Eigen::Index>(j)];
      in.require_condition("plane.row", own == 1.0, own, 1.0);
      in.require_covariance("plane.covariance", plane->covariance);
    }
  }
}

void start_from_saturation_levels(const SaturationLevels& rails, SaturationLimitDetector::Params& detector,
                                  SaturationPlaneFinder::Params& gyro, SaturationPlaneFinder::Params& accel) {
  for (std::size_t c = 0; c < detector.known.size(); ++c)
    detector.known[c] = rails.axis_limit_state.channels[c].plateau_limit;
  gyro.known_limits = rails.gyro_planes;
  accel.known_limits = rails.accel_saturation_planes;
}

}  // namespace tumble::odometry

namespace tumble {

namespace {

constexpr std::size_t kPointBytes = 28;

template <class Visit, class Point>
void visit_point(Visit& visit, Point& point) {
  visit("point.position_W_m", point.position_W_m);
  visit("point.normal_W", point.normal_W);
  visit("point.sigma_m", point.sigma_m);
}

}  // namespace

std::vector<std::byte> save_map(std::span<const MapPoint> points) {
  odometry::SavedStateWriter out;
  out.reserve(sizeof(std::uint64_t) + kPointBytes * points.size());
  out("map.points", std::uint64_t{points.size()});
  for (const MapPoint& point : points) visit_point(out, point);
  return std::move(out).finish(odometry::SavedStateKind::map);
}

Status load_map(std::span<const std::byte> bytes, std::vector<MapPoint>& points) {
  odometry::SavedStateReader in(odometry::SavedStateKind::map, bytes);
  std::uint64_t count = 0;
  in("map.points", count);
  in.require_condition(
      "map.points",
      in.remaining_bytes().size() % kPointBytes == 0 && count == in.remaining_bytes().size() / kPointBytes,
      double(count), double(in.remaining_bytes().size()) / kPointBytes);
  if (!in.status().ok()) return in.status();
  std::vector<MapPoint> loaded(count);
  for (MapPoint& point : loaded) visit_point(in, point);
  if (!in.status().ok()) return in.status();
  if (const Status status = check_map_points(loaded); !status.ok()) return status;
  points = std::move(loaded);
  return {};
}

}  // namespace tumble
