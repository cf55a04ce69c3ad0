// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// AnswerBounds limits the size and the values of an external method's result. The size of a file is checked before
/// reading, because the method's time limit excludes reading.
class AnswerBounds {
 public:
  using Place = std::function<std::string(std::size_t row)>;

  explicit AnswerBounds(const sim::Sensors& sensors);

  /// A table, text or trajectory may have 1 KiB per row [bytes]. The number of rows is limited to 10 000, plus 4 per
  /// IMU sample and per lidar sweep.
  std::uintmax_t table_bytes() const;
  /// A float32 map may have 32 bytes per point [bytes]. The number of points is limited to 10 000, plus 4 per lidar
  /// point.
  std::uintmax_t map_bytes() const;

  void require_size(const std::filesystem::path& file, std::uintmax_t bytes) const;

  /// The functions require_rates to require_slam throw BadInput with location, value and limit. Time stamps must be
  /// within 10 s of the recording. Positions [m] must be finite and within 1e7 m of the origin, which allows
  /// Earth-centred coordinates. Quaternions must have norm 1 within 1 %, as in TUM files. Rates [rad/s] must be finite
  /// and below 1e6, with finite covariances.
  void require_rates(const std::vector<RateState>& rates, const Place& place) const;
  void require_poses(const std::vector<PoseState>& poses, const Place& place) const;
  void require_attitudes(const std::vector<AttitudeState>& attitudes, const Place& place) const;
  /// Throws BadInput if ten or more time stamps cover less than a hundredth of the recording, or cover more than a
  /// hundred times the recording and fit another unit.
  void require_unit(std::span<const double> stamps_s, const char* unit, const Place& place) const;
  void require_unit(const Estimate& estimate, const char* unit, const Place& place) const;
  void require_slam(const Estimate& estimate) const;

 private:
  void require_time(std::int64_t time_ns, const std::string& where) const;
  void require_pose(const PoseState& pose, const std::string& where) const;

  std::uintmax_t rows_ = 0, points_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  double length_s_ = 0.0;  ///< duration of the readings
};

}  // namespace tumble::scenarios
