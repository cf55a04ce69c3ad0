// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/rolling/rolling_filter.hpp"

namespace tumble {

/// Smooths the poses of RollingFilter with later data, with a fixed lag or over the whole run.
///
/// RollingSmoother uses the contact modes of the most probable hypothesis of RollingFilter at the time of smoothing.
/// With the contact modes fixed, one Kalman filter runs forward over the stored samples. The modified Bryson-Fraser
/// smoother then runs backward (Bierman, Factorization Methods for Discrete Sequential Estimation, 1977). The
/// Bryson-Fraser smoother needs no matrix inverse, only the gains of the Kalman filter. RollingSmoother interpolates
/// the errors of a sample from the errors of its two neighbouring nodes.
///
/// With a fixed lag, the reported position is constant while the sphere is at rest. When motion resumes,
/// RollingSmoother corrects the position for errors of the path before the rest. If the whole run is smoothed,
/// RollingSmoother corrects the path before a rest directly.
///
/// RollingSmoother treats the contact modes as certain, except for the spread of positions that RollingFilter prunes at
/// rest.
class RollingSmoother {
 public:
  static constexpr double kWholeRun = 1e9;

  struct Params {
    RollingParams filter = {};
    /// Ratio of the process noise of the smoother to the process noise of RollingFilter. The reported covariance uses
    /// the full process noise of RollingFilter.
    double final_pass_noise_ratio = 0.65;
    double lag_s = kWholeRun;    ///< delay of an estimate behind the newest sample
    double block_s = 0.2;        ///< RollingSmoother reports estimates in blocks of this duration
    double rate_max_hz = 500.0;  ///< sample rate for which memory is allocated in advance
    /// Measured horizontal distance of the centre between the start and the end of the run, and its standard deviation.
    /// The measured distance and the prior on the radius determine the radius. A distance of 0 means that no distance
    /// was measured.
    double known_distance_m = 0.0, known_distance_sigma_m = 5e-3;

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.filter);
      visit(p.final_pass_noise_ratio, {"final_pass_noise_ratio", "1", 1e-6, 1.0,
                                       "process noise of the last pass, as a share of the filter's process noise"});
      visit(p.lag_s,
            {"lag_s", "s", 1e-3, 1e9,
             "maximum delay of a pose; a longer delay makes poses more accurate; 1e9: until the end of the run",
             FieldRank::basic});
      visit(p.block_s, {"block_s", "s", 1e-3, 1e3, "length of the blocks in which estimates are reported"});
      visit(p.rate_max_hz,
            {"rate_max_hz", "Hz", 1e-3, 1e5, "maximum sample rate; determines the memory for the delay"});
      visit(p.known_distance_m,
            {"known_distance_m", "m", 0.0, 1e6,
             "known horizontal distance from start to end, from which the radius is estimated; 0: not known",
             FieldRank::basic});
      visit(p.known_distance_sigma_m,
            {"known_distance_sigma_m", "m", 1e-12, 1e3, "standard deviation of the known distance", FieldRank::basic});
    }
  };

  /// NodeModes contains the contact modes of all hypotheses at a node, and the parent of each hypothesis at the
  /// previous node.
  struct NodeModes {
    std::array<std::uint8_t, RollingFilter::kHypotheses> parent{};
    std::array<RollingMode, RollingFilter::kHypotheses> mode{};
    Eigen::Matrix3d position_spread_m2 = Eigen::Matrix3d::Zero();
    double rest_s = 0.0;  ///< duration of the rest so far
    bool at_rest = false;
    bool spins_in_place = false;
    bool operator==(const NodeModes&) const = default;
  };
  /// FinalPassState is the state of the smoother at the committed node, up to which estimates are reported.
  struct FinalPassState {
    RollingNominal nominal;
    RollingFilter::Covariance P = RollingFilter::Covariance::Zero();
    RollingMode mode = RollingMode::grip;
    double event_start_variance_m2 = 0.0;                          ///< position variance at the start of the event
    Eigen::Vector3d constrained_p_WG_m = Eigen::Vector3d::Zero();  ///< reported position while `position_constrained`
    bool position_constrained = false;  ///< the sphere is at rest and the reported position is constant
    TimeNs last_time_ns = 0;
    Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero();
    // Rate during a gap between samples, if the node is within a gap.
    Eigen::Vector3d gap_rate_rad_s = Eigen::Vector3d::Zero();
    TimeNs gap_start_ns = 0;
    int gap_step = 0;
    bool started = false;
    bool operator==(const FinalPassState&) const = default;
  };
  struct State {
    RollingFilter::State live;
    FinalPassState committed;
    std::vector<ImuSample> samples;  ///< samples after the committed node
    std::vector<NodeModes> steps;
    RollingNominal constants;     ///< constants at the newest smoothed node
    double radius_sigma_m = 0.0;  ///< standard deviation of the radius at the newest smoothed node
    bool operator==(const State& other) const;
  };

  explicit RollingSmoother(const Params& params);

  /// Returns the RollingFilter that updates State::live. A program that needs only live poses can use RollingFilter
  /// alone.
  const RollingFilter& filter() const { return filter_; }

  /// Processes a sample, and appends the estimates that are older than the lag to `out`. On error, the state is
  /// unchanged. The first call of step() allocates the memory for samples within the lag. Later calls of step()
  /// allocate memory only for `out` and for the processing of a block. The memory grows with the duration (64 bytes per
  /// sample, 152 per node) if the sample rate exceeds rate_max_hz, if the lag contains over a million samples, or with
  /// kWholeRun. The call of step() for the last sample of a block smooths the block. Smoothing temporarily needs 14 KiB
  /// of memory per node of lag and block, or 4 MiB plus 0.3 KiB per node if there are many nodes.
  Status step(const ImuSample& sample, State& state, std::vector<RollingEstimate>& out) const;

  /// Ends the run. The function smooths the remaining estimates with all data, and passes them to `take` in time order.
  /// For a whole run of N nodes, finish() temporarily needs 4 MiB + N * 0.3 KiB of memory, in addition to the state.
  using EstimateCallback = std::function<void(const RollingEstimate&)>;
  void finish(State& state, const EstimateCallback& take) const;
  void finish(State& state, std::vector<RollingEstimate>& out) const;

  /// Ends the run with externally known contact modes. The argument `known` contains one contact mode per sample of a
  /// whole run that was processed with kWholeRun.
  void finish(std::span<const RollingMode> known, State& state, const EstimateCallback& take) const;

 private:
  struct Path;

  /// Returns the number of samples for which the memory of the lag is allocated in advance.
  std::size_t preallocated_samples() const;
  Path most_probable_path(const State& state) const;
  void smooth_window(const Path& path, std::size_t emitted, State& state, const EstimateCallback& take) const;

  Params params_;
  RollingParams final_pass_params_;
  RollingFilter filter_;
  std::size_t lag_nodes_ = 0, block_nodes_ = 0;
};

}  // namespace tumble
