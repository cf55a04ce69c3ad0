// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::tools {

/// Every exception becomes one line on standard error and an exit status.
int run_program(int argc, const char* const* argv);

}  // namespace tumble::tools
