// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "registration_sums.hpp"
#include "tumble/common/so3.hpp"
#include "unknowns.hpp"

namespace tumble {

namespace {

using Vector = Registration::Vector;
using Matrix = Registration::Matrix;

Matrix information_of(const Matrix& covariance) {
  Matrix positive = covariance;
  positive.diagonal().array() += mapping::unknowns::kLeastVariance;
  return positive.llt().solve(Matrix::Identity());
}

/// Pulls the estimate towards the prior: adds its information and gradient to normal equations over all unknowns, those
/// terms of mapping.md (R20), (R21) that hold the prior.
void add_prior(const Registration::Prior& prior, const Matrix& information, const Registration::Estimate& now,
               Matrix& H, Vector& g) {
  Matrix J = Matrix::Identity();
  const Vector away = now.minus(prior.mean);
  J.block<3, 3>(3, 3) = so3::left_jacobian_inverse(away.segment<3>(3));
  H += J.transpose() * information * J;
  g += J.transpose() * (information * away);
}

/// Whether the motion is within what the prior says it may be off by: mapping.md (R59).
bool agrees(const Registration::Prior& prior, const Registration::Estimate& now) {
  constexpr int kMotion = Registration::kMotion;
  const auto away = now.minus(prior.mean).head<kMotion>().eval();
  Eigen::Matrix<double, kMotion, kMotion> P = prior.covariance.topLeftCorner<kMotion, kMotion>();
  P.diagonal().array() += mapping::unknowns::kLeastVariance;
  return away.dot(P.ldlt().solve(away)) <= mapping::unknowns::kAgrees;
}

bool is_small(const Vector& step, double span_s, const Registration::Params& params) {
  constexpr int kCal = Registration::kCalibration;
  const bool lengths = step.segment<3>(0).norm() < params.expert.step_m &&
                       step.segment<3>(6).norm() * span_s < params.expert.step_m &&
                       step.segment<3>(kCal + 3).norm() < params.expert.step_m &&
                       step.segment<3>(kCal + 7).norm() * span_s * span_s < params.expert.step_m;
  return lengths && step.segment<3>(3).norm() < params.expert.step_rad &&
         step.segment<SweepTrajectory::kExcess>(Registration::kExcess).cwiseAbs().maxCoeff() * span_s <
             params.expert.step_rad &&
         step.segment<3>(kCal).norm() < params.expert.step_rad && std::abs(step[kCal + 6]) < 1e-5;
}

}  // namespace

void SweepUnknowns::Estimate::add(const Vector& error) {
  state.p_WI_m += error.segment<3>(0);
  state.q_WI = (so3::exp(error.segment<3>(3)) * state.q_WI).normalized();
  state.v_WI_m_s += error.segment<3>(6);
  excess_rad_s += error.segment<SweepTrajectory::kExcess>(kExcess).reshaped(3, SweepTrajectory::kKnots);
  calibration.add(error.tail<SweepCalibration::kErrors>());
}

Vector SweepUnknowns::Estimate::minus(const Estimate& other) const {
  Vector error;
  error << state.p_WI_m - other.state.p_WI_m, so3::log(state.q_WI * other.state.q_WI.conjugate()),
      state.v_WI_m_s - other.state.v_WI_m_s, (excess_rad_s - other.excess_rad_s).reshaped(),
      calibration.minus(other.calibration);
  return error;
}

Registration::Registration(const Params& params) : params_(params) {
  require_fields(params);
  require_within("plane_neighbours_min", params.expert.plane.neighbours_min, 3, params.neighbours);
}

Status Registration::align(const Prior& prior, std::span<const MotionSample> samples, TimeNs end_ns,
                           std::span<const SweepPoint> given, const VoxelMap& map, SweepTrajectory& trajectory,
                           Result& result) {
  const Unknowns unknowns(prior.covariance);
  const Matrix information = information_of(prior.covariance);
  result = Result{};
  result.mean = prior.mean;
  result.covariance = prior.covariance;
  result.points = given.size();
  Estimate now = prior.mean;
  now.excess_rad_s = prior.excess_start_rad_s;
  if (prior.start) now.state = *prior.start;
  const auto build = [&](const Estimate& from) {
    return trajectory.build(from.state, samples, end_ns, from.calibration.gravity_W_m_s2, from.excess_rad_s);
  };
  if (Status status = build(now); !status.ok()) return status;

  std::span<const SweepPoint> points = given;
  matches_.assign(points.size(), Match{});
  const std::size_t matches_needed =
      std::max(params_.matches_min,
               static_cast<std::size_t>(params_.expert.matched_share_min * static_cast<double>(points.size())));
  Sums sum;
  Matrix H = Matrix::Zero();
  double kernel_m = params_.expert.kernel_min_m;
  const auto refuse = [&](RegistrationVerdict verdict) {
    result.verdict = result.matches < matches_needed ? RegistrationVerdict::too_few : verdict;
    return build(prior.mean);
  };
  bool converged = false;
  while (!converged && result.iterations < params_.iterations_max) {
    ++result.iterations;
    if (unknowns.calibration && result.iterations > 1) {
      apply_calibration(now.calibration, now.calibration.time_offset_s - prior.mean.calibration.time_offset_s, given,
                        moved_);
      points = moved_;
    }
    place(trajectory, points, map);
    kernel_m = kernel_width_m();
    accumulate(points, trajectory, now.calibration, unknowns, kernel_m, sum);
    result.matches = sum.matches;
    result.inliers = sum.inliers;
    if (sum.matches < std::min(matches_needed, params_.expert.agreeing_min))
      return refuse(RegistrationVerdict::too_few);

    Vector g;
    unknowns.expand(sum, H, g);
    add_prior(prior, information, now, H, g);
    unknowns.hold(H, g);
    const Vector step = -H.ldlt().solve(g);  // mapping.md (R21)
    if (!step.allFinite()) return refuse(RegistrationVerdict::diverged);
    now.add(step);
    if (Status status = build(now); !status.ok()) return status;
    converged = is_small(step, trajectory.duration_s(), params_);
    result.correction_m = (now.state.p_WI_m - prior.mean.state.p_WI_m).norm();
    result.correction_rad = so3::log(now.state.q_WI * prior.mean.state.q_WI.conjugate()).norm();
    if (result.correction_m > params_.correction_max_m || result.correction_rad > params_.correction_max_rad) {
      return refuse(RegistrationVerdict::diverged);
    }
  }
  // a false minimum: most matches lie off their planes
  const bool fits =
      static_cast<double>(sum.inliers) >= params_.expert.fitting_share_min * static_cast<double>(sum.matches);
  if (!converged || !fits) return refuse(RegistrationVerdict::diverged);
  if (sum.matches < matches_needed && !agrees(prior, now)) return refuse(RegistrationVerdict::too_few);

  const Matrix posterior = H.ldlt().solve(Matrix::Identity());  // mapping.md (R22)
  result.covariance = 0.5 * (posterior + posterior.transpose());
  unknowns.clear_held(result.covariance);
  result.mean = now;
  result.mean.state.covariance = result.covariance.topLeftCorner<kMotion, kMotion>();
  result.verdict = RegistrationVerdict::converged;
  if (Status status = build(result.mean); !status.ok()) return status;
  describe_errors(points, trajectory, now.calibration, unknowns, kernel_m, result);
  describe_shape(points, kernel_m, sum, result);
  return {};
}

/// mapping.md (R27), (R28).
void Registration::describe_shape(std::span<const SweepPoint> points, double kernel_m, const Sums& sum,
                                  Result& result) const {
  Eigen::Matrix<double, 6, 6> shape = Eigen::Matrix<double, 6, 6>::Zero();  // robustly weighted, without variances
  double weight = 0.0, lever2 = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (matches_[i].plane.verdict != PlaneVerdict::plane) continue;
    const double robust = weigh(points[i], matches_[i], distances_[i], kernel_m).robust;
    const Eigen::Vector3d n = matches_[i].plane.normal_W.cast<double>(), lever = levers_[i].cast<double>();
    Eigen::Matrix<double, 6, 1> j;
    j << n, lever.cross(n);
    shape += robust * j * j.transpose();
    weight += robust;
    lever2 += robust * lever.squaredNorm();
  }
  const double lever_m = std::sqrt(std::max(lever2 / weight, 1e-12));
  Eigen::Matrix<double, 6, 1> scale;
  scale << 1.0, 1.0, 1.0, 1.0 / lever_m, 1.0 / lever_m, 1.0 / lever_m;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(scale.asDiagonal() * shape *
                                                                          scale.asDiagonal() / weight);
  result.eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  result.directions = solver.eigenvectors();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> information(
      scale.asDiagonal() *
          (sum.H.topLeftCorner<6, 6>() - result.errors_in_variables_information.topLeftCorner<6, 6>()) *
          scale.asDiagonal(),
      Eigen::EigenvaluesOnly);
  result.weakest_sigma_m = 1.0 / std::sqrt(std::max(information.eigenvalues()[0], 1e-12));
}

}  // namespace tumble
