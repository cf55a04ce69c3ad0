// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/lidar_inertial_odometry.hpp"

#include <algorithm>
#include <limits>

#include "inertial_prior.hpp"
#include "tumble/mapping/deskew.hpp"
#include "tumble/mapping/plane_fit.hpp"
#include "tumble/mapping/registration.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"
#include "tumble/mapping/voxel_map.hpp"

namespace tumble {

namespace {

using Params = LidarInertialOdometry::Params;
using SweepReport = LidarInertialOdometry::SweepReport;

constexpr std::uint8_t kAllAxes = 7;
constexpr double kSameLineCosine = 0.9988;  // 0.05 rad, less than the angle between two rings
constexpr int kRingBits = 16;
constexpr double kExcessTries_rad_s[] = {3.0, 6.0, 9.0, 15.0};

void check(const Params& params) {
  require_within("gravity_m_s2", params.gravity_m_s2, 0.0, 100.0);
  require_within("rest_s", params.rest_s, 1e-9, 60.0);
  require_within("rest_rate_rad_s", params.rest_rate_rad_s, 0.0, 10.0);
  require_within("rest_force_m_s2", params.rest_force_m_s2, 0.0, 10.0);
  require_within("range_min_m", params.range_min_m, 0.0, 10.0);
  require_within("range_max_m", params.range_max_m, params.range_min_m, 1e4);
  require_within("sweep_voxel_m", params.sweep_voxel_m, 0.01, 10.0);
  require_within("map_voxel_m", params.map_voxel_m, 0.01, 10.0);
  require_within("map_spacing_m", params.map_spacing_m, 0.0, params.map_voxel_m);
  require_within("neighbours", params.neighbours, 3, Neighbours::kMax);
  require_within("prior_sigma_m", params.prior_sigma_m, 1e-9, 1e3);
  require_within("prior_sigma_rad", params.prior_sigma_rad, 1e-9, 1e3);
  require_within("prior_sigma_m_s", params.prior_sigma_m_s, 1e-9, 1e3);
  require_within("force_sigma_share", params.force_sigma_share, 0.0, 1.0);
  require_within("trusted_prior_m", params.trusted_prior_m, 0.0, 1e3);
  require_within("trusted_prior_rad", params.trusted_prior_rad, 0.0, 1e3);
  require_within("clipped_sigma_rad_s", params.clipped_sigma_rad_s, 0.0, 100.0);
  require_within("rate_sigma_max_rad_s", params.rate_sigma_max_rad_s, 0.0, 100.0);
  require_within("excess_sigma_min_rad_s", params.excess_sigma_min_rad_s, 1e-9, 100.0);
  require_within("degenerate_conditioning", params.degenerate_conditioning, 0.0, 1.0);
  const double orthogonality =
      (params.T_IL.linear() * params.T_IL.linear().transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  require_within("T_IL rotation's distance from orthogonal", orthogonality, 0.0, 1e-6);
  require_within("T_IL translation", params.T_IL.translation().norm(), 0.0, 1e3);
}

Registration::Params registration_params(const Params& params) {
  Registration::Params out;
  out.neighbours = params.neighbours;
  out.plane.neighbours_min = std::min(out.plane.neighbours_min, params.neighbours);
  out.match_distance_m = params.match_distance_m;
  out.iterations_max = params.iterations_max;
  out.skew_sigma_m_s = params.skew_sigma_m_s;
  out.correction_max_m = params.correction_max_m;
  out.correction_max_rad = params.correction_max_rad;
  out.matches_min = params.matches_min;
  return out;
}

}  // namespace

struct LidarInertialOdometry::Impl {
  explicit Impl(const Params& p)
      : params((check(p), p)), map({p.map_voxel_m, p.map_spacing_m}), registration(registration_params(p)) {}

  Status check_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points) const;
  Status check_selection(TimeNs span_ns, std::span<const LidarPoint> points, const PointCounts& counts) const;
  Registration::Prior prior() const;
  bool prior_is_trusted() const;
  void choose_points();
  Status align(Registration::Prior prior, TimeNs end_ns, Registration::Result& result);
  void register_sweep(TimeNs end_ns, SweepReport& report);
  std::uint32_t scan_line_base(bool rings_differ);
  std::size_t extend_map(bool rings_differ);
  void finish(TimeNs end_ns, SweepReport& report);

  Params params;
  bool started = false;
  MotionState state;  // at the end of the last sweep
  mapping::InitialRest rest;
  std::vector<MotionSample> samples;  // from the window that holds state.time_ns on
  Eigen::Vector3d excess_rad_s = Eigen::Vector3d::Zero();
  std::uint8_t excess_axes_at_end = 0;
  VoxelMap map;
  std::vector<Eigen::Vector3f> seen_from_W_m;             // per sweep that gave points to the map
  Eigen::Vector3d scan_axis_W = Eigen::Vector3d::Zero();  // of the sweeps that share scan lines
  std::uint32_t scan_attitude = 0;                        // counts changes of it

  // memory kept between sweeps
  Registration registration;
  SweepTrajectory trajectory;
  SweepSampler sampler;
  std::vector<SweepPoint> points, chosen;
  std::vector<Eigen::Vector3f> positions_W_m;
  std::vector<std::uint32_t> chosen_index;
};

Status LidarInertialOdometry::Impl::check_sweep(TimeNs start_ns, TimeNs end_ns,
                                                std::span<const LidarPoint> given) const {
  if (end_ns < start_ns) return {Trouble::time_order, "end_ns", double(end_ns), double(start_ns)};
  if (started && start_ns < state.time_ns)
    return {Trouble::time_order, "start_ns", double(start_ns), double(state.time_ns)};
  if (samples.empty() && given.empty()) return {Trouble::empty, "points", 0.0, 1.0};
  if (samples.empty()) return {Trouble::too_few, "imu samples", 0.0, 1.0};
  if (samples.back().time_ns < end_ns) {
    return {Trouble::too_few, "imu time_ns", double(samples.back().time_ns), double(end_ns)};
  }
  if (!started && samples.front().from_ns > start_ns) {
    return {Trouble::too_few, "start_ns", double(start_ns), double(samples.front().from_ns)};
  }
  for (const LidarPoint& point : given) {
    if (point.offset_ns > end_ns - start_ns) {
      return {Trouble::out_of_range, "offset_ns", double(point.offset_ns), double(end_ns - start_ns)};
    }
  }
  return {};
}

Status LidarInertialOdometry::Impl::check_selection(TimeNs span_ns, std::span<const LidarPoint> given,
                                                    const PointCounts& counts) const {
  if (counts.given == 0) return {Trouble::empty, "points", 0.0, 1.0};
  if (counts.finite == 0) return {Trouble::non_finite, "position_L_m", std::numeric_limits<double>::quiet_NaN(), 0.0};
  if (counts.used == 0) return {Trouble::too_few, "points in range", 0.0, 1.0};
  // a driver that lost its time stamps: nothing could be deskewed, and nothing would show it
  const auto differs = [&](const LidarPoint& point) { return point.offset_ns != given.front().offset_ns; };
  if (span_ns > 0 && given.size() > 1 && std::none_of(given.begin(), given.end(), differs)) {
    return {Trouble::degenerate, "spread of offset_ns", 0.0, 1.0};
  }
  return {};
}

Registration::Prior LidarInertialOdometry::Impl::prior() const {
  Registration::Prior prior;
  prior.state = state;
  if (samples.front().at_rest) mapping::hold_still(prior.state);
  const std::uint8_t axes = params.estimate_excess_rate ? trajectory.clipped_axes() : 0;
  prior.state.covariance += mapping::inertial_noise(params, trajectory, samples, axes);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(axes >> axis & 1)) continue;
    double sigma = params.excess_sigma_min_rad_s;
    for (const MotionSample& sample : samples) {
      if (sample.clipped_axes >> axis & 1) sigma = std::max(sigma, sample.rate_sigma_rad_s[axis]);
    }
    prior.excess_sigma_rad_s[axis] = sigma;
    if (excess_axes_at_end >> axis & 1) prior.excess_rad_s[axis] = excess_rad_s[axis];
  }
  prior.excess_start_rad_s = prior.excess_rad_s;
  return prior;
}

bool LidarInertialOdometry::Impl::prior_is_trusted() const {
  // clipped axes count in full here, also where the registration estimates their excess
  const Eigen::Matrix<double, 9, 9> P = state.covariance + mapping::inertial_noise(params, trajectory, samples, 0);
  const Eigen::Vector3d m2 = P.diagonal().head<3>(), rad2 = P.diagonal().segment<3>(3);
  return m2.maxCoeff() <= params.trusted_prior_m * params.trusted_prior_m &&
         rad2.maxCoeff() <= params.trusted_prior_rad * params.trusted_prior_rad;
}

void LidarInertialOdometry::Impl::choose_points() {
  compute_levers(trajectory, points, positions_W_m);
  for (std::size_t i = 0; i < points.size(); ++i) positions_W_m[i] += trajectory.base_m(points[i].t_s).cast<float>();
  sampler.choose(positions_W_m, params.sweep_voxel_m, chosen_index);
  chosen.clear();
  for (const std::uint32_t index : chosen_index) chosen.push_back(points[index]);
}

/// Registers; where that fails and the rate may be short on a clipped axis, tries again from larger excess rates, since
/// a rail that is left behind within one sweep may put the start a whole radian off.
Status LidarInertialOdometry::Impl::align(Registration::Prior prior, TimeNs end_ns, Registration::Result& result) {
  Status status = registration.align(prior, samples, end_ns, params.gravity_m_s2, chosen, map, trajectory, result);
  int iterations = result.iterations;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double more : kExcessTries_rad_s) {
      if (!status.ok() || result.verdict == RegistrationVerdict::converged) break;
      if (prior.excess_sigma_rad_s[axis] < more / 5.0) break;
      prior.excess_start_rad_s = prior.excess_rad_s;
      prior.excess_start_rad_s[axis] += more;
      status = registration.align(prior, samples, end_ns, params.gravity_m_s2, chosen, map, trajectory, result);
      iterations += result.iterations;
    }
  }
  result.iterations = iterations;
  return status;
}

void LidarInertialOdometry::Impl::register_sweep(TimeNs end_ns, SweepReport& report) {
  Registration::Result result;
  const bool prior_trusted = prior_is_trusted();
  const Status status = align(prior(), end_ns, result);
  report.iterations = result.iterations;
  report.inlier_share = result.points == 0 ? 0.0 : double(result.inliers) / double(result.points);
  if (!status.ok()) return;
  if (result.verdict == RegistrationVerdict::too_few && chosen.size() >= params.matches_min && prior_trusted) {
    report.verdict = SweepVerdict::degenerate;
  }
  if (result.verdict != RegistrationVerdict::converged) return;

  report.conditioning = result.eigenvalues[5] > 0.0 ? result.eigenvalues[0] / result.eigenvalues[5] : 0.0;
  report.weakest_direction = result.directions.col(0);
  report.verdict =
      report.conditioning < params.degenerate_conditioning ? SweepVerdict::degenerate : SweepVerdict::registered;
  report.excess_rate_rad_s = result.excess_rad_s;
  excess_rad_s = result.excess_rad_s;
}

/// Sweeps of a sensor that holds its attitude draw the same lines; one that turns draws new ones.
std::uint32_t LidarInertialOdometry::Impl::scan_line_base(bool rings_differ) {
  if (!rings_differ) return VoxelMap::kNoLine;
  const MotionState middle = trajectory.state(0.5 * trajectory.duration_s());
  const Eigen::Vector3d axis = middle.q_WI * params.T_IL.linear().col(2);
  if (axis.dot(scan_axis_W) < kSameLineCosine) {
    scan_axis_W = axis;
    ++scan_attitude;
  }
  return scan_attitude << kRingBits;
}

std::size_t LidarInertialOdometry::Impl::extend_map(bool rings_differ) {
  compute_levers(trajectory, points, positions_W_m);
  const std::uint32_t sweep = static_cast<std::uint32_t>(seen_from_W_m.size());
  const std::uint32_t line = scan_line_base(rings_differ);
  std::size_t added = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f position = positions_W_m[i] + trajectory.base_m(points[i].t_s).cast<float>();
    added += map.insert(position, static_cast<float>(registration.point_sigma_m(points[i])), sweep,
                        line == VoxelMap::kNoLine ? line : line | points[i].ring);
  }
  seen_from_W_m.push_back(trajectory.state(0.5 * trajectory.duration_s()).p_WI_m.cast<float>());
  return added;
}

void LidarInertialOdometry::Impl::finish(TimeNs end_ns, SweepReport& report) {
  for (std::size_t i = 0; i < trajectory.intervals(); ++i) {
    report.trajectory.push_back(trajectory.state(trajectory.interval_end_s(i)).pose());
  }
  state = trajectory.state(trajectory.duration_s());
  state.time_ns = end_ns;
  report.trajectory.back().time_ns = end_ns;
  report.pose = state.pose();

  const bool excess_held = report.verdict == SweepVerdict::registered || report.verdict == SweepVerdict::degenerate;
  excess_axes_at_end = 0;
  const auto after = std::find_if(samples.begin(), samples.end(), [&](const auto& s) { return s.time_ns > end_ns; });
  if (excess_held && after != samples.begin()) excess_axes_at_end = std::prev(after)->clipped_axes & kAllAxes;
  samples.erase(samples.begin(), after);
}

LidarInertialOdometry::LidarInertialOdometry(const Params& params) : impl_(std::make_unique<Impl>(params)) {}
LidarInertialOdometry::~LidarInertialOdometry() = default;
LidarInertialOdometry::LidarInertialOdometry(LidarInertialOdometry&&) noexcept = default;
LidarInertialOdometry& LidarInertialOdometry::operator=(LidarInertialOdometry&&) noexcept = default;
LidarInertialOdometry::LidarInertialOdometry(const LidarInertialOdometry& other)
    : impl_(std::make_unique<Impl>(*other.impl_)) {}
LidarInertialOdometry& LidarInertialOdometry::operator=(const LidarInertialOdometry& other) {
  impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}

Status LidarInertialOdometry::add_imu(const ImuSample& sample, const RateState& rate) {
  Impl& my = *impl_;
  if (!is_finite(sample)) return {Trouble::non_finite, "imu sample", std::numeric_limits<double>::quiet_NaN(), 0.0};
  if (!rate.w_WI_I_rad_s.allFinite() || !rate.covariance_rad2_s2.allFinite()) {
    return {Trouble::non_finite, "rate", std::numeric_limits<double>::quiet_NaN(), 0.0};
  }
  if (rate.time_ns != sample.time_ns) {
    return {Trouble::out_of_range, "rate.time_ns", double(rate.time_ns), double(sample.time_ns)};
  }
  const TimeNs last_ns = !my.samples.empty() ? my.samples.back().time_ns : my.state.time_ns;
  const bool follows = my.started || !my.samples.empty();
  if (follows && sample.time_ns <= last_ns) {
    return {Trouble::time_order, "time_ns", double(sample.time_ns), double(last_ns)};
  }
  // the first window's length is that of the second
  if (!my.started && my.samples.size() == 1) my.samples[0].from_ns = 2 * last_ns - sample.time_ns;
  const TimeNs from_ns = follows ? last_ns : sample.time_ns;
  const bool at_rest = my.rest.take(my.params, rate.w_WI_I_rad_s, sample.specific_force_m_s2);
  const Eigen::Vector3d rate_rad_s =
      at_rest ? Eigen::Vector3d::Zero() : Eigen::Vector3d(rate.w_WI_I_rad_s - my.rest.rate_bias_rad_s());
  my.samples.push_back({from_ns, sample.time_ns, rate_rad_s, sample.specific_force_m_s2,
                        mapping::believed_rate_sigma(my.params, rate, sample.time_ns - from_ns),
                        static_cast<std::uint8_t>(rate.clipped_axes & kAllAxes), at_rest});
  return {};
}

Status LidarInertialOdometry::add_sweep(TimeNs start_ns, TimeNs end_ns, std::span<const LidarPoint> points,
                                        SweepReport& report) {
  Impl& my = *impl_;
  report = SweepReport{};
  if (Status status = my.check_sweep(start_ns, end_ns, points); !status.ok()) return status;
  MotionState start = my.state;
  if (!my.started) {
    if (Status status = mapping::start_at_rest(my.samples, my.params.rest_s, start); !status.ok()) return status;
  }
  if (Status status = my.trajectory.build(start, my.samples, end_ns, my.params.gravity_m_s2); !status.ok())
    return status;
  my.state = start;
  my.started = true;

  const PointBounds bounds{my.params.range_min_m, my.params.range_max_m, my.params.own_body_L};
  const PointCounts counts =
      select_points(points, bounds, my.params.T_IL, seconds(start_ns - start.time_ns), my.points);
  report.points_used = counts.used;
  const Status status = my.check_selection(end_ns - start_ns, points, counts);
  const bool first = my.map.size() == 0;
  if (status.ok() && first && counts.used >= my.params.matches_min) {
    report.verdict = SweepVerdict::first;
  } else if (status.ok() && !first) {
    my.choose_points();
    report.points_registered = my.chosen.size();
    my.register_sweep(end_ns, report);
  }
  if (report.verdict == SweepVerdict::rejected) {
    MotionState loose = my.state;
    if (!first) loose = my.prior().state;
    if (Status built = my.trajectory.build(loose, my.samples, end_ns, my.params.gravity_m_s2); !built.ok())
      return built;
  } else {
    report.map_points_added = my.extend_map(counts.rings_differ);
  }
  my.finish(end_ns, report);
  return status;
}

std::vector<MapPoint> LidarInertialOdometry::map() const {
  const Impl& my = *impl_;
  std::vector<MapPoint> out;
  out.reserve(my.map.size());
  Neighbours found;
  for (std::uint32_t index = 0; index < my.map.index_end(); ++index) {
    if (!my.map.exists(index)) continue;
    MapPoint& point = out.emplace_back();
    point.position_W_m = my.map.position_W_m(index);
    point.sigma_m = my.map.sigma_m(index);
    my.map.nearest(point.position_W_m, my.params.neighbours, static_cast<float>(my.params.match_distance_m), found);
    const PlaneFit plane = fit_plane(my.map, found, PlaneBounds{});
    if (plane.verdict != PlaneVerdict::plane) continue;
    const Eigen::Vector3f towards = my.seen_from_W_m[my.map.sweep(index)] - point.position_W_m;
    point.normal_W = plane.normal_W.dot(towards) < 0.0f ? Eigen::Vector3f(-plane.normal_W) : plane.normal_W;
  }
  return out;
}

}  // namespace tumble
