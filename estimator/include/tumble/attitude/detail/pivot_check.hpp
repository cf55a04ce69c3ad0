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

/// Parameters of PivotCheck.
struct PivotCheckParams {
  double gravity_m_s2 = 9.80665;
  double accel_range_m_s2 = 0.0;        ///< range from the data sheet; 0: unknown
  double reading_s = 0.01;              ///< averaging time of readings
  double segment_s = 2.0;               ///< duration of a motion segment; the minimum is half of segment_s
  double rotation_min_rad = 1.0;        ///< minimum rotation within a segment
  double explained_rms_m_s = 0.3;       ///< rms velocity below which gyro rates explain a segment
  double noise_m_s = 0.03;              ///< rms velocity below which two alternatives explain a segment equally well
  double evidence_min = 5.0;            ///< minimum sum over the segments of the log ratio of squares
  double mean_evidence_min = 0.6;       ///< minimum mean of the log ratio per segment
  double better_segments_min = 6.0;     ///< minimum number of better explained segments; segments overlap by half
  double better_worse_ratio_min = 4.0;  ///< minimum ratio of better to worse explained segments
  double pivot_distance_max_m = 0.25;   ///< maximum pivot distance of segments that determine the scale
  double scale_error_min = 0.025;  ///< minimum difference of the scale from 1, in addition to five standard deviations
  double scale_error_min_sigmas = 5.0;
  double scale_segments_min = 10.0;  ///< minimum number of segments that determine the scale
  double scale_segment_fraction_min = 0.5;
  double gap_max_s = 0.1;  ///< a longer gap ends a segment

  /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.accel_range_m_s2,
          {"accel_range_m_s2", "m/s^2", 0.0, kUnbounded, "range stated by the device; 0: not stated"});
    visit(p.reading_s, {"reading_s", "s", 1e-3, 1.0, "duration over which readings are averaged"});
    visit(p.segment_s, {"segment_s", "s", 0.1, 100.0, "duration of one segment of motion"});
    visit(p.rotation_min_rad, {"rotation_min_rad", "rad", 0.0, 1e3, "minimum rotation within a segment"});
    visit(p.explained_rms_m_s, {"explained_rms_m_s", "m/s", 1e-3, 1e3,
                                "maximum rms velocity of the pivot in a segment that counts as explained"});
    visit(p.noise_m_s, {"noise_m_s", "m/s", 1e-6, 1e3, "noise floor of the rms velocity"});
    visit(p.evidence_min, {"evidence_min", "1", 0.0, 1e6,
                           "minimum evidence for another orientation or scale of the gyro, summed over all segments"});
    visit(p.mean_evidence_min, {"mean_evidence_min", "1", 0.0, 1e3,
                                "minimum evidence for another orientation or scale of the gyro, mean per segment"});
    visit(p.better_segments_min, {"better_segments_min", "1", 1.0, 1e6,
                                  "minimum number of segments that the other orientation explains better"});
    visit(p.better_worse_ratio_min,
          {"better_worse_ratio_min", "1", 0.0, 1e6,
           "minimum ratio of segments that the other orientation explains better to segments that it explains worse"});
    visit(p.pivot_distance_max_m,
          {"pivot_distance_max_m", "m", 1e-3, 1e3,
           "maximum distance between sensor and pivot in a segment that measures the gyro's scale"});
    visit(p.scale_error_min,
          {"scale_error_min", "1", 1e-4, 1.0, "largest accepted difference of the gyro's scale from 1"});
    visit(p.scale_error_min_sigmas,
          {"scale_error_min_sigmas", "1", 0.1, 1e6,
           "minimum difference of the gyro's scale from 1 for a fault, in standard deviations"});
    visit(p.scale_segments_min,
          {"scale_segments_min", "1", 2.0, 1e6, "minimum number of segments for a measurement of the gyro's scale"});
    visit(p.scale_segment_fraction_min, {"scale_segment_fraction_min", "1", 0.0, 1.0,
                                         "minimum share of the explained segments that measure the gyro's scale"});
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-3, 1e3, "maximum time between two samples of one segment"});
  }
};

/// Checks whether rates are plausible for a body that never rests but is held by a hand, a hinge, or the ground. During
/// one or two seconds, a held body rotates about one of its points (the pivot), which hardly moves. The forces, rotated
/// by the rates, then integrate to gravity times the duration plus the effect of rotation about the pivot. PivotCheck
/// evaluates the integral for the actual rates, for relabelled or inverted gyro axes, and for half or twice the rate.
/// The rates are wrong if only one of the alternatives fits the integral, in many segments. If the pivot is near the
/// sensor, as in hand-held motion, PivotCheck determines the gyro's scale to a per cent.
///
/// The equations of PivotCheck are imu_merge.md (I27), (I28), (I29), (I30). PivotCheck uses only unsaturated rates: a
/// segment ends where the gyro saturates. PivotCheck does not detect wrong rates in three cases. First, no alternative
/// explains the motion of a body that flies or rolls. Second, several axis labels explain rotation about a single axis
/// equally well. Third, flipping all three axes of the accelerometer only moves the estimated pivot to the opposite
/// side.
class PivotCheck {
 public:
  using Params = PivotCheckParams;

  /// Found is the result of PivotCheck over all segments.
  struct Found {
    int reading = 0;                    ///< index of the best gyro alternative; 0: unchanged gyro
    double evidence = 0.0;              ///< evidence against the unchanged rates: sum of logarithms
    std::size_t compared_segments = 0;  ///< segments that the alternative or the unchanged rates explain
    std::size_t better_segments = 0, worse_segments = 0;  ///< segments that the alternative explains better or worse
    double scale = 1.0;                                   ///< best scale of the rates, from segments with a near pivot
    double scale_sigma = std::numeric_limits<double>::infinity();
    std::size_t scale_segments = 0, explained_segments = 0;  ///< segments that determine the scale; explained segments
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit PivotCheck(const Params& params);

  /// Compares all alternatives of the gyro over a recording. Cost: O(samples). The argument `rates` contains the
  /// estimated rate of each sample.
  Found find(std::span<const ImuSample> samples, std::span<const RateState> rates) const;

  /// Returns `out_of_range` if an alternative of the gyro explains clearly more segments than the unchanged gyro, or if
  /// the gyro's scale is wrong.
  Status verdict(const Found& found) const;

 private:
  Params params_;
};

}  // namespace tumble
