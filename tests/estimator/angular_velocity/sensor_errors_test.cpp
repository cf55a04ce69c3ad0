// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/sensor_errors.hpp"

#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/rate_smoother.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/common/types.hpp"
#include "tumble_recording.hpp"

namespace tumble {
namespace {

// Returns a tumble whose accelerometer is `samples` late.
TumbleRecording late_tumble(std::uint64_t seed, std::size_t samples) {
  TumbleOptions options;
  options.seed = options.mounting_seed = seed;
  TumbleRecording out = make_tumble(options);
  for (std::size_t k = out.samples.size(); k-- > samples;) {
    out.samples[k].specific_force_m_s2 = out.samples[k - samples].specific_force_m_s2;
  }
  return out;
}

struct Coverage {
  std::size_t inside = 0, all = 0;
  double share() const { return static_cast<double>(inside) / static_cast<double>(all); }
};

void count(const TumbleRecording& recording, const std::vector<AngularRateState>& states, Coverage& coverage) {
  for (std::size_t k = 0; k < states.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      if ((states[k].clipped_axes >> j & 1) == 0) continue;
      const double error = states[k].w_WI_I_rad_s[j] - recording.truth[k][j];
      coverage.inside += error * error <= 9.0 * states[k].covariance_rad2_s2(j, j);
      ++coverage.all;
    }
  }
}

TEST(SensorErrors, ComeBackFromTheirVector) {
  oracles::Gaussian noise(1);
  SensorErrors::Vector v;
  for (double& x : v) x = noise();
  const SensorErrors errors = SensorErrors::from(v);
  EXPECT_EQ(errors.vector(), v);
  EXPECT_EQ(errors.gyro(0, 1), v[1]);
  EXPECT_EQ(errors.accel(2, 0), v[SensorErrors::kAccel + 6]);
  EXPECT_EQ(errors.accel_delay_s, v[SensorErrors::kDelay]);
}

// Information that any motion could explain counts by time, not by samples; all other information is unchanged: (R39).
TEST(SensorErrors, WhatNoMotionDeterminesIsDiscounted) {
  oracles::Gaussian noise(2);
  SensorErrors::Matrix root;
  for (double& x : root.reshaped()) x = noise();
  SensorErrorInformation evidence;
  evidence.information = root * root.transpose();
  for (double& x : evidence.gradient) x = noise();
  SensorErrors both_rotated;
  both_rotated.gyro = both_rotated.accel = so3::hat({0.3, -0.2, 0.5});
  SensorErrors gyro_longer, accel_longer, gyro_rotated, one_axis;
  gyro_longer.gyro.setIdentity(), accel_longer.accel.setIdentity();
  gyro_rotated.gyro = so3::hat({0.3, -0.2, 0.5}), gyro_rotated.accel = -gyro_rotated.gyro;
  one_axis.gyro.diagonal() << 2.0, -1.0, -1.0;
  SensorErrors late;
  late.accel_delay_s = 1.0;

  SensorErrorInformation same = evidence, tenth = evidence;
  discount_unobservable(1.0, same);
  EXPECT_EQ(same.information, evidence.information);
  EXPECT_EQ(same.gradient, evidence.gradient);
  discount_unobservable(0.1, tenth);
  const auto along = [](const SensorErrors& error, const SensorErrorInformation& of) {
    const SensorErrors::Vector v = error.vector();
    return std::pair(v.dot(of.gradient), v.dot(of.information * v));
  };
  for (const SensorErrors& untold : {both_rotated, gyro_longer, accel_longer}) {
    EXPECT_NEAR(along(untold, tenth).first, 0.1 * along(untold, evidence).first, 1e-12);
    EXPECT_NEAR(along(untold, tenth).second, 0.01 * along(untold, evidence).second, 1e-10);
  }
  for (const SensorErrors& told : {gyro_rotated, one_axis, late}) {
    EXPECT_NEAR(along(told, tenth).first, along(told, evidence).first, 1e-12);
    EXPECT_NEAR(along(told, tenth).second, along(told, evidence).second, 1e-10);
  }
}

TEST(SensorErrors, WithoutReadingsTheyAreWhatIsAssumed) {
  SensorErrorPriors sheet;
  sheet.gyro_uncalibrated = sheet.accel_uncalibrated = sheet.g_sensitivity_uncalibrated_s_m =
      sheet.delay_uncalibrated_s = 0.0;
  const SensorErrorFit believed = fit_sensor_errors({}, sheet), open = fit_sensor_errors({}, {});
  EXPECT_EQ(believed.fitted_errors.errors, SensorErrors{});
  EXPECT_DOUBLE_EQ(std::sqrt(believed.fitted_errors.covariance(1, 1)), sheet.gyro);
  EXPECT_DOUBLE_EQ(believed.data_sheet_probability, 1.0);
  EXPECT_LT(open.data_sheet_probability, 1.0);
  EXPECT_GT(open.fitted_errors.covariance(0, 0), 20.0 * believed.fitted_errors.covariance(0, 0));
}

TEST(SensorErrors, ADelayThatIsPlainIsFoundAndAnotherIsNotMadeUp) {
  SensorErrorInformation evidence;
  constexpr int i = SensorErrors::kDelay;
  evidence.information(i, i) = 1.0 / (1e-4 * 1e-4);
  evidence.gradient[i] = evidence.information(i, i) * 4e-3;
  const SensorErrorFit late = fit_sensor_errors(evidence, {});
  EXPECT_NEAR(late.fitted_errors.errors.accel_delay_s, 4e-3, 1e-4);
  EXPECT_LT(late.synchronous_triads_probability, 1e-6);
  evidence.gradient[i] = evidence.information(i, i) * 5e-5;
  const SensorErrorFit alike = fit_sensor_errors(evidence, {});
  EXPECT_GT(alike.synchronous_triads_probability, 0.9);
  EXPECT_LT(std::abs(alike.fitted_errors.errors.accel_delay_s), 5e-5);
}

// Compares the derivatives of add_sensor_errors() with the gradient of a model that contains the error.
TEST(SensorErrors, MoveTheGradientAsTheModelHasIt) {
  oracles::Gaussian noise(3);
  AngularRateObservation o;
  AngularRateEstimate estimate;
  BodyImuConstants rig;
  rig.lever_arm_m = {-0.022, -0.085, 0.055};
  rig.inertia_coordinates << 0.05, -0.03, 0.02, 0.01, -0.02;
  estimate.knot = {{4.0, -6.0, 3.0}, {10.0, 20.0, -15.0}};
  estimate.flight_weight = 1.0;
  o.sample.angular_velocity_rad_s = estimate.knot.rate_rad_s;
  o.sample.specific_force_m_s2 = flight_force_factor(estimate.knot, rig, Vector3d::Zero()).residual;
  for (const double age_s : {0.0, 0.004}) {
    o.gyro_age_s = age_s;
    o.sample.angular_velocity_rad_s = estimate.knot.rate_rad_s - age_s * estimate.knot.acceleration_rad_s2;
    const AngularRateModel model({.nominal = rig}, 0.01);
    arrow::ErrorMatrix block = arrow::ErrorMatrix::Zero();
    arrow::BorderErrors border = arrow::BorderErrors::Zero();
    SensorErrorInformation evidence;
    model.add_sensor_errors(o, estimate, rig, block, border, evidence);
    EXPECT_LT(evidence.gradient.cwiseAbs().maxCoeff(), 1e-6 * evidence.information.cwiseAbs().maxCoeff());
    for (int i = 0; i < SensorErrors::kSize; ++i) {
      constexpr double kStep = 1e-6;
      arrow::Block blocks[2];
      arrow::Corner corners[2];
      for (int side = 0; side < 2; ++side) {
        AngularRateModelParams params;
        params.nominal = rig;
        params.errors = SensorErrors::from((side == 0 ? kStep : -kStep) * SensorErrors::Vector::Unit(i));
        AngularRateModel(params, 0.01).add_sample(o, estimate, rig, blocks[side], corners[side]);
      }
      const arrow::StateVector want = (blocks[0].gradient - blocks[1].gradient) / (2.0 * kStep);
      EXPECT_LT((block.col(i) - want).norm(), 1e-3 * (1.0 + want.norm())) << i;
      Eigen::Matrix<double, 9, 1> calibration_by_errors =
          (corners[0].gradient - corners[1].gradient).head<9>() / (2.0 * kStep);
      EXPECT_LT((border.col(i).head<9>() - calibration_by_errors).norm(), 1e-3 * (1.0 + calibration_by_errors.norm()))
          << i;
    }
  }
}

// A calibration is restored unchanged from a device of equal uncertainty without other readings.
TEST(SensorErrors, WhatWasLearntComesBack) {
  SensorErrorPriors open;
  open.gyro = open.accel = open.gyro_uncalibrated;
  open.g_sensitivity_s_m = open.g_sensitivity_uncalibrated_s_m;
  open.delay_s = open.delay_uncalibrated_s;
  KnownSensorErrors learnt = fit_sensor_errors({}, open).fitted_errors;
  constexpr int i = SensorErrors::kDelay, j = SensorErrors::kGSensitivity;
  learnt.covariance(i, i) *= 0.01;
  learnt.covariance(j, j) *= 0.25;
  learnt.covariance(i, j) = learnt.covariance(j, i) =
      0.3 * std::sqrt(learnt.covariance(i, i) * learnt.covariance(j, j));
  learnt.errors.accel_delay_s = 4e-3;
  learnt.errors.g_sensitivity_s_m(0, 0) = 1e-4;
  const SensorErrorFit back = fit_sensor_errors({}, open, evidence_from_earlier_runs(learnt, open));
  EXPECT_NEAR(back.fitted_errors.errors.accel_delay_s, 4e-3, 1e-9);
  EXPECT_NEAR(back.fitted_errors.errors.g_sensitivity_s_m(0, 0), 1e-4, 1e-10);
  const SensorErrors::Vector deviation = learnt.covariance.diagonal().cwiseSqrt();
  const SensorErrors::Matrix apart = deviation.cwiseInverse().asDiagonal() *
                                     (back.fitted_errors.covariance - learnt.covariance) *
                                     deviation.cwiseInverse().asDiagonal();
  EXPECT_LT(apart.cwiseAbs().maxCoeff(), 1e-6);
  // a result that is as uncertain as the prior contains no information
  const KnownSensorErrors nothing = fit_sensor_errors({}, open).fitted_errors;
  EXPECT_LT(evidence_from_earlier_runs(nothing, open).information.cwiseAbs().maxCoeff() * open.delay_s * open.delay_s,
            1e-6);
}

TEST(TriadDelay, IsGuessedWhereThereIsOne) {
  std::size_t right = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (const std::size_t late : {0u, 1u, 2u}) {
      const TumbleRecording recording = late_tumble(seed, late);
      std::vector<Clipping> clippings(recording.samples.size());
      for (std::size_t k = 0; k < clippings.size(); ++k) {
        for (int j = 0; j < 3; ++j) {
          const bool at_rail = std::abs(recording.samples[k].angular_velocity_rad_s[j]) > 10.49;
          clippings[k].gyro = static_cast<std::uint8_t>(clippings[k].gyro | (at_rail ? 1u << j : 0u));
        }
      }
      const double found = guess_triad_delay(recording.samples, clippings, {-0.022, -0.085, 0.055}).delay_s;
      const bool near = std::abs(found - 0.01 * static_cast<double>(late)) < 2.6e-3;
      right += near ? 1 : 0;
      EXPECT_TRUE(near || late > 0) << seed;
    }
  }
  // measured 14: the delay is found in neither of two recordings (seeds 2 and 4)
  EXPECT_GE(right, 14u);
}

TEST(TriadDelay, IsNilWithoutMotion) {
  const std::vector<ImuSample> rest(100);
  EXPECT_EQ(guess_triad_delay(rest, std::vector<Clipping>(100), Vector3d::Zero()).delay_s, 0.0);
  EXPECT_EQ(guess_triad_delay({}, {}, Vector3d::Zero()).delay_s, 0.0);
}

// An accelerometer that is 10 ms late gives results as accurate and consistent as a synchronous one; assumed
// synchronous, it gives neither.
TEST(RateSmootherDevices, ALateAccelerometerIsFound) {
  Coverage found, taken, in_time;
  double late_sum = 0.0, clean_sum = 0.0, taken_sum = 0.0;
  for (const std::uint64_t seed : {2u, 3u, 5u, 6u, 7u}) {  // seeds 1, 4 and 8 are classified as contact, see below
    const TumbleRecording late = late_tumble(seed, 1), clean = late_tumble(seed, 0);
    std::vector<AngularRateState> states;
    AngularRateReport report;
    ASSERT_TRUE(
        AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(late.samples, states, report).ok());
    EXPECT_NEAR(report.sensor_errors.errors.accel_delay_s, 0.01, 1e-3);
    EXPECT_LT(report.synchronous_triads_probability, 0.05);
    late_sum += clipped_errors(late, rates_of(states), 10.49).median;
    count(late, states, found);
    ASSERT_TRUE(AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>())
                    .estimate(clean.samples, states, report)
                    .ok());
    EXPECT_GT(report.synchronous_triads_probability, 0.05);
    EXPECT_LT(std::abs(report.sensor_errors.errors.accel_delay_s), 2e-4);
    count(clean, states, in_time);
    clean_sum += clipped_errors(clean, rates_of(states), 10.49).median;
    auto believing = with_lever_arm<AngularRateSmoother::Params>();
    believing.expert.error_rounds_max = 1;
    ASSERT_TRUE(AngularRateSmoother(believing).estimate(late.samples, states, report).ok());
    taken_sum += clipped_errors(late, rates_of(states), 10.49).median;
    count(late, states, taken);
  }
  ASSERT_GT(found.all, 300u);
  EXPECT_LT(late_sum, 2.0 * clean_sum);
  EXPECT_GT(taken_sum, 3.0 * late_sum);
  EXPECT_GT(found.share(), 0.97);
  EXPECT_GT(found.share(), in_time.share() - 0.01);
  EXPECT_LT(found.share(), 0.9999);
  EXPECT_LT(taken.share(), 0.9);
}

// In a single flight with few impacts, the free flight determines the delay. The lever arm must not absorb it.
TEST(RateSmootherDevices, ADelayIsFoundInOneFlight) {
  for (const std::uint64_t seed : {1u, 4u, 8u}) {
    const TumbleRecording late = late_tumble(seed, 1);
    std::vector<AngularRateState> states;
    AngularRateReport report;
    ASSERT_TRUE(
        AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(late.samples, states, report).ok());
    EXPECT_FALSE(report.calibration_at_prior) << seed;
    EXPECT_NEAR(report.sensor_errors.errors.accel_delay_s, 0.01, 1e-3) << seed;
    EXPECT_LT((report.calibration.constants.lever_arm_m - TumbleOptions{}.lever_arm_m).norm(), 1e-3) << seed;
  }
}

// Known errors that the caller states are corrected, and not estimated away.
TEST(RateSmootherDevices, GivenErrorsAreKept) {
  TumbleRecording recording = late_tumble(3, 0);
  auto params = with_lever_arm<AngularRateSmoother::Params>();
  params.model.errors.gyro = Eigen::Vector3d(0.01, -0.008, 0.006).asDiagonal();
  for (ImuSample& sample : recording.samples) {
    const Vector3d more = params.model.errors.gyro * sample.angular_velocity_rad_s;
    for (int j = 0; j < 3; ++j) {
      if (std::abs(sample.angular_velocity_rad_s[j]) < 10.49) sample.angular_velocity_rad_s[j] += more[j];
    }
  }
  std::vector<AngularRateState> states, without;
  AngularRateReport report;
  ASSERT_TRUE(AngularRateSmoother(params).estimate(recording.samples, states, report).ok());
  EXPECT_LT((report.sensor_errors.errors.gyro - params.model.errors.gyro).cwiseAbs().maxCoeff(), 1e-12);
  ASSERT_TRUE(AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>())
                  .estimate(recording.samples, without, report)
                  .ok());
  double given_sum = 0.0, without_sum = 0.0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (states[k].clipped_axes != 0) continue;
    given_sum += (states[k].w_WI_I_rad_s - recording.truth[k]).norm();
    without_sum += (without[k].w_WI_I_rad_s - recording.truth[k]).norm();
  }
  ASSERT_GT(without_sum, 0.0);
  EXPECT_LT(given_sum, 0.5 * without_sum);
}

// A stated delay is the centre of the search: 30 ms are accepted although devices without a statement have less.
TEST(RateSmootherDevices, AStatedDelayFarFromZeroIsUsed) {
  const TumbleRecording late = late_tumble(3, 3);
  auto params = with_lever_arm<AngularRateSmoother::Params>();
  params.model.errors.accel_delay_s = 0.03;
  params.model.expert.error_priors.delay_s = 2e-4;
  params.model.expert.error_priors.delay_uncalibrated_s = 4e-3;
  std::vector<AngularRateState> states;
  AngularRateReport report;
  ASSERT_TRUE(AngularRateSmoother(params).estimate(late.samples, states, report).ok());
  EXPECT_NEAR(report.sensor_errors.errors.accel_delay_s, 0.03, 5e-4);
  constexpr int i = SensorErrors::kDelay;
  EXPECT_LT(std::sqrt(report.sensor_errors.covariance(i, i)),
            0.5 * params.model.expert.error_priors.delay_uncalibrated_s);
  EXPECT_GT(report.synchronous_triads_probability, 0.5);
}

// A run that starts from the calibration of a late accelerometer finds in its first optimisation what a new run finds
// in its second or third, and more accurately.
TEST(RateSmootherDevices, WhatARunLearnsOfTheDeviceHelpsTheNext) {
  const TumbleRecording first = late_tumble(3, 1), second = late_tumble(5, 1);
  std::vector<AngularRateState> states;
  AngularRateReport of_first, fresh, informed;
  ASSERT_TRUE(AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>())
                  .estimate(first.samples, states, of_first)
                  .ok());
  ASSERT_TRUE(
      AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(second.samples, states, fresh).ok());
  auto params = with_lever_arm<AngularRateSmoother::Params>();
  params.calibrated_errors = of_first.sensor_errors;
  ASSERT_TRUE(AngularRateSmoother(params).estimate(second.samples, states, informed).ok());
  EXPECT_NEAR(informed.sensor_errors.errors.accel_delay_s, 0.01, 5e-4);
  EXPECT_LE(informed.correction_iterations, fresh.correction_iterations);
  constexpr int i = SensorErrors::kDelay;
  EXPECT_LT(informed.sensor_errors.covariance(i, i), fresh.sensor_errors.covariance(i, i));
  // the device still differs from its data sheet
  EXPECT_LT(informed.synchronous_triads_probability, 0.05);
  EXPECT_GT(informed.common_delay_sigma_s, 0.0);
}

// Negative control: the calibration of a late device does not make another device late.
TEST(RateSmootherDevices, WhatWasLearntOfAnotherDeviceGivesWayToTheReadings) {
  const TumbleRecording first = late_tumble(3, 1), second = late_tumble(5, 0);
  std::vector<AngularRateState> states;
  AngularRateReport report;
  ASSERT_TRUE(
      AngularRateSmoother(with_lever_arm<AngularRateSmoother::Params>()).estimate(first.samples, states, report).ok());
  auto params = with_lever_arm<AngularRateSmoother::Params>();
  params.calibrated_errors = report.sensor_errors;
  ASSERT_TRUE(AngularRateSmoother(params).estimate(second.samples, states, report).ok());
  EXPECT_LT(std::abs(report.sensor_errors.errors.accel_delay_s), 5e-4);
  Coverage coverage;
  count(second, states, coverage);
  EXPECT_GT(coverage.share(), 0.97);
}

// Simulates the readings of a triad with a separate update rate.
std::vector<double> hold(std::vector<ImuSample>& samples, double period_s, double phase_s) {
  const std::vector<ImuSample> exact = samples;
  std::vector<double> ages(samples.size(), 0.0);
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const double now = 0.01 * static_cast<double>(k);
    const double read = phase_s + period_s * std::floor((now - phase_s) / period_s);
    ages[k] = now - read;
    const double at = std::max(0.0, read / 0.01);
    const auto before = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(before);
    const std::size_t after = std::min(before + 1, samples.size() - 1);
    samples[k].angular_velocity_rad_s =
        (1.0 - share) * exact[before].angular_velocity_rad_s + share * exact[after].angular_velocity_rad_s;
  }
  return ages;
}

TEST(SampleHold, FindsPeriodAndAges) {
  for (const double period_s : {0.012, 0.016, 0.0195}) {
    TumbleRecording recording = late_tumble(2, 0);
    EXPECT_FALSE(find_repeated(recording.samples, Triad::gyro).has_value());
    const std::vector<double> ages = hold(recording.samples, period_s, 0.0037);
    const std::optional<RepeatedReadings> held = find_repeated(recording.samples, Triad::gyro);
    ASSERT_TRUE(held.has_value());
    EXPECT_FALSE(find_repeated(recording.samples, Triad::accelerometer).has_value());
    EXPECT_NEAR(held->period_s, period_s, 1e-4);
    EXPECT_GT(held->regular_clock_fraction, 0.97);
    double sum = 0.0;
    for (std::size_t k = 200; k < 500; ++k) sum += std::abs(held->age_s[k] - ages[k]) / 300.0;
    EXPECT_LT(sum, 2e-3);
  }
}

}  // namespace
}  // namespace tumble
