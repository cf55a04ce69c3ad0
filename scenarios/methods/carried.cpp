// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/carried.hpp"

#include <optional>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/near_rails.hpp"

namespace tumble::scenarios {

const Settings<CarriedSmoother::Params>& carried_settings() {
  static const Settings<CarriedSmoother::Params> all(CarriedSmoother::Params{}, {.stated = {"gravity_m_s2"}});
  return all;
}

ClippedElements find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::vector<ClipSigns>& signs, std::vector<std::uint8_t>* near) {
  ClippingFinder::Params params;
  params.walls = stated_rails(record);
  const ClippingFinder::Found found = ClippingFinder(params).find(samples);
  const RailPlanes& planes = found.rails.planes;
  signs.assign(samples.size(), {});
  for (std::size_t k = 0; k < samples.size(); ++k) signs[k] = clip_signs(samples[k], found.clippings[k]);
  if (near != nullptr)
    *near = may_meet_rails(samples, found.rails.upright ? RailPlanes{} : found.rails.planes_in_use());
  ClippedElements out;
  out.signs = signs;
  for (int j = 0; j < 3; ++j) {
    const std::optional<RailPlane>& plane = planes.element[static_cast<std::size_t>(j)];
    if (plane) out.rows.row(j) = plane->row.transpose();
  }
  return out;
}

Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters,
                   std::span<const std::uint8_t> doubted_axes, std::vector<RateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health) {
  std::vector<ImuSample> samples;
  if (const Status status = bridge::primary_imu_samples(sensors, samples); !status.ok()) return status;
  CarriedSmoother::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  carried_settings().apply(parameters, params);
  std::vector<ClipSigns> signs;
  std::vector<std::uint8_t> near;
  const ClippedElements clipped = find_clipped(sensors.imus.front(), samples, signs, &near);
  for (std::size_t k = 0; k < doubted_axes.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      std::int8_t& sign = signs[k].gyro[static_cast<std::size_t>(j)];
      if ((doubted_axes[k] >> j & 1u) != 0 && sign == 0) sign = samples[k].angular_velocity_rad_s[j] < 0.0 ? -1 : 1;
    }
  }
  CarriedSmoother::Report report;
  const Status status = CarriedSmoother(params).estimate(samples, clipped, rates, attitudes, report);
  if (!status.ok()) return status;
  for (std::size_t k = 0; k < rates.size(); ++k) {
    if (near[k] != 0 && rates[k].source == RateSource::measured) rates[k].source = RateSource::bounded_only;
  }
  health["iterations"] = report.iterations;
  health["converged"] = report.converged ? 1.0 : 0.0;
  health["hand_surprise"] = report.hand_surprise;
  health["turns_asked"] = report.turns_asked;
  health["turns_taken"] = report.turns_taken;
  health["turns_open"] = report.turns_open;
  health["turns_failed"] = report.turns_failed;
  return status;
}

}  // namespace tumble::scenarios
