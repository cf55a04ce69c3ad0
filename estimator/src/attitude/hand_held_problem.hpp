// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hand_held_readings.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"

namespace tumble::hand_held {

/// `jerk` is a factor on the root spectral density of the angular jerk that `params` contains.
Motion::Params motion_params(const HandHeldSmoother::Params& params, double jerk = 1.0);
ReadingNoise reading_noise(const HandHeldSmoother::Params& params, double period_s);
double add_node(const NodeReadings& readings, const Eigen::Matrix3d& rows, const ReadingNoise& noise,
                const Eigen::Vector3d& g_W_m_s2, const Motion& motion, const Node& node, const Constants& constants,
                System::StateBlock& block, System::BorderBlock& corner);
double add_constants_prior(const HandHeldSmoother::Params& params, const Constants& constants,
                           System::BorderBlock& corner);
/// Returns the difference between the states of two time steps (nodes), as an argument of Node::move.
System::StateVector node_difference(const Node& from, const Node& to);

/// NodeMessage is a prior on the state of one time step (node) that summarises all earlier or all later time steps. The
/// prior is linearised at the state `linearisation_node`.
struct NodeMessage {
  Node linearisation_node;
  System::StateMatrix information = System::StateMatrix::Zero();
  System::StateVector gradient = System::StateVector::Zero();
  double add(const Node& node, System::StateBlock& block) const;
};

/// ProblemSegment is the range [first, last] of a problem's time steps (nodes). A prior on the first time step replaces
/// all earlier time steps, and a prior on the last time step replaces all later time steps.
struct ProblemSegment {
  std::size_t first = 0, last = 0;
  NodeMessage message_from_before = {}, message_from_after = {};
};

class HandHeldProblem {
 public:
  HandHeldProblem(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows, const NodeData& collected,
                  std::vector<Node> nodes);
  /// The caller must set `part.message_from_before` and `part.message_from_after` with condense_other_nodes().
  HandHeldProblem(const HandHeldProblem& whole, const ProblemSegment& part);

  /// Returns `diverged` if the normal equations are not positive definite.
  Status solve(HandHeldSmoother::Report& report);
  Status covariances(HandHeldSmoother::Report& report);
  struct Solution {
    std::vector<Node> nodes;
    Constants constants;
    System::BorderMatrix constants_covariance = System::BorderMatrix::Zero();
    std::vector<double> hand_acceleration_factors;
    std::vector<Eigen::Matrix<double, 9, 9>> covariances;
  };
  Solution solution() const {
    return {nodes_, constants_, constants_covariance_, hand_acceleration_factors_, covariances_};
  }
  void restore(Solution answer);
  /// Returns false if the normal equations are not positive definite.
  bool condense_other_nodes(std::span<ProblemSegment> parts) const;
  /// Returns the cost of the solution, or infinity if the optimisation has not converged.
  double iterate_to_convergence();

  const Eigen::Matrix3d& sensing_directions() const { return sensing_directions_; }
  Eigen::Vector3d gyro_rad_s(std::size_t node) const { return nodes_[node].w_WI_I_rad_s + constants_.gyro_bias_rad_s; }
  double saturation_limit_sigma_rad_s() const { return noise_.saturation_limit_sigma_rad_s; }
  double jerk_rad_s3_sqrts() const { return params_.jerk_rad_s3_sqrts; }
  double node_interval_s() const { return params_.expert.node_s; }
  const Eigen::Vector3d& gravity_W_m_s2() const { return g_W_m_s2_; }
  const NodeReadings& readings(std::size_t node) const { return readings_[node]; }
  std::span<const Node> nodes() const { return nodes_; }
  void set_nodes(std::size_t first, std::span<const Node> nodes);
  void add_covariance(std::size_t node, const Eigen::Matrix<double, 9, 9>& by) { covariances_[node] += by; }
  /// joint covariance of attitude error (sensor axes), rate and angular acceleration
  const Eigen::Matrix<double, 9, 9>& covariance(std::size_t node) const { return covariances_[node]; }

 private:
  double linearise();
  double add_node(std::size_t i, System::StateBlock& block, System::BorderBlock& corner) const;
  bool eliminate(System::BorderVector& step);
  bool step(double& largest);
  struct Iterate {
    std::vector<Node> nodes;
    Constants constants;
    double cost = 0.0;
  };
  void apply_state_step(double share);
  bool halve_step_until_decrease(const Iterate& before, double& cost);
  void adapt_process_noise();

  HandHeldSmoother::Params params_;
  Eigen::Matrix3d sensing_directions_;
  std::span<const NodeReadings> readings_;
  std::span<const double> measured_jerk_;
  Motion motion_;
  double period_s_ = 0.0;  // sample period of the gyro, without repeated readings
  ReadingNoise noise_;
  Eigen::Vector3d g_W_m_s2_;
  std::optional<ProblemSegment>
      problem_segment_;  // range of nodes if the problem is a part of another problem with fixed constants
  std::vector<Node> nodes_;
  Constants constants_;
  std::vector<double> jerk_;  // factor on the root spectral density of the angular jerk, per node
  std::vector<double>
      hand_acceleration_factors_;  // factor on the spectral density of the hand's acceleration, per step between nodes
  // cumulative sum of squared hand accelerations, each divided by the assumed mean square
  std::vector<double> hand_power_cumulative_;
  std::vector<System::StateBlock> state_blocks_;
  std::vector<System::StateVector> state_steps_;
  System::BorderVector border_unknowns_step_ = System::BorderVector::Zero();
  System::BorderBlock border_block_;
  System::BorderMatrix constants_covariance_;
  std::vector<Eigen::Matrix<double, 9, 9>> covariances_;
};

}  // namespace tumble::hand_held
