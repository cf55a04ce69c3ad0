// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/outcome.hpp"

#include <type_traits>

#include "scenarios/provenance/hasher.hpp"

namespace tumble::scenarios {

namespace {

/// Each number of an estimate is hashed separately, so that no padding enters the digest.
class NumberHasher : public Hasher {
 public:
  template <typename Number>
  void add(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    bytes(&value, sizeof(value));
  }

  template <typename Derived>
  void add_matrix(const Eigen::MatrixBase<Derived>& matrix) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) add(matrix(i, j));
    }
  }
};

void add_pose(NumberHasher& hasher, const PoseState& pose) {
  hasher.add(pose.time_ns);
  hasher.add_matrix(pose.position_W_m);
  hasher.add_matrix(pose.orientation_W.coeffs());
  hasher.add_matrix(pose.velocity_W_m_s);
  hasher.add_matrix(pose.covariance);
}

void add_poses(NumberHasher& hasher, const std::vector<PoseState>& poses) {
  hasher.add(static_cast<std::uint64_t>(poses.size()));
  for (const PoseState& pose : poses) add_pose(hasher, pose);
}

void add_sweep(NumberHasher& hasher, const LidarInertialOdometry::SweepResult& sweep) {
  hasher.add(static_cast<std::int32_t>(sweep.verdict));
  add_pose(hasher, sweep.pose);
  add_poses(hasher, sweep.trajectory);
  hasher.add(sweep.inlier_ratio);
  hasher.add(sweep.eigenvalue_ratio);
  hasher.add(static_cast<std::int32_t>(sweep.iterations));
  hasher.add_matrix(sweep.least_constrained_pose_direction_W);
  hasher.add_matrix(sweep.mean_saturation_deficit_I_rad_s);
  for (const std::size_t count : {sweep.usable_points, sweep.points_after_downsampling, sweep.map_points_added}) {
    hasher.add(static_cast<std::uint64_t>(count));
  }
}

}  // namespace

std::string digest(const Estimate& estimate) {
  NumberHasher hasher;
  hasher.add(static_cast<std::int32_t>(estimate.status.error_code));
  hasher.text(estimate.status.field);
  hasher.add(static_cast<std::int32_t>(estimate.frame));
  hasher.add(static_cast<std::uint64_t>(estimate.rates.size()));
  for (const AngularRateState& rate : estimate.rates) {
    hasher.add(rate.time_ns);
    hasher.add_matrix(rate.w_WI_I_rad_s);
    hasher.add_matrix(rate.covariance_rad2_s2);
    hasher.add(rate.clipped_axes);
    hasher.add(static_cast<std::int32_t>(rate.source));
  }
  hasher.add(static_cast<std::uint64_t>(estimate.attitudes.size()));
  for (const AttitudeState& attitude : estimate.attitudes) {
    hasher.add(attitude.time_ns);
    hasher.add_matrix(attitude.orientation_W.coeffs());
    hasher.add_matrix(attitude.covariance_rad2);
  }
  add_poses(hasher, estimate.poses);
  hasher.add(static_cast<std::uint64_t>(estimate.contacts.size()));
  for (const sim::ContactLabel label : estimate.contacts) hasher.add(static_cast<std::int32_t>(label));
  hasher.add(static_cast<std::uint64_t>(estimate.uncertain.size()));
  for (const bool uncertain : estimate.uncertain) hasher.add(static_cast<std::int32_t>(uncertain));
  hasher.add(static_cast<std::uint64_t>(estimate.sweeps.size()));
  for (const auto& sweep : estimate.sweeps) add_sweep(hasher, sweep);
  for (const std::int64_t end_ns : estimate.sweep_end_ns) hasher.add(end_ns);
  hasher.add(static_cast<std::uint64_t>(estimate.map.size()));
  for (const MapPoint& point : estimate.map) {
    hasher.add_matrix(point.position_W_m);
    hasher.add_matrix(point.normal_W);
    hasher.add(point.sigma_m);
  }
  return hasher.hex();
}

namespace {

int rank(OutcomeStatus status) {
  if (status == OutcomeStatus::killed) return 0;
  return status == OutcomeStatus::crashed || status == OutcomeStatus::timeout ? 1 : 2;
}

}  // namespace

bool was_scored(OutcomeStatus status) {
  return rank(status) == 2;
}

bool outranks(OutcomeStatus status, OutcomeStatus other) {
  return rank(status) > rank(other);
}

bool may_run_again(OutcomeStatus status) {
  return !was_scored(status);
}

}  // namespace tumble::scenarios
