// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/attitude/carried_params.hpp"
#include "tumble/attitude/detail/carried_model.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/pose.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Which elements of an IMU stand at a rail in one sample: -1 the negative one, 1 the positive one, 0 free; of the gyro
/// kMissing where the reading says nothing (one that has wrapped over the rail): neither measurement nor bound.
struct ClipSigns {
  static constexpr std::int8_t kMissing = 2;
  std::array<std::int8_t, 3> gyro{}, accel{};
};
/// Those of a judged sample.
ClipSigns clip_signs(const ImuSample& sample, const Clipping& clipping);

/// What is known of an IMU's rails. Element i senses along row i of `rows` and clips there: where it does, the readings
/// y lie in the plane m_i' y = rail, and truly m_i' (rate + bias) lies beyond.
struct ClippedElements {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  std::span<const ClipSigns> signs;  ///< one per sample; empty: nothing clips
  /// One per sample: covariance of a rate that no gyro read but somebody recovered from what this smoother does not
  /// know (flight), sensor axes; zero: as read. Empty: all are. No element of a recovered sample is called clipped.
  std::span<const Eigen::Matrix3d> recovered_rad2_s2 = {};
};

/// Attitude and angular velocity of a body that is carried (held, swung, twirled), from one IMU, also where its gyro
/// clips: a smoother over a whole recording.
///
/// What a hand does is bounded: its acceleration is short-lived and its velocity and position come back. So the
/// specific force is gravity at the attitude, the lever arm's share and a bounded rest, and gravity turning in the
/// sensor tells the rate that the gyro lost. Nodes at equal times of attitude, rate, angular acceleration and the
/// carried point's acceleration, velocity, position; constants of the device beside them; Gauss-Newton on the arrow
/// matrix (ArrowSystem), covariances from the same factors. O(time) in memory (about 7 kB a node) and work, whatever
/// the IMU's rate.
///
/// Not modelled: flight (a body that is thrown: `hand_mahalanobis` tells), contact beyond what a hand's acceleration
/// explains, walk of the biases, heading.
class CarriedSmoother {
 public:
  using Params = CarriedParams;

  struct Report {
    carried::Constants constants;
    carried::System::BorderMatrix constants_covariance = carried::System::BorderMatrix::Zero();
    int iterations = 0;
    bool converged = false;
    double cost = 0.0;
    /// Largest mean acceleration of the carried point over a quarter of a second, in deviations of what is assumed. One
    /// that is thrown (specific force about 0) shows 2 and more; so does a hand that is rough: it warns, it decides
    /// nothing.
    double hand_mahalanobis = 0.0;
    /// Clipped segments in which the body may have turned once more, or less, than the descent says: how many were
    /// long and unknown enough to be asked, in how many another number of turns was the better one and was taken (a
    /// segment counts anew in each round), and in how many others stay possible, at odds of 1 to 1000 or better: there
    /// the covariance holds their spread.
    int revolutions_asked = 0, revolutions_taken = 0, revolutions_open = 0;
    /// Turns that were to be taken and from which the whole could not be solved: the answer without them stands, and
    /// they count as possible.
    int revolutions_failed = 0;
  };

  /// Throws InvalidParams when a parameter is outside of its bound.
  explicit CarriedSmoother(const Params& params);

  /// One rate and one attitude per sample (sensor axes to world, heading 0 at the start). Trouble: `empty`,
  /// `non_finite`, `time_order`, `gap` as for a filter; `out_of_range` for signs or recovered rates that are not one
  /// per sample, or for a covariance of these that is none; `diverged` when the equations lose their definiteness. The
  /// outputs are then empty.
  Status estimate(std::span<const ImuSample> samples, const ClippedElements& clipped, std::vector<RateState>& rates,
                  std::vector<AttitudeState>& attitudes, Report& report) const;

 private:
  Params params_;
};

}  // namespace tumble
