// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Rate about the spin axis at one sample.
struct SpinRate {
  int axis = -1;  ///< gyro axis closest to the spin axis; -1: the body does not spin
  double rate_rad_s = 0.0, variance_rad2_s2 = 0.0;
  double probability = 0.0;  ///< probability of a steady spin
  bool saturated = false;    ///< this gyro axis is saturated or possibly saturated
};

/// State of one Kalman filter; Modulation and Centripetal define the components of `x`.
template <int N>
struct SpinFilter {
  Eigen::Matrix<double, N, 1> x = Eigen::Matrix<double, N, 1>::Zero();
  Eigen::Matrix<double, N, N> covariance = Eigen::Matrix<double, N, N>::Zero();
  double variance_ratio = 1.0;  ///< measured / assumed variance of the readings across the spin axis
};

/// Estimates the rate of a steady spin while the gyro axis of the spin is saturated, from the readings across the spin
/// axis.
///
/// - **Modulation of the rate:** The axis of a spinning body that is long or has a steady load turns slowly in the
///   world. The rate across the spin axis is then the sum of two parts: carried.md (C44). One part is constant in the
///   body, and the other part oscillates in body axes with the frequency of the spin.
/// - **Centripetal force:** The specific force across the spin axis grows with the squared rate: carried.md (C49). The
///   lever arm is estimated while the spin axis is unsaturated.
///
/// For the modulation and for the centripetal force, one extended Kalman filter assumes a steady spin, and a second
/// filter assumes readings that change independently of the spin. The likelihood ratio of the two filters determines
/// the probability of a steady spin. Only samples with an unsaturated spin axis raise this probability, because any
/// oscillation fits some spin rate beyond the saturation limit. SpinTracker assumes that the spin axis is close to one
/// gyro axis, and that the body turns by less than half a revolution between two samples. Cost: O(1) per sample.
class SpinTracker {
 public:
  struct Params {
    double probability_min = 0.1;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.probability_min, {"probability_min", "1", 0.0, 1.0,
                                "minimum probability of a steady spin that changes the rate of a saturated axis"});
    }
  };
  /// Both filters for one effect: with a steady spin, and with readings that do not depend on the spin.
  template <int N>
  struct Hypotheses {
    SpinFilter<N> spin, independent_filter;
    double probability = 0.0;           ///< probability of a steady spin
    double measured_probability = 0.0;  ///< `probability` at the last sample with an unsaturated spin axis
  };
  struct State {
    Hypotheses<6> modulation;
    Hypotheses<8> centripetal;
    int axis = -1;
    TimeNs time_ns = 0;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit SpinTracker(const Params& params);

  /// Processes the next finite sample. Bit j of `saturated_axes` marks gyro axis j as saturated or possibly saturated,
  /// and bit 3 + j marks accelerometer axis j as saturated. With further IMUs on the body (`further_imus`), only the
  /// modulation of the rate is used.
  SpinRate step(const ImuSample& sample, std::uint8_t saturated_axes, State& state, bool further_imus = false) const;

  /// Returns the spin rate at each sample of a recording, from all earlier and later samples of the spin.
  /// `saturated_axes` contains one value per sample. Memory: about 2 kB per sample of the longest spin.
  std::vector<SpinRate> smooth(std::span<const ImuSample> samples, std::span<const std::uint8_t> saturated_axes,
                               bool further_imus = false) const;

  /// Combines an estimated rate with the spin rate by the probability of a steady spin. The result equals `rate` if the
  /// spin axis is unsaturated, if the probability is below `probability_min`, or if further IMUs (`further_imus`) give
  /// `rate` a smaller variance.
  AngularRateState combine_with_spin_rate(const AngularRateState& rate, const SpinRate& spin,
                                          bool further_imus = false) const;

 private:
  bool select_spin_axis(const ImuSample& sample, State& state) const;
  template <class Model, class Recorder>
  SpinRate advance_spin_filter(const Model& model, const ImuSample& sample, std::uint8_t saturated_axes, double dt_s,
                               bool first, int axis, Hypotheses<Model::kStates>& hypotheses,
                               const Recorder& record) const;

  Params params_;
};

// Modulation and Centripetal are two measurement models of a steady spin. The first two states of each
// model are the rate and the angular acceleration about the spin axis. The parameter `related` is 1 in the filter for a
// steady spin, and 0 in the filter for other motion. Only the filter for a steady spin rotates world-fixed vectors in
// the state by the spin angle.

template <int N>
struct SpinPrediction {
  Eigen::Matrix<double, N, 1> x;
  Eigen::Matrix<double, N, N> covariance, transition_matrix;
};

/// SpinReading splits one IMU sample into the gyro reading about the spin axis, and the readings of the two axes
/// perpendicular to the spin axis. The spin axis and the two perpendicular axes, in this order, form a right-handed
/// frame.
struct SpinReading {
  double rate_rad_s = 0.0;
  bool saturated = false;
  Eigen::Vector2d across = Eigen::Vector2d::Zero();  ///< gyro [rad/s] or accelerometer [m/s^2]
  bool across_valid = false;
  double dt_s = 0.0;
};

/// Modulation models the transverse rate (perpendicular to the spin axis), equations (C44) and (C45) of carried.md. The
/// states are:
/// - the rate and the angular acceleration about the spin axis,
/// - the part of the transverse rate that is constant in world axes: two components, in body axes,
/// - the part of the transverse rate that is constant in body axes: two components, in body axes.
struct Modulation {
  static constexpr int kStates = 6;
  using Filter = SpinFilter<kStates>;

  SpinReading reading(const ImuSample& sample, std::uint8_t saturated_axes, int axis, double dt_s) const;
  Filter start(const SpinReading& reading) const;
  SpinPrediction<kStates> predict(const Filter& filter, double related, double dt_s) const;
  double update(const SpinPrediction<kStates>& predicted, const SpinReading& reading, double related,
                Filter& filter) const;
};

/// Centripetal models the specific force perpendicular to the spin axis, equations (C49) and (C50) of carried.md. The
/// states are the rate, the angular acceleration, and three vectors. Each vector has two components perpendicular to
/// the spin axis, in body axes:
/// - the lever arm,
/// - the external force that is constant in the body,
/// - the external force that is constant in the world.
struct Centripetal {
  static constexpr int kStates = 8;
  using Filter = SpinFilter<kStates>;

  SpinReading reading(const ImuSample& sample, std::uint8_t saturated_axes, int axis, double dt_s) const;
  Filter start(const SpinReading& reading) const;
  SpinPrediction<kStates> predict(const Filter& filter, double related, double dt_s) const;
  double update(const SpinPrediction<kStates>& predicted, const SpinReading& reading, double related,
                Filter& filter) const;
};

}  // namespace tumble
