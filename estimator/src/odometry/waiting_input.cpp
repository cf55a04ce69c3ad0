// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/waiting_input.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "../common/dense.hpp"
#include "position_alignment.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/deskew.hpp"
#include "tumble/mapping/detail/odometry_params.hpp"

namespace tumble {

namespace {

TimeNs middle_ns(const OdometerReading& reading) {
  const TimeNs from_ns = reading_start_ns(reading);
  return from_ns + (reading_end_ns(reading) - from_ns) / 2;
}

// offset between the ring numbers of two lidars; LoneReturns compares returns within one ring, so rings of two lidars
// must have different numbers
constexpr std::uint16_t kRingsPerLidar = 4096;
constexpr double kOffsetMax_s = 1.0;

bool is_return(const FurtherLidar& lidar, const LidarPoint& point) {
  const double range_m = point.position_L_m.cast<double>().norm();
  return range_m >= lidar.data_sheet.range_min_m && range_m <= lidar.data_sheet.range_max_m &&
         !lidar.own_body_L.contains(point.position_L_m.cast<double>());
}

constexpr double kGate = 16.27;  // 99.9 % quantile of chi-square with three degrees of freedom
constexpr std::size_t kPairsMin = 3, kPairsPerOutlier = 5;
constexpr double kHeadingSigma_rad = 0.1;
constexpr double kSpacing = 0.5;  // minimum distance of two stored positions, in standard deviations of a reading
constexpr double kDrift = 0.01;   // minimum assumed drift of the poses, as a fraction of the path

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

PoseState pose_at(const std::vector<PoseState>& trajectory, TimeNs time_ns) {
  const auto next = std::find_if(trajectory.begin(), trajectory.end() - 1,
                                 [&](const PoseState& pose) { return pose.time_ns >= time_ns; });
  PoseState out = *next;
  if (next == trajectory.begin()) return out;
  const PoseState& before = *(next - 1);
  const double share = seconds(time_ns - before.time_ns) / seconds(next->time_ns - before.time_ns);
  out.position_W_m = before.position_W_m + share * (next->position_W_m - before.position_W_m);
  out.orientation_W = before.orientation_W.slerp(share, next->orientation_W);
  return out;
}

PositionFrame fit_position_frame(const std::deque<PositionAlignment::PositionPair>& pairs) {
  Eigen::Vector3d mean_W_m = Eigen::Vector3d::Zero(), mean_P_m = mean_W_m;
  double weight = 0.0, sine = 0.0, cosine = 0.0, spread = 0.0;
  for (const auto& pair : pairs) {
    weight += 1.0 / pair.variance_m2;
    mean_W_m += pair.antenna_position_W_m / pair.variance_m2;
    mean_P_m += pair.antenna_position_P_m / pair.variance_m2;
  }
  mean_W_m /= weight;
  mean_P_m /= weight;
  for (const auto& pair : pairs) {
    const Eigen::Vector2d a = (pair.antenna_position_W_m - mean_W_m).head<2>(),
                          b = (pair.antenna_position_P_m - mean_P_m).head<2>();
    sine += (a.x() * b.y() - a.y() * b.x()) / pair.variance_m2;
    cosine += a.dot(b) / pair.variance_m2;
    spread += a.squaredNorm() / pair.variance_m2;
  }
  PositionFrame out;
  out.covariance_reference_point_W_m = mean_W_m;
  out.xyz_yaw_covariance_P.diagonal() << Eigen::Vector3d::Constant(1.0 / weight),
      spread > 0.0 ? 1.0 / spread : std::numeric_limits<double>::max();
  out.T_PW.linear() = so3::exp(std::atan2(sine, cosine) * kUp).toRotationMatrix();
  out.T_PW.translation() = mean_P_m - out.T_PW.linear() * mean_W_m;
  return out;
}

}  // namespace

Status WaitingReadings::add(const OdometerReading& reading, TimeNs done_ns, TimeNs latest_ns, std::size_t most) {
  if (const Status status = check_odometer_reading(reading); !status.ok()) return status;
  const bool motion = std::holds_alternative<RelativePoseReading>(reading);
  const char* const first = motion ? "from_ns" : "time_ns";
  const char* const last = motion ? "to_ns" : "time_ns";
  const TimeNs from_ns = reading_start_ns(reading), to_ns = reading_end_ns(reading),
               earliest_ns = done_ns - kExtrapolation_ns;
  if (from_ns < earliest_ns) return {ErrorCode::time_order, first, double(from_ns), double(earliest_ns)};
  if (to_ns > latest_ns) return {ErrorCode::out_of_range, last, double(to_ns), double(latest_ns)};
  const TimeNs middle = middle_ns(reading);
  if (middle <= done_ns) return {ErrorCode::time_order, last, double(to_ns), double(done_ns)};
  if (waiting_readings_.size() >= most)
    return {ErrorCode::out_of_range, "readings waiting", double(waiting_readings_.size() + 1), double(most)};
  const auto later = [](TimeNs time_ns, const OdometerReading& other) { return time_ns < middle_ns(other); };
  waiting_readings_.insert(std::upper_bound(waiting_readings_.begin(), waiting_readings_.end(), middle, later),
                           reading);
  return {};
}

std::optional<OdometerReading> WaitingReadings::find(TimeNs from_ns, TimeNs end_ns) const {
  const auto later = [](TimeNs time_ns, const OdometerReading& other) { return time_ns < middle_ns(other); };
  auto next = std::upper_bound(waiting_readings_.begin(), waiting_readings_.end(), end_ns, later);
  while (next != waiting_readings_.begin() && middle_ns(*--next) > from_ns - kExtrapolation_ns) {
    if (reading_start_ns(*next) >= from_ns - kExtrapolation_ns && reading_end_ns(*next) <= end_ns + kExtrapolation_ns)
      return *next;
  }
  return std::nullopt;
}

std::optional<OdometerReading> WaitingReadings::take_readings_in(TimeNs from_ns, TimeNs end_ns) {
  std::optional<OdometerReading> out;
  for (; !waiting_readings_.empty() && middle_ns(waiting_readings_.front()) <= end_ns; waiting_readings_.pop_front()) {
    const OdometerReading& reading = waiting_readings_.front();
    if (reading_start_ns(reading) >= from_ns - kExtrapolation_ns &&
        reading_end_ns(reading) <= end_ns + kExtrapolation_ns)
      out = reading;
  }
  return out;
}

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

Status PositionAlignment::add(const PositionReading& reading, TimeNs done_ns, TimeNs latest_ns, std::size_t most) {
  const Eigen::Matrix3d& covariance = reading.covariance_m2;
  if (!reading.antenna_position_P_m.allFinite() || !covariance.allFinite() ||
      !reading.antenna_lever_arm_I_m.allFinite())
    return {ErrorCode::non_finite, "position", std::numeric_limits<double>::quiet_NaN(), 0.0};
  const double least = covariance.diagonal().minCoeff();
  if (!(least > 0.0) || !covariance.isApprox(covariance.transpose(), 1e-6) || !dense::Cholesky(covariance).ok())
    return {ErrorCode::out_of_range, "covariance of the position", least, 0.0};
  const TimeNs time_ns = reading.time_ns;
  if (time_ns <= done_ns) return {ErrorCode::time_order, "time_ns", double(time_ns), double(done_ns)};
  if (time_ns > latest_ns) return {ErrorCode::out_of_range, "time_ns", double(time_ns), double(latest_ns)};
  if (waiting_readings_.size() >= most)
    return {ErrorCode::out_of_range, "positions waiting", double(waiting_readings_.size() + 1), double(most)};
  const auto later = [](TimeNs at_ns, const PositionReading& other) { return at_ns < other.time_ns; };
  waiting_readings_.insert(std::upper_bound(waiting_readings_.begin(), waiting_readings_.end(), time_ns, later),
                           reading);
  return {};
}

void PositionAlignment::add_sweep(const SweepResult& report) {
  if (report.trajectory.empty()) return;
  if (report.in_prior_map != in_prior_map_) restart_fit();
  in_prior_map_ = report.in_prior_map;
  path_m_ += (report.pose.position_W_m - last_position_W_m_).norm();
  last_position_W_m_ = report.pose.position_W_m;
  pose_variance_m2_ = report.pose.covariance.topLeftCorner<3, 3>().trace();
  bool any = false;
  for (; !waiting_readings_.empty() && waiting_readings_.front().time_ns <= report.pose.time_ns;
       waiting_readings_.pop_front()) {
    if (waiting_readings_.front().time_ns < report.trajectory.front().time_ns) continue;
    add_position_pair(waiting_readings_.front(), pose_at(report.trajectory, waiting_readings_.front().time_ns));
    any = true;
  }
  if (any) fit();
}

void PositionAlignment::restart_fit() {
  position_pairs_.clear();
  position_frame_.reset();
}

/// If the robot has hardly moved since the last position reading, the last and the new position reading are averaged.
void PositionAlignment::add_position_pair(const PositionReading& reading, const PoseState& pose) {
  const double variance_m2 = reading.covariance_m2.trace() / 3.0;
  const PositionPair pair{pose.position_W_m + pose.orientation_W * reading.antenna_lever_arm_I_m,
                          reading.antenna_position_P_m, variance_m2, path_m_, pose_variance_m2_};
  if (position_pairs_.empty() || (pair.antenna_position_W_m - position_pairs_.back().antenna_position_W_m).norm() >
                                     kSpacing * std::sqrt(variance_m2)) {
    if (position_pairs_.size() >= kMaxPositionPairs) position_pairs_.pop_front();
    position_pairs_.push_back(pair);
    return;
  }
  PositionPair& last = position_pairs_.back();
  const double share = last.variance_m2 / (last.variance_m2 + variance_m2);
  last.antenna_position_W_m += share * (pair.antenna_position_W_m - last.antenna_position_W_m);
  last.antenna_position_P_m += share * (pair.antenna_position_P_m - last.antenna_position_P_m);
  last.variance_m2 = share * variance_m2;
}

void PositionAlignment::fit() {
  position_frame_.reset();
  std::deque<PositionPair> inliers = position_pairs_;
  for (PositionPair& pair : inliers) {
    const double drift_m = kDrift * (path_m_ - pair.path_m);
    pair.variance_m2 += drift_m * drift_m + std::max(0.0, pose_variance_m2_ - pair.pose_variance_m2);
  }
  const std::size_t least = std::max(kPairsMin, position_pairs_.size() - position_pairs_.size() / kPairsPerOutlier);
  while (inliers.size() >= least) {
    const PositionFrame found = fit_position_frame(inliers);
    const auto misfit = [&](const PositionPair& pair) {
      return (found.T_PW * pair.antenna_position_W_m - pair.antenna_position_P_m).squaredNorm() / pair.variance_m2;
    };
    const auto worst =
        std::max_element(inliers.begin(), inliers.end(),
                         [&](const PositionPair& a, const PositionPair& b) { return misfit(a) < misfit(b); });
    if (misfit(*worst) <= kGate) {
      if (found.xyz_yaw_covariance_P(3, 3) < kHeadingSigma_rad * kHeadingSigma_rad) position_frame_ = found;
      return;
    }
    inliers.erase(worst);
  }
}

}  // namespace tumble
