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

/// RollingFilter with what came after taken into account: with a fixed lag, or over the whole run.
///
/// The modes are those of the live filter's best hypothesis at the time of smoothing; with them frozen, one Kalman
/// filter runs over the stored samples again, and the modified Bryson-Fraser smoother (Bierman 1977) back: it needs no
/// inverse and no more than the filter's own gains. A sample between two nodes takes the errors of both, in
/// proportion to time.
///
/// With a fixed lag the position stands still while the sphere does: what rest teaches of the way before is taken up
/// when the motion goes on, since the estimates of that way are out. Over the whole run the way itself is mended.
///
/// Source: the reference study of this project on slip; the smoother as G. J. Bierman, Factorization Methods for
/// Discrete Sequential Estimation, 1977. Not modelled: doubt about the modes, other than the spread of positions that
/// the live filter gives up at rest.
class RollingSmoother {
 public:
  static constexpr double kWholeRun = 1e9;

  struct Params {
    RollingParams filter = {};
    /// Noise of the last pass, as a share of the filter's; the covariance that it states is of the filter's.
    double path_noise = 0.65;
    double lag_s = kWholeRun;    ///< how long an estimate may wait for what follows
    double block_s = 0.2;        ///< estimates are given out in blocks of this length
    double rate_max_hz = 500.0;  ///< of the samples: storage set aside for the lag
    /// Above zero: horizontal distance of the centre from the start to the end of the run, known from elsewhere, and
    /// its sigma. With a prior on the radius it tells the radius.
    double known_distance_m = 0.0, known_distance_sigma_m = 5e-3;

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.filter);
      visit(p.path_noise, {"path_noise", "1", 1e-6, 1.0, "process noise of the last pass, as a share of the filter's"});
      visit(p.lag_s, {"lag_s", "s", 1e-3, 1e9,
                      "longest time that a pose waits for later data; 1e9: until the end of the run", Rank::first});
      visit(p.block_s, {"block_s", "s", 1e-3, 1e3, "length of the blocks in which estimates are reported"});
      visit(p.rate_max_hz, {"rate_max_hz", "Hz", 1e-3, 1e5, "largest sample rate, which sets the storage for the lag"});
      visit(p.known_distance_m,
            {"known_distance_m", "m", 0.0, 1e6,
             "known horizontal distance from start to end, which determines the radius; 0: not known", Rank::first});
      visit(p.known_distance_sigma_m,
            {"known_distance_sigma_m", "m", 1e-12, 1e3, "standard deviation of the known distance", Rank::first});
    }
  };

  /// The modes of all hypotheses at a node, and which of the node before each came from.
  struct Step {
    std::array<std::uint8_t, RollingFilter::kHypotheses> parent{};
    std::array<RollingMode, RollingFilter::kHypotheses> mode{};
    Eigen::Matrix3d spread_m2 = Eigen::Matrix3d::Zero();
    double rest_s = 0.0;  ///< quiet for so long
    bool at_rest = false;
    bool spins_in_place = false;
    bool operator==(const Step&) const = default;
  };
  /// The last pass at the node up to which estimates are out.
  struct Committed {
    RollingNominal nominal;
    RollingFilter::Covariance P = RollingFilter::Covariance::Zero();
    RollingMode mode = RollingMode::grip;
    double event_variance_m2 = 0.0;                         ///< of the position, when the event began
    Eigen::Vector3d held_p_WG_m = Eigen::Vector3d::Zero();  ///< while `held`
    bool held = false;                                      ///< it stands still, and so does the position given out
    TimeNs last_time_ns = 0;
    Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero();
    // of the gap that the node lies in, if it does
    Eigen::Vector3d gap_rate_rad_s = Eigen::Vector3d::Zero();
    TimeNs gap_start_ns = 0;
    int gap_piece = 0;
    bool started = false;
    bool operator==(const Committed&) const = default;
  };
  struct State {
    RollingFilter::State live;
    Committed committed;
    std::vector<ImuSample> samples;  ///< after the committed node
    std::vector<Step> steps;
    RollingNominal learnt;        ///< constants as known at the newest node that was smoothed
    double radius_sigma_m = 0.0;  ///< of the radius there
    bool operator==(const State& other) const;
  };

  explicit RollingSmoother(const Params& params);

  /// What works on State::live: by itself where live poses are all that is asked for.
  const RollingFilter& filter() const { return filter_; }

  /// Takes a sample; appends estimates that are old enough to `out`, if any. On trouble the state is unchanged. Storage
  /// for the lag is set aside with the first sample; no allocation later but by `out` and the work of a block, and,
  /// beyond rate_max_hz, a million samples or with kWholeRun, as the run grows (64 bytes per sample, 152 per node). The
  /// work of a block is done in the sample that ends it; it holds some 14 KiB for each node of lag and block, or 4 MiB
  /// and 0.3 KiB for each node where they are many.
  Status step(const ImuSample& sample, State& state, std::vector<RollingEstimate>& out) const;

  /// Gives the estimates that are still owed, one after the other in the order of time, all smoothed with what there
  /// is. The run has ended. A whole run of N nodes needs 4 MiB + N * 0.3 KiB beside the state while it lasts.
  using Take = std::function<void(const RollingEstimate&)>;
  void finish(State& state, const Take& take) const;
  void finish(State& state, std::vector<RollingEstimate>& out) const;

  /// The same with modes known from elsewhere, one per sample of a whole run that `state` took with kWholeRun.
  void finish(std::span<const RollingMode> known, State& state, const Take& take) const;

  /// What holds of every state that step() left, for one that comes from elsewhere; the first that does not. A state
  /// with a lag of samples that came more than four times as fast as rate_max_hz is refused.
  Status check_state(const State& state) const;

 private:
  struct Path;

  /// Samples that the lag has storage for.
  std::size_t samples_set_aside() const;
  Path best_path(const State& state) const;
  void run_window(const Path& path, std::size_t emitted, State& state, const Take& take) const;

  Params params_;
  RollingParams path_params_;
  RollingFilter filter_;
  std::size_t lag_nodes_ = 0, block_nodes_ = 0;
};

}  // namespace tumble
