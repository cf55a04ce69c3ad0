// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/trajectories/reference_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/trajectories/turning.hpp"

namespace tumble::scenarios {

namespace {

/// The rotations of reference and gyro contradict each other if their relative difference exceeds 50 %, and agree if
/// the relative difference is below 30 %.
constexpr double kContradicts = 0.5, kReferenceAgrees = 0.3;
/// A wrong quaternion convention is reported only if reference and gyro differ by more than 15 % of the rotation. With
/// the correct quaternion convention, the rotation difference must be less than 40 % of the difference with the stated
/// convention.
constexpr double kExplained = 0.15, kExplanationLeaves = 0.4;
/// A delay below kDelayNoted_s causes no note, because the filters of an IMU cause a delay of about 0.02 s.
constexpr double kDelayNoted_s = 0.03;

std::vector<CandidateFrame> candidate_frames(const Eigen::Isometry3d& T_BA, const sim::Sensors& sensors) {
  const Eigen::Quaterniond q_BI(sensors.imus.front().T_BI.linear());
  std::vector<CandidateFrame> out = {{"as stated", Eigen::Quaterniond(T_BA.linear()).conjugate() * q_BI},
                                     {"body", q_BI}};
  if (!sensors.lidars.empty())
    out.push_back({"lidar", Eigen::Quaterniond(sensors.lidars.front().T_BL.linear()).conjugate() * q_BI});
  out.push_back({"IMU", Eigen::Quaterniond::Identity()});
  return out;
}

std::string share_text(double share) {
  return fmt::format("{:.0f} %", 100.0 * share);
}

std::string remedy(QuaternionConvention written, double delay_s) {
  std::string out;
  if (written == QuaternionConvention::w_first || written == QuaternionConvention::w_first_inverse)
    out += ". The quaternions of the reference have w first, but the order must be qx qy qz qw; move the column of w";
  if (written == QuaternionConvention::inverse || written == QuaternionConvention::w_first_inverse)
    out +=
        ". The poses of the reference describe the world in sensor axes, but must describe the sensor in world axes; "
        "invert the poses";
  return is_delayed(delay_s) ? out + "; " + delay_remedy(delay_s) : out;
}

std::string disagreement(const TurningCheck& check, const std::string& imu) {
  return fmt::format(
      "the rotations of the reference differ from the rotations of the gyro of '{}' by {} (median of {} pairs of "
      "poses)",
      imu, share_text(check.stated.difference), check.pairs);
}

std::string caution(const TurningCheck& check, const std::string& frame, const std::string& imu) {
  const std::string text = "caution: " + disagreement(check, imu) +
                           fmt::format("; these rotations should differ by at most {}; ", share_text(kContradicts));
  const TurningFit& reading = check.reading.undelayed;
  if (reading.difference < kReferenceAgrees && reading.written == QuaternionConvention::as_stated) {
    return text + fmt::format(
                      "the rotations of reference and gyro would differ by only {} if the poses belonged to the {}{}",
                      share_text(reading.difference), frame, frame == "IMU" ? "" : ": give --reference-frame " + frame);
  }
  const MountingFit& mounting = check.mounting.undelayed;
  if (mounting.difference < kReferenceAgrees) {
    const Eigen::Quaterniond& q = mounting.q_AI;
    return text + fmt::format(
                      "the rotations of reference and gyro would differ by only {} if the IMU's orientation in the "
                      "frame of the poses were x y z w {:.4f} {:.4f} {:.4f} {:.4f}; check the mounting",
                      share_text(mounting.difference), q.x(), q.y(), q.z(), q.w());
  }
  return text + fmt::format(
                    "the program tested other quaternion conventions, other frames and delays up to {:.0f} s, and none "
                    "explains this difference. The reference may belong to another recording",
                    kDelaySearched_s);
}

std::string agreement(const TurningCheck& check, const std::string& imu) {
  const TurningFit& likely = check.reading.likely();
  const TurningFit& fit = likely.written == QuaternionConvention::as_stated ? likely : check.stated;
  const std::string text =
      fmt::format("the reference agrees with the gyro of '{}': rotations differ by {} (median of {} pairs of poses)",
                  imu, share_text(fit.difference), check.pairs);
  if (std::abs(fit.delay_s) >= kDelayNoted_s)
    return fmt::format("caution: the time stamps of the reference are {}. Without this delay, {}",
                       delay_text(fit.delay_s), text);
  return text +
         (check.clock_known ? "" : "; this motion does not reveal whether the clock of the reference has a delay") +
         (check.order_known ? "" : "; this motion does not reveal whether the quaternions have w first");
}

bool fits_as_stated(const TurningCheck& check) {
  const TurningFit& fit = check.reading.likely();
  return fit.written == QuaternionConvention::as_stated && fit.frame == 0 && fit.difference < kReferenceAgrees;
}

[[noreturn]] void refuse(const TurningCheck& check, const std::string& imu, const std::string& where, double corrected,
                         const std::string& remedies) {
  throw BadInput(
      where + ": " + disagreement(check, imu) +
      fmt::format(". With the following correction, the rotations of reference and gyro would differ by only {}",
                  share_text(corrected)) +
      remedies);
}

void require_reading_as_stated(const TurningCheck& check, const std::string& imu, const std::string& where) {
  const TurningFit& fit = check.reading.likely();
  if (fit.difference >= kReferenceAgrees) return;
  const bool rewritten = fit.written != QuaternionConvention::as_stated && check.stated.difference > kExplained &&
                         fit.difference < kExplanationLeaves * check.stated.difference;
  if (rewritten || is_delayed(fit.delay_s))
    refuse(check, imu, where, fit.difference,
           remedy(rewritten ? fit.written : QuaternionConvention::as_stated, fit.delay_s));
}

void require_clock(const TurningCheck& check, const std::string& imu, const std::string& where) {
  const MountingFit& fit = check.mounting.likely();
  if (fit.difference < kReferenceAgrees && is_delayed(fit.delay_s))
    refuse(check, imu, where, fit.difference, remedy(QuaternionConvention::as_stated, fit.delay_s));
}

}  // namespace

std::string check_reference(const std::vector<ReferencePose>& poses, const Eigen::Isometry3d& T_BA,
                            const sim::Sensors& sensors, const std::string& where) {
  if (sensors.imus.empty()) return "the reference is not checked against a gyro: the recording has no IMU";
  const sim::ImuRecord& imu = sensors.imus.front();
  std::vector<TimedAttitude> attitudes;
  for (const ReferencePose& pose : poses) attitudes.push_back({pose.time_ns, pose.q_WA});
  const std::vector<CandidateFrame> frames = candidate_frames(T_BA, sensors);
  const TurningCheck check = check_turning(attitudes, frames, imu, kDelaySearched_s);
  if (check.pairs == 0)
    return fmt::format(
        "the reference is not checked against the gyro of '{}': there are too few pairs of poses, 0.05 to 1 s apart, "
        "with a rotation of at least 0.02 rad and without saturation",
        imu.name);
  if (check.upright) {
    throw BadInput(
        fmt::format("{}: the mean specific force of '{}' should point up, but differs from the vertical of the "
                    "reference by more than 60 degrees. The rotations of the reference agree with the gyro, but "
                    "another quaternion convention agrees equally well{}",
                    where, imu.name, remedy(check.upright->written, 0.0)));
  }
  require_reading_as_stated(check, imu.name, where);
  if (check.stated.difference > kContradicts && check.reading.likely().difference >= kReferenceAgrees)
    require_clock(check, imu.name, where);
  if (check.stated.difference > kContradicts && !fits_as_stated(check))
    return caution(check, frames[check.reading.undelayed.frame].name, imu.name);
  return agreement(check, imu.name);
}

}  // namespace tumble::scenarios
