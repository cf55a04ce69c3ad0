// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/triad_delay.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "recording_check.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Unknown = Eigen::Matrix<double, 6, 1>;  // lever arm, bias

constexpr int kReach = 4;      // largest delay, in samples
constexpr int kPerSample = 4;  // delays tried to a sample, on the coarse and, as many again, about the best of them
constexpr double kRateMin_rad_s = 2.0;
constexpr std::size_t kSamplesMin = 20, kSamplesMax = 2000;
constexpr double kLeverSigma_m = 0.02, kBiasSigma_m_s2 = 0.3;
// Scales of what fits, from the first iteration to the last [m/s^2].
constexpr double kScales_m_s2[] = {3.0, 1.5, 0.8, 0.4, 0.25, 0.2};
// A gain of robust cost, each sample's at most 1, that chance does not make.
constexpr double kGainMin = 0.4;

struct Place {
  std::size_t index;
  Matrix3d by_lever;  ///< [alpha]x + [w]x [w]x
};

// Cubic through the four readings about an instant `shift` samples after sample k.
bool force_at(std::span<const ImuSample> samples, std::span<const Clipping> clippings, std::size_t k, double shift,
              Vector3d& force) {
  const double at = static_cast<double>(k) + shift, floor = std::floor(at);
  const auto i = static_cast<std::ptrdiff_t>(floor);
  if (i < 1 || i + 2 >= static_cast<std::ptrdiff_t>(samples.size())) return false;
  const double u = at - floor;
  const double weights[] = {-u * (u - 1.0) * (u - 2.0) / 6.0, (u + 1.0) * (u - 1.0) * (u - 2.0) / 2.0,
                            -(u + 1.0) * u * (u - 2.0) / 2.0, (u + 1.0) * u * (u - 1.0) / 6.0};
  force.setZero();
  for (std::ptrdiff_t n = 0; n < 4; ++n) {
    const auto s = static_cast<std::size_t>(i - 1 + n);
    if (clippings[s].accel != 0) return false;
    force += weights[n] * samples[s].specific_force_m_s2;
  }
  return true;
}

std::vector<Place> places(std::span<const ImuSample> samples, std::span<const Clipping> clippings) {
  std::vector<Place> out;
  for (std::size_t k = kReach + 2; k + kReach + 2 < samples.size(); ++k) {
    const Vector3d& w = samples[k].angular_velocity_rad_s;
    if (w.norm() < kRateMin_rad_s) continue;
    const auto clipped = [&](std::size_t i) { return (clippings[i].gyro | clippings[i].void_gyro) != 0; };
    if (clipped(k - 1) || clipped(k) || clipped(k + 1)) continue;
    const double span_s = seconds(samples[k + 1].time_ns - samples[k - 1].time_ns);
    const Vector3d alpha = (samples[k + 1].angular_velocity_rad_s - samples[k - 1].angular_velocity_rad_s) / span_s;
    if (out.size() == kSamplesMax) break;
    out.push_back({k, so3::hat(alpha) + so3::hat(w) * so3::hat(w)});
  }
  return out;
}

// Robust cost of a delay of `shift` samples, least over lever arm and bias.
double cost(std::span<const ImuSample> samples, std::span<const Clipping> clippings, std::span<const Place> places,
            const Vector3d& lever_arm_m, double shift) {
  Unknown prior, at, information;
  prior << lever_arm_m, Vector3d::Zero();
  information << Vector3d::Constant(1.0 / (kLeverSigma_m * kLeverSigma_m)),
      Vector3d::Constant(1.0 / (kBiasSigma_m_s2 * kBiasSigma_m_s2));
  at = prior;
  double sum = 0.0;
  for (const double scale : kScales_m_s2) {
    Eigen::Matrix<double, 6, 6> H = information.asDiagonal();
    Unknown g = information.cwiseProduct(prior);
    sum = 0.0;
    for (const Place& place : places) {
      Vector3d force;
      if (!force_at(samples, clippings, place.index, shift, force)) {
        sum += 1.0;
        continue;
      }
      Eigen::Matrix<double, 3, 6> A;
      A << place.by_lever, Matrix3d::Identity();
      const double r2 = (A * at - force).squaredNorm() / (scale * scale), ratio = 1.0 / (1.0 + r2);
      sum += r2 * ratio;
      const double weight = ratio * ratio / (scale * scale);
      H.noalias() += weight * A.transpose() * A;
      g.noalias() += weight * A.transpose() * force;
    }
    at = H.ldlt().solve(g);
  }
  return sum;
}

}  // namespace

double guess_triad_delay_s(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                           const Vector3d& lever_arm_m) {
  const std::vector<Place> turning = places(samples, clippings);
  if (turning.size() < kSamplesMin) return 0.0;
  const auto of = [&](double shift) { return cost(samples, clippings, turning, lever_arm_m, shift); };
  const double none = of(0.0);
  double best = none, shift = 0.0;
  for (int i = -kReach * kPerSample; i <= kReach * kPerSample; ++i) {
    if (i == 0) continue;
    const double tried = static_cast<double>(i) / kPerSample, found = of(tried);
    if (found < best) {
      best = found;
      shift = tried;
    }
  }
  const double about = shift;
  for (int i = -kPerSample; i <= kPerSample; ++i) {
    const double tried = about + static_cast<double>(i) / (kPerSample * kPerSample), found = of(tried);
    if (found < best) {
      best = found;
      shift = tried;
    }
  }
  return none - best < kGainMin ? 0.0 : shift * median_period_s(samples);
}

}  // namespace tumble
