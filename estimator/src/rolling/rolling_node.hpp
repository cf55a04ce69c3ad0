// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/detail/squared.hpp"
#include "tumble/rolling/rolling_model.hpp"
#include "tumble/rolling/rolling_params.hpp"

namespace tumble::rolling {

/// First index of each part of the error state: attitude (W), velocity and position of the IMU (W), then constants.
inline constexpr int kAttitude = 0, kVelocity = 3, kPosition = 6, kGyroBias = 9, kAccelBias = 12, kAccelScale = 15,
                     kGyroScale = 24, kDelay = 33, kLeverArm = 34, kSlope = 37, kRadius = 39;
inline constexpr int kStates = 40;

using Vector = Eigen::Matrix<double, kStates, 1>;
using Row = Eigen::Matrix<double, 1, kStates>;
using Covariance = Eigen::Matrix<double, kStates, kStates>;
using Moving = Eigen::Matrix<double, 9, kStates>;

/// After kConstrainAfter_s without motion and below the speed limit, the sphere is at rest, and the reported position
/// is constant.
inline constexpr double kConstrainAfter_s = 0.1, kConstrainSpeed_m_s = 0.02;

/// Contact is the contact velocity of the nominal trajectory, and its derivative by the error state.
struct Contact {
  Eigen::Vector3d contact_velocity_W_m_s;
  Eigen::Matrix<double, 3, kStates> H;
  double grip_variance = 0.0;
  double gap_variance = 0.0;       ///< additional variance from a gap, in every direction
  double rolling_speed_m_s = 0.0;  ///< speed of the centre, assuming grip
  Eigen::Vector3d lift_W;          ///< derivative of u by the third component of the normal
  Eigen::Vector2d slope;           ///< slope of the nominal

  /// Returns the contact velocity for an error `x`. The contact velocity is linear in `x` except for the length of the
  /// normal.
  Eigen::Vector3d velocity(const Vector& x) const;
};

/// Returns the variance of a stationary contact point's velocity. When the sphere slips, only the vertical component is
/// used.
Eigen::Vector3d contact_variance(const RollingParams& params, const Contact& c, RollingMode mode);

bool starts_in_motion(const RollingParams& params, const Eigen::Vector3d& rate_I_rad_s);

/// Returns the initial state: levelled or stated attitude, centre at the origin, and zero velocity, or rolling velocity
/// if the sphere starts in motion.
RollingNominal start_nominal(const RollingParams& params, const Eigen::Quaterniond& q_WI,
                             const Eigen::Vector3d& rate_I_rad_s);
void set_prior(const RollingParams& params, const Eigen::Vector3d& rate_I_rad_s, Covariance& P);

/// Force states whether a force is measured (at least up to saturation) or unknown, as in a gap.
enum class Force { read, unknown };

void integrate(const RollingParams& params, const ImuAverage& reading, RollingNominal& nominal, RollingIntegrals& sums,
               Force known = Force::read);

/// Returns the nominal trajectory, extrapolated by readings that are not yet processed.
RollingNominal extrapolate_nominal(const RollingParams& params, const ImuAverage& reading,
                                   const RollingNominal& nominal);

int gap_pieces(const RollingParams& params, double gap_s);

/// GapUncertainty is the uncertainty of a piece of a gap, with interpolated rate and without force.
struct GapUncertainty {
  double rad2 = 0.0, rate_variance_rad2_s = 0.0, speed_variance_m2_s2 = 0.0;
};
ImuAverage gap_step(const RollingParams& params, const ImuSample& before, const ImuSample& after, double gap_s, int k,
                    GapUncertainty& uncertainty);

void integrate_gap(const RollingParams& params, const ImuAverage& piece, const GapUncertainty& uncertainty,
                   RollingNominal& nominal, RollingIntegrals& sums);

/// Returns the transition of the error over the node: x <- x + (B x on top).
Moving transition(const RollingIntegrals& sums);
void predict(const RollingParams& params, const RollingIntegrals& sums, const Moving& B, Vector& x, Covariance& P);

/// Computes the contact at a node. `rate_I_rad_s` is the unprocessed reading at the node. `sums` contains the sums over
/// the node; the rate's uncertainty in a gap adds to the noise of the contact.
Contact contact(const RollingParams& params, const RollingNominal& nominal, const Eigen::Vector3d& rate_I_rad_s,
                const RollingIntegrals& sums);

/// Updates the floor's slope for a change of mode. The slope is a random walk while the mode lasts. When the contact
/// point stops again, the slope becomes level or unknown. `h_s` is the duration of the node.
void update_slope_for_mode(const RollingParams& params, RollingMode from, RollingMode to, double h_s,
                           const RollingNominal& nominal, Vector& x, Covariance& P);

/// Returns the variance of the pseudo-measurement of zero velocity at a node with unknown velocity. The result is empty
/// at a node with known velocity.
std::optional<double> lost_velocity_variance(const RollingParams& params, double node_s, const Covariance& P);

/// Returns whether a mode change from `from` to `to` makes the slope unknown.
bool resets_slope(RollingMode from, RollingMode to);

/// Levels a tilt that was lost during clipping, by the mean force of the node, at rest or in motion. The function also
/// resets the velocity. Returns false if levelling is not needed, or if the force of the node is not usable.
bool reset_tilt(const RollingParams& params, const RollingIntegrals& sums, bool at_rest, RollingNominal& nominal,
                Covariance& P);

/// Applies a Kalman update by a scalar row: measurement = row x + noise.
void update(const Row& row, double measured, double variance, Vector& x, Covariance& P);

/// Applies a Kalman update by a measurement of a single state.
void update(int index, double measured, double variance, Vector& x, Covariance& P);

/// Adds the error `x` to the nominal trajectory and constants.
void move_linearisation_point(const Vector& x, RollingNominal& nominal);

}  // namespace tumble::rolling
