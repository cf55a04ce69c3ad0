// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <span>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Of PivotCheck.
struct PivotCheckParams {
  double gravity_m_s2 = 9.80665;
  double accel_range_m_s2 = 0.0;    ///< as the device states it; 0: not stated
  double reading_s = 0.01;          ///< readings are averaged to this length
  double segment_s = 2.0;           ///< of motion that is explained at once, and half of it at least
  double rotation_least_rad = 1.0;  ///< within a segment, to count
  double explains_m_s = 0.3;        ///< root mean square of a velocity below which a segment is explained
  double noise_m_s = 0.03;          ///< nothing is explained better than so
  double evidence_least = 5.0;      ///< sum over the segments of the logarithm of the ratio of squares, and
  double evidence_of_each = 0.6;    ///< on the average of a segment at least
  double segments_least = 6.0;      ///< that are explained better; each moment is in two
  double better_over_worse = 4.0;   ///< and so many for each that is explained worse
  double arm_most_m = 0.25;         ///< of a segment that tells the scale
  double scale_off = 0.025;         ///< and five deviations, by which the scale differs from 1
  double scale_deviations = 5.0;
  double scale_segments_least = 10.0;  ///< and this share of those that the rates explain: others hang on a rod
  double scale_share_least = 0.5;
  double gap_max_s = 0.1;  ///< a longer one ends a segment

  /// Every number of it, stated once.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.accel_range_m_s2,
          {"accel_range_m_s2", "m/s^2", 0.0, kUnbounded, "range stated by the device; 0: not stated"});
    visit(p.reading_s, {"reading_s", "s", 1e-3, 1.0, "duration over which readings are averaged"});
    visit(p.segment_s, {"segment_s", "s", 0.1, 100.0, "length of motion that one segment explains"});
    visit(p.rotation_least_rad, {"rotation_least_rad", "rad", 0.0, 1e3, "least rotation within a segment"});
    visit(p.explains_m_s, {"explains_m_s", "m/s", 1e-3, 1e3, "rms velocity below which a segment is explained"});
    visit(p.noise_m_s, {"noise_m_s", "m/s", 1e-6, 1e3, "noise floor of the rms velocity"});
    visit(p.evidence_least, {"evidence_least", "1", 0.0, 1e6,
                             "least evidence for another orientation or scale of the gyro, summed over all segments"});
    visit(p.evidence_of_each, {"evidence_of_each", "1", 0.0, 1e3,
                               "least evidence for another orientation or scale of the gyro, mean per segment"});
    visit(p.segments_least,
          {"segments_least", "1", 1.0, 1e6, "least number of segments that the other orientation explains better"});
    visit(p.better_over_worse,
          {"better_over_worse", "1", 0.0, 1e6, "least ratio of segments explained better to segments explained worse"});
    visit(p.arm_most_m,
          {"arm_most_m", "m", 1e-3, 1e3, "largest distance from sensor to pivot for a segment to measure the scale"});
    visit(p.scale_off, {"scale_off", "1", 1e-4, 1.0, "largest accepted difference of the gyro's scale from 1"});
    visit(p.scale_deviations, {"scale_deviations", "1", 0.1, 1e6,
                               "least difference of the scale from 1 for a fault, in standard deviations"});
    visit(p.scale_segments_least,
          {"scale_segments_least", "1", 2.0, 1e6, "least number of segments for a measurement of the scale"});
    visit(p.scale_share_least,
          {"scale_share_least", "1", 0.0, 1.0, "least share of explained segments that measure the scale"});
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-3, 1e3, "longest gap between samples within a segment"});
  }
};

/// Whether rates can be believed of a body that never rests but is held: by a hand, by a hinge, by the ground that it
/// rocks on. Over a second or two it turns about a point of itself that hardly moves. The forces, turned by the rates,
/// then add to gravity for the time, and to what the turning makes of the way to that point, and to nothing else. Where
/// they do not, but would with axes or signs of the gyro named otherwise, or with half or twice its rate, segment after
/// segment, the rates are not what they claim. Where the point is near the sensor, as in a hand, the same tells the
/// gyro's scale to a per cent.
///
/// The equations are imu_merge.md (I24), (I25), (I26), (I27). Only what the gyro measured counts: a segment ends where
/// it was at its rail. Not seen: a body that flies or rolls on, which no reading explains; turning about one axis
/// alone, which several namings explain alike; an accelerometer with all three axes flipped, whose pivot lies on the
/// other side.
class PivotCheck {
 public:
  using Params = PivotCheckParams;

  /// What all segments say.
  struct Found {
    int reading = 0;                    ///< of the gyro, that explains most, by number; 0: as it is
    double evidence = 0.0;              ///< for it, against the rates as they are: sum of logarithms, more is better
    std::size_t counted = 0;            ///< segments that it or the rates as they are explain
    std::size_t better = 0, worse = 0;  ///< of those, by more than a fifth of the residual
    double scale = 1.0;                 ///< by which the rates explain most, of segments with a near pivot
    double scale_sigma = std::numeric_limits<double>::infinity();
    std::size_t scale_segments = 0, explained = 0;  ///< and all that the rates as they are explain
  };

  /// Throws InvalidParams when a parameter is outside of its bound.
  explicit PivotCheck(const Params& params);

  /// `rates`: what an estimate gives for each of the samples. O(samples).
  Found find(std::span<const ImuSample> samples, std::span<const RateState> rates) const;

  /// `out_of_range` where another reading of the gyro explains clearly more, or its scale is off.
  Status verdict(const Found& found) const;

 private:
  Params params_;
};

}  // namespace tumble
