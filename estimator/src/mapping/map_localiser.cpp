// SPDX-License-Identifier: BSD-3-Clause
#include "prior_scene.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "../common/dense.hpp"
#include "odometry_impl.hpp"
#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace u = unknowns;
using Matrix = Registration::Matrix;

namespace {

constexpr double kChanceAgreementMin = 0.7;
// The second-best pose of a search is probably wrong. The fraction of points that agree at the second-best pose
// therefore estimates the agreement by chance.
constexpr double kChanceMargin = 0.3;
constexpr double kFalseAcceptance = 1e-6;  // maximum probability that a search accepts a wrong pose
constexpr std::size_t kMinPoints = 100;    // minimum number of surface points for a search
constexpr double kMinCoveredRatio = 0.4;   // minimum fraction of surface points that the prior map covers
constexpr int kAcceptSweeps = 3;           // number of successive sweeps that accept a pose
constexpr int kRejectSweeps = 2;           // number of successive sweeps that reject a pose
constexpr int kSearchSweeps = 5;           // number of sweeps between two searches
// half of the size of the search region around an approximate pose, in standard deviations
constexpr double kSigmas = 3.0;
constexpr double kMinReach_m = 1.0, kMinReach_rad = 0.15;

double relative_entropy(double share, double chance) {
  double out = 0.0;
  if (share > 0.0) out += share * std::log(share / chance);
  if (share < 1.0) out += (1.0 - share) * std::log((1.0 - share) / (1.0 - chance));
  return out;
}

}  // namespace

void MapLocaliser::restart(const std::optional<Eigen::Isometry3d>& T_MI) {
  if (!has_map()) return;
  const bool moved = T_MI && (!map().start_T_MI || !T_MI->isApprox(*map().start_T_MI, 0.0));
  std::shared_ptr<const PriorMapScene> scene = prior_scene_;
  if (moved) {
    PriorMap map = prior_scene_->map();
    map.start_T_MI = T_MI;
    scene = std::make_shared<const PriorMapScene>(std::move(map));
  }
  *this = MapLocaliser();
  prior_scene_ = std::move(scene);
}

std::optional<FramePose> MapLocaliser::match_local_map(const VoxelMap& local, const Eigen::Vector3d& p_WI_m) {
  if (!has_map() || localised_) return std::nullopt;
  ++sweeps_since_search_;
  const bool searches = !T_prior_map_world_ && (attempts_ == 0 || sweeps_since_search_ >= kSearchSweeps);
  if (!T_prior_map_world_ && !searches) return std::nullopt;
  const std::vector<SurfacePoint> points = surface_points(local, p_WI_m.cast<float>(), kQueryRadius_m);
  if (points.size() < kMinPoints) return std::nullopt;
  if (searches) propose_map_pose(points, p_WI_m);
  if (!T_prior_map_world_) return std::nullopt;

  const FramePose pose = prior_scene_->refined_pose({.T_prior_map_world = *T_prior_map_world_}, points, p_WI_m, 0.4f);
  const bool enough = double(pose.covered_point_count) >= kMinCoveredRatio * double(points.size());
  if (!enough || !matches_prior_map(pose)) {
    successive_passed_tests_ = 0;
    if (++successive_failed_tests_ >= kRejectSweeps) T_prior_map_world_.reset();
    return std::nullopt;
  }
  T_prior_map_world_ = pose.T_prior_map_world;
  successive_failed_tests_ = 0;
  if (++successive_passed_tests_ < kAcceptSweeps) return std::nullopt;
  localised_ = true;
  return pose;
}

void MapLocaliser::propose_map_pose(const std::vector<SurfacePoint>& points, const Eigen::Vector3d& p_WI_m) {
  SearchRegion region;
  if (map().start_T_MI) {  // the given start pose also defines frame W, so W and M have nearly equal headings
    region.p_WI_m = region.centre_in_prior_map_m = map().start_T_MI->translation();
    region.search_radius_m = std::max(kSigmas * map().start_position_sigma_m, kMinReach_m);
    region.search_angle_rad = std::max(kSigmas * map().start_heading_sigma_rad, kMinReach_rad);
  }
  std::size_t tried = 0;
  const std::vector<FramePose> found = prior_scene_->find_candidate_poses(
      points, p_WI_m, static_cast<std::size_t>(attempts_), map().start_T_MI ? &region : nullptr, tried);
  ++attempts_;
  sweeps_since_search_ = successive_passed_tests_ = successive_failed_tests_ = 0;
  if (found.empty()) return;
  T_prior_map_world_ = found.front().T_prior_map_world;
  compared_pose_count_ = std::max(double(tried), 1.0);
  const double second = found.size() > 1 ? found[1].agreement_ratio() : 0.0;
  random_agreement_fraction_ = std::max(kChanceAgreementMin, second + kChanceMargin * (1.0 - second));
}

/// See mapping.md (R74).
bool MapLocaliser::matches_prior_map(const FramePose& pose) const {
  if (pose.agreement_ratio() <= random_agreement_fraction_ || random_agreement_fraction_ >= 1.0) return false;
  return double(pose.covered_point_count) * relative_entropy(pose.agreement_ratio(), random_agreement_fraction_) >=
         std::log(compared_pose_count_ / kFalseAcceptance);
}

Status MapLocaliser::status() const {
  if (!has_map() || localised_) return {};
  return {ErrorCode::degenerate, "number of sweeps that agree with the prior map (too few to localise the run)",
          double(successive_passed_tests_), double(kAcceptSweeps)};
}

Matrix FrameChange::rotation() const {
  Matrix T = Matrix::Identity();
  const Eigen::Matrix3d R = T_prior_map_world.linear();
  u::sub_block(T, u::position) = R;
  u::sub_block(T, u::attitude) = R;
  u::sub_block(T, u::velocity) = R;
  u::sub_block(T, u::gravity) = R;
  return T;
}

void FrameChange::apply(Registration::Estimate& mean) const {
  const Eigen::Quaterniond q_MW(T_prior_map_world.linear());
  MotionState& state = mean.state;
  state.p_WI_m = T_prior_map_world * state.p_WI_m;
  state.q_WI = (q_MW * state.q_WI).normalized();
  state.v_WI_m_s = q_MW * state.v_WI_m_s;
  mean.calibration.gravity_W_m_s2 = q_MW * mean.calibration.gravity_W_m_s2;
  Matrix of_motion = Matrix::Zero();
  u::sub_block(of_motion, u::motion) = state.covariance;
  apply(mean, of_motion);
  state.covariance = u::sub_block(of_motion, u::motion);
}

void FrameChange::apply(const Registration::Estimate& mean, Matrix& of_all) const {
  const Matrix T = rotation();
  Matrix turned;
  propagate_covariance(T, of_all, turned);
  Eigen::Matrix<double, Registration::kUnknowns, 6> J = Eigen::Matrix<double, Registration::kUnknowns, 6>::Zero();
  u::row_range(J, u::position).leftCols<3>().setIdentity();
  u::row_range(J, u::position).rightCols<3>() = -so3::hat(mean.state.p_WI_m - sensor_in_prior_map_m);
  u::row_range(J, u::attitude).rightCols<3>().setIdentity();
  u::row_range(J, u::velocity).rightCols<3>() = -so3::hat(mean.state.v_WI_m_s);
  const bool free_gravity = u::variances(of_all, u::gravity).maxCoeff() > 0.0;
  if (free_gravity) u::row_range(J, u::gravity).rightCols<3>() = -so3::hat(mean.calibration.gravity_W_m_s2);
  of_all = turned + J * covariance * J.transpose();
  make_symmetric(of_all);
}

void FrameChange::apply(SweepBoundary& boundary) const {
  StateEstimate& estimate = boundary.state_estimate;
  apply(estimate.mean);
  apply(estimate.mean, estimate.prior_weight_covariance);
  apply(estimate.mean, estimate.state_error_covariance);
  estimate.mean.state.covariance = u::sub_block(estimate.prior_weight_covariance, u::motion);
  const Matrix T = rotation();
  Matrix turned;
  propagate_covariance(T, boundary.end_by_start_jacobian, turned);
  boundary.end_by_start_jacobian = turned;
  boundary.clipped_velocity_variance_m2_s2 =
      (T_prior_map_world.linear() * boundary.clipped_velocity_variance_m2_s2 * T_prior_map_world.linear().transpose())
          .eval();
}

void FrameChange::apply(LagWindow& window) const {
  const Matrix T = rotation();
  window.for_each([&](WindowSweep& sweep) {
    for (EstimatedSweep* estimated : {&sweep.predicted, &sweep.filtered, &sweep.smoothed}) {
      apply(estimated->mean);
      apply(estimated->mean, estimated->error_covariance);
    }
    Matrix turned;
    propagate_covariance(T, sweep.jacobian_previous, turned);
    sweep.jacobian_previous = turned;
  });
}

PosesBeforeChange::PosesBeforeChange(const FrameChange& change, const PoseState& last)
    : T_prior_map_world_(change.T_prior_map_world), last_M_m_(change.T_prior_map_world * last.position_W_m) {
  Eigen::Matrix<double, 6, 6> R = Eigen::Matrix<double, 6, 6>::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = T_prior_map_world_.linear();
  last_covariance_M_ = R * last.covariance * R.transpose() + change.covariance;
}

void PosesBeforeChange::apply(PoseState& pose) const {
  const Eigen::Quaterniond q_MW(T_prior_map_world_.linear());
  pose.position_W_m = T_prior_map_world_ * pose.position_W_m;
  pose.orientation_W = (q_MW * pose.orientation_W).normalized();
  pose.velocity_W_m_s = q_MW * pose.velocity_W_m_s;
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Identity();
  A.topRightCorner<3, 3>() = -so3::hat(pose.position_W_m - last_M_m_);
  pose.covariance = A * last_covariance_M_ * A.transpose();
  make_symmetric(pose.covariance);
}

}  // namespace tumble::mapping

namespace tumble {

Status LidarInertialOdometry::set_prior_map(PriorMap map) {
  if (const Status status = check_prior_map(map); !status.ok()) return status;
  if (mapping::has_started(impl_->tracking))
    return {ErrorCode::time_order, "number of sweeps before the prior map", 1.0, 0.0};
  if (map.start_T_MI) set_start_pose(*map.start_T_MI);
  impl_->localiser = mapping::MapLocaliser(std::move(map));
  return {};
}

void LidarInertialOdometry::copy_prior_map(const LidarInertialOdometry& other) {
  impl_->localiser = other.impl_->localiser;
  impl_->localiser.restart(impl_->start_pose);
  const PriorMap* const map = prior_map();
  if (!impl_->start_pose && map != nullptr && map->start_T_MI) set_start_pose(*map->start_T_MI);
}

Status LidarInertialOdometry::check_localised() const {
  return impl_->localiser.status();
}

Status LidarInertialOdometry::convert_to_prior_map_frame(std::span<PoseState> poses) const {
  if (!impl_->poses_before_localisation)
    return {ErrorCode::degenerate, "number of localisations in a prior map", 0.0, 1.0};
  for (PoseState& pose : poses) impl_->poses_before_localisation->apply(pose);
  return {};
}

const PriorMap* LidarInertialOdometry::prior_map() const {
  return impl_->localiser.has_map() ? &impl_->localiser.map() : nullptr;
}

/// After a tracking failure, or while a relocalisation is unconfirmed, the local map may be wrong and is not compared
/// with the prior map.
void LidarInertialOdometry::Impl::localise(const SweepResult& report) {
  if (!localiser.has_map() || localiser.is_localised()) return;
  if (report.verdict != SweepVerdict::registered || !std::holds_alternative<mapping::Tracking>(tracking)) return;
  const std::optional<mapping::FramePose> pose =
      localiser.match_local_map(map.voxels(), sweep_boundary.state_estimate.mean.state.p_WI_m);
  if (pose) enter_prior_map(*pose, report.pose);
}

void LidarInertialOdometry::Impl::enter_prior_map(const mapping::FramePose& pose, const PoseState& last) {
  const Eigen::Vector3d sensor_M_m = pose.T_prior_map_world * sweep_boundary.state_estimate.mean.state.p_WI_m;
  const mapping::FrameChange change{pose.T_prior_map_world, pose.covariance, sensor_M_m};
  poses_before_localisation.emplace(change, last);
  change.apply(sweep_boundary);
  change.apply(window);
  window.clear_inserted();  // the indices of the points change
  const Eigen::Isometry3f T_MW = pose.T_prior_map_world.cast<float>();
  map.start_from_map_points(params, localiser.map().points, localiser.map().extend ? &T_MW : nullptr);
  world_covariance = mapping::WorldCovariance::covariance_in_prior_map(params.expert.world_covariance, sensor_M_m);
}

}  // namespace tumble
