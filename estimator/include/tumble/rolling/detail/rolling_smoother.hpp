// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/rolling/detail/rolling_filter.hpp"

namespace tumble {

namespace rolling {

/// Contact mode of the most probable hypothesis at one time step.
struct ModePathNode;

/// Kalman filter for the most probable sequence of contact modes.
struct ModePathFilter {
  RollingNominalState nominal;
  RollingFilter::Covariance covariance = RollingFilter::Covariance::Zero();
  ContactMode mode = ContactMode::grip;
  bool operator==(const ModePathFilter&) const = default;
};

/// Position in the stored samples.
struct ReadingCursor {
  TimeNs time_ns = 0;
  Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero();
  std::size_t next = 0;
  Eigen::Vector3d rate_before_gap_rad_s = Eigen::Vector3d::Zero();
  TimeNs gap_start_ns = 0;
  int gap_step_index = 0;
  bool operator==(const ReadingCursor&) const = default;
};

struct SmoothingCheckpoint {
  ModePathFilter filter;
  ReadingCursor reading;
  bool operator==(const SmoothingCheckpoint&) const = default;
};

}  // namespace rolling

/// Smooths the poses of RollingFilter with later data, with a fixed lag or over the whole run. The contact modes are
/// those of RollingFilter's most probable hypothesis at the time of smoothing, and are treated as certain. Source:
/// modified Bryson-Fraser smoother (Bierman, Factorization Methods for Discrete Sequential Estimation, 1977).
///
/// With a fixed lag, the reported position is constant while the sphere is at rest. When motion resumes, the position
/// is corrected for errors of the path before the rest.
class RollingSmoother {
 public:
  static constexpr double kWholeRecordingLag = 1e9;

  struct Params {
    RollingParams filter = {};
    /// process noise of the smoother, relative to the process noise of RollingFilter; does not affect the reported
    /// covariance
    static constexpr double kFinalPassNoiseRatio = 0.65;
    double lag_s = kWholeRecordingLag;       ///< delay of an estimate behind the newest sample
    static constexpr double kBlock_s = 0.2;  ///< RollingSmoother reports estimates in blocks of this duration
    double rate_max_hz = 500.0;              ///< sample rate for which memory is allocated in advance

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.filter);
      visit(p.lag_s,
            {"lag_s", "s", 1e-3, 1e9,
             "maximum delay of a pose; a longer delay makes poses more accurate; 1e9: until the end of the run",
             ParameterAudience::common_use});
      visit(p.rate_max_hz,
            {"rate_max_hz", "Hz", 1e-3, 1e5, "sample rate for which the memory of the delay is allocated in advance"});
    }
  };

  /// Contact modes of all hypotheses at a time step, and for each the preceding hypothesis at the previous time step.
  struct NodeModes {
    std::array<std::uint8_t, RollingFilter::kHypotheses> parent{};
    std::array<ContactMode, RollingFilter::kHypotheses> mode{};
    Eigen::Matrix3d position_spread_m2 = Eigen::Matrix3d::Zero();
    double rest_s = 0.0;
    bool at_rest = false;
    bool spins_in_place = false;
    bool operator==(const NodeModes&) const = default;
  };
  /// State of the smoother at the last time step with reported estimates.
  struct FinalSmoothingState {
    rolling::SmoothingCheckpoint checkpoint;
    double slip_start_variance_m2 = 0.0;  ///< position variance at the start of the slip or bump
    Eigen::Vector3d constrained_sphere_centre_W_m = Eigen::Vector3d::Zero();
    bool reported_position_constant = false;
    bool started = false;
    bool operator==(const FinalSmoothingState&) const = default;
  };
  struct State {
    RollingFilter::State live_filter;
    FinalSmoothingState committed_state;
    std::vector<ImuSample> samples;  ///< samples after the last time step with reported estimates
    std::vector<NodeModes> node_modes;
    RollingNominalState constants;  ///< estimated constants at the newest smoothed time step
    double radius_sigma_m = 0.0;    ///< standard deviation of the radius at the newest smoothed time step
    bool operator==(const State&) const = default;
  };

  explicit RollingSmoother(const Params& params);

  /// Returns the filter that updates State::live.
  const RollingFilter& filter() const { return filter_; }

  /// Processes one sample, and appends the smoothed estimates that are older than `lag_s` to `out`. On error, the state
  /// is unchanged.
  ///
  /// The first call allocates the memory for the samples of the last `lag_s`. Later calls allocate memory only for
  /// `out` and for smoothing, at the last sample of a block of `kBlock_s`. Smoothing temporarily needs 14 KiB per time
  /// step of lag and block, or 4 MiB plus 0.3 KiB per time step for long lags. With kWholeRecordingLag, above
  /// rate_max_hz, or with more than a million samples in `lag_s`, the state grows by 64 bytes per sample and 152 bytes
  /// per time step.
  Status step(const ImuSample& sample, State& state, std::vector<RollingEstimate>& out) const;

  /// Smooths the remaining estimates with all data, and passes the estimates to `take` in time order. For a whole run
  /// of N time steps, finish() temporarily needs 4 MiB + N * 0.3 KiB of memory.
  using EstimateCallback = std::function<void(const RollingEstimate&)>;
  void finish(State& state, const EstimateCallback& take) const;
  void finish(State& state, std::vector<RollingEstimate>& out) const;

 private:
  using ModePath = std::vector<rolling::ModePathNode>;

  std::size_t preallocated_samples() const;
  ModePath most_probable_path(const State& state) const;
  void smooth_window(const ModePath& path, std::size_t emitted, State& state, const EstimateCallback& take) const;

  Params params_;
  RollingFilter filter_;
  std::size_t lag_nodes_ = 0, nodes_per_block_ = 0;
};

}  // namespace tumble
