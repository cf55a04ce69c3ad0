// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/types.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

TEST(AngularRateSource, NamesAreThoseOfTheTables) {
  EXPECT_STREQ(to_string(AngularRateSource::measured), "measured");
  EXPECT_STREQ(to_string(AngularRateSource::recovered_in_flight), "recovered_in_flight");
  EXPECT_STREQ(to_string(AngularRateSource::recovered_in_contact), "recovered_in_contact");
  EXPECT_STREQ(to_string(AngularRateSource::lower_bound_only), "lower_bound_only");
  EXPECT_STREQ(to_string(static_cast<AngularRateSource>(200)), "unknown");
}

}  // namespace
}  // namespace tumble
