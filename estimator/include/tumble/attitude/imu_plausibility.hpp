// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <optional>

#include "tumble/attitude/detail/axis_labels.hpp"
#include "tumble/attitude/detail/imu_plausibility_expert_params.hpp"
#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Of ImuPlausibility.
struct ImuPlausibilityParams {
  double gravity_m_s2 = 9.80665;
  double window_s = 0.2;          ///< over which force and turning are compared
  double reading_s = 0.02;        ///< readings are averaged to this length
  double steady_share = 0.12;     ///< by which the force's size may change within a window
  double near_share = 0.25;       ///< by which it may differ from gravity for its direction to be compared
  double gyro_range_rad_s = 1e6;  ///< a window with an axis beyond it is not compared
  double gap_max_s = 0.1;         ///< after a longer one a window begins anew

  using Expert = ImuPlausibilityExpertParams;
  Expert expert = {};  ///< what few need

  /// Every number of it, stated once.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.window_s, {"window_s", "s", 0.02, 10.0, "length of the windows in which force and rotation are compared"});
    visit(p.reading_s, {"reading_s", "s", 1e-3, 1.0, "duration over which readings are averaged"});
    visit(p.steady_share, {"steady_share", "1", 1e-12, 1.0,
                           "largest change of the force's magnitude within a steady window, as a share"});
    visit(p.near_share, {"near_share", "1", 1e-12, 1e6,
                         "largest difference between force and gravity for a comparison of rotations, as a share"});
    visit(p.gyro_range_rad_s,
          {"gyro_range_rad_s", "rad/s", 1e-3, 1e6, "rate of an axis above which a window is not compared"});
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-12, 1e4, "longest gap between samples within a window"});
    visit.group("", p.expert);
  }
};

/// Whether an IMU's readings can be what they claim to be: units, axes, signs, and alive.
///
/// Where the force is steady in size over a fifth of a second it is nearly gravity: its size must be g, and the gyro
/// must say how its direction turns, u(t + T) = R^T u(t). A steady force of another size is no gravity: of a body
/// that flies and spins it is what its turning makes of the sensor's position, and stands still in the sensor's axes.
/// Of that its direction is not asked, nor anything of a window in which the gyro is at its rail. Where the force
/// turned, it must have turned as the gyro says: the slope of one over the other is 1 of a sound IMU, 2 of a gyro of
/// half the scale, -1 of one of the other sense, and about 0 of axes that are swapped. Pushes and a rod that a force
/// points along spread about that slope and do not move it far. A body that turns about the one axis which a wrong
/// naming leaves alone (a sphere that rolls along x = y with x and y swapped) keeps it; but the right naming leaves
/// less unexplained, so every naming is asked. A force that does not turn at all while the body does is told apart from
/// that.
///
/// A gyro or an accelerometer that repeats one reading to the last bit, for a second and ten times as long as ever
/// before, is frozen: it has shown that its readings move. One that held its readings as long before (a coarse quantum
/// at rest, a simulation without noise) is not told from that. One that never moved is frozen when the other one says
/// that the body moves: a gyro by the turning of gravity, or by forces that are far from gravity's for long enough, an
/// accelerometer that reads nothing but 0 by the gyro.
///
/// Not seen: an accelerometer with all three axes flipped, which is the mirrored world (ImuMerge::arm_share() tells it,
/// with several IMUs), errors of some per cent, axes about which the body does not turn, or a body that is pushed about
/// all the time.
class ImuPlausibility {
 public:
  using Params = ImuPlausibilityParams;

  /// How long a triad has repeated its reading.
  struct Hold {
    Eigen::Vector3d reading = Eigen::Vector3d::Zero();
    double held_s = 0.0, longest_s = 0.0, moved_s = 0.0;
    double frozen_s = 0.0;  ///< 0: never
    bool operator==(const Hold&) const = default;
  };
  struct State {
    Hold gyro, accel;
    ImuAverage average;
    Eigen::Vector3d force_start_m_s2 = Eigen::Vector3d::Zero();
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  ///< within the window, by the gyro
    double length_s = 0.0;
    bool open = false, steady = false;
    bool in_range = true;  ///< of all samples of the window and of the average that is open
    double force_sum_m_s2 = 0.0, windows = 0.0;
    double pushed_s = 0.0;                               ///< time of forces that are no rest's
    std::array<double, kAxisLabels> unexplained_rad2{};  ///< by how axes are named; the first: as they are
    double by_force_rad2 = 0.0, by_gyro_rad2 = 0.0;      ///< where the force turned, in
    double rotated_windows = 0.0;                        ///< windows
    double all_force_rad2 = 0.0, all_gyro_rad2 = 0.0;    ///< where either did
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams when a parameter is outside of its bound.
  explicit ImuPlausibility(const Params& params);

  /// Takes a reading; one that is not finite or out of order is passed over. O(1), no allocation.
  void step(const ImuSample& sample, State& state) const;

  /// Mean size of a steady force as a share of gravity; 1 while nothing is known.
  double force_share(const State& state) const;
  /// Share of the force's turning that the gyro does not explain; 0 while nothing is known.
  double unexplained_share(const State& state) const;
  /// Slope of the force's turning over the gyro's (I17); 1 while nothing is known.
  double rotation_slope(const State& state) const;
  /// Correlation of the two turnings, -1 to 1: 1 of a gyro of any scale, -1 of the other sense, about 0 of axes that
  /// are swapped, between where pushes are taken for gravity. 1 while too little turned.
  double rotation_agreement(const State& state) const;
  /// The force's turning as a share of the gyro's, also where the force did not turn; 1 while nothing is known.
  double force_rotated_share(const State& state) const;
  /// How axes are named where gravity turns with the gyro, when they clearly are not as they say (I18).
  std::optional<AxisLabels> other_labels(const State& state) const;
  /// Longest time for which the gyro or the accelerometer was frozen [s]; 0: never.
  double frozen_s(const State& state) const;
  /// `out_of_range` naming which of these is out of its bound.
  Status verdict(const State& state) const;

 private:
  /// Whether the force turned far enough, and in windows enough, for the sums to mean something.
  bool turned(const State& state) const;
  /// Whether a gyro of the slope's scale leaves far less unexplained than this one, or is of the other sense.
  bool explains_more(const State& state) const;
  void take(State& state) const;
  void compare(const Eigen::Vector3d& force_m_s2, State& state) const;
  void hold(const Eigen::Vector3d& reading, double dt_s, Hold& hold) const;

  Params params_;
};

}  // namespace tumble
