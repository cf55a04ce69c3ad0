// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/processes/command.hpp"

/// What runs of somebody else's program share, a command or a function of Python.
namespace tumble::scenarios {

/// `what`, and the end of what the program said.
std::string with_last_words(const std::string& what, const CommandEnd& end);

/// Throws NoAnswer unless the program came to its end with status 0.
void require_done(const CommandEnd& end);

/// First line of what a version command says, and a digest of all of it; the command runs in `folder`, for at most half
/// a minute. Throws BadInput that begins with `place` when it fails.
std::string version_said(Command command, const std::string& place);

}  // namespace tumble::scenarios
