// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/rolling/detail/rolling_filter.hpp"

#include <algorithm>
#include <cmath>

#include "rolling_node.hpp"
#include "rolling_window.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"
#include "tumble/rolling/detail/rolling_params.hpp"

namespace tumble::rolling {

/// See rolling.md (R1).
void move_linearisation_point(const Vector& x, RollingNominalState& nominal) {
  nominal.q_WI = (so3::exp(x.segment<3>(kAttitude)) * nominal.q_WI).normalized();
  nominal.v_WI_m_s += x.segment<3>(kVelocity);
  nominal.p_WI_m += x.segment<3>(kPosition);
  nominal.gyro_bias_rad_s += x.segment<3>(kGyroBias);
  nominal.accel_bias_m_s2 += x.segment<3>(kAccelBias);
  nominal.accel_scale += Eigen::Map<const Eigen::Matrix3d>(x.data() + kAccelScale);
  nominal.gyro_scale += Eigen::Map<const Eigen::Matrix3d>(x.data() + kGyroScale);
  nominal.accel_delay_s += x[kDelay];
  nominal.lever_arm_error_m += x.segment<3>(kLeverArm);
  nominal.floor_slope += x.segment<2>(kSlope);
  nominal.radius_error_m += x[kRadius];
}

}  // namespace tumble::rolling

namespace tumble {

namespace {

constexpr double kSlowRateTau_s = 0.3;
constexpr double kEventProbability = 0.5;  // minimum probability of a reported slip or bump
// A sphere at rest rotates in place if the gyro rate differs from the gyro bias by more than kSpinSigmas standard
// deviations.
constexpr double kSpinSigmas = 4.0;

static_assert(RollingFilter::kStates == rolling::kStates);

/// Returns the calibration constants of a nominal state, in the order of rolling.md (R1).
Eigen::Matrix<double, RollingCalibration::kSize, 1> constants_of(const RollingNominalState& nominal) {
  Eigen::Matrix<double, RollingCalibration::kSize, 1> out;
  out << nominal.gyro_bias_rad_s, nominal.accel_bias_m_s2, nominal.accel_scale.reshaped(),
      nominal.gyro_scale.reshaped(), nominal.accel_delay_s, nominal.lever_arm_error_m, nominal.floor_slope,
      nominal.radius_error_m;
  return out;
}

}  // namespace

void require_valid(const RollingParams& p) {
  require_valid_fields(p);
  require_in_interval("lever_arm_m", p.lever_arm_m.norm(), 0.0, 10.0);
  if (p.q_WI_start) require_in_interval("q_WI_start", p.q_WI_start->norm(), 1.0 - 1e-6, 1.0 + 1e-6);
}

RollingFilter::RollingFilter(const Params& p) : params_(p), rest_detector_(p.expert.rest_detector) {
  require_valid(p);
}

Status RollingFilter::step_with_listener(const ImuSample& sample, State& state, Listener listener) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad =
            elapsed_time_since_last(sample.time_ns, state.last_time_ns, RollingGapParams::kGapMax_s, dt_s);
        !bad.ok())
      return bad;
    if (dt_s > RollingGapParams::kGapMinDuration_s) {
      bridge_gap(sample, dt_s, state, listener);
    } else {
      process_reading(sample, dt_s, state, listener);
    }
  } else {
    Eigen::Quaterniond q_WI = params_.q_WI_start.value_or(Eigen::Quaterniond::Identity());
    if (!params_.q_WI_start) {
      if (const Status bad = inclination_from_force(sample.specific_force_m_s2, q_WI); !bad.ok()) return bad;
    }
    start(sample, q_WI, state);
  }
  state.last_time_ns = sample.time_ns;
  update_reported_pose(state);
  return {};
}

void RollingFilter::start(const ImuSample& sample, const Eigen::Quaterniond& q_WI, State& state) const {
  const Eigen::Vector3d& rate = sample.angular_velocity_rad_s;
  state.nominal = rolling::start_nominal(params_, q_WI, rate);
  rolling::set_prior(params_, rate, state.hypotheses[0].covariance);
  state.started_in_motion = rolling::starts_in_motion(rate);
  state.last_rate_rad_s = rate;
  state.hypothesis_count = 1;
  state.started = true;
}

void RollingFilter::process_reading(const ImuSample& sample, double dt_s, State& state, Listener listener) const {
  // The rate at the end of a filter step (node) is interpolated between two readings, so the filter step is completed
  // when the next reading arrives.
  if (state.node_integrals.node_interval_s >= params_.expert.kNode_s - 0.5 * dt_s) {
    complete_filter_node(sample.angular_velocity_rad_s, state);
    listener.function(listener.target, state);
  }
  rolling::integrate(params_, sample, dt_s, state.nominal, state.node_integrals);
  state.last_rate_rad_s = sample.angular_velocity_rad_s;
}

void RollingFilter::bridge_gap(const ImuSample& sample, double gap_s, State& state, Listener listener) const {
  ImuSample before;
  before.angular_velocity_rad_s = state.last_rate_rad_s;
  const int pieces = rolling::gap_step_count(params_, gap_s);
  const double piece_s = gap_s / pieces;
  for (int k = 0; k < pieces; ++k) {
    rolling::GapUncertainty uncertainty;
    const ImuSample piece = rolling::gap_step_sample(params_, before, sample, gap_s, k, uncertainty);
    const Eigen::Vector3d& rate = piece.angular_velocity_rad_s;
    if (state.node_integrals.node_interval_s >= params_.expert.kNode_s - 0.5 * piece_s) {
      complete_filter_node(rate, state);
      listener.function(listener.target, state);
    }
    rolling::integrate_gap(params_, piece, piece_s, uncertainty, state.nominal, state.node_integrals);
    state.last_rate_rad_s = rate;
  }
  ++state.gaps;
}

void RollingFilter::complete_filter_node(const Eigen::Vector3d& next_rate_rad_s, State& state) const {
  const rolling::Moving B = rolling::transition(state.node_integrals);
  for (int k = 0; k < state.hypothesis_count; ++k) {
    Hypothesis& h = state.hypotheses[static_cast<std::size_t>(k)];
    rolling::predict(params_, state.node_integrals, B, h.x, h.covariance);
  }
  state.pruned_position_covariance_m2.setZero();
  detect_rest(state);
  Hypothesis& best = state.hypotheses[0];
  if (rolling::reset_tilt(params_, state.node_integrals, state.at_rest, state.nominal, best.covariance)) {
    best.x.setZero();
    keep_most_probable_hypotheses(1, state);
  }
  const bool heading_lost = rolling::heading_lost(best.covariance);
  if (state.at_rest) {
    correct_at_rest(state);
  } else {
    choose_modes(0.5 * (state.last_rate_rad_s + next_rate_rad_s), heading_lost, state);
  }
  state.position_covariance_m2 = state.hypotheses[0].covariance.block<3, 3>(rolling::kPosition, rolling::kPosition) +
                                 hypothesis_position_covariance(state, rolling::kPosition);
  // When the filter discards hypotheses at rest, the position differences between discarded and remaining hypothesis
  // increase the position covariance.
  if (state.at_rest && state.hypothesis_count == 1) {
    state.hypotheses[0].covariance.block<3, 3>(rolling::kPosition, rolling::kPosition) +=
        state.pruned_position_covariance_m2;
    state.position_covariance_m2 += state.pruned_position_covariance_m2;
  }
  flag_uncertain_position(state);
  weigh_modes(state);
  move_linearisation_point(heading_lost, state);
  keep_position_at_rest(state);
  state.node_integrals = {};
  ++state.step_count;
}

void RollingFilter::detect_rest(State& state) const {
  const double h = state.node_integrals.node_interval_s;
  if (state.node_integrals.gap_s > 0.0) {  // the readings before and after a data gap do not prove rest within the gap
    state.stationary_state = {};
    state.at_rest = state.spins_in_place = false;
    return;
  }
  const Eigen::Vector3d w_mean = state.node_integrals.rate_integral_I_rad / h + state.nominal.gyro_bias_rad_s;
  const TimeNs from_ns = state.stationary_state.last_averaged_reading_ns;  // end of the previous filter step
  state.at_rest = rest_detector_.detect_stationary_from_mean(w_mean, state.node_integrals.force_integral_I_m_s / h,
                                                             from_ns, from_ns + std::llround(1e9 * h),
                                                             state.nominal.gyro_bias_rad_s, state.stationary_state);
  state.low_passed_rate_rad_s += -std::expm1(-h / kSlowRateTau_s) * (w_mean - state.low_passed_rate_rad_s);
  state.spins_in_place = state.at_rest && spins_in_place(state);
}

/// Returns whether the sphere rotates slowly about its contact point without moving: rolling.md (R29).
bool RollingFilter::spins_in_place(const State& state) const {
  const double averaged = params_.expert.kNode_s / (2.0 * kSlowRateTau_s);
  const Hypothesis& best = state.hypotheses[0];
  const Eigen::Array3d variance = best.covariance.diagonal().segment<3>(rolling::kGyroBias).array() +
                                  squared(RollingContactParams::kRestRateSigma_rad_s) * averaged;
  const Eigen::Array3d off =
      (state.low_passed_rate_rad_s - state.nominal.gyro_bias_rad_s - best.x.segment<3>(rolling::kGyroBias)).array();
  return (off.square() > kSpinSigmas * kSpinSigmas * variance).any();
}

/// See rolling.md (R27).
Eigen::Matrix3d RollingFilter::hypothesis_position_covariance(const State& state, int first) {
  const Eigen::Vector3d best = state.hypotheses[0].x.segment<3>(first);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double total = 0.0;
  for (int k = 0; k < state.hypothesis_count; ++k) {
    const Hypothesis& h = state.hypotheses[static_cast<std::size_t>(k)];
    const double weight = std::exp(h.log_weight - state.hypotheses[0].log_weight);
    const Eigen::Vector3d d = h.x.segment<3>(first) - best;
    spread += weight * d * d.transpose();
    total += weight;
  }
  return spread / total;
}

void RollingFilter::flag_uncertain_position(State& state) const {
  const double variance_m2 = state.position_covariance_m2(0, 0) + state.position_covariance_m2(1, 1);
  const bool event = may_slip(state.hypotheses[0].mode);
  if (!event) state.variance_before_slip_m2 = variance_m2;
  state.position_uncertain =
      event && variance_m2 - state.variance_before_slip_m2 > squared(ContactModeParams::kEventSigmaGrowth_m);
}

void RollingFilter::weigh_modes(State& state) {
  double slipping = 0.0, hopping = 0.0, total = 0.0;
  for (int k = 0; k < state.hypothesis_count; ++k) {
    const Hypothesis& h = state.hypotheses[static_cast<std::size_t>(k)];
    const double weight = std::exp(h.log_weight - state.hypotheses[0].log_weight);
    total += weight;
    if (may_slip(h.mode)) slipping += weight;
    if (h.mode == ContactMode::bump_or_flight) hopping += weight;
  }
  state.slip_probability = slipping / total;
  state.bump_probability = hopping / total;
}

/// While the sphere is at rest, the filter keeps the reported position constant.
void RollingFilter::keep_position_at_rest(State& state) const {
  const bool quiet = seconds(state.stationary_state.small_rate_since_ns) >=
                         std::min(rolling::kConstrainAfter_s, params_.expert.rest_detector.rest_s) &&
                     !may_slip(state.hypotheses[0].mode);
  const bool revised = state.hypotheses[0].parent != 0;
  const bool stands = quiet && !revised && state.sphere_velocity_W_m_s.norm() < rolling::kConstrainSpeed_m_s;
  if (!stands || !state.reported_position_constant) {
    state.reported_position_constant = false;
    update_reported_pose(state);
  }
  state.reported_position_constant = stands;
}

/// Adds the error state of the best hypothesis to the nominal state, and subtracts this error state from the error
/// states of all hypotheses.
void RollingFilter::move_linearisation_point(bool heading_lost, State& state) const {
  const Vector x = state.hypotheses[0].x, turned = rolling::heading_component(x);
  rolling::move_linearisation_point(x, state.nominal);
  for (int k = 0; k < state.hypothesis_count; ++k) {
    Hypothesis& h = state.hypotheses[static_cast<std::size_t>(k)];
    h.x -= x;
    if (!heading_lost) continue;
    rolling::remove_heading_error(turned, h.x);
    rolling::remove_heading_covariance(turned, h.covariance);
  }
}

void RollingFilter::update_reported_pose(State& state) const {
  const RollingNominalState& nominal = state.nominal;
  const Eigen::Vector3d arm_W = nominal.q_WI * (params_.lever_arm_m + nominal.lever_arm_error_m);
  const Eigen::Vector3d w_W = nominal.q_WI * (state.last_rate_rad_s - nominal.gyro_bias_rad_s);
  state.q_WI = nominal.q_WI;
  if (!state.reported_position_constant) state.sphere_centre_W_m = nominal.p_WI_m - arm_W;
  state.sphere_velocity_W_m_s = nominal.v_WI_m_s - w_W.cross(arm_W);
  state.mode = state.hypotheses[0].mode;
  state.contact_velocity_m_s = state.hypotheses[0].contact_velocity_W_m_s;
}

/// The summed weight of all hypotheses decides between grip and slip, because several hypotheses may have the same
/// contact mode.
ContactMode RollingFilter::most_probable_mode(const State& state) {
  const bool event = state.slip_probability >= kEventProbability;
  if (event == may_slip(state.mode)) return state.mode;
  if (!event) return ContactMode::grip;
  return 2.0 * state.bump_probability > state.slip_probability ? ContactMode::bump_or_flight : ContactMode::slip;
}

RollingCalibration RollingFilter::calibration(const State& state) {
  RollingCalibration out{
      constants_of(state.nominal),
      state.hypotheses[0].covariance.bottomRightCorner<RollingCalibration::kSize, RollingCalibration::kSize>()};
  constexpr int kSlope = rolling::kSlope - rolling::kGyroBias;  // the floor slope is no calibration constant
  out.constants.segment<2>(kSlope).setZero();
  out.covariance.middleRows<2>(kSlope).setZero();
  out.covariance.middleCols<2>(kSlope).setZero();
  return out;
}

RollingEstimate RollingFilter::estimate(const State& state) {
  RollingEstimate out;
  out.time_ns = state.last_time_ns;
  out.sphere_centre_W_m = state.sphere_centre_W_m;
  out.q_WI = state.q_WI;
  out.sphere_velocity_W_m_s = state.sphere_velocity_W_m_s;
  out.w_WI_I_rad_s = state.last_rate_rad_s - state.nominal.gyro_bias_rad_s;
  out.covariance.topLeftCorner<3, 3>() = state.position_covariance_m2;
  if (state.hypothesis_count > 0) {
    const Eigen::Matrix3d R_IW = state.nominal.q_WI.toRotationMatrix().transpose();
    out.velocity_covariance_I_m2_s2 =
        rolling::velocity_covariance_I(
            state.nominal, out.w_WI_I_rad_s,
            rolling::reported_covariance(rolling::output_covariance_rows(state.hypotheses[0].covariance))) +
        R_IW * hypothesis_position_covariance(state, rolling::kVelocity) * R_IW.transpose();
  }
  out.mode = most_probable_mode(state);
  out.at_rest = state.at_rest;
  out.position_uncertain = state.position_uncertain;
  return out;
}

}  // namespace tumble
