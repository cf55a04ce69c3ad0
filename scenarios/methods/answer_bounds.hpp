// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// AnswerBounds limits the size and the values of an external method's result for one recording. AnswerBounds checks
/// the size of a file before reading, because the method's time limit excludes reading.
class AnswerBounds {
 public:
  /// Place returns the location of row `row` for an error message, for example "poses.tum:3".
  using Place = std::function<std::string(std::size_t row)>;

  explicit AnswerBounds(const sim::Sensors& sensors);

  /// Returns the size limit [bytes] of a table, text or trajectory: 1 KiB per row. The number of rows is limited to 10
  /// 000, plus 4 per IMU sample and per lidar sweep.
  std::uintmax_t table_bytes() const;
  /// Returns the size limit [bytes] of a float32 map: 32 bytes per point. The number of points is limited to 10 000,
  /// plus 4 per lidar point.
  std::uintmax_t map_bytes() const;

  /// Throws BadInput unless `file` is a regular file of at most `bytes`. The function checks only the size, without
  /// reading the file.
  void require_size(const std::filesystem::path& file, std::uintmax_t bytes) const;

  /// The functions require_rates to require_slam check the values of an external method's result and throw BadInput
  /// with location, value and limit. Time stamps must be within 10 s of the recording. Positions [m] must be finite and
  /// within 1e7 m of the origin, which allows Earth-centred coordinates. Quaternions must have norm 1 within 1 %, as in
  /// TUM files. Rates [rad/s] must be finite and below 1e6, and their covariances must be finite.
  void require_rates(const std::vector<RateState>& rates, const Place& place) const;
  void require_poses(const std::vector<PoseState>& poses, const Place& place) const;
  void require_attitudes(const std::vector<AttitudeState>& attitudes, const Place& place) const;
  /// Throws BadInput if ten or more time stamps are probably not in `unit`. The unit is wrong if the time stamps cover
  /// less than a hundredth of the recording. The unit is also wrong if the time stamps cover more than a hundred times
  /// the recording and fit another unit.
  void require_unit(std::span<const double> stamps_s, const char* unit, const Place& place) const;
  void require_unit(const Estimate& estimate, const char* unit, const Place& place) const;
  /// Checks the pose and trajectory of each sweep, and the points of the map; throws BadInput for an invalid value. The
  /// limits of positions and quaternions also apply to the sweeps and the map.
  void require_slam(const Estimate& estimate) const;

 private:
  void require_time(std::int64_t time_ns, const std::string& where) const;
  void require_pose(const PoseState& pose, const std::string& where) const;

  std::uintmax_t rows_ = 0, points_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  double length_s_ = 0.0;  ///< duration of the readings
};

}  // namespace tumble::scenarios
