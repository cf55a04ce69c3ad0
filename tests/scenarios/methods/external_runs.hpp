// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/external/external_method.hpp"
#include "scenarios/methods/registry.hpp"
#include "tests/scenarios/methods/synthetic_recording.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios::testing {

/// ExternalRuns runs external methods on one recording in closed form.
class ExternalRuns : public test::TemporaryFolder {
 protected:
  static const sim::Recording& recording() {
    static const sim::Recording one = synthetic_rig();
    return one;
  }
  static Estimate run(const fs::path& file) { return external_method(file).run(recording().sensors, {}, {}); }
  /// Returns why a run gave no answer, and its output.
  static std::pair<NoAnswer::Why, std::string> no_answer(const fs::path& file) {
    try {
      run(file);
    } catch (const NoAnswer& error) {
      return {error.why(), error.what()};
    }
    ADD_FAILURE() << "it answered";
    return {};
  }
  static void expect_same_as_raw(const Estimate& theirs) {
    const Estimate ours = find_methods("rate/raw").front()->run(recording().sensors, {}, {});
    ASSERT_EQ(theirs.rates.size(), ours.rates.size());
    ASSERT_FALSE(theirs.rates.empty());
    for (std::size_t k = 0; k < ours.rates.size(); ++k) {
      EXPECT_EQ(theirs.rates[k].time_ns, ours.rates[k].time_ns);
      EXPECT_EQ(theirs.rates[k].w_WI_I_rad_s, ours.rates[k].w_WI_I_rad_s);
    }
  }
  static std::string refused(const fs::path& file) {
    try {
      run(file);
    } catch (const BadInput& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
  }
};

}  // namespace tumble::scenarios::testing
