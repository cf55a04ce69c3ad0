// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tumble/attitude/detail/hand_held_smoother.hpp"

namespace tumble::hand_held {

/// If the determinant of the three sensing directions is below kRowsMin, the directions are assumed linearly dependent.
inline constexpr double kRowsMin = 0.1;
/// standard deviation of a repeated reading's time, in sample periods: 1/sqrt(12) for a uniform distribution
inline constexpr double kAge_samples = 0.29;

/// All times are relative to the centre of the first averaging window.
struct AveragingWindows {
  double period_s = 0.0;
  std::vector<double> window_centre_s;
  std::vector<double> end_s;         ///< end of each window, which is its time stamp
  std::vector<std::size_t> node_of;  ///< nearest node to the centre of each window
};

/// TimedReadings contains each reading of a sensor once, even if the recording repeats the reading.
struct TimedReadings {
  std::vector<ImuSample> samples;  ///< with time stamps at the end of the averaging windows
  std::vector<ClipSigns> clip_signs;
  AveragingWindows averaging_windows;
  std::vector<std::size_t> reading_index_of_sample;  ///< index of the reading of each IMU sample
};

struct GyroReadings : TimedReadings {
  /// standard deviation of the correction for partial saturation, per sensing element; 0 without correction
  std::vector<Eigen::Vector3d> partial_saturation_sigma_rad_s;
};

struct NodeData {
  AveragingWindows samples;
  GyroReadings rates;
  std::vector<NodeReadings> nodes;  ///< time steps of equal length from the first sample's centre
  /// root of the spectral density of angular jerk, per element of `nodes` [rad/s^3 sqrt(s)]; 0 without an estimate
  std::vector<double> jerk;
};

NodeData collect_node_data(const HandHeldSmoother::Params& params, std::span<const ImuSample> samples,
                           const SensingAxisClipSigns& clipped);

inline constexpr double kLongest = 1.5;  ///< longest averaging window of a reading, in sample periods

/// Estimates the root of the spectral density of angular jerk [rad/s^3 sqrt(s)] near each time step (node) of the
/// smoother: carried.md (C24), (C25). Cost: O(N). The result for a time step is 0 if the readings near the time step do
/// not determine the jerk.
std::vector<double> estimate_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s,
                                  double node_s, std::size_t nodes);

/// heuristic upper limit of the initial rates, as a multiple of the saturation level
inline constexpr double kFillRatioMax = 2.5;

/// Without saturation, HandHeldRateStream makes one optimisation step per kFreeNodes nodes (time steps).
inline constexpr int kFreeNodes = 5;

bool clips(const NodeReadings& readings);

/// The time of an accelerometer reading is uniformly distributed over the second half of its period, with a standard
/// deviation of 1/(4 sqrt(3)) periods.
inline constexpr double kWindowCentreSigmaRatio = 0.144;

/// Adds a gyro reading that is `t` seconds later than the time step `node`.
void add_rate(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
              const Eigen::Vector3d& subsample_sigma_rad_s, NodeReadings& node);
void add_force(const ImuSample& sample, const ClipSigns& signs, double t, NodeReadings& node);

/// The attitude filter VQF uses the rates of filled_rates(), and initialises attitude and rate of each time step
/// (node).
Status start_nodes(const HandHeldSmoother::Params& params, const Eigen::Matrix3d& rows, const NodeData& collected,
                   std::vector<Node>& nodes);

/// The root spectral density of the angular jerk is `jerk` times the value in `params`.
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
