// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/impact_sums.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace tumble
