// SPDX-License-Identifier: BSD-3-Clause
#include "tools/replay/parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "scenarios/scoring/clipping.hpp"

namespace tumble::tools {

namespace {

using Eigen::Vector3f;

constexpr std::uint8_t kGyroFlags = 7;

std::vector<std::size_t> kept_samples(const sim::ImuRecord& imu, std::size_t most) {
  const std::size_t count = std::min(imu.time_ns.size(), imu.gyro_rad_s.size());
  const std::size_t run = most == 0 ? count : (count + most - 1) / most;
  std::vector<std::size_t> kept;
  for (std::size_t first = 0; first < count; first += run) {
    std::size_t fastest = first;
    for (std::size_t k = first; k < std::min(count, first + run); ++k) {
      if (imu.gyro_rad_s[k].squaredNorm() > imu.gyro_rad_s[fastest].squaredNorm()) fastest = k;
    }
    kept.push_back(fastest);
  }
  return kept;
}

bool truth_tells_clipping(const sim::Sensors& sensors, const sim::Truth* truth) {
  if (truth == nullptr || truth->imus.empty()) return false;
  return truth->imus.front().rate_rad_s.size() == sensors.imus.front().time_ns.size();
}

std::size_t nearest(const std::vector<AngularRateState>& rates, std::int64_t time_ns) {
  const auto after = std::lower_bound(rates.begin(), rates.end(), time_ns,
                                      [](const AngularRateState& rate, std::int64_t t) { return rate.time_ns < t; });
  const auto at = static_cast<std::size_t>(after - rates.begin());
  if (at == rates.size()) return at - 1;
  return at > 0 && time_ns - rates[at - 1].time_ns < rates[at].time_ns - time_ns ? at - 1 : at;
}

void mark_clipping(const sim::Sensors& sensors, const sim::Truth* truth, const std::vector<ReplayEstimate>& estimates,
                   const std::vector<std::size_t>& kept, ReplayStrip& strip) {
  const sim::ImuRecord& imu = sensors.imus.front();
  strip.clipped_axes.assign(kept.size(), 0);
  if (truth_tells_clipping(sensors, truth)) {
    const scenarios::ClippingTruth clipping(sensors, *truth);
    for (std::size_t k = 0; k < kept.size(); ++k)
      strip.clipped_axes[k] = clipping.known(kept[k]) ? clipping.clipped_axes(kept[k]) : 0;
    strip.clipping = "the truth";
    return;
  }
  if (imu.clip_flags.size() == imu.time_ns.size() &&
      std::any_of(imu.clip_flags.begin(), imu.clip_flags.end(), [](std::uint8_t f) { return (f & kGyroFlags) != 0; })) {
    for (std::size_t k = 0; k < kept.size(); ++k) strip.clipped_axes[k] = imu.clip_flags[kept[k]] & kGyroFlags;
    strip.clipping = "the device";
    return;
  }
  for (const ReplayEstimate& given : estimates) {
    const std::vector<AngularRateState>& rates = given.estimate->rates;
    if (rates.empty()) continue;
    for (std::size_t k = 0; k < kept.size(); ++k)
      strip.clipped_axes[k] = rates[nearest(rates, strip.time_ns[k])].clipped_axes & kGyroFlags;
    strip.clipping = given.name;
    return;
  }
}

/// For a rig, only contact is shown, because slip and slide are defined for spheres.
std::vector<ContactSpan> contact_spans(const sim::Sensors& sensors, const sim::Truth& truth) {
  std::vector<ContactSpan> spans;
  const auto label_at = [&](std::size_t k) {
    const sim::ContactLabel label = truth.label[k];
    return label == sim::ContactLabel::air || sensors.sphere_radius_m > 0.0 ? label : sim::ContactLabel::grip;
  };
  for (std::size_t k = 0; k < truth.label.size(); ++k) {
    const std::int64_t time_ns = static_cast<std::int64_t>(k) * truth.period_ns;
    const sim::ContactLabel label = label_at(k);
    if (label == sim::ContactLabel::air) continue;
    if (k > 0 && label_at(k - 1) == label && !spans.empty()) {
      spans.back().end_ns = time_ns + truth.period_ns;
    } else {
      spans.push_back({time_ns, time_ns + truth.period_ns, label});
    }
  }
  return spans;
}

}  // namespace

ReplayStrip strip_of(const sim::Sensors& sensors, const sim::Truth* truth, const std::vector<ReplayEstimate>& estimates,
                     std::size_t most) {
  ReplayStrip strip;
  if (truth != nullptr && !truth->label.empty()) {
    strip.contacts = contact_spans(sensors, *truth);
    strip.contacts_known = true;
  }
  if (sensors.imus.empty()) return strip;
  const sim::ImuRecord& imu = sensors.imus.front();
  strip.of = imu.time_ns.size();
  const std::vector<std::size_t> kept = kept_samples(imu, most);
  for (const std::size_t k : kept) {
    strip.time_ns.push_back(imu.time_ns[k]);
    strip.gyro_rad_s.push_back(imu.gyro_rad_s[k].cast<float>());
  }
  mark_clipping(sensors, truth, estimates, kept, strip);
  return strip;
}

std::vector<Vector3f> true_rates(const ReplayStrip& strip, const sim::Sensors& sensors, const sim::Truth& truth) {
  std::vector<Vector3f> out;
  if (sensors.imus.empty() || !truth_tells_clipping(sensors, &truth)) return out;
  const sim::ImuRecord& imu = sensors.imus.front();
  std::size_t at = 0;
  for (const std::int64_t time_ns : strip.time_ns) {
    while (at + 1 < imu.time_ns.size() && imu.time_ns[at] < time_ns) ++at;
    out.push_back(truth.imus.front().rate_rad_s[at].cast<float>());
  }
  return out;
}

std::vector<Vector3f> estimated_rates(const ReplayStrip& strip, const sim::Sensors& sensors,
                                      const scenarios::Estimate& estimate) {
  std::vector<Vector3f> out;
  if (estimate.rates.empty() || sensors.imus.empty()) return out;
  const std::int64_t period_ns = std::max<std::int64_t>(sensors.imus.front().period_ns, 1);
  for (const std::int64_t time_ns : strip.time_ns) {
    const AngularRateState& rate = estimate.rates[nearest(estimate.rates, time_ns)];
    const bool there = std::abs(rate.time_ns - time_ns) <= period_ns;
    out.push_back(there ? rate.w_WI_I_rad_s.cast<float>()
                        : Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()).eval());
  }
  return out;
}

}  // namespace tumble::tools
