// SPDX-License-Identifier: BSD-3-Clause
#include "hand_held_problem.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/attitude/detail/vqf.hpp"
#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping) {
  const auto sign = [&](Triad triad, int axis) -> std::int8_t {
    switch (sensing_axis_reading(sample, clipping, triad, axis)) {
      case SensingAxisReading::not_clipped:
        return 0;
      case SensingAxisReading::clipped_high:
        return 1;
      case SensingAxisReading::clipped_low:
        return -1;
      case SensingAxisReading::invalid_reading:
        return ClipSigns::kMissingSign;
    }
    return 0;
  };
  ClipSigns out;
  for (int j = 0; j < 3; ++j) {
    out.gyro[static_cast<std::size_t>(j)] = sign(Triad::gyro, j);
    out.accel[static_cast<std::size_t>(j)] = sign(Triad::accelerometer, j);
  }
  return out;
}

namespace hand_held {

using Eigen::Vector3d;

namespace {

double since_s(std::span<const ImuSample> samples, std::size_t from, std::size_t to) {
  return seconds(samples[to].time_ns - samples[from].time_ns);
}

constexpr double kMinClockAgreement = 0.9;
// Partial saturation is assumed only for averaging windows that are longer than kLongWindow time steps. Recorded
// readings with windows of 20 ms (pendulums) were partly saturated, and readings with 10 ms (hand-held wands) were not.
constexpr double kLongWindow = 1.5;

TimeNs nanoseconds(double s) {
  return static_cast<TimeNs>(std::llround(1e9 * s));
}

ClipSigns clip_signs_of(const SensingAxisClipSigns& clipped, std::size_t k) {
  return clipped.clip_signs.empty() ? ClipSigns{} : clipped.clip_signs[k];
}

void add_gyro_reading(double z, double t, int sign, SensingAxisSums& e) {
  if (sign == ClipSigns::kMissingSign) {
    e.unusable_reading_count += 1.0;
    e.mean_unusable_reading += (z - e.mean_unusable_reading) / e.unusable_reading_count;
    return;
  }
  if (sign != 0) {
    e.clipped_reading_count += 1.0;
    e.clipped_time_s += (t - e.clipped_time_s) / e.clipped_reading_count;
    e.mean_saturation_limit += (z - e.mean_saturation_limit) / e.clipped_reading_count;
    e.saturated_side = sign;
    return;
  }
  e.count += 1.0;
  e.time_sum_s += t;
  e.time_squared_sum_s2 += t * t;
  e.reading_sum += z;
  e.reading_time_sum += z * t;
}

void interpolate_segment(std::span<const ImuSample> samples, const std::vector<double>& raw, std::size_t begin,
                         std::size_t end, int sign, std::vector<double>& filled) {
  if (begin < 2 || end + 1 >= raw.size()) return;
  const std::size_t a = begin - 1, b = end;
  const double gap = since_s(samples, a, b);
  const double slope_a = (raw[a] - raw[a - 1]) / since_s(samples, a - 1, a);
  const double slope_b = (raw[b + 1] - raw[b]) / since_s(samples, b, b + 1);
  for (std::size_t i = begin; i < end; ++i) {
    const double u = since_s(samples, a, i) / gap, v = 1.0 - u;
    const double value =
        raw[a] * v * v * (1.0 + 2.0 * u) + raw[b] * u * u * (1.0 + 2.0 * v) + gap * u * v * (slope_a * v - slope_b * u);
    const double rail = std::abs(raw[i]);
    filled[i] = sign * std::clamp(sign * value, rail, kFillRatioMax * rail);
  }
}

struct ClippedSegment {
  std::size_t clipped_segment_end = 0;
  int saturated_side = 0;
};

ClippedSegment clipped_segment(std::span<const ClipSigns> signs, std::size_t element, std::size_t begin,
                               const std::vector<double>& raw) {
  ClippedSegment out{begin, 0};
  if (signs[begin].gyro[element] == 0) {
    while (out.clipped_segment_end < signs.size() && signs[out.clipped_segment_end].gyro[element] == 0)
      ++out.clipped_segment_end;
    return out;
  }
  for (; out.clipped_segment_end < signs.size(); ++out.clipped_segment_end) {
    const int sign = signs[out.clipped_segment_end].gyro[element];
    if (sign == 0 || (sign != ClipSigns::kMissingSign && out.saturated_side != 0 && sign != out.saturated_side)) break;
    if (sign != ClipSigns::kMissingSign) out.saturated_side = sign;
  }
  // If all readings of a segment are unusable, the rate is assumed to exceed the saturation level, with the sign of the
  // reading before the segment.
  if (out.saturated_side == 0) out.saturated_side = raw[begin == 0 ? begin : begin - 1] < 0.0 ? -1 : 1;
  return out;
}

// All averaging windows have the length `period_s`, even if the previous reading is missing.
AveragingWindows averaging_windows_of(std::span<const ImuSample> samples, TimeNs origin_ns, double period_s) {
  AveragingWindows out;
  out.period_s = period_s;
  out.window_centre_s.resize(samples.size());
  out.end_s.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double window = k == 0 ? period_s : std::min(since_s(samples, k - 1, k), kLongest * period_s);
    out.end_s[k] = seconds(samples[k].time_ns - origin_ns);
    out.window_centre_s[k] = out.end_s[k] - 0.5 * window;
  }
  return out;
}

void assign_windows_to_nodes(double node_s, std::size_t nodes, AveragingWindows& windows) {
  windows.node_of.resize(windows.window_centre_s.size());
  for (std::size_t k = 0; k < windows.node_of.size(); ++k) {
    const auto node = static_cast<std::size_t>(std::llround(std::max(0.0, windows.window_centre_s[k]) / node_s));
    windows.node_of[k] = std::min(node, nodes - 1);
  }
}

// Returns the standard deviations of specific forces that result from the unknown averaging time of a slow
// accelerometer: carried.md (C12).
std::vector<double> window_force_sigmas(TimedReadings& forces, double log_period_s) {
  const std::vector<ImuSample>& samples = forces.samples;
  std::vector<double> out(samples.size(), 0.0);
  if (!(forces.averaging_windows.period_s > log_period_s)) return out;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    forces.averaging_windows.window_centre_s[k] += 0.25 * forces.averaging_windows.period_s;
    const std::size_t a = k == 0 ? 0 : k - 1, b = std::min(k + 1, samples.size() - 1);
    const Vector3d change = samples[b].specific_force_m_s2 - samples[a].specific_force_m_s2;
    if (b > a) out[k] = kWindowCentreSigmaRatio * change.norm() / static_cast<double>(b - a);
  }
  return out;
}

// See rails.md (R69) to (R73).
void correct_partial_saturation(double noise_rad_s, const Eigen::Matrix3d& rows, GyroReadings& rates) {
  const std::size_t count = rates.samples.size();
  const auto along = [&](std::size_t k, Eigen::Index j) {
    return rows.row(j).dot(rates.samples[k].angular_velocity_rad_s);
  };
  const Eigen::Matrix3d inverse = rows.inverse();
  std::vector<Vector3d> lost(count, Vector3d::Zero());
  for (std::size_t k = 1; k + 1 < count; ++k) {
    for (std::size_t j = 0; j < 3; ++j) {
      const int before = rates.clip_signs[k - 1].gyro[j], after = rates.clip_signs[k + 1].gyro[j];
      const bool at_edge = rates.clip_signs[k].gyro[j] == 0 && (before == 0) != (after == 0);
      const int sign = before + after;
      if (!at_edge || sign == ClipSigns::kMissingSign) continue;
      const std::size_t inside = before != 0 ? k - 1 : k + 1, outside = before != 0 ? k + 1 : k - 1;
      const auto axis = static_cast<Eigen::Index>(j);
      const PartialSaturation loss = partial_saturation(sign * along(k, axis), sign * along(outside, axis),
                                                        sign * along(inside, axis), noise_rad_s);
      if (!(loss.expected_saturation_deficit_rad_s > noise_rad_s)) continue;
      lost[k][axis] = sign * loss.expected_saturation_deficit_rad_s;
      rates.partial_saturation_sigma_rad_s[k][axis] = loss.sigma_rad_s;
    }
  }
  for (std::size_t k = 0; k < count; ++k) rates.samples[k].angular_velocity_rad_s += inverse * lost[k];
}

// Increases the standard deviation of rates recovered from saturation, because the errors of successive recovered rates
// are correlated: carried.md (C15).
void recovered_readings(const HandHeldSmoother::Params& params, const SensingAxisClipSigns& clipped,
                        GyroReadings& rates) {
  const double nodes = std::sqrt(2.0 * HandHeldSensorParams::kRecoveredTau_s / params.expert.node_s);
  for (std::size_t k = 0; k < clipped.recovered_covariance_rad2_s2.size(); ++k) {
    const Eigen::Matrix3d along =
        clipped.sensing_directions * clipped.recovered_covariance_rad2_s2[k] * clipped.sensing_directions.transpose();
    Vector3d& subsample_sigma_rad_s = rates.partial_saturation_sigma_rad_s[rates.reading_index_of_sample[k]];
    subsample_sigma_rad_s = subsample_sigma_rad_s.cwiseMax(nodes * along.diagonal().cwiseMax(0.0).cwiseSqrt());
  }
}

TimedReadings timed_readings(std::span<const ImuSample> samples, const SensingAxisClipSigns& clipped, Triad triad,
                             TimeNs origin_ns, double period_s) {
  std::optional<RepeatedReadings> repeated = find_repeated(samples, triad);
  if (repeated &&
      (repeated->regular_clock_fraction < kMinClockAgreement || repeated->period_s > sample_hold::kSlowest * period_s))
    repeated.reset();
  TimedReadings out;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    out.reading_index_of_sample.push_back(out.samples.size());
    if (repeated && repeated->repeats_per_sample[k]) {
      out.reading_index_of_sample.back() -= 1;
      continue;
    }
    ImuSample own = samples[k];
    if (repeated) own.time_ns -= nanoseconds(repeated->age_s[k]);
    // If the estimated clock is inaccurate, two successive readings may have equal times.
    if (repeated && !out.samples.empty())
      own.time_ns = std::max(own.time_ns, out.samples.back().time_ns + nanoseconds(0.5 * period_s));
    out.samples.push_back(own);
    out.clip_signs.push_back(clip_signs_of(clipped, k));
  }
  out.averaging_windows = averaging_windows_of(out.samples, origin_ns, repeated ? repeated->period_s : period_s);
  return out;
}

/// Returns the gyro's rates, with clipped readings replaced by a cubic polynomial. The cubic polynomial is limited to
/// values between 1 and kFillRatioMax times the saturation level.
std::vector<Vector3d> filled_rates(std::span<const ImuSample> samples, const SensingAxisClipSigns& clipped) {
  const std::size_t count = samples.size();
  std::vector<Vector3d> rates(count);
  for (std::size_t k = 0; k < count; ++k) rates[k] = clipped.sensing_directions * samples[k].angular_velocity_rad_s;
  std::vector<double> raw(count), filled;
  for (std::size_t j = 0; j < 3 && !clipped.clip_signs.empty(); ++j) {
    const auto axis = static_cast<Eigen::Index>(j);
    for (std::size_t k = 0; k < count; ++k) raw[k] = rates[k][axis];
    filled = raw;
    for (std::size_t begin = 0; begin < count;) {
      const ClippedSegment segment = clipped_segment(clipped.clip_signs, j, begin, raw);
      if (segment.saturated_side != 0)
        interpolate_segment(samples, raw, begin, segment.clipped_segment_end, segment.saturated_side, filled);
      begin = segment.clipped_segment_end;
    }
    for (std::size_t k = 0; k < count; ++k) rates[k][axis] = filled[k];
  }
  const Eigen::Matrix3d inverse = clipped.sensing_directions.inverse();
  for (Vector3d& rate : rates) rate = (inverse * rate).eval();
  return rates;
}

}  // namespace

bool clips(const NodeReadings& readings) {
  return std::any_of(readings.gyro.begin(), readings.gyro.end(), [](const SensingAxisSums& e) {
    return e.clipped_reading_count > 0.0 || e.unusable_reading_count > 0.0;
  });
}

void add_rate(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
              const Vector3d& subsample_sigma_rad_s, NodeReadings& node) {
  const Vector3d z = rows * sample.angular_velocity_rad_s;
  for (int j = 0; j < 3; ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    add_gyro_reading(z[j], t, signs.gyro[i], node.gyro[i]);
    node.gyro[i].partial_saturation_sigma = std::max(node.gyro[i].partial_saturation_sigma, subsample_sigma_rad_s[j]);
  }
}

void add_force(const ImuSample& sample, const ClipSigns& signs, double t, NodeReadings& node) {
  for (int j = 0; j < 3; ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    if (signs.accel[i] != 0) node.force_bound_m_s2[j] = signs.accel[i];
  }
  node.force_reading_count += 1.0;
  node.force_m_s2 += (sample.specific_force_m_s2 - node.force_m_s2) / node.force_reading_count;
  node.mean_force_time_s += (t - node.mean_force_time_s) / node.force_reading_count;
}

NodeData collect_node_data(const HandHeldSmoother::Params& params, std::span<const ImuSample> samples,
                           const SensingAxisClipSigns& clipped) {
  NodeData out;
  const double period_s = samples.size() < 2 ? params.expert.node_s : median_period_s(samples);
  const TimeNs origin_ns = samples.front().time_ns - nanoseconds(0.5 * period_s);
  out.samples = averaging_windows_of(samples, origin_ns, period_s);
  out.nodes.resize(static_cast<std::size_t>(std::llround(out.samples.window_centre_s.back() / params.expert.node_s)) +
                   1);
  assign_windows_to_nodes(params.expert.node_s, out.nodes.size(), out.samples);

  out.rates = {timed_readings(samples, clipped, Triad::gyro, origin_ns, period_s), {}};
  assign_windows_to_nodes(params.expert.node_s, out.nodes.size(), out.rates.averaging_windows);
  out.rates.partial_saturation_sigma_rad_s.assign(out.rates.samples.size(), Vector3d::Zero());
  const double noise_rad_s = params.gyro_noise_density / std::sqrt(out.rates.averaging_windows.period_s);
  if (out.rates.averaging_windows.period_s > kLongWindow * params.expert.node_s)
    correct_partial_saturation(noise_rad_s, clipped.sensing_directions, out.rates);
  recovered_readings(params, clipped, out.rates);
  out.jerk = estimate_jerk(out.rates, clipped.sensing_directions, noise_rad_s, params.expert.node_s, out.nodes.size());
  TimedReadings forces = timed_readings(samples, clipped, Triad::accelerometer, origin_ns, period_s);
  const std::vector<double> window_force_sigma_m_s2 = window_force_sigmas(forces, period_s);
  assign_windows_to_nodes(params.expert.node_s, out.nodes.size(), forces.averaging_windows);
  const auto from_node = [&](const AveragingWindows& windows, std::size_t k) {
    return windows.window_centre_s[k] - static_cast<double>(windows.node_of[k]) * params.expert.node_s;
  };
  for (std::size_t k = 0; k < out.rates.samples.size(); ++k) {
    const AveragingWindows& windows = out.rates.averaging_windows;
    add_rate(out.rates.samples[k], clipped.sensing_directions, out.rates.clip_signs[k], from_node(windows, k),
             out.rates.partial_saturation_sigma_rad_s[k], out.nodes[windows.node_of[k]]);
  }
  for (std::size_t k = 0; k < forces.samples.size(); ++k) {
    NodeReadings& node = out.nodes[forces.averaging_windows.node_of[k]];
    add_force(forces.samples[k], forces.clip_signs[k], from_node(forces.averaging_windows, k), node);
    node.force_timing_sigma_m_s2 = std::max(node.force_timing_sigma_m_s2, window_force_sigma_m_s2[k]);
  }
  const std::vector<bool> rest = RestDetector(params.expert.rest_detector).find(samples);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (rest[k]) out.nodes[out.samples.node_of[k]].is_stationary = true;
  }
  return out;
}

Status start_nodes(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows, const NodeData& collected,
                   std::vector<Node>& nodes) {
  const std::span<const ImuSample> samples = collected.rates.samples;
  const AveragingWindows& windows = collected.rates.averaging_windows;
  const std::vector<Vector3d> rates = filled_rates(samples, {rows, collected.rates.clip_signs});
  const Vqf filter(Vqf::Params{.gap_max_s = params.expert.gap_max_s});
  Vqf::State state;
  const std::size_t count = collected.nodes.size();
  nodes.assign(count, {});
  std::vector<double> readings(count, 0.0), nearest(count, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ImuSample sample = samples[k];
    sample.angular_velocity_rad_s = rates[k];
    if (const Status status = filter.step(sample, state); !status.ok()) return status;
    const std::size_t i = windows.node_of[k];
    readings[i] += 1.0;
    nodes[i].w_WI_I_rad_s += (rates[k] - nodes[i].w_WI_I_rad_s) / readings[i];
    const double off = std::abs(windows.window_centre_s[k] - static_cast<double>(i) * params.expert.node_s);
    if (off < nearest[i]) nearest[i] = off, nodes[i].q_WI = state.q_WI;
  }
  std::size_t before = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (!(readings[i] > 0.0)) continue;
    for (std::size_t m = before + 1; m < i; ++m) {
      const double u = static_cast<double>(m - before) / static_cast<double>(i - before);
      nodes[m].q_WI = nodes[before].q_WI.slerp(u, nodes[i].q_WI);
      nodes[m].w_WI_I_rad_s = (1.0 - u) * nodes[before].w_WI_I_rad_s + u * nodes[i].w_WI_I_rad_s;
    }
    before = i;
  }
  std::fill(nodes.begin() + static_cast<std::ptrdiff_t>(before) + 1, nodes.end(), nodes[before]);
  const Vector3d g_W(0.0, 0.0, -params.gravity_m_s2);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, count - 1);
    if (b > a) {
      nodes[i].angular_acceleration_rad_s2 =
          (nodes[b].w_WI_I_rad_s - nodes[a].w_WI_I_rad_s) / (static_cast<double>(b - a) * params.expert.node_s);
    }
    if (collected.nodes[i].force_reading_count > 0.0)
      nodes[i].a_W_m_s2 = nodes[i].q_WI * collected.nodes[i].force_m_s2 + g_W;
  }
  return {};
}

}  // namespace hand_held

}  // namespace tumble
