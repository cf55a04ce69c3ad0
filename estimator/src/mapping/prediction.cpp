// SPDX-License-Identifier: BSD-3-Clause
#include "prediction.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "../common/dense.hpp"
#include "inertial_track.hpp"
#include "tumble/common/types.hpp"
#include "unknowns.hpp"

namespace tumble::mapping {

namespace {

// If a sweep has too few matches, its points are inserted into the map only if the predicted position and attitude are
// accurate. The standard deviation of the attitude must be at most kExtendSigmaMax_rad.
constexpr double kExtendSigmaMax_rad = 0.1;
// minimum prior standard deviation of the gyro's saturation deficit on a clipped axis
constexpr double kDeficitSigmaMin_rad_s = 1.0;
// correlation time of the gyro's saturation deficit
constexpr double kDeficitTime_s = 0.3;
// maximum growth factor of the gyro's saturation deficit from one sweep to the next
constexpr double kDeficitCarryMax = 3.0;
// The registration estimates the gyro's saturation deficit at the start, middle and end of each sweep. Each of the
// three saturation deficits has an additional independent error. kKnotSigmaRatio is the ratio of the error's standard
// deviation to the deficit's standard deviation.
constexpr double kKnotSigmaRatio = 0.05;
// standard deviation of the velocity during the initial rest
constexpr double kStartSigma_m_s = 0.01;
// minimum number of consecutive sweeps at rest before the predicted velocity is set to zero
constexpr int kRestingSweepsMin = 3;
// standard deviation of the tilt from the specific force at rest, for an accelerometer bias of 0.3 m/s^2
constexpr double kRestTilt_rad = 0.03;

namespace u = unknowns;
using Params = LidarInertialOdometry::Params;

/// Returns the correlation between the saturation deficits at two successive instants (start, middle or end of a
/// sweep): mapping.md (R46).
double deficit_knot_correlation(const SweepTrajectory& trajectory) {
  return std::exp(-trajectory.duration_s() / (SweepTrajectory::kKnots - 1) / kDeficitTime_s);
}

/// The gyro's saturation deficit at the end of a sweep continues in the next sweep, and decays exponentially:
/// mapping.md (R48).
void propagate_saturation_deficit(const Params& params, const SweepBoundary& boundary,
                                  const SweepTrajectory& trajectory, Prediction& next) {
  constexpr int kLast = SweepTrajectory::kKnots - 1;
  u::row_range(next.boundary_jacobian, u::deficit).setZero();
  if (!params.expert.saturated_imu.estimate_deficit) return;
  const Eigen::Vector3d boundary_factor = trajectory.clipped_axes_at_start();
  const double rho = deficit_knot_correlation(trajectory);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(boundary_factor[axis] > 0.0 && boundary.clipped_axis_sign[axis] > 0.0)) continue;
    double remains = std::clamp(boundary.clipped_axis_sign[axis] / boundary_factor[axis], 0.0, kDeficitCarryMax);
    for (int knot = 0; knot <= kLast; ++knot) {
      next.prior.mean.saturation_deficit_rad_s(axis, knot) =
          remains * boundary.state_estimate.mean.saturation_deficit_rad_s(axis, kLast);
      next.boundary_jacobian(u::saturation_deficit_index(axis, knot), u::saturation_deficit_index(axis, kLast)) =
          remains;
      remains *= rho;
    }
  }
}

double saturation_deficit_sigma(const MotionWindow& window, const SweepTrajectory& trajectory, int axis) {
  double sigma = kDeficitSigmaMin_rad_s;
  for (const MotionSample& sample : window.samples) {
    if (seconds(sample.from_ns - trajectory.start_ns()) >= trajectory.duration_s()) break;
    if (sample.clipped_axes >> axis & 1) sigma = std::max(sigma, sample.rate_sigma_rad_s[axis]);
  }
  return sigma;
}

/// The gyro's saturation deficit is modelled as a first-order Gauss-Markov process: mapping.md (R46), (R47). If a
/// saturation continues from the last sweep, the process noise of the deficit is smaller than for a new saturation:
/// mapping.md (R49).
void add_saturation_deficit_noise(const Params& params, const MotionWindow& window, const SweepTrajectory& trajectory,
                                  Prediction& next) {
  if (!params.expert.saturated_imu.estimate_deficit) return;
  const double rho = deficit_knot_correlation(trajectory);
  for (int axis = 0; axis < 3; ++axis) {
    if (!(trajectory.clipped_axes() >> axis & 1)) continue;
    const double sigma = saturation_deficit_sigma(window, trajectory, axis);
    const bool carried = next.boundary_jacobian.row(u::saturation_deficit_index(axis, 0)).squaredNorm() > 0.0;
    for (int a = 0; a < SweepTrajectory::kKnots; ++a) {
      for (int b = 0; b < SweepTrajectory::kKnots; ++b) {
        const double known = carried ? std::pow(rho, a + b) : 0.0;
        next.noise(u::saturation_deficit_index(axis, a), u::saturation_deficit_index(axis, b)) +=
            sigma * sigma * (std::pow(rho, std::abs(a - b)) - known);
      }
      next.noise(u::saturation_deficit_index(axis, a), u::saturation_deficit_index(axis, a)) +=
          kKnotSigmaRatio * kKnotSigmaRatio * sigma * sigma;
    }
  }
}

}  // namespace

/// See mapping.md (R32).
void Prediction::compose_with_boundary(const StateEstimate& at_boundary) {
  propagate_covariance(boundary_jacobian, at_boundary.prior_weight_covariance, prior.covariance);
  propagate_covariance(boundary_jacobian, at_boundary.state_error_covariance, motion_error_covariance);
  prior.covariance += noise;
  motion_error_covariance += noise;
}

void Prediction::zero_velocity_update(double sigma_m_s) {
  prior.mean.state.v_WI_m_s.setZero();
  u::row_range(boundary_jacobian, u::velocity).setZero();
  u::row_range(noise, u::velocity).setZero();
  u::columns(noise, u::velocity).setZero();
  u::variances(noise, u::velocity).setConstant(sigma_m_s * sigma_m_s);
}

void Prediction::level_update(const Eigen::Vector3d& force_I_m_s2, double sigma_rad) {
  MotionState& state = prior.mean.state;
  const Eigen::Vector3d up = -prior.mean.calibration.gravity_W_m_s2;
  state.q_WI = (Eigen::Quaterniond::FromTwoVectors(state.q_WI * force_I_m_s2, up) * state.q_WI).normalized();
  u::row_range(boundary_jacobian, u::tilt).setZero();
  u::row_range(noise, u::tilt).setZero();
  u::columns(noise, u::tilt).setZero();
  u::variances(noise, u::tilt).setConstant(sigma_rad * sigma_rad);
}

Prediction predict(const Params& params, const SweepBoundary& boundary, const MotionWindow& window,
                   const SweepTrajectory& trajectory, const std::optional<OdometerReading>& reading) {
  Prediction next;
  next.prior.mean.state = boundary.state_estimate.mean.state;
  next.prior.mean.calibration = boundary.state_estimate.mean.calibration;
  propagate_saturation_deficit(params, boundary, trajectory, next);
  if (window.samples.front().at_rest) next.zero_velocity_update(kStartSigma_m_s);
  // The IMU cannot distinguish constant velocity from rest. At speeds above kCreepMax_m_s, the robot is therefore
  // assumed to move.
  const bool creeps = boundary.state_estimate.mean.state.v_WI_m_s.norm() < Standstill::kCreepMax_m_s;
  if (window.resting_sweeps >= kRestingSweepsMin && !boundary.all_directions_constrained && creeps)
    next.zero_velocity_update(Standstill::kSigma_m_s);
  if (window.contradicting_rest_force_I_m_s2 && !boundary.all_directions_constrained) {
    next.zero_velocity_update(Standstill::kCreepMax_m_s);
    next.level_update(*window.contradicting_rest_force_I_m_s2, kRestTilt_rad);
  }
  const std::uint8_t axes = params.expert.saturated_imu.estimate_deficit ? trajectory.clipped_axes() : 0;
  MotionNoise within = inertial_noise(params, trajectory, window.samples, axes);
  const Eigen::Matrix3d clipped_force_m2_s2 = velocity_variance_from_clipping(trajectory, window.samples);
  u::sub_block(next.noise, u::motion) += within;
  // If the accelerometer saturates near the end of a sweep, the error hardly affects the registration of the sweep, but
  // changes the velocity in the next sweep.
  u::sub_block(next.noise, u::velocity) += boundary.clipped_velocity_variance_m2_s2 + clipped_force_m2_s2;
  u::sub_block(within, u::velocity) += clipped_force_m2_s2;
  add_saturation_deficit_noise(params, window, trajectory, next);
  if (reading) fuse_reading(*reading, boundary, window, within, next);
  next.prior.initial_saturation_deficit_rad_s = next.prior.mean.saturation_deficit_rad_s;
  next.compose_with_boundary(boundary.state_estimate);
  return next;
}

void predict_stationary_sweep(const SweepBoundary& boundary, Prediction& prediction) {
  prediction.zero_velocity_update(Standstill::kSigma_m_s);
  prediction.compose_with_boundary(boundary.state_estimate);
}

bool prior_is_certain(const Params& params, const SweepBoundary& boundary, const MotionWindow& window,
                      const SweepTrajectory& trajectory) {
  const Eigen::Matrix<double, 9, 9> P =
      boundary.state_estimate.mean.state.covariance + inertial_noise(params, trajectory, window.samples, 0);
  return u::variances(P, u::position).maxCoeff() <=
             TrackingLimits::kExtendSigmaMax_m * TrackingLimits::kExtendSigmaMax_m &&
         u::variances(P, u::attitude).maxCoeff() <= kExtendSigmaMax_rad * kExtendSigmaMax_rad;
}

StateEstimate posterior(const Prediction& prediction) {
  StateEstimate start{prediction.prior.mean, prediction.prior.covariance, prediction.motion_error_covariance};
  start.mean.state.covariance = u::sub_block(start.prior_weight_covariance, u::motion);
  return start;
}

/// See mapping.md (R52).
StateEstimate posterior(const Prediction& prediction, const Registration::Result& aligned) {
  StateEstimate start{aligned.mean, aligned.covariance, Registration::Matrix::Zero()};
  // The information due to errors of the surface normals is false, and therefore not used.
  Registration::Matrix kept = Registration::Matrix::Identity(), from_prior;
  dense::solve_semidefinite(make_invertible(prediction.prior.covariance), kept);
  kept += aligned.surface_normal_noise_information;
  from_prior.noalias() = aligned.covariance * kept;
  propagate_covariance(from_prior, prediction.motion_error_covariance, start.state_error_covariance);
  propagate_covariance(aligned.covariance, aligned.score_covariance, from_prior);
  start.state_error_covariance += from_prior;
  make_symmetric(start.state_error_covariance);
  return start;
}

double innovation(const Prediction& prediction, const Registration::Estimate& aligned) {
  constexpr int kMotionSize = Registration::kMotionSize;
  const Registration::Vector away = aligned.minus(prediction.prior.mean);
  const Eigen::Matrix<double, kMotionSize, 1> moved = u::segment(away, u::motion);
  Eigen::Matrix<double, kMotionSize, kMotionSize> P = u::sub_block(prediction.motion_error_covariance, u::motion);
  P.diagonal().array() += unknowns::kMinVariance;
  return std::sqrt(std::max(0.0, moved.dot(P.ldlt().solve(moved))) / kMotionSize);
}

bool agrees_with_prediction(const Params& params, const Prediction& prediction, const Registration::Estimate& aligned,
                            double innovation) {
  const Eigen::Vector3d away_m = aligned.state.p_WI_m - prediction.prior.mean.state.p_WI_m;
  return innovation * innovation * Registration::kMotionSize <= unknowns::kAgreementChi2Max &&
         away_m.norm() <= params.expert.matching.distance_m;
}

void sweep_boundary_after(const Params& params, const StateEstimate& start, const MotionWindow& window,
                          const SweepTrajectory& trajectory, const Registration::Result* alignment,
                          SweepBoundary& boundary) {
  boundary.end_by_start_jacobian = unknowns_at(trajectory, trajectory.duration_s());
  at_end(start, trajectory, boundary.end_by_start_jacobian, window.end_ns, boundary.state_estimate);
  boundary.clipped_velocity_variance_m2_s2 = velocity_variance_from_clipping(trajectory, window.samples);
  const bool aligned = alignment != nullptr;
  boundary.clipped_axis_sign = Eigen::Vector3d::Zero();
  if (aligned) boundary.clipped_axis_sign = trajectory.clipped_axes_at_end();
  boundary.all_directions_constrained =
      aligned && alignment->least_constrained_sigma_m <= params.expert.matching.kDegenerateSigma_m;
}

}  // namespace tumble::mapping
