// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/hold_watch.hpp"
#include "tumble/attitude/carried_smoother.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// The streaming form of CarriedSmoother: the same factors over a window of nodes, one Gauss-Newton step per node.
///
/// The oldest node is marginalised into a Gaussian prior on the next one and on the constants; it keeps the derivatives
/// that it had when it left. Each estimate is given out when its sample is `lag_s` old, from a window that reaches back
/// further (`window_s`), so that what the window still holds of the past is linearised anew with each step. `lag_s` is
/// counted in samples of `period_s`: where they come so sparse that a sample's node leaves the window before, its rate
/// is kept as it was then. Memory is bounded and made by start(); splitting a recording and carrying the State over
/// gives the same bits.
///
/// Differs from the batch: while nothing in the window clips, only each fifth node is a step; the first attitude stands
/// on one force and not on a filter; the hand's liveliness follows the nodes that have left, with the memory
/// `hand_window_s` / 2, and not the time to come; whole turns are not asked for, their deviation is stated and the
/// segments that may hide one are counted (C43, C44 of carried.md); readings that have left were read with
/// the rails known then; the prior of the past keeps the assumed jerk where covariances are those of a larger one.
/// Work: one step per node that begins, O(window).
class CarriedStream {
 public:
  struct Params {
    CarriedSmoother::Params body;  ///< `iterations_max` has no meaning here
    double period_s = 0.01;        ///< nominal time between samples
    double lag_s = 0.2;
    double window_s = 0.6;

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.body);
      visit(p.period_s, {"period_s", "s", 1e-5, 1.0, "nominal time between samples"});
      visit(p.lag_s, {"lag_s", "s", 2e-5, 10.0, "age of a sample when its estimate is reported"});
      visit(p.window_s, {"window_s", "s", 1e-3, 20.0, "length of the sliding window"});
    }
  };

  /// One sample of the window.
  struct Reading {
    ImuSample sample;
    ClipSigns signs;
    double centre_s = 0.0, end_s = 0.0;  ///< of its window, from the first sample's centre
    std::int64_t node = 0;               ///< nearest to the centre
    bool rest = false;
    HeldReading gyro, accel;            ///< of a log that says readings again
    std::optional<RateState> smoothed;  ///< its rate, where its node has left and the rate has not been given out
  };
  struct Knot {
    carried::Node node;
    carried::NodeReadings readings;
  };
  struct State {
    std::vector<Reading> readings;  ///< of the nodes in the window, oldest first
    std::vector<Knot> window;       ///< oldest first
    std::int64_t first_node = 0;    ///< number of the oldest
    Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
    carried::Constants constants;
    carried::System::BorderMatrix constants_covariance = carried::System::BorderMatrix::Zero();
    // what all that left says of the oldest node and of the constants, about a point
    carried::System::Block prior;
    carried::System::Corner prior_corner;
    carried::Node prior_node;
    carried::Constants prior_constants;
    double hand_power = 1.0;  ///< of the nodes that left, over that assumed
    RestDetector::State rests;
    std::int64_t given_node = -1;  ///< node of the last estimate given out, and its covariance
    Eigen::Matrix3d given_covariance_rad2_s2 = Eigen::Matrix3d::Zero();
    std::int64_t start_ns = 0;
    std::size_t samples = 0;
    std::size_t failures = 0;  ///< steps whose system was not positive definite and was skipped
    /// Of the segment in which each element of the gyro is clipped now, as far as it was given out: how long it is, and
    /// the integral of the rate's deviation.
    Eigen::Vector3d hidden_s = Eigen::Vector3d::Zero(), hidden_rad = Eigen::Vector3d::Zero();
    std::size_t revolutions_open = 0;          ///< segments in which a whole turn more was not excluded
    std::vector<carried::System::Block> work;  ///< scratch space, no part of the state proper
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit CarriedStream(const Params& params);

  /// A state before the first sample, with all memory that push() needs.
  State start() const;
  /// Makes of a state one before the first sample, in the memory that it has. What it has counted stays.
  void restart(State& state) const;

  /// Takes one sample. `known.signs`: of the newest samples as they are known now, this one's last, at least this one;
  /// samples whose signs have changed are read again while they are in the window. `out`: rate of the sample that is
  /// `lag_s` old, empty while the window fills and where it is not `wanted`, which spares most of the work. `held`:
  /// which readings the log says again; they count once, about when they were taken (R97 of rate_stream.md). Trouble:
  /// `non_finite`, `time_order`, `gap`, `out_of_range` for no signs, `degenerate` for rows that do not span the axes;
  /// the state is then as it was and `out` empty.
  Status push(const ImuSample& sample, const ClippedElements& known, State& state, std::optional<RateState>& out,
              bool wanted = true, const HoldWatch::State& held = {}) const;

  /// Rates of the samples that push() has not given out, oldest first, appended to `out`.
  void flush(const State& state, std::vector<RateState>& out) const;

  /// What holds of every state that push() left, for one that comes from elsewhere; the first that does not.
  Status check_state(const State& state) const;

 private:
  Status check_reading(const Reading& reading, const Reading* before, TimeNs start_ns) const;
  void append(const ImuSample& sample, const HoldWatch::State& held, State& state) const;
  void add(const Reading& reading, State& state) const;
  bool read_again(const ClippedElements& known, State& state) const;
  void rebuild(State& state) const;
  carried::Node begin(const State& state) const;
  void predict(const carried::Node& before, const Eigen::Matrix3d& rows, Knot& knot) const;
  void predict_newest(State& state) const;
  carried::ReadingNoise noise_of(const State& state) const;
  std::size_t first_not_given(const State& state) const;
  void keep_rates_of_oldest(State& state) const;
  void forget_readings(State& state) const;
  void marginalise_oldest(State& state) const;
  double hand(const State& state) const;
  void add_prior(const State& state, carried::System::Block& block, carried::System::Corner& corner) const;
  bool factorise(const carried::Motion& motion, const carried::ReadingNoise& noise, State& state,
                 carried::System::BorderVector& step) const;
  bool step(State& state) const;
  void extend(State& state) const;
  RateState give(std::size_t at, bool due, bool factorised, State& state) const;
  void publish(std::size_t first, std::size_t last, bool factorised, State& state, std::span<RateState> out) const;
  void count_revolutions(std::size_t at, const RateState& rate, State& state) const;
  RateState to_rate(const Reading& reading, const State& state, const Eigen::Matrix3d& covariance_rad2_s2) const;

  Params params_;
  RestDetector rests_;
  carried::Motion motion_, doubted_;
  carried::ReadingNoise noise_;
  Eigen::Vector3d g_W_m_s2_;
  std::size_t nodes_max_, readings_max_, delay_;
};

}  // namespace tumble
