// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/carried.hpp"

#include <array>
#include <optional>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"

namespace tumble::scenarios {

std::span<const sim::Parameter> carried_parameters() {
  static const CarriedSmoother::Params library;
  static const std::array<sim::Parameter, 16> parameters = {{
      {"node_s", library.node_s, 1e-3, 0.1, "s", "between two nodes of the smoother"},
      {"accel_noise_m_s2_sqrt_hz", library.accel_noise_density, 1e-5, 10.0, "m/s^2/sqrt(Hz)",
       "of the specific force, unmodelled errors included"},
      {"tilt_share", library.tilt_share, 0.0, 1.0, "1", "error of a free element per excess of a clipped one"},
      {"jerk_rad_s3_sqrts", library.jerk_rad_s3_sqrts, 1e-2, 1e6, "rad/s^3 sqrt(s)",
       "root density of the angular jerk"},
      {"jerk_doubt", library.jerk_doubt, 1.0, 100.0, "1", "by how much more covariances are those of"},
      {"iterations_max", static_cast<double>(library.iterations_max), 1.0, 1000.0, "1", "steps of Gauss-Newton"},
      {"turn_error_sqrts", library.turn_error_sqrts, 0.0, 1.0, "sqrt(s)", "angle random walk per rad/s turned: scale"},
      {"hand_m_s2", library.hand_m_s2, 1e-3, 1e3, "m/s^2", "deviation of the carried point's acceleration"},
      {"hand_tau_s", library.hand_tau_s, 1e-3, 10.0, "s", "its memory"},
      {"hand_follow", library.hand_follow, 0.0, 1.0, "1", "how far it follows the motion's own power"},
      {"velocity_m_s", library.velocity_m_s, 1e-3, 1e3, "m/s", "deviation of the carried point's velocity"},
      {"place_m", library.place_m, 1e-3, 1e3, "m", "deviation of the carried point's place"},
      {"gyro_bias_sigma_rad_s", library.gyro_bias_sigma_rad_s, 1e-6, 10.0, "rad/s", "prior of the gyro's bias"},
      {"accel_bias_sigma_m_s2", library.accel_bias_sigma_m_s2, 1e-6, 10.0, "m/s^2",
       "prior of the accelerometer's bias"},
      {"lever_arm_sigma_m", library.lever_arm_sigma_m, 1e-6, 10.0, "m", "prior of the way from the carried point"},
      {"recovered_sigma_rad_s", library.recovered_sigma_rad_s, 0.0, 1e4, "rad/s",
       "a clipped rate known better than this is recovered, not only bounded"},
  }};
  return parameters;
}

ClippedElements find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::vector<ClipSigns>& signs) {
  ClippingFinder::Params params;
  params.walls = stated_rails(record);
  const ClippingFinder::Found found = ClippingFinder(params).find(samples);
  const RailPlanes& planes = found.rails.planes;
  signs.assign(samples.size(), {});
  for (std::size_t k = 0; k < samples.size(); ++k) signs[k] = clip_signs(samples[k], found.clippings[k]);
  ClippedElements out;
  out.signs = signs;
  for (int j = 0; j < 3; ++j) {
    const std::optional<RailPlane>& plane = planes.element[static_cast<std::size_t>(j)];
    if (plane) out.rows.row(j) = plane->row.transpose();
  }
  return out;
}

Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters, std::vector<RateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health) {
  std::vector<ImuSample> samples;
  if (const Status status = bridge::primary_imu_samples(sensors, samples); !status.ok()) return status;
  CarriedSmoother::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  params.gap_max_s = bridge::kGapMaxS;
  params.node_s = parameters.at("node_s");
  params.accel_noise_density = parameters.at("accel_noise_m_s2_sqrt_hz");
  params.tilt_share = parameters.at("tilt_share");
  params.jerk_rad_s3_sqrts = parameters.at("jerk_rad_s3_sqrts");
  params.jerk_doubt = parameters.at("jerk_doubt");
  params.iterations_max = static_cast<int>(parameters.at("iterations_max"));
  params.turn_error_sqrts = parameters.at("turn_error_sqrts");
  params.hand_m_s2 = parameters.at("hand_m_s2");
  params.hand_tau_s = parameters.at("hand_tau_s");
  params.hand_follow = parameters.at("hand_follow");
  params.velocity_m_s = parameters.at("velocity_m_s");
  params.place_m = parameters.at("place_m");
  params.gyro_bias_sigma_rad_s = parameters.at("gyro_bias_sigma_rad_s");
  params.accel_bias_sigma_m_s2 = parameters.at("accel_bias_sigma_m_s2");
  params.lever_arm_sigma_m = parameters.at("lever_arm_sigma_m");
  params.recovered_sigma_rad_s = parameters.at("recovered_sigma_rad_s");
  std::vector<ClipSigns> signs;
  const ClippedElements clipped = find_clipped(sensors.imus.front(), samples, signs);
  CarriedSmoother::Report report;
  const Status status = CarriedSmoother(params).estimate(samples, clipped, rates, attitudes, report);
  if (!status.ok()) return status;
  health["iterations"] = report.iterations;
  health["converged"] = report.converged ? 1.0 : 0.0;
  health["hand_surprise"] = report.hand_surprise;
  health["turns_asked"] = report.turns_asked;
  health["turns_taken"] = report.turns_taken;
  health["turns_open"] = report.turns_open;
  return status;
}

}  // namespace tumble::scenarios
