// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rate_model.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "../common/dense.hpp"
#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

void check(const AuxiliaryImu& p) {
  require_in_interval("auxiliary_imu gyro_noise_density", p.gyro_noise_density, 1e-9, 1.0);
  require_in_interval("auxiliary_imu accel_noise_density", p.accel_noise_density, 1e-9, 10.0);
  require_in_interval("auxiliary_imu gyro_error_rad_s", p.gyro_error_rad_s, 1e-9, 10.0);
  require_in_interval("auxiliary_imu accel_error_m_s2", p.accel_error_m_s2, 1e-9, 10.0);
  require_in_interval("auxiliary_imu share_error", p.scale_error, 0.0, 1.0);
  require_in_interval("auxiliary_imu position_error_m", p.position_error_m, 1e-9, 1.0);
  require_in_interval("auxiliary_imu clock_error_s", p.clock_error_s, 0.0, 0.1);
  for (const double value : p.T_imu_device.matrix().reshaped())
    require_in_interval("auxiliary_imu T_IC", value, -100.0, 100.0);
}

void check(const AngularRateModelParams& p) {
  require_valid_fields(p);
  for (const double value : p.errors.vector()) require_in_interval("sensor errors", value, -0.2, 0.2);
  require_in_interval("auxiliary_imus", p.auxiliary_imus.size(), 0, kAuxiliaryImusMax);
  for (const AuxiliaryImu& auxiliary_imu : p.auxiliary_imus) check(auxiliary_imu);
  const Status rig = check_body_imu_constants(p.calibration ? p.calibration->constants : p.nominal);
  if (!rig.ok())
    require_in_interval(rig.field, rig.value, -BodyImuConstants::kMaxConstantMagnitude,
                        BodyImuConstants::kMaxConstantMagnitude);
}

BodyImuConstants::Matrix covariance_of(const AngularRateModelParams& p) {
  if (p.calibration) return 0.5 * (p.calibration->covariance + p.calibration->covariance.transpose());
  BodyImuConstants::Vector variance;
  variance << Vector3d::Constant(p.lever_arm_sigma_m), Vector3d::Constant(p.gyro_bias_sigma_rad_s),
      Vector3d::Constant(p.accel_bias_sigma_m_s2), Eigen::Matrix<double, 5, 1>::Constant(p.inertia_sigma),
      Eigen::Matrix<double, 6, 1>::Constant(p.element_sigma);
  return variance.cwiseAbs2().asDiagonal();
}

// additional standard deviation [rad/s] of a partly saturated gyro reading during ground contact
constexpr double kSubsampleInContact = 0.25;

constexpr int kLever = 0, kAccelBias = 6, kInertia = 9;

Eigen::Matrix3d flight_force_covariance(const AngularRateFactor& f, const BodyImuConstants::Matrix& rig) {
  const Eigen::Matrix3d T = f.jacobian_calibration.middleCols<3>(kLever),
                        B = f.jacobian_calibration.middleCols<3>(kAccelBias);
  const Eigen::Matrix3d between = rig.block<3, 3>(kLever, kAccelBias);
  const Eigen::Matrix3d TC = T.lazyProduct(rig.block<3, 3>(kLever, kLever)), TM = T.lazyProduct(between);
  const Eigen::Matrix3d BC = B.lazyProduct(rig.block<3, 3>(kAccelBias, kAccelBias));
  const Eigen::Matrix3d mixed = TM.lazyProduct(B.transpose());
  Eigen::Matrix3d S = mixed + mixed.transpose();
  S.noalias() += TC.lazyProduct(T.transpose());
  S.noalias() += BC.lazyProduct(B.transpose());
  return S;
}

Eigen::Matrix3d euler_equation_covariance(const AngularRateFactor& f, const BodyImuConstants::Matrix& rig) {
  const Eigen::Matrix<double, 3, 5> I = f.jacobian_calibration.middleCols<5>(kInertia);
  const Eigen::Matrix<double, 3, 5> IC = I.lazyProduct(rig.block<5, 5>(kInertia, kInertia));
  return IC.lazyProduct(I.transpose());
}

// See rate_smoother.md (R16).
double normalised(const AngularRateFactor& f, Eigen::Matrix3d spread, double sigma,
                  const Vector3d& more = Vector3d::Zero()) {
  spread.diagonal().array() += sigma * sigma;
  spread.diagonal() += more;
  return f.residual.dot(spread.inverse() * f.residual);
}

// See rate_smoother.md (R32).
template <int kFirst, int kCount>
double mahalanobis(const BodyImuConstants::Vector& moved, const BodyImuConstants::Matrix& covariance) {
  const Eigen::Matrix<double, kCount, 1> part = moved.segment<kCount>(kFirst);
  const Eigen::Matrix<double, kCount, kCount> spread = covariance.block<kCount, kCount>(kFirst, kFirst);
  return std::sqrt(part.dot(spread.llt().solve(part)) / kCount);
}

double mahalanobis(const BodyImuConstants::Vector& moved, const BodyImuConstants::Matrix& covariance) {
  const double lever = mahalanobis<0, 3>(moved, covariance), gyro = mahalanobis<3, 3>(moved, covariance),
               accel = mahalanobis<6, 3>(moved, covariance), inertia = mahalanobis<9, 5>(moved, covariance);
  return std::max({lever, gyro, accel, inertia});
}

// Returns A^T * information, where A is the derivative of the residual with respect to the sample's unknowns.
Eigen::Matrix<double, 6, 3> add_to_knot(const AngularRateFactor& f, const Eigen::Matrix3d& information,
                                        double time_scale_s, arrow::Block& block) {
  Eigen::Matrix<double, 3, 6> A = f.jacobian_knot;
  A.rightCols<3>() /= time_scale_s;
  const Eigen::Matrix<double, 6, 3> At = A.transpose().lazyProduct(information);
  block.diagonal.noalias() += At.lazyProduct(A);
  block.gradient.noalias() -= At.lazyProduct(f.residual);
  return At;
}

template <int kFirst, int kCount>
void add_to_calibration(const AngularRateFactor& f, const Eigen::Matrix3d& information,
                        const Eigen::Matrix<double, 6, 3>& At, arrow::Block& block, arrow::Corner& corner) {
  const Eigen::Matrix<double, 3, kCount> B = f.jacobian_calibration.middleCols<kCount>(kFirst);
  const Eigen::Matrix<double, kCount, 3> Bt = B.transpose().lazyProduct(information);
  block.border_coupling.middleCols<kCount>(kFirst).noalias() += At.lazyProduct(B);
  corner.matrix.block<kCount, kCount>(kFirst, kFirst).noalias() += Bt.lazyProduct(B);
  corner.gradient.segment<kCount>(kFirst).noalias() -= Bt.lazyProduct(f.residual);
}

void add_flight(const AngularRateFactor& f, const Eigen::Matrix3d& information, double time_scale_s,
                arrow::Block& block, arrow::Corner& corner) {
  const Eigen::Matrix<double, 6, 3> At = add_to_knot(f, information, time_scale_s, block);
  add_to_calibration<kLever, 3>(f, information, At, block, corner);
  add_to_calibration<kAccelBias, 3>(f, information, At, block, corner);
  const Eigen::Matrix3d T = f.jacobian_calibration.middleCols<3>(kLever),
                        B = f.jacobian_calibration.middleCols<3>(kAccelBias);
  const Eigen::Matrix3d weighted = information.lazyProduct(B), mixed = T.transpose().lazyProduct(weighted);
  corner.matrix.block<3, 3>(kLever, kAccelBias) += mixed;
  corner.matrix.block<3, 3>(kAccelBias, kLever) += mixed.transpose();
}

void add_euler_equation(const AngularRateFactor& f, const Eigen::Matrix3d& information, double time_scale_s,
                        arrow::Block& block, arrow::Corner& corner) {
  const Eigen::Matrix<double, 6, 3> At = add_to_knot(f, information, time_scale_s, block);
  add_to_calibration<kInertia, 5>(f, information, At, block, corner);
}

// See rate_stream.md (R92).
Eigen::Matrix3d with_added_covariance(const Eigen::Matrix3d& information, const Eigen::Matrix3d& spread) {
  return (Eigen::Matrix3d::Identity() + information * spread).inverse() * information;
}

}  // namespace

AngularRateModel::AngularRateModel(const AngularRateModelParams& params, double period_s)
    : params_(params), time_scale_s_(period_s) {
  check(params);
  require_in_interval("period_s", period_s, 1e-6, 10.0);
  const double bandwidth_hz = 1.0 / period_s;
  gyro_sigma_rad_s_ = params.gyro_noise_density * std::sqrt(bandwidth_hz);  // gyro noise: rate_smoother.md (R6)
  accel_noise_m_s2_ = params.accel_noise_density * std::sqrt(bandwidth_hz);
  accel_sigma_m_s2_ = std::hypot(params.expert.flight.sigma_m_s2, accel_noise_m_s2_);
  independent_sample_fraction_ = std::min(1.0, period_s / params.expert.kModelError_s);
  uses_raw_readings_ = params.errors == SensorErrors{};
  prior_constants_ = params.calibration ? params.calibration->constants : params.nominal;
  prior_covariance_ = covariance_of(params);
  const dense::Cholesky factor(prior_covariance_);
  if (!factor.ok() || !prior_covariance_.allFinite()) {
    throw InvalidParams("calibration covariance", prior_covariance_.trace(), "positive definite");
  }
  prior_information_ = factor.inverse<BodyImuConstants::Matrix>();
}

void AngularRateModel::compute_flight_weight(const AngularRateObservation& observation, const BodyImuConstants& rig,
                                             const BodyImuConstants::Matrix& rig_covariance, double threshold_factor,
                                             double jump, AngularRateEstimate& estimate) const {
  AngularRateFactor flight = flight_force_calibration_jacobian(observation, estimate.knot, rig);
  const Vector3d hidden = accel_sensing_axis_readings(observation, flight);
  const AngularRateFactor euler = euler_equation_factor(estimate.knot, rig);
  const double r2 =
      normalised(flight, flight_force_covariance(flight, rig_covariance), accel_sigma_m_s2(observation), hidden) +
      normalised(euler, euler_equation_covariance(euler, rig_covariance), params_.expert.flight.euler_sigma_rad_s2) +
      jump;
  const double threshold = threshold_factor * params_.expert.flight.kThreshold;
  // Geman-McClure weight: rate_smoother.md (R18)
  const double ratio = 1.0 / (1.0 + r2 / (threshold * threshold));
  estimate.flight_weight = ratio * ratio;
  // See rate_smoother.md (R19).
  estimate.contact_force_m_s2 = (estimate.flight_weight - 1.0) * flight.residual;
}

double AngularRateModel::accel_sigma_m_s2(const AngularRateObservation& observation) const {
  return std::hypot(accel_sigma_m_s2_, params_.expert.kAccelScaleError * observation.sample.specific_force_m_s2.norm());
}

// Averaging over samples does not reduce a model error that lasts longer than one sample.
double AngularRateModel::total_accel_variance(const AngularRateObservation& observation) const {
  const double single = accel_sigma_m_s2(observation), noise2 = accel_noise_m_s2_ * accel_noise_m_s2_;
  return independent_sample_fraction_ < 1.0 ? noise2 + (single * single - noise2) / independent_sample_fraction_
                                            : single * single;
}

// See rate_smoother.md (R17), (R4).
double AngularRateModel::jump(const AngularRateKnot& from, const AngularRateKnot& to, double dt_s) const {
  const Vector3d e0 = from.rate_rad_s + dt_s * from.acceleration_rad_s2 - to.rate_rad_s;
  const Vector3d e1 = dt_s * (from.acceleration_rad_s2 - to.acceleration_rad_s2);
  const double scale = 1.0 / (params_.expert.flight.kJerkPsd_rad2_s5 * dt_s * dt_s * dt_s);
  return scale * (12.0 * e0.squaredNorm() - 12.0 * e0.dot(e1) + 4.0 * e1.squaredNorm());
}

double AngularRateModel::gyro_information(const AngularRateObservation& observation,
                                          const AngularRateEstimate& estimate, int axis) const {
  if (observation.gyro_repeats) return 0.0;
  if (observation.gyro_age_s > 0.0) {
    // A gyro reading measures the rate at `gyro_age_s` before its time stamp. A contact force may change the rate
    // between the measured time and the time stamp: rate_smoother.md (R7).
    const double change =
        params_.expert.contact.kGain_rad_m * estimate.contact_force_m_s2.norm() * observation.gyro_age_s;
    const double lost = (observation.partly_saturated_axes() >> axis & 1u) != 0
                            ? observation.saturation_deficit_sigma_rad_s[axis]
                            : 0.0;
    return 1.0 / (gyro_sigma_rad_s_ * gyro_sigma_rad_s_ + change * change + lost * lost);
  }
  if ((observation.partly_saturated_axes() >> axis & 1u) == 0) return 1.0 / (gyro_sigma_rad_s_ * gyro_sigma_rad_s_);
  const double impact = kSubsampleInContact * (1.0 - estimate.flight_weight),
               lost = observation.saturation_deficit_sigma_rad_s[axis];
  return 1.0 / (lost * lost + impact * impact);
}

// During contact, the contact force is modelled as an additional error of the specific force. The modelled error has
// zero mean, and a standard deviation proportional to the estimated contact force: rate_smoother.md (R20).
AngularRateModel::ForceFactor AngularRateModel::force_factor(const AngularRateObservation& observation,
                                                             const AngularRateEstimate& estimate,
                                                             const BodyImuConstants& rig) const {
  const double flight2 = total_accel_variance(observation);
  const double share = observation.unmeasured_axes() != 0 ? params_.expert.contact.kForceShare : 0.0;
  const double contact2 =
      flight2 + share * share * estimate.contact_force_m_s2.squaredNorm() / independent_sample_fraction_;
  ForceFactor out;
  const double information =
      estimate.flight_weight / flight2 + (share > 0.0 ? (1.0 - estimate.flight_weight) / contact2 : 0.0);
  out.factor = flight(observation, estimate.knot, rig);
  const Vector3d hidden = accel_sensing_axis_readings(observation, out.factor);
  for (int j = 0; j < 3; ++j) out.information[j] = information / (1.0 + information * hidden[j]);
  return out;
}

void AngularRateModel::add_gyro(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                                const BodyImuConstants& rig, arrow::Block& block, arrow::Corner& corner) const {
  const AngularRateFactor gyro =
      gyro_factor(knot_at_reading(observation, estimate), rig, corrected_rate(observation, estimate));
  const double age = observation.gyro_age_s / time_scale_s_;
  for (int j = 0; j < 3; ++j) {
    const double information = gyro_information(observation, estimate, j), pull = information * gyro.residual[j];
    block.diagonal(j, j) += information;
    block.border_coupling(j, 3 + j) += information;
    block.gradient[j] -= pull;
    if (age != 0.0) {
      const int i = 3 + j;
      block.diagonal(j, i) -= age * information;
      block.diagonal(i, j) -= age * information;
      block.diagonal(i, i) += age * age * information;
      block.border_coupling(i, 3 + j) -= age * information;
      block.gradient[i] += age * pull;
    }
    corner.matrix(3 + j, 3 + j) += information;
    corner.gradient[3 + j] -= pull;
  }
}

void AngularRateModel::add_sample(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                                  const BodyImuConstants& rig, arrow::Block& block, arrow::Corner& corner,
                                  const BodyImuConstants::Matrix* rig_spread) const {
  if (observation.has_clipped_sensing_axis()) {
    add_sensing_axis_readings(observation, estimate, rig, block, corner, rig_spread);
  } else {
    add_gyro(observation, estimate, rig, block, corner);
  }

  auto [flight, flight_information] = force_factor(observation, estimate, rig);
  AngularRateFactor euler = euler_equation_factor(estimate.knot, rig);
  Eigen::Matrix3d of_flight = flight_information.asDiagonal(), of_euler = euler_equation_information(estimate);
  if (rig_spread != nullptr) {
    of_flight = with_added_covariance(of_flight, flight_force_covariance(flight, *rig_spread));
    of_euler = with_added_covariance(of_euler, euler_equation_covariance(euler, *rig_spread));
    flight.jacobian_calibration.setZero();
    euler.jacobian_calibration.setZero();
  } else if (has_no_error_information(estimate)) {
    exclude_from_calibration(observation, flight);
    euler.jacobian_calibration.setZero();
  }
  add_flight(flight, of_flight, time_scale_s_, block, corner);
  add_euler_equation(euler, of_euler, time_scale_s_, block, corner);

  add_auxiliary_imus(observation, estimate, rig, block);

  const double rate_sigma = observation.at_rest ? params_.expert.kRestSigma_rad_s : params_.kRateMax_rad_s;
  const double rate_information = independent_sample_fraction_ / (rate_sigma * rate_sigma);
  const double largest = params_.kAccelerationMax_rad_s2 * time_scale_s_;
  const double acceleration_information = independent_sample_fraction_ / (largest * largest);
  for (int j = 0; j < 3; ++j) {
    block.diagonal(j, j) += rate_information;
    block.gradient[j] -= rate_information * estimate.knot.rate_rad_s[j];
    block.diagonal(3 + j, 3 + j) += acceleration_information;
    block.gradient[3 + j] -= acceleration_information * estimate.knot.acceleration_rad_s2[j] * time_scale_s_;
  }
}

// A force that acts on one point of the body exerts no torque about the direction of the force: rate_smoother.md (R21).
Eigen::Matrix3d AngularRateModel::euler_equation_information(const AngularRateEstimate& estimate) const {
  const double flight = params_.expert.flight.euler_sigma_rad_s2 * params_.expert.flight.euler_sigma_rad_s2;
  const double force = estimate.contact_force_m_s2.norm(), lever = params_.expert.contact.kLever_rad_m * force;
  const double across = independent_sample_fraction_ / (flight + lever * lever);
  if (!(force > 0.0)) return across * Eigen::Matrix3d::Identity();
  const double twist = params_.expert.contact.kTwistRatio * lever;
  const Vector3d n = estimate.contact_force_m_s2 / force;
  return across * Eigen::Matrix3d::Identity() +
         (independent_sample_fraction_ / (flight + twist * twist) - across) * n * n.transpose();
}

void AngularRateModel::add_motion_model(const AngularRateEstimate& from, const AngularRateEstimate& to, double dt_s,
                                        arrow::Block& block, arrow::Block& next) const {
  const double h = time_scale_s_, ratio = dt_s / h;
  // See rate_smoother.md (R5).
  const double change =
      params_.expert.contact.kGain_rad_m * std::max(from.contact_force_m_s2.norm(), to.contact_force_m_s2.norm());
  const double psd = params_.expert.flight.kJerkPsd_rad2_s5 + independent_sample_fraction_ * change * change / dt_s;
  // inverse of the scaled process noise covariance in rate_smoother.md (R4)
  const double a = 12.0 / (psd * dt_s * dt_s * dt_s), b = -6.0 / (psd * dt_s * dt_s * h),
               c = 4.0 / (psd * dt_s * h * h);
  for (int j = 0; j < 3; ++j) {
    const double e0 = from.knot.rate_rad_s[j] + dt_s * from.knot.acceleration_rad_s2[j] - to.knot.rate_rad_s[j];
    const double e1 = (from.knot.acceleration_rad_s2[j] - to.knot.acceleration_rad_s2[j]) * h;
    const double g0 = a * e0 + b * e1, g1 = b * e0 + c * e1;
    const int i = 3 + j;
    block.diagonal(j, j) += a;
    block.diagonal(j, i) += ratio * a + b;
    block.diagonal(i, j) += ratio * a + b;
    block.diagonal(i, i) += ratio * ratio * a + 2.0 * ratio * b + c;
    block.gradient[j] -= g0;
    block.gradient[i] -= ratio * g0 + g1;
    block.coupling_to_next_state(j, j) -= a;
    block.coupling_to_next_state(j, i) -= b;
    block.coupling_to_next_state(i, j) -= ratio * a + b;
    block.coupling_to_next_state(i, i) -= ratio * b + c;
    next.diagonal(j, j) += a;
    next.diagonal(j, i) += b;
    next.diagonal(i, j) += b;
    next.diagonal(i, i) += c;
    next.gradient[j] += g0;
    next.gradient[i] += g1;
  }
}

void AngularRateModel::add_rig_prior(const BodyImuConstants& rig, arrow::Corner& corner) const {
  corner.matrix += prior_information_;
  corner.gradient -= prior_information_ * (rig.vector() - prior_constants_.vector());
}

double AngularRateModel::calibration_mahalanobis(const BodyImuConstants& rig) const {
  return mahalanobis(rig.vector() - prior_constants_.vector(), prior_covariance_);
}

double AngularRateModel::calibration_mahalanobis(const BodyImuConstants& rig, const arrow::BorderErrors& error_jacobian,
                                                 const SensorErrors::Matrix& error_covariance) const {
  return mahalanobis(rig.vector() - prior_constants_.vector(),
                     prior_covariance_ + error_jacobian * error_covariance * error_jacobian.transpose());
}

// See rate_smoother.md (R1).
Eigen::Matrix<double, 6, 1> AngularRateModel::unscaled_step(const arrow::StateVector& step) const {
  Eigen::Matrix<double, 6, 1> out = step;
  out.tail<3>() /= time_scale_s_;
  return out;
}

arrow::StateVector AngularRateModel::scaled_difference(const Eigen::Matrix<double, 6, 1>& difference) const {
  arrow::StateVector out = difference;
  out.tail<3>() *= time_scale_s_;
  return out;
}

AngularRateSource rate_source_of(const AngularRateObservation& o, const AngularRateEstimate& e,
                                 const Eigen::Matrix3d& covariance) {
  constexpr double kRecoveredSigma_rad_s = 0.5;
  const int clipped = o.clipping.gyro | o.clipping.unusable_gyro;
  // A reading that may be saturated is a lower bound of the rate.
  if (clipped == 0)
    return o.possibly_saturated_axes() == 0 ? AngularRateSource::measured : AngularRateSource::lower_bound_only;
  if (e.flight_weight >= 0.5) return AngularRateSource::recovered_in_flight;
  double largest = 0.0;
  for (int j = 0; j < 3; ++j) {
    if ((clipped >> j & 1) != 0) largest = std::max(largest, covariance(j, j));
  }
  return largest <= kRecoveredSigma_rad_s * kRecoveredSigma_rad_s ? AngularRateSource::recovered_in_contact
                                                                  : AngularRateSource::lower_bound_only;
}

}  // namespace tumble
