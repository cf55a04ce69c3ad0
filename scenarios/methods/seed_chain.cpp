// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/seed_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "scenarios/baselines/attitude/madgwick.hpp"
#include "scenarios/baselines/mapping/trimmed_icp.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sweep_log.hpp"
#include "tumble/mapping/detail/map_drawing.hpp"
#include "tumble/mapping/detail/spatial_hash.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kMadgwickGain = 0.01;
constexpr TimeNs kBucketNs = 50000;  // times of points are rounded down to this before the look-up
constexpr double kRangeMaxM = 100.0;
constexpr double kSweepVoxelM = 0.15;
constexpr double kMapSpacingM = 0.05;  // a point enters the map where the old map has none within this
constexpr double kRangeSigmaM = 0.02, kRangeSigmaShare = 0.0015;
const Eigen::AlignedBox3f kOwnBody{Eigen::Vector3f(-0.5f, -0.4f, -0.27f), Eigen::Vector3f(0.5f, 0.4f, 0.23f)};

/// Attitude by Madgwick's filter and position by the accelerometer, in a frame of its own ("odom").
class ImuOdometry {
 public:
  ImuOdometry(std::span<const ImuSample> samples, std::span<const RateState> rates) : samples_(samples) {
    baselines::Madgwick::Params params;
    params.gain_rad_s = kMadgwickGain;
    const baselines::Madgwick madgwick(params);
    baselines::Madgwick::State state;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      ImuSample sample = samples[k];
      sample.angular_velocity_rad_s = rates[k].w_WI_I_rad_s;
      (void)madgwick.step(sample, state);
      attitude_.push_back(state.q_WI);
    }
    p_m_.assign(1, Eigen::Vector3d::Zero());
    v_m_s_.assign(1, Eigen::Vector3d::Zero());
    gravity_m_s2_ = (attitude_[0] * samples[0].specific_force_m_s2).z();
  }

  /// Integrates up to the sample at or after `to_ns`.
  void advance(TimeNs to_ns) {
    while (p_m_.size() < samples_.size() && samples_[p_m_.size() - 1].time_ns < to_ns) {
      const std::size_t k = p_m_.size();
      const double step_s = seconds(samples_[k].time_ns - samples_[k - 1].time_ns);
      const Eigen::Vector3d change =
          fed_back_ ? Eigen::Vector3d(0.5 * (force(k - 1) + force(k)) * step_s) : Eigen::Vector3d::Zero();
      p_m_.push_back(p_m_.back() + step_s * (velocity_m_s_ + 0.5 * change));
      velocity_m_s_ += change;
      v_m_s_.push_back(velocity_m_s_);
      changes_.push_back({samples_[k].time_ns, change});
    }
  }

  /// Velocity by registration, valid at `time_ns`: what the accelerometer has added since is added again.
  void feed_back(const Eigen::Vector3d& velocity_m_s, TimeNs time_ns) {
    fed_back_ = true;
    velocity_m_s_ = velocity_m_s;
    for (const auto& [time, change] : changes_) {
      if (time > time_ns) velocity_m_s_ += change;
    }
    std::erase_if(changes_, [&](const auto& entry) { return entry.first <= time_ns; });
  }

  /// Pose of the IMU, linear and slerp between samples, constant before the first.
  Eigen::Isometry3d pose(TimeNs time_ns) const {
    const auto next = std::lower_bound(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(p_m_.size()),
                                       time_ns, [](const ImuSample& s, TimeNs t) { return s.time_ns < t; });
    const auto k = std::min(static_cast<std::size_t>(next - samples_.begin()), p_m_.size() - 1);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    if (k == 0) {
      T.linear() = attitude_[0].toRotationMatrix();
      return T;
    }
    const double share = std::clamp(static_cast<double>(time_ns - samples_[k - 1].time_ns) /
                                        static_cast<double>(samples_[k].time_ns - samples_[k - 1].time_ns),
                                    0.0, 1.0);
    T.linear() = attitude_[k - 1].slerp(share, attitude_[k]).toRotationMatrix();
    T.translation() = (1.0 - share) * p_m_[k - 1] + share * p_m_[k];
    return T;
  }
  /// As it was believed when the sample was integrated, nearest at or after the time.
  const Eigen::Vector3d& velocity_m_s(TimeNs time_ns) const {
    const auto next = std::lower_bound(samples_.begin(), samples_.begin() + static_cast<std::ptrdiff_t>(v_m_s_.size()),
                                       time_ns, [](const ImuSample& s, TimeNs t) { return s.time_ns < t; });
    return v_m_s_[std::min(static_cast<std::size_t>(next - samples_.begin()), v_m_s_.size() - 1)];
  }

 private:
  Eigen::Vector3d force(std::size_t k) const {
    return attitude_[k] * samples_[k].specific_force_m_s2 - gravity_m_s2_ * Eigen::Vector3d::UnitZ();
  }

  std::span<const ImuSample> samples_;
  std::vector<Eigen::Quaterniond> attitude_;
  std::vector<Eigen::Vector3d> p_m_, v_m_s_;  // of the samples integrated so far
  std::vector<std::pair<TimeNs, Eigen::Vector3d>> changes_;
  Eigen::Vector3d velocity_m_s_ = Eigen::Vector3d::Zero();
  double gravity_m_s2_ = 0.0;
  bool fed_back_ = false;
};

struct Cell {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  double time_s = 0.0, skew_variance = 0.0;
  float count = 0.0f;
};

TimeNs rounded_offset(const LidarPoint& point) {
  return static_cast<TimeNs>(point.offset_ns) / kBucketNs * kBucketNs;
}

/// The time whose pose the registration asks for: the start of the sweep; of one whose points are all of one instant,
/// as triage's are, that instant. Were they moved to a start that they are far from, an error of the velocity would
/// come back as one of position and be fed back as one of velocity: v' = v_true + (v - v'') from sweep to sweep, whose
/// root -1.6 runs away. Points over the whole sweep halve that term: roots 0.5 and -1.
TimeNs registered_at(const bridge::Sweep& sweep) {
  if (sweep.points.empty()) return sweep.start_ns;
  const auto [first, last] = std::minmax_element(
      sweep.points.begin(), sweep.points.end(), [](const auto& a, const auto& b) { return a.offset_ns < b.offset_ns; });
  if (static_cast<TimeNs>(last->offset_ns) - static_cast<TimeNs>(first->offset_ns) >= kBucketNs) return sweep.start_ns;
  return sweep.start_ns + rounded_offset(*first);
}

/// Returns of a sweep in the lidar's axes at `at_ns`, voxelised, with their variances.
std::vector<baselines::TrimmedIcp::Point> prepare(const bridge::Sweep& sweep, TimeNs at_ns, const ImuOdometry& odometry,
                                                  const Eigen::Isometry3d& T_IL, const SeedParams& params) {
  const double rate = params.skew_sigma_m_s;
  const Eigen::Isometry3d from_odom = (odometry.pose(at_ns) * T_IL).inverse(Eigen::Isometry);
  std::unordered_map<std::uint64_t, std::size_t> index_of;
  std::vector<Cell> cells;
  TimeNs bucket = -1;
  Eigen::Isometry3f move = Eigen::Isometry3f::Identity();
  double first_s = std::numeric_limits<double>::infinity();
  for (const LidarPoint& point : sweep.points) {
    if (!point.position_L_m.allFinite() || point.position_L_m.norm() > kRangeMaxM) continue;
    if (kOwnBody.contains(point.position_L_m) || point.position_L_m.norm() < 0.2f) continue;
    const TimeNs rounded = rounded_offset(point);
    if (rounded != bucket) {
      bucket = rounded;
      move = (from_odom * odometry.pose(sweep.start_ns + rounded) * T_IL).cast<float>();
    }
    const Eigen::Vector3f x = move * point.position_L_m;
    const double t_s = seconds(static_cast<TimeNs>(point.offset_ns));
    first_s = std::min(first_s, t_s);
    const Eigen::Vector3i cube = (x / static_cast<float>(kSweepVoxelM)).array().floor().cast<int>();
    const auto [it, added] = index_of.try_emplace(SpatialHash::key(cube), cells.size());
    if (added) cells.emplace_back();
    Cell& cell = cells[it->second];
    cell.sum += x;
    cell.time_s += t_s;
    cell.skew_variance += rate * rate * t_s * t_s;
    cell.count += 1.0f;
  }
  std::vector<baselines::TrimmedIcp::Point> points;
  points.reserve(cells.size());
  for (const Cell& cell : cells) {
    baselines::TrimmedIcp::Point& point = points.emplace_back();
    point.position_m = cell.sum / cell.count;
    const double count = static_cast<double>(cell.count);
    const double range = std::max(kRangeSigmaM, kRangeSigmaShare * static_cast<double>(point.position_m.norm()));
    const double skew = rate * (cell.time_s / count - first_s);
    const double variance = params.voxel_averages_time ? skew * skew : cell.skew_variance / count;
    point.variance_m2 = static_cast<float>(range * range + variance);
  }
  return points;
}

/// The mapper: registers at one time of the sweep, keeps what lies between the map's frame and the odometry's.
class SeedMapper {
 public:
  SeedMapper(const SeedParams& params, const Eigen::Isometry3d& T_IL, const ImuOdometry& odometry)
      : ends_on_abort_(params.abort_ends_mapping), T_IL_(T_IL), odometry_(odometry), icp_(params.icp) {}

  bool add(const bridge::Sweep& sweep, TimeNs at_ns, std::span<const baselines::TrimmedIcp::Point> points,
           SweepReport& report) {
    report.points_used = sweep.points.size();
    report.points_registered = points.size();
    if (dead_ || points.empty()) return false;
    const Eigen::Isometry3d in_odom = odometry_.pose(at_ns) * T_IL_;
    Eigen::Isometry3d T = T_map_odom_ * in_odom;
    if (map_.size() == 0) {
      report.verdict = SweepVerdict::first;
    } else {
      const baselines::TrimmedIcp::Result result = icp_.align(points, T, map_);
      report.iterations = result.iterations;
      report.inlier_share = result.kept_share;
      dead_ = result.verdict != RegistrationVerdict::converged && ends_on_abort_;
      if (result.verdict != RegistrationVerdict::converged) return false;
      report.verdict = SweepVerdict::registered;
      T = result.T;
    }
    T_map_odom_ = T * in_odom.inverse(Eigen::Isometry);
    extend(points, T, report);
    return true;
  }

  const Eigen::Isometry3d& T_map_odom() const { return T_map_odom_; }
  std::vector<MapPoint> map() const { return mapping::with_normals(map_, seen_from_, 20, 1.0); }

 private:
  // compared with the old map only, not with each other
  void extend(std::span<const baselines::TrimmedIcp::Point> points, const Eigen::Isometry3d& T, SweepReport& report) {
    const Eigen::Isometry3f T_WL = T.cast<float>();
    std::vector<std::uint32_t> fresh;
    Neighbours found;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      map_.nearest(T_WL * points[i].position_m, 1, static_cast<float>(kMapSpacingM), found);
      if (found.count == 0) fresh.push_back(i);
    }
    for (const std::uint32_t i : fresh) {
      report.map_points_added += map_.insert(T_WL * points[i].position_m, std::sqrt(points[i].variance_m2),
                                             static_cast<std::uint32_t>(seen_from_.size()));
    }
    seen_from_.push_back(T_WL.translation());
    icp_.forget_normals();
  }

  bool ends_on_abort_, dead_ = false;
  Eigen::Isometry3d T_IL_;
  const ImuOdometry& odometry_;
  baselines::TrimmedIcp icp_;
  VoxelMap map_{{0.5, 0.0}};
  std::vector<Eigen::Vector3f> seen_from_;
  Eigen::Isometry3d T_map_odom_ = Eigen::Isometry3d::Identity();
};

PoseState pose_state(const Eigen::Isometry3d& T, const Eigen::Vector3d& v_m_s, TimeNs time_ns) {
  PoseState pose;
  pose.time_ns = time_ns;
  pose.p_WA_m = T.translation();
  pose.q_WA = Eigen::Quaterniond(T.linear()).normalized();
  pose.v_WA_m_s = v_m_s;
  return pose;
}

Status sweep_trouble(const bridge::Sweep& sweep, std::size_t prepared) {
  if (sweep.points.empty()) return {Trouble::empty, "points", 0.0, 1.0};
  const auto differs = [&](const LidarPoint& p) { return p.offset_ns != sweep.points.front().offset_ns; };
  if (std::none_of(sweep.points.begin(), sweep.points.end(), differs)) {
    return {Trouble::degenerate, "spread of offset_ns", 0.0, 1.0};
  }
  if (prepared == 0) return {Trouble::too_few, "points in range", 0.0, 1.0};
  return {};
}

/// Poses of a sweep, in the map's frame.
void tell_poses(const bridge::Sweep& sweep, std::span<const ImuSample> samples, ImuOdometry& odometry,
                const Eigen::Isometry3d& T_map_odom, SweepReport& report) {
  const auto at = [&](TimeNs time_ns) {
    return pose_state(T_map_odom * odometry.pose(time_ns), T_map_odom.linear() * odometry.velocity_m_s(time_ns),
                      time_ns);
  };
  for (const ImuSample& sample : samples) {
    if (sample.time_ns > sweep.start_ns && sample.time_ns <= sweep.end_ns)
      report.trajectory.push_back(at(sample.time_ns));
  }
  report.pose = at(sweep.end_ns);
  if (report.trajectory.empty()) report.trajectory.push_back(report.pose);
}

/// Where the last sweep was registered.
struct Return {
  std::optional<TimeNs> time_ns;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
};

/// The mean velocity since the last registered sweep goes back to the odometry.
void feed_back(TimeNs at_ns, const Eigen::Isometry3d& T_map_odom, bool late, Return& last, ImuOdometry& odometry) {
  const Eigen::Vector3d here_m = (T_map_odom * odometry.pose(at_ns)).translation();
  if (last.time_ns && at_ns > *last.time_ns) {
    const Eigen::Vector3d mean = (here_m - last.p_m) / seconds(at_ns - *last.time_ns);
    odometry.feed_back(T_map_odom.linear().transpose() * mean, late ? at_ns : (at_ns + *last.time_ns) / 2);
  }
  last = {at_ns, here_m};
}

}  // namespace

void run_seed_chain(const sim::Sensors& sensors, std::span<const ImuSample> samples, const sim::Values& parameters,
                    Estimate& estimate) {
  estimate.frame = Frame::imu;
  count_sources(estimate.rates, estimate.health);
  if (sensors.lidars.empty()) {
    estimate.status = {Trouble::empty, "lidars", 0.0, 1.0};
    return;
  }
  const sim::LidarRecord& lidar = sensors.lidars.front();
  const Eigen::Isometry3d T_IL = bridge::T_IL(sensors.imus.front(), lidar);
  const SeedParams params = seed_settings().read(parameters);
  ImuOdometry odometry(samples, estimate.rates);
  SeedMapper mapper(params, T_IL, odometry);
  Return last;
  const auto covers = [&](const bridge::Sweep& sweep) {
    return samples.back().time_ns >= sweep.end_ns && samples.front().time_ns <= sweep.end_ns;
  };
  const auto add = [&](const bridge::Sweep& sweep, SweepReport& report) {
    for (const LidarPoint& point : sweep.points) {
      if (point.offset_ns <= sweep.end_ns - sweep.start_ns) continue;
      return Status{Trouble::out_of_range, "offset_ns", double(point.offset_ns), double(sweep.end_ns - sweep.start_ns)};
    }
    odometry.advance(sweep.end_ns);
    const TimeNs at_ns = registered_at(sweep);
    std::vector<baselines::TrimmedIcp::Point> points = prepare(sweep, at_ns, odometry, T_IL, params);
    const Status trouble = sweep_trouble(sweep, points.size());
    if (!trouble.ok()) points.clear();
    const bool registered = mapper.add(sweep, at_ns, points, report);
    tell_poses(sweep, samples, odometry, mapper.T_map_odom(), report);
    if (registered) feed_back(at_ns, mapper.T_map_odom(), params.late_velocity, last, odometry);
    return trouble;
  };
  if (run_over_sweeps(lidar, {covers, add}, estimate)) estimate.map = mapper.map();
}

const Settings<SeedParams>& seed_settings() {
  static const Settings<SeedParams> all(SeedParams{});
  return all;
}

}  // namespace tumble::scenarios
