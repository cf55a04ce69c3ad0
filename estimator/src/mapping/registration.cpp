// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

using Vector = Registration::Vector;
using Matrix = Registration::Matrix;

constexpr int kRigid = Registration::kMotion;
constexpr int kUnknowns = Registration::kUnknowns;
// variance given to an unknown whose prior claims none, so that the prior can be inverted
constexpr double kLeastVariance = 1e-12;

/// The prior as one normal distribution; unknowns that are not estimated are marked.
struct JointPrior {
  Matrix covariance = Matrix::Zero();
  Matrix information = Matrix::Zero();
  std::array<bool, kUnknowns> held{};
  bool rigid = true;  // neither excess nor calibration is free
  bool calibrates = false;

  explicit JointPrior(const Registration::Prior& prior) {
    constexpr int kCal = Registration::kCalibration;
    covariance.topLeftCorner<kRigid, kRigid>() = prior.state.covariance;
    covariance.diagonal().segment<3>(Registration::kExcess) = prior.excess_sigma_rad_s.cwiseAbs2();
    covariance.bottomRightCorner<SweepCalibration::kErrors, SweepCalibration::kErrors>() = prior.calibration_covariance;
    covariance.block<kRigid, SweepCalibration::kErrors>(0, kCal) = prior.motion_calibration;
    covariance.block<SweepCalibration::kErrors, kRigid>(kCal, 0) = prior.motion_calibration.transpose();
    for (int i = kRigid; i < kUnknowns; ++i) {
      held[static_cast<std::size_t>(i)] = covariance(i, i) <= 0.0;
      if (covariance(i, i) <= 0.0) continue;
      rigid = false;
      calibrates = calibrates || i >= kCal;
    }
    Matrix positive = covariance;
    positive.diagonal().array() += kLeastVariance;
    information = positive.llt().solve(Matrix::Identity());
  }
};

/// Where the iterations stand.
struct Estimate {
  MotionState state;
  Eigen::Vector3d excess_rad_s;
  SweepCalibration calibration;

  void add(const Vector& step) {
    state.p_WI_m += step.segment<3>(0);
    state.q_WI = (so3::exp(step.segment<3>(3)) * state.q_WI).normalized();
    state.v_WI_m_s += step.segment<3>(6);
    excess_rad_s += step.segment<3>(Registration::kExcess);
    calibration.add(step.tail<SweepCalibration::kErrors>());
  }
};

/// Pulls the estimate towards the prior: adds its information and gradient to the normal equations.
void add_prior(const Registration::Prior& prior, const JointPrior& joint, const Estimate& now, Matrix& H, Vector& g) {
  const Eigen::Vector3d turned = so3::log(now.state.q_WI * prior.state.q_WI.conjugate());
  Vector away;
  away << now.state.p_WI_m - prior.state.p_WI_m, turned, now.state.v_WI_m_s - prior.state.v_WI_m_s,
      now.excess_rad_s - prior.excess_rad_s, now.calibration.minus(prior.calibration);
  Matrix J = Matrix::Identity();
  J.block<3, 3>(3, 3) = so3::left_jacobian_inverse(turned);
  H += J.transpose() * joint.information * J;
  g += J.transpose() * (joint.information * away);
  for (int i = 0; i < kUnknowns; ++i) {
    if (!joint.held[static_cast<std::size_t>(i)]) continue;
    // not estimated: its row and column are cut, its step is zero
    H.row(i).setZero();
    H.col(i).setZero();
    H(i, i) = 1.0;
    g[i] = 0.0;
  }
}

bool is_small(const Vector& step, double span_s, const Registration::Params& params) {
  constexpr int kCal = Registration::kCalibration;
  const bool lengths = step.segment<3>(0).norm() < params.step_m &&
                       step.segment<3>(6).norm() * span_s < params.step_m &&
                       step.segment<3>(kCal + 3).norm() < params.step_m &&
                       step.segment<3>(kCal + 7).norm() * span_s * span_s < params.step_m;
  return lengths && step.segment<3>(3).norm() < params.step_rad &&
         step.segment<3>(Registration::kExcess).norm() * span_s < params.step_rad &&
         step.segment<3>(kCal).norm() < params.step_rad && std::abs(step[kCal + 6]) < 1e-5;
}

}  // namespace

/// Sums over the matches of one iteration.
struct Registration::Normal {
  Matrix H = Matrix::Zero();
  Vector g = Vector::Zero();
  Eigen::Matrix<double, 6, 6> shape = Eigen::Matrix<double, 6, 6>::Zero();  // robustly weighted, without variances
  double weight = 0.0;
  double lever2 = 0.0;
  std::size_t matches = 0;
  std::size_t inliers = 0;
};

Registration::Registration(const Params& params) : params_(params) {
  require_within("neighbours", params.neighbours, 3, Neighbours::kMax);
  require_within("match_distance_m", params.match_distance_m, 1e-3, 10.0);
  require_within("iterations_max", params.iterations_max, 1, 200);
  require_within("step_m", params.step_m, 1e-12, 1.0);
  require_within("step_rad", params.step_rad, 1e-12, 1.0);
  require_within("rematch_m", params.rematch_m, 0.0, 10.0);
  require_within("range_sigma_m", params.range_sigma_m, 1e-6, 10.0);
  require_within("range_sigma_share", params.range_sigma_share, 0.0, 1.0);
  require_within("skew_sigma_m_s", params.skew_sigma_m_s, 0.0, 1e3);
  require_within("kernel_min_m", params.kernel_min_m, 1e-6, 1e3);
  require_within("information_share", params.information_share, 1e-6, 1.0);
  require_within("matched_share_min", params.matched_share_min, 0.0, 1.0);
  require_within("fitting_share_min", params.fitting_share_min, 0.0, 1.0);
  require_within("correction_max_m", params.correction_max_m, 0.0, 1e6);
  require_within("correction_max_rad", params.correction_max_rad, 0.0, 3.15);
  require_within("plane.neighbours_min", params.plane.neighbours_min, 3, params.neighbours);
  require_within("plane.collinear_share", params.plane.collinear_share, 0.0, 1.0);
  require_within("plane.rough_share", params.plane.rough_share, 0.0, 1.0);
}

double Registration::point_sigma_m(const SweepPoint& point) const {
  const double range = std::max(params_.range_sigma_m, params_.range_sigma_share * point.range_m);
  const double skew = params_.skew_sigma_m_s * point.sweep_t_s;
  return std::sqrt(range * range + skew * skew);
}

double Registration::residual(const SweepTrajectory& trajectory, const SweepCalibration& calibration,
                              const SweepPoint& point, const PlaneFit& plane, std::size_t& hint, Vector& derivative) {
  const SweepTrajectory::Instant now = trajectory.at(point.t_s, hint);
  const Eigen::Vector3d x_I = point.x_I_m.cast<double>();
  const Eigen::Vector3d turned = now.q_WI * x_I;
  const Eigen::Vector3d lever = now.thrust_m + turned;
  const Eigen::Vector3d n = plane.normal_W.cast<double>();
  const Eigen::Vector3d n_I = now.q_WI.conjugate() * n;
  const SweepTrajectory::ExcessDerivative by_excess = trajectory.excess_derivative(point.t_s, hint);
  const double t = point.t_s;
  derivative << n, lever.cross(n), t * n,
      (by_excess.thrust_m_s - so3::hat(turned) * by_excess.attitude_s).transpose() * n,
      (x_I - calibration.T_IL.translation()).cross(n_I), n_I, n.dot(trajectory.velocity_m_s(t, x_I, hint)),
      (0.5 * t * t) * n;
  return n.dot(trajectory.base_m(t) + lever - plane.centre_W_m.cast<double>());
}

void Registration::find_matches(const VoxelMap& map, std::span<const SweepPoint> points) {
  const float rematch2 = static_cast<float>(params_.rematch_m * params_.rematch_m);
  Neighbours found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Match& match = matches_[i];
    if (match.searched && (positions_[i] - match.searched_at_W_m).squaredNorm() <= rematch2) continue;
    match.searched = true;
    match.searched_at_W_m = positions_[i];
    map.nearest(positions_[i], params_.neighbours, static_cast<float>(params_.match_distance_m), found);
    match.plane = fit_plane(map, found, params_.plane);
    if (match.plane.verdict != PlaneVerdict::plane) continue;
    float variance = 0.0f;
    for (int k = 0; k < found.count; ++k) {
      const float sigma = map.sigma_m(found.index[k]);
      variance += sigma * sigma;
    }
    match.map_variance_m2 = variance / static_cast<float>(found.count) + match.plane.thickness2_m2;
  }
}

double Registration::kernel_width_m() {
  sorted_.clear();
  for (std::size_t i = 0; i < matches_.size(); ++i) {
    if (matches_[i].plane.verdict == PlaneVerdict::plane) sorted_.push_back(std::abs(distances_[i]));
  }
  if (sorted_.empty()) return params_.kernel_min_m;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  // three standard deviations of a normal distribution with this median of the absolute value
  return std::max(params_.kernel_min_m, 3.0 * 1.4826 * static_cast<double>(*middle));
}

Registration::Normal Registration::accumulate(std::span<const SweepPoint> points, const SweepTrajectory& trajectory,
                                              const SweepCalibration& calibration, bool rigid, double kernel_m) {
  Normal sum;
  std::size_t hint = 0;
  const double kernel2 = kernel_m * kernel_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Match& match = matches_[i];
    if (match.plane.verdict != PlaneVerdict::plane) continue;
    const double r = distances_[i];
    const double sigma = point_sigma_m(points[i]);
    const double variance = sigma * sigma + match.map_variance_m2;
    const double soft = 1.0 + r * r / kernel2;
    const double robust = 1.0 / (soft * soft);
    const double w = robust * params_.information_share / variance;
    const Eigen::Vector3d n = match.plane.normal_W.cast<double>();
    const Eigen::Vector3d lever = levers_[i].cast<double>();
    Eigen::Matrix<double, kRigid, 1> j;
    j << n, lever.cross(n), static_cast<double>(points[i].t_s) * n;
    if (!rigid) {
      Vector full;
      residual(trajectory, calibration, points[i], match.plane, hint, full);
      sum.H.selfadjointView<Eigen::Lower>().rankUpdate(full, w);
      sum.g += (w * r) * full;
    } else {
      sum.H.topLeftCorner<kRigid, kRigid>().selfadjointView<Eigen::Lower>().rankUpdate(j, w);
      sum.g.head<kRigid>() += (w * r) * j;
    }
    sum.shape.selfadjointView<Eigen::Lower>().rankUpdate(j.head<6>(), robust);
    sum.weight += robust;
    sum.lever2 += robust * lever.squaredNorm();
    ++sum.matches;
    if (r * r <= 9.0 * variance) ++sum.inliers;
  }
  const Matrix lower = sum.H;
  sum.H = lower.selfadjointView<Eigen::Lower>();
  return sum;
}

Status Registration::align(const Prior& prior, std::span<const MotionSample> samples, TimeNs end_ns,
                           std::span<const SweepPoint> given, const VoxelMap& map, SweepTrajectory& trajectory,
                           Result& result) {
  const JointPrior joint(prior);
  result = Result{};
  result.state = prior.state;
  result.calibration = prior.calibration;
  result.excess_rad_s = prior.excess_rad_s;
  result.excess_sigma_rad_s = prior.excess_sigma_rad_s;
  result.covariance = joint.covariance;
  result.points = given.size();
  Estimate now{prior.state, prior.excess_start_rad_s, prior.calibration};
  const auto build = [&](const Estimate& from) {
    return trajectory.build(from.state, samples, end_ns, from.calibration.gravity_W_m_s2, from.excess_rad_s);
  };
  if (Status status = build(now); !status.ok()) return status;

  std::span<const SweepPoint> points = given;
  matches_.assign(points.size(), Match{});
  positions_.resize(points.size());
  distances_.resize(points.size());
  const std::size_t matches_needed = std::max(
      params_.matches_min, static_cast<std::size_t>(params_.matched_share_min * static_cast<double>(points.size())));
  Normal sum;
  Matrix H = Matrix::Zero();
  const auto refuse = [&](RegistrationVerdict verdict) {
    result.verdict = verdict;
    return build({prior.state, prior.excess_rad_s, prior.calibration});
  };
  bool settled = false;
  while (!settled && result.iterations < params_.iterations_max) {
    ++result.iterations;
    if (joint.calibrates && result.iterations > 1) {
      apply_calibration(now.calibration, now.calibration.time_offset_s - prior.calibration.time_offset_s, given,
                        moved_);
      points = moved_;
    }
    compute_levers(trajectory, points, levers_);
    for (std::size_t i = 0; i < points.size(); ++i) {
      positions_[i] = (trajectory.base_m(points[i].t_s) + levers_[i].cast<double>()).cast<float>();
    }
    find_matches(map, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      distances_[i] = matches_[i].plane.normal_W.dot(positions_[i] - matches_[i].plane.centre_W_m);
    }
    sum = accumulate(points, trajectory, now.calibration, joint.rigid, kernel_width_m());
    result.matches = sum.matches;
    result.inliers = sum.inliers;
    if (sum.matches < matches_needed) return refuse(RegistrationVerdict::too_few);

    H = sum.H;
    Vector g = sum.g;
    add_prior(prior, joint, now, H, g);
    const Vector step = -H.ldlt().solve(g);
    if (!step.allFinite()) return refuse(RegistrationVerdict::diverged);
    now.add(step);
    if (Status status = build(now); !status.ok()) return status;
    settled = is_small(step, trajectory.duration_s(), params_);
    result.correction_m = (now.state.p_WI_m - prior.state.p_WI_m).norm();
    result.correction_rad = so3::log(now.state.q_WI * prior.state.q_WI.conjugate()).norm();
    if (result.correction_m > params_.correction_max_m || result.correction_rad > params_.correction_max_rad) break;
  }
  // a false minimum: most matches lie off their planes
  const bool fits = static_cast<double>(sum.inliers) >= params_.fitting_share_min * static_cast<double>(sum.matches);
  if (!settled || !fits) return refuse(RegistrationVerdict::diverged);

  const Matrix posterior = H.ldlt().solve(Matrix::Identity());
  result.covariance = 0.5 * (posterior + posterior.transpose());
  for (int i = 0; i < kUnknowns; ++i) {
    if (joint.held[static_cast<std::size_t>(i)]) result.covariance(i, i) = 0.0;
  }
  result.state = now.state;
  result.state.covariance = result.covariance.topLeftCorner<kRigid, kRigid>();
  result.excess_rad_s = now.excess_rad_s;
  result.excess_sigma_rad_s = result.covariance.diagonal().segment<3>(kExcess).cwiseMax(0.0).cwiseSqrt();
  result.calibration = now.calibration;
  result.verdict = RegistrationVerdict::converged;
  describe_shape(sum, result);
  return build({result.state, result.excess_rad_s, result.calibration});
}

void Registration::describe_shape(const Normal& sum, Result& result) {
  const double lever_m = std::sqrt(std::max(sum.lever2 / sum.weight, 1e-12));
  Eigen::Matrix<double, 6, 1> scale;
  scale << 1.0, 1.0, 1.0, 1.0 / lever_m, 1.0 / lever_m, 1.0 / lever_m;
  const Eigen::Matrix<double, 6, 6> full = sum.shape.selfadjointView<Eigen::Lower>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(scale.asDiagonal() * full *
                                                                          scale.asDiagonal() / sum.weight);
  result.eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  result.directions = solver.eigenvectors();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> information(
      scale.asDiagonal() * sum.H.topLeftCorner<6, 6>() * scale.asDiagonal(), Eigen::EigenvaluesOnly);
  result.weakest_sigma_m = 1.0 / std::sqrt(std::max(information.eigenvalues()[0], 1e-12));
}

}  // namespace tumble
