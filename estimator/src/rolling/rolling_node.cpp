// SPDX-License-Identifier: BSD-3-Clause
#include "rolling_node.hpp"

#include <algorithm>
#include <cmath>

#include "../common/dense.hpp"
#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/types.hpp"

namespace tumble::rolling {

namespace {

// root densities of random walks: radius on a rough floor, slope, accelerometer bias, and velocity per squared rate
constexpr double kRoughRadiusWalk_m_sqrts = 1e-4, kSlopeWalk_sqrts = 0.02, kAccelBiasWalk_m_s2_sqrts = 2e-3,
                 kVelocityWalkPerRate2_sqrts = 4e-5;
constexpr double kImpactSigmaRatio = 0.06;  // velocity error by an impact, as a fraction of its velocity change
constexpr double kClippedRateSigma_rad_s = 5.0, kClippedForceSigma_m_s2 = 4.0;  // error of a saturated reading
constexpr double kSteepest = 0.95;  // maximum sine of a slope, so that the normal points up
constexpr double kLevelSlopeSigma = 1e-3, kStartRate_rad_s = 0.1;  // minimum first gyro rate for a start in motion

double vertical_component(const Eigen::Vector2d& slope) {
  return std::sqrt(1.0 - std::min(slope.squaredNorm(), squared(kSteepest)));
}

Eigen::Vector3d floor_normal(const Eigen::Vector2d& slope) {
  return {slope.x(), slope.y(), vertical_component(slope)};
}

constexpr double kNoImpactForce_m_s2 = 3.0;  // maximum difference of specific force and gravity without an impact
constexpr double kImuOffset_m = 0.02;        // assumed IMU distance from the sphere's centre, for centripetal force
constexpr double kPartialRangeMin = 0.3, kPartialRangeMax = 0.6;  // peaks (fraction of range) with possible saturation
constexpr double kForceTilt_rad = 0.35;                           // tilt error of the mean specific force in motion
constexpr double kLostTilt_rad = kForceTilt_rad;  // tilt standard deviation above which specific force levels the tilt
constexpr double kUncertainTilt_rad = 0.1;        // tilt limit at rest, where the specific force is gravity
constexpr double kRestTilt_rad = 5e-3, kLostSpeed_m_s = 1.0;
constexpr double kPushForceRatio = 0.15;  // minimum |specific force - gravity| of a push or fast rotation, in g
constexpr double kRecoveredTau_s = 0.1;   // correlation time of the error of a rate recovered from saturation
constexpr double kFastRate_rad_s = 6.0;   // at higher rates, the specific force rotates too fast for levelling
constexpr double kUnsureSpeed_m_s = 0.1, kSpeedWindow_s = 1.0, kSpeedSigma_m_s = 1.0;
constexpr double kStartTilt_rad = 0.15;  // tilt error of a start in motion, caused by a push of 1.5 m/s^2
// See rolling.md (R31). If the rates before and after a data gap are below kGapRate_rad_s, the sphere was hardly pushed
// during the gap, so the rate in the gap is less uncertain.
constexpr double kGapRate_rad_s = 1.0, kGapStill_rad_s2 = 0.5, kGapAcceleration_rad_s2 = 15.0;
constexpr double kGapVelocityChangeRatio =
    0.5;  // unknown velocity change in a data gap, as a fraction of the rolling velocity's change
constexpr double kGapTimeSigmaRatio = 0.15;  // uncertain time of a rate change in a gap, as a fraction of the gap

}  // namespace

/// See rolling.md (R18), (R19).
Eigen::Vector3d contact_variance(const Contact& c, ContactMode mode) {
  const double rough =
      mode == ContactMode::rough ? squared(RollingContactParams::kRoughShare * c.rolling_speed_m_s) : 0.0;
  return {c.grip_variance, c.grip_variance,
          squared(RollingContactParams::kVerticalSigma_m_s) + rough + c.gap_extra_variance};
}

/// See rolling.md (R17).
Eigen::Vector3d Contact::velocity(const Vector& x) const {
  const Eigen::Vector2d change = x.segment<2>(kSlope);
  const double curved = vertical_component(floor_slope + change) - vertical_component(floor_slope) +
                        floor_slope.dot(change) / vertical_component(floor_slope);
  return contact_velocity_W_m_s + measurement_jacobian * x + curved * normal_height_derivative_W;
}

bool starts_in_motion(const Eigen::Vector3d& rate_I_rad_s) {
  return rate_I_rad_s.norm() > kStartRate_rad_s;
}

RollingNominalState start_nominal(const RollingParams& params, const Eigen::Quaterniond& q_WI,
                                  const Eigen::Vector3d& rate_I_rad_s) {
  RollingNominalState nominal;
  if (params.calibration) {
    Vector x = Vector::Zero();
    x.tail<RollingCalibration::kSize>() = params.calibration->constants;
    move_linearisation_point(x, nominal);
  }
  nominal.q_WI = q_WI;
  nominal.p_WI_m = q_WI * (params.lever_arm_m + nominal.lever_arm_error_m);
  nominal.last_rate_I_rad_s = rate_I_rad_s;
  if (starts_in_motion(rate_I_rad_s)) {
    const Eigen::Vector3d w_W = q_WI * rate_I_rad_s;
    nominal.v_WI_m_s = w_W.cross(params.radius_m * Eigen::Vector3d::UnitZ() + nominal.p_WI_m);
  }
  return nominal;
}

void set_prior(const RollingParams& params, const Eigen::Vector3d& rate_I_rad_s, Covariance& P) {
  P.setZero();
  auto prior = P.diagonal();
  // While the sphere is pushed, the specific force differs from gravity. A rotating sphere may slip at the start, so
  // the standard deviation of the initial velocity is the full rolling speed.
  const bool moves = starts_in_motion(rate_I_rad_s);
  const double tilt = moves ? kStartTilt_rad : 0.0, velocity = moves ? params.radius_m * rate_I_rad_s.norm() : 0.0;
  // The initial heading defines the x axis of the world frame, so the prior variance of the heading is 0.
  prior.segment<2>(kAttitude).setConstant(squared(params.expert.prior.tilt_sigma_rad) + squared(tilt));
  prior.segment<3>(kVelocity).setConstant(squared(params.expert.prior.kVelocitySigma_m_s) + squared(velocity));
  prior.segment<3>(kGyroBias).setConstant(squared(params.expert.prior.gyro_bias_sigma_rad_s));
  prior.segment<3>(kAccelBias).setConstant(squared(params.expert.prior.accel_bias_sigma_m_s2));
  prior.segment<9>(kAccelScale).setConstant(squared(params.expert.prior.accel_scale_sigma));
  prior.segment<9>(kGyroScale).setConstant(squared(params.expert.prior.gyro_scale_sigma));
  prior[kDelay] = squared(params.expert.prior.accel_delay_sigma_s);
  prior.segment<3>(kLeverArm).setConstant(squared(params.lever_arm_sigma_m));
  prior[kRadius] = squared(params.radius_sigma_m);
  if (params.calibration) {
    const Eigen::Matrix<double, 6, 1> bias_variance = prior.segment<6>(kGyroBias);
    P.bottomRightCorner<RollingCalibration::kSize, RollingCalibration::kSize>() = params.calibration->covariance;
    prior.segment<6>(kGyroBias) += bias_variance;
  }
  prior.segment<2>(kSlope).setConstant(squared(kLevelSlopeSigma));
}

namespace {

struct SaturatedForce {
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d lower_bound_m_s2 = Eigen::Vector3d::Zero();
};

/// A saturated accelerometer reading is a lower bound of the specific force. The assumed specific force is the larger
/// of two values: the reading, and the specific force at constant velocity of the sphere's centre (rolling.md, R8).
SaturatedForce saturated_force(const ImuSample& sample, const Eigen::Vector3d& read_m_s2,
                               const Eigen::Vector3d& kept_m_s2) {
  int largest = 0;
  sample.specific_force_m_s2.cwiseAbs().maxCoeff(&largest);
  const int flags = sample.device_clip_flags & kClipAccel;
  SaturatedForce out{.force_m_s2 = read_m_s2};
  for (int axis = 0; axis < 3; ++axis) {
    const bool railed = flags != 0 ? (flags & (kClipAccelX << axis)) != 0 : axis == largest;
    if (!railed) continue;
    if (std::copysign(1.0, read_m_s2[axis]) * (kept_m_s2[axis] - read_m_s2[axis]) > 0.0) {
      out.force_m_s2[axis] = kept_m_s2[axis];
    } else {
      out.lower_bound_m_s2[axis] = read_m_s2[axis];
    }
  }
  return out;
}

}  // namespace

/// See rolling.md (R2) to (R9).
void integrate(const RollingParams& params, const ImuSample& sample, double dt_s, RollingNominalState& nominal,
               RollingNodeIntegrals& sums, Force known) {
  const Eigen::Vector3d& w_raw = sample.angular_velocity_rad_s;
  const Eigen::Vector3d& f_raw = sample.specific_force_m_s2;
  const Eigen::Vector3d w = w_raw - nominal.gyro_bias_rad_s - nominal.gyro_scale * w_raw;
  Eigen::Vector3d f =
      f_raw - nominal.accel_bias_m_s2 - nominal.accel_scale * f_raw - nominal.accel_delay_s * w.cross(f_raw);
  // Averaging over the time dt at the rate w reduces the specific force perpendicular to the rotation axis by the
  // fraction (|w| dt)^2 / 24: rolling.md (R4).
  f -= dt_s * dt_s / 24.0 * w.cross(w.cross(f));
  const Eigen::Quaterniond half = so3::exp(0.5 * dt_s * w);
  const Eigen::Quaterniond q_mid = nominal.q_WI * half;
  const Eigen::Matrix3d R_T = dt_s * q_mid.toRotationMatrix();
  nominal.q_WI = (q_mid * half).normalized();
  const double gravity = params.gravity_m_s2;
  const bool beyond = w_raw.cwiseAbs().maxCoeff() >= params.gyro_range_rad_s;
  const bool lost =
      (sample.device_clip_flags & kClipGyro) != 0 || (beyond && !params.expert.saturation.recovered_rate_sigma_rad_s);
  const bool has_unknown_rate = lost || beyond || known == Force::force_unknown;
  const bool railed =
      (sample.device_clip_flags & kClipAccel) != 0 || f_raw.cwiseAbs().maxCoeff() >= params.accel_range_m_s2;
  const Eigen::Vector3d arm = params.lever_arm_m + nominal.lever_arm_error_m;
  const Eigen::Vector3d change_rad_s = w_raw - nominal.last_rate_I_rad_s;  // angular acceleration times dt_s
  nominal.last_rate_I_rad_s = w_raw;
  // If the rate is unknown, the direction of the specific force in the world is unknown, and the velocity of the
  // sphere's centre is assumed constant: rolling.md (R7).
  const Eigen::Vector3d centre_velocity_change_m_s = R_T * w.cross(w.cross(arm)) + q_mid * change_rad_s.cross(arm);
  const Eigen::Vector3d fallen = dt_s * gravity * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d least = Eigen::Vector3d::Zero();
  if (railed && !has_unknown_rate) {
    const SaturatedForce force =
        saturated_force(sample, f, q_mid.conjugate() * ((centre_velocity_change_m_s + fallen) / dt_s));
    f = force.force_m_s2;
    least = force.lower_bound_m_s2;
  }
  const Eigen::Vector3d gained = has_unknown_rate ? centre_velocity_change_m_s : Eigen::Vector3d(R_T * f - fallen);
  nominal.p_WI_m += dt_s * (nominal.v_WI_m_s + 0.5 * gained);
  nominal.v_WI_m_s += gained;
  sums.integrated_rotation_s += R_T;
  for (int axis = 0; axis < 3; ++axis) sums.rotation_rate_integral.middleCols<3>(3 * axis) += w_raw[axis] * R_T;
  if (!has_unknown_rate) {  // without a known rate, errors of specific force and attitude do not affect the velocity
    sums.integrated_rotation_with_force_s += R_T;
    sums.force_integral_W_m_s += R_T * f;
    for (int axis = 0; axis < 3; ++axis) sums.rotation_by_force_integral.middleCols<3>(3 * axis) += f_raw[axis] * R_T;
    sums.rate_cross_force_integral_W += R_T * w.cross(f_raw);
  }
  sums.rate_integral_I_rad += dt_s * w;
  sums.force_integral_I_m_s += dt_s * f_raw;
  sums.squared_rate_integral_rad2_s += dt_s * w.squaredNorm();
  const double force_minus_gravity_m_s2 = std::abs(f.norm() - gravity) - kNoImpactForce_m_s2;
  sums.impact_m_s += dt_s * std::max(0.0, force_minus_gravity_m_s2);
  sums.unexplained_impact_m_s += dt_s * std::max(0.0, force_minus_gravity_m_s2 - kImuOffset_m * w.squaredNorm());
  const double peak = f_raw.cwiseAbs().maxCoeff() / params.accel_range_m_s2;
  const double hidden = std::clamp((peak - kPartialRangeMin) / (kPartialRangeMax - kPartialRangeMin), 0.0, 1.0);
  const double share = params.expert.saturation.subsample_saturation_ratio;
  if (railed) {
    sums.partial_saturation_W_m_s += share * (R_T * least);
  } else if (!has_unknown_rate && hidden > 0.0) {
    sums.partial_saturation_W_m_s += share * hidden * (R_T * f);
  }
  if (railed || has_unknown_rate) sums.force_clipped_s += dt_s;
  if (lost) sums.rate_clipped_s += dt_s;
  if (beyond && !lost) sums.recovered_rate_s += dt_s;
  sums.node_interval_s += dt_s;
}

int gap_step_count(const RollingParams& params, double gap_s) {
  return std::max(1, static_cast<int>(std::lround(gap_s / params.expert.kNode_s)));
}

ImuSample gap_step_sample(const RollingParams& params, const ImuSample& before, const ImuSample& after, double gap_s,
                          int k, GapUncertainty& uncertainty) {
  const int pieces = gap_step_count(params, gap_s);
  const double share = (k + 0.5) / pieces;
  const Eigen::Vector3d change = after.angular_velocity_rad_s - before.angular_velocity_rad_s;
  ImuSample sample = after;
  sample.angular_velocity_rad_s = before.angular_velocity_rad_s + share * change;
  sample.device_clip_flags = 0;  // flags of the reading after the gap do not apply within the gap
  const double turning = std::max(before.angular_velocity_rad_s.norm(), after.angular_velocity_rad_s.norm());
  const double acceleration = kGapStill_rad_s2 + kGapAcceleration_rad_s2 * std::min(1.0, turning / kGapRate_rad_s);
  // If the rate error in a gap of T seconds is parabolic with second derivative a, the angle error is a T^3 / 12 (R31).
  const double mean_force_tilt_rad =
      acceleration * gap_s * gap_s * gap_s / 12.0 + kGapTimeSigmaRatio * change.norm() * gap_s;
  uncertainty.rotation_variance_rad2 = mean_force_tilt_rad * mean_force_tilt_rad / pieces;
  uncertainty.rate_variance_rad2_s =
      squared(mean_force_tilt_rad / gap_s) * gap_s;  // rolling.md (R32); same rate error in all pieces of the gap
  uncertainty.speed_variance_m2_s2 =
      squared(kGapVelocityChangeRatio * params.radius_m * change.norm()) / pieces;  // rolling.md (R33)
  return sample;
}

void integrate_gap(const RollingParams& params, const ImuSample& piece, double piece_s,
                   const GapUncertainty& uncertainty, RollingNominalState& nominal, RollingNodeIntegrals& sums) {
  integrate(params, piece, piece_s, nominal, sums, Force::force_unknown);
  sums.gap_s += piece_s;
  sums.gap_angle_variance_rad2 += uncertainty.rotation_variance_rad2;
  sums.gap_rate_variance_rad2_s += uncertainty.rate_variance_rad2_s;
  sums.gap_speed_variance_m2_s2 += uncertainty.speed_variance_m2_s2;
}

/// See rolling.md (R10).
Moving transition(const RollingNodeIntegrals& sums) {
  Moving B = Moving::Zero();
  B.block<3, 3>(kAttitude, kGyroBias) = -sums.integrated_rotation_s;
  B.block<3, 9>(kAttitude, kGyroScale) = -sums.rotation_rate_integral;
  B.block<3, 3>(kVelocity, kAttitude) = -so3::hat(sums.force_integral_W_m_s);
  B.block<3, 3>(kVelocity, kAccelBias) = -sums.integrated_rotation_with_force_s;
  B.block<3, 9>(kVelocity, kAccelScale) = -sums.rotation_by_force_integral;
  B.block<3, 1>(kVelocity, kDelay) = -sums.rate_cross_force_integral_W;
  B.middleRows<3>(kPosition) = 0.5 * sums.node_interval_s * B.middleRows<3>(kVelocity);
  B.block<3, 3>(kPosition, kVelocity) += sums.node_interval_s * Eigen::Matrix3d::Identity();
  return B;
}

/// See rolling.md (R11) to (R14).
void predict(const RollingParams& params, const RollingNodeIntegrals& sums, const Moving& B, Vector& x, Covariance& P,
             double noise_ratio) {
  const double h = sums.node_interval_s;
  x.head<9>() += (B * x).eval();
  P.topRows<9>() += (B * P).eval();
  P.leftCols<9>() += (P * B.transpose()).eval();
  make_symmetric(P);
  const double attitude =
      squared(params.expert.noise.attitude_walk_rad_sqrts) * h +
      squared(noise_ratio * params.expert.noise.rate_error_sqrts) * sums.squared_rate_integral_rad2_s +
      sums.gap_angle_variance_rad2 + squared(kClippedRateSigma_rad_s * sums.rate_clipped_s) +
      squared(params.expert.saturation.recovered_rate_sigma_rad_s.value_or(0.0)) * 2.0 * kRecoveredTau_s *
          sums.recovered_rate_s;
  const double velocity = squared(noise_ratio * RollingImuNoiseParams::kVelocityWalk_m_s_sqrts) * h +
                          squared(kImpactSigmaRatio * sums.impact_m_s) +
                          squared(kVelocityWalkPerRate2_sqrts * sums.squared_rate_integral_rad2_s) / h +
                          sums.gap_speed_variance_m2_s2 + squared(kClippedForceSigma_m_s2 * sums.force_clipped_s);
  P.block<3, 3>(kVelocity, kVelocity) += sums.partial_saturation_W_m_s * sums.partial_saturation_W_m_s.transpose();
  auto diagonal = P.diagonal();
  diagonal.segment<3>(kAttitude).array() += attitude;
  diagonal.segment<3>(kVelocity).array() += velocity;
  diagonal.segment<3>(kPosition).array() += velocity * h * h / 3.0;
  diagonal.segment<3>(kGyroBias).array() += squared(params.expert.noise.gyro_bias_walk_rad_s_sqrts) * h;
  diagonal.segment<3>(kAccelBias).array() += squared(kAccelBiasWalk_m_s2_sqrts) * h;
}

/// See rolling.md (R15), (R16), (R18).
Contact contact(const RollingParams& params, const RollingNominalState& nominal, const Eigen::Vector3d& rate_I_rad_s,
                const RollingNodeIntegrals& sums, double noise_ratio) {
  const Eigen::Matrix3d R = nominal.q_WI.toRotationMatrix();
  const Eigen::Vector3d w_W = R * (rate_I_rad_s - nominal.gyro_bias_rad_s - nominal.gyro_scale * rate_I_rad_s);
  const Eigen::Vector3d arm_W = R * (params.lever_arm_m + nominal.lever_arm_error_m);
  const Eigen::Vector3d n = floor_normal(nominal.floor_slope);
  const double r = params.radius_m + nominal.radius_error_m;
  const Eigen::Matrix3d reach = so3::hat(arm_W + r * n);
  Contact out;
  out.contact_velocity_W_m_s = nominal.v_WI_m_s + reach * w_W;
  out.measurement_jacobian.setZero();
  out.measurement_jacobian.middleCols<3>(kVelocity).setIdentity();
  out.measurement_jacobian.middleCols<3>(kAttitude) = so3::hat(w_W.cross(arm_W)) - r * so3::hat(n) * so3::hat(w_W);
  out.measurement_jacobian.middleCols<3>(kGyroBias) = -reach * R;
  for (int axis = 0; axis < 3; ++axis) {
    out.measurement_jacobian.middleCols<3>(kGyroScale + 3 * axis) = -rate_I_rad_s[axis] * reach * R;
  }
  out.measurement_jacobian.middleCols<3>(kLeverArm) = -so3::hat(w_W) * R;
  const Eigen::Matrix3d by_normal = -r * so3::hat(w_W);
  out.normal_height_derivative_W = by_normal.col(2);
  out.floor_slope = nominal.floor_slope;
  out.measurement_jacobian.middleCols<2>(kSlope) =
      by_normal.leftCols<2>() - out.normal_height_derivative_W * nominal.floor_slope.transpose() / n.z();
  out.measurement_jacobian.col(kRadius) = -w_W.cross(n);
  out.rolling_speed_m_s = r * w_W.cross(n).norm();
  out.grip_variance = squared(noise_ratio * RollingContactParams::kGripSigma_m_s) +
                      squared(noise_ratio * RollingContactParams::kGripSigmaRatio * r * w_W.norm());
  const bool beyond = rate_I_rad_s.cwiseAbs().maxCoeff() >= params.gyro_range_rad_s || sums.recovered_rate_s > 0.0;
  const std::optional<double>& recovered_sigma_rad_s = params.expert.saturation.recovered_rate_sigma_rad_s;
  if (sums.rate_clipped_s > 0.0 || (beyond && !recovered_sigma_rad_s)) {
    out.grip_variance += squared(r * kClippedRateSigma_rad_s);
  } else if (beyond) {
    out.grip_variance += squared(r * *recovered_sigma_rad_s);
  }
  if (sums.gap_s > 0.0) {
    out.gap_extra_variance = squared(r) * sums.gap_rate_variance_rad2_s / sums.node_interval_s;  // rolling.md (R32)
    out.grip_variance += out.gap_extra_variance;
  }
  return out;
}

/// See rolling.md (R20).
std::optional<double> velocity_variance_if_lost(double node_s, const Covariance& P) {
  if (P(kVelocity, kVelocity) + P(kVelocity + 1, kVelocity + 1) < squared(kUnsureSpeed_m_s)) return std::nullopt;
  return squared(kSpeedSigma_m_s) * kSpeedWindow_s / node_s;
}

bool resets_floor_slope(ContactMode from, ContactMode to) {
  return from != to && !may_slip(to);
}

/// See rolling.md (R21).
void update_slope_for_mode(ContactMode from, ContactMode to, double h_s, const RollingNominalState& nominal, Vector& x,
                           Covariance& P) {
  if (from == ContactMode::incline && to == from) {
    P.diagonal().segment<2>(kSlope).array() += squared(kSlopeWalk_sqrts) * h_s;
  }
  if (to == ContactMode::rough) P(kRadius, kRadius) += squared(kRoughRadiusWalk_m_sqrts) * h_s;
  if (!resets_floor_slope(from, to)) return;
  P.middleRows<2>(kSlope).setZero();
  P.middleCols<2>(kSlope).setZero();
  const double sigma = to == ContactMode::incline ? RollingContactParams::kSlopeSigma : kLevelSlopeSigma;
  P.diagonal().segment<2>(kSlope).setConstant(squared(sigma));
  x.segment<2>(kSlope) = -nominal.floor_slope;
}

/// See rolling.md (R30).
bool reset_tilt(const RollingParams& params, const RollingNodeIntegrals& sums, bool at_rest,
                RollingNominalState& nominal, Covariance& P) {
  if (sums.force_clipped_s >= sums.node_interval_s) return false;
  if (sums.squared_rate_integral_rad2_s > squared(kFastRate_rad_s) * sums.node_interval_s) return false;
  const Eigen::Vector3d f_I_m_s2 = sums.force_integral_I_m_s / sums.node_interval_s;
  const double tilt_variance = std::max(P(kAttitude, kAttitude), P(kAttitude + 1, kAttitude + 1));
  if (tilt_variance < squared(at_rest ? kUncertainTilt_rad : kLostTilt_rad)) return false;
  const double force = f_I_m_s2.norm();
  if (!(force > 0.1 * params.gravity_m_s2)) return false;
  if (!at_rest && std::abs(force - params.gravity_m_s2) > kPushForceRatio * params.gravity_m_s2) return false;
  const Eigen::Vector3d up_W = nominal.q_WI * (f_I_m_s2 / force);
  nominal.q_WI = (so3::shortest_arc(up_W, Eigen::Vector3d::UnitZ()) * nominal.q_WI).normalized();
  nominal.v_WI_m_s.setZero();
  P.topRows<6>().setZero();
  P.leftCols<6>().setZero();
  const double tilt_sigma_rad = at_rest ? std::max(params.expert.prior.tilt_sigma_rad, kRestTilt_rad) : kForceTilt_rad;
  P.diagonal().segment<2>(kAttitude).setConstant(squared(tilt_sigma_rad));
  P(kAttitude + 2, kAttitude + 2) = squared(kLostSpeed_m_s);  // practically unknown heading, but linearisation is valid
  P.diagonal().segment<3>(kVelocity).setConstant(
      squared(at_rest ? RollingContactParams::kRestVelocitySigma_m_s : kLostSpeed_m_s));
  return true;
}

void update(const Row& row, double measured, double variance, Vector& x, Covariance& P) {
  x += scalar_update(row, measured - row.dot(x), variance, P);
}

void update(int index, double measured, double variance, Vector& x, Covariance& P) {
  x += kalman_update_of_component(index, measured - x[index], variance, P);
}

}  // namespace tumble::rolling
