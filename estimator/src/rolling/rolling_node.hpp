// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/types.hpp"
#include "tumble/rolling/detail/rolling_model.hpp"
#include "tumble/rolling/detail/rolling_params.hpp"

namespace tumble::rolling {

/// index of the first element of each quantity in the error state
inline constexpr int kAttitude = 0, kVelocity = 3, kPosition = 6, kGyroBias = 9, kAccelBias = 12, kAccelScale = 15,
                     kGyroScale = 24, kDelay = 33, kLeverArm = 34, kSlope = 37, kRadius = 39;
inline constexpr int kStates = 40;
static_assert(kStates - kGyroBias == RollingCalibration::kSize);

using Vector = Eigen::Matrix<double, kStates, 1>;
using Row = Eigen::Matrix<double, 1, kStates>;
using Covariance = Eigen::Matrix<double, kStates, kStates>;
using Moving = Eigen::Matrix<double, 9, kStates>;

/// The reported position is held constant if the speed of the sphere has been below kConstrainSpeed_m_s for
/// kConstrainAfter_s.
inline constexpr double kConstrainAfter_s = 0.1, kConstrainSpeed_m_s = 0.02;

/// Contact contains the velocity of the contact point on the nominal trajectory, and the Jacobian of this velocity with
/// respect to the error state.
struct Contact {
  Eigen::Vector3d contact_velocity_W_m_s;
  Eigen::Matrix<double, 3, kStates> measurement_jacobian;
  double grip_variance = 0.0;
  /// additional variance of the contact velocity in every direction, due to a data gap
  double gap_extra_variance = 0.0;
  double rolling_speed_m_s = 0.0;  ///< speed of the centre if the sphere rolls without slip
  /// derivative of the contact velocity with respect to the vertical component of the floor's normal
  Eigen::Vector3d normal_height_derivative_W;
  Eigen::Vector2d floor_slope;

  /// Returns the contact velocity for the error state `x`. The floor normal has unit length, so the contact velocity is
  /// a nonlinear function of the slope error. The contact velocity is linear in all other errors.
  Eigen::Vector3d velocity(const Vector& x) const;
};

/// Returns the variance of the contact velocity. In the mode `slip`, only the vertical component of the result is
/// valid.
Eigen::Vector3d contact_variance(const Contact& c, ContactMode mode);

bool starts_in_motion(const Eigen::Vector3d& rate_I_rad_s);

/// Returns the initial state with the attitude `q_WI` and the sphere's centre at the origin. The initial velocity is
/// zero, or the velocity of rolling.
RollingNominalState start_nominal(const RollingParams& params, const Eigen::Quaterniond& q_WI,
                                  const Eigen::Vector3d& rate_I_rad_s);
void set_prior(const RollingParams& params, const Eigen::Vector3d& rate_I_rad_s, Covariance& P);

enum class Force { force_measured, force_unknown };

/// `sample` contains the mean readings over the time interval of length `dt_s` before the time stamp of the sample.
void integrate(const RollingParams& params, const ImuSample& sample, double dt_s, RollingNominalState& nominal,
               RollingNodeIntegrals& sums, Force known = Force::force_measured);

int gap_step_count(const RollingParams& params, double gap_s);

struct GapUncertainty {
  double rotation_variance_rad2 = 0.0, rate_variance_rad2_s = 0.0, speed_variance_m2_s2 = 0.0;
};
ImuSample gap_step_sample(const RollingParams& params, const ImuSample& before, const ImuSample& after, double gap_s,
                          int k, GapUncertainty& uncertainty);

void integrate_gap(const RollingParams& params, const ImuSample& piece, double piece_s,
                   const GapUncertainty& uncertainty, RollingNominalState& nominal, RollingNodeIntegrals& sums);

/// Returns the matrix B. During one filter step (node), the errors of attitude, velocity and position change by B times
/// the error state.
Moving transition(const RollingNodeIntegrals& sums);
/// `noise_ratio` multiplies the root densities of the velocity noise and of the rate-dependent attitude noise.
void predict(const RollingParams& params, const RollingNodeIntegrals& sums, const Moving& B, Vector& x, Covariance& P,
             double noise_ratio = 1.0);

/// `rate_I_rad_s` is the uncorrected gyro reading at the end of the filter step (node). A data gap within the filter
/// step increases the variance of the contact velocity. `noise_ratio` multiplies the standard deviation of the contact
/// velocity during grip.
Contact contact(const RollingParams& params, const RollingNominalState& nominal, const Eigen::Vector3d& rate_I_rad_s,
                const RollingNodeIntegrals& sums, double noise_ratio = 1.0);

/// In the mode `incline`, the slope of the floor is a random walk. A transition to a mode with resting contact point
/// resets the slope.
void update_slope_for_mode(ContactMode from, ContactMode to, double h_s, const RollingNominalState& nominal, Vector& x,
                           Covariance& P);

/// Returns the variance of a pseudo-measurement of zero velocity, or nothing if the variance of the velocity is small.
std::optional<double> velocity_variance_if_lost(double node_s, const Covariance& P);

bool resets_floor_slope(ContactMode from, ContactMode to);

/// If the tilt is uncertain, levels the attitude with the mean specific force of the filter step, and resets the
/// velocity. If the tilt is certain, or if the specific force is unusable, returns false without a reset.
bool reset_tilt(const RollingParams& params, const RollingNodeIntegrals& sums, bool at_rest,
                RollingNominalState& nominal, Covariance& P);

/// Applies a Kalman update with the scalar measurement `measured` = row x + noise.
void update(const Row& row, double measured, double variance, Vector& x, Covariance& P);

void update(int index, double measured, double variance, Vector& x, Covariance& P);

/// Adds the estimated error `x` to the nominal trajectory and constants.
void move_linearisation_point(const Vector& x, RollingNominalState& nominal);

// The following functions call `take(row, measured, variance)` for each scalar measurement of the error state x:
// measured = row * x + noise. `row` is a Row, or the index of a single state. Each call of `take` may change the state
// `x` and its covariance `P`.

/// During grip, the contact point is at rest. During slip, the contact point moves along the floor: rolling.md (R17),
/// (R20). If the velocity of the sphere is very uncertain, a weak pseudo-measurement of zero velocity is added.
template <class EstimateCallback>
void contact_measurement_rows(const Contact& c, ContactMode mode, double node_s, const Eigen::Vector3d& v_WI_m_s,
                              const Vector& x, const Covariance& P, EstimateCallback&& take) {
  // The contact velocity is not linear in the error state. The nonlinear part of the contact velocity is subtracted
  // from the measurement.
  const Eigen::Vector3d u = c.velocity(x) - c.measurement_jacobian * x, variance = contact_variance(c, mode);
  if (!may_slip(mode)) {
    for (int axis = 0; axis < 2; ++axis) take(Row(c.measurement_jacobian.row(axis)), -u[axis], variance[axis]);
  }
  if (mode != ContactMode::bump_or_flight) take(Row(c.measurement_jacobian.row(2)), -u.z(), variance.z());
  if (const auto lost = velocity_variance_if_lost(node_s, P)) {
    for (int axis = 0; axis < 2; ++axis) take(kVelocity + axis, -v_WI_m_s[axis], *lost);
  }
}

/// See rolling.md (R28).
template <class EstimateCallback>
void stationary_measurement_rows(const RollingNodeIntegrals& sums, const RollingNominalState& nominal,
                                 bool spins_in_place, EstimateCallback&& take) {
  for (int axis = 0; axis < 3; ++axis) {
    take(kVelocity + axis, -nominal.v_WI_m_s[axis], squared(RollingContactParams::kRestVelocitySigma_m_s));
    if (spins_in_place) continue;
    const double bias_rad_s = sums.rate_integral_I_rad[axis] / sums.node_interval_s;
    take(kGyroBias + axis, bias_rad_s, squared(RollingContactParams::kRestRateSigma_rad_s));
  }
}

// Rolling does not determine the heading, because a rotation of the whole run about the vertical leaves all readings
// unchanged. If the heading error is large, a linearised filter nevertheless reduces the heading's variance, which is
// wrong: rolling.md (R34) to (R36).

/// standard deviation of the heading, above which a measurement must not reduce the variance of the heading
inline constexpr double kLostHeading_rad = 0.1;

inline bool heading_lost(const Covariance& P) {
  return P(kAttitude + 2, kAttitude + 2) > squared(kLostHeading_rad);
}

/// Removes the derivative of the contact velocity with respect to the heading error: rolling.md (R35).
inline void remove_heading_component(Contact& c) {
  c.measurement_jacobian.col(kAttitude + 2) -= Eigen::Vector3d::UnitZ().cross(c.contact_velocity_W_m_s);
}

/// See rolling.md (R36).
inline Vector heading_component(const Vector& x) {
  const auto turned = [](const auto& v) { return Eigen::Vector2d(-v.y(), v.x()); };
  Vector out = Vector::Zero();
  out.segment<2>(kVelocity) = turned(x.segment<2>(kVelocity));
  out.segment<2>(kPosition) = turned(x.segment<2>(kPosition));
  out.segment<2>(kSlope) = turned(x.segment<2>(kSlope));
  return out;
}

/// Transforms the covariance P of the error state after a correction of the nominal trajectory, with the matrix T of
/// rolling.md (R36).
inline void remove_heading_covariance(const Vector& turned, Covariance& P) {
  P += (turned * P.row(kAttitude + 2)).eval();
  P += (P.col(kAttitude + 2) * turned.transpose()).eval();
}

inline void remove_heading_error(const Vector& turned, Vector& x) {
  x += x[kAttitude + 2] * turned;
}

}  // namespace tumble::rolling
