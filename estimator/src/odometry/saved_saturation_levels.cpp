// SPDX-License-Identifier: BSD-3-Clause
#include "saved_saturation_levels.hpp"

#include <utility>

namespace tumble::odometry {

namespace {

template <class Visit, class Rails>
void visit_saturation_levels(Visit& visit, Rails& rails) {
  constexpr double kLimitMax = 1e6, kCountMax = 1e9, kSlopeMax = 1.0;
  for (auto& channel : rails.axis_limit_state.channels)
    visit("saturation limit", channel.plateau_limit, 0.0, kLimitMax);
  for (auto* const planes : {&rails.gyro_planes, &rails.accel_saturation_planes}) {
    for (auto& plane : planes->sensing_axis) {
      if (!visit.presence_flag("saturation plane", plane)) continue;
      visit("plane.row", plane->row, -kSlopeMax, kSlopeMax);
      visit("plane.distance_rad_s", plane->saturation_limit_rad_s, 0.0, kLimitMax);
      visit("plane.offset_rad_s", plane->offset_rad_s, -kLimitMax, kLimitMax);
      visit("plane.covariance", plane->covariance, -kVarianceMax, kVarianceMax);
      for (auto& count : plane->samples) visit("plane.samples", count, 0.0, kCountMax);
      for (auto& count : plane->segments) visit("plane.segments", count, 0.0, kCountMax);
      visit("plane.deviation_rad_s", plane->deviation_rad_s, 0.0, kLimitMax);
      visit("plane.tolerance_rad_s", plane->tolerance_rad_s, 0.0, kLimitMax);
      visit("plane.log_odds", plane->log_odds);
    }
  }
}

}  // namespace

/// If a sensor clips after misalignment compensation, each output has a fixed saturation limit, and saturation planes
/// (SaturationPlane) are not needed.
void write_saturation_levels(const SaturationLevels& rails, SavedStateWriter& out) {
  SaturationLevels kept = rails;
  if (rails.gyro_clips_after_compensation) kept.gyro_planes = {};
  if (rails.accel_clips_after_compensation) kept.accel_saturation_planes = {};
  visit_saturation_levels(out, std::as_const(kept));
}

void read_saturation_levels(SavedStateReader& in, SaturationLevels& rails) {
  visit_saturation_levels(in, rails);
  for (const SaturationPlanes* const planes : {&rails.gyro_planes, &rails.accel_saturation_planes}) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::optional<SaturationPlane>& plane = planes->sensing_axis[j];
      if (!plane || !in.status().ok()) continue;
      const double own = plane->row[static_cast<Eigen::Index>(j)];
      in.require_condition("plane.row", own == 1.0, own, 1.0);
      in.require_covariance("plane.covariance", plane->covariance);
    }
  }
}

void start_from_saturation_levels(const SaturationLevels& rails, SaturationLimitDetector::Params& detector,
                                  SaturationPlaneFinder::Params& gyro, SaturationPlaneFinder::Params& accel) {
  for (std::size_t c = 0; c < detector.known.size(); ++c)
    detector.known[c] = rails.axis_limit_state.channels[c].plateau_limit;
  gyro.known_limits = rails.gyro_planes;
  accel.known_limits = rails.accel_saturation_planes;
}

}  // namespace tumble::odometry
