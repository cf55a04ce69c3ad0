// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/flight_sense.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/angular_velocity/detail/least_rails.hpp"
#include "tumble/angular_velocity/detail/rail_watch.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/rate_model_params_fields.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// The streaming form of RateSmoother: the same factors over a window of fixed length, one Gauss-Newton step per
/// sample, or every 5 ms where samples come faster; what leaves the window is marginalised into a Gaussian prior on the
/// next sample and on the RigConstants.
///
/// An estimate comes out when its sample is `lag_s` old, and a provisional one at once. A step is O(window): in
/// proportion to the rate of the samples beyond 200 Hz, to its square below; no allocation after the State is made.
/// Rails, upright ones and the tilted planes of a gyro's elements, are learnt as they show themselves (RailWatch); with
/// each that becomes known the window is read again, element by element, so that a clipped sample that was believed
/// counts as believed only where it left the window before its rail was seen. Give it the calibration of an earlier run
/// where there is one: then the error is 1.1 times that of the batch (median and mean) and 99 % lie within three
/// deviations. Without it the rig is learnt in the tumble that needs it: 1.6 times the median of the batch and 1.7
/// times its mean. Nearly all of that arises in the first 0.3 s after the first clipped sample, and the window is not
/// what loses it: the batch run anew for each sample on all the past and the same 0.2 s ahead is no better. With 0.5 s
/// of lag it is 1.2 and 1.4 (docs/maths/rate_stream.md has the draws).
///
/// What leaves the window is weighed for good while the constants are off by millimetres, and the samples of a flight
/// err together (its edges, an impact or a push that was taken for flight), so that their formal covariance is too
/// small: the lever arm was off by five of its deviations after 10 samples of flight, by three after 40. The covariance
/// of the rig is therefore widened while few samples have been learnt from (`rig_doubt`), and that of the rates
/// contains it so. Tried and no help: linearising 3 s of the past anew whenever the constants had moved; keeping young
/// or short flights in the window from telling of the rig; of the gyro's elements: keeping what was learnt of them when
/// the rest of the rig is dropped, and keeping contact from telling of them. What it does not model: see RateSmoother.
class RateStream {
 public:
  struct Params {
    /// Narrower than the default of RateModelParams in two priors, since a stream answers before the data outweigh
    /// them: 2 mg of bias as after a factory calibration, and the inertia of a box rather than of any body (per
    /// coordinate; sides of 3 : 2 : 2 lie at one deviation of the whole shape, a disc at 1.8, a rod at 3.6).
    RateModelParams model = {.accel_bias_sigma_m_s2 = 0.02, .inertia_sigma = 0.15};
    RailDetector::Params rails;
    RailPlaneFinder::Params planes;  ///< without a stated range of its own: that of `rails`
    RailPlaneFinder::Params accel_planes = RailPlaneFinder::Params::for_accelerometer();  ///< likewise
    RestDetector::Params rests;
    double period_s = 0.01;        ///< nominal time between samples
    double lag_s = 0.2;            ///< length of the window; [2 period_s, 10], at most 4096 samples
    double widen_first = 8.0;      ///< threshold of contact for a new clipped sample, halved with each step
    double step_max_rad_s = 10.0;  ///< longest step of a rate at one sample
    int bound_age = 3;             ///< steps after which the bounds of a sample in contact are softened
    int flight_run_min = 6;        ///< a flight of fewer samples in a row says nothing of the rig
    /// Of a rig without calibration: its covariance, but for the gyro's bias and never beyond that beforehand, counts 1
    /// + rig_doubt / (1 + n / rig_doubt_samples) times, n being the samples of flight that have been learnt from.
    double rig_doubt = 60.0;
    double rig_doubt_samples = 30.0;
    /// What contact tells of a rate beyond the rail rests on a rig that flight has to tell: of a rig without
    /// calibration its deviation is at least this share of what lies beyond the rail, over 1 + n / rig_doubt_samples.
    double contact_doubt = 0.5;
    double bound_damping = 0.5;                ///< share of a new bound taken over in each step
    double recovered_sigma_rad_s = 0.5;        ///< as in RateSmoother
    double calibration_mahalanobis_max = 1.5;  ///< beyond this what was learnt of the rig is dropped
    double gap_max_s = 1.0;                    ///< longest time between samples
    double step_s = 0.005;                     ///< least time between Gauss-Newton steps; 0: with each sample

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.model);
      visit.group("rails_", p.rails);
      visit.group("planes_", p.planes);
      visit.group("accel_planes_", p.accel_planes);
      visit.group("rests_", p.rests);
      visit(p.period_s, {"period_s", "s", 1e-5, 1.0, "nominal time between samples"});
      visit(p.lag_s, {"lag_s", "s", 2e-5, 10.0, "how old a sample is when its estimate is given out", Rank::first});
      visit(p.widen_first,
            {"widen_first", "1", 1.0, 1000.0, "threshold of contact for a new clipped sample, halved with each step"});
      visit(p.step_max_rad_s, {"step_max_rad_s", "rad/s", 1e-3, 1e4, "longest step of a rate at one sample"});
      visit(p.bound_age,
            {"bound_age", "1", 0, 4096, "steps after which the bounds of a sample in contact are softened"});
      visit(p.flight_run_min,
            {"flight_run_min", "1", 0, 4096, "a flight of fewer samples in a row says nothing of the rig"});
      visit(p.rig_doubt, {"rig_doubt", "1", 0.0, 1e3,
                          "covariance of a rig without calibration counts 1 + this / (1 + n / rig_doubt_samples) "
                          "times, n samples of flight learnt from"});
      visit(p.rig_doubt_samples, {"rig_doubt_samples", "1", 1.0, 1e6, "see rig_doubt"});
      visit(p.contact_doubt, {"contact_doubt", "1", 0.0, 10.0,
                              "of a rig without calibration: deviation of a rate in contact, as a share of what lies "
                              "beyond the rail, over 1 + n / rig_doubt_samples"});
      visit(p.bound_damping, {"bound_damping", "1", 0.01, 1.0, "share of a new bound taken over in each step"});
      visit(p.recovered_sigma_rad_s,
            {"recovered_sigma_rad_s", "rad/s", 0.0, 1e4,
             "a clipped axis known better than this is recovered, not only bounded", Rank::first});
      visit(p.calibration_mahalanobis_max,
            {"calibration_mahalanobis_max", "1", 0.1, 1e6,
             "constants of the rig that move further from their prior are held to it", Rank::first});
      visit(p.gap_max_s,
            {"gap_max_s", "s", 1e-6, 3600.0, "longest time between two samples before the run is refused"});
      visit(p.step_s, {"step_s", "s", 0.0, 0.1, "least time between Gauss-Newton steps; 0: with each sample"});
    }
  };

  struct Knot {
    RateObservation observation;
    Clipping by_walls;  ///< what the device and upright rails say; the observation's knows planes too
    RateEstimate estimate;
    Eigen::Matrix3d covariance_rad2_s2 = Eigen::Matrix3d::Zero();
    /// By how much the size of each axis has grown in each of the two steps up to this sample, the lesser; 0 or more.
    Eigen::Vector3d approach_rad_s = Eigen::Vector3d::Zero();
    int age = 0;
  };

  /// All that evolves; made by start(). Copyable; equal() compares.
  struct State {
    RailWatch::State rails;
    RestDetector::State rests;
    FrozenAxes::State frozen;
    FlightSense::State sense;
    std::vector<Knot> window;  ///< oldest first
    RigConstants rig;
    RigConstants::Matrix rig_covariance;
    // what is known of the oldest sample and of the rig from all that left the window, about a point
    arrow::Block prior;
    arrow::Corner prior_corner;
    std::array<Eigen::Vector3d, 2> extremes{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  ///< of readings so far
    LeastRails least;  ///< by the readings so far
    /// Of a run of readings at a possible rail that left in part: Knot::approach_rad_s before it, and how many left.
    Eigen::Vector3d entry_rad_s = Eigen::Vector3d::Zero(), entry_samples = Eigen::Vector3d::Zero();
    std::optional<RateKnot> left;  ///< the sample that left last, and when it was read
    TimeNs left_ns = 0;
    RateKnot prior_knot;
    RigConstants prior_rig;
    std::size_t samples = 0;
    std::size_t waiting = 0;         ///< samples since the last step
    std::size_t learnt_from = 0;     ///< samples of flight that left the window and told of the rig
    std::size_t flight_run = 0;      ///< samples of flight in a row that left the window last
    std::size_t rig_resets = 0;      ///< times that what was learnt of the rig was dropped
    std::size_t failures = 0;        ///< steps whose system was not positive definite and was skipped
    std::vector<arrow::Block> work;  ///< scratch space, no part of the state proper
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RateStream(const Params& params);

  /// A state before the first sample, with all memory that push() needs.
  State start() const;

  /// Takes one sample; `out` is the estimate of the sample that is lag_s old, empty while the window fills. On trouble
  /// (`non_finite`, `time_order`, `gap`) the state is left as it was and `out` is empty.
  Status push(const ImuSample& sample, State& state, std::optional<RateState>& out) const {
    return push(sample, {}, state, out);
  }
  /// The same with what other IMUs on the body read at that time, one per RateModelParams::auxiliary_imus or none at
  /// all; else `too_few`.
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<RateState>& out) const;

  /// Provisional estimate of the newest sample; empty before the first.
  std::optional<RateState> newest(const State& state) const;

  /// Estimates of the samples still in the window that push() has not given out, oldest first, appended to `out`.
  void flush(const State& state, std::vector<RateState>& out) const;

  /// Whether the IMU can be believed just now: `out_of_range` with the axis by name that has frozen (FrozenAxes), whose
  /// rates state the fastest rate that was read as their deviation, or where the accelerometer has the other sense than
  /// the nominal lever arm (FlightSense).
  Status doubt(const State& state) const;

  /// What has been learnt of the rig.
  RigCalibration calibration(const State& state) const { return {state.rig, widened(state)}; }

  /// True when two states will behave alike for ever (scratch space excluded), bit for bit.
  static bool equal(const State& a, const State& b);

  /// What holds of every state that push() left, for one that comes from elsewhere; the first that does not.
  Status check_state(const State& state) const;

 private:
  void forget_oldest(State& state) const;
  void marginalise(std::size_t first, State& state) const;
  void predict_covariance(State& state) const;
  double jump_before(const Knot& oldest, const State& state) const;
  void append(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state) const;
  void classify_again(State& state) const;
  void judge(std::size_t first, State& state) const;
  void doubt_unseen(std::size_t k, State& state) const;
  void forget_doubts(State& state) const;
  void doubt_possible_rails(State& state) const;
  bool may_clip(const ImuSample& sample, int axis, int sign, const State& state) const;
  void doubt_run(int axis, std::size_t first, std::size_t last, State& state) const;
  static Eigen::Vector3d approach(const std::vector<Knot>& window);
  static void remember_entry(const Knot& leaving, const Knot& next, State& state);
  void add_rails(const State& state, arrow::Corner& corner) const;
  void guess(Knot& knot, const Knot& previous, const State& state) const;
  void weigh(State& state) const;
  bool step(State& state) const;
  RigConstants::Matrix widened(const State& state) const;
  Eigen::Matrix3d doubted(const Knot& knot, const State& state) const;
  RateState to_state(const Knot& knot, const State& state) const;

  Params params_;
  RailWatch rails_;
  RestDetector rests_;
  FrozenAxes frozen_;
  FlightSense sense_;
  RateModel model_;
  std::size_t capacity_;
  std::size_t every_;  ///< samples from one step to the next
};

}  // namespace tumble
