// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <utility>

#include "rolling_odometry_impl.hpp"
#include "tumbling_odometry_impl.hpp"

namespace tumble {

template class HeapValue<TumblingExpertParams>;
template class HeapValue<RollingOdometryExpertParams>;

TumblingOdometry::TumblingOdometry(const Params& params) : impl_(std::make_unique<Impl>(params)) {}
TumblingOdometry::TumblingOdometry(const TumblingOdometry&) = default;
TumblingOdometry& TumblingOdometry::operator=(const TumblingOdometry&) = default;
TumblingOdometry::TumblingOdometry(TumblingOdometry&&) noexcept = default;
TumblingOdometry& TumblingOdometry::operator=(TumblingOdometry&&) noexcept = default;
TumblingOdometry::~TumblingOdometry() = default;

Status TumblingOdometry::set_prior_map(PriorMap map) {
  return impl_->odometry_pass_.set_prior_map(std::move(map));
}
Status TumblingOdometry::add_imu(const ImuSample& sample) {
  return impl_->add_imu(sample);
}
Status TumblingOdometry::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points) {
  return impl_->add_sweep(start_ns, end_ns, points);
}
Status TumblingOdometry::add_sweep(std::size_t lidar, TimeNs start_ns, TimeNs end_ns,
                                   std::span<const LidarPoint> points) {
  return impl_->add_sweep(lidar, start_ns, end_ns, points);
}
Status TumblingOdometry::add_velocity(const VelocityReading& velocity) {
  return impl_->add_reading(velocity);
}
Status TumblingOdometry::add_relative_pose(const RelativePoseReading& motion) {
  return impl_->add_reading(motion);
}
void TumblingOdometry::reset() {
  impl_->reset();
}
void TumblingOdometry::reset(const Eigen::Isometry3d& T_WI) {
  impl_->reset(T_WI);
}
Status TumblingOdometry::newest(PoseState& pose, Eigen::Matrix3d* velocity_covariance_I_m2_s2) const {
  return impl_->newest(pose, velocity_covariance_I_m2_s2);
}
SensorHealth TumblingOdometry::health() const {
  return impl_->health();
}
const std::optional<PositionFrame>& TumblingOdometry::position_frame() const {
  return impl_->positions_.position_frame();
}
std::optional<TimeNs> TumblingOdometry::newest_imu_time_ns() const {
  return impl_->newest_ns_;
}
std::optional<AngularRateState> TumblingOdometry::newest_rate() const {
  return impl_->newest_rate();
}
const std::optional<AngularRateState>& TumblingOdometry::newest_smoothed_rate() const {
  return impl_->odometry_pass_.newest_smoothed_rate();
}
BodyImuCalibration TumblingOdometry::body_imu_calibration() const {
  return impl_->body_imu_calibration();
}
const SaturationLevels& TumblingOdometry::saturation_levels() const {
  return impl_->saturation_levels();
}
std::size_t TumblingOdometry::restart_count() const {
  return impl_->restart_count_;
}
std::size_t TumblingOdometry::rejected_readings() const {
  return impl_->outlier_filter_state_.rejected;
}
bool TumblingOdometry::first_seconds_reprocessing_applied() const {
  return impl_->first_seconds_reprocessing_.is_applied();
}
std::size_t TumblingOdometry::samples_rejected_by_mapper() const {
  return impl_->odometry_pass_.samples_rejected_by_mapper();
}
std::size_t TumblingOdometry::dropped_untaken_sweeps() const {
  return impl_->dropped_sweeps_;
}
std::size_t TumblingOdometry::sweeps_before_first_imu() const {
  return impl_->sweeps_before_first_imu_;
}
const LidarInertialOdometry& TumblingOdometry::mapper() const {
  return impl_->mapper();
}
const WholeRecordingEstimate* TumblingOdometry::whole_recording_result() const {
  return impl_->whole_recording_result_.get();
}
std::vector<std::byte> TumblingOdometry::save() const {
  return impl_->save();
}
Status TumblingOdometry::load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose) {
  return impl_->load(bytes, last_pose);
}

RollingOdometry::RollingOdometry(const Params& params) : impl_(std::make_unique<Impl>(params)) {}
RollingOdometry::RollingOdometry(const RollingOdometry&) = default;
RollingOdometry& RollingOdometry::operator=(const RollingOdometry&) = default;
RollingOdometry::RollingOdometry(RollingOdometry&&) noexcept = default;
RollingOdometry& RollingOdometry::operator=(RollingOdometry&&) noexcept = default;
RollingOdometry::~RollingOdometry() = default;

Status RollingOdometry::add_imus(std::span<const ImuSample> samples) {
  return impl_->add_imus(samples);
}
std::optional<RollingOdometry::Pose> RollingOdometry::newest() const {
  return impl_->newest();
}
void RollingOdometry::reset() {
  impl_->reset();
}
void RollingOdometry::reset(const Eigen::Isometry3d& T_WG) {
  impl_->reset(T_WG);
}
SensorHealth RollingOdometry::health() const {
  return impl_->health();
}
const MergedImuRecording* RollingOdometry::whole_recording_result() const {
  return impl_->whole_recording_result_.get();
}
bool RollingOdometry::started_in_motion() const {
  return impl_->state_->live_filter.started_in_motion;
}
const ImuMergeState& RollingOdometry::imu_merge_state() const {
  return *impl_->imu_merge_state_;
}
std::size_t RollingOdometry::restart_count() const {
  return impl_->restart_count_;
}
std::vector<std::byte> RollingOdometry::save() const {
  return impl_->save();
}
Status RollingOdometry::load(std::span<const std::byte> bytes, std::optional<PoseState>* last_pose) {
  return impl_->load(bytes, last_pose);
}

}  // namespace tumble
