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

/// Clipping marks the clipped axes of a sample.
struct Clipping {
  std::uint8_t gyro = 0;           ///< bit j: axis j is saturated; the true value is at or beyond the reading
  std::uint8_t accel = 0;          ///< bit j: axis j of the accelerometer is saturated
  std::uint8_t unusable_gyro = 0;  ///< bit j: the reading of axis j is unusable (overflow with flipped sign)
  bool operator==(const Clipping&) const = default;
};

/// RailPlateauParams defines plateaus: runs of consecutive readings that are closer together than noise allows.
struct RailPlateauParams {
  int samples = 4;  ///< minimum number of readings
  /// Largest spread of the readings of a plateau, as a fraction of the saturation level. The spread of a plateau is
  /// smaller than the noise of unsaturated readings.
  double spread_share = 2e-5;
  /// A plateau of the gyro below gyro_low_rad_s needs twice as many readings, and a jump at its start or end.
  double gyro_low_rad_s = 1.0;
  double gyro_min_rad_s = 0.02;  ///< minimum level of a plateau
  double accel_min_m_s2 = 15.0;  ///< minimum level of a plateau of the accelerometer; above gravity
  /// Minimum jump at the start or end of a low plateau, in digits. A digit is the smallest observed change between two
  /// readings.
  double jump_digits = 8.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.samples, {"plateau_samples", "1", 2, 1000, "number of equal readings in a row that form a plateau"});
    visit(p.spread_share, {"plateau_spread_share", "1", 0.0, 0.01,
                           "maximum spread of the readings of a plateau, as a share of the plateau's level"});
    visit(p.gyro_low_rad_s, {"plateau_gyro_low_rad_s", "rad/s", 1e-6, 1000.0,
                             "a gyro plateau below this rate needs twice as many readings and a jump"});
    visit(p.gyro_min_rad_s, {"plateau_gyro_min_rad_s", "rad/s", 1e-6, 1000.0,
                             "a gyro plateau below this rate does not count as a saturation limit"});
    visit(p.accel_min_m_s2,
          {"plateau_accel_min_m_s2", "m/s^2", 1e-6, 1000.0,
           "an accelerometer plateau below this force does not count as a saturation limit; must be above gravity"});
    visit(p.jump_digits, {"plateau_jump_digits", "1", 1.0, 1000.0,
                          "minimum jump at the start or end of a low plateau, in steps of the reading's resolution"});
  }
};

/// Parameters of RailDetectorParams that few users change.
struct RailDetectorExpertParams {
  RailPlateauParams plateau = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.plateau);
  }
};

/// Parameters of RailDetector.
struct RailDetectorParams {
  /// Ranges that the data sheet or the user states, if any: gyro [rad/s], (0, 1000]; accelerometer [m/s^2], (0, 1e5].
  std::optional<double> stated_gyro_rad_s = std::nullopt;
  std::optional<double> stated_accel_m_s2 = std::nullopt;
  double enter_share = 0.003;        ///< clipping starts within this fraction of the saturation level
  double leave_share = 0.02;         ///< readings next to a clipped reading are clipped within this fraction
  double disagreement_share = 0.02;  ///< minimum relative difference that contradicts the stated range

  using Expert = RailDetectorExpertParams;
  Expert expert = {};  ///< parameters that few users change

  /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.enter_share,
          {"enter_share", "1", 0.0, 0.1,
           "a reading within this distance of the saturation limit counts as clipped, as a share of the limit"});
    visit(p.leave_share, {"leave_share", "1", 0.0, 0.5,
                          "a neighbour of a clipped reading within this distance of the saturation limit also counts "
                          "as clipped, as a share of the limit"});
    visit(p.disagreement_share,
          {"disagreement_share", "1", 1e-6, 1.0,
           "maximum accepted difference between stated and measured saturation limit, as a share of the stated limit"});
    visit.group("", p.expert);
  }
};

/// Finds the saturation level of each axis of an IMU from the readings of the axis. The saturation level differs
/// between devices of one type, and from the data sheet. For example, one gyro with a stated range of 450 deg/s
/// saturated at 600 deg/s.
///
/// A plateau is a run of readings of one sign that are closer together than noise allows. The readings of a plateau
/// have the largest magnitude so far on the axis. A plateau at a low rate must be longer, and must start or end with a
/// jump of many digits of the device. The required jump excludes an axis at rest, and the rounded maximum of a slow,
/// coarsely quantised motion. A stated range is used until RailDetector finds a plateau or a reading exceeds the range.
/// RailDetector always uses the clip flags of the device. The classification has hysteresis, so that the irregular edge
/// of a plateau belongs to the plateau. RailDetector does not model saturation levels that drift or differ between the
/// two signs of an axis.
class RailDetector {
 public:
  using Params = RailDetectorParams;

  /// State of one channel of the IMU. The channels are gyro x, y, z, then accelerometer x, y, z.
  struct Channel {
    double rail = 0.0;  ///< saturation level from a plateau; 0: none found
    double peak = 0.0;  ///< largest magnitude so far
    double run_first = 0.0;
    int run_length = 0;
    double before = 0.0;  ///< previous reading
    double entry = 0.0;   ///< change at the start of the run; 0: the recording started with the run
    double digit = 0.0;   ///< smallest observed change between two readings; 0: none yet
    double last = 0.0;
    bool clipped = false;
    bool operator==(const Channel&) const = default;
  };
  struct State {
    std::array<Channel, 6> channels;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RailDetector(const Params& params);

  /// Updates the saturation levels with one finite sample. Cost: O(1).
  void observe(const ImuSample& sample, State& state) const;
  /// Classifies one finite sample with the current saturation levels. Cost: O(1). `state` stores the hysteresis of the
  /// classification.
  Clipping classify(const ImuSample& sample, State& state) const;
  /// Classifies a whole recording after all samples have updated the saturation levels. Cost: O(N). The clipped samples
  /// include the edges on both sides of each plateau.
  void classify_all(std::span<const ImuSample> samples, State& state, std::span<Clipping> out) const;

  /// Adds the rising edge of a plateau to `clipping`. The edge consists of the axes of `sample` that are near the
  /// saturation level before a clipped `next`. The largest distance of an edge from the saturation level is equal
  /// before and after a plateau.
  void add_rising_edge(const ImuSample& sample, const ImuSample& next, const Clipping& of_next, const State& state,
                       Clipping& clipping) const;

  /// Returns the saturation level of channel c (0-5). The level comes from the plateau of the channel, else from the
  /// largest plateau on another axis of its triad, else from the stated range. A saturation level from another axis or
  /// from the stated range applies only while no reading of channel c exceeds the level.
  std::optional<double> rail(const State& state, int c) const;
  /// Returns whether a plateau or a larger reading contradicts the stated range.
  bool disagrees(const State& state, int c) const;

 private:
  std::optional<double> stated(int c) const;
  /// Returns whether the current run of readings is a plateau that started or ended with `jump`.
  bool plateau(int c, const Channel& channel, double jump) const;
  Params params_;
};

}  // namespace tumble
