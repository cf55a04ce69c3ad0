// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

constexpr double kMovingRateMin_rad_s = 1.0, kCorrelationMin = 0.6, kDelaySigmaRatio = 0.15;
constexpr double kCorrelatedImpactsMin = 30.0;
// A body with impacts counts as hand-held if the body is in free flight for less than the fraction `kFlightFractionMin`
// of the time.
constexpr double kImpactForceMin_m_s2 = 30.0, kFlightForceMax_m_s2 = 5.0, kFlightFractionMin = 0.1;
constexpr double kImpactsMin = 10.0;

// See rate_smoother.md (R45).
double correlation(const ImpactDelayCorrelation& sums, int i) {
  const double n = sums.intervals, x = sums.acceleration_sum, xx = sums.acceleration_squared;
  const double y = sums.force[i], yy = sums.force_squared[i], xy = sums.correlation_sum[i];
  const double spread = (n * xx - x * x) * (n * yy - y * y);
  return spread > 0.0 ? (n * xy - x * y) / std::sqrt(spread) : 0.0;
}

double delay_score(const ImpactDelayCorrelation& sums, int i) {
  if (sums.impacts[i] < kImpactsMin || sums.flying[i] < kFlightFractionMin * sums.intervals) return 0.0;
  return correlation(sums, i);
}

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Unknown = Eigen::Matrix<double, 6, 1>;  // unknowns: lever arm, accelerometer bias

constexpr int kMaxDelay_samples = ImpactDelayCorrelation::kDelayMax_samples;
constexpr int kDelaysPerSample =
    4;  // delays per sample on the coarse grid, and on the finer grid around the best delay
constexpr double kRateMin_rad_s = 2.0;
constexpr std::size_t kSamplesMin = 20, kSamplesMax = 2000;
constexpr double kLeverSigma_m = 0.02, kBiasSigma_m_s2 = 0.3;
// Two successive samples that are at most kApart_s apart count as one sample with time jitter.
constexpr double kApart_s = 1e-4;
// widths [m/s^2] of the robust kernel for the free-flight residuals of the specific force, in successive iterations
constexpr double kKernelWidths_m_s2[] = {3.0, 1.5, 0.8, 0.4, 0.25, 0.2};
// minimum significant decrease of the robust cost; each sample contributes at most 1 to this cost
constexpr double kGainMin = 0.4;

struct TriadReadings {
  std::vector<double> time_s;
  std::vector<Vector3d> value;
  std::vector<bool> is_sample_clipped;

  std::size_t size() const { return time_s.size(); }
  void add(double at_s, const Vector3d& reading, bool clips) {
    time_s.push_back(at_s);
    value.push_back(reading);
    is_sample_clipped.push_back(clips);
  }
};

TriadReadings readings_of(std::span<const ImuSample> samples, std::span<const Clipping> clippings, Triad triad) {
  const std::optional<RepeatedReadings> repeated = find_repeated(samples, triad);
  TriadReadings out;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (repeated && repeated->repeats_per_sample[k]) continue;
    const double at_s =
        seconds(samples[k].time_ns - samples[0].time_ns) - (repeated ? repeated->reading_age_s(k) : 0.0);
    if (out.size() > 0 && !(at_s > out.time_s.back() + kApart_s)) continue;
    if (triad == Triad::gyro) {
      out.add(at_s, samples[k].angular_velocity_rad_s, (clippings[k].gyro | clippings[k].unusable_gyro) != 0);
    } else {
      out.add(at_s, samples[k].specific_force_m_s2, clippings[k].accel != 0);
    }
  }
  return out;
}

struct RotationSample {
  double time_s;
  Matrix3d jacobian_lever;  ///< derivative of the specific force with respect to the lever arm: [alpha]x + [w]x [w]x
};

bool force_at(const TriadReadings& force, double time_s, std::size_t& from, Vector3d& out) {
  while (from + 2 < force.size() && force.time_s[from + 1] <= time_s) ++from;
  if (from < 1 || from + 2 >= force.size() || force.time_s[from] > time_s) return false;
  out.setZero();
  for (std::size_t i = from - 1; i < from + 3; ++i) {
    if (force.is_sample_clipped[i]) return false;
    double weight = 1.0;
    for (std::size_t j = from - 1; j < from + 3; ++j) {
      if (j != i) weight *= (time_s - force.time_s[j]) / (force.time_s[i] - force.time_s[j]);
    }
    out += weight * force.value[i];
  }
  return true;
}

std::vector<RotationSample> rotation_samples(const TriadReadings& gyro) {
  std::vector<RotationSample> out;
  for (std::size_t k = 1; k + 1 < gyro.size() && out.size() < kSamplesMax; ++k) {
    const Vector3d &before = gyro.value[k - 1], &w = gyro.value[k], &after = gyro.value[k + 1];
    if (w.norm() < kRateMin_rad_s || gyro.is_sample_clipped[k - 1] || gyro.is_sample_clipped[k] ||
        gyro.is_sample_clipped[k + 1])
      continue;
    const double left = gyro.time_s[k] - gyro.time_s[k - 1], right = gyro.time_s[k + 1] - gyro.time_s[k];
    const Vector3d alpha = (left / right * (after - w) + right / left * (w - before)) / (left + right);
    out.push_back({gyro.time_s[k], so3::hat(alpha) + so3::hat(w) * so3::hat(w)});
  }
  return out;
}

// Returns the robust cost of the free-flight residuals, minimised over lever arm and bias: rate_smoother.md (R10).
double alignment_cost(const TriadReadings& accel, std::span<const RotationSample> instants, const Vector3d& lever_arm_m,
                      double delay_s) {
  Unknown prior, at, information;
  prior << lever_arm_m, Vector3d::Zero();
  information << Vector3d::Constant(1.0 / (kLeverSigma_m * kLeverSigma_m)),
      Vector3d::Constant(1.0 / (kBiasSigma_m_s2 * kBiasSigma_m_s2));
  at = prior;
  double sum = 0.0;
  for (const double scale : kKernelWidths_m_s2) {
    Eigen::Matrix<double, 6, 6> H = information.asDiagonal();
    Unknown g = information.cwiseProduct(prior);
    sum = 0.0;
    std::size_t from = 0;
    for (const RotationSample& instant : instants) {
      Vector3d force;
      if (!force_at(accel, instant.time_s + delay_s, from, force)) {
        sum += 1.0;
        continue;
      }
      Eigen::Matrix<double, 3, 6> A;
      A << instant.jacobian_lever, Matrix3d::Identity();
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

class ForceIntegral {
 public:
  explicit ForceIntegral(const TriadReadings& force)
      : time_s_(force.time_s), norm_(force.size()), sum_(force.size(), 0.0) {
    for (std::size_t k = 0; k < norm_.size(); ++k) {
      norm_[k] = force.value[k].norm();
      if (k > 0) sum_[k] = sum_[k - 1] + 0.5 * (norm_[k] + norm_[k - 1]) * (time_s_[k] - time_s_[k - 1]);
    }
  }
  double integral_until(double time_s, std::size_t& from) const {
    if (time_s <= time_s_.front()) return norm_.front() * (time_s - time_s_.front());
    if (time_s >= time_s_.back()) return sum_.back() + norm_.back() * (time_s - time_s_.back());
    while (from + 2 < norm_.size() && time_s_[from + 1] <= time_s) ++from;
    const double u = time_s - time_s_[from];
    const double slope = (norm_[from + 1] - norm_[from]) / (time_s_[from + 1] - time_s_[from]);
    return sum_[from] + u * (norm_[from] + 0.5 * slope * u);
  }

 private:
  std::span<const double> time_s_;
  std::vector<double> norm_, sum_;
};

// See rate_smoother.md (R45).
TriadDelay delay_from_impacts(const TriadReadings& gyro, const TriadReadings& accel, double period_s) {
  if (accel.size() < 4) return {};
  const ForceIntegral force(accel);
  const double step_s = period_s / ImpactDelayCorrelation::kDelaysPerSample;
  std::array<std::size_t, ImpactDelayCorrelation::kDelayCount> begin{}, end{};
  ImpactDelayCorrelation sums;
  for (std::size_t k = 1; k < gyro.size(); ++k) {
    if (gyro.is_sample_clipped[k] || gyro.is_sample_clipped[k - 1] ||
        !ImpactDelayCorrelation::counts(gyro.value[k - 1], gyro.value[k]))
      continue;
    const double begin_s = gyro.time_s[k - 1], end_s = gyro.time_s[k], span_s = end_s - begin_s;
    ImpactDelayCorrelation::DelayGrid mean;
    for (int i = 0; i < ImpactDelayCorrelation::kDelayCount; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double delay_s = (i - ImpactDelayCorrelation::kDelayMax) * step_s;
      mean[i] = (force.integral_until(end_s + delay_s, end[at]) - force.integral_until(begin_s + delay_s, begin[at])) /
                span_s;
    }
    sums.add((gyro.value[k] - gyro.value[k - 1]).norm() / span_s, mean);
  }
  const auto mean_period = [](const TriadReadings& triad) {
    return (triad.time_s.back() - triad.time_s.front()) / static_cast<double>(triad.size() - 1);
  };
  if (gyro.size() < 2) return {};
  return sums.estimate_delay(period_s, std::max(mean_period(gyro), mean_period(accel)));
}

double delay_from_flight_s(const TriadReadings& gyro, const TriadReadings& accel, const Vector3d& lever_arm_m,
                           double period_s) {
  const std::vector<RotationSample> turning = rotation_samples(gyro);
  if (turning.size() < kSamplesMin) return 0.0;
  const auto of = [&](double shift) { return alignment_cost(accel, turning, lever_arm_m, shift * period_s); };
  const double none = of(0.0);
  double best = none, shift = 0.0;
  for (int i = -kMaxDelay_samples * kDelaysPerSample; i <= kMaxDelay_samples * kDelaysPerSample; ++i) {
    if (i == 0) continue;
    const double tried = static_cast<double>(i) / kDelaysPerSample, found = of(tried);
    if (found < best) {
      best = found;
      shift = tried;
    }
  }
  const double about = shift;
  for (int i = -kDelaysPerSample; i <= kDelaysPerSample; ++i) {
    const double tried = about + static_cast<double>(i) / (kDelaysPerSample * kDelaysPerSample), found = of(tried);
    if (found < best) {
      best = found;
      shift = tried;
    }
  }
  return none - best < kGainMin ? 0.0 : shift * period_s;
}

}  // namespace

bool ImpactDelayCorrelation::counts(const Eigen::Vector3d& before_rad_s, const Eigen::Vector3d& after_rad_s) {
  return std::min(before_rad_s.norm(), after_rad_s.norm()) >= kMovingRateMin_rad_s;
}

void ImpactDelayCorrelation::add(double acceleration_rad_s2, const DelayGrid& force_m_s2) {
  const double x = std::sqrt(acceleration_rad_s2);
  intervals += 1.0;
  acceleration_sum += x;
  acceleration_squared += x * x;
  for (int i = 0; i < kDelayCount; ++i) {
    const double mean = force_m_s2[i], root = std::sqrt(std::max(0.0, mean));
    impacts[i] += mean > kImpactForceMin_m_s2 ? 1.0 : 0.0;
    flying[i] += mean < kFlightForceMax_m_s2 ? 1.0 : 0.0;
    force[i] += root;
    force_squared[i] += root * root;
    correlation_sum[i] += x * root;
  }
}

void ImpactDelayCorrelation::decay_sums(double share) {
  for (double* const sum : {&intervals, &acceleration_sum, &acceleration_squared}) *sum *= share;
  for (DelayGrid* const sum : {&force, &force_squared, &correlation_sum, &impacts, &flying}) *sum *= share;
}

double ImpactDelayCorrelation::force_correlation_at(double delay_s, double period_s) const {
  const double step = std::clamp<double>(delay_s * kDelaysPerSample / period_s, -kDelayMax, kDelayMax);
  return correlation(*this, kDelayMax + static_cast<int>(std::lround(step)));
}

TriadDelay ImpactDelayCorrelation::estimate_delay(double period_s, double slower_s) const {
  if (intervals < kCorrelatedImpactsMin) return {};
  int at = 0;
  double best = -1.0;
  for (int i = 0; i < kDelayCount; ++i) {
    const double found = delay_score(*this, i);
    if (found > best) best = found, at = i;
  }
  if (best < kCorrelationMin || at == 0 || at == kDelayCount - 1) return {};
  const double left = delay_score(*this, at - 1), right = delay_score(*this, at + 1), bend = left - 2.0 * best + right;
  const double part = bend < 0.0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0.0;
  return {(at - kDelayMax + part) * (period_s / kDelaysPerSample), kDelaySigmaRatio * slower_s};
}

TriadDelay guess_triad_delay(std::span<const ImuSample> samples, std::span<const Clipping> clippings,
                             const Vector3d& lever_arm_m) {
  if (samples.size() < 2) return {};
  const TriadReadings gyro = readings_of(samples, clippings, Triad::gyro);
  const TriadReadings accel = readings_of(samples, clippings, Triad::accelerometer);
  const double period_s = median_period_s(samples);
  const TriadDelay impact_delay = delay_from_impacts(gyro, accel, period_s);
  if (impact_delay.sigma_s > 0.0) return impact_delay;
  return {delay_from_flight_s(gyro, accel, lever_arm_m, period_s), 0.0};
}

}  // namespace tumble
