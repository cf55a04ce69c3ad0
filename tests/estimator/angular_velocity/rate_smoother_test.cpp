// SPDX-License-Identifier: BSD-3-Clause
// Tests accuracy, covariance and symmetry of the batch smoother on synthetic tumbles.
#include "tumble/angular_velocity/detail/rate_smoother.hpp"

#include "estimator/angular_velocity/tumble_recording.hpp"
#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/angular_velocity/detail/saave.hpp"

namespace tumble {
namespace {

constexpr double kAtRail = 10.49;

struct Outcome {
  TumbleRecording recording;
  std::vector<AngularRateState> states;
  AngularRateReport report;
};

Outcome estimate(const TumbleOptions& options, const AngularRateSmoother::Params& params) {
  Outcome run{make_tumble(options), {}, {}};
  const Status status = AngularRateSmoother(params).estimate(run.recording.samples, run.states, run.report);
  EXPECT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(run.states.size(), run.recording.samples.size());
  return run;
}

TEST(AngularRateSmoother, RecoversTumblesWithTheLeverArmOffByTwentyMillimetres) {
  std::vector<double> medians;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    TumbleOptions options;
    options.seed = seed;
    options.mounting_seed = seed;
    options.roll = false;
    const Outcome run = estimate(options, with_wrong_lever_arm<AngularRateSmoother::Params>(0.02, seed));
    const ClippedErrors ours = clipped_errors(run.recording, rates_of(run.states), kAtRail);
    const ClippedErrors raw = clipped_errors(run.recording, readings_of(run.recording.samples), kAtRail);
    ASSERT_GT(ours.count, 50u);
    // measured: medians 0.007 to 0.011 rad/s (-99.5 %), impacts up to 3.4 rad/s in few samples
    EXPECT_LT(ours.median, 0.02) << seed;
    EXPECT_LT(ours.median, 0.02 * raw.median) << seed;
    EXPECT_LT(ours.maximum, 6.0) << seed;
    const Vector3d lever_error = run.report.calibration.constants.lever_arm_m - options.lever_arm_m;
    EXPECT_LT(lever_error.norm(), 0.5e-3) << seed;  // measured below 0.1 mm
    const Eigen::Matrix3d inertia = run.report.calibration.constants.inertia_matrix_with_trace_3();
    const Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
    EXPECT_LT((moments - 3.0 / options.moments.sum() * options.moments).norm(), 0.02) << seed;
    EXPECT_EQ(run.report.saturation_limits[0].value_or(0.0), 10.5);
  }
}

TEST(AngularRateSmoother, HandlesAllAxesClippedAtOnce) {
  TumbleOptions options;
  options.seed = 4;
  options.speed_low_rad_s = 20.0;
  options.speed_high_rad_s = 24.0;
  options.gyro_rail_rad_s = 7.0;
  options.roll = false;
  const Outcome run = estimate(options, with_wrong_lever_arm<AngularRateSmoother::Params>(0.02, 4));
  std::vector<double> errors;
  for (std::size_t k = 0; k < run.states.size(); ++k) {
    if (run.states[k].clipped_axes != 7 || run.recording.phase[k] != Phase::flight) continue;
    errors.push_back((run.states[k].w_WI_I_rad_s - run.recording.truth[k]).norm());
  }
  ASSERT_GT(errors.size(), 50u);
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.05);
}

TEST(AngularRateSmoother, CoverageInFlight) {
  std::size_t inside = 0, outside = 0, inside_impact = 0, outside_impact = 0;
  double normalised = 0.0;
  for (std::uint64_t seed = 21; seed <= 35; ++seed) {
    TumbleOptions options;
    options.seed = seed;
    options.mounting_seed = seed;
    options.roll = false;
    AngularRateSmoother::Params params = with_wrong_lever_arm<AngularRateSmoother::Params>(0.02, seed);
    params.model.expert.error_priors.gyro = params.model.expert.error_priors.accel = 0.0;  // nor has the sensor any
    const Outcome run = estimate(options, params);
    for (std::size_t k = 0; k < run.states.size(); ++k) {
      const Vector3d error = run.states[k].w_WI_I_rad_s - run.recording.truth[k];
      for (int j = 0; j < 3; ++j) {
        if ((run.states[k].clipped_axes >> j & 1) == 0) continue;
        const double z = error[j] * error[j] / run.states[k].covariance_rad2_s2(j, j);
        const bool flight = run.recording.phase[k] == Phase::flight;
        (flight ? (z < 9.0 ? inside : outside) : (z < 9.0 ? inside_impact : outside_impact)) += 1;
        if (flight) normalised += z;
      }
    }
  }
  ASSERT_GT(inside, 1500u);
  ASSERT_GT(inside_impact, 50u);
  // 99.73 % are expected; errors of neighbouring samples are correlated, so the count is worth about a tenth of its
  // size
  EXPECT_GT(static_cast<double>(inside) / static_cast<double>(inside + outside), 0.99);
  // measured 0.05: the model allows for a drifting clock, drag and a loose joint, which this simulation lacks
  EXPECT_GT(normalised / static_cast<double>(inside + outside), 0.02);
  EXPECT_LT(normalised / static_cast<double>(inside + outside), 1.5);
  // torque and force of an impact are not modelled: measured 95 % of the axes
  EXPECT_GT(static_cast<double>(inside_impact) / static_cast<double>(inside_impact + outside_impact), 0.9);
}

struct Consistency {
  double coverage = 0.0;    // share within three reported standard deviations
  double normalised = 0.0;  // mean squared error over reported variance
};

// Returns the consistency at clipped axes in flight, for sensors with scale and misalignment errors `sigma` per entry,
// when the smoother assumes `stated`.
Consistency consistency_with_matrices(double sigma, double stated) {
  std::size_t inside = 0, all = 0;
  double normalised = 0.0;
  for (std::uint64_t seed = 41; seed <= 60; ++seed) {
    oracles::Gaussian noise(seed);
    TumbleOptions options;
    options.seed = options.mounting_seed = seed;
    options.roll = false;
    options.flights = 2;  // many flights calibrate the gyro
    for (double& entry : options.gyro_error.reshaped()) entry = sigma * noise();
    for (double& entry : options.accel_error.reshaped()) entry = sigma * noise();
    AngularRateSmoother::Params params = with_wrong_lever_arm<AngularRateSmoother::Params>(0.01, seed);
    params.expert.error_rounds_max = 1;
    params.model.expert.error_priors.gyro = params.model.expert.error_priors.accel = stated;
    const Outcome run = estimate(options, params);
    for (std::size_t k = 0; k < run.states.size(); ++k) {
      if (run.recording.phase[k] != Phase::flight) continue;
      for (int j = 0; j < 3; ++j) {
        if ((run.states[k].clipped_axes >> j & 1) == 0) continue;
        const double error = run.states[k].w_WI_I_rad_s[j] - run.recording.truth[k][j];
        const double z = error * error / run.states[k].covariance_rad2_s2(j, j);
        inside += z <= 9.0;
        normalised += z;
        ++all;
      }
    }
  }
  EXPECT_GT(all, 500u);
  return {static_cast<double>(inside) / static_cast<double>(all), normalised / static_cast<double>(all)};
}

TEST(AngularRateSmoother, ScaleAndMisalignmentAreInTheCovariance) {
  constexpr double kSigma = 3e-3;
  const Consistency honest = consistency_with_matrices(kSigma, kSigma);
  EXPECT_GT(honest.coverage, 0.99);
  // if the same sensors are assumed perfect or much worse, the check detects it
  const Consistency perfect = consistency_with_matrices(kSigma, 0.0),
                    rough = consistency_with_matrices(kSigma, 10.0 * kSigma);
  EXPECT_LT(perfect.coverage, 0.95);
  // twenty draws of matrices: 1, except for what each run calibrates; measured 0.62, 4.1, 0.01
  EXPECT_GT(honest.normalised, 0.4);
  EXPECT_LT(honest.normalised, 1.5);
  EXPECT_GT(perfect.normalised, 1.5);
  EXPECT_LT(rough.normalised, 0.4);
}

// At 40 rad/s, an accelerometer error of 0.3 % looks like a bias of many prior standard deviations, although the lever
// arm is right. The calibration must therefore not be fixed at its prior.
TEST(AngularRateSmoother, AScaleErrorAtLargeForcesIsNoContradictionToTheLeverArm) {
  TumbleOptions options;
  options.speed_low_rad_s = 36.0;
  options.speed_high_rad_s = 44.0;
  options.accel_rail_m_s2 = 400.0;
  options.roll = false;
  options.accel_error = 3e-3 * Eigen::Matrix3d::Identity();
  AngularRateSmoother::Params params = with_wrong_lever_arm<AngularRateSmoother::Params>(0.01, 3);
  params.model.expert.error_priors.accel = 3e-3;
  const Outcome run = estimate(options, params);
  EXPECT_FALSE(run.report.calibration_at_prior);
  EXPECT_LT((run.report.calibration.constants.lever_arm_m - options.lever_arm_m).norm(), 1e-3);
  EXPECT_LT(clipped_errors(run.recording, rates_of(run.states), kAtRail).median, 0.2);
}

// The effect of the sensor errors on the rates is computed at the final estimates. Before the optimisation has
// converged, the normal equations of its last step would give wrong derivatives.
TEST(AngularRateSmoother, SensorErrorsStayInTheCovarianceBeforeConvergence) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    TumbleOptions options;
    options.seed = options.mounting_seed = seed;
    AngularRateSmoother::Params params = with_wrong_lever_arm<AngularRateSmoother::Params>(0.01, seed);
    params.expert.optimisation.iterations_max = 6;
    const Outcome run = estimate(options, params);
    double largest = 0.0;
    for (std::size_t k = 0; k < run.states.size(); ++k) {
      if (run.recording.phase[k] == Phase::flight)
        largest = std::max(largest, run.states[k].covariance_rad2_s2.diagonal().maxCoeff());
    }
    EXPECT_LT(std::sqrt(largest), 3.0) << seed;
  }
}

TEST(AngularRateSmoother, ARunWithoutClippingReturnsTheGyro) {
  TumbleOptions options;
  options.gyro_rail_rad_s = 1000.0;
  const Outcome run = estimate(options, with_lever_arm<AngularRateSmoother::Params>());
  double gyro = 0.0, ours = 0.0;
  for (std::size_t k = 0; k < run.states.size(); ++k) {
    const Vector3d reading = run.recording.samples[k].angular_velocity_rad_s;
    gyro += (reading - run.recording.truth[k]).squaredNorm();
    ours += (run.states[k].w_WI_I_rad_s - run.recording.truth[k]).squaredNorm();
    EXPECT_LT((run.states[k].w_WI_I_rad_s - reading).norm(), 8.0 * options.gyro_sigma_rad_s) << k;
    EXPECT_EQ(run.states[k].source, AngularRateSource::measured);
  }
  EXPECT_EQ(run.report.clipped_sample_count, 0u);
  EXPECT_LT(ours, 1.02 * gyro);  // at least as good as the gyro
}

TEST(AngularRateSmoother, IsEquivariantToARotatedMounting) {
  // saturation limits remain on the axes
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitZ()).toRotationMatrix();
  TumbleOptions options;
  options.seed = 3;
  TumbleRecording turned = make_tumble(options);
  for (ImuSample& sample : turned.samples) {
    sample.angular_velocity_rad_s = R * sample.angular_velocity_rad_s;
    sample.specific_force_m_s2 = R * sample.specific_force_m_s2;
  }
  auto params = with_lever_arm<AngularRateSmoother::Params>();
  params.expert.optimisation.tolerance_rad_s = 1e-8;
  params.expert.optimisation.iterations_max = 60;
  const Outcome run = estimate(options, params);
  params.model.nominal.lever_arm_m = R * params.model.nominal.lever_arm_m;
  std::vector<AngularRateState> states;
  AngularRateReport report;
  ASSERT_TRUE(AngularRateSmoother(params).estimate(turned.samples, states, report).ok());
  std::size_t same = 0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    // the initial values come from the published method, which treats the axes in order, so only its solution is
    // compared
    same += (states[k].w_WI_I_rad_s - R * run.states[k].w_WI_I_rad_s).norm() < 1e-3;
  }
  EXPECT_GT(static_cast<double>(same), 0.97 * static_cast<double>(states.size()));
}

TEST(AngularRateSmoother, WhatARunLearnsHelpsTheNext) {
  TumbleOptions hard, mild;
  hard.seed = 6;
  mild.seed = 7;
  mild.speed_low_rad_s = 8.0;
  mild.speed_high_rad_s = 12.0;
  mild.flights = 3;
  mild.roll = false;
  AngularRateSmoother::Params params = with_wrong_lever_arm<AngularRateSmoother::Params>(0.02, 5);
  const Outcome first = estimate(hard, params), fresh = estimate(mild, params);
  params.model.calibration = first.report.calibration;
  const Outcome second = estimate(mild, params);
  const double fresh_error = (fresh.report.calibration.constants.lever_arm_m - mild.lever_arm_m).norm();
  const double carried_error = (second.report.calibration.constants.lever_arm_m - mild.lever_arm_m).norm();
  EXPECT_LT(carried_error, fresh_error + 1e-4);
  EXPECT_LT(carried_error, 3e-4);
  EXPECT_LT(second.report.calibration.covariance(0, 0), fresh.report.calibration.covariance(0, 0));
}

TEST(AngularRateSmoother, SameInputSameBits) {
  TumbleOptions options;
  options.seed = 9;
  const Outcome a = estimate(options, with_wrong_lever_arm<AngularRateSmoother::Params>(0.01, 9)),
                b = estimate(options, with_wrong_lever_arm<AngularRateSmoother::Params>(0.01, 9));
  for (std::size_t k = 0; k < a.states.size(); ++k) {
    ASSERT_EQ(a.states[k].w_WI_I_rad_s, b.states[k].w_WI_I_rad_s);
    ASSERT_EQ(a.states[k].covariance_rad2_s2, b.states[k].covariance_rad2_s2);
  }
}

}  // namespace
}  // namespace tumble
