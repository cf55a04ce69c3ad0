// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

/// Returns the identity of the program's code: version, compiler, build type, and a digest of the sources at build time
/// (estimator, sim and scenarios). Equal sources, compiler and build type give equal identities on any machine.
const std::string& build_id();

}  // namespace tumble::scenarios
