// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/left_out.hpp"
#include "scenarios/recordings/stored_truth.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

struct SweepReading {
  sim::LidarRecord device;   ///< sweep_period_ns 0: median step
  std::string time_field;    ///< empty: a field with a usual name
  std::string time_unit;     ///< s ms us ns; empty: inferred
  bool not_skewed = false;   ///< already deskewed or simultaneous points
  double range_max_m = 0.0;  ///< from the data sheet; 0: unknown
  bool assumed = false;      ///< absolute point times replace the stamps
  /// Folder for storing the points on disk; empty: in memory.
  std::filesystem::path scratch;
};

struct PointTimeRule {
  std::string field;        ///< empty: the points have no times
  double unit_ns = 1.0;     ///< unit of the field [ns]
  bool absolute = false;    ///< false: since the sweep's stamp
  bool constant = false;    ///< equal times in a sweep
  bool short_span = false;  ///< small part of the sweep period
};

/// The field of the point times has one of these names (any case): t time timestamp timestamps time_stamp offset_time
/// time_offset offset_ns. The suffix _s, _ms, _us or _ns of a field name determines the unit of the point times.
/// Without a suffix, the unit follows from the time span of a sweep, which must be 0.15 to 150 % of `period_ns`. If the
/// sweep period is unknown (0), the size of times since 1970 determines the unit. If all points of each sweep have
/// equal times, the sweeps count as sweeps without point times.
///
/// A stated unit of the point times is rejected if the sweeps have at least 100 points and only another unit fits the
/// sweep period.
PointTimeRule find_point_times(const std::vector<Cloud>& first, std::int64_t period_ns, const SweepReading& reading,
                               const std::string& where);

struct BuiltSweeps {
  sim::LidarRecord lidar;
  std::optional<PointStore> points;
  /// Time of the last point of each cloud. If the points have no times, the start of the sweep is stored instead. The
  /// entry of a skipped cloud is empty.
  std::vector<std::optional<std::int64_t>> last_point_ns = {};
  std::vector<std::string> fields = {};  ///< of the first cloud
  std::int64_t record_lag_ns = 0;        ///< of a bag: smallest delay from the end of a sweep to its record stamp
};

/// SweepBuilder buffers the first ten clouds to determine the unit of the point times.
///
/// A point that is not finite, farther than 1000 km, or at the origin counts as a ray without return. Intensities above
/// 1 are divided by 255, or by the maximum intensity if the maximum exceeds 255. A sweep starts at its time stamp. If
/// the first point is earlier than the stamp, or more than a period later, the sweep starts at the first point.
///
/// A cloud is skipped if a field is missing, a ring is invalid, or the cloud starts before the previous sweep. A cloud
/// is also skipped if most points are beyond twice the lidar's range. If absolute point times and stamps come from
/// different clocks, the stamp is assumed to be the time of the first point.
class SweepBuilder {
 public:
  SweepBuilder(SweepReading reading, std::int64_t period_ns, LeftOut left_out = LeftOut("clouds"))
      : reading_(std::move(reading)), period_ns_(period_ns), left_out_(std::move(left_out)) {
    if (!reading_.scratch.empty()) store_.emplace(reading_.scratch);
  }

  void add(std::optional<std::int64_t> stamp_ns, Cloud cloud, std::string where);

  LeftOut& left_out() { return left_out_; }

  /// Returns the sweeps. If the device description has no sweep period, the period is the median step of the stamps or
  /// the largest point offset, whichever is larger.
  BuiltSweeps finish(const std::string& where, std::vector<std::string>& notes);

 private:
  struct Waiting {
    std::optional<std::int64_t> stamp_ns;
    Cloud cloud;
    std::string where;
  };
  void find_rule();
  bool has_other_clock() const;
  void take(Waiting& sweep);
  void read(Waiting& sweep);
  std::vector<std::int64_t> point_times(const Waiting& sweep, std::vector<std::size_t>& kept);
  std::int64_t start_of(const Waiting& sweep, std::vector<std::int64_t>& times_ns) const;
  bool is_far(const Waiting& sweep, const std::vector<std::size_t>& kept);
  void take_points(const Waiting& sweep, const std::vector<std::size_t>& kept);
  void scale_intensity(std::vector<std::string>& notes);
  std::int64_t longest_sweep_ns() const;  ///< also limits stamp to point time
  double range_max_m() const;
  void require_range(const std::string& where) const;
  void note_dropped_points(std::vector<std::string>& notes) const;
  std::size_t points() const { return store_ ? store_->size() : record_.position_L_m.size(); }

  SweepReading reading_;
  std::int64_t period_ns_;
  std::optional<PointTimeRule> rule_;
  std::vector<Waiting> waiting_;
  sim::LidarRecord record_;
  std::optional<PointStore> store_;
  float brightest_ = 0.0f;
  std::int64_t longest_ns_ = 0;
  LeftOut left_out_;
  std::vector<std::string> fields_;  ///< of the first cloud
  bool other_clock_ = false;         ///< point times and stamps differ
  std::vector<std::optional<std::int64_t>> last_point_ns_;
  std::size_t misses_ = 0, dark_ = 0, skipped_ = 0, beyond_ = 0, far_ = 0;  ///< far_: points of far clouds
  std::size_t mistimed_ = 0;                                                ///< outside their sweep
  std::string first_mistimed_;
  std::size_t rises_ = 0, falls_ = 0;           ///< points later and earlier than previous
  std::size_t viewpoints_ = 0;                  ///< sweeps with a viewpoint
  std::string first_viewpoint_;                 ///< with its file
  std::map<std::string, std::size_t> ignored_;  ///< ignored columns and their sweeps
};

}  // namespace tumble::scenarios
