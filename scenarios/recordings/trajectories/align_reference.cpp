// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/trajectories/align_reference.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/recordings/trajectories/reference_rate.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "scenarios/standard_gravity.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kFreeShare = 0.9;
constexpr double kRotating_rad_s = 0.5;
constexpr std::size_t kLeastSamples = 200;
constexpr int kSearch_ms = 100;
constexpr double kSlopeStep_s = 4e-3;
constexpr int kAlignmentParts = 8;
constexpr int kRounds = 20;
/// Standard deviations of the vector pairs, and numbers of consecutive samples with correlated errors.
constexpr double kRateSigma_rad_s = 0.15, kForceSigma_m_s2 = 1.0;
constexpr double kRateRun = 5.0, kForceRun = 25.0;

using Vectors = std::vector<Eigen::Vector3d>;

/// SamplePair is a sample whose gyro reading and reference are known.
struct SamplePair {
  std::int64_t time_ns = 0;
  Eigen::Vector3d w_I, f_I;
  Eigen::Vector3d w_V = Eigen::Vector3d::Zero();  ///< reference rate at the current delay
  Eigen::Quaterniond q_V = Eigen::Quaterniond::Identity();
  double speed_rad_s = 0.0;
};

std::vector<SamplePair> all_samples(const sim::ImuRecord& imu) {
  std::vector<SamplePair> pairs;
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    SamplePair pair;
    pair.time_ns = imu.time_ns[k], pair.w_I = imu.gyro_rad_s[k], pair.f_I = imu.accel_m_s2[k];
    pair.speed_rad_s = pair.w_I.norm();
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<SamplePair> free_samples(std::vector<SamplePair> pairs) {
  Eigen::Vector3d extreme = Eigen::Vector3d::Zero();
  for (const SamplePair& pair : pairs) extreme = extreme.cwiseMax(pair.w_I.cwiseAbs());
  std::erase_if(pairs, [&](const SamplePair& pair) {
    return pair.speed_rad_s < kRotating_rad_s || (pair.w_I.cwiseAbs().array() > kFreeShare * extreme.array()).any();
  });
  return pairs;
}

std::vector<double> speeds_at(const std::vector<ReferencePose>& poses, const std::vector<SamplePair>& pairs,
                              double delay_s) {
  std::vector<std::int64_t> times;
  for (const SamplePair& pair : pairs) times.push_back(pair.time_ns + std::llround(delay_s * 1e9));
  std::vector<double> speeds;
  for (const Eigen::Vector3d& w : reference_rates(poses, times)) speeds.push_back(w.norm());
  return speeds;
}

double correlation(const std::vector<SamplePair>& pairs, const std::vector<double>& speeds) {
  double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double x = pairs[k].speed_rad_s, y = speeds[k];
    if (!std::isfinite(y)) continue;
    n += 1, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
  }
  const double spread = (n * aa - a * a) * (n * bb - b * b);
  return spread > 0.0 ? (n * ab - a * b) / std::sqrt(spread) : -1.0;
}

/// Performs one Gauss-Newton step of the delay, from |w| of the samples `first` to `end` - 1. Rates slightly earlier
/// and later give the derivative.
double delay_step(const std::vector<SamplePair>& pairs, const std::array<std::vector<double>, 3>& speeds,
                  std::size_t first, std::size_t end) {
  std::vector<double> sizes;
  for (std::size_t k = first; k < end; ++k) {
    const double error = pairs[k].speed_rad_s - speeds[1][k];
    if (std::isfinite(error)) sizes.push_back(std::abs(error));
  }
  const double bound = 3.0 * upper_median(std::move(sizes));
  double gg = 0.0, ge = 0.0;
  for (std::size_t k = first; k < end; ++k) {
    const double slope = (speeds[2][k] - speeds[0][k]) / (2.0 * kSlopeStep_s),
                 error = pairs[k].speed_rad_s - speeds[1][k];
    if (!(std::abs(error) <= bound) || !std::isfinite(slope)) continue;
    gg += slope * slope, ge += slope * error;
  }
  return gg > 0.0 ? std::clamp(ge / gg, -0.05, 0.05) : 0.0;
}

std::array<std::vector<double>, 3> speeds_around(const std::vector<ReferencePose>& poses,
                                                 const std::vector<SamplePair>& pairs, double delay_s) {
  return {speeds_at(poses, pairs, delay_s - kSlopeStep_s), speeds_at(poses, pairs, delay_s),
          speeds_at(poses, pairs, delay_s + kSlopeStep_s)};
}

double deviation_of_mean(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v;
  for (const double v : values) squares += (v - sum / n) * (v - sum / n);
  return n > 1.0 ? std::sqrt(squares / (n - 1.0) / n) : 0.0;
}

/// Returns first index and end of part i, if n samples are divided into equal parts.
std::array<std::size_t, 2> part(std::size_t i, std::size_t n) {
  return {i * n / kAlignmentParts, (i + 1) * n / kAlignmentParts};
}

void estimate_delay(const std::vector<ReferencePose>& poses, const std::vector<SamplePair>& pairs,
                    ReferenceAlignment& alignment) {
  double best = -1.0;
  for (int ms = -kSearch_ms; ms <= kSearch_ms; ms += 5) {
    const double found = correlation(pairs, speeds_at(poses, pairs, 1e-3 * ms));
    if (found > best) best = found, alignment.delay_s = 1e-3 * ms;
  }
  std::array<std::vector<double>, 3> speeds;
  for (int round = 0; round < 4; ++round) {
    speeds = speeds_around(poses, pairs, alignment.delay_s);
    alignment.delay_s += delay_step(pairs, speeds, 0, pairs.size());
  }
  speeds = speeds_around(poses, pairs, alignment.delay_s);
  std::vector<double> steps;
  for (std::size_t i = 0; i < kAlignmentParts; ++i) {
    const auto [first, end] = part(i, pairs.size());
    steps.push_back(delay_step(pairs, speeds, first, end));
  }
  alignment.delay_sigma_s = deviation_of_mean(steps);
}

/// Interpolates the reference at the given delay, and removes pairs with an unknown reference.
void pair_up(const std::vector<ReferencePose>& poses, double delay_s, std::vector<SamplePair>& pairs) {
  std::vector<std::int64_t> times;
  for (const SamplePair& pair : pairs) times.push_back(pair.time_ns + std::llround(delay_s * 1e9));
  const Vectors rates = reference_rates(poses, times);
  std::vector<SamplePair> kept;
  std::size_t next = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (!rates[k].allFinite()) continue;
    while (next < poses.size() && poses[next].time_ns < times[k]) ++next;
    const ReferencePose &before = poses[next - 1], &after = poses[next];  // the rate needs a pose on both sides
    const double share =
        static_cast<double>(times[k] - before.time_ns) / static_cast<double>(after.time_ns - before.time_ns);
    pairs[k].w_V = rates[k];
    pairs[k].q_V = before.q_WA.slerp(share, after.q_WA);
    kept.push_back(pairs[k]);
  }
  pairs = std::move(kept);
}

/// Returns the vertical in the reference's world, from the mean specific force and the rotation between IMU and
/// reference. The mean is over all samples, because accelerations cancel over the recording.
Eigen::Vector3d up_in_world(const std::vector<SamplePair>& all, const Eigen::Quaterniond& q_IV) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SamplePair& pair : all) sum += pair.q_V * (q_IV.conjugate() * pair.f_I);
  return sum.normalized();
}

/// Returns the rotation R with the largest trace(R^T B) as a unit quaternion. The quaternion is the eigenvector of the
/// largest eigenvalue of Davenport's matrix (Markley and Crassidis, Fundamentals of Spacecraft Attitude Determination
/// and Control, 2014, section 5.3, which defines the matrix for R^T).
Eigen::Quaterniond closest_rotation(const Eigen::Matrix3d& B) {
  const Eigen::Vector3d z(B(2, 1) - B(1, 2), B(0, 2) - B(2, 0), B(1, 0) - B(0, 1));
  Eigen::Matrix4d K;
  K.topLeftCorner<3, 3>() = B + B.transpose() - B.trace() * Eigen::Matrix3d::Identity();
  K.topRightCorner<3, 1>() = z;
  K.bottomLeftCorner<1, 3>() = z.transpose();
  K(3, 3) = B.trace();
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(K).eigenvectors().col(3);
  return Eigen::Quaterniond(q.w() < 0.0 ? Eigen::Vector4d(-q) : q).normalized();
}

/// Returns the rotation that fits the samples `first` to `end` - 1 best, for a given direction of gravity.
Eigen::Quaterniond rotation(const std::vector<SamplePair>& pairs, std::size_t first, std::size_t end,
                            const Eigen::Vector3d& up) {
  Eigen::Matrix3d B = Eigen::Matrix3d::Zero();
  for (std::size_t k = first; k < end; ++k) {
    const SamplePair& pair = pairs[k];
    const double departure = pair.f_I.norm() - kStandardGravity_m_s2;
    B += pair.w_I * pair.w_V.transpose() / (kRateSigma_rad_s * kRateSigma_rad_s * kRateRun);
    B += pair.f_I * (kStandardGravity_m_s2 * (pair.q_V.conjugate() * up)).transpose() /
         ((kForceSigma_m_s2 * kForceSigma_m_s2 + departure * departure) * kForceRun);
  }
  return closest_rotation(B);
}

void estimate_rotation(const std::vector<SamplePair>& all, const std::vector<SamplePair>& pairs,
                       ReferenceAlignment& alignment) {
  Eigen::Vector3d up = up_in_world(all, alignment.q_IV);
  for (int round = 0; round < kRounds; ++round) {
    alignment.q_IV = rotation(pairs, 0, pairs.size(), up);
    up = up_in_world(all, alignment.q_IV);
  }
  alignment.q_WV = so3::shortest_arc(up, Eigen::Vector3d::UnitZ());
  std::array<std::vector<double>, 3> departures;
  for (std::size_t i = 0; i < kAlignmentParts; ++i) {
    const auto [first, end] = part(i, pairs.size());
    const Eigen::AngleAxisd turn(rotation(pairs, first, end, up) * alignment.q_IV.conjugate());
    for (int j = 0; j < 3; ++j) departures[static_cast<std::size_t>(j)].push_back(turn.angle() * turn.axis()[j]);
  }
  for (int j = 0; j < 3; ++j) alignment.q_IV_sigma_rad[j] = deviation_of_mean(departures[static_cast<std::size_t>(j)]);
}

double degrees(double rad) {
  return rad * 180.0 / M_PI;
}

}  // namespace

ReferenceAlignment align_reference(const std::vector<ReferencePose>& poses, const sim::ImuRecord& imu) {
  ReferenceAlignment alignment;
  std::vector<SamplePair> all = all_samples(imu), pairs = free_samples(all);
  if (poses.size() < kLeastSamples || pairs.size() < kLeastSamples) return alignment;
  estimate_delay(poses, pairs, alignment);
  pair_up(poses, alignment.delay_s, pairs);
  alignment.samples = pairs.size();
  if (pairs.size() < kLeastSamples) return alignment;
  pair_up(poses, alignment.delay_s, all);
  estimate_rotation(all, pairs, alignment);
  alignment.known = true;
  return alignment;
}

void apply(const ReferenceAlignment& alignment, std::vector<ReferencePose>& poses) {
  for (ReferencePose& pose : poses) {
    pose.time_ns -= std::llround(alignment.delay_s * 1e9);
    pose.q_WA = (alignment.q_WV * pose.q_WA * alignment.q_IV.conjugate()).normalized();
    pose.p_WA_m = alignment.q_WV * pose.p_WA_m;
  }
}

std::string ReferenceAlignment::text() const {
  if (!known)
    return "the reference cannot be aligned with the IMU, because the motion has too little rotation, or the reference "
           "has too few poses";
  const Eigen::AngleAxisd turn(q_IV);
  const Eigen::Vector3d rotation_deg = turn.axis() * degrees(turn.angle());
  const Eigen::Vector3d sigma_deg = q_IV_sigma_rad * (180.0 / M_PI);
  return fmt::format(
      "the reference is {:.1f} +- {:.1f} ms later than the IMU; its frame is rotated by ({:.2f}, {:.2f}, {:.2f}) +- "
      "({:.2f}, {:.2f}, {:.2f}) deg, and its vertical differs by {:.2f} deg ({} samples)",
      1e3 * delay_s, 1e3 * delay_sigma_s, rotation_deg.x(), rotation_deg.y(), rotation_deg.z(), sigma_deg.x(),
      sigma_deg.y(), sigma_deg.z(), degrees(Eigen::AngleAxisd(q_WV).angle()), samples);
}

}  // namespace tumble::scenarios
