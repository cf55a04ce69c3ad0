// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/external/turning_sense.hpp"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "scenarios/recordings/trajectories/turning.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kTurnsOtherwise = 0.5, kTurnsAsSaid = 0.15;
/// Largest accepted difference between the rotations of estimate and gyro after the correction of a delay, as a
/// fraction of the gyro rotation.
constexpr double kTurnsOnceCorrected = 0.3;

std::vector<TimedAttitude> attitudes_of(const Estimate& estimate) {
  std::vector<TimedAttitude> out;
  for (const AttitudeState& each : estimate.attitudes) out.push_back({each.time_ns, each.orientation_W});
  if (out.empty()) {
    for (const PoseState& each : estimate.poses) out.push_back({each.time_ns, each.orientation_W});
  }
  return out;
}

std::optional<Eigen::Quaterniond> q_AI(Frame frame, const sim::Sensors& sensors) {
  const Eigen::Quaterniond q_BI(sensors.imus.front().T_BI.linear());
  if (frame == Frame::imu) return Eigen::Quaterniond::Identity();
  if (frame != Frame::lidar) return q_BI;
  if (sensors.lidars.empty()) return std::nullopt;
  return Eigen::Quaterniond(sensors.lidars.front().T_BL.linear()).conjugate() * q_BI;
}

std::string text_of(const TurningFit& fit, const std::string& frame) {
  std::string out;
  if (fit.written == QuaternionConvention::w_first)
    out = "the quaternions were stored with w first (expected order: x y z w)";
  if (fit.written == QuaternionConvention::w_first_inverse)
    out =
        "the quaternions were stored with w first and described the world in sensor axes (expected: x y z w, the "
        "sensor in world axes)";
  if (fit.written == QuaternionConvention::inverse)
    out = "the quaternions described the world in sensor axes (expected: the sensor in world axes)";
  if (fit.frame == 0) return out;
  return out + (out.empty() ? "the poses" : " and the poses") + " belonged to the frame " + frame;
}

/// Returns the frames to which the poses may belong, each with its mounting on the body. The first frame is the stated
/// frame of the estimate, followed by the frames of IMU, lidar and body. The result is empty if the mounting of the
/// stated frame is unknown.
std::vector<CandidateFrame> candidates(const Estimate& estimate, const sim::Sensors& sensors) {
  std::vector<CandidateFrame> frames;
  if (sensors.imus.empty()) return frames;
  for (const Frame frame : {estimate.frame, Frame::imu, Frame::lidar, Frame::body}) {
    const auto mounting = q_AI(frame, sensors);
    if (mounting) frames.push_back({to_string(frame), *mounting});
    if (frames.empty()) break;
  }
  return frames;
}

}  // namespace

std::string turning_complaint(const Estimate& estimate, const sim::Sensors& sensors) {
  const std::vector<CandidateFrame> frames = candidates(estimate, sensors);
  if (frames.empty()) return "";
  const TurningCheck check = check_turning(attitudes_of(estimate), frames, sensors.imus.front(), 0.0);
  const TurningFit& best = check.reading.undelayed;
  if (check.pairs == 0 || check.stated.difference <= kTurnsOtherwise || best.difference >= kTurnsAsSaid) return "";
  return fmt::format(
      "the rotations of the estimated attitudes (frame {}) differ from the rotations of the gyro by {:.0f} % ({} pairs "
      "of poses). The difference would be only {:.0f} % if {}",
      to_string(estimate.frame), 100.0 * check.stated.difference, check.pairs, 100.0 * best.difference,
      text_of(best, frames[best.frame].name));
}

std::string clock_complaint(const Estimate& estimate, const sim::Sensors& sensors) {
  const std::vector<CandidateFrame> frames = candidates(estimate, sensors);
  if (frames.empty()) return "";
  const TurningCheck check = check_turning(attitudes_of(estimate), frames, sensors.imus.front(), kDelaySearched_s);
  const TurningFit& likely = check.reading.likely();
  if (check.pairs == 0 || likely.written != QuaternionConvention::as_stated ||
      likely.difference >= kTurnsOnceCorrected || !is_delayed(likely.delay_s))
    return "";
  return fmt::format(
      "the rotations of the estimated attitudes differ from the rotations of the gyro by {:.0f} % ({} pairs of poses). "
      "Corrected time stamps would reduce the difference to {:.0f} %: {}",
      100.0 * check.stated.difference, check.pairs, 100.0 * likely.difference, delay_remedy(likely.delay_s));
}

}  // namespace tumble::scenarios
