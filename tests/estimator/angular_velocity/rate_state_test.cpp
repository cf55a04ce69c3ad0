// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/rate_state.hpp"

#include <gtest/gtest.h>

namespace tumble {
namespace {

TEST(RateSource, NamesAreThoseOfTheTables) {
  EXPECT_STREQ(to_string(RateSource::measured), "measured");
  EXPECT_STREQ(to_string(RateSource::recovered_flight), "recovered_flight");
  EXPECT_STREQ(to_string(RateSource::recovered_contact), "recovered_contact");
  EXPECT_STREQ(to_string(RateSource::bounded_only), "bounded_only");
  EXPECT_STREQ(to_string(static_cast<RateSource>(200)), "unknown");
}

}  // namespace
}  // namespace tumble
