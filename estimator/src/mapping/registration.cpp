// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/registration.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "../common/dense.hpp"
#include "state_estimate.hpp"
#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble {

namespace {

constexpr double kMatchRatioMin = 0.1;  // minimum ratio of matches to points

using Vector = Registration::Vector;
using Matrix = Registration::Matrix;
namespace u = mapping::unknowns;

Matrix information_of(const Matrix& covariance) {
  Matrix positive = covariance;
  positive.diagonal().array() += u::kMinVariance;
  return dense::Cholesky(positive).inverse<Matrix>();
}

/// See mapping.md (R22), (R23).
void add_prior(const Registration::Prior& prior, const Matrix& information, const Registration::Estimate& now,
               Matrix& H, Vector& g) {
  const auto held = std::make_unique<std::array<Matrix, 3>>();
  auto& [J, Jt, pull] = *held;
  J.setIdentity();
  const Vector away = now.minus(prior.mean);
  u::sub_block(J, u::attitude) = so3::left_jacobian_inverse(u::segment(away, u::attitude));
  Jt = J.transpose();
  mapping::propagate_covariance(Jt, information, pull);
  H += pull;
  g += J.transpose() * (information * away);
}

/// See mapping.md (R25).
bool agrees_with_prior(const Registration::Prior& prior, const Registration::Estimate& now) {
  constexpr int kMotionSize = Registration::kMotionSize;
  const Vector moved = now.minus(prior.mean);
  const Eigen::Matrix<double, kMotionSize, 1> away = u::segment(moved, u::motion);
  Eigen::Matrix<double, kMotionSize, kMotionSize> P = u::sub_block(prior.covariance, u::motion);
  P.diagonal().array() += u::kMinVariance;
  return away.dot(P.ldlt().solve(away)) <= u::kAgreementChi2Max;
}

bool is_converged_step(const Vector& step, double span_s, const Registration::Params& params) {
  const RegistrationExpertParams& below = params.expert;
  const bool lengths = u::segment(step, u::position).norm() < below.step_m &&
                       u::segment(step, u::velocity).norm() * span_s < below.step_m &&
                       u::segment(step, u::mounting_translation).norm() < below.step_m &&
                       u::segment(step, u::gravity).norm() * span_s * span_s < below.step_m;
  const bool angles = u::segment(step, u::attitude).norm() < below.step_rad &&
                      u::segment(step, u::deficit).cwiseAbs().maxCoeff() * span_s < below.step_rad &&
                      u::segment(step, u::mounting_rotation).norm() < below.step_rad;
  return lengths && angles && u::segment(step, u::clock).cwiseAbs().value() < below.step_s;
}

}  // namespace

void RegistrationUnknowns::Estimate::add(const Vector& error) {
  state.p_WI_m += u::segment(error, u::position);
  state.q_WI = (so3::exp(u::segment(error, u::attitude)) * state.q_WI).normalized();
  state.v_WI_m_s += u::segment(error, u::velocity);
  saturation_deficit_rad_s += u::segment(error, u::deficit).reshaped(3, SweepTrajectory::kKnots);
  calibration.add(u::segment(error, u::calibration));
}

Vector RegistrationUnknowns::Estimate::minus(const Estimate& other) const {
  Vector error;
  error << state.p_WI_m - other.state.p_WI_m, so3::logarithm(state.q_WI * other.state.q_WI.conjugate()),
      state.v_WI_m_s - other.state.v_WI_m_s, (saturation_deficit_rad_s - other.saturation_deficit_rad_s).reshaped(),
      calibration.minus(other.calibration);
  return error;
}

Registration::Registration(const Params& params) : params_(params) {
  require_valid_fields(params);
  require_in_interval("plane_neighbours_min", params.expert.plane.neighbours_min, 3, params.neighbours);
}

struct Registration::RegistrationProblem {
  const Prior& prior;
  std::span<const MotionSample> samples;
  TimeNs end_ns;
  std::span<const SweepPoint> points;  ///< positions computed with the prior's calibration
  const VoxelMap& map;
  Unknowns unknowns{prior.covariance};
  Matrix information = information_of(prior.covariance);
  std::size_t matches_needed = 0;

  Status build_trajectory(const Estimate& of, SweepTrajectory& trajectory) const {
    return trajectory.build(of.state, samples, end_ns, of.calibration.gravity_W_m_s2, of.saturation_deficit_rad_s);
  }
};

struct Registration::IterationState {
  Estimate now;
  std::span<const SweepPoint> points;  ///< positions computed with the current calibration
  Sums normal_equations;
  Matrix normal_matrix = Matrix::Zero();  ///< normal matrix, including the prior
  double kernel_m = 0.0;
  bool converged = false;
  RegistrationVerdict verdict = RegistrationVerdict::converged;  ///< any other value stops the iterations
};

Status Registration::align(const Prior& prior, std::span<const MotionSample> samples, TimeNs end_ns,
                           std::span<const SweepPoint> points, const VoxelMap& map, SweepTrajectory& trajectory,
                           Result& result) {
  const std::unique_ptr<RegistrationProblem> posed(new RegistrationProblem{prior, samples, end_ns, points, map});
  RegistrationProblem& problem = *posed;
  problem.matches_needed = std::max(params_.expert.matches_min,
                                    static_cast<std::size_t>(kMatchRatioMin * static_cast<double>(points.size())));
  std::destroy_at(&result);  // reconstructed in place, because a Result needs 22 KiB
  std::construct_at(&result);
  result.mean = prior.mean;
  result.covariance = prior.covariance;
  result.points = points.size();
  const std::unique_ptr<IterationState> descent(new IterationState{
      .now = prior.mean, .points = points, .normal_equations = {}, .kernel_m = params_.expert.kernel_min_m});
  IterationState& at = *descent;
  at.now.saturation_deficit_rad_s = prior.initial_saturation_deficit_rad_s;
  if (prior.start) at.now.state = *prior.start;
  if (Status status = problem.build_trajectory(at.now, trajectory); !status.ok()) return status;

  matches_.assign(points.size(), Match{});
  while (at.verdict == RegistrationVerdict::converged && !at.converged &&
         result.iterations < params_.expert.iterations_max) {
    ++result.iterations;
    if (Status status = iterate(problem, at, trajectory, result); !status.ok()) return status;
  }
  if (at.verdict == RegistrationVerdict::converged) at.verdict = registration_verdict(problem, at);
  if (at.verdict == RegistrationVerdict::converged) return finalise(problem, at, trajectory, result);
  result.verdict = result.matches < problem.matches_needed ? RegistrationVerdict::too_few_matches : at.verdict;
  return problem.build_trajectory(prior.mean, trajectory);
}

Status Registration::iterate(const RegistrationProblem& problem, IterationState& at, SweepTrajectory& trajectory,
                             Result& result) {
  const Estimate& mean = problem.prior.mean;
  if (problem.unknowns.calibration_free && result.iterations > 1) {
    apply_calibration(at.now.calibration,
                      at.now.calibration.imu_minus_lidar_clock_s - mean.calibration.imu_minus_lidar_clock_s,
                      problem.points, transformed_points_);
    at.points = transformed_points_;
  }
  match_points(trajectory, at.points, problem.map);
  at.kernel_m = kernel_width_m();
  accumulate(at.points, trajectory, at.now.calibration, problem.unknowns, at.kernel_m, at.normal_equations);
  result.matches = at.normal_equations.matches;
  result.inliers = at.normal_equations.inliers;
  if (at.normal_equations.matches < std::min(problem.matches_needed, params_.expert.agreeing_matches_needed)) {
    at.verdict = RegistrationVerdict::too_few_matches;
    return {};
  }

  Vector g;
  problem.unknowns.expand_to_all_unknowns(at.normal_equations, at.normal_matrix, g);
  add_prior(problem.prior, problem.information, at.now, at.normal_matrix, g);
  problem.unknowns.fix_constrained_unknowns(at.normal_matrix, g);
  dense::solve_semidefinite_vector(at.normal_matrix, g);
  const Vector step = -g;  // Gauss-Newton step: mapping.md (R23)
  if (!step.allFinite()) {
    at.verdict = RegistrationVerdict::diverged;
    return {};
  }
  at.now.add(step);
  if (Status status = problem.build_trajectory(at.now, trajectory); !status.ok()) return status;
  at.converged = is_converged_step(step, trajectory.duration_s(), params_);
  result.correction_m = (at.now.state.p_WI_m - mean.state.p_WI_m).norm();
  result.correction_rad = so3::logarithm(at.now.state.q_WI * mean.state.q_WI.conjugate()).norm();
  if (result.correction_m > params_.expert.correction_max_m ||
      result.correction_rad > params_.expert.correction_max_rad)
    at.verdict = RegistrationVerdict::diverged;
  return {};
}

RegistrationVerdict Registration::registration_verdict(const RegistrationProblem& problem,
                                                       const IterationState& at) const {
  // At a wrong local minimum of the cost, most matched points are far from their matched planes.
  const bool fits = static_cast<double>(at.normal_equations.inliers) >=
                    params_.expert.inlier_ratio_min * static_cast<double>(at.normal_equations.matches);
  if (!at.converged || !fits) return RegistrationVerdict::diverged;
  if (at.normal_equations.matches < problem.matches_needed && !agrees_with_prior(problem.prior, at.now))
    return RegistrationVerdict::too_few_matches;
  return RegistrationVerdict::converged;
}

Status Registration::finalise(const RegistrationProblem& problem, const IterationState& at, SweepTrajectory& trajectory,
                              Result& result) {
  Matrix posterior = Matrix::Identity();  // posterior covariance: mapping.md (R24)
  dense::solve_semidefinite(at.normal_matrix, posterior);
  result.covariance = 0.5 * (posterior + posterior.transpose());
  problem.unknowns.clear_fixed(result.covariance);
  result.mean = at.now;
  result.mean.state.covariance = u::sub_block(result.covariance, u::motion);
  result.verdict = at.verdict;
  if (Status status = problem.build_trajectory(result.mean, trajectory); !status.ok()) return status;
  compute_error_statistics(at.points, trajectory, at.now.calibration, problem.unknowns, at.kernel_m, result);
  compute_eigenvalues(at.points, at.kernel_m, at.normal_equations, result);
  return {};
}

/// See mapping.md (R30), (R31).
void Registration::compute_eigenvalues(std::span<const SweepPoint> points, double kernel_m, const Sums& sum,
                                       Result& result) const {
  Eigen::Matrix<double, 6, 6> shape = Eigen::Matrix<double, 6, 6>::Zero();  // robust weights without variances
  double weight = 0.0, lever2 = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (matches_[i].plane.verdict != PlaneVerdict::plane) continue;
    const double robust = compute_weight(points[i], matches_[i], residual_distances_m_[i], kernel_m).robust;
    const Eigen::Vector3d n = matches_[i].plane.normal_W.cast<double>(), lever = lever_arm_vectors_[i].cast<double>();
    Eigen::Matrix<double, 6, 1> j;
    j << n, lever.cross(n);
    shape += robust * j * j.transpose();
    weight += robust;
    lever2 += robust * lever.squaredNorm();
  }
  const double lever_m = std::sqrt(std::max(lever2 / weight, 1e-12));
  Eigen::Matrix<double, 6, 1> scale;
  scale << 1.0, 1.0, 1.0, 1.0 / lever_m, 1.0 / lever_m, 1.0 / lever_m;
  dense::decompose(scale.asDiagonal() * shape * scale.asDiagonal() / weight, result.eigenvalues, result.directions);
  result.eigenvalues = result.eigenvalues.cwiseMax(0.0).eval();
  Eigen::Matrix<double, 6, 1> information;
  dense::eigenvalues(
      scale.asDiagonal() *
          (u::sub_block(sum.normal_matrix, u::pose) - u::sub_block(result.surface_normal_noise_information, u::pose)) *
          scale.asDiagonal(),
      information);
  result.least_constrained_sigma_m = 1.0 / std::sqrt(std::max(information[0], 1e-12));
}

}  // namespace tumble
