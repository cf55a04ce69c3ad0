// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::tools {

/// The program: reads the command line, does the verb, and turns every exception into one line on standard error and
/// its exit status (session.hpp).
int run_program(int argc, const char* const* argv);

}  // namespace tumble::tools
