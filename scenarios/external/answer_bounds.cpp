// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/external/answer_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::uintmax_t kBase = 10'000;       // rows or points allowed for any recording
constexpr std::uintmax_t kPerReading = 4;      // additional rows or points per input reading
constexpr std::uintmax_t kBytesPerRow = 1024;  // a sweep's row of 37 numbers
constexpr std::uintmax_t kBytesPerPoint = 32;  // x y z nx ny nz sigma, header
constexpr std::int64_t kTimeMargin_ns = 10'000'000'000;
constexpr double kPositionMax_m = 1e7;
constexpr double kRateMax_rad_s = 1e6;
constexpr double kAnswerNormTolerance = 1e-2;
constexpr double kCorrelationTolerance = 1e-3;  // covariances may have few digits

constexpr std::size_t kStampsToJudge = 10;  // fewer stamps could agree by chance
constexpr double kUnitsApart = 100.0;       // smaller spans indicate a wrong unit

std::string unit_like(std::string_view unit, double times) {
  constexpr std::array<std::pair<const char*, double>, 4> kUnits = {
      {{"nanoseconds", 1e-9}, {"microseconds", 1e-6}, {"milliseconds", 1e-3}, {"seconds", 1.0}}};
  double asked_s = 1.0;
  for (const auto& [name, length_s] : kUnits)
    if (unit == name) asked_s = length_s;
  constexpr double kFactor = 5.0;  // a result may cover only a part
  for (const auto& [name, length_s] : kUnits) {
    const double share = times * length_s / asked_s;  // covered fraction in this unit
    if (unit != name && share > 1.0 / kFactor && share < kFactor)
      return fmt::format("; the time stamps seem to be in {}", name);
  }
  return "";
}

template <typename Vector>
std::string text_of(const Vector& v) {
  return fmt::format("({:g}, {:g}, {:g})", v.x(), v.y(), v.z());
}

void require_position(const Eigen::Vector3d& p_m, const std::string& where) {
  if (p_m.allFinite() && p_m.cwiseAbs().maxCoeff() <= kPositionMax_m) return;
  throw BadInput(fmt::format("{}: the position is {} m; it must be finite and within {:g} m of the origin", where,
                             text_of(p_m), kPositionMax_m));
}

void require_attitude(const Eigen::Quaterniond& q, const std::string& where) {
  const double norm = q.coeffs().stableNorm();
  if (std::abs(norm - 1.0) <= kAnswerNormTolerance) return;
  throw BadInput(fmt::format("{}: the quaternion has norm {:g}; it must be 1 (difference at most {:g})", where, norm,
                             kAnswerNormTolerance));
}

template <int N>
void require_covariance(const Eigen::Matrix<double, N, N>& C, const std::string& where) {
  if (!C.allFinite()) throw BadInput(fmt::format("{}: the covariance has a value that is not finite", where));
  if (const double least = C.diagonal().minCoeff(); least < 0.0)
    throw BadInput(
        fmt::format("{}: the covariance has a variance of {:g}; variances must be at least 0", where, least));
  for (int i = 0; i < N; ++i) {
    for (int j = i + 1; j < N; ++j) {
      const double most = std::sqrt(C(i, i)) * std::sqrt(C(j, j));
      if (std::abs(C(i, j)) > (1.0 + kCorrelationTolerance) * most)
        throw BadInput(
            fmt::format("{}: two components have the covariance {:g} and the variances {:g} and {:g}; the magnitude of "
                        "the covariance must be at most {:g}",
                        where, C(i, j), C(i, i), C(j, j), most));
    }
  }
}

}  // namespace

AnswerBounds::AnswerBounds(const sim::Sensors& sensors) : rows_(kBase), points_(kBase) {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  const auto span = [&](const std::vector<std::int64_t>& stamps, std::int64_t length_ns) {
    rows_ += kPerReading * stamps.size();
    if (stamps.empty()) return;
    first_ns = std::min(first_ns, stamps.front());
    last_ns_ = std::max(last_ns_, stamps.back() + length_ns);
  };
  for (const sim::ImuRecord& imu : sensors.imus) span(imu.time_ns, 0);
  for (const sim::LidarRecord& lidar : sensors.lidars) {
    span(lidar.sweep_start_ns, lidar.sweep_period_ns);
    points_ += kPerReading * lidar.position_L_m.size();
  }
  if (first_ns < last_ns_) length_s_ = 1e-9 * static_cast<double>(last_ns_ - first_ns);
  first_ns_ = std::min<std::int64_t>(first_ns, 0);  // the first sample may be later
}

std::uintmax_t AnswerBounds::table_bytes() const {
  return rows_ * kBytesPerRow;
}

std::uintmax_t AnswerBounds::map_memory_bytes() const {
  return points_ * kBytesPerPoint;
}

void AnswerBounds::require_size(const std::filesystem::path& file, std::uintmax_t bytes) const {
  const std::string name = file.filename().string();
  if (!std::filesystem::is_regular_file(std::filesystem::symlink_status(file)))
    throw BadInput(
        fmt::format("{}: the output path is not a regular file; the method must write a regular file", name));
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw BadInput(name + ": " + error.message());
  if (size > bytes)
    throw BadInput(fmt::format("{}: the output file has {} bytes; for this recording, it may have at most {} bytes",
                               name, size, bytes));
}

void AnswerBounds::require_time(std::int64_t time_ns, const std::string& where) const {
  if (time_ns >= first_ns_ - kTimeMargin_ns && time_ns <= last_ns_ + kTimeMargin_ns) return;
  const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) * 1e-9; };
  throw BadInput(
      fmt::format("{}: the time stamp is {:.9g} s; it must be between {:.9g} and {:.9g} s (the time of the recording "
                  "with a margin of 10 s)",
                  where, seconds(time_ns), seconds(first_ns_ - kTimeMargin_ns), seconds(last_ns_ + kTimeMargin_ns)));
}

void AnswerBounds::require_unit(std::span<const double> stamps_s, const char* unit, const Place& place) const {
  if (stamps_s.size() < kStampsToJudge || !(length_s_ > 0.0)) return;
  const auto [least, most] = std::ranges::minmax(stamps_s);
  const double times = (most - least) / length_s_;
  const auto outside = std::ranges::find_if(stamps_s, [this](double stamp_s) {
    return stamp_s < 1e-9 * static_cast<double>(first_ns_ - kTimeMargin_ns) ||
           stamp_s > 1e-9 * static_cast<double>(last_ns_ + kTimeMargin_ns);
  });
  const bool far = outside != stamps_s.end() && times > kUnitsApart, near = times < 1.0 / kUnitsApart;
  if (!far && !near) return;
  const std::string like = unit_like(unit, times);
  if (far && like.empty()) return;  // probably a few wrong stamps
  const std::size_t row = far ? static_cast<std::size_t>(outside - stamps_s.begin()) : stamps_s.size() - 1;
  throw BadInput(fmt::format(
      "{}: the time stamp is {:.9g} s, and all {} time stamps span {:.3g} s, but the recording lasts {:.3g} s; "
      "time stamps must be in {}{}",
      place(row), stamps_s[row], stamps_s.size(), most - least, length_s_, unit, like));
}

void AnswerBounds::require_unit(const Estimate& estimate, const char* unit, const Place& place) const {
  std::vector<double> stamps_s;
  for (const PoseState& pose : estimate.poses) stamps_s.push_back(1e-9 * static_cast<double>(pose.time_ns));
  for (const AttitudeState& each : estimate.attitudes) stamps_s.push_back(1e-9 * static_cast<double>(each.time_ns));
  require_unit(stamps_s, unit, place);
}

void AnswerBounds::require_pose(const PoseState& pose, const std::string& where) const {
  require_time(pose.time_ns, where);
  require_position(pose.position_W_m, where);
  require_attitude(pose.orientation_W, where);
}

void AnswerBounds::require_rates(const std::vector<AngularRateState>& rates, const Place& place) const {
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const Eigen::Vector3d& rate_rad_s = rates[k].w_WI_I_rad_s;
    if (!rate_rad_s.allFinite() || rate_rad_s.cwiseAbs().maxCoeff() > kRateMax_rad_s)
      throw BadInput(
          fmt::format("{}: the rate is {} rad/s; its components must be finite and at most {:g} rad/s in magnitude",
                      place(k), text_of(rate_rad_s), kRateMax_rad_s));
    require_covariance(rates[k].covariance_rad2_s2, place(k));
    require_time(rates[k].time_ns, place(k));
  }
}

void AnswerBounds::require_poses(const std::vector<PoseState>& poses, const Place& place) const {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    require_pose(poses[k], place(k));
    require_covariance(poses[k].covariance, place(k));
  }
}

void AnswerBounds::require_attitudes(const std::vector<AttitudeState>& attitudes, const Place& place) const {
  for (std::size_t k = 0; k < attitudes.size(); ++k) {
    require_time(attitudes[k].time_ns, place(k));
    require_attitude(attitudes[k].orientation_W, place(k));
    require_covariance(attitudes[k].covariance_rad2, place(k));
  }
}

void AnswerBounds::require_slam(const Estimate& estimate) const {
  for (std::size_t k = 0; k < estimate.sweeps.size(); ++k) {
    const std::string sweep = "sweep " + std::to_string(k);
    require_pose(estimate.sweeps[k].pose, sweep);
    const std::vector<PoseState>& trajectory = estimate.sweeps[k].trajectory;
    for (std::size_t j = 0; j < trajectory.size(); ++j)
      require_pose(trajectory[j], sweep + ", pose " + std::to_string(j));
  }
  for (std::size_t k = 0; k < estimate.map.size(); ++k)
    require_position(estimate.map[k].position_W_m.cast<double>(), "map: point " + std::to_string(k));
}

}  // namespace tumble::scenarios
