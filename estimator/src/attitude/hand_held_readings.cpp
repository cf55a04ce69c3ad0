// SPDX-License-Identifier: BSD-3-Clause
#include "hand_held_readings.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../angular_velocity/sample_hold.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/subsample_saturation.hpp"
#include "tumble/attitude/detail/vqf.hpp"

namespace tumble {

ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping) {
  const auto sign = [&](Triad triad, int axis) -> std::int8_t {
    switch (element_reading(sample, clipping, triad, axis)) {
      case ElementReading::measured:
        return 0;
      case ElementReading::clipped_high:
        return 1;
      case ElementReading::clipped_low:
        return -1;
      case ElementReading::unreadable:
        return ClipSigns::kMissing;
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
// In recordings of pendulums, averaging windows of 20 ms were partly saturated; windows of 10 ms of hand-held wands
// were not.
constexpr double kLongWindow = 1.5;

TimeNs nanoseconds(double s) {
  return static_cast<TimeNs>(std::llround(1e9 * s));
}

double median_step_or(std::span<const ImuSample> samples, double otherwise_s) {
  if (samples.size() < 2) return otherwise_s;
  std::vector<double> periods(samples.size() - 1);
  for (std::size_t k = 1; k < samples.size(); ++k) periods[k - 1] = since_s(samples, k - 1, k);
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

ClipSigns signs_of(const ClippedElements& clipped, std::size_t k) {
  return clipped.signs.empty() ? ClipSigns{} : clipped.signs[k];
}

void add_gyro_reading(double z, double t, int sign, ElementSums& e) {
  if (sign == ClipSigns::kMissing) {
    e.unusable_count += 1.0;
    e.unusable_mean += (z - e.unusable_mean) / e.unusable_count;
    return;
  }
  if (sign != 0) {
    e.clipped += 1.0;
    e.clipped_time_s += (t - e.clipped_time_s) / e.clipped;
    e.rail += (z - e.rail) / e.clipped;
    e.sign = sign;
    return;
  }
  e.count += 1.0;
  e.time_sum_s += t;
  e.time_squared_sum_s2 += t * t;
  e.reading_sum += z;
  e.reading_time_sum += z * t;
}

/// Replaces a clipped segment of one sensing element by a cubic.
void fill_segment(std::span<const ImuSample> samples, const std::vector<double>& raw, std::size_t begin,
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

struct HiddenSegment {
  std::size_t end = 0;
  int sign = 0;
};

HiddenSegment hidden_segment(std::span<const ClipSigns> signs, std::size_t element, std::size_t begin,
                             const std::vector<double>& raw) {
  HiddenSegment out{begin, 0};
  if (signs[begin].gyro[element] == 0) {
    while (out.end < signs.size() && signs[out.end].gyro[element] == 0) ++out.end;
    return out;
  }
  for (; out.end < signs.size(); ++out.end) {
    const int sign = signs[out.end].gyro[element];
    if (sign == 0 || (sign != ClipSigns::kMissing && out.sign != 0 && sign != out.sign)) break;
    if (sign != ClipSigns::kMissing) out.sign = sign;
  }
  // If all readings of a segment are unusable, the rate is assumed to be beyond the saturation level.
  if (out.sign == 0) out.sign = raw[begin == 0 ? begin : begin - 1] < 0.0 ? -1 : 1;
  return out;
}

// Averaging windows are `period_s` long even after a missing reading.
Windows windows_of(std::span<const ImuSample> samples, TimeNs origin_ns, double period_s) {
  Windows out;
  out.period_s = period_s;
  out.centre_s.resize(samples.size());
  out.end_s.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double window = k == 0 ? period_s : std::min(since_s(samples, k - 1, k), kLongest * period_s);
    out.end_s[k] = seconds(samples[k].time_ns - origin_ns);
    out.centre_s[k] = out.end_s[k] - 0.5 * window;
  }
  return out;
}

void place(double node_s, std::size_t nodes, Windows& windows) {
  windows.node_of.resize(windows.centre_s.size());
  for (std::size_t k = 0; k < windows.node_of.size(); ++k) {
    const auto node = static_cast<std::size_t>(std::llround(std::max(0.0, windows.centre_s[k]) / node_s));
    windows.node_of[k] = std::min(node, nodes - 1);
  }
}

// Returns the standard deviations of specific forces due to the unknown averaging time of a slow accelerometer:
// carried.md (C12).
std::vector<double> window_force_sigmas(TimedReadings& forces, double log_period_s) {
  const std::vector<ImuSample>& samples = forces.samples;
  std::vector<double> out(samples.size(), 0.0);
  if (!(forces.windows.period_s > log_period_s)) return out;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    forces.windows.centre_s[k] += 0.25 * forces.windows.period_s;
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
      const int before = rates.signs[k - 1].gyro[j], after = rates.signs[k + 1].gyro[j];
      const bool at_edge = rates.signs[k].gyro[j] == 0 && (before == 0) != (after == 0);
      const int sign = before + after;
      if (!at_edge || sign == ClipSigns::kMissing) continue;
      const std::size_t inside = before != 0 ? k - 1 : k + 1, outside = before != 0 ? k + 1 : k - 1;
      const auto axis = static_cast<Eigen::Index>(j);
      const SubsampleSaturation loss = subsample_saturation(sign * along(k, axis), sign * along(outside, axis),
                                                            sign * along(inside, axis), noise_rad_s);
      if (!(loss.expected_deficit_rad_s > noise_rad_s)) continue;
      lost[k][axis] = sign * loss.expected_deficit_rad_s;
      rates.subsample_sigma_rad_s[k][axis] = loss.sigma_rad_s;
    }
  }
  for (std::size_t k = 0; k < count; ++k) rates.samples[k].angular_velocity_rad_s += inverse * lost[k];
}

// Recovered rates have correlated errors: carried.md (C15).
void recovered_readings(const HandHeldSmoother::Params& params, const ClippedElements& clipped, GyroReadings& rates) {
  const double nodes = std::sqrt(2.0 * params.expert.readings.kRecoveredTau_s / params.expert.node_s);
  for (std::size_t k = 0; k < clipped.recovered_covariance_rad2_s2.size(); ++k) {
    const Eigen::Matrix3d along = clipped.rows * clipped.recovered_covariance_rad2_s2[k] * clipped.rows.transpose();
    Vector3d& subsample_sigma_rad_s = rates.subsample_sigma_rad_s[rates.of_sample[k]];
    subsample_sigma_rad_s = subsample_sigma_rad_s.cwiseMax(nodes * along.diagonal().cwiseMax(0.0).cwiseSqrt());
  }
}

TimedReadings timed_readings(std::span<const ImuSample> samples, const ClippedElements& clipped, Triad triad,
                             TimeNs origin_ns, double period_s) {
  std::optional<RepeatedReadings> repeated = find_repeated(samples, triad);
  if (repeated && (repeated->agreement < kMinClockAgreement || repeated->period_s > sample_hold::kSlowest * period_s))
    repeated.reset();
  TimedReadings out;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    out.of_sample.push_back(out.samples.size());
    if (repeated && repeated->repeats[k]) {
      out.of_sample.back() -= 1;
      continue;
    }
    ImuSample own = samples[k];
    if (repeated) own.time_ns -= nanoseconds(repeated->age_s[k]);
    // If the estimated clock is inaccurate, two readings may have the same time.
    if (repeated && !out.samples.empty())
      own.time_ns = std::max(own.time_ns, out.samples.back().time_ns + nanoseconds(0.5 * period_s));
    out.samples.push_back(own);
    out.signs.push_back(signs_of(clipped, k));
  }
  out.windows = windows_of(out.samples, origin_ns, repeated ? repeated->period_s : period_s);
  return out;
}

}  // namespace

bool clips(const NodeReadings& readings) {
  return std::any_of(readings.gyro.begin(), readings.gyro.end(),
                     [](const ElementSums& e) { return e.clipped > 0.0 || e.unusable_count > 0.0; });
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
    if (signs.accel[i] != 0) node.force_bound[j] = signs.accel[i];
  }
  node.force_count += 1.0;
  node.force_m_s2 += (sample.specific_force_m_s2 - node.force_m_s2) / node.force_count;
  node.force_time_s += (t - node.force_time_s) / node.force_count;
}

NodeData collect(const HandHeldSmoother::Params& params, std::span<const ImuSample> samples,
                 const ClippedElements& clipped) {
  NodeData out;
  const double period_s = median_step_or(samples, params.expert.node_s);
  const TimeNs origin_ns = samples.front().time_ns - nanoseconds(0.5 * period_s);
  out.samples = windows_of(samples, origin_ns, period_s);
  out.nodes.resize(static_cast<std::size_t>(std::llround(out.samples.centre_s.back() / params.expert.node_s)) + 1);
  place(params.expert.node_s, out.nodes.size(), out.samples);

  out.rates = {timed_readings(samples, clipped, Triad::gyro, origin_ns, period_s), {}};
  place(params.expert.node_s, out.nodes.size(), out.rates.windows);
  out.rates.subsample_sigma_rad_s.assign(out.rates.samples.size(), Vector3d::Zero());
  const double noise_rad_s = params.gyro_noise_density / std::sqrt(out.rates.windows.period_s);
  if (out.rates.windows.period_s > kLongWindow * params.expert.node_s)
    correct_partial_saturation(noise_rad_s, clipped.rows, out.rates);
  recovered_readings(params, clipped, out.rates);
  out.jerk = estimate_jerk(out.rates, clipped.rows, noise_rad_s, params.expert.node_s, out.nodes.size());
  TimedReadings forces = timed_readings(samples, clipped, Triad::accelerometer, origin_ns, period_s);
  const std::vector<double> window_force_sigma_m_s2 = window_force_sigmas(forces, period_s);
  place(params.expert.node_s, out.nodes.size(), forces.windows);
  const auto from_node = [&](const Windows& windows, std::size_t k) {
    return windows.centre_s[k] - static_cast<double>(windows.node_of[k]) * params.expert.node_s;
  };
  for (std::size_t k = 0; k < out.rates.samples.size(); ++k) {
    const Windows& windows = out.rates.windows;
    add_rate(out.rates.samples[k], clipped.rows, out.rates.signs[k], from_node(windows, k),
             out.rates.subsample_sigma_rad_s[k], out.nodes[windows.node_of[k]]);
  }
  for (std::size_t k = 0; k < forces.samples.size(); ++k) {
    NodeReadings& node = out.nodes[forces.windows.node_of[k]];
    add_force(forces.samples[k], forces.signs[k], from_node(forces.windows, k), node);
    node.force_timing_sigma_m_s2 = std::max(node.force_timing_sigma_m_s2, window_force_sigma_m_s2[k]);
  }
  const std::vector<bool> rest = RestDetector(params.expert.rest).find(samples);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (rest[k]) out.nodes[out.samples.node_of[k]].rest = true;
  }
  return out;
}

std::vector<Vector3d> filled_rates(std::span<const ImuSample> samples, const ClippedElements& clipped) {
  const std::size_t count = samples.size();
  std::vector<Vector3d> rates(count);
  for (std::size_t k = 0; k < count; ++k) rates[k] = clipped.rows * samples[k].angular_velocity_rad_s;
  std::vector<double> raw(count), filled;
  for (std::size_t j = 0; j < 3 && !clipped.signs.empty(); ++j) {
    const auto axis = static_cast<Eigen::Index>(j);
    for (std::size_t k = 0; k < count; ++k) raw[k] = rates[k][axis];
    filled = raw;
    for (std::size_t begin = 0; begin < count;) {
      const HiddenSegment segment = hidden_segment(clipped.signs, j, begin, raw);
      if (segment.sign != 0) fill_segment(samples, raw, begin, segment.end, segment.sign, filled);
      begin = segment.end;
    }
    for (std::size_t k = 0; k < count; ++k) rates[k][axis] = filled[k];
  }
  const Eigen::Matrix3d inverse = clipped.rows.inverse();
  for (Vector3d& rate : rates) rate = (inverse * rate).eval();
  return rates;
}

Status start_nodes(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows, const NodeData& collected,
                   std::vector<Node>& nodes) {
  const std::span<const ImuSample> samples = collected.rates.samples;
  const Windows& windows = collected.rates.windows;
  const std::vector<Vector3d> rates = filled_rates(samples, {rows, collected.rates.signs});
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
    const double off = std::abs(windows.centre_s[k] - static_cast<double>(i) * params.expert.node_s);
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
    if (collected.nodes[i].force_count > 0.0) nodes[i].a_W_m_s2 = nodes[i].q_WI * collected.nodes[i].force_m_s2 + g_W;
  }
  return {};
}

}  // namespace hand_held

}  // namespace tumble
