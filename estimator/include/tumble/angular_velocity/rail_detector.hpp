// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Which readings of a sample say less than they show.
struct Clipping {
  std::uint8_t gyro = 0;          ///< bit j: axis j at its rail, the truth lies at or beyond the reading
  std::uint8_t accel = 0;         ///< likewise for the accelerometer
  std::uint8_t missing_gyro = 0;  ///< bit j: the reading of axis j says nothing (sign flipped at the rail: overflow)
  bool operator==(const Clipping&) const = default;
};

/// A plateau: readings in a row that lie closer together than noise allows.
struct RailPlateauParams {
  int samples = 4;  ///< readings in a row that make one
  /// Largest spread as a share of its level. Below the noise of a free reading.
  double spread_share = 2e-5;
  /// One of the gyro below this is a low one, which needs twice as many readings and a jump.
  double gyro_low_rad_s = 1.0;
  double gyro_min_rad_s = 0.02;  ///< one below this is no rail
  double accel_min_m_s2 = 15.0;  ///< likewise of the accelerometer; above gravity
  /// Digits (smallest changes seen between two readings) of the jump with which a low one begins or ends.
  double jump_digits = 8.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.samples, {"plateau_samples", "1", 2, 1000, "number of equal readings in a row that form a plateau"});
    visit(p.spread_share,
          {"plateau_spread_share", "1", 0.0, 0.01, "largest spread of a plateau, as a share of its level"});
    visit(p.gyro_low_rad_s, {"plateau_gyro_low_rad_s", "rad/s", 1e-6, 1000.0,
                             "a gyro plateau below this rate needs twice as many readings and a jump"});
    visit(p.gyro_min_rad_s,
          {"plateau_gyro_min_rad_s", "rad/s", 1e-6, 1000.0, "a gyro plateau below this rate is not a rail"});
    visit(p.accel_min_m_s2, {"plateau_accel_min_m_s2", "m/s^2", 1e-6, 1000.0,
                             "an accelerometer plateau below this force is not a rail; above gravity"});
    visit(p.jump_digits,
          {"plateau_jump_digits", "1", 1.0, 1000.0, "least jump at the start or end of a low plateau, in digits"});
  }
};

/// What few need of RailDetectorParams.
struct RailDetectorExpertParams {
  RailPlateauParams plateau = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.plateau);
  }
};

/// Of RailDetector.
struct RailDetectorParams {
  /// Range as stated by the data sheet or the user, if any: gyro [rad/s], (0, 1000]; accelerometer [m/s^2], (0, 1e5].
  std::optional<double> stated_gyro_rad_s = std::nullopt;
  std::optional<double> stated_accel_m_s2 = std::nullopt;
  double enter_share = 0.003;        ///< a reading within this share of the rail starts clipping
  double leave_share = 0.02;         ///< a neighbour of a clipped reading within this share of the rail is clipped too
  double disagreement_share = 0.02;  ///< stated and found rail disagree beyond this share

  using Expert = RailDetectorExpertParams;
  Expert expert = {};  ///< what few need

  /// Every number of it, stated once.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.enter_share, {"enter_share", "1", 0.0, 0.1,
                          "distance from the rail, as a share of it, within which a reading starts clipping"});
    visit(p.leave_share,
          {"leave_share", "1", 0.0, 0.5,
           "distance from the rail, as a share of it, within which a neighbour of a clipped reading is clipped too"});
    visit(p.disagreement_share, {"disagreement_share", "1", 1e-6, 1.0,
                                 "largest accepted difference between stated and measured rail, as a share"});
    visit.group("", p.expert);
  }
};

/// Finds the rails of an IMU in its readings: the level that a channel keeps while it is clipped, which differs from
/// unit to unit and from the data sheet (one specified for 450 deg/s was seen to stay at 600).
///
/// A plateau is a run of readings of one sign that lie closer together than noise allows, at the largest magnitude
/// seen so far on that axis. Low ones must be longer and be entered or left by a jump of many digits of the device: the
/// round top of a slow motion, read in coarse digits, and an axis that stands still are flat too. A stated range serves
/// until a plateau is seen, and only as long as no reading exceeds it. Flags reported by the device count always.
/// Clipping has hysteresis, so that the ragged edge of a plateau belongs to it. What it does not model: rails that
/// differ between the two signs of an axis, or that drift.
class RailDetector {
 public:
  using Params = RailDetectorParams;

  /// One channel; gyro x, y, z then accelerometer x, y, z.
  struct Channel {
    double rail = 0.0;  ///< found by a plateau; 0: none yet
    double peak = 0.0;  ///< largest magnitude seen
    double run_first = 0.0;
    int run_length = 0;
    double before = 0.0;  ///< the last reading
    double entry = 0.0;   ///< change with which the run began; 0: with the recording
    double digit = 0.0;   ///< smallest change seen between two readings; 0: none yet
    double last = 0.0;
    bool clipped = false;
    bool operator==(const Channel&) const = default;
  };
  struct State {
    std::array<Channel, 6> channels;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RailDetector(const Params& params);

  /// Learns from one finite sample. O(1).
  void observe(const ImuSample& sample, State& state) const;
  /// Classifies one finite sample with what is known; carries the hysteresis in `state`. O(1).
  Clipping classify(const ImuSample& sample, State& state) const;
  /// Classifies a whole recording after learning from all of it, edges on both sides of each plateau included. O(N).
  void classify_all(std::span<const ImuSample> samples, State& state, std::span<Clipping> out) const;

  /// The rising edge: adds to `clipping` of `sample` what stands before a plateau, that is before a clipped `next`, and
  /// as near to the rail as what stands after one.
  void add_edge(const ImuSample& sample, const ImuSample& next, const Clipping& of_next, const State& state,
                Clipping& clipping) const;

  /// Rail in use for channel c (0-5): the plateau found; else, as long as no reading exceeds it, the largest found on
  /// another axis of the same sensor; else likewise the stated range; else none.
  std::optional<double> rail(const State& state, int c) const;
  /// True when a stated range exists and a plateau or a larger reading contradicts it.
  bool disagrees(const State& state, int c) const;

 private:
  std::optional<double> stated(int c) const;
  /// Whether the run of readings at hand is a plateau that began or ended with `jump`.
  bool plateau(int c, const Channel& channel, double jump) const;
  Params params_;
};

}  // namespace tumble
