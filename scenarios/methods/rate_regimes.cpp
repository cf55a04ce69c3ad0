// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_regimes.hpp"

#include <algorithm>
#include <cstddef>

#include "scenarios/methods/carried.hpp"
#include "tumble/attitude/regimes.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kMatters = 0.02;  // a share of the carried body below this changes nothing worth a run
constexpr double kNear_s = 0.1;    // clipped samples so close belong to one stretch, and what is so close about it

/// Whether a reading is clipped or doubted; one that only may have met its rail in a part of its window is read.
bool unread(const RateReport& report, const RateState& rate, std::size_t k) {
  return rate.clipped_axes != 0 || report.doubted_axes[k] != 0;
}

/// Probability that the body was carried throughout the stretch of clipped or doubted samples that a sample lies in or
/// near to; 0 away from all. Where a stretch begins in a hand and ends in flight, the flight tells its rate.
std::vector<double> carried_stretches(std::span<const RegimeShares> shares, const RateReport& report,
                                      std::span<const RateState> rates) {
  std::vector<double> out(rates.size(), 0.0);
  const TimeNs near_ns = static_cast<TimeNs>(1e9 * kNear_s);
  for (std::size_t k = 0; k < rates.size();) {
    if (!unread(report, rates[k], k)) {
      ++k;
      continue;
    }
    std::size_t first = k, last = k;
    double least = 1.0;
    for (; k < rates.size() && rates[k].time_ns <= rates[last].time_ns + near_ns; ++k)
      if (unread(report, rates[k], k)) last = k;
    for (std::size_t i = first; i <= last; ++i) least = std::min(least, shares[i].carried);
    const TimeNs from_ns = rates[first].time_ns - near_ns, to_ns = rates[last].time_ns + near_ns;
    while (first > 0 && rates[first - 1].time_ns >= from_ns) --first;
    for (std::size_t i = first; i < rates.size() && rates[i].time_ns <= to_ns; ++i) out[i] = std::max(out[i], least);
  }
  return out;
}

}  // namespace

void join_regimes(const sim::Sensors& sensors, std::span<const ImuSample> samples, const RateReport& report,
                  std::vector<RateState>& rates, std::map<std::string, double>& health) {
  RegimeEvidence::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  const RigCalibration& rig = report.calibration;
  const Eigen::Matrix3d lever_covariance = rig.covariance.topLeftCorner<3, 3>();
  std::vector<RegimeShares> shares;
  const RegimeEvidence evidence(params);
  if (!evidence.find(samples, rates, rig.constants.lever_arm_m, lever_covariance, shares).ok()) return;
  const double each = 1.0 / static_cast<double>(shares.size());
  double flight = 0.0, contact = 0.0, carried = 0.0;
  for (const RegimeShares& share : shares) {
    flight += each * share.flight;
    contact += each * share.contact;
    carried += each * share.carried;
  }
  health["regime_flight_share"] = flight;
  health["regime_contact_share"] = contact;
  health["regime_carried_share"] = carried;
  const std::vector<double> by_stretch = carried_stretches(shares, report, rates);
  const double clipped = *std::max_element(by_stretch.begin(), by_stretch.end());
  health["regime_carried_clipped_max"] = clipped;
  health["regime_carried_asked"] = 0.0;
  if (clipped < kMatters) return;

  std::vector<RateState> other;
  std::vector<AttitudeState> attitudes;
  std::map<std::string, double> of_carried;
  const SettingsTable* const stages[] = {&carried_settings()};
  const sim::Values parameters = resolve_settings("rate/carried", {}, stages);
  if (!run_carried(sensors, parameters, report.doubted_axes, other, attitudes, of_carried).ok()) return;
  health["regime_carried_asked"] = 1.0;
  for (const auto& [name, value] : of_carried) health["carried_" + name] = value;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (by_stretch[k] <= kMatters) continue;
    const bool only_doubted = rates[k].clipped_axes == 0 && rates[k].source != RateSource::measured;
    rates[k] = either(rates[k], other[k], by_stretch[k]);
    // no clipping was found there, whoever holds the body
    if (only_doubted) rates[k].clipped_axes = 0, rates[k].source = RateSource::bounded_only;
  }
}

}  // namespace tumble::scenarios
