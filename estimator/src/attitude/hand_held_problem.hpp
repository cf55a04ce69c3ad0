// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hand_held_readings.hpp"
#include "tumble/attitude/hand_held_smoother.hpp"

namespace tumble::hand_held {

/// Returns the weights of motion factors; `jerk` multiplies the root density of the jerk.
Motion::Params motion_params(const HandHeldSmoother::Params& params, double jerk = 1.0);
ReadingNoise reading_noise(const HandHeldSmoother::Params& params, double period_s);
/// Adds the factors of one node: gyro, force, limits of velocity and position, and rest.
double add_node(const NodeReadings& readings, const Eigen::Matrix3d& rows, const ReadingNoise& noise,
                const Eigen::Vector3d& g_W_m_s2, const Motion& motion, const Node& node, const Constants& constants,
                System::Block& block, System::Corner& corner);
/// Adds the zero-mean priors of the constants.
double add_constants_prior(const HandHeldSmoother::Params& params, const Constants& constants, System::Corner& corner);
/// Returns the difference of two nodes, in the form that Node::move takes.
System::StateVector moved(const Node& from, const Node& to);

/// Message contains the information from all nodes on one side of a node, as a quadratic about the node's current
/// value.
struct Message {
  Node about;
  System::StateMatrix information = System::StateMatrix::Zero();
  System::StateVector gradient = System::StateVector::Zero();
  double add(const Node& node, System::Block& block) const;
};

/// Part consists of the nodes [first, last] of a problem. A Part includes the information from all other nodes about
/// the ends of the part, for fixed constants.
struct Part {
  std::size_t first = 0, last = 0;
  Message before = {}, after = {};
};

class Problem {
 public:
  Problem(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows, const NodeData& collected,
          std::vector<Node> nodes);
  /// Constructs a part of another problem; condense_rest() must have set `part.before` and `part.after`. The constants
  /// and the density of the held point's acceleration are copied and fixed.
  Problem(const Problem& whole, const Part& part);

  /// Solves the problem by Gauss-Newton. Returns `diverged` if the normal equations are not positive definite.
  Status solve(HandHeldSmoother::Report& report);
  /// Computes the covariances of all nodes at the solution.
  Status covariances(HandHeldSmoother::Report& report);
  /// Answer is a copy of the solution and its covariances, which restore() restores.
  struct Answer {
    std::vector<Node> nodes;
    Constants constants;
    System::BorderMatrix constants_covariance = System::BorderMatrix::Zero();
    std::vector<double> hand;
    std::vector<Eigen::Matrix<double, 9, 9>> covariances;
  };
  Answer answer() const { return {nodes_, constants_, constants_covariance_, hand_, covariances_}; }
  void restore(Answer answer);
  /// Computes the information about the ends of each part, with one elimination from either end of the chain. Returns
  /// false if the normal equations are not positive definite.
  bool condense_rest(std::span<Part> parts) const;
  /// Solves a part by Gauss-Newton. Returns the cost at the solution, or infinity without convergence.
  double converge();

  const Eigen::Matrix3d& rows() const { return rows_; }
  /// Returns rate plus bias of a node, which is the expected gyro reading.
  Eigen::Vector3d gyro_rad_s(std::size_t node) const { return nodes_[node].w_WI_I_rad_s + constants_.gyro_bias_rad_s; }
  double rail_sigma_rad_s() const { return noise_.rail_rad_s; }
  double jerk_rad_s3_sqrts() const { return params_.jerk_rad_s3_sqrts; }
  double node_s() const { return params_.expert.node_s; }
  const Eigen::Vector3d& gravity_W_m_s2() const { return g_W_m_s2_; }
  const NodeReadings& readings(std::size_t node) const { return readings_[node]; }
  std::span<const Node> nodes() const { return nodes_; }
  /// Replaces the nodes from index `first` on, to start from other initial values.
  void place(std::size_t first, std::span<const Node> nodes);
  void widen(std::size_t node, const Eigen::Matrix<double, 9, 9>& by) { covariances_[node] += by; }
  /// Returns the covariance of attitude error (sensor axes), rate and angular acceleration.
  const Eigen::Matrix<double, 9, 9>& covariance(std::size_t node) const { return covariances_[node]; }

 private:
  double linearise();
  double add_node(std::size_t i, System::Block& block, System::Corner& corner) const;
  bool eliminate(System::BorderVector& step);
  bool step(double& largest);
  /// Iterate is the state of the problem before a Gauss-Newton step.
  struct Iterate {
    std::vector<Node> nodes;
    Constants constants;
    double cost = 0.0;
  };
  void go(double share);
  bool halve_step_until_decrease(const Iterate& before, double& cost);
  void adapt_process_noise();
  double hand_acceleration_ratio() const;

  HandHeldSmoother::Params params_;
  Eigen::Matrix3d rows_;
  std::span<const NodeReadings> readings_;
  std::span<const double> measured_jerk_;  // jerk density of each node, from NodeData
  Motion motion_;
  double period_s_ = 0.0;  // period of the gyro's distinct readings
  ReadingNoise noise_;
  Eigen::Vector3d g_W_m_s2_;
  std::optional<Part> part_;  // if set, a part of another problem with fixed constants
  std::vector<Node> nodes_;
  Constants constants_;
  std::vector<double> jerk_;        // multiplier of the jerk's root density, per node
  std::vector<double> hand_;        // multiplier of the density of the held point's acceleration, per step
  std::vector<double> hand_power_;  // cumulative sum of the squared multipliers
  std::vector<System::Block> blocks_;
  std::vector<System::StateVector> steps_;
  System::BorderVector border_step_ = System::BorderVector::Zero();
  System::Corner corner_;
  System::BorderMatrix constants_covariance_;
  std::vector<Eigen::Matrix<double, 9, 9>> covariances_;
};

}  // namespace tumble::hand_held
