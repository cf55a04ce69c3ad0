// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/diagnosis/probable_devices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/upper_median.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kDegree_rad = 0.017453292519943295;
constexpr double kRingOff_rad = 0.5 * kDegree_rad;
/// Points closer than 0.5 m are ignored, because they may belong to the robot, and because their beams may start at the
/// mirror instead of the origin.
constexpr float kNear_m = 0.5f;
constexpr std::size_t kSweepsUsed = 10, kLeastPointsOfRing = 20;

std::string letters_of(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

std::vector<double> elevations(const DataSheet& sheet) {
  std::vector<double> out;
  const sim::Values values = sheet.values();
  if (sheet.sensor_kind == "column_lidar") {
    if (values.at("elevation_shift_share") != 0.0) return {};
    const double rings = values.at("rings"), low = values.at("elevation_low_rad"),
                 high = values.at("elevation_high_rad");
    for (int ring = 0; ring < static_cast<int>(rings); ++ring) out.push_back(low + (high - low) * ring / (rings - 1.0));
  } else if (sheet.sensor_kind == "spinning_lidar") {
    for (const DataSheet::Entry& entry : sheet.entries) {
      if (entry.name.starts_with("elevation_")) out.push_back(entry.value);
    }
  }
  std::ranges::sort(out);
  return out;
}

std::vector<double> seen_elevations(const sim::LidarRecord& lidar) {
  const std::size_t sweeps = std::min(kSweepsUsed, lidar.sweep_start_ns.size());
  if (sweeps == 0 || lidar.ring.size() != lidar.position_L_m.size()) return {};
  std::map<std::uint16_t, std::vector<double>> rings;
  for (std::size_t k = 0; k < std::min<std::size_t>(lidar.sweep_first[sweeps], lidar.ring.size()); ++k) {
    if (lidar.range_m[k] > kNear_m)
      rings[lidar.ring[k]].push_back(std::asin(std::clamp(lidar.position_L_m[k].z() / lidar.range_m[k], -1.0f, 1.0f)));
  }
  std::vector<double> out;
  for (auto& [ring, angles] : rings) {
    if (angles.size() < kLeastPointsOfRing) return {};
    out.push_back(upper_median(std::move(angles)));
  }
  std::ranges::sort(out);
  return out;
}

bool is_kind(const DataSheet& sheet, const char* ending) {
  return sheet.sensor_kind.ends_with(ending);
}

std::optional<ProbableDevice> by_name(const std::string& name, std::span<const DataSheet> sheets, const char* kind) {
  std::optional<ProbableDevice> out;
  for (const DataSheet& sheet : sheets) {
    if (!is_kind(sheet, kind) || letters_of(name).find(letters_of(sheet.device)) == std::string::npos) continue;
    if (!out || sheet.device.size() > out->device.size()) out = ProbableDevice{sheet.device, "name of the sensor"};
  }
  return out;
}

bool fits(const DataSheet& sheet, const sim::ImuRecord& imu) {
  sim::ImuRecord stated = imu;
  apply_sheet(sheet, stated);
  const auto beyond = [&](std::size_t k) {
    return !bridge::check_range(stated, imu.gyro_rad_s[k], imu.accel_m_s2[k]).ok();
  };
  std::size_t count = 0;
  for (std::size_t k = 0; k < imu.gyro_rad_s.size(); ++k) count += beyond(k) ? 1 : 0;
  return static_cast<double>(count) <= bridge::kWildShareMax * static_cast<double>(imu.gyro_rad_s.size());
}

}  // namespace

void apply_sheet(const DataSheet& sheet, sim::ImuRecord& imu) {
  const sim::Values values = sheet.values();
  imu.device = sheet.device;
  imu.stated_gyro_range_rad_s = values.at("gyro_range_rad_s");
  imu.stated_accel_range_m_s2 = values.at("accel_range_m_s2");
  imu.gyro_noise_rad_s_sqrt_hz = values.at("gyro_noise_rad_s_sqrt_hz");
  imu.accel_noise_m_s2_sqrt_hz = values.at("accel_noise_m_s2_sqrt_hz");
}

std::optional<ProbableDevice> probable_lidar(const sim::LidarRecord& lidar, std::span<const DataSheet> sheets) {
  const std::vector<double> seen = seen_elevations(lidar);
  std::optional<ProbableDevice> best;
  double best_off = kRingOff_rad;
  for (const DataSheet& sheet : sheets) {
    const std::vector<double> stated = is_kind(sheet, "lidar") ? elevations(sheet) : std::vector<double>{};
    if (stated.size() < 2 || stated.size() != seen.size()) continue;
    double off = 0.0;
    for (std::size_t k = 0; k < seen.size(); ++k) off = std::max(off, std::abs(seen[k] - stated[k]));
    if (off >= best_off) continue;
    best_off = off;
    best = ProbableDevice{
        sheet.device,
        fmt::format("the elevation angles of {} rings differ from the data sheet of this device by at most {} deg",
                    seen.size(), rounded(off / kDegree_rad))};
  }
  return best ? best : by_name(lidar.name, sheets, "lidar");
}

std::optional<ProbableDevice> probable_imu(const sim::ImuRecord& imu, std::span<const DataSheet> sheets) {
  std::optional<ProbableDevice> out = by_name(imu.name, sheets, "imu");
  constexpr std::pair<const char*, const char*> kBuiltIn[] = {{"ouster", "ouster_imu"}, {"livox", "mid360_imu"}};
  for (const auto& [maker, device] : kBuiltIn) {
    if (!out && letters_of(imu.name).find(maker) != std::string::npos)
      out = ProbableDevice{device, fmt::format("the name of the sensor contains '{}'", maker)};
  }
  if (!out) return std::nullopt;
  const auto sheet = std::ranges::find(sheets, out->device, &DataSheet::device);
  return sheet != sheets.end() && fits(*sheet, imu) ? out : std::nullopt;
}

}  // namespace tumble::scenarios
