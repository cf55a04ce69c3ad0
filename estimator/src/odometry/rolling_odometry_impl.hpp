// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "imu_time_alignment.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/common/detail/outlier_filter.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/odometry/rolling_odometry.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble {

/// start of a new run of RollingOdometry after a gap or a step of the clock
struct RollingRestart {
  Eigen::Vector3d sphere_centre_W_m = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Functions of Impl that have the name of a public function are documented in the public header.
struct RollingOdometry::Impl {
  using Frozen = std::array<FrozenAxes::State, ImuMerge::kImus>;
  using Samples = std::array<ImuSample, ImuMerge::kImus>;
  struct ImuClippingState {
    StreamingClippingFinder::State clipping_state;
    std::optional<ImuSample> previous_sample;  ///< last finite sample
  };
  using Outliers = std::array<OutlierFilter::State, ImuMerge::kImus>;

  explicit Impl(const Params& params);
  Impl(const Params& params, const ImuMerge::Setup& merged);

  Status add_imus(std::span<const ImuSample> samples);
  std::optional<Pose> newest() const;
  void reset();
  void reset(const Eigen::Isometry3d& T_WG);
  SensorHealth health() const;
  std::vector<std::byte> save() const;
  Status load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose);

  void restart_at_newest(double gap_s);
  void end_continuous_run();
  void start_continuous_run();
  void initialise_pose();
  RollingEstimate transform_to_world(RollingEstimate estimate) const;
  Status add_delayed_samples(std::span<const ImuSample> next);
  bool is_delayed_after(std::span<const ImuSample> next, std::size_t unit);
  Status add_inliers(std::span<const ImuSample> samples);
  Status process_ordered_sample(const ImuSample& merged);
  Status add_imu(std::size_t unit, const ImuSample& sample);
  Status add_inlier(std::size_t unit, const ImuSample& sample);
  Status add_time_aligned_readings(bool ended);
  void forget_waiting_readings();
  Status record_sample(std::size_t unit, ImuSample sample);
  Status finish_whole_recording();
  bool uses_whole_recording() const { return params_.lag_s >= kWholeRecording; }
  Samples flag_clipped(std::span<const ImuSample> samples) const;
  void observe_saturation(std::span<const ImuSample> samples);
  void start_clipping_states();
  Status exclude_frozen(const Frozen& frozen, std::span<ImuSample> samples) const;
  void add_frozen_findings(const Frozen& frozen, SensorHealth& health) const;

  Params params_;
  StampOrder stamp_order_;
  StampOrder::State stamp_order_state_;
  SampleClock sample_clock_;
  SampleClock::State sample_clock_state_;  ///< clock state after the last accepted sample
  ImuMerge imu_merge_;
  RollingSmoother smoother_;
  std::vector<StreamingClippingFinder> clipping_finders_;  ///< one per IMU
  ImuTimeAlignment imu_time_alignment_;
  ImuTimeAlignment::State imu_time_alignment_state_;
  std::array<StampOrder::State, ImuMerge::kImus> unit_stamp_order_states_;  ///< order of the readings of each IMU
  std::array<std::vector<ImuSample>, ImuMerge::kImus>
      recorded_samples_;  ///< readings of each IMU, with kWholeRecording
  HeapValue<ImuMerge::State> imu_merge_state_, merge_state_buffer_;
  HeapValue<RollingSmoother::State> state_;
  std::array<ImuClippingState, ImuMerge::kImus> clipping_states_;
  std::vector<OutlierFilter> outlier_filters_;  ///< one filter per IMU
  Outliers outlier_filter_state_{};
  std::array<Samples, OutlierFilter::kDelayedMax>
      delayed_samples_{};                          ///< samples of all IMUs while OutlierFilter delays one IMU
  std::size_t delayed_count_ = 0;                  ///< number of valid elements of `delayed_samples_`
  std::vector<FrozenAxes> frozen_axis_detectors_;  ///< one detector per IMU
  Frozen frozen_imus_{};
  MergedImuChecks merged_imu_checks_;                                 ///< checks of the merged IMUs, with their states
  std::shared_ptr<const MergedImuRecording> whole_recording_result_;  ///< set by finish() with kWholeRecording
  std::vector<RollingEstimate> finished_results_;
  std::size_t returned_result_count_ = 0;
  std::optional<Eigen::Isometry3d> start_;  ///< pose passed to reset(), until the first sample
  std::optional<Eigen::Isometry3d>
      T_world_run_origin_;  ///< pose of the filter's frame in the world; empty: equal frames
  std::size_t restart_count_ = 0;
  std::optional<RollingRestart> restart_;  ///< last restart; poses after a restart are uncertain
  bool is_live_ = true, finished_ = false;
};

}  // namespace tumble

namespace tumble::odometry {

/// Throws InvalidParams if a parameter of RollingOdometry is out of bounds.
ImuMerge::Setup merge_setup(const RollingOdometry::Params& params);

/// `lever_arm_m` is the position of the virtual IMU that merges the readings of all `units` IMUs.
RollingSmoother::Params rolling_params(const RollingOdometry::Params& params, const ImuMerge::Setup& merged,
                                       std::size_t units, const Eigen::Vector3d& lever_arm_m);

/// Returns one StreamingClippingFinder per IMU. `known` contains the saturation levels of each IMU from an earlier run,
/// or is empty.
std::vector<StreamingClippingFinder> clipping_finders_of(const RollingOdometry::Params& params,
                                                         std::span<const SaturationLevels> known = {});
std::vector<FrozenAxes> frozen_axis_detectors(const RollingOdometry::Params& params);
std::vector<OutlierFilter> outlier_filters_of(const RollingOdometry::Params& params);

}  // namespace tumble::odometry
