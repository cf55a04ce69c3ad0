// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/report_rails.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace tumble::scenarios {

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

void report_level(std::size_t j, double level_rad_s, std::map<std::string, double>& health) {
  health[std::string("learnt_gyro_rail_") + kAxes[j] + "_rad_s"] = level_rad_s;
}

void report_plane(std::size_t j, const RailPlane& plane, std::map<std::string, double>& health) {
  const std::string axis = kAxes[j], begin = "gyro_rail_";
  const auto sigma = [&plane](Eigen::Index i) { return std::sqrt(plane.covariance(i, i)); };
  health[begin + "samples_" + axis] = plane.samples[0] + plane.samples[1];
  health[begin + "samples_low_" + axis] = plane.samples[0];
  health[begin + "samples_high_" + axis] = plane.samples[1];
  health[begin + "deviation_" + axis + "_rad_s"] = plane.deviation_rad_s;
  health[begin + "log_odds_" + axis] = plane.log_odds;
  for (std::size_t i = 1; i < 3; ++i) {
    const std::size_t along = (j + i) % 3;
    const std::string pair = axis + "_" + kAxes[along];
    health[begin + "slope_" + pair] = plane.row[static_cast<Eigen::Index>(along)];
    health[begin + "slope_sigma_" + pair] = sigma(static_cast<Eigen::Index>(i - 1));
  }
  // The offset of a tilted plane of saturated readings requires readings at its limits of both signs.
  if (!plane.seen(-1) || !plane.seen(1)) return;
  health[begin + "offset_" + axis + "_rad_s"] = plane.offset_rad_s;
  health[begin + "offset_sigma_" + axis + "_rad_s"] = sigma(3);
}

}  // namespace

void report_rails(const SaturationLevels& rails, std::map<std::string, double>& health) {
  const RailPlanes in_use = rails.planes_in_use();
  for (std::size_t j = 0; j < 3; ++j) {
    const double level_rad_s = rails.axis_aligned_rails.channels[j].rail;
    if (in_use.element[j]) {
      report_level(j, in_use.element[j]->distance_rad_s, health);
    } else if (level_rad_s > 0.0) {
      report_level(j, level_rad_s, health);
    }
    if (rails.planes.element[j]) report_plane(j, *rails.planes.element[j], health);
  }
}

void report_rails(const RateReport& report, std::map<std::string, double>& health) {
  for (std::size_t j = 0; j < 3; ++j) {
    if (report.rail_observed[j]) report_level(j, *report.rail[j], health);
    if (report.planes.element[j]) report_plane(j, *report.planes.element[j], health);
  }
}

}  // namespace tumble::scenarios
