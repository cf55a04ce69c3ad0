// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>

#include "odometry_impl.hpp"

namespace tumble {

namespace {

// variance added to what the prior holds exactly, so that it can be inverted
constexpr double kLeastVariance = 1e-12;

}  // namespace

/// The present sweep becomes the newest of the window; the oldest leaves it once the window is full.
void LidarInertialOdometry::Impl::enter_window(TimeNs end_ns, bool aligned, SweepReport& report) {
  mapping::WindowSweep& sweep = window.emplace_back();
  sweep.filtered = sweep.smoothed = result.mean;
  sweep.filtered_errors = sweep.smoothed_errors = errors;
  sweep.predicted = prediction.prior.mean;
  sweep.predicted_errors = prediction.errors;
  sweep.by_before = prediction.by_last * end_by_start;
  sweep.samples = samples;
  sweep.end_ns = end_ns;
  sweep.drawn.swap(drawn);
  if (window.size() > static_cast<std::size_t>(params.window_sweeps)) {
    report.smoothed = describe(window.front());
    window.pop_front();
  }
  if (window.size() < 2 || !aligned) return;
  smooth();
  for (std::size_t k = 0; k + 1 < window.size(); ++k) redraw(window[k]);
}

/// mapping.md (R52).
/// Backward pass over the window (H. Rauch, F. Tung, C. Striebel, 1965), each sweep's registration being the linear
/// measurement that it settled on: the maximum a posteriori of all sweeps' unknowns together, to first order. What it
/// is for is a sweep that saw little: where all see much, as on `hill` 1002 to 1007, the end error is the same within
/// its noise (1.0 to 1.9 cm for windows of 1, 2 and 3).
void LidarInertialOdometry::Impl::smooth() {
  window.back().smoothed = window.back().filtered;
  window.back().smoothed_errors = window.back().filtered_errors;
  for (std::size_t k = window.size() - 1; k-- > 0;) {
    mapping::WindowSweep& sweep = window[k];
    const mapping::WindowSweep& next = window[k + 1];
    Registration::Matrix predicted = next.predicted_errors;
    predicted.diagonal().array() += kLeastVariance;
    const Registration::Matrix gain = predicted.ldlt().solve(next.by_before * sweep.filtered_errors).transpose();
    sweep.smoothed = sweep.filtered;
    sweep.smoothed.add(gain * next.smoothed.minus(next.predicted));
    const Registration::Matrix P =
        sweep.filtered_errors + gain * (next.smoothed_errors - next.predicted_errors) * gain.transpose();
    sweep.smoothed_errors = 0.5 * (P + P.transpose());
  }
}

/// Moves what a sweep drew into the map to where it is now known to lie, by mapping.md (R3).
void LidarInertialOdometry::Impl::redraw(mapping::WindowSweep& sweep) {
  if (sweep.drawn.empty()) return;
  SweepTrajectory motion;
  const Registration::Estimate& now = sweep.smoothed;
  if (!motion.build(now.state, sweep.samples, sweep.end_ns, now.calibration.gravity_W_m_s2, now.excess_rad_s).ok()) {
    return;
  }
  const Eigen::Isometry3d& T_IL = now.calibration.T_IL;
  const double later_s = now.calibration.time_offset_s - sweep.filtered.calibration.time_offset_s;
  std::size_t hint = 0;
  for (const mapping::WindowSweep::Drawn& drawn_point : sweep.drawn) {
    const double t_s = drawn_point.point.t_s + later_s;
    const SweepTrajectory::Instant at = motion.at(t_s, hint);
    const Eigen::Vector3d position =
        motion.base_m(t_s) + at.preintegrated_position_m + at.q_WI * (T_IL * drawn_point.point.x_L_m.cast<double>());
    map.move(drawn_point.index, position.cast<float>());
  }
}

std::vector<PoseState> LidarInertialOdometry::Impl::describe(const mapping::WindowSweep& sweep) const {
  SweepTrajectory motion;
  const Registration::Estimate& now = sweep.smoothed;
  if (!motion.build(now.state, sweep.samples, sweep.end_ns, now.calibration.gravity_W_m_s2, now.excess_rad_s).ok()) {
    return {};
  }
  std::vector<PoseState> poses = describe(motion, sweep.smoothed_errors);
  poses.back().time_ns = sweep.end_ns;
  return poses;
}

std::vector<std::vector<PoseState>> LidarInertialOdometry::open_trajectories() const {
  std::vector<std::vector<PoseState>> all;
  for (const mapping::WindowSweep& sweep : impl_->window) all.push_back(impl_->describe(sweep));
  return all;
}

Status LidarInertialOdometry::pose_at(TimeNs time_ns, PoseState& pose) const {
  const auto& window = impl_->window;
  if (window.empty()) return {Trouble::empty, "sweeps", 0.0, 1.0};
  const TimeNs first_ns = window.front().filtered.state.time_ns;
  if (time_ns < first_ns) return {Trouble::out_of_range, "time_ns", double(time_ns), double(first_ns)};
  const auto holds = [&](const mapping::WindowSweep& sweep) { return time_ns <= sweep.end_ns; };
  const auto sweep = std::find_if(window.begin(), window.end(), holds);
  if (sweep == window.end()) return {Trouble::out_of_range, "time_ns", double(time_ns), double(window.back().end_ns)};
  SweepTrajectory motion;
  const Registration::Estimate& now = sweep->smoothed;
  if (Status status =
          motion.build(now.state, sweep->samples, sweep->end_ns, now.calibration.gravity_W_m_s2, now.excess_rad_s);
      !status.ok()) {
    return status;
  }
  const double t_s = seconds(time_ns - now.state.time_ns);
  const Registration::Matrix F = mapping::unknowns_at(motion, t_s);
  pose = motion.state(t_s).pose();
  pose.time_ns = time_ns;
  pose.covariance = impl_->reported_covariance(F * sweep->smoothed_errors * F.transpose(), pose.p_WA_m);
  return {};
}

}  // namespace tumble
