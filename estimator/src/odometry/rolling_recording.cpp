// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <utility>

#include "rolling_odometry_impl.hpp"
#include "rolling_odometry_params.hpp"

namespace tumble {

static_assert(RollingOdometry::kWholeRecording == RollingSmoother::kWholeRecordingLag, "both classes use one value");

RollingSmoother::Params rolling_smoother_params(const RollingOdometry::Params& params, const MergedRecordings& merged) {
  return odometry::rolling_params(params, odometry::merge_setup(params), merged.imus.size(), merged.lever_arm_m);
}

/// Stores a reading until the call of finish(). Ignores non-finite readings.
Status RollingOdometry::Impl::record_sample(std::size_t unit, ImuSample sample) {
  if (!check_sample(sample).ok()) return {};
  std::vector<ImuSample>& samples = recorded_samples_[unit];
  if (!samples.empty() && sample.time_ns <= samples.back().time_ns)
    return {ErrorCode::time_order, "time_ns", double(sample.time_ns), double(samples.back().time_ns)};
  samples.push_back(sample);
  return {};
}

Status RollingOdometry::Impl::finish_whole_recording() {
  std::vector<ImuRecording> recordings;
  for (std::size_t k = 0; k < params_.imus.size(); ++k) {
    std::vector<ImuSample>& samples = recorded_samples_[k];
    const std::vector<bool> inlier = find_inliers(outlier_filters_[k], samples);
    outlier_filter_state_[k].rejected += static_cast<std::size_t>(std::count(inlier.begin(), inlier.end(), false));
    std::size_t next = 0;
    std::erase_if(samples, [&](const ImuSample&) { return !inlier[next++]; });
    std::vector<TimeNs> stamps;
    for (const ImuSample& sample : samples) stamps.push_back(sample.time_ns);
    double jitter_s = 0.0;
    if (Status status = correct_stamps(sample_clock_, stamps, jitter_s); !status.ok()) return status;
    for (std::size_t j = 0; j < samples.size(); ++j) samples[j].time_ns = stamps[j];
    recordings.push_back({params_.imus[k].data_sheet, params_.imus[k].T_BI, std::move(samples)});
  }
  const auto whole = std::make_shared<MergedImuRecording>();
  MergedRecordings& merged = whole->recordings;
  const Status merge_status = merge_recordings(recordings, odometry::merge_setup(params_), merged);
  whole->health = merged.faults;
  whole_recording_result_ = whole;
  if (!merge_status.ok()) return merge_status;
  whole->health = check_merged_imus({.gravity_m_s2 = params_.gravity_m_s2, .is_merged = true}, merged);
  smoother_ = RollingSmoother(rolling_smoother_params(params_, merged));
  for (const ImuSample& sample : merged.samples) {
    const TimeNs last_ns = state_->live_filter.started ? state_->live_filter.last_time_ns : sample.time_ns;
    if (seconds(sample.time_ns - last_ns) > RollingGapParams::kGapMax_s)
      restart_at_newest(seconds(sample.time_ns - last_ns));
    if (Status status = smoother_.step(sample, *state_, finished_results_); !status.ok()) return status;
    initialise_pose();
  }
  return {};
}

}  // namespace tumble
