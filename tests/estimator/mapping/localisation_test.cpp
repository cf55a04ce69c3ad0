// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/localisation.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tumble {
namespace {

SweepReport sweep(double sigma_m, double innovation) {
  SweepReport report;
  report.pose.covariance.setZero();
  report.pose.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m / 3.0);
  report.innovation = innovation;
  return report;
}

Status after(const SweepReport& one) {
  Localisation localisation(1.0);
  for (int k = 0; k < 100; ++k) localisation.add(sweep(0.1, 0.3));
  localisation.add(one);
  for (int k = 0; k < 100; ++k) localisation.add(sweep(0.1, 0.3));
  return localisation.verdict();
}

TEST(Localisation, IsWhatTheDeviationSaysHoweverManySweepsWereHeld) {
  EXPECT_TRUE(Localisation(1.0).verdict().ok());
  SweepReport rejected = sweep(0.9, 0.0);
  rejected.verdict = SweepVerdict::rejected;
  EXPECT_TRUE(after(rejected).ok());
  const Status lost = after(sweep(1.1, 0.0));
  EXPECT_EQ(lost.trouble, Trouble::out_of_range) << "though it was found again";
  EXPECT_NE(std::string(lost.field).find("deviation"), std::string::npos);
}

// five deviations of nine unknowns: chi-square passes 46.2 with 5.7e-7
TEST(Localisation, ASweepThatContradictsItsPriorIsNotForgotten) {
  EXPECT_TRUE(after(sweep(0.1, 2.2)).ok());
  const Status contradicted = after(sweep(0.1, 2.3));
  EXPECT_NE(std::string(contradicted.field).find("innovation"), std::string::npos);
  EXPECT_NEAR(contradicted.bound, 2.266, 1e-3);
}

}  // namespace
}  // namespace tumble
