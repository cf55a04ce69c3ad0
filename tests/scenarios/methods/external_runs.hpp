// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/external/external_method.hpp"
#include "tests/scenarios/methods/synthetic_recording.hpp"
#include "tests/temporary_folder.hpp"

namespace tumble::scenarios::testing {

/// ExternalRuns runs external methods on one recording in closed form.
class ExternalRuns : public TemporaryFolder {
 protected:
  static const sim::Recording& recording() {
    static const sim::Recording one = synthetic_rig();
    return one;
  }
  static Estimate run(const std::filesystem::path& file) {
    return external_method(file).run(recording().sensors, {}, {});
  }
  /// Returns why a run gave no answer, and its output.
  static std::pair<NoAnswer::Why, std::string> no_answer(const std::filesystem::path& file) {
    try {
      run(file);
    } catch (const NoAnswer& error) {
      return {error.why(), error.what()};
    }
    ADD_FAILURE() << "it answered";
    return {};
  }
  static std::string refused(const std::filesystem::path& file) {
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
