// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

/// Returns the identity of this build: version, compiler, build type, and a digest of the sources at build time. The
/// build identity does not depend on the machine.
const std::string& build_id();

}  // namespace tumble::scenarios
