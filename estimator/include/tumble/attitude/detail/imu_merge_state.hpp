// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Detects axes that are flipped or swapped in all gyros, or in all accelerometers, of several IMUs on one rigid body.
/// MultiImuSignCheck compares the specific forces at different positions with the measured rotation: imu_merge.md (I9).
struct MultiImuSignCheck {
  static constexpr std::size_t kMirroredAlternatives =
      12;  ///< gyros, then accelerometers: x, y or z flipped; xy, yz or zx swapped
  static constexpr double kMinEffectOnForces =
      0.3;  ///< minimum effect of an alternative on the force differences; the effect of biases is smaller
  static constexpr double kMinExplainedFraction =
      0.5;  ///< minimum (explained difference / effect): 1 for a correct alternative, -1 for a wrong one

  std::array<double, kMirroredAlternatives> explained_effect_per_alternative{}, effect_per_alternative{};

  /// Adds the mean readings of one IMU over `length_s`, in common axes. `force_m_s2` and `position_m` are relative to
  /// the mean of all IMUs. Cost: O(1), no allocation.
  void add(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& position_m, const Eigen::Vector3d& rate_rad_s,
           const Eigen::Vector3d& acceleration_rad_s2, double length_s);

  struct DetectedMirroring {
    std::size_t mirroring = 0;
    double explained_fraction = 0.0;
  };
  /// Returns the flip or swap of axes that best explains the differences between specific forces, or no value if none
  /// reaches kMinExplainedFraction.
  std::optional<DetectedMirroring> detected_mirroring() const;

  bool operator==(const MultiImuSignCheck&) const = default;
};

/// Number, poses and ranges of the IMUs that ImuMerge fuses.
struct ImuMergeSetup {
  static constexpr int kImus = 4;
  /// pose of each IMU in the common axes C of the rigid body; the first `count` entries are used
  std::array<Eigen::Isometry3d, kImus> T_mean_imu{};
  int count = 1;
  /// An accelerometer reading above this fraction of the range may be saturated during a part of its averaging window.
  static constexpr double kSubsampleSaturationRatio = 0.15;
  static constexpr double kRateNoise_rad_s = 0.01;  ///< standard deviation of a gyro's mean rate over a window
  static constexpr double kWindow_s = 4e-3;
  static constexpr double kGapMax_s = 1.0;
  double gyro_range_rad_s = 1e3;  ///< readings at or above this rate are saturated
  double accel_range_m_s2 = 1e5;
  /// directions of the sensing elements of each IMU, as found by SaturationPlaneFinder
  std::array<SensingDirections, kImus> gyro_sensing_directions{}, accel_sensing_directions{};
};

/// Estimates the errors of several accelerometers on one rigid body from the differences between their readings. For
/// each accelerometer, a Kalman filter estimates bias, scale and misalignment M, and position error. Errors that all
/// accelerometers share are not observable, and their estimates remain close to zero.
class ForceErrors {
 public:
  static constexpr int kImus = ImuMergeSetup::kImus;
  static constexpr int kErrorsPerImu = 15;  ///< bias, rows of M, position error
  static constexpr int kStates = kImus * kErrorsPerImu;
  static constexpr double kCorrelationTime_s = 0.032;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  struct State {
    Vector x = Vector::Zero();
    Covariance error_covariance = Covariance::Zero();
    // Sums over the current averaging interval.
    Eigen::Matrix<double, 3, kImus> force_difference_m_s2 = Eigen::Matrix<double, 3, kImus>::Zero();
    Eigen::Matrix<double, 3, kImus> force_m_s2 = Eigen::Matrix<double, 3, kImus>::Zero();
    Eigen::Matrix3d jacobian_position = Eigen::Matrix3d::Zero();
    double acceleration_rad_s2 = 0.0;
    int samples = 0;
    double span_s = 0.0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit ForceErrors(const ImuMergeSetup& setup) : setup_(setup) {}

  /// Processes the specific forces of all IMUs in common axes C, measured over `dt_s`. Cost: O((kErrorsPerImu
  /// count)^2), no allocation.
  void calibrate(std::span<const Eigen::Vector3d> forces_m_s2, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& acceleration_rad_s2, double dt_s, State& state) const;

  static Eigen::Vector3d corrected(int k, const Eigen::Vector3d& force_m_s2, const State& state);

  static Eigen::Vector3d position_error_m(int k, const State& state) {
    return state.x.segment<3>(kErrorsPerImu * k + kErrorsPerImu - 3);
  }

 private:
  // prior standard deviations of the bias, of each entry of M, and of the position error
  static constexpr double kBiasSigma_m_s2 = 0.05, kScaleSigma = 4e-3, kPositionSigma_m = 1.5e-3;
  static constexpr double kNoise_m_s2 =
      0.06;  // standard deviation of a force difference, averaged over kCorrelationTime_s
  static constexpr double kAccelerationNoiseRatio = 0.02;  // additional noise relative to the tangential force
  static constexpr double kGateSigmas = 5.0;               // largest accepted innovation, in standard deviations

  Eigen::Vector3d imu_position_m(int k) const { return setup_.T_mean_imu[static_cast<std::size_t>(k)].translation(); }
  void update(State& state) const;

  ImuMergeSetup setup_;
};

/// Estimates the rate of a body beyond the range of its gyros from the differences between several accelerometers. An
/// extended Kalman filter estimates rate, angular acceleration, specific force at the mean position of the IMUs, and
/// the error of each IMU position. Clipped readings are lower bounds.
///
/// AngularRateRecovery neglects scale errors; estimated IMU positions absorb the scale error of the gyros. IMUs at one
/// position provide no information about the rate.
class AngularRateRecovery {
 public:
  static constexpr int kImus = ImuMergeSetup::kImus;
  static constexpr int kStates = 9 + 3 * kImus;
  /// averaging time for which the noise constants below hold; shorter readings have more noise
  static constexpr double kReadingInterval_s = 4e-3;
  static constexpr double kMinSaturatedRangeFraction =
      0.5;  ///< the filter runs above this fraction of the gyro's range
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  struct State {
    Vector x = Vector::Zero();  ///< rate, angular acceleration, specific force, errors of the IMU positions (axes C)
    Covariance error_covariance = Covariance::Zero();
    bool started = false;
    bool running = false;
    bool operator==(const State&) const = default;
  };

  /// `mean_imu_position_m` is the mean position of the IMUs in the axes of `setup`.
  AngularRateRecovery(const ImuMergeSetup& setup, const Eigen::Vector3d& mean_imu_position_m);

  /// Processes the readings `units` of all IMUs, each in its own axes, `dt_s` after the previous readings. IMUs whose
  /// readings are not finite are ignored. `merged` contains the mean of the used IMUs in axes C, and receives the
  /// recovered rate and force. The gyro flags of `merged` are set if the rate could not be recovered. The accelerometer
  /// flags are set if most accelerometers are saturated, or if one accelerometer and a gyro are saturated. Cost:
  /// O(count), no allocation.
  void step(std::span<const ImuSample> units, double dt_s, State& state, ImuSample& merged) const;

 private:
  static constexpr double kLeverArmSigma_m = 1.5e-3;  // prior standard deviation of each IMU position
  static constexpr double kAccelerationWalk_rad_s2_sqrts = 200.0;
  static constexpr double kForceWalk_m_s2_sqrts = 25.0;
  static constexpr double kRecoveredSigma_rad_s =
      1.0;  // rates with a larger standard deviation remain flagged as clipped
  // Noise of a gyro reading: a constant, and a fraction of the reading.
  static constexpr double kRateNoise_rad_s = 0.03, kRateNoiseRatio = 0.003;
  static constexpr double kForceNoise_m_s2 = 0.3, kForceNoiseRatio = 0.004;

  struct SaturatedSensors {
    bool rate = false;
    bool force = false;  ///< enough accelerometers are saturated to corrupt the mean force
  };
  bool is_rate_saturated(const ImuSample& unit, int axis) const;
  bool is_force_saturated(const ImuSample& unit, int axis) const;
  SaturatedSensors find_saturated_sensors(std::span<const ImuSample> units) const;
  void start(const ImuSample& merged, State& state) const;
  void predict(double dt_s, State& state) const;
  void measure_rates(std::span<const ImuSample> units, double dt_s, State& state) const;
  void measure_forces(std::span<const ImuSample> units, double dt_s, State& state) const;

  ImuMergeSetup setup_;  // with poses relative to the mean position of the IMUs
};

/// Run of equal readings of one IMU, with the readings of the other IMUs at the start of the run, and the rotation
/// since then.
struct RepeatedImuReading {
  Eigen::Vector3d repeated_reading = Eigen::Vector3d::Zero(), other_imus_reading = Eigen::Vector3d::Zero();
  Eigen::Vector3d turned_rad = Eigen::Vector3d::Zero();
  TimeNs since_ns = 0;
  double repeated_s = 0.0;
  bool operator==(const RepeatedImuReading&) const = default;
};

/// Errors of one IMU relative to the mean of all IMUs.
struct MergedImuState {
  static constexpr int kErrorCount = 13;  ///< bias, scale and misalignment, time offset

  Eigen::Matrix<double, kErrorCount, 1> x = Eigen::Matrix<double, kErrorCount, 1>::Zero();
  Eigen::Matrix<double, kErrorCount, kErrorCount> covariance = Eigen::Matrix<double, kErrorCount, kErrorCount>::Zero();
  ImuAverage window;
  /// mean rate and specific force over the last window; predicted from the other IMUs if the IMU is excluded
  Eigen::Vector3d last_rate_rad_s = Eigen::Vector3d::Zero(), last_force_m_s2 = Eigen::Vector3d::Zero();
  double exclusion_left_s = 0.0;  ///< remaining time of exclusion from the mean specific force
  std::int64_t excluded_window_count = 0;
  RepeatedImuReading repeated_rate, repeated_force;
  double changing_readings_duration_s = 0.0;
  double rate_difference_to_others_rad_s = 0.0, force_disagreement_m_s2 = 0.0, disagreement_s = 0.0;
  TimeNs disagreement_since_ns = 0;
  bool is_frozen = false, disagrees = false;
  std::int64_t missing_samples = 0;
  TimeNs frozen_since_ns = 0, disagrees_since_ns = 0, missing_since_ns = 0;
  bool is_excluded() const { return is_frozen || disagrees; }
  double offset_s() const { return x[kErrorCount - 1]; }
  bool operator==(const MergedImuState&) const = default;
};

struct ImuMergeState {
  static constexpr int kImus = ImuMergeSetup::kImus;
  static constexpr int kAngularAccelerationWindows = 3;

  std::array<MergedImuState, kImus> imus{};
  ForceErrors::State forces;
  AngularRateRecovery::State rate_recovery;
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();           ///< fused rate over the last window
  Eigen::Vector3d previous_rate_rad_s = Eigen::Vector3d::Zero();  ///< fused rate over the window before
  double rotation_rate_rad_s = 0.0;                               ///< mean magnitude of the rate over half a second
  double window_s = 0.0;
  double length_s = 0.0, previous_length_s = 0.0;
  double lever_arm_correlation = 0.0, lever_arm_effect_power = 0.0;  ///< sums for lever_arm_agreement()
  MultiImuSignCheck imu_sign_check;
  std::int64_t sample_count = 0, window_count = 0;
  int unclipped_windows = kAngularAccelerationWindows;  ///< windows since a gyro clipped or an IMU was absent
  TimeNs last_time_ns = 0;
  bool all_frozen = false;
  bool operator==(const ImuMergeState&) const = default;
};

}  // namespace tumble
