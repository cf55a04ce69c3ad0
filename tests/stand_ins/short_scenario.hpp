// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tumble::test {

/// Writes a scenario of the catalogue under its own name, shortened for tests of what a program does and not of how
/// accurate it is: a short rest, then `hill` 4 s instead of 10, `throw` 5 s instead of 9, `roll` 5 s instead of 14.5,
/// along a line of 1.2 to 1.6 m. The scenario is written into `folder`, and its path is returned. Throws
/// std::runtime_error when the catalogue has no such scenario, or no longer contains the text to replace.
std::filesystem::path write_short_scenario(const std::string& name, const std::filesystem::path& folder);

/// Writes the repository's models and scenarios below `folder`, which is returned, with short versions of `hill` and
/// `roll` under their own names. The files are always the same, so that a certificate measured over one copy serves the
/// others.
std::filesystem::path write_short_data(const std::filesystem::path& folder);

}  // namespace tumble::test
