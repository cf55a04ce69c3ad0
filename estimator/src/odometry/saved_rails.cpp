// SPDX-License-Identifier: BSD-3-Clause
#include "saved_rails.hpp"

#include <utility>

namespace tumble::odometry {

namespace {

template <class Visit, class Rails>
void visit_rails(Visit& visit, Rails& rails) {
  constexpr double kLimitMax = 1e6, kCountMax = 1e9, kSlopeMax = 1.0;
  for (auto& channel : rails.axis_aligned_rails.channels) visit("saturation limit", channel.rail, 0.0, kLimitMax);
  for (auto* const planes : {&rails.planes, &rails.accel_planes}) {
    for (auto& plane : planes->element) {
      if (!visit.present("saturation plane", plane)) continue;
      visit("plane.row", plane->row, -kSlopeMax, kSlopeMax);
      visit("plane.distance_rad_s", plane->distance_rad_s, 0.0, kLimitMax);
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

/// Planes of saturated readings are not saved for upright rails, because the saturation limits suffice.
void write_rails(const SaturationLevels& rails, SavedWriter& out) {
  SaturationLevels kept = rails;
  if (rails.gyro_clips_after_compensation) kept.planes = {};
  if (rails.accel_clips_after_compensation) kept.accel_planes = {};
  visit_rails(out, std::as_const(kept));
}

void read_rails(SavedReader& in, SaturationLevels& rails) {
  visit_rails(in, rails);
  for (const RailPlanes* const planes : {&rails.planes, &rails.accel_planes}) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::optional<RailPlane>& plane = planes->element[j];
      if (!plane || !in.status().ok()) continue;
      const double own = plane->row[static_cast<Eigen::Index>(j)];
      in.require("plane.row", own == 1.0, own, 1.0);
      in.require_covariance("plane.covariance", plane->covariance);
    }
  }
}

void start_from_rails(const SaturationLevels& rails, RailDetector::Params& detector, RailPlaneFinder::Params& gyro,
                      RailPlaneFinder::Params& accel) {
  for (std::size_t c = 0; c < detector.known.size(); ++c) detector.known[c] = rails.axis_aligned_rails.channels[c].rail;
  gyro.known = rails.planes;
  accel.known = rails.accel_planes;
}

}  // namespace tumble::odometry
