// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/turning_sense.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "scenarios/recordings/upper_median.hpp"
#include "tumble/common/so3.hpp"
#include "tumble/common/time.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kTurnShortest_ns = 50'000'000, kTurnLongest_ns = 500'000'000;
constexpr std::int64_t kReadingHole_ns = 100'000'000;
constexpr double kLeast_rad = 0.02, kMost_rad = 2.5;
constexpr std::size_t kTurnPairsMin = 6;
constexpr double kTurnsOtherwise = 0.5, kTurnsAsSaid = 0.15;
constexpr std::uint8_t kGyroClipped = 0b111;

struct TimedAttitude {
  std::int64_t time_ns;
  Eigen::Quaterniond q;
};

/// Two attitudes and the turn between them that the gyro measured, IMU axes.
struct TurnPair {
  Eigen::Quaterniond before, after;
  Eigen::Quaterniond said;
  double angle_rad;
};

/// What a file may mean by its quaternions.
enum class Written { as_stated, w_first, inverse };

std::vector<TimedAttitude> attitudes_of(const Estimate& estimate) {
  std::vector<TimedAttitude> out;
  for (const AttitudeState& each : estimate.attitudes) out.push_back({each.time_ns, each.q_WA});
  if (out.empty()) {
    for (const PoseState& each : estimate.poses) out.push_back({each.time_ns, each.q_WA});
  }
  return out;
}

/// None beyond the readings, across a hole, or where a reading is at its rail.
std::optional<Eigen::Quaterniond> measured_turn(const sim::ImuRecord& imu, std::int64_t from_ns, std::int64_t to_ns) {
  const std::vector<std::int64_t>& ends = imu.time_ns;
  auto at = static_cast<std::size_t>(std::ranges::upper_bound(ends, from_ns) - ends.begin());
  if (at == 0 || ends.empty() || ends.back() < to_ns) return std::nullopt;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  for (; at < ends.size() && ends[at - 1] < to_ns; ++at) {
    if (ends[at] - ends[at - 1] > kReadingHole_ns || (imu.clip_flags[at] & kGyroClipped) != 0) return std::nullopt;
    const std::int64_t length_ns = std::min(ends[at], to_ns) - std::max(ends[at - 1], from_ns);
    turn = turn * so3::exp(seconds(length_ns) * imu.gyro_rad_s[at]);
  }
  return turn;
}

std::vector<TurnPair> pairs_of(const std::vector<TimedAttitude>& attitudes, const sim::ImuRecord& imu) {
  std::vector<TurnPair> out;
  std::size_t first = 0;
  for (std::size_t k = 1; k < attitudes.size(); ++k) {
    const std::int64_t length_ns = attitudes[k].time_ns - attitudes[first].time_ns;
    if (length_ns < kTurnShortest_ns) continue;
    const TimedAttitude& before = attitudes[first];
    first = k;
    if (length_ns > kTurnLongest_ns) continue;
    const auto said = measured_turn(imu, before.time_ns, attitudes[k].time_ns);
    if (!said) continue;
    const double angle_rad = so3::log(*said).norm();
    if (angle_rad < kLeast_rad || angle_rad > kMost_rad) continue;
    out.push_back({before.q, attitudes[k].q, *said, angle_rad});
  }
  return out;
}

Eigen::Quaterniond as_meant(const Eigen::Quaterniond& read, Written written) {
  if (written == Written::inverse) return read.conjugate();
  return written == Written::w_first ? Eigen::Quaterniond(read.x(), read.y(), read.z(), read.w()) : read;
}

/// IMU coordinates to those of the frame; none where the recording has no such sensor.
std::optional<Eigen::Quaterniond> q_AI(Frame frame, const sim::Sensors& sensors) {
  const Eigen::Quaterniond q_BI(sensors.imus.front().T_BI.linear());
  if (frame == Frame::imu) return Eigen::Quaterniond::Identity();
  if (frame != Frame::lidar) return q_BI;
  if (sensors.lidars.empty()) return std::nullopt;
  return Eigen::Quaterniond(sensors.lidars.front().T_BL.linear()).conjugate() * q_BI;
}

/// Median difference as a share of the median rotation.
double difference(const std::vector<TurnPair>& pairs, Written written, const Eigen::Quaterniond& q_AI) {
  std::vector<double> differences, angles;
  for (const TurnPair& pair : pairs) {
    const Eigen::Quaterniond seen = as_meant(pair.before, written).conjugate() * as_meant(pair.after, written);
    differences.push_back(so3::log((q_AI.conjugate() * seen * q_AI).conjugate() * pair.said).norm());
    angles.push_back(pair.angle_rad);
  }
  return upper_median(std::move(differences)) / upper_median(std::move(angles));
}

std::string text_of(Written written, Frame frame, Frame stated) {
  std::string out;
  if (written == Written::w_first) out = "the quaternions had w first (expected order: x y z w)";
  if (written == Written::inverse)
    out = "the quaternions described the world in sensor axes (expected: the sensor in world axes)";
  if (frame == stated) return out;
  return out + (out.empty() ? "the poses" : " and the poses") + " belonged to the frame " + to_string(frame);
}

}  // namespace

std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors) {
  if (sensors.imus.empty()) return "";
  const std::vector<TurnPair> pairs = pairs_of(attitudes_of(estimate), sensors.imus.front());
  if (pairs.size() < kTurnPairsMin) return "";
  const auto stated = q_AI(estimate.frame, sensors);
  if (!stated) return "";
  const double off = difference(pairs, Written::as_stated, *stated);
  if (!(off > kTurnsOtherwise)) return "";
  double least = kTurnsAsSaid;
  std::string found;
  // the frame as stated first, which wins where two are mounted alike
  for (const Frame frame : {estimate.frame, Frame::imu, Frame::lidar, Frame::body}) {
    const auto mounting = q_AI(frame, sensors);
    if (!mounting) continue;
    for (const Written written : {Written::as_stated, Written::w_first, Written::inverse}) {
      const double share = difference(pairs, written, *mounting);
      if (share >= least) continue;
      least = share;
      found = text_of(written, frame, estimate.frame);
    }
  }
  if (found.empty()) return "";
  return fmt::format(
      "the attitudes in frame {} do not rotate as the gyro does (difference {:.0f} % over {} pairs), but would "
      "(difference {:.0f} %) if {}",
      to_string(estimate.frame), 100.0 * off, pairs.size(), 100.0 * least, found);
}

}  // namespace tumble::scenarios
