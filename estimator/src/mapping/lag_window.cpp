// SPDX-License-Identifier: BSD-3-Clause
#include "lag_window.hpp"

#include <array>
#include <memory>

#include "../common/dense.hpp"
#include "state_estimate.hpp"

namespace tumble::mapping {

Status WindowSweep::motion(SweepTrajectory& trajectory) const {
  const Registration::Estimate& now = smoothed.mean;
  return trajectory.build(now.state, samples, end_ns, now.calibration.gravity_W_m_s2, now.saturation_deficit_rad_s);
}

WindowSweep& LagWindow::append_sweep() {
  if (is_full()) sweeps_.pop_front();
  return sweeps_.emplace_back();
}

/// The smoother of Rauch, Tung and Striebel (1965) treats the registration of each sweep as a measurement that is
/// linearised at the converged pose.
void LagWindow::smooth() {
  if (sweeps_.empty()) return;
  sweeps_.back().smoothed = sweeps_.back().filtered;
  const auto held = std::make_unique<std::array<Registration::Matrix, 2>>();
  auto& [solved, gain] = *held;
  for (std::size_t k = sweeps_.size() - 1; k-- > 0;) {
    WindowSweep& sweep = sweeps_[k];
    const WindowSweep& next = sweeps_[k + 1];
    solved.noalias() = next.jacobian_previous * sweep.filtered.error_covariance;
    dense::solve_semidefinite(make_invertible(next.predicted.error_covariance), solved);
    gain = solved.transpose();
    sweep.smoothed.mean = sweep.filtered.mean;
    sweep.smoothed.mean.add(gain * next.smoothed.mean.minus(next.predicted.mean));
    solved = next.smoothed.error_covariance - next.predicted.error_covariance;
    propagate_covariance(gain, solved, sweep.smoothed.error_covariance);
    sweep.smoothed.error_covariance += sweep.filtered.error_covariance;
    make_symmetric(sweep.smoothed.error_covariance);
  }
}

void LagWindow::move_inserted_sweeps(LocalMap& map) const {
  SweepTrajectory trajectory;
  for (std::size_t k = 0; k + 1 < sweeps_.size(); ++k) {
    const WindowSweep& sweep = sweeps_[k];
    if (sweep.inserted.empty() || !sweep.motion(trajectory).ok()) continue;
    const LidarImuCalibration &now = sweep.smoothed.mean.calibration,
                              &inserted_calibration = sweep.filtered.mean.calibration;
    map.move(trajectory, now.T_IL, now.imu_minus_lidar_clock_s - inserted_calibration.imu_minus_lidar_clock_s,
             sweep.inserted);
  }
}

void LagWindow::clear_inserted() {
  for (WindowSweep& sweep : sweeps_) sweep.inserted.clear();
}

}  // namespace tumble::mapping
