// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/diagnosis/lidar_rotation.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/repairable.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "tumble/common/types.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kLeastPairs = 12;
/// Largest accepted difference between the rotations that lidar and gyro measure, relative to the median rotation. In
/// correct recordings, both rotations differ by about 0.1 of the median rotation.
constexpr double kAgrees = 0.3;
/// An alternative to the stated IMU axes counts as better only if its rotation error is below kConclusive times the
/// rotation error of the stated axes. A delay between lidar and gyro counts only if the rotation error with the delay
/// is below kDelayConclusive times the rotation error without delay.
constexpr double kConclusive = 0.5, kDelayConclusive = 0.6;
constexpr double kDegreesOfRadian = 57.29577951308232;
constexpr double kDelayMost_s = 0.5, kDelayStep_s = 0.01, kDelaySaid_s = 0.03;
constexpr std::int64_t kGap_ns = 100'000'000;
constexpr double kInverted = 0.2;
/// Record stamps of a bag (times of recording) vary by some 10 ms. Record stamps therefore replace only header stamps
/// with errors above 0.1 s.
constexpr double kRecordsBetter_s = 0.1;

class Integral {
 public:
  explicit Integral(const sim::ImuRecord& imu) : imu_(imu) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
      sum += imu.gyro_rad_s[k] * seconds(imu.time_ns[k] - start(k));
      sum_.push_back(sum);
    }
  }

  std::optional<Eigen::Vector3d> between(std::int64_t from_ns, std::int64_t to_ns) const {
    const auto first = sample_at(from_ns), last = sample_at(to_ns);
    if (!first || !last) return std::nullopt;
    for (std::size_t k = *first; k <= *last; ++k) {
      if (imu_.time_ns[k] - start(k) > kGap_ns) return std::nullopt;
    }
    return Eigen::Vector3d(until(*last, to_ns) - until(*first, from_ns));
  }

 private:
  std::int64_t start(std::size_t k) const { return k == 0 ? imu_.time_ns[0] - imu_.period_ns : imu_.time_ns[k - 1]; }
  std::optional<std::size_t> sample_at(std::int64_t time_ns) const {
    const auto at = std::lower_bound(imu_.time_ns.begin(), imu_.time_ns.end(), time_ns);
    if (at == imu_.time_ns.end() || time_ns < start(0)) return std::nullopt;
    return static_cast<std::size_t>(at - imu_.time_ns.begin());
  }
  Eigen::Vector3d until(std::size_t k, std::int64_t time_ns) const {
    return sum_[k] - imu_.gyro_rad_s[k] * seconds(imu_.time_ns[k] - time_ns);
  }

  const sim::ImuRecord& imu_;
  std::vector<Eigen::Vector3d> sum_;
};

struct Pairs {
  std::vector<Eigen::Vector3d> lidar, gyro;  ///< rotation vectors between two sweeps [rad]
  double rotation_rad = 0.0;

  template <class Error>
  double share(Error&& error) const {
    std::vector<double> errors;
    for (std::size_t k = 0; k < lidar.size(); ++k) errors.push_back(error(k));
    return upper_median(std::move(errors)) / rotation_rad;
  }
  double share_by(const Eigen::Matrix3d& matrix) const {
    return share([&](std::size_t k) { return (lidar[k] - matrix * gyro[k]).norm(); });
  }
};

Pairs pairs_at(const Integral& integral, const Eigen::Matrix3d& R_IL, std::span<const SeenRotation> seen,
               std::int64_t delay_ns) {
  Pairs out;
  std::vector<double> angles;
  for (const SeenRotation& each : seen) {
    const auto gyro = integral.between(each.from_ns - delay_ns, each.to_ns - delay_ns);
    if (!gyro) continue;
    out.lidar.emplace_back(R_IL * each.rotation_L_rad);
    out.gyro.push_back(*gyro);
    angles.push_back(out.lidar.back().norm());
  }
  if (!angles.empty()) out.rotation_rad = upper_median(std::move(angles));
  return out;
}

/// Solves Wahba's problem (1965) by singular values for an orthogonal matrix with the determinant 1 or -1.
Eigen::Matrix3d best_orthogonal(const Pairs& pairs, double determinant) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < pairs.lidar.size(); ++k) sum += pairs.lidar[k] * pairs.gyro[k].transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double found = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  const Eigen::Vector3d signs(1.0, 1.0, found * determinant < 0.0 ? -1.0 : 1.0);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

void fit_unit(const Pairs& pairs, double delay_s, RotationAgreement& best, double& best_error) {
  RotationAgreement at;
  at.pairs = pairs.lidar.size();
  at.delay_s = delay_s;
  for (const double unit : {1.0, kDegreesOfRadian, 1.0 / kDegreesOfRadian}) {
    const double error =
        pairs.share([&](std::size_t k) { return std::abs(pairs.lidar[k].norm() - unit * pairs.gyro[k].norm()); });
    if (error < at.unit_error) at.unit = unit, at.unit_error = error;
  }
  const double error = std::min(pairs.share_by(at.unit * best_orthogonal(pairs, 1.0)),
                                pairs.share_by(at.unit * best_orthogonal(pairs, -1.0)));
  if (error >= best_error) return;
  best = at;
  best_error = error;
}

void fit_axes(const Pairs& pairs, RotationAgreement& out) {
  out.error_as_read = pairs.share_by(out.unit * Eigen::Matrix3d::Identity());
  std::array<int, 3> axis{0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      const SignedAxes axes{axis, {signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1}};
      const double error = pairs.share_by(out.unit * axes.matrix());
      if (error < out.axes_error) {
        out.next_error = out.axes_error;
        out.axes_error = error;
        out.axes = axes;
      } else {
        out.next_error = std::min(out.next_error, error);
      }
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  out.turned = Eigen::Quaterniond(best_orthogonal(pairs, 1.0));
  out.turned_error = pairs.share_by(out.unit * out.turned.toRotationMatrix());
}

std::string percent(double share) {
  return rounded(100.0 * share) + " %";
}

std::string pairs_text(const RotationAgreement& found) {
  return fmt::format(" over {} sweep pairs", found.pairs);
}

std::string unit_text(const std::string& where, const RotationAgreement& found, GyroUnit unit) {
  const bool degrees = unit == GyroUnit::deg_s;
  const std::string read = fmt::format(
      "if the gyro is read in {}, the ratio of lidar rotation to gyro rotation is {} (accurate to {}){}; this ratio "
      "must be from 0.5 to 2",
      degrees ? "deg/s" : "rad/s", rounded(found.unit), percent(found.unit_error), pairs_text(found));
  if ((found.unit < 1.0) == degrees) return "caution: " + read;
  const std::string fits = degrees ? "rad/s" : "deg/s";
  throw RepairableInput(fmt::format("{}: {}; the rates may be in {} (set '--gyro-unit {}')", where, read, fits, fits),
                        {"--gyro-unit", fits});
}

std::string delay_text(const RotationAgreement& found, double imu_minus_lidar_clock_s) {
  if (std::abs(found.delay_s) < kDelaySaid_s) return "";
  return fmt::format(
      "caution: the lidar measures rotations {}{} than the gyro; check that both sensors use one clock and that sweep "
      "stamps are start times. If the offset is constant, an option corrects it (set '--imu-minus-lidar-clock {}'). "
      "After correction of the time offset: ",
      rounded(std::abs(found.delay_s)), found.delay_s > 0.0 ? " s later" : " s earlier",
      rounded(imu_minus_lidar_clock_s - found.delay_s));
}

/// Throws RepairableInput if lidar and gyro disagree with the header stamps of the messages, but agree with the record
/// stamps of the bag.
void require_common_clock(const std::string& where, const sim::Sensors& sensors,
                          const std::optional<RotationAgreement>& agreement, std::optional<double> record_shift_s) {
  if (!record_shift_s) return;
  const double delay_s = agreement ? agreement->delay_s : -*record_shift_s;
  const double least_s = agreement ? kRecordsBetter_s : kDelayMost_s;
  if (std::abs(delay_s) < least_s || std::abs(delay_s + *record_shift_s) > 0.5 * std::abs(delay_s)) return;
  throw RepairableInput(
      fmt::format("{}: the header stamps of '{}' and '{}' do not agree: the lidar's header stamps are {} s too {}. Two "
                  "clocks, or stamps at the end of the sweep, may be the cause. The record stamps agree (set '--stamps "
                  "record')",
                  where, sensors.lidars.front().name, sensors.imus.front().name, rounded(std::abs(*record_shift_s)),
                  delay_s > 0.0 ? "late" : "early"),
      {"--stamps", "record"});
}

bool is_mirrored(const RotationAgreement& found) {
  return found.axes.matrix().determinant() < 0.0 &&
         (found.turned_error > kAgrees || kConclusive * found.turned_error > found.axes_error);
}

std::string mirrored_text(const RotationAgreement& found) {
  const SignedAxes& axes = found.axes;
  const auto wrong = std::ranges::find(axes.sign, -1);
  const bool one_sign = axes.axis == std::array{0, 1, 2} && std::ranges::count(axes.sign, -1) == 1;
  const std::string which = one_sign
                                ? fmt::format("the sign of the {} axis is wrong", "xyz"[wrong - axes.sign.begin()])
                                : fmt::format("the true axes (x, y, z) are the axes {} of the readings", axes.text());
  return fmt::format(
      "caution: the axes of the IMU are mirrored (left-handed): {}. The rotations of lidar and gyro differ{} by {}, "
      "and with the correct axes by {}. No rotation and no option repairs mirrored axes; correct the IMU's driver",
      which, pairs_text(found), percent(found.error_as_read), percent(found.axes_error));
}

std::string axes_text(const RotationAgreement& found) {
  if (found.error_as_read <= kAgrees && kConclusive * found.error_as_read <= found.axes_error) {
    return fmt::format(
        "the rotations of lidar and gyro agree{} within {}{}", pairs_text(found), percent(found.error_as_read),
        kConclusive * found.next_error > found.axes_error
            ? ": units, signs and axes agree"
            : ": the units agree; this motion does not rotate about all axes, so some axes are not checked");
  }
  if (found.axes_error <= kAgrees && is_mirrored(found)) return mirrored_text(found);
  if (found.axes_error <= kAgrees) {
    return fmt::format(
        "caution: the rotations of lidar and gyro differ{} (difference {}). The rotations would agree if the lidar's "
        "axes were {} (difference {}). Check the signs and order of the axes, and the mounting",
        pairs_text(found), percent(found.error_as_read), found.axes.text(), percent(found.axes_error));
  }
  const Eigen::Quaterniond& q = found.turned;
  return fmt::format(
      "caution: the rotations of lidar and gyro differ{} (difference {}). The rotations would agree if the lidar's "
      "orientation relative to the IMU were the quaternion x y z w {} {} {} {} (difference {}). Check the mounting",
      pairs_text(found), percent(found.error_as_read), rounded(q.x()), rounded(q.y()), rounded(q.z()), rounded(q.w()),
      percent(found.turned_error));
}

}  // namespace

Eigen::Matrix3d SignedAxes::matrix() const {
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) out(i, axis[static_cast<std::size_t>(i)]) = sign[static_cast<std::size_t>(i)];
  return out;
}

std::string SignedAxes::text() const {
  std::string out;
  for (std::size_t i = 0; i < 3; ++i) {
    out += (i == 0 ? "(" : ", ") + std::string(sign[i] < 0 ? "-" : "") + "xyz"[axis[i]];
  }
  return out + ")";
}

std::optional<RotationAgreement> rotation_agreement(const sim::ImuRecord& imu, const sim::LidarRecord& lidar,
                                                    std::span<const SeenRotation> seen) {
  const Integral integral(imu);
  const Eigen::Matrix3d R_IL = bridge::T_IL(imu, lidar).linear();
  RotationAgreement at_once, delayed;
  double at_once_error = 1.0, delayed_error = 1.0;
  const int steps = static_cast<int>(std::lround(kDelayMost_s / kDelayStep_s));
  for (int step = -steps; step <= steps; ++step) {
    const double delay_s = kDelayStep_s * step;
    const Pairs pairs = pairs_at(integral, R_IL, seen, std::llround(1e9 * delay_s));
    if (pairs.lidar.size() < kLeastPairs) continue;
    fit_unit(pairs, delay_s, delayed, delayed_error);
    if (step == 0) fit_unit(pairs, delay_s, at_once, at_once_error);
  }
  // Among a hundred delays, the best delay may reduce the rotation error slightly by chance.
  RotationAgreement out = delayed_error < kDelayConclusive * at_once_error ? delayed : at_once;
  if (out.unit_error > kAgrees) return std::nullopt;
  fit_axes(pairs_at(integral, R_IL, seen, std::llround(1e9 * out.delay_s)), out);
  if (std::min({out.error_as_read, out.axes_error, out.turned_error}) > kAgrees) return std::nullopt;
  return out;
}

std::string agreement_text(const std::string& where, const RotationAgreement& found, GyroUnit unit,
                           double imu_minus_lidar_clock_s) {
  if (found.unit != 1.0) return unit_text(where, found, unit);
  return delay_text(found, imu_minus_lidar_clock_s) + axes_text(found);
}

namespace {

std::optional<Eigen::Matrix3d> better_attitude(const sim::ImuRecord& imu, const sim::LidarRecord& lidar,
                                               const RotationAgreement& found) {
  const bool agrees = found.error_as_read <= kAgrees && kConclusive * found.error_as_read <= found.axes_error;
  const Eigen::Matrix3d axes = found.axes.matrix();
  const bool by_axes =
      found.axes_error <= kAgrees && axes.determinant() > 0.0 && kConclusive * found.next_error > found.axes_error;
  if (agrees || found.unit != 1.0 || is_mirrored(found) || (!by_axes && found.turned_error > kAgrees))
    return std::nullopt;
  const Eigen::Matrix3d M = by_axes ? axes : found.turned.toRotationMatrix();
  return imu.T_BI.linear() * M.transpose() * bridge::T_IL(imu, lidar).linear();
}

bool is_inverse(const Eigen::Matrix3d& R, const Eigen::Matrix3d& other) {
  return R.transpose().isApprox(other, kInverted);
}

Eigen::Isometry3d better_pose(const sim::LidarRecord& lidar, const Eigen::Matrix3d& R_BL) {
  if (is_inverse(lidar.T_BL.linear(), R_BL)) return lidar.T_BL.inverse();
  Eigen::Isometry3d out = lidar.T_BL;
  out.linear() = R_BL;
  return out;
}

std::string better_pose_text(const sim::LidarRecord& lidar, const Eigen::Isometry3d& better_BL) {
  if (lidar.T_BL.isApprox(Eigen::Isometry3d::Identity(), 1e-12))
    return fmt::format(
        "; 'tumble odometry' uses another attitude of the lidar, and estimates the lidar's position "
        "(set '{}', with the measured position X Y Z, for more accurate poses)",
        lidar_pose_option(better_BL, "X Y Z"));
  return fmt::format("{} (set '{}')",
                     is_inverse(lidar.T_BL.linear(), better_BL.linear())
                         ? "; the stated pose may be inverted: the pose of the body in the lidar frame instead of the "
                           "pose of the lidar in the body frame. If only the stated orientation is wrong, keep the "
                           "stated position"
                         : "",
                     lidar_pose_option(better_BL));
}

}  // namespace

std::string lidar_pose_option(const Eigen::Isometry3d& T_BL, const std::string& position) {
  const auto text = [](const auto& numbers) {
    std::string out;
    for (const double number : numbers) out += " " + rounded(std::abs(number) < 1e-9 ? 0.0 : number);
    return out;
  };
  return "--T-body-lidar" + (position.empty() ? text(T_BL.translation()) : " " + position) +
         text(Eigen::Quaterniond(T_BL.linear()).coeffs());
}

LidarRotationCheck check_lidar_rotation(const std::string& where, const Imported& recording, GyroUnit unit) {
  LidarRotationCheck out;
  const sim::Sensors& sensors = recording.sensors;
  if (sensors.lidars.empty() || sensors.imus.empty()) return out;
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const std::vector<SeenRotation> seen =
      seen_rotations(lidar, recording.points.empty() ? nullptr : &recording.points.front());
  bool primary_agrees = false;
  for (const sim::ImuRecord& imu : sensors.imus) {
    auto agreement = rotation_agreement(imu, lidar, seen);
    // Points without times were measured on average half a sweep period after the stamp of their sweep.
    if (agreement && agreement->delay_s != 0.0 && lidar.point_times == sim::PointTimes::unknown)
      agreement->delay_s += 0.5 * seconds(lidar.sweep_period_ns);
    if (&imu == &sensors.imus.front()) require_common_clock(where, sensors, agreement, recording.record_shift_s);
    if (!agreement) continue;
    std::string text =
        agreement_text(where + ": '" + imu.name + "'", *agreement, unit, recording.imu_minus_lidar_clock_s);
    if (&imu == &sensors.imus.front()) {
      out.primary = agreement;
      primary_agrees = !text.starts_with("caution");
      if (const auto R_BL = better_attitude(imu, lidar, *agreement)) {
        out.better_BL = better_pose(lidar, *R_BL);
        text += better_pose_text(lidar, *out.better_BL);
      }
    } else if (primary_agrees && text.starts_with("caution") && sensors.imus.front().name.starts_with('/')) {
      text += fmt::format(" (set '--imu-topic {}' to use only this IMU)", sensors.imus.front().name);
    }
    if (!text.empty()) out.notes.push_back(imu.name + ": " + text);
  }
  return out;
}

}  // namespace tumble::scenarios
