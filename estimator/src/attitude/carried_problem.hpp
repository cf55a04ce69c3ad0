// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tumble/attitude/carried_smoother.hpp"

namespace tumble::carried {

/// Least determinant of the elements' rows: below, they do not span the axes.
inline constexpr double kRowsMin = 0.1;
/// Deviation of the time at which a reading was taken that the log says again, anywhere within the sample before:
/// 1/sqrt(12).
inline constexpr double kTaken_samples = 0.29;

/// Where windows lie on the line of the nodes, which begins at the centre of the first sample's window.
struct Windows {
  double period_s = 0.0;             ///< median
  std::vector<double> centre_s;      ///< of each window
  std::vector<double> end_s;         ///< of each window: its time stamp
  std::vector<std::size_t> node_of;  ///< the nearest to each centre
};

/// The readings of one triad, each once and at its own time: one that is slower than the log repeats itself.
struct OwnReadings {
  std::vector<ImuSample> samples;  ///< stamped at the end of their windows
  std::vector<ClipSigns> signs;    ///< one per sample
  Windows windows;
  std::vector<std::size_t> of_sample;  ///< of each sample of the IMU, the reading that it says, anew or again
};

/// Those of the gyro, and what a window lost that met the rail in a part of its length.
struct GyroReadings : OwnReadings {
  /// Deviation of what a window lost of each element's reading, which stands in the readings; 0: the reading is whole.
  std::vector<Eigen::Vector3d> open_rad_s;
};

/// What the readings about each node say, and where the samples lie among the nodes.
struct Collected {
  Windows samples;
  GyroReadings rates;
  std::vector<NodeReadings> nodes;  ///< at equal times from the first sample's centre
  /// Root density of the angular jerk that the readings about each node show [rad/s^3 sqrt(s)]; 0: none is there.
  std::vector<double> jerk;
};

/// Sums the readings by node. O(N).
Collected collect(const CarriedSmoother::Params& params, std::span<const ImuSample> samples,
                  const ClippedElements& clipped);

inline constexpr double kLongest = 1.5;  ///< periods: the longest window

/// The root density of the angular jerk about each of `nodes` nodes as readings show it [rad/s^3 sqrt(s)]: where they
/// are free by how they bend, across what an element hides by how its slope has changed meanwhile; 0 where none tells.
/// carried.md (C37), (C39). O(N).
std::vector<double> seen_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s, double node_s,
                              std::size_t nodes);

/// Rates with the clipped segments of each element replaced by cubics: value and slope continued from both sides, held
/// beyond the rail and within kFillMost of it.
std::vector<Eigen::Vector3d> filled_rates(std::span<const ImuSample> samples, const ClippedElements& clipped);

inline constexpr double kFillMost = 2.5;  ///< rails: the fill is a start, no more

/// While nothing in the window of CarriedStream clips, one step for so many nodes.
inline constexpr int kFreeNodes = 5;

/// Whether an element of the gyro is not read, in a part of the node's time or in all of it.
bool clips(const NodeReadings& readings);

/// Of the period of an accelerometer that may filter for all of it or read at once: deviation of a centre that lies
/// evenly between the window's end and its middle, 1/(4 sqrt(3)).
inline constexpr double kOpenShare = 0.144;

/// Adds one triad's reading, `t` seconds from the node; `open_rad_s`: more deviation of each element's.
void add_rate(const ImuSample& sample, const Eigen::Matrix3d& rows, const ClipSigns& signs, double t,
              const Eigen::Vector3d& open_rad_s, NodeReadings& node);
void add_force(const ImuSample& sample, const ClipSigns& signs, double t, NodeReadings& node);

/// What the factors of the motion and of the readings are weighed with; `jerk`: its root density counts so many times.
Motion::Params motion_params(const CarriedSmoother::Params& params, double jerk = 1.0);
ReadingNoise reading_noise(const CarriedSmoother::Params& params, double period_s);
/// Gyro, force, bounds and rest of one node.
double add_node(const NodeReadings& readings, const Eigen::Matrix3d& rows, const ReadingNoise& noise,
                const Eigen::Vector3d& g_W_m_s2, const Motion& motion, const Node& node, const Constants& constants,
                System::Block& block, System::Corner& corner);
/// Priors of the constants about zero.
double add_constants_prior(const CarriedSmoother::Params& params, const Constants& constants, System::Corner& corner);
/// The way from one node to another, as Node::move takes it.
System::StateVector moved(const Node& from, const Node& to);

/// Attitude and rates of the nodes by a filter (VQF) on the filled rates; the hand's acceleration is what is left.
Status start_nodes(const CarriedSmoother::Params& params, const Eigen::Matrix3d& rows, const Collected& collected,
                   std::vector<Node>& nodes);

/// What all that lies on one side of a node says of it: a quadratic about the node as it stood.
struct Message {
  Node about;
  System::StateMatrix information = System::StateMatrix::Zero();
  System::StateVector gradient = System::StateVector::Zero();
  double add(const Node& node, System::Block& block) const;
};

/// Nodes [first, last] of a problem, and what is said of its ends by all that lies beyond them, the constants given.
struct Part {
  std::size_t first = 0, last = 0;
  Message before = {}, after = {};
};

/// The normal equations of one recording and their solution.
class Problem {
 public:
  Problem(const CarriedSmoother::Params& params, const Eigen::Matrix3d& rows, const Collected& collected,
          std::vector<Node> nodes);
  /// A part of another one alone, `part.before` and `after` filled by tell(). The constants and how lively the hand is
  /// stay as they are there.
  Problem(const Problem& whole, const Part& part);

  /// Gauss-Newton; `diverged` when the equations lose their definiteness.
  Status solve(CarriedSmoother::Report& report);
  /// Covariances of all nodes at the solution.
  Status covariances(CarriedSmoother::Report& report);
  /// The solution as it stands, with its covariances, to come back to.
  struct Answer {
    std::vector<Node> nodes;
    Constants constants;
    System::BorderMatrix constants_covariance = System::BorderMatrix::Zero();
    std::vector<double> hand;
    std::vector<Eigen::Matrix<double, 9, 9>> covariances;
  };
  Answer answer() const { return {nodes_, constants_, constants_covariance_, hand_, covariances_}; }
  void restore(Answer answer);
  /// Fills what the rest says of each part's ends: one sweep from either side. False where it loses its definiteness.
  bool tell(std::span<Part> parts) const;
  /// Gauss-Newton of a part. The cost at the solution, infinite where it did not converge.
  double converge();

  const Eigen::Matrix3d& rows() const { return rows_; }
  /// Rate and bias of a node: what the gyro would read.
  Eigen::Vector3d gyro_rad_s(std::size_t node) const { return nodes_[node].w_WI_I_rad_s + constants_.gyro_bias_rad_s; }
  double rail_sigma_rad_s() const { return noise_.rail_rad_s; }
  double jerk_rad_s3_sqrts() const { return params_.jerk_rad_s3_sqrts; }
  double node_s() const { return params_.expert.node_s; }
  const Eigen::Vector3d& gravity_W_m_s2() const { return g_W_m_s2_; }
  const NodeReadings& readings(std::size_t node) const { return readings_[node]; }
  std::span<const Node> nodes() const { return nodes_; }
  /// Other nodes from `first` on: another start.
  void place(std::size_t first, std::span<const Node> nodes);
  /// Adds to a node's covariance.
  void widen(std::size_t node, const Eigen::Matrix<double, 9, 9>& by) { covariances_[node] += by; }
  /// Of attitude (error in sensor axes), rate, angular acceleration.
  const Eigen::Matrix<double, 9, 9>& covariance(std::size_t node) const { return covariances_[node]; }

 private:
  double linearise();
  double add_node(std::size_t i, System::Block& block, System::Corner& corner) const;
  bool eliminate(System::BorderVector& step);
  bool step(double& largest);
  /// Where a step of the descent began.
  struct Iterate {
    std::vector<Node> nodes;
    Constants constants;
    double cost = 0.0;
  };
  void go(double share);
  bool descend_from(const Iterate& before, double& cost);
  void follow_hand();
  double hand_mahalanobis() const;

  CarriedSmoother::Params params_;
  Eigen::Matrix3d rows_;
  std::span<const NodeReadings> readings_;
  std::span<const double> jerk_seen_;  // of Collected
  Motion motion_;
  double period_s_ = 0.0;  // of the gyro's own readings
  ReadingNoise noise_;
  Eigen::Vector3d g_W_m_s2_;
  std::optional<Part> part_;  // of another problem; the constants stay then
  std::vector<Node> nodes_;
  Constants constants_;
  std::vector<double> jerk_;        // what the root density of the jerk is multiplied with, per node
  std::vector<double> hand_;        // what the density of the hand's acceleration is multiplied with, per step
  std::vector<double> hand_power_;  // running sum of its square
  std::vector<System::Block> blocks_;
  std::vector<System::StateVector> steps_;  // the last step
  System::BorderVector border_step_ = System::BorderVector::Zero();
  System::Corner corner_;
  System::BorderMatrix constants_covariance_;
  std::vector<Eigen::Matrix<double, 9, 9>> covariances_;
};

}  // namespace tumble::carried
