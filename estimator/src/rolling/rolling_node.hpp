// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/detail/squared.hpp"
#include "tumble/rolling/rolling_model.hpp"
#include "tumble/rolling/rolling_params.hpp"

namespace tumble::rolling {

/// Error state: attitude (W), velocity and position of the IMU (W), then constants; first index of each part.
inline constexpr int kAttitude = 0, kVelocity = 3, kPosition = 6, kGyroBias = 9, kAccelBias = 12, kAccelScale = 15,
                     kGyroScale = 24, kDelay = 33, kLeverArm = 34, kSlope = 37, kRadius = 39;
inline constexpr int kStates = 40;

using Vector = Eigen::Matrix<double, kStates, 1>;
using Row = Eigen::Matrix<double, 1, kStates>;
using Covariance = Eigen::Matrix<double, kStates, kStates>;
using Moving = Eigen::Matrix<double, 9, kStates>;

/// Quiet for so long, and no faster: it stands still, and so does the position that is given out.
inline constexpr double kHeldAfter_s = 0.1, kHeldSpeed_m_s = 0.02;

/// Contact velocity of the nominal trajectory and its derivative by the error state.
struct Contact {
  Eigen::Vector3d u_W_m_s;
  Eigen::Matrix<double, 3, kStates> H;
  double grip_variance = 0.0;
  double gap_variance = 0.0;       ///< more, in every direction
  double rolling_speed_m_s = 0.0;  ///< of the centre, should it grip
  Eigen::Vector3d lift_W;          ///< change of u for a change of the normal's third component
  Eigen::Vector2d slope;           ///< nominal

  /// Contact velocity for an error `x`: linear but for the length of the normal.
  Eigen::Vector3d velocity(const Vector& x) const;
};

/// Of the contact velocity while the contact stands still; slipping, its vertical part alone counts.
Eigen::Vector3d contact_variance(const RollingParams& params, const Contact& c, RollingMode mode);

/// Whether the first reading was taken in motion.
bool starts_in_motion(const RollingParams& params, const Eigen::Vector3d& rate_I_rad_s);

/// Levelled (or given) attitude, centre at the origin, at rest; in motion it rolls.
RollingNominal start_nominal(const RollingParams& params, const Eigen::Quaterniond& q_WI,
                             const Eigen::Vector3d& rate_I_rad_s);
void set_prior(const RollingParams& params, const Eigen::Vector3d& rate_I_rad_s, Covariance& P);

/// Whether the force of a reading was read at all, if only up to its rail; in a gap it was not.
enum class Force { read, unknown };

/// Takes averaged readings into the nominal trajectory and the sums.
void integrate(const RollingParams& params, const ImuAverage& reading, RollingNominal& nominal, RollingSums& sums,
               Force known = Force::read);

/// The nominal trajectory carried on by readings that are not taken yet.
RollingNominal carried_on(const RollingParams& params, const ImuAverage& reading, const RollingNominal& nominal);

/// Pieces that a gap is bridged in.
int gap_pieces(const RollingParams& params, double gap_s);

/// Piece k of a gap between two readings: the rate between theirs, no force. `doubt` gets what it may be off by.
struct GapDoubt {
  double rad2 = 0.0, rate_rad2_s = 0.0, speed_m2_s2 = 0.0;
};
ImuAverage gap_piece(const RollingParams& params, const ImuSample& before, const ImuSample& after, double gap_s, int k,
                     GapDoubt& doubt);

/// Takes a piece of a gap.
void integrate_gap(const RollingParams& params, const ImuAverage& piece, const GapDoubt& doubt, RollingNominal& nominal,
                   RollingSums& sums);

/// Transition of the error over the node: x <- x + (B x on top).
Moving transition(const RollingSums& sums);
void predict(const RollingParams& params, const RollingSums& sums, const Moving& B, Vector& x, Covariance& P);

/// `rate_I_rad_s` is the raw reading at the node.
/// `sums` are those of the node: what a gap in it makes of the rate counts as noise of the contact.
Contact contact(const RollingParams& params, const RollingNominal& nominal, const Eigen::Vector3d& rate_I_rad_s,
                const RollingSums& sums);

/// What a change of mode does to the floor's slope: it walks while the slope lasts, and becomes level or unknown when
/// the contact stands still anew. `h_s` is the length of the node.
void change_floor(const RollingParams& params, RollingMode from, RollingMode to, double h_s,
                  const RollingNominal& nominal, Vector& x, Covariance& P);

/// Variance of the zero that the velocity is taken for at a node, where it is lost; none where it is known.
std::optional<double> lost_velocity_variance(const RollingParams& params, double node_s, const Covariance& P);

/// Whether the slope is forgotten on this change: what is known of it before says nothing about it after.
bool forgets_slope(RollingMode from, RollingMode to);

/// After clipping the attitude may be lost: levels it anew by the node's mean force, at rest or not, and forgets the
/// velocity. False when there was no need, or the node's force tells nothing.
bool reset_tilt(const RollingParams& params, const RollingSums& sums, bool at_rest, RollingNominal& nominal,
                Covariance& P);

/// Kalman update by a scalar row: measurement = row x + noise.
void update(const Row& row, double measured, double variance, Vector& x, Covariance& P);

/// The same for a row that picks one state.
void update(int index, double measured, double variance, Vector& x, Covariance& P);

/// Moves the error `x` into the nominal trajectory and constants.
void rebase(const Vector& x, RollingNominal& nominal);

}  // namespace tumble::rolling
