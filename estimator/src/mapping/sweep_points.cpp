// SPDX-License-Identifier: BSD-3-Clause
#include "sweep_points.hpp"

#include "aligner.hpp"
#include "tumble/mapping/detail/sweep_check.hpp"

namespace tumble::mapping {

SweepPoints::SweepPoints(const Params& params) {
  const Registration::Params registration = registration_params(params);
  noise_ = {registration.kRangeSigma_m, registration.kRangeSigmaRatio};
}

Status SweepPoints::select_returns(const Params& params, std::span<const LidarPoint> returns, TimeNs span_ns,
                                   const LidarImuCalibration& calibration, double start_s, Counts& counts) {
  const PointSelectionBounds bounds{params.range_min_m, params.range_max_m, params.own_body_L};
  const PointCounts found =
      select_points(returns, bounds, calibration.T_IL, start_s + calibration.imu_minus_lidar_clock_s, all_);
  sampled_points_.clear();
  counts = {found.usable_points, 0, found.has_ring_numbers};
  if (Status status = check_point_selection(span_ns, returns, found); !status.ok()) return status;
  // Isolated returns are detected only if the sweep has ring numbers, because a return is compared with other returns
  // of its ring.
  if (found.has_ring_numbers) counts.isolated = lone_returns_.drop_isolated_returns(noise_, all_);
  if (all_.empty()) return {ErrorCode::insufficient_data, "points", 0.0, 1.0};
  return {};
}

void SweepPoints::choose_points_per_voxel(const Params& params, const SweepTrajectory& predicted) {
  compute_lever_arm_vectors(predicted, all_, positions_W_m_);
  for (std::size_t i = 0; i < all_.size(); ++i)
    positions_W_m_[i] += predicted.gravity_free_position_m(all_[i].t_s).cast<float>();
  sampler_.choose_points_per_voxel(positions_W_m_, params.sweep_voxel_m, sampled_point_index_);
  for (const std::uint32_t index : sampled_point_index_) sampled_points_.push_back(all_[index]);
}

}  // namespace tumble::mapping
