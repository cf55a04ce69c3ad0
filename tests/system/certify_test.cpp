// SPDX-License-Identifier: BSD-3-Clause
// The test checks the certificate as the program prints it. Other tests cover the measurements of the rows.
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

TEST(Certify, PrintsRowsWithBoundAndVerdict) {
  const Ended ended = run_successfully({"certify", "--row", "free_fall", "--row", "flight_force"});
  for (const char* word : {"free_fall_time", "flight_specific_force", "<= 1e-06", "m/s^2", "pass"}) {
    EXPECT_THAT(ended.out, HasSubstr(word));
  }
  EXPECT_THAT(ended.err, HasSubstr("compares the duration of a free fall with the analytic solution"));
  EXPECT_EQ(run_program({"certify", "--row", "free_fall", "--quiet"}).err, "");
}

TEST(Certify, IsJsonOnDemand) {
  const json certificate = json_of(run_program({"certify", "--row", "free_flight", "--json"}));
  EXPECT_EQ(certificate["verdict"], "pass");
  EXPECT_NE(certificate.value("build", ""), "");
  ASSERT_EQ(certificate["entries"].size(), 2u);
  for (const json& entry : certificate["entries"]) {
    EXPECT_EQ(entry["verdict"], "pass");
    EXPECT_LE(entry["value"].get<double>(), entry["high"].get<double>());
  }
}

}  // namespace
}  // namespace tumble::system_test
