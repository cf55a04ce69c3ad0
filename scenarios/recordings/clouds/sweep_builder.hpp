// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/clouds/cloud_file.hpp"
#include "scenarios/recordings/point_store.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// How the points of a sweep are to be read, where the file does not say.
struct SweepReading {
  sim::LidarRecord device;   ///< name, device, T_BL; sweep_period_ns, 0: the median step of the sweeps' starts
  std::string time_field;    ///< "": the one that is called as one of them usually is
  std::string time_unit;     ///< s ms us ns; "": told by the field's name ("offset_ns") or its size
  bool not_skewed = false;   ///< the points were deskewed, or fired at once: their times mean nothing
  double range_max_m = 0.0;  ///< by the data sheet; 0: not known
  bool assumed = false;      ///< the stamps are a guess: absolute times of points replace them
  /// Where the points are set aside as they come; "": they stay in the record, which then takes memory with each sweep.
  std::filesystem::path scratch;
};

/// Unit and name of the points' times in a sequence of clouds.
struct PointTimeRule {
  std::string field;      ///< "": the points have no times of their own
  double unit_ns = 1.0;   ///< of the field's numbers
  bool absolute = false;  ///< they count from the clock's zero, not from the stamp of the sweep
};

/// Finds the field of the times and its unit from the first clouds. Names, whatever their case: t time timestamp
/// timestamps time_stamp offset_time time_offset offset_ns; a name that ends in _s _ms _us _ns tells the unit. Else the
/// unit is the one in which the times of a sweep (median over the clouds) span 2 to 150 % of `period_ns`; where that is
/// not known (0), stamps since the epoch tell it by their size. A stated unit that does not fit so, where another does
/// and the sweeps hold 100 points or more, is refused with both. Times that begin more than two periods from 0 in any
/// of the clouds are absolute. Of two fields the one whose name tells its unit is taken. Throws BadInput beginning with
/// `where`: a field that is not there, two of them, no unit that fits.
PointTimeRule find_point_times(const std::vector<Cloud>& first, std::int64_t period_ns, const SweepReading& reading,
                               const std::string& where);

/// A lidar, and its points where they were set aside: then the record has none.
struct BuiltSweeps {
  sim::LidarRecord lidar;
  std::optional<PointStore> points;
  std::vector<std::int64_t> last_point_ns = {};  ///< of each sweep, in the clock of the stamps; its start without times
};

/// Makes the record of a lidar from clouds in the order of time. In memory are the first ten clouds, then one at a time
/// where the points are set aside.
///
/// A point that is not finite, farther than 1000 km or at the origin is a miss. Intensity ("intensity", "reflectivity")
/// up to 1 stays as it is; up to 255 it is divided by that, else by the largest. Ring ("ring", "line", "channel") is a
/// whole number up to 65535. A sweep starts at its stamp, or, where its first point is earlier or a period later, at
/// that point; so that no offset is negative. No column is needed but x, y and z.
class SweepBuilder {
 public:
  /// `period_ns` is what find_point_times is given: of the device, or the median step of the stamps.
  SweepBuilder(SweepReading reading, std::int64_t period_ns) : reading_(std::move(reading)), period_ns_(period_ns) {
    if (!reading_.scratch.empty()) store_.emplace(reading_.scratch);
  }

  /// One sweep; `where` begins the messages. Throws BadInput: no x, y or z, a stamp that does not rise, a time outside
  /// two sweep periods, a ring that is none.
  void add(std::optional<std::int64_t> stamp_ns, Cloud cloud, std::string where);

  /// The record, in the clock of the stamps, and remarks for the user: how the times of points were read among them. A
  /// period that is not given is the median step, or the latest offset where that is more. Throws BadInput beginning
  /// with `where`: no point in any sweep, most of them beyond twice the range of the data sheet, a single sweep of
  /// unknown length.
  BuiltSweeps finish(const std::string& where, std::vector<std::string>& notes);

 private:
  struct Waiting {
    std::optional<std::int64_t> stamp_ns;
    Cloud cloud;
    std::string where;
  };
  void find_rule();  ///< the rule of the times, from the clouds that wait; then these are taken
  void take(Waiting& sweep);
  std::int64_t take_times(const Waiting& sweep, const std::vector<std::size_t>& kept);
  void take_points(const Waiting& sweep, const std::vector<std::size_t>& kept);
  void take_rings(const Waiting& sweep, const std::vector<std::size_t>& kept);
  void scale_intensity(std::vector<std::string>& notes);
  double range_max_m() const;
  void require_range(const std::string& where) const;
  void note_what_was_left(std::vector<std::string>& notes) const;
  std::size_t points() const { return store_ ? store_->size() : record_.position_L_m.size(); }

  SweepReading reading_;
  std::int64_t period_ns_;
  std::optional<PointTimeRule> rule_;
  std::vector<Waiting> waiting_;
  sim::LidarRecord record_;
  std::optional<PointStore> store_;
  float brightest_ = 0.0f;
  std::int64_t longest_ns_ = 0;  ///< offset of a point
  std::vector<std::int64_t> last_point_ns_;
  std::size_t misses_ = 0, dark_ = 0, skipped_ = 0, beyond_ = 0;
  std::size_t viewpoints_ = 0;                  ///< sweeps that state one
  std::string first_viewpoint_;                 ///< with its file
  std::map<std::string, std::size_t> ignored_;  ///< columns that mean nothing here, and in how many sweeps they were
};

}  // namespace tumble::scenarios
