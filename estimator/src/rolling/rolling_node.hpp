// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tumble/common/detail/squared.hpp"
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

/// Returns the calibration constants of a nominal state, in the order of rolling.md (R1).
Eigen::Matrix<double, RollingCalibration::kSize, 1> constants_of(const RollingNominalState& nominal);

/// Adds the estimated error `x` to the nominal trajectory and constants.
void move_linearisation_point(const Vector& x, RollingNominalState& nominal);

}  // namespace tumble::rolling
