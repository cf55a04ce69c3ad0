// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "scenarios/estimates/estimate.hpp"

namespace tumble::scenarios {

/// AnswerBounds checks the result of an external program. Result files that are too large are rejected before they are
/// read.
class AnswerBounds {
 public:
  using Place = std::function<std::string(std::size_t row)>;

  explicit AnswerBounds(const sim::Sensors& sensors);

  /// Returns the size limit of a table: 1 KiB per row, with 10 000 rows plus 4 rows per IMU sample and per lidar sweep.
  std::uintmax_t table_bytes() const;
  /// Returns the size limit of a map: 32 bytes per point, with 10 000 points plus 4 points per lidar point.
  std::uintmax_t map_memory_bytes() const;

  void require_size(const std::filesystem::path& file, std::uintmax_t bytes) const;

  /// Throws BadInput with location, value and limit if a result value is outside its limits. Time stamps of a result
  /// must be within 10 s of the recording. Positions of a result [m] must be finite and within 1e7 m of the origin,
  /// which allows Earth-centred coordinates. Quaternions of a result must have norm 1 within 1 %. Rates of a result
  /// [rad/s] must be finite and below 1e6, with finite covariances.
  void require_rates(const std::vector<AngularRateState>& rates, const Place& place) const;
  void require_poses(const std::vector<PoseState>& poses, const Place& place) const;
  void require_attitudes(const std::vector<AttitudeState>& attitudes, const Place& place) const;
  /// Throws BadInput if the time stamps seem to have a wrong unit. The function compares the time span of at least ten
  /// time stamps with the duration of the recording. If time span and duration differ by a factor above 100, the unit
  /// of the time stamps is probably wrong. A time span that is too long but fits no other unit is accepted, because
  /// probably only a few time stamps are wrong.
  void require_unit(std::span<const double> stamps_s, const char* unit, const Place& place) const;
  void require_unit(const Estimate& estimate, const char* unit, const Place& place) const;
  void require_slam(const Estimate& estimate) const;

 private:
  void require_time(std::int64_t time_ns, const std::string& where) const;
  void require_pose(const PoseState& pose, const std::string& where) const;

  std::uintmax_t rows_ = 0, points_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  double length_s_ = 0.0;
};

}  // namespace tumble::scenarios
