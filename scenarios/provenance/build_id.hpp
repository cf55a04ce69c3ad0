// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

/// Identity of the code that made an outcome: version, compiler, build type and the digest of the sources of estimator,
/// sim and scenarios, taken at build time. Equal sources built alike have equal identities, whatever the machine.
const std::string& build_id();

}  // namespace tumble::scenarios
