// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "carried_problem.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/attitude/vqf.hpp"

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
        return ClipSigns::kVoid;
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

namespace carried {

using Eigen::Vector3d;

namespace {

double since_s(std::span<const ImuSample> samples, std::size_t from, std::size_t to) {
  return seconds(samples[to].time_ns - samples[from].time_ns);
}

double median_period_s(std::span<const ImuSample> samples, double otherwise_s) {
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
  if (sign == ClipSigns::kVoid) {
    e.unread += 1.0;
    e.unread_z += (z - e.unread_z) / e.unread;
    return;
  }
  if (sign != 0) {
    e.clipped += 1.0;
    e.clipped_t_s += (t - e.clipped_t_s) / e.clipped;
    e.rail += (z - e.rail) / e.clipped;
    e.sign = sign;
    return;
  }
  e.n += 1.0;
  e.t_s += t;
  e.tt_s2 += t * t;
  e.z += z;
  e.zt += z * t;
}

/// The clipped stretch [begin, end) of one element, whose readings are `raw`.
void fill_stretch(std::span<const ImuSample> samples, const std::vector<double>& raw, std::size_t begin,
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
    filled[i] = sign * std::clamp(sign * value, rail, kFillMost * rail);
  }
}

/// From `begin` on: as long as an element stands at one rail, readings that say nothing among them, or as long as it is
/// free (sign 0).
struct HiddenStretch {
  std::size_t end = 0;
  int sign = 0;
};

HiddenStretch hidden_stretch(std::span<const ClipSigns> signs, std::size_t element, std::size_t begin,
                             const std::vector<double>& raw) {
  HiddenStretch out{begin, 0};
  if (signs[begin].gyro[element] == 0) {
    while (out.end < signs.size() && signs[out.end].gyro[element] == 0) ++out.end;
    return out;
  }
  for (; out.end < signs.size(); ++out.end) {
    const int sign = signs[out.end].gyro[element];
    if (sign == 0 || (sign != ClipSigns::kVoid && out.sign != 0 && sign != out.sign)) break;
    if (sign != ClipSigns::kVoid) out.sign = sign;
  }
  // none but unreadable ones: beyond the rail on the side from which it came
  if (out.sign == 0) out.sign = raw[begin == 0 ? begin : begin - 1] < 0.0 ? -1 : 1;
  return out;
}

}  // namespace

bool clips(const NodeReadings& readings) {
  return std::any_of(readings.gyro.begin(), readings.gyro.end(),
                     [](const ElementSums& e) { return e.clipped > 0.0 || e.unread > 0.0; });
}

void add_reading(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
                 NodeReadings& node) {
  const Vector3d z = rows * sample.angular_velocity_rad_s;
  for (int j = 0; j < 3; ++j) {
    const std::size_t i = static_cast<std::size_t>(j);
    add_gyro_reading(z[j], t, signs.gyro[i], node.gyro[i]);
    if (signs.accel[i] != 0) node.force_bound[j] = signs.accel[i];
  }
  node.force_n += 1.0;
  node.force_m_s2 += (sample.specific_force_m_s2 - node.force_m_s2) / node.force_n;
  node.force_t_s += (t - node.force_t_s) / node.force_n;
}

Collected collect(const CarriedSmoother::Params& params, std::span<const ImuSample> samples,
                  const ClippedElements& clipped) {
  Collected out;
  out.period_s = median_period_s(samples, params.node_s);
  const std::size_t count = samples.size();
  out.centre_s.resize(count);
  out.end_s.resize(count);
  out.node_of.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    // a window after a drop-out is as long as any other
    const double window = k == 0 ? out.period_s : std::min(since_s(samples, k - 1, k), 1.5 * out.period_s);
    out.end_s[k] = since_s(samples, 0, k) + 0.5 * out.period_s;
    out.centre_s[k] = out.end_s[k] - 0.5 * window;
  }
  out.nodes.resize(static_cast<std::size_t>(std::llround(out.centre_s.back() / params.node_s)) + 1);
  const std::vector<bool> rest = RestDetector(params.rest).find(samples);
  for (std::size_t k = 0; k < count; ++k) {
    const auto node = static_cast<std::size_t>(std::llround(out.centre_s[k] / params.node_s));
    out.node_of[k] = std::min(node, out.nodes.size() - 1);
    NodeReadings& readings = out.nodes[out.node_of[k]];
    const double t = out.centre_s[k] - static_cast<double>(out.node_of[k]) * params.node_s;
    add_reading(samples[k], clipped.rows, signs_of(clipped, k), t, readings);
    readings.rest = readings.rest || rest[k];
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
      const HiddenStretch stretch = hidden_stretch(clipped.signs, j, begin, raw);
      if (stretch.sign != 0) fill_stretch(samples, raw, begin, stretch.end, stretch.sign, filled);
      begin = stretch.end;
    }
    for (std::size_t k = 0; k < count; ++k) rates[k][axis] = filled[k];
  }
  const Eigen::Matrix3d inverse = clipped.rows.inverse();
  for (Vector3d& rate : rates) rate = (inverse * rate).eval();
  return rates;
}

Status start_nodes(const CarriedSmoother::Params& params, std::span<const ImuSample> samples,
                   const ClippedElements& clipped, const Collected& collected, std::vector<Node>& nodes) {
  const std::vector<Vector3d> rates = filled_rates(samples, clipped);
  const Vqf filter(Vqf::Params{.gap_max_s = params.gap_max_s});
  Vqf::State state;
  const std::size_t count = collected.nodes.size();
  nodes.assign(count, {});
  std::vector<double> readings(count, 0.0), nearest(count, std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ImuSample sample = samples[k];
    sample.angular_velocity_rad_s = rates[k];
    if (const Status status = filter.step(sample, state); !status.ok()) return status;
    const std::size_t i = collected.node_of[k];
    readings[i] += 1.0;
    nodes[i].w_WI_I_rad_s += (rates[k] - nodes[i].w_WI_I_rad_s) / readings[i];
    const double off = std::abs(collected.centre_s[k] - static_cast<double>(i) * params.node_s);
    if (off < nearest[i]) nearest[i] = off, nodes[i].q_WI = state.q_WI;
  }
  // the first and the last node have a sample; those without lie between two that have
  for (std::size_t i = 1, before = 0; i < count; ++i) {
    if (!(readings[i] > 0.0)) continue;
    for (std::size_t m = before + 1; m < i; ++m) {
      const double u = static_cast<double>(m - before) / static_cast<double>(i - before);
      nodes[m].q_WI = nodes[before].q_WI.slerp(u, nodes[i].q_WI);
      nodes[m].w_WI_I_rad_s = (1.0 - u) * nodes[before].w_WI_I_rad_s + u * nodes[i].w_WI_I_rad_s;
    }
    before = i;
  }
  const Vector3d g_W(0.0, 0.0, -params.gravity_m_s2);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1, b = std::min(i + 1, count - 1);
    if (b > a) {
      nodes[i].angular_acceleration_rad_s2 =
          (nodes[b].w_WI_I_rad_s - nodes[a].w_WI_I_rad_s) / (static_cast<double>(b - a) * params.node_s);
    }
    if (readings[i] > 0.0) nodes[i].a_W_m_s2 = nodes[i].q_WI * collected.nodes[i].force_m_s2 + g_W;
  }
  return {};
}

}  // namespace carried

}  // namespace tumble
