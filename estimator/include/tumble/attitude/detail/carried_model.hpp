// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "tumble/common/detail/arrow_system.hpp"

namespace tumble {

/// The carried body as a least-squares problem: a chain of nodes at equal steps of time, and constants of the device.
/// Each function adds one factor to the normal equations H d = g and returns its cost (minus two times its log).
namespace carried {

inline constexpr int kState = 18;  ///< of a node: see Index
inline constexpr int kBorder = 9;  ///< of the constants: see ConstantIndex
using System = ArrowSystem<kState, kBorder>;

/// Where the parts of a node's error lie; that of the attitude is phi with q_true = q_WI Exp(phi).
enum Index { kPhi = 0, kRate = 3, kAngular = 6, kHand = 9, kVelocity = 12, kPosition = 15 };
enum ConstantIndex { kGyroBias = 0, kAccelBias = 3, kLever = 6 };

/// One node. The carried point is what the hand holds; its acceleration, velocity and position are bounded.
struct Node {
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_WI_I_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_acceleration_rad_s2 = Eigen::Vector3d::Zero();  ///< derivative of the rate, sensor axes
  Eigen::Vector3d a_W_m_s2 = Eigen::Vector3d::Zero();                     ///< of the carried point
  Eigen::Vector3d v_W_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  void move(const System::StateVector& step);
};

/// What stays the same over a recording.
struct Constants {
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from the carried point to the sensor, sensor axes
  void move(const System::BorderVector& step);
};

/// The readings of one sensing element about a node, at times t from it: sums, so that a step of the solver costs the
/// same at any rate of the IMU.
struct ElementSums {
  double n = 0.0, t_s = 0.0, tt_s2 = 0.0, z = 0.0, zt = 0.0;  ///< count and sums of the free readings z
  double clipped = 0.0, clipped_t_s = 0.0, rail = 0.0;        ///< count, mean time and mean rail
  double sign = 0.0;                                          ///< of the rail: the truth lies beyond it
  double unread = 0.0, unread_z = 0.0;                        ///< count and mean of readings that say nothing
  double open = 0.0;  ///< deviation that all free readings share: of one whose window met the rail in a part
};

/// All readings about a node.
struct NodeReadings {
  std::array<ElementSums, 3> gyro;
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero();   ///< mean
  Eigen::Vector3d force_bound = Eigen::Vector3d::Zero();  ///< sign of the rail where an axis clips, else 0
  double force_n = 0.0;                                   ///< number of force readings
  double force_t_s = 0.0;                                 ///< mean time of the force readings
  double force_open_m_s2 = 0.0;                           ///< what their window leaves open of their time makes of them
  bool rest = false;
};

/// Deviations that the factors are weighed with.
struct ReadingNoise {
  double gyro_rad_s = 0.0;    ///< of one reading
  double window_rad_s = 0.0;  ///< of what a mean over a window differs from the rate at its centre by, one reading
  double tilt_share = 0.0;    ///< of a free element while another clips, per rad/s of that one's deficit
  double rail_rad_s = 0.0;    ///< of a rail
  double bound = 1.0;         ///< share of a gyro's bounds that counts as information
  double force_bound = 1.0;   ///< likewise of an accelerometer's
  double accel_m_s2 = 0.0;    ///< of one reading
  double accel_share = 0.0;   ///< more, per m/s^2 away from gravity
  double rest_rad_s = 0.0;    ///< of the rate at rest, one node
  double rest_m_s = 0.0;      ///< of the velocity at rest
  double rest_m_s2 = 0.0;     ///< of the acceleration at rest
};

/// Gyro of one node, element by element: row i of `rows` is the axis m_i along which element i senses. Free readings
/// measure m_i' (rate + bias), clipped ones bound it from one side.
double add_gyro(const NodeReadings& readings, const Eigen::Matrix3d& rows, const ReadingNoise& noise, const Node& node,
                const Constants& constants, System::Block& block, System::Corner& corner);

/// Specific force of one node: f = R'(a - g) + alpha x r + w x (w x r) + bias at the mean time of the readings.
double add_force(const NodeReadings& readings, const Eigen::Vector3d& g_W_m_s2, const ReadingNoise& noise,
                 const Node& node, const Constants& constants, System::Block& block, System::Corner& corner);

/// A resting node: rate, velocity and acceleration about zero.
double add_rest(const ReadingNoise& noise, const Node& node, System::Block& block);

/// The motion from one node to the next, per step of `h` seconds: white angular jerk; the hand's acceleration a bounded
/// process of its own memory, its velocity and position about zero over theirs.
class Motion {
 public:
  struct Params {
    double step_s = 0.01;
    double jerk_rad_s3_sqrts = 0.0;     ///< root of the density of the angular jerk
    double rotation_error_sqrts = 0.0;  ///< random walk of the attitude per rad/s turned: scale, misalignment
    double hand_m_s2 = 0.0, hand_tau_s = 0.0;
    double velocity_m_s = 0.0, velocity_tau_s = 0.0;
    double position_m = 0.0, position_tau_s = 0.0, position_leak_s = 10.0;
  };
  explicit Motion(const Params& params);

  /// `hand`: what the density of the hand's acceleration is multiplied with in this step; `jerk`: likewise the root
  /// density of the angular jerk.
  double add_step(const Node& from, const Node& to, double hand, System::Block& block, System::Block& next,
                  double jerk = 1.0) const;
  /// Velocity and position about zero: the share of one node.
  double add_bounds(const Node& node, System::Block& block) const;
  /// The first node: heading 0 as it stands, everything else as wide as the process.
  double add_first(const Node& node, System::Block& block) const;

 private:
  double add_attitude(const Node& from, const Node& to, double jerk, System::Block& block, System::Block& next) const;

  Params params_;
  Eigen::Matrix4d jerk_;  // information of (rate, angular acceleration) here and next, one axis
  Eigen::Matrix<double, 6, 6> hand_, kinematics_;  // of (acceleration, velocity, position) here and next, one axis
  double phi_variance_;
};

/// Rotation vector from node to node by the rates' cubic, with the coning term (Magnus, fourth order).
Eigen::Vector3d turned(const Node& from, const Node& to, double step_s);

}  // namespace carried

extern template struct ArrowSystem<carried::kState, carried::kBorder>;  // carried_arrow.cpp
}  // namespace tumble
