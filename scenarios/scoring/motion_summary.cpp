// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/motion_summary.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/clipping.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kMovingSpeed_m_s = 0.1;
constexpr double kMovingRate_rad_s = 0.3;
constexpr double kImpact_m_s2 = 20.0;
constexpr std::int64_t kQuiet_ns = 20'000'000;

struct MovingSpan {
  std::size_t first = 1, last = 0;
};

MovingSpan moving_span(const sim::Truth& truth) {
  const auto moves = [&](std::size_t k) {
    return truth.v_WB_m_s[k].norm() > kMovingSpeed_m_s || truth.w_WB_B_rad_s[k].norm() > kMovingRate_rad_s;
  };
  MovingSpan span;
  bool found = false;
  for (std::size_t k = 0; k < truth.v_WB_m_s.size(); ++k) {
    if (!moves(k)) continue;
    if (!found) span.first = k;
    found = true;
    span.last = k;
  }
  return span;
}

std::size_t count_impacts(const sim::Truth& truth) {
  const auto quiet = static_cast<std::size_t>(kQuiet_ns / truth.period_ns);
  std::size_t impacts = 0, below = quiet;
  for (const Eigen::Vector3d& f : truth.f_B_m_s2) {
    if (f.norm() <= kImpact_m_s2) {
      ++below;
      continue;
    }
    if (below >= quiet) ++impacts;
    below = 0;
  }
  return impacts;
}

bool accel_clipped(const sim::ImuRecord& record, const sim::ImuTruth& truth, std::size_t i) {
  const double noise_m_s2 = record.accel_noise_m_s2_sqrt_hz / std::sqrt(1e-9 * static_cast<double>(record.period_ns));
  return (truth.accel_unclipped_m_s2[i] - record.accel_m_s2[i]).lpNorm<Eigen::Infinity>() > std::max(1e-6, noise_m_s2);
}

}  // namespace

MotionSummary summarise_motion(const sim::Sensors& sensors, const sim::Truth& truth) {
  const ClippingTruth clipping(sensors, truth);
  if (truth.period_ns <= 0 || truth.label.size() != truth.p_WB_m.size() ||
      truth.f_B_m_s2.size() != truth.p_WB_m.size()) {
    throw BadInput(
        "the truth of the recording is damaged: its sampling period is not positive, or its positions, contact labels "
        "and specific forces differ in number");
  }
  MotionSummary out;
  for (std::size_t k = 1; k < truth.p_WB_m.size(); ++k) out.path_m += (truth.p_WB_m[k] - truth.p_WB_m[k - 1]).norm();
  for (const sim::ImuTruth& imu : truth.imus) {
    for (const Eigen::Vector3d& f : imu.accel_unclipped_m_s2)
      out.peak_accel_m_s2 = std::max(out.peak_accel_m_s2, f.norm());
  }
  for (const Eigen::Vector3d& w : truth.imus.front().rate_rad_s)
    out.peak_rate_rad_s = std::max(out.peak_rate_rad_s, w.norm());
  out.impacts = count_impacts(truth);

  const MovingSpan span = moving_span(truth);
  if (span.first > span.last) return out;
  const std::size_t steps = span.last - span.first + 1;
  const double period_s = 1e-9 * static_cast<double>(truth.period_ns);
  out.moving_s = period_s * static_cast<double>(steps);
  out.rest_at_end_s = period_s * static_cast<double>(truth.v_WB_m_s.size() - 1 - span.last);
  const auto begin = truth.label.begin() + static_cast<std::ptrdiff_t>(span.first);
  const auto air = std::count(begin, begin + static_cast<std::ptrdiff_t>(steps), sim::ContactLabel::air);
  out.flight_share = static_cast<double>(air) / static_cast<double>(steps);
  const sim::ImuRecord& primary = sensors.imus.front();
  std::size_t in_a_row = 0;
  for (std::size_t i = 0; i < clipping.size(); ++i) {
    const auto k = static_cast<std::size_t>(std::max<std::int64_t>(0, primary.time_ns[i]) / truth.period_ns);
    if (k < span.first || k > span.last) continue;
    const std::uint8_t clipped = clipping.clipped_axes(i);
    const int axes = std::popcount(clipped);
    ++out.samples;
    in_a_row = axes >= 1 ? in_a_row + 1 : 0;
    if (axes >= 1) {
      ++out.clipped_samples;
      out.clip_depth_max_rad_s = std::max(out.clip_depth_max_rad_s, clipping.depth_rad_s(i));
      out.clip_length_max_s = std::max(out.clip_length_max_s,
                                       1e-9 * static_cast<double>(primary.period_ns) * static_cast<double>(in_a_row));
    }
    for (std::size_t j = 0; j < 3; ++j) out.axis_clipped_samples[j] += (clipped >> j) & 1u;
    if (axes >= 2) ++out.several_axes_samples;
    if (clipping.cross_axes(i) != 0) ++out.cross_axis_samples;
    if (accel_clipped(primary, truth.imus.front(), i)) ++out.accel_clipped_samples;
  }
  return out;
}

}  // namespace tumble::scenarios
