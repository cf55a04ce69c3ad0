// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/localisation.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

SweepResult sweep(double sigma_m, double innovation, double inlier_ratio = 0.6) {
  SweepResult report;
  report.verdict = SweepVerdict::registered;
  report.pose.covariance.setZero();
  report.pose.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m / 3.0);
  report.normalised_innovation = innovation;
  report.inlier_ratio = inlier_ratio;
  return report;
}

Status after(const SweepResult& one) {
  Localisation localisation(1.0);
  for (int k = 0; k < 100; ++k) localisation.add(sweep(0.1, 0.3));
  localisation.add(one);
  for (int k = 0; k < 100; ++k) localisation.add(sweep(0.1, 0.3));
  return localisation.verdict();
}

TEST(Localisation, AgreesWithItsDeviationForAnyNumberOfConstrainedSweeps) {
  EXPECT_TRUE(Localisation(1.0).verdict().ok());
  SweepResult rejected = sweep(0.9, 0.0);
  rejected.verdict = SweepVerdict::rejected;
  EXPECT_TRUE(after(rejected).ok());
  const Status lost = after(sweep(1.1, 0.0));
  EXPECT_EQ(lost.error_code, ErrorCode::out_of_range) << "though it was found again";
  EXPECT_NE(std::string(lost.field).find("deviation"), std::string::npos);
}

TEST(Localisation, WithoutAMapNothingIsLost) {
  Localisation localisation(1.0);
  SweepResult empty = sweep(5.0, 0.0);
  empty.verdict = SweepVerdict::rejected;
  for (int k = 0; k < 10; ++k) localisation.add(empty);
  EXPECT_TRUE(localisation.verdict().ok()) << "a lidar that says nothing";
  SweepResult first = sweep(0.01, 0.0);
  first.verdict = SweepVerdict::first;
  localisation.add(first);
  EXPECT_TRUE(localisation.verdict().ok());
  localisation.add(empty);
  EXPECT_FALSE(localisation.verdict().ok());
}

// Reversed point times or a wrong mounting distort each sweep.
TEST(Localisation, SweepsWhosePointsDoNotFitTheMapAreReported) {
  Localisation localisation(1.0);
  for (int k = 0; k < 60; ++k) localisation.add(sweep(0.1, 0.35, 0.4));  // a low-cost IMU
  for (int k = 0; k < 60; ++k) localisation.add(sweep(0.1, 0.05, 0.1));  // grass
  EXPECT_TRUE(localisation.verdict().ok());
  for (int k = 0; k < 60; ++k) localisation.add(sweep(0.1, 0.35, 0.1));
  EXPECT_NE(std::string(localisation.current_verdict().field).find("points on the map"), std::string::npos);
  for (int k = 0; k < 60; ++k) localisation.add(sweep(0.1, 0.05, 0.6));
  EXPECT_TRUE(localisation.current_verdict().ok());
  EXPECT_FALSE(localisation.verdict().ok());
}

// Saturation may hide more in one sweep than the rates state; an error of IMU or mounting occurs again.
TEST(Localisation, TwoSweepsThatContradictTheirPriorsAreNotForgotten) {
  EXPECT_TRUE(after(sweep(0.1, 3.0)).ok());
  Localisation localisation(1.0);
  for (const double innovation : {0.2, 2.0, 0.1, 3.0, 0.2, 0.3}) localisation.add(sweep(0.1, innovation));
  const Status contradicted = localisation.verdict();
  EXPECT_NE(std::string(contradicted.field).find("innovation"), std::string::npos);
  EXPECT_EQ(contradicted.value, 2.0);
  EXPECT_NEAR(contradicted.bound, 1.912, 1e-3);
}

/// Returns how many of 200 runs of 1000 sweeps the check reports, if the true errors of the predictions are `scale`
/// times the reported standard deviations.
int reported_runs(double scale) {
  std::mt19937_64 random(1);
  std::chi_squared_distribution<double> squared_error(RegistrationUnknowns::kMotionSize);
  int reported = 0;
  for (int run = 0; run < 200; ++run) {
    Localisation localisation(1.0);
    for (int k = 0; k < 1000; ++k)
      localisation.add(sweep(0.1, scale * std::sqrt(squared_error(random) / RegistrationUnknowns::kMotionSize)));
    reported += localisation.verdict().ok() ? 0 : 1;
  }
  return reported;
}

// A correct covariance is reported in 1 % of the runs; 8 or more of 200 runs have a probability of 0.1 %.
TEST(Localisation, ConsistentSweepsContradictNoPrediction) {
  EXPECT_LT(reported_runs(1.0), 8);
  EXPECT_GT(reported_runs(1.5), 190);
}

TEST(Localisation, APresentFindingEnds) {
  Localisation localisation(1.0);
  TimeNs time_ns = 0;
  const auto add = [&](double map_sigma_m, double innovation, double world_sigma_m = 0.1) {
    SweepResult report = sweep(world_sigma_m, innovation);
    report.position_in_map_sigma_m = map_sigma_m;
    report.pose.time_ns = time_ns += 100'000'000;
    localisation.add(report);
  };
  for (int k = 0; k < 100; ++k) add(0.1, 0.3, 30.0);
  EXPECT_TRUE(localisation.current_verdict().ok()) << "the drift of a long path is no tracking failure";
  add(1.1, 0.3);
  EXPECT_FALSE(localisation.current_verdict().ok());
  add(0.1, 0.3);
  EXPECT_TRUE(localisation.current_verdict().ok());
  add(0.1, 3.0);
  EXPECT_TRUE(localisation.current_verdict().ok());
  add(0.1, 3.0);
  EXPECT_FALSE(localisation.current_verdict().ok());
  for (int k = 0; k < int(10.0 * Localisation::kForgettingTime_s) + 2; ++k) add(0.1, 0.3);
  EXPECT_TRUE(localisation.current_verdict().ok());
}

}  // namespace
}  // namespace tumble
