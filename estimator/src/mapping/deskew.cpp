// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/deskew.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "relocalizer.hpp"
#include "sweep_points.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

// sine of 10 deg: minimum angle between a lidar beam and the line to an adjacent return on the same surface
// (Bogoslavskyi and Stachniss)
constexpr float kMinSurfaceSine = 0.17365f;
// sine of 2 deg: minimum angle between a lidar beam and the line through the two adjacent returns. If the angle between
// beam and line is smaller, the two adjacent returns count as two sides of an edge. A lidar 0.5 m above level ground
// sees the ground at an angle of 2 deg, at a distance of 14 m.
constexpr float kGrazingSine = 0.0349f;
constexpr float kBend = 0.15f;                     // relative tolerance of ranges on uneven ground
constexpr int kNeighbours = 2;                     // number of neighbours on each side along the ring
constexpr float kReachSteps = kNeighbours + 0.5f;  // angular steps; beams further apart are not neighbours
constexpr float kStepMax = 0.05f;                  // rad; the rings of 16-channel lidars are 0.035 rad apart
constexpr float kDeviations = 3.0f;
// In clear air, adjacent beams confirm at least 98.4 % of the returns, even for a thrown robot.
constexpr float kClearAirFraction = 0.02f;

float squared(float x) {
  return x * x;
}

}  // namespace

PointCounts select_points(std::span<const LidarPoint> points, const PointSelectionBounds& bounds,
                          const Eigen::Isometry3d& T_IL, double sweep_start_s, std::vector<SweepPoint>& selected) {
  selected.clear();
  PointCounts counts;
  counts.received = points.size();
  const Eigen::Matrix3f R = T_IL.linear().cast<float>();
  const Eigen::Vector3f p = T_IL.translation().cast<float>();
  const float near2 = static_cast<float>(bounds.range_min_m * bounds.range_min_m);
  const float far2 = static_cast<float>(bounds.range_max_m * bounds.range_max_m);
  const Eigen::AlignedBox3f body(bounds.own_body_L.min().cast<float>(), bounds.own_body_L.max().cast<float>());
  const bool has_body = !bounds.own_body_L.isEmpty();
  for (const LidarPoint& point : points) {
    if (!point.position_L_m.allFinite()) continue;
    ++counts.finite;
    const float range2 = point.position_L_m.squaredNorm();
    if (range2 < near2 || range2 > far2 || (has_body && body.contains(point.position_L_m))) continue;
    const double offset_s = seconds(point.offset_ns);
    selected.push_back({R * point.position_L_m + p, point.position_L_m, static_cast<float>(sweep_start_s + offset_s),
                        static_cast<float>(offset_s), std::sqrt(range2), point.ring});
    counts.has_ring_numbers |= point.ring != selected.front().ring;
  }
  counts.usable_points = selected.size();
  return counts;
}

void apply_calibration(const LidarImuCalibration& calibration, double later_s, std::span<const SweepPoint> points,
                       std::vector<SweepPoint>& moved) {
  moved.assign(points.begin(), points.end());
  apply_calibration(calibration, later_s, moved);
}

void apply_calibration(const LidarImuCalibration& calibration, double later_s, std::span<SweepPoint> points) {
  const Eigen::Matrix3f R = calibration.T_IL.linear().cast<float>();
  const Eigen::Vector3f p = calibration.T_IL.translation().cast<float>();
  for (SweepPoint& point : points) {
    point.x_I_m = R * point.point_L_m + p;
    point.t_s += static_cast<float>(later_s);
  }
}

/// See mapping.md (R3).
void compute_lever_arm_vectors(const SweepTrajectory& trajectory, std::span<const SweepPoint> points,
                               std::vector<Eigen::Vector3f>& levers_W_m) {
  levers_W_m.resize(points.size());
  trajectory.lever_arm_vectors(points, levers_W_m);
}

/// See mapping.md (R12).
void deskew(const SweepTrajectory& trajectory, std::span<const SweepPoint> points, double target_s,
            std::vector<Eigen::Vector3f>& positions_I_m) {
  compute_lever_arm_vectors(trajectory, points, positions_I_m);
  std::size_t hint = trajectory.intervals();
  const SweepTrajectory::PreintegratedMotion target = trajectory.at(target_s, hint);
  const Eigen::Vector3d origin = trajectory.gravity_free_position_m(target_s) + target.preintegrated_position_m;
  const Eigen::Quaterniond q_IW = target.q_WI.conjugate();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d world = trajectory.gravity_free_position_m(points[i].t_s) + positions_I_m[i].cast<double>();
    positions_I_m[i] = (q_IW * (world - origin)).cast<float>();
  }
}

void SweepSampler::choose_points_per_voxel(std::span<const Eigen::Vector3f> positions_W_m, double voxel_m,
                                           std::vector<std::uint32_t>& chosen) {
  occupied_voxels_.clear();
  chosen.clear();
  const float cubes_per_m = static_cast<float>(1.0 / voxel_m);
  for (std::uint32_t i = 0; i < positions_W_m.size(); ++i) {
    const Eigen::Vector3f scaled = positions_W_m[i] * cubes_per_m;
    if (!(scaled.cwiseAbs().maxCoeff() < static_cast<float>(SpatialHash::kCoordinateLimit - 2))) continue;
    if (occupied_voxels_.add(SpatialHash::key(scaled.array().floor().cast<int>()))) chosen.push_back(i);
  }
}

/// Returns the squared sine of the angle between two beams, or 1 if the angle is at least 90 deg.
float LoneReturns::sine2_between(const Beam& a, const Beam& b) {
  if (a.point_L_m.dot(b.point_L_m) <= 0.0f) return 1.0f;
  return a.point_L_m.cross(b.point_L_m).squaredNorm() / (squared(a.range_m) * squared(b.range_m));
}

float LoneReturns::variance_m2(const RangeNoise& noise, const Beam& beam) {
  return squared(std::max(static_cast<float>(noise.sigma_m), static_cast<float>(noise.range_fraction) * beam.range_m));
}

/// See mapping.md (R13).
bool LoneReturns::have_similar_range(const RangeNoise& noise, const Beam& a, const Beam& b) {
  return squared(a.range_m - b.range_m) <= squared(kDeviations) * (variance_m2(noise, a) + variance_m2(noise, b));
}

/// See mapping.md (R14).
bool LoneReturns::is_steep_surface(float sine, const Beam& a, const Beam& b) {
  const float farther = std::max(a.range_m, b.range_m);
  return a.point_L_m.cross(b.point_L_m).squaredNorm() >=
         squared(sine * farther) * (a.point_L_m - b.point_L_m).squaredNorm();
}

/// See mapping.md (R15).
bool LoneReturns::between(const RangeNoise& noise, const Beam& before, const Beam& beam, const Beam& after) {
  if (!is_steep_surface(kGrazingSine, before, after)) return false;
  const float to_before = std::sqrt(sine2_between(before, beam)), to_after = std::sqrt(sine2_between(beam, after));
  const float share = to_before / std::max(to_before + to_after, 1e-9f);
  const float expected_m = 1.0f / ((1.0f - share) / before.range_m + share / after.range_m);
  const float variance = variance_m2(noise, beam) + squared(1.0f - share) * variance_m2(noise, before) +
                         squared(share) * variance_m2(noise, after);
  const float bend_m = kBend * std::abs(before.range_m - after.range_m);
  return squared(beam.range_m - expected_m) <= std::max(squared(kDeviations) * variance, squared(bend_m));
}

/// adjacent returns of a lidar return on one side of its ring, nearest first
struct LoneReturns::NeighbouringBeams {
  std::array<const Beam*, kNeighbours> beam;
  int count = 0;

  auto begin() const { return beam.begin(); }
  auto end() const { return beam.begin() + count; }
};

bool LoneReturns::is_neighbour(std::size_t at, std::size_t other, float reach2) const {
  if (other >= beams_.size() || beams_[other].ring != beams_[at].ring) return false;
  const bool next = other + 1 == at || at + 1 == other;
  const float sine2 = next ? squared_beam_steps_[std::max(at, other)] : sine2_between(beams_[at], beams_[other]);
  return !(sine2 > reach2);
}

bool LoneReturns::is_confirmed(const RangeNoise& noise, std::size_t at, float reach2) const {
  const Beam& beam = beams_[at];
  const bool has_before = is_neighbour(at, at - 1, reach2);
  if (has_before && is_steep_surface(kMinSurfaceSine, beam, beams_[at - 1])) return true;
  const bool has_after = is_neighbour(at, at + 1, reach2);
  if (has_after && is_steep_surface(kMinSurfaceSine, beam, beams_[at + 1])) return true;
  const auto collect = [&](bool has_next, std::size_t direction) {
    NeighbouringBeams beside;
    std::size_t other = at + direction;
    for (bool goes_on = has_next; goes_on; goes_on = beside.count < kNeighbours && is_neighbour(at, other, reach2)) {
      beside.beam[static_cast<std::size_t>(beside.count++)] = &beams_[other];
      other += direction;
    }
    return beside;
  };
  const NeighbouringBeams before = collect(has_before, ~std::size_t{0}), after = collect(has_after, 1);
  const auto has_equal_range = [&](const Beam* other) { return have_similar_range(noise, beam, *other); };
  if (std::any_of(before.begin(), before.end(), has_equal_range)) return true;
  if (std::any_of(after.begin(), after.end(), has_equal_range)) return true;
  return std::any_of(before.begin(), before.end(), [&](const Beam* one) {
    return std::any_of(after.begin(), after.end(),
                       [&](const Beam* other) { return between(noise, *one, beam, *other); });
  });
}

void LoneReturns::sort_by_ring(const std::vector<SweepPoint>& points) {
  next_beam_on_ring_.assign(1, 0);
  for (const SweepPoint& point : points) {
    if (point.ring + 2u > next_beam_on_ring_.size()) next_beam_on_ring_.resize(point.ring + 2u, 0);
    ++next_beam_on_ring_[point.ring + 1u];
  }
  for (std::size_t ring = 1; ring < next_beam_on_ring_.size(); ++ring)
    next_beam_on_ring_[ring] += next_beam_on_ring_[ring - 1];
  beam_order_.resize(points.size());
  beams_.resize(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint32_t at = next_beam_on_ring_[points[i].ring]++;
    beam_order_[at] = i;
    beams_[at] = {points[i].point_L_m, points[i].range_m, points[i].ring};
  }
}

void LoneReturns::measure_beam_steps() {
  squared_beam_steps_.assign(beams_.size(), 1.0f);
  sorted_squared_beam_steps_.clear();
  for (std::size_t at = 1; at < beams_.size(); ++at) {
    if (beams_[at - 1].ring != beams_[at].ring) continue;
    squared_beam_steps_[at] = sine2_between(beams_[at - 1], beams_[at]);
    sorted_squared_beam_steps_.push_back(squared_beam_steps_[at]);
  }
}

float LoneReturns::median_step2() {
  if (sorted_squared_beam_steps_.empty()) return 1.0f;
  const auto middle =
      sorted_squared_beam_steps_.begin() + static_cast<std::ptrdiff_t>(sorted_squared_beam_steps_.size() / 2);
  std::nth_element(sorted_squared_beam_steps_.begin(), middle, sorted_squared_beam_steps_.end());
  return *middle;
}

std::size_t LoneReturns::drop_isolated_returns(const RangeNoise& noise, std::vector<SweepPoint>& points) {
  if (points.size() < 3) return 0;
  sort_by_ring(points);
  measure_beam_steps();
  const float step2 = median_step2();
  if (step2 > squared(kStepMax)) return 0;
  const float reach2 = squared(kReachSteps) * step2;
  isolated_.resize(points.size());
  for (std::size_t at = 0; at < beams_.size(); ++at) isolated_[beam_order_[at]] = !is_confirmed(noise, at, reach2);
  const auto dropped = static_cast<std::size_t>(std::count(isolated_.begin(), isolated_.end(), 1));
  if (static_cast<float>(dropped) <= kClearAirFraction * static_cast<float>(points.size())) return 0;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (isolated_[i] == 0) points[kept++] = points[i];
  }
  points.resize(kept);
  return dropped;
}

}  // namespace tumble

namespace tumble::mapping {

Status check_time_offsets(TimeNs span_ns, std::span<const LidarPoint> points) {
  for (const LidarPoint& point : points) {
    if (point.offset_ns > span_ns)
      return {ErrorCode::out_of_range, "offset_ns", double(point.offset_ns), double(span_ns)};
  }
  return {};
}

Status check_point_selection(TimeNs span_ns, std::span<const LidarPoint> points, const PointCounts& counts) {
  if (counts.received == 0) return {ErrorCode::empty, "points", 0.0, 1.0};
  if (counts.finite == 0) return {ErrorCode::non_finite, "position_L_m", std::numeric_limits<double>::quiet_NaN(), 0.0};
  if (counts.usable_points == 0) return {ErrorCode::insufficient_data, "points in range", 0.0, 1.0};
  const auto differs = [&](const LidarPoint& point) { return point.offset_ns != points.front().offset_ns; };
  if (span_ns > 0 && points.size() > 1 && std::none_of(points.begin(), points.end(), differs)) {
    return {ErrorCode::degenerate, "spread of offset_ns", 0.0, 1.0};
  }
  return {};
}

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
