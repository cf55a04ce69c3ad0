// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/methods/external_method.hpp"
#include "scenarios/processes/command.hpp"

/// command_run.hpp helps to run external commands and Python functions.
namespace tumble::scenarios {

std::string without_trailing_folder(std::string text, const std::filesystem::path& folder);

/// Returns the text `what`, followed by the last lines that the program printed.
std::string with_output_tail(const std::string& what, const CommandEnd& end);

/// Calls `work`, and removes the path of the scratch folder from the messages of BadInput and NoAnswer. The path
/// changes from run to run; without it, the messages are equal in each run.
template <class Work>
auto without_folder(const std::filesystem::path& scratch, Work&& work) {
  try {
    return work();
  } catch (const NoAnswer& error) {
    throw NoAnswer(error.why(), without_trailing_folder(error.what(), scratch), error.transcript());
  } catch (const BadInput& error) {
    throw BadInput(without_trailing_folder(error.what(), scratch));
  }
}

/// Throws NoAnswer if the program did not exit with status 0.
void require_done(const CommandEnd& end);

/// Runs a command that prints a version. Returns the first line of its output, with a digest of the whole output. The
/// command runs for at most 30 s. If the command fails, throws BadInput with a message that starts with `place`.
std::string reported_version(Command command, const std::string& place);

}  // namespace tumble::scenarios
