// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "tumble/common/detail/arrow_system.hpp"

namespace tumble {

/// Least-squares problem for hand-held motion, over a chain of states (nodes) at equal time steps. Each add function
/// adds one residual to the normal equations and returns the cost of the residual.
namespace hand_held {

inline constexpr int kBlockSize = 18;  ///< size of a node's error vector: Index
inline constexpr int kBorderSize = 9;  ///< number of constants: ConstantsIndex
using System = BlockArrowSystem<kBlockSize, kBorderSize>;

/// First index of each part of a node's error vector. The attitude error phi is defined by q_true = q_WI Exp(phi).
enum Index {
  kAttitudeError = 0,
  kRate = 3,
  kAngularAcceleration = 6,
  kHandAccelerationIndex = 9,
  kVelocity = 12,
  kPosition = 15
};
enum ConstantsIndex { kGyroBias = 0, kAccelBias = 3, kLever = 6 };

/// State of the body at one time step. The held point is the point of the body at the hand.
struct Node {
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Eigen::Vector3d w_WI_I_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_acceleration_rad_s2 = Eigen::Vector3d::Zero();  ///< in sensor axes
  Eigen::Vector3d a_W_m_s2 = Eigen::Vector3d::Zero();                     ///< acceleration of the held point
  Eigen::Vector3d v_W_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  void move(const System::StateVector& step);
};

struct Constants {
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< vector from the held point to the IMU, in sensor axes
  void move(const System::BorderVector& step);
};

/// Sums over the gyro readings of one sensing element near a node; times are relative to the node.
struct SensingAxisSums {
  double count = 0.0, time_sum_s = 0.0, time_squared_sum_s2 = 0.0, reading_sum = 0.0,
         reading_time_sum = 0.0;  ///< count and sums of unsaturated readings
  double clipped_reading_count = 0.0, clipped_time_s = 0.0,
         mean_saturation_limit = 0.0;  ///< count, mean time and mean magnitude of clipped readings
  double saturated_side = 0.0;         ///< sign of the saturation limit
  double unusable_reading_count = 0.0, mean_unusable_reading = 0.0;
  double partial_saturation_sigma = 0.0;  ///< standard deviation of readings that may be partly saturated
};

struct NodeReadings {
  std::array<SensingAxisSums, 3> gyro;
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_bound_m_s2 =
      Eigen::Vector3d::Zero();  ///< sign of the reading on clipped accelerometer axes, otherwise 0
  double force_reading_count = 0.0;
  double mean_force_time_s = 0.0;
  double force_timing_sigma_m_s2 = 0.0;  ///< standard deviation of the force because of uncertain reading times
  bool is_stationary = false;
};

struct ReadingNoise {
  double gyro_rad_s = 0.0;               ///< standard deviation of one gyro reading
  double window_rate_sigma_rad_s = 0.0;  ///< standard deviation of (mean rate over a window - rate at the centre)
  double deficit_error_ratio = 0.0;  ///< error of an unclipped gyro element / saturation deficit of a clipped element
  double saturation_limit_sigma_rad_s = 0.0;
  double bound = 1.0;               ///< weight of the gyro's lower bounds; 1: full weight
  double force_bound_weight = 1.0;  ///< weight of the accelerometer's lower bounds; 1: full weight
  double accel_m_s2 = 0.0;          ///< standard deviation of one accelerometer reading
  double force_noise_ratio = 0.0;   ///< additional noise / (magnitude of the specific force - gravity)
  double stationary_rate_sigma_rad_s = 0.0;
  double stationary_velocity_sigma_m_s = 0.0;
  double stationary_acceleration_sigma_m_s2 = 0.0;
};

/// Adds the gyro readings of one node. Row i of `rows` is the sensing direction of gyro element i. A clipped reading is
/// a one-sided bound on the component of (rate + bias) along row i.
double add_gyro(const NodeReadings& readings, const Eigen::Matrix3d& rows, const ReadingNoise& noise, const Node& node,
                const Constants& constants, System::StateBlock& block, System::BorderBlock& corner);

/// Adds the specific force of one node: gravity, acceleration of the held point, and centripetal and tangential force
/// at the lever arm.
double add_force(const NodeReadings& readings, const Eigen::Vector3d& g_W_m_s2, const ReadingNoise& noise,
                 const Node& node, const Constants& constants, System::StateBlock& block, System::BorderBlock& corner);

double add_rest(const ReadingNoise& noise, const Node& node, System::StateBlock& block);

/// Motion model between two nodes that are `step_s` apart. The angular jerk is white noise. Acceleration, velocity and
/// position of the held point return to zero, with separate time constants.
class Motion {
 public:
  struct Params {
    double step_s = 0.01;
    double jerk_rad_s3_sqrts = 0.0;  ///< square root of the power spectral density of the angular jerk
    double rotation_error_sqrts =
        0.0;  ///< random walk of the attitude per rad/s of rate, for scale and misalignment errors
    double hand_sigma_m_s2 = 0.0, hand_tau_s = 0.0;
    double velocity_m_s = 0.0, velocity_tau_s = 0.0;
    double position_m = 0.0, position_tau_s = 0.0, position_leak_s = 10.0;
  };
  explicit Motion(const Params& params);

  /// `hand` is a factor on the power spectral density of the held point's acceleration. `jerk` is a factor on the
  /// square root of the power spectral density of the angular jerk.
  double add_motion_model(const Node& from, const Node& to, double hand, System::StateBlock& block,
                          System::StateBlock& next, double jerk = 1.0) const;
  double add_bounds(const Node& node, System::StateBlock& block) const;
  /// Adds the prior of the first node. The heading is fixed; every other unknown has the stationary variance of its
  /// stochastic process.
  double add_initial_prior(const Node& node, System::StateBlock& block) const;

 private:
  double add_attitude(const Node& from, const Node& to, double jerk, System::StateBlock& block,
                      System::StateBlock& next) const;

  Params params_;
  Eigen::Matrix4d jerk_;  // information matrix of (rate, angular acceleration) of both nodes, one axis
  Eigen::Matrix<double, 6, 6> hand_information_,
      kinematics_;  // information matrix of (acceleration, velocity, position), one axis
  double attitude_error_variance_;
};

/// Returns the rotation vector between two nodes, for a rate that is a cubic polynomial of time.
Eigen::Vector3d rotation_between_nodes(const Node& from, const Node& to, double step_s);

}  // namespace hand_held

extern template struct BlockArrowSystem<hand_held::kBlockSize, hand_held::kBorderSize>;  // hand_held_problem.cpp
}  // namespace tumble
