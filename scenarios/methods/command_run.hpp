// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/methods/external_method.hpp"
#include "scenarios/processes/command.hpp"

namespace tumble::scenarios {

std::string without_trailing_folder(std::string text, const std::filesystem::path& folder);

std::string with_output_tail(const std::string& what, const CommandEnd& end);

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

void require_done(const CommandEnd& end);

/// The version command of an external method runs for at most 30 s.
std::string reported_version(Command command, const std::string& place);

}  // namespace tumble::scenarios
