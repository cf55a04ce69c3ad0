// SPDX-License-Identifier: BSD-3-Clause
#include "tumble_ros/tumbling_adapter.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/odometry/expert_params.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "adapter_values.hpp"
#include "tumble_ros/map_file.hpp"

namespace tumble::ros {

namespace {

constexpr double kRatesKept_s = 2.0;  // exceeds the longest time between a sweep's end and its registration
constexpr std::size_t kSamplesKept = 1 << 14;
constexpr TimeNs kEarly_ns = 500'000'000;  // TumblingOdometry rejects sweeps a second ahead of the IMU
constexpr std::size_t kEarlyMax = 32;

TumblingParams mounted(const TumblingAdapterParams& params) {
  TumblingParams out = params.odometry;
  out.T_IL = params.T_BI.inverse() * params.T_BL;
  return out;
}

/// Returns the element whose time is nearest to `time_ns`.
template <class Queue, class Time>
auto nearest(Queue& queue, TimeNs time_ns, Time time_of) {
  return std::min_element(queue.begin(), queue.end(), [&](const auto& a, const auto& b) {
    return std::abs(time_of(a) - time_ns) < std::abs(time_of(b) - time_ns);
  });
}

}  // namespace

TumblingAdapter::TumblingAdapter(const Params& params, Publisher& publisher)
    : params_(params),
      publisher_(publisher),
      odometry_(mounted(params)),
      reader_(params.time_field),
      map_(params.map_period_s),
      diagnostics_(params.adapter.diagnostics_period_s) {
  require_valid_fields(params);
  odometry_.reset(params.T_BI);
}

Status TumblingAdapter::on_imu(const ImuSample& sample) {
  const std::optional<TimeNs> before_ns = odometry_.newest_imu_time_ns();
  const Status status = imu_.count(odometry_.add_imu(sample));
  if (status.ok()) samples_.push_back(sample);
  if (samples_.size() > kSamplesKept) samples_.pop_front();
  add_sweeps();
  publish_rate();
  publish_sweeps();
  if (odometry_.newest_imu_time_ns() != before_ns && publisher_.wants(Output::odometry_imu)) publish_newest();
  if (diagnostics_.is_due(sample.time_ns)) publish_diagnostics();
  if (last_ && publisher_.wants(Output::map) && map_.is_due(sample.time_ns)) publisher_.map(sample.time_ns, map());
  return status;
}

Status TumblingAdapter::on_cloud(const PointCloudView& cloud) {
  TimedSweep sweep;
  if (Status status = reader_.read(cloud, sweep); !status.ok()) return clouds_.count(status);
  if (!early_.empty() && sweep.end_ns < early_.back().end_ns) early_.clear();  // the clock stepped back
  early_.push_back(std::move(sweep));
  return add_sweeps();
}

bool TumblingAdapter::is_early(const TimedSweep& sweep) const {
  const std::optional<TimeNs> newest_ns = odometry_.newest_imu_time_ns();
  return !newest_ns || sweep.end_ns - *newest_ns > kEarly_ns;
}

/// Adds the waiting sweeps whose samples have arrived. Returns the status of the last added sweep.
Status TumblingAdapter::add_sweeps() {
  Status status;
  while (!early_.empty() && (early_.size() > kEarlyMax || !is_early(early_.front()))) {
    status = add_sweep(std::move(early_.front()));
    early_.pop_front();
  }
  return status;
}

Status TumblingAdapter::add_sweep(TimedSweep sweep) {
  const Status status = clouds_.count(odometry_.add_sweep(sweep.start_ns, sweep.end_ns, sweep.points));
  if (!status.ok()) return status;
  if (publisher_.wants(Output::points)) sweeps_.push_back(std::move(sweep));
  if (sweeps_.size() > params_.odometry.expert->waiting_sweeps_max) sweeps_.pop_front();
  return status;
}

void TumblingAdapter::finish() {
  odometry_.finish();
  publish_sweeps();
}

Status TumblingAdapter::on_livox(std::span<const std::uint8_t> cdr) {
  LivoxCloud cloud;
  if (Status status = cloud.parse(cdr); !status.ok()) return clouds_.count(status);
  return on_cloud(cloud.view());
}

Status TumblingAdapter::on_position(TimeNs stamp_ns, const Eigen::Vector3d& position_m,
                                    const Eigen::Matrix3d& covariance_m2) {
  const Eigen::Vector3d arm_I_m = params_.T_BI.inverse() * params_.position_arm_B_m;
  return positions_.count(odometry_.add_frame_alignment_position({stamp_ns, position_m, covariance_m2, arm_I_m}));
}

Status TumblingAdapter::reset(const std::optional<StartPose>& start) {
  samples_.clear();
  rates_.clear();
  early_.clear();
  sweeps_.clear();
  last_.reset();
  if (prior_map_.empty()) {
    odometry_.reset(start ? start->T_OB * params_.T_BI : params_.T_BI);
    return {};
  }
  PriorMap map{.points = prior_map_, .extend = params_.prior_map_extend};
  if (start) {
    map.start_T_MI = start->T_OB * params_.T_BI;
    map.start_position_sigma_m = start->sigma_m;
    map.start_heading_sigma_rad = start->sigma_rad;
  }
  odometry_.reset();
  return odometry_.set_prior_map(std::move(map));
}

Status TumblingAdapter::load_map(std::span<const std::byte> bytes) {
  if (Status status = read_map(bytes, prior_map_); !status.ok()) return status;
  return reset();
}

std::string TumblingAdapter::map_file(const std::string& path) const {
  if (path.ends_with(".ply")) return ply_of(map());
  const std::vector<std::byte> bytes = save_map(map());
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void TumblingAdapter::publish_rate() {
  const std::optional<AngularRateState>& rate = odometry_.newest_smoothed_rate();
  if (!rate || samples_.empty() || (!rates_.empty() && rates_.back().time_ns == rate->time_ns)) return;
  if (!rates_.empty() && rate->time_ns < rates_.back().time_ns) rates_.clear();  // the clock stepped back
  rates_.push_back(*rate);
  while (seconds(rate->time_ns - rates_.front().time_ns) > kRatesKept_s) rates_.pop_front();
  // SampleClock may correct the stamp of a rate, so the stamps of rate and sample may differ
  const auto sample = nearest(samples_, rate->time_ns, [](const ImuSample& each) { return each.time_ns; });
  const double density = params_.odometry.imu.accel_noise_m_s2_sqrt_hz;
  publisher_.imu({*rate, sample->specific_force_m_s2, density * density * params_.odometry.imu.rate_hz});
  samples_.erase(samples_.begin(), sample);
}

void TumblingAdapter::publish_sweeps() {
  while (const std::optional<TumblingOdometry::Sweep> sweep = odometry_.take()) {
    const SweepResult& report = sweep->result;
    if (report.trajectory.empty() || rates_.empty()) continue;  // no pose before the map starts
    publisher_.odometry(base_odometry(report.pose, report.velocity_covariance_I_m2_s2, rate_at(report.pose.time_ns),
                                      params_.T_BI.inverse()));
    if (sweep->position_frame) {
      publisher_.position_pose(base_odometry(sweep->position_frame->transform(report.pose),
                                             report.velocity_covariance_I_m2_s2, rate_at(report.pose.time_ns),
                                             params_.T_BI.inverse()));
    }
    if (publisher_.wants(Output::points)) publish_points(report);
    last_ = report;
    last_->trajectory.clear();
    last_->final_poses_of_earlier_sweep.clear();
  }
}

void TumblingAdapter::publish_points(const SweepResult& report) {
  const LidarImuCalibration calibration = odometry_.mapper().lidar_calibration();
  const TimeNs offset_ns = std::llround(1e9 * calibration.imu_minus_lidar_clock_s);
  const TimeNs end_ns = report.pose.time_ns - offset_ns;
  const auto raw = nearest(sweeps_, end_ns, [](const TimedSweep& each) { return each.end_ns; });
  if (raw == sweeps_.end() || std::abs(raw->end_ns - end_ns) > (raw->end_ns - raw->start_ns) / 2) return;
  DeskewedSweep out;
  out.stamp_ns = report.pose.time_ns;
  deskew(report.trajectory, calibration.T_IL, raw->start_ns + offset_ns, raw->points, out.points);
  sweeps_.erase(sweeps_.begin(), raw + 1);
  publisher_.points(out);
}

void TumblingAdapter::publish_newest() {
  PoseState pose;
  Eigen::Matrix3d velocity_covariance;
  if (!odometry_.newest(pose, &velocity_covariance).ok()) return;
  publisher_.odometry_imu(base_odometry(pose, velocity_covariance, odometry_.newest_rate().value_or(AngularRateState{}),
                                        params_.T_BI.inverse()));
}

const AngularRateState& TumblingAdapter::rate_at(TimeNs time_ns) const {
  return *nearest(rates_, time_ns, [](const AngularRateState& each) { return each.time_ns; });
}

void TumblingAdapter::publish_diagnostics() {
  const SensorHealth health = odometry_.health();
  Diagnostics out;
  out.ok = health.ok() && last_.has_value();
  out.message = !health.ok() ? health.worst_message() : last_ ? "ok" : "no registered sweep yet";
  add_findings(out, health);
  add_input(out, "imu", imu_);
  add_input(out, "clouds", clouds_);
  if (positions_.received > 0) add_input(out, "positions", positions_);
  add(out, "restarts after a gap or a step of the clock", odometry_.restart_count());
  add(out, "outliers among the IMU samples", odometry_.rejected_readings());
  add(out, "dropped sweeps", odometry_.dropped_untaken_sweeps());
  add(out, "sweeps before the first IMU sample", odometry_.sweeps_before_first_imu());
  if (last_) {
    add(out, "verdict of the last sweep", to_string(last_->verdict));
    add(out, "inlier ratio of the last sweep", last_->inlier_ratio);
    add(out, "consecutive rejected sweeps", last_->consecutive_rejected_sweeps);
  }
  publisher_.diagnostics(odometry_.newest_imu_time_ns().value_or(0), out);
}

std::string TumblingAdapter::calibration_yaml() const {
  const Eigen::Isometry3d T_BL = params_.T_BI * odometry_.mapper().lidar_calibration().T_IL;
  const Eigen::Vector3d arm = odometry_.body_imu_calibration().constants.lever_arm_m;
  return "/**:\n  ros__parameters:\n    T_base_imu: " + pose_text(params_.T_BI) +
         "\n    T_base_lidar: " + pose_text(T_BL) + "\n    lever_arm_m: " + list_text({arm.x(), arm.y(), arm.z()}) +
         "\n";
}

}  // namespace tumble::ros
