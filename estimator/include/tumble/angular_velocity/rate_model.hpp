// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/arrow_solver.hpp"
#include "tumble/angular_velocity/auxiliary_imu.hpp"
#include "tumble/angular_velocity/partial_clipping.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_planes.hpp"
#include "tumble/angular_velocity/rate_factors.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rig_constants.hpp"
#include "tumble/angular_velocity/sensor_errors.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// What is assumed of the sensors, of the body and of its motion; shared by the batch and the streaming smoother.
struct RateModelParams {
  /// What is known of the rig beforehand; the shape of the inertia counts about the centre of mass, in IMU axes. The
  /// lever arm has no default: it is refused until it is stated, unless there is a `calibration`.
  RigConstants nominal = {.lever_arm_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())};
  /// Standard deviations of `nominal`.
  double lever_arm_sigma_m = 0.01;
  double gyro_bias_sigma_rad_s = 0.01;
  double accel_bias_sigma_m_s2 = 0.05;
  double inertia_sigma = 0.3;
  /// Of each entry of RigConstants::elements: cross-axis sensitivity before the device compensates it.
  double element_sigma = 0.03;
  /// What an earlier run has learnt; takes the place of `nominal` and of the five deviations above.
  std::optional<RigCalibration> calibration = std::nullopt;

  /// Other IMUs on the body, at most kAuxiliaryImusMax; their readings come with each sample.
  std::vector<AuxiliaryImu> auxiliary_imus = {};

  /// Noise density of the gyro [rad/s/sqrt(Hz)]; of an industrial MEMS gyro, 0.03 deg/s/sqrt(Hz).
  double gyro_noise_density = 5.236e-4;
  /// Noise density of the accelerometer [m/s^2/sqrt(Hz)]; of an industrial MEMS accelerometer, 60 ug/sqrt(Hz).
  double accel_noise_density = 5.9e-4;
  /// What the flight model misses of the specific force (drag, bias in motion), besides noise [m/s^2].
  double flight_sigma_m_s2 = 0.02;
  /// What the model misses of a force, a torque or a rate lasts so long: samples that come faster say it once between
  /// them, and their noise alone averages out [s].
  double model_error_s = 0.01;
  /// Scale and misalignment of the accelerometer, as a share of the force.
  double accel_scale_error = 1e-3;
  /// What the device makes of the motion, as far as it is known: readings are corrected for it.
  SensorErrors errors = {};
  /// What is left open of it.
  SensorErrorSizes error_sizes = {};
  /// What a gyro's bandwidth and its clock leave open of the time of a reading (a first-order low-pass at 415 Hz is
  /// 0.38 ms late): counted in the covariance, times the angular acceleration [s].
  double gyro_time_sigma_s = 2.5e-4;
  /// What Euler's equation without torque misses of the angular acceleration [rad/s^2].
  double euler_sigma_rad_s2 = 0.3;
  /// Density of the white angular jerk in flight [rad^2/s^5].
  double jerk_psd_flight = 1e4;
  /// In contact the jerk grows by what the force can do to the angular acceleration: rad/s^2 per m/s^2 of specific
  /// force that the flight model cannot explain.
  double contact_gain_rad_m = 4.0;
  /// Impacts are no Gaussian noise: what a fit through one claims to know is widened by this factor.
  double contact_sigma_factor = 1.3;
  /// Euler's equation in contact: a force F turns the body across itself, by up to about this times |F| (mass times
  /// distance of the contact over a third of the trace of the inertia) ....
  double contact_lever_rad_m = 5.0;
  /// ... and about its own direction by a share of that (several contacts, a contact that moves in a window).
  double contact_twist_share = 0.3;
  /// In contact the unknown force is taken for zero with a standard deviation of this times itself (a prior that is
  /// flat in its logarithm has 0.58); 0: nothing is assumed of it.
  double contact_force_share = 1.0;
  /// A sample whose residuals of flight exceed this many standard deviations counts as contact.
  double flight_threshold = 5.0;
  /// Softness of the bound that a clipped reading is [rad/s].
  double rail_sigma_rad_s = 0.05;
  /// A body at rest still trembles, and rest may be found where there is none: deviation of its rate from zero, taken
  /// anew with each sample [rad/s].
  double rest_sigma_rad_s = 0.01;
  /// Rates and accelerations that no body of this kind has; they bound the answer where nothing else does. The first
  /// in [1, 1e4] rad/s, the second in [1, 1e7] rad/s^2.
  double rate_max_rad_s = 50.0;
  double acceleration_max_rad_s2 = 5000.0;

  /// Every number of it, stated once: `rate_model_fields.hpp`.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit);
};

inline constexpr std::size_t kAuxiliaryImusMax = 2;

/// One sample as the model sees it.
struct RateObservation {
  ImuSample sample;
  Clipping clipping;
  bool at_rest = false;  ///< standstill: the rate is zero, see RestDetector
  // Axes that are read with a deviation of their own, bit j of each for axis j; an axis is one of the three at most.
  std::uint8_t partial = 0;  ///< met the rail in a part of its window only, as the device says: see PartialLoss
  std::uint8_t lone = 0;  ///< few readings as high as other elements' rails, on a side whose own rail nobody has seen
  std::uint8_t doubted = 0;  ///< a run of readings that may all stand at a rail nobody has seen: at least what is read
  Eigen::Vector3d lost_rad_s = Eigen::Vector3d::Zero();        ///< of partial axes, signed as the reading
  Eigen::Vector3d lost_sigma_rad_s = Eigen::Vector3d::Zero();  ///< of all three
  /// How old the triads' readings are at the stamp of the sample, and whether the gyro's is that of the sample before.
  double gyro_age_s = 0.0, accel_age_s = 0.0;
  bool gyro_repeats = false;
  ElementRows accel_rows = {};  ///< of the accelerometer's elements: of use where one of them clips
  std::array<AuxiliaryReading, kAuxiliaryImusMax> auxiliary_imus =
      {};  ///< in the order of RateModelParams::auxiliary_imus

  /// Whether an element clips, so that the readings of all axes are off: it is read element by element.
  bool by_elements() const { return (clipping.gyro | clipping.void_gyro) != 0; }

  /// Axes that are read, but not as well as the gyro reads.
  std::uint8_t read_in_part() const { return static_cast<std::uint8_t>(partial | lone | doubted); }
  /// Axes whose reading may be less than the rate, though no rail was found there.
  std::uint8_t may_hide() const { return static_cast<std::uint8_t>(lone | doubted); }

  /// Axes whose rate is not read: bound at most.
  std::uint8_t unseen() const {
    for (const AuxiliaryReading& auxiliary_imu : auxiliary_imus) {
      if (auxiliary_imu.sees_all_rates()) return 0;
    }
    return static_cast<std::uint8_t>((clipping.gyro | clipping.void_gyro) & ~(partial & ~clipping.void_gyro));
  }
};

/// Finds the partial axes of `now` from the samples beside it (null where there is none).
void mark_partial(const RailDetector& rails, const RailDetector::State& state, double noise_rad_s,
                  const ImuSample* before, RateObservation& now, const ImuSample* after);

/// What is estimated of one sample.
struct RateEstimate {
  RateKnot knot;
  double flight_weight = 0.0;  ///< 0: contact, 1: free flight
  /// Specific force of contact at the centre of mass: what the flight model does not explain.
  Eigen::Vector3d contact_m_s2 = Eigen::Vector3d::Zero();
  /// What the bounds of clipped elements amount to, as Gaussian sites on what each hides, m_j . (rate + bias -
  /// reading): precision and precision * mean.
  Eigen::Vector3d bound_precision = Eigen::Vector3d::Zero();
  Eigen::Vector3d bound_shift = Eigen::Vector3d::Zero();
  bool soft_bounds = false;  ///< false: bounds are walls that act only when violated (for the first iterations)
};

/// The factors of one sample and of one step between samples, added to an arrow matrix. Holds derived coefficients
/// only.
class RateModel {
 public:
  /// `period_s`: nominal time between samples, from which noise per sample and the scale of the acceleration follow.
  /// Throws InvalidParams on a parameter outside of its bound.
  RateModel(const RateModelParams& params, double period_s);

  /// Weighs a sample between flight and contact at the current estimate. `rig_covariance`: what is not yet known of
  /// the rig must not pass for contact. `widen` >= 1 multiplies the threshold while the rates themselves are unknown.
  /// `jump`: the smaller of the jumps to the neighbours, from jump(); flight has at least one smooth side.
  void weigh(const RateObservation& observation, const RigConstants& rig, const RigConstants::Matrix& rig_covariance,
             double widen, double jump, RateEstimate& estimate) const;

  /// How far a step between two samples is from the smoothness of flight: squared, normalised, six degrees of freedom.
  double jump(const RateKnot& from, const RateKnot& to, double dt_s) const;

  /// Moves the unseen rates of a sample in contact to where its force is smallest, when that is far smaller than at the
  /// current estimate: between two impacts a body may fly for a single sample, which no local step finds.
  void seek_flight(const RateObservation& observation, const RigConstants& rig, RateEstimate& estimate) const;

  /// Starts the bounds of a sample: near the current estimate or the reading, whichever lies beyond.
  void start_bounds(const RateObservation& observation, const RigConstants& rig, RateEstimate& estimate) const;

  /// Refines the bounds of a sample by expectation propagation (Minka 2001): the Gaussian site with which the marginal
  /// has the mean and variance that truncation at the reading gives it. `damping` in (0, 1] is the share of the new.
  void update_bounds(const RateObservation& observation, const RigConstants& rig, const arrow::Conditional& conditional,
                     const RigConstants::Matrix& rig_covariance, double damping, RateEstimate& estimate) const;

  /// Adds gyro, bound, flight and Euler factors of one sample. `doubted`: null, or what is not known of the rig, where
  /// the sample shall say nothing of the rig and count for as little as that leaves it (a flight too short to be told
  /// from contact of another rig).
  void add_sample(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                  arrow::Block& block, arrow::Corner& corner, const RigConstants::Matrix* doubted = nullptr) const;

  /// What each of SensorErrors does to the gradient of a sample, and what the sample says of them. A clipped element
  /// says no more than where its rail is, contact nothing: neither tells of errors.
  void add_errors(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                  arrow::ErrorMatrix& block, arrow::BorderErrors& border, SensorErrorEvidence& evidence) const;

  /// Adds the motion prior between two samples, dt_s apart.
  void add_step(const RateEstimate& from, const RateEstimate& to, double dt_s, arrow::Block& block,
                arrow::Block& next) const;

  /// Adds what was known of the rig beforehand.
  void add_rig_prior(const RigConstants& rig, arrow::Corner& corner) const;

  /// How far `rig` is from what was known beforehand: the largest, over lever arm, both biases and inertia, of the
  /// Mahalanobis distance divided by the root of the number of components. About 1 is expected.
  double calibration_mahalanobis(const RigConstants& rig) const;

  RigConstants prior_constants() const { return prior_constants_; }
  const RigConstants::Matrix& prior_covariance() const { return prior_covariance_; }

  /// A step of the solver in physical units.
  Eigen::Matrix<double, 6, 1> unscaled(const arrow::StateVector& step) const;
  /// A difference in physical units in those of the solver.
  arrow::StateVector scaled(const Eigen::Matrix<double, 6, 1>& difference) const;
  /// Covariance of a rate as it is reported: of the fit, wider in contact, and what the time of a reading leaves open.
  Eigen::Matrix3d reported(const Eigen::Matrix3d& covariance_rad2_s2, const RateObservation& observation,
                           const RateEstimate& estimate) const;
  double gyro_sigma_rad_s() const { return gyro_sigma_rad_s_; }

 private:
  struct ForceFactor {
    RateFactor factor;
    Eigen::Vector3d information;  ///< of each axis, or element
  };
  /// The residual of flight element by element where one of the accelerometer's clips: bounds that hold are dropped.
  /// Returns variances to be added, of what unknown rows make of the hidden force.
  static Eigen::Vector3d read_accel_elements(const RateObservation& observation, RateFactor& flight);
  ForceFactor force_factor(const RateObservation& observation, const RateEstimate& estimate,
                           const RigConstants& rig) const;
  /// The rate of which the gyro's reading tells: earlier by the reading's age.
  RateKnot at_reading(const RateObservation& observation, const RateEstimate& estimate) const;
  /// The gyro's reading without what the device is known to make of the motion.
  Eigen::Vector3d corrected_rate(const RateObservation& observation, const RateEstimate& estimate) const;
  /// flight_factor() with what is known of the accelerometer's errors; `by_delay`: as late_flight_factor().
  RateFactor flight(const RateObservation& observation, const RateKnot& knot, const RigConstants& rig,
                    Eigen::Vector3d* by_delay = nullptr) const;
  double gyro_information(const RateObservation& observation, const RateEstimate& estimate, int axis) const;
  void add_gyro(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                arrow::Block& block, arrow::Corner& corner) const;
  void add_elements(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                    arrow::Block& block, arrow::Corner& corner, const RigConstants::Matrix* doubted) const;
  static bool says_nothing_of_rig(const RateEstimate& estimate);
  static void keep_from_rig(const RateObservation& observation, RateFactor& flight);
  void add_auxiliary_imus(const RateObservation& observation, const RateEstimate& estimate, const RigConstants& rig,
                          arrow::Block& block) const;
  Eigen::Matrix3d euler_information(const RateEstimate& estimate) const;
  double accel_sigma_m_s2(const RateObservation& observation) const;
  double accel_variance_together(const RateObservation& observation) const;

  RateModelParams params_;
  bool exact_ = true;    ///< nothing is known of errors: readings are taken as they are
  double time_scale_s_;  ///< the solver's acceleration is the acceleration times this
  double gyro_sigma_rad_s_;
  double accel_noise_m_s2_;
  double accel_sigma_m_s2_;
  double share_;  ///< of what lasts model_error_s, that one sample may say
  RigConstants prior_constants_;
  RigConstants::Matrix prior_covariance_;
  RigConstants::Matrix prior_information_;
};

/// Where a rate comes from, given its covariance and the deviation below which a clipped axis counts as recovered.
RateSource rate_source(const RateObservation& observation, const RateEstimate& estimate,
                       const Eigen::Matrix3d& covariance_rad2_s2, double recovered_sigma_rad_s);

}  // namespace tumble
