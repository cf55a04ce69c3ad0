// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tumble::scenarios {

/// The build identity contains version, compiler, build type, and a digest of the sources at build time, and is equal
/// on any machine.
const std::string& build_id();

}  // namespace tumble::scenarios
