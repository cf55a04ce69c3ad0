// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/imu_position.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::scenarios {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Rows = Eigen::Matrix<double, 3, 6>;

constexpr double kRateMin_rad_s = 2.5;      // slower rotation causes forces below the noise
constexpr double kUnsaturatedRatio = 0.98;  // of the largest reading of an axis
constexpr std::size_t kSamplesMin = 200;
constexpr double kSigmaMax_m = 2e-3;         // the estimators assume this accuracy of a position
constexpr double kRateDifferenceMax = 0.1;   // median difference of both gyros / rate; more: other axes
constexpr double kCorrelatedSamples = 10.0;  // vibration is correlated over about this number of samples
constexpr double kOutlierSigmas = 3.0;
constexpr int kRounds = 4;

/// Pair contains the readings of both IMUs at one time.
struct Pair {
  Rows rows;            // derivative of the force difference with respect to position and bias
  Vector3d difference;  // specific force of the second IMU minus that of the first IMU
};

Vector3d largest_readings(const sim::ImuRecord& imu) {
  Vector3d out = Vector3d::Zero();
  for (const Vector3d& rate : imu.gyro_rad_s) out = out.cwiseMax(rate.cwiseAbs());
  return out;
}

/// Returns the pairs of readings during fast rotation, and the median difference of both gyros relative to the rate.
std::vector<Pair> fast_pairs(const sim::ImuRecord& first, const sim::ImuRecord& second, double& rate_difference) {
  const Vector3d largest = kUnsaturatedRatio * largest_readings(first);
  std::vector<Pair> pairs;
  std::vector<double> differences;
  std::size_t after = 0;
  for (std::size_t k = 1; k + 1 < first.time_ns.size(); ++k) {
    const std::int64_t now = first.time_ns[k];
    while (after < second.time_ns.size() && second.time_ns[after] < now) ++after;
    if (after == second.time_ns.size()) break;
    const bool exact = second.time_ns[after] == now;
    const std::int64_t step_ns = first.time_ns[k + 1] - first.time_ns[k - 1];
    if (step_ns > 3 * first.period_ns || (!exact && after == 0)) continue;
    const std::size_t before = exact ? after : after - 1;
    const std::int64_t apart_ns = second.time_ns[after] - second.time_ns[before];
    if (apart_ns > 2 * second.period_ns) continue;
    const double share =
        exact ? 0.0 : static_cast<double>(now - second.time_ns[before]) / static_cast<double>(apart_ns);
    const auto at_time = [&](const std::vector<Vector3d>& values) -> Vector3d {
      return (1.0 - share) * values[before] + share * values[after];
    };
    const bool saturated = (first.gyro_rad_s[k - 1].cwiseAbs().array() > largest.array()).any() ||
                           (first.gyro_rad_s[k + 1].cwiseAbs().array() > largest.array()).any();
    const Vector3d& w = first.gyro_rad_s[k];
    if (saturated || w.norm() < kRateMin_rad_s) continue;
    const Vector3d a = (first.gyro_rad_s[k + 1] - first.gyro_rad_s[k - 1]) / (1e-9 * static_cast<double>(step_ns));
    Pair pair;
    pair.rows << so3::hat(a) + so3::hat(w) * so3::hat(w), Matrix3d::Identity();
    pair.difference = at_time(second.accel_m_s2) - first.accel_m_s2[k];
    pairs.push_back(pair);
    differences.push_back((at_time(second.gyro_rad_s) - w).norm() / w.norm());
  }
  rate_difference = differences.empty() ? 0.0 : upper_median(std::move(differences));
  return pairs;
}

}  // namespace

ImuPosition estimate_imu_position(const sim::ImuRecord& first, const sim::ImuRecord& second) {
  ImuPosition out;
  double rate_difference = 0.0;
  const std::vector<Pair> pairs = fast_pairs(first, second, rate_difference);
  out.samples = pairs.size();
  if (pairs.size() < kSamplesMin) {
    out.problem = fmt::format(
        "only {} samples have a rate above {} rad/s and no saturated gyro; an estimate of the IMU's position needs {}",
        pairs.size(), rounded(kRateMin_rad_s), kSamplesMin);
    return out;
  }
  if (rate_difference > kRateDifferenceMax) {
    out.problem = fmt::format(
        "the rates of both gyros differ by {} % (median); they may differ by {} %. The axes of "
        "the IMUs may differ",
        rounded(100.0 * rate_difference), rounded(100.0 * kRateDifferenceMax));
    return out;
  }
  Vector6d solution = Vector6d::Zero();
  Matrix6d inverse = Matrix6d::Identity();
  double variance = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kRounds; ++round) {
    Matrix6d normal = Matrix6d::Zero();
    Vector6d right = Vector6d::Zero();
    double sum = 0.0, used = 0.0;
    for (const Pair& pair : pairs) {
      const Vector3d residual = pair.difference - pair.rows * solution;
      if (residual.squaredNorm() > 3.0 * kOutlierSigmas * kOutlierSigmas * variance) continue;
      normal += pair.rows.transpose() * pair.rows;
      right += pair.rows.transpose() * pair.difference;
      used += 1.0;
    }
    inverse = normal.ldlt().solve(Matrix6d::Identity());
    solution = inverse * right;
    for (const Pair& pair : pairs) {
      const double squared = (pair.difference - pair.rows * solution).squaredNorm();
      if (squared <= 3.0 * kOutlierSigmas * kOutlierSigmas * variance) sum += squared;
    }
    variance = sum / (3.0 * std::max(1.0, used));
  }
  out.position_m = solution.head<3>();
  out.sigma_m = (kCorrelatedSamples * variance * inverse.diagonal().head<3>()).cwiseMax(0.0).cwiseSqrt();
  if (!(out.sigma_m.maxCoeff() <= kSigmaMax_m))
    out.problem = fmt::format("the estimated position of this IMU has the standard deviation {} m; the maximum is {} m",
                              rounded(out.sigma_m.maxCoeff()), rounded(kSigmaMax_m));
  return out;
}

}  // namespace tumble::scenarios
