// SPDX-License-Identifier: BSD-3-Clause
// AngularRateStream treats the sensor errors as consider parameters (Schmidt, 1966).
#include <algorithm>
#include <cmath>

#include "rate_stream_impl.hpp"

namespace tumble {

namespace {

using Eigen::Matrix3d;

// The sensor errors are estimated only at intervals, because each estimate solves a system of 29 unknowns, which costs
// more than a step of the stream.
constexpr TimeNs kUpdatePeriod_ns = 50'000'000;

// See rate_smoother.md (R44).
Matrix3d rate_covariance_from_errors(const arrow::ErrorMatrix& moved, const SensorErrors::Matrix& covariance,
                                     double rate_max_rad_s) {
  const Eigen::Matrix<double, 3, SensorErrors::kSize> rates = moved.topRows<3>(),
                                                      spread = rates.lazyProduct(covariance);
  const Matrix3d out = spread.lazyProduct(rates.transpose());
  return std::min(1.0, rate_max_rad_s * rate_max_rad_s / std::max(out.trace(), 1e-300)) * out;
}

bool has_moved_states(const AngularRateStream::Knot& knot) {
  return !knot.observation.at_rest;
}

}  // namespace

// See rate_stream.md (R100).
void AngularRateStream::Impl::marginalise_sensor_errors(const arrow::Block& block, arrow::ErrorMatrix& errors,
                                                        State& state) const {
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  device.prior.setZero();
  arrow::eliminate_sensor_errors(block, errors, &device.prior, device.border_errors);
  device.sensor_error_evidence.information.noalias() -= errors.transpose().lazyProduct(errors);
  device.sensor_error_evidence.gradient.noalias() += errors.transpose().lazyProduct(block.gradient);
}

void AngularRateStream::Impl::discard_marginalised_information(State& state) const {
  state.prior = {};
  state.prior_border_block = {};
  model.add_rig_prior(state.rig, state.prior_border_block);
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  device.prior.setZero();
  device.border_errors.setZero();
  device.sensor_error_evidence.information.setZero();
  device.sensor_error_evidence.gradient.setZero();
}

void AngularRateStream::Impl::reset_rig(State& state) const {
  state.rig = state.prior_rig = model.prior_constants();
  state.rig_covariance = model.prior_covariance();
  discard_marginalised_information(state);
  state.calibration_samples = 0;
}

KnownSensorErrors AngularRateStream::sensor_errors_except_biases(const State& state) const {
  const AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  KnownSensorErrors out{
      impl_->params.calibrated_errors ? impl_->params.calibrated_errors->errors : impl_->params.model.errors,
      device.posterior.covariance};
  out.errors.accel_delay_s = device.accel_delay_state.applied_delay_s;
  return out;
}

// See rate_stream.md (R101). The caller must factorise the normal equations at the current estimates and calibration.
void AngularRateStream::Impl::add_sensor_error_covariance(const arrow::BorderVector& rig_step, State& state) const {
  AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  const std::size_t count = state.window.size();
  if (std::none_of(state.window.begin(), state.window.end(), has_moved_states)) {
    std::fill_n(device.sample_jacobian.begin(), count, arrow::ErrorMatrix::Zero());
    return;
  }
  std::vector<arrow::ErrorMatrix>& errors = device.sample_jacobian;
  auto& [border, calibration_by_errors, window_error_evidence, posterior_workspace] = device.work_matrices;
  border = device.border_errors;
  window_error_evidence = device.sensor_error_evidence;
  errors[0] = device.prior;
  std::fill_n(errors.begin() + 1, count - 1, arrow::ErrorMatrix::Zero());
  for (std::size_t k = 0; k < count; ++k) {
    const Knot& knot = state.window[k];
    model.add_sensor_errors(knot.observation, knot.estimate, state.rig, errors[k], border, window_error_evidence);
    arrow::eliminate_sensor_errors(state.work_blocks[k], errors[k], k + 1 == count ? nullptr : &errors[k + 1], border);
    window_error_evidence.information.noalias() -= errors[k].transpose().lazyProduct(errors[k]);
    window_error_evidence.gradient.noalias() += errors[k].transpose().lazyProduct(state.work_blocks[k].gradient);
  }
  calibration_by_errors.noalias() = state.rig_covariance.lazyProduct(border);
  for (std::size_t k = count; k-- > 0;)
    errors[k] = arrow::back_substitute_errors(state.work_blocks[k], errors[k],
                                              k + 1 == count ? nullptr : &errors[k + 1], calibration_by_errors);

  const TimeNs now_ns = state.window.back().observation.sample.time_ns;
  if (params.calibrated_errors || (device.updated_ns && now_ns - *device.updated_ns < kUpdatePeriod_ns)) return;
  device.updated_ns = now_ns;
  window_error_evidence.information.noalias() -= border.transpose().lazyProduct(calibration_by_errors);
  window_error_evidence.gradient.noalias() += border.transpose().lazyProduct(rig_step);
  discount_unobservable(model.independent_sample_fraction(), window_error_evidence);
  AngularRateStreamDelay& delay = device.accel_delay_state;
  if (delay.delay_found) {
    if (const TriadDelay& guess = delay.impact_delay; guess.sigma_s > 0.0) {
      // The information is divided by kSensorErrorEvidenceWeight, because SensorErrorUncertainty multiplies all
      // information by kSensorErrorEvidenceWeight.
      const double information =
          1.0 / (SensorErrorUncertainty::kSensorErrorEvidenceWeight * guess.sigma_s * guess.sigma_s);
      window_error_evidence.information(SensorErrors::kDelay, SensorErrors::kDelay) += information;
      window_error_evidence.gradient[SensorErrors::kDelay] += information * (guess.delay_s - delay.applied_delay_s);
    }
    delay.estimated_s = std::clamp(
        delay.applied_delay_s + sensor_error_uncertainty.delay_correction_s(window_error_evidence, max_accel_delay_s()),
        -max_accel_delay_s(), max_accel_delay_s());
  }
  sensor_error_uncertainty.update(window_error_evidence, posterior_workspace, device.posterior, delay.delay_found);
}

Matrix3d AngularRateStream::Impl::sensor_error_rate_covariance(std::size_t k, const State& state) const {
  const Knot& knot = state.window[k];
  if (!has_moved_states(knot)) return Matrix3d::Zero();
  const AngularRateStreamSensorErrors& device = state.sensor_errors.front();
  Matrix3d out =
      rate_covariance_from_errors(device.sample_jacobian[k], device.posterior.covariance, params.model.kRateMax_rad_s);
  const double shared_s2 = sensor_error_uncertainty.common_delay_variance_s2(device.posterior);
  const Eigen::Vector3d& alpha = knot.estimate.knot.acceleration_rad_s2;
  const double struck = params.model.expert.contact.kGain_rad_m * knot.estimate.contact_force_m_s2.norm();
  out += shared_s2 * (alpha * alpha.transpose() + struck * struck * Matrix3d::Identity());
  return out;
}

}  // namespace tumble
