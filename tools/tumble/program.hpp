// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::tools {

/// Runs the program: parses the command line, runs the verb, and converts every exception to one line on standard error
/// and an exit status (session.hpp).
int run_program(int argc, const char* const* argv);

}  // namespace tumble::tools
