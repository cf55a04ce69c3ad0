// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/attitude/detail/hand_held_smoother.hpp"
#include "tumble/attitude/detail/regime_params.hpp"
#include "tumble/attitude/detail/spin_tracker.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct ClippedReadings {
  Eigen::Matrix3d sensing_directions = Eigen::Matrix3d::Identity();  ///< of the gyro, one per row
  std::vector<ClipSigns> clip_signs;
  std::vector<std::uint8_t> possibly_clipped_axes;  ///< bit j: gyro element j may be partly saturated

  SensingAxisClipSigns clipped_element_signs() const { return {sensing_directions, clip_signs}; }

  /// Marks gyro readings that may be saturated at an unknown limit as lower bounds of the rate. Bit j of `axes[k]`
  /// marks gyro axis j in sample k.
  void mark_suspected_saturation(std::span<const ImuSample> samples, std::span<const std::uint8_t> axes);

  /// Changes the source of a rate from `measured` to `lower_bound_only` if the gyro may be saturated during a part of
  /// the averaging window. `rates` contains one rate per sample.
  void mark_partly_saturated(std::span<AngularRateState> rates) const;
};

/// Cost: O(N).
ClippedReadings clipped_readings_of(std::span<const ImuSample> samples,
                                    const ClippingFinder::ClippingSearchResult& found);

/// Estimates the angular velocity of a body in flight, in contact or hand-held, over a whole recording.
/// AngularRateSmoother estimates the rates for flight and contact. HandHeldSmoother estimates the rates for saturated
/// intervals in which the body was probably hand-held. Both rates are combined by the probability of hand-held motion
/// (MotionRegimeEvidence), which is constant in each saturated interval. SpinTracker replaces the rate of a saturated
/// axis during a steady spin.
class MotionRegimeSmoother {
 public:
  struct Params : MotionRegimeParams {
    AngularRateSmoother::Params rate;
    HandHeldSmoother::Params hand_held;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("carried_", p.hand_held);
      MotionRegimeParams::fields(p, visit);
    }
  };
  struct Report {
    AngularRateReport rate;
    bool regimes_estimated = false;  ///< false: the probabilities below were not estimated
    RegimeProbabilities probabilities{};
    double hand_held_probability_max = 0.0;  ///< largest probability of hand-held motion in a clipped segment
    bool hand_held_smoother_ran = false;     ///< true: `hand_held` contains the report of HandHeldSmoother
    HandHeldSmoother::Report hand_held;
    std::size_t spin_samples = 0;  ///< saturated samples that are probably in a steady spin
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit MotionRegimeSmoother(const Params& params);

  /// Estimates the rates at all samples. Returns the status of AngularRateSmoother; on error, `rates` is empty. If
  /// HandHeldSmoother fails, `rates` contains the result of AngularRateSmoother.
  Status estimate(std::span<const ImuSample> samples, std::vector<AngularRateState>& rates, Report& report) const {
    return estimate(samples, {}, rates, report);
  }
  /// Estimates the rates with additional IMUs on the body, like AngularRateSmoother::estimate(). With additional IMUs,
  /// the rates are those of AngularRateSmoother and `report.regimes_estimated` is false.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<AngularRateState>& rates, Report& report) const;

 private:
  void join_hand_held_rates(std::span<const ImuSample> samples, std::vector<AngularRateState>& rates,
                            Report& report) const;
  void join_spin_rates(std::span<const ImuSample> samples, bool further_imus, std::vector<AngularRateState>& rates,
                       Report& report) const;
  bool estimate_hand_held(std::span<const ImuSample> samples, const ClippedReadings& known,
                          std::vector<AngularRateState>& rates, HandHeldSmoother::Report& report) const;
  std::vector<double> segment_hand_held_probability(std::span<const RegimeProbabilities> probabilities,
                                                    const AngularRateReport& report,
                                                    std::span<const AngularRateState> rates) const;

  Params params_;
  AngularRateSmoother rate_;
  MotionRegimeEvidence regime_evidence_;
  HandHeldSmoother hand_held_;
  SpinTracker spin_;
};

/// Estimates the rates of a recording with MotionRegimeSmoother, with optional additional IMUs. Returns `ok`, or an
/// error of align() or MotionRegimeSmoother::estimate().
Status estimate_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                      const MotionRegimeSmoother::Params& params, std::vector<AngularRateState>& rates,
                      MotionRegimeSmoother::Report& report);

/// Recording in which estimated rates replace gyro readings, for methods that need gyro readings as input.
struct RecoveredRates {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Matrix3d>
      covariances_rad2_s2;                 ///< one covariance per sample, in sensor axes; zero for unmodified readings
  std::vector<AngularRateSource> sources;  ///< one per sample
  bool estimated = false;                  ///< true if a reading clips, and MotionRegimeSmoother succeeded
  std::size_t replaced_reading_count = 0;  ///< number of clipped or possibly clipped readings that were replaced
  MotionRegimeSmoother::Report report;
  SaturationLevels saturation_levels;
};

enum class ReadingsToReplace : std::uint8_t {
  clipped,
  /// readings with a clipped or possibly clipped axis; all readings if the gyro updates more slowly than the log
  unreliable_readings,
};

/// Replaces clipped gyro readings by estimated rates plus the gyro bias, so that replaced and original readings have
/// equal bias. All three axes of a reading are replaced, because the gyro's misalignment compensation also corrupts the
/// unclipped axes. If no reading clips or the estimation fails, all readings remain. With `unreliable_readings`, the
/// readings of a gyro that updates more slowly than the log are still interpolated. Cost: O(N).
RecoveredRates recover_rates(std::span<const ImuSample> samples, std::span<const AuxiliaryRecording> auxiliary_imus,
                             const MotionRegimeSmoother::Params& params, ReadingsToReplace replaced);

}  // namespace tumble
