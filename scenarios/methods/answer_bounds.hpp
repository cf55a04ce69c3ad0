// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

/// What somebody else's method may answer to one recording. Beyond it an answer is refused, by its size before it is
/// read: reading is not within the time that the method is given.
class AnswerBounds {
 public:
  /// Names row k of what was left, for a message: "poses.tum:3".
  using Place = std::function<std::string(std::size_t row)>;

  explicit AnswerBounds(const sim::Sensors& sensors);

  /// Of a table, a text or a trajectory: 1 KiB for each of `rows`, which are 10 000 and 4 for each sample of an IMU
  /// and each sweep of a lidar.
  std::uintmax_t table_bytes() const;
  /// Of a map in float32: 32 bytes for each of 10 000 points and 4 for each point of the lidars.
  std::uintmax_t map_bytes() const;

  /// Throws BadInput unless `file` is a regular file of at most `bytes`. Nothing is read.
  void require_size(const std::filesystem::path& file, std::uintmax_t bytes) const;

  /// The three throw BadInput with place, value and bound. Stamps: within 10 s of the recording. Positions [m]: finite,
  /// within 1e7 m of the origin, which leaves room for coordinates of the Earth. Quaternions: norm 1 within a percent,
  /// as in TUM files. Rates [rad/s]: finite, within 1e6; their covariances: finite.
  void require_rates(const std::vector<RateState>& rates, const Place& place) const;
  void require_poses(const std::vector<PoseState>& poses, const Place& place) const;
  void require_attitudes(const std::vector<AttitudeState>& attitudes, const Place& place) const;
  /// Throws BadInput where ten stamps and more have a span that is as much too long as another unit makes it and lie
  /// outside of the recording, or a hundredth of it and less. `unit`: what they were to be counted in.
  void require_unit(std::span<const double> stamps_s, const char* unit, const Place& place) const;
  void require_unit(const Estimate& estimate, const char* unit, const Place& place) const;
  /// Poses of each sweep and each of its trajectory, and the points of the map, as the poses above.
  void require_slam(const Estimate& estimate) const;

 private:
  void require_time(std::int64_t time_ns, const std::string& where) const;
  void require_pose(const PoseState& pose, const std::string& where) const;

  std::uintmax_t rows_ = 0, points_ = 0;
  std::int64_t first_ns_ = 0, last_ns_ = 0;
  double length_s_ = 0.0;  ///< of the readings
};

}  // namespace tumble::scenarios
