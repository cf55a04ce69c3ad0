// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/motion_values.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/motion_summary.hpp"

namespace tumble::scenarios {

namespace {

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::nan("") : static_cast<double>(part) / static_cast<double>(whole);
}

double duration_s(const sim::ImuRecord& imu) {
  return imu.time_ns.empty() ? 0.0 : 1e-9 * static_cast<double>(imu.time_ns.back() - imu.time_ns.front());
}

}  // namespace

DrawValues motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording) {
  DrawValues draw{scenario, seed, {}};
  if (recording.sensors.imus.empty()) return draw;
  const MotionSummary motion = summarise_motion(recording.sensors, recording.truth);
  draw.values = {{"motion_duration_s", duration_s(recording.sensors.imus.front())},
                 {"motion_moving_s", motion.moving_s},
                 {"motion_path_m", motion.path_m},
                 {"motion_peak_rate_rad_s", motion.peak_rate_rad_s},
                 {"motion_peak_accel_m_s2", motion.peak_accel_m_s2},
                 {"motion_flight_share", motion.flight_share},
                 {"motion_impacts", static_cast<double>(motion.impacts)},
                 {"motion_clips", motion.clipped_samples > 0 ? 1.0 : 0.0},
                 {"motion_clipped_share", share(motion.clipped_samples, motion.samples)},
                 {"motion_clipped_samples", static_cast<double>(motion.clipped_samples)},
                 {"motion_clip_depth_max_rad_s", motion.clip_depth_max_rad_s},
                 {"motion_clip_length_max_s", motion.clip_length_max_s},
                 {"motion_several_axes_share", share(motion.several_axes_samples, motion.clipped_samples)},
                 {"motion_cross_axis_share", share(motion.cross_axis_samples, motion.clipped_samples)},
                 {"motion_accel_clipped_share", share(motion.accel_clipped_samples, motion.samples)}};
  return draw;
}

DrawValues recorded_motion_values(const std::string& scenario, std::uint64_t seed, const sim::Recording& recording) {
  DrawValues draw{scenario, seed, {}};
  if (recording.sensors.imus.empty()) return draw;
  double peak_rad_s = 0.0;
  for (const Eigen::Vector3d& w : recording.sensors.imus.front().gyro_rad_s)
    peak_rad_s = std::max(peak_rad_s, w.norm());
  draw.values = {{"motion_duration_s", duration_s(recording.sensors.imus.front())},
                 {"motion_peak_rate_rad_s", peak_rad_s}};
  if (recording.truth.imus.empty() || recording.truth.imus.front().rate_rad_s.empty()) return draw;
  const ClippingTruth clipping(recording.sensors, recording.truth);
  std::size_t clipped = 0;
  double depth_rad_s = 0.0;
  for (std::size_t i = 0; i < clipping.size(); ++i) {
    if (clipping.clipped_axes(i) == 0) continue;
    ++clipped;
    depth_rad_s = std::max(depth_rad_s, clipping.depth_rad_s(i));
  }
  draw.values.push_back({"motion_clips", clipped > 0 ? 1.0 : 0.0});
  draw.values.push_back({"motion_clipped_share", share(clipped, clipping.known_samples())});
  draw.values.push_back({"motion_clipped_samples", static_cast<double>(clipped)});
  draw.values.push_back({"motion_clip_depth_max_rad_s", depth_rad_s});
  return draw;
}

}  // namespace tumble::scenarios
