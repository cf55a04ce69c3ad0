// SPDX-License-Identifier: BSD-3-Clause
#include "further_lidars.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"
#include "tumble/mapping/detail/sweep_check.hpp"

namespace tumble {

namespace {

// offset between the ring numbers of two lidars; LoneReturns compares returns within one ring, so rings of two lidars
// must have different numbers
constexpr std::uint16_t kRingsPerLidar = 4096;
constexpr double kOffsetMax_s = 1.0;

bool is_return(const FurtherLidar& lidar, const LidarPoint& point) {
  const double range_m = point.position_L_m.cast<double>().norm();
  return range_m >= lidar.data_sheet.range_min_m && range_m <= lidar.data_sheet.range_max_m &&
         !lidar.own_body_L.contains(point.position_L_m.cast<double>());
}

}  // namespace

FurtherLidars::FurtherLidars(std::span<const FurtherLidar> lidars, const Eigen::Isometry3d& T_IL_first)
    : lidars_(lidars.begin(), lidars.end()), T_first_lidar_imu_(T_IL_first.inverse()) {
  for (const FurtherLidar& lidar : lidars_) {
    OdometryParams checked;
    checked.T_IL = lidar.T_IL;
    checked.range_min_m = lidar.data_sheet.range_min_m;
    checked.range_max_m = lidar.data_sheet.range_max_m;
    checked.own_body_L = lidar.own_body_L;
    if (const Status status = check_odometry_params(checked); !status.ok())
      throw InvalidParams("further_lidars: " + status.message(), status.value, "valid as for the first lidar");
    if (!(std::abs(lidar.first_minus_this_clock_s) <= kOffsetMax_s))
      throw InvalidParams("further_lidars.first_minus_this_clock_s", lidar.first_minus_this_clock_s, "-1 to 1");
  }
}

Status FurtherLidars::add(std::size_t lidar, TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points,
                          TimeNs latest_ns, std::size_t most) {
  if (lidar > lidars_.size()) return {ErrorCode::out_of_range, "lidar", double(lidar), double(lidars_.size())};
  const FurtherLidar& from = lidars_[lidar - 1];
  if (end_ns < start_ns) return {ErrorCode::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (const Status status = check_stamp(start_ns, "start_ns"); !status.ok()) return status;
  if (const Status status = check_stamp(end_ns, "end_ns"); !status.ok()) return status;
  if (const Status status = mapping::check_time_offsets(end_ns - start_ns, points); !status.ok()) return status;
  const TimeNs offset_ns = std::llround(1e9 * from.first_minus_this_clock_s);
  if (end_ns + offset_ns > latest_ns)
    return {ErrorCode::out_of_range, "end_ns", double(end_ns + offset_ns), double(latest_ns)};
  const Eigen::Isometry3f T_first = (T_first_lidar_imu_ * from.T_IL).cast<float>();
  WaitingSweep sweep{start_ns + offset_ns, end_ns + offset_ns, {}};
  for (LidarPoint point : points) {
    if (!is_return(from, point)) continue;
    point.position_L_m = T_first * point.position_L_m;
    if (point.ring < kRingsPerLidar) point.ring = static_cast<std::uint16_t>(point.ring + lidar * kRingsPerLidar);
    sweep.points.push_back(point);
  }
  if (waiting_sweeps_.size() >= most) waiting_sweeps_.pop_front();
  waiting_sweeps_.push_back(std::move(sweep));
  return {};
}

void FurtherLidars::merge_into(WaitingSweep& sweep) {
  for (WaitingSweep& from : waiting_sweeps_) {
    if (from.start_ns > sweep.end_ns) continue;
    std::erase_if(from.points, [&](LidarPoint point) {
      const TimeNs time_ns = from.start_ns + point.offset_ns;
      if (time_ns > sweep.end_ns) return false;
      if (time_ns < sweep.start_ns) return true;
      point.offset_ns = static_cast<std::uint32_t>(time_ns - sweep.start_ns);
      sweep.points.push_back(point);
      return true;
    });
  }
  std::erase_if(waiting_sweeps_, [](const WaitingSweep& from) { return from.points.empty(); });
}

}  // namespace tumble
