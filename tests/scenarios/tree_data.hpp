// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/data_root.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {

/// Returns the scenarios, suites and models of this checkout.
inline DataRoot tree_data() {
  return DataRoot{test::source_dir()};
}

}  // namespace tumble::scenarios
