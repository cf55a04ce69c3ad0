// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/methods/external_method.hpp"
#include "scenarios/processes/command.hpp"

/// What runs of somebody else's program share, a command or a function of Python.
namespace tumble::scenarios {

std::string less_folder(std::string text, const std::filesystem::path& folder);

/// `what`, and the end of what the program said.
std::string with_last_words(const std::string& what, const CommandEnd& end);

/// Calls `work`, of whose messages of BadInput and NoAnswer the scratch folder is taken off, which is another one each
/// time: files within it go by their own names.
template <class Work>
auto without_folder(const std::filesystem::path& scratch, Work&& work) {
  try {
    return work();
  } catch (const NoAnswer& error) {
    throw NoAnswer(error.why(), less_folder(error.what(), scratch), error.transcript());
  } catch (const BadInput& error) {
    throw BadInput(less_folder(error.what(), scratch));
  }
}

/// Throws NoAnswer unless the program came to its end with status 0.
void require_done(const CommandEnd& end);

/// First line of what a version command says, and a digest of all of it; the command runs in `folder`, for at most half
/// a minute. Throws BadInput that begins with `place` when it fails.
std::string version_said(Command command, const std::string& place);

}  // namespace tumble::scenarios
