// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tumble::test {

/// A shortened scenario of the catalogue with its own name, for tests that do not measure accuracy. The rest at the
/// start is short; `hill` takes 4 s instead of 10, `throw` 5 s instead of 9, `roll` 5 s instead of 14.5 along a line
/// of 1.2 to 1.6 m. Writes the scenario to `folder` and returns its path. Throws std::runtime_error if the catalogue
/// lacks the scenario or a replaced text.
std::filesystem::path write_short_scenario(const std::string& name, const std::filesystem::path& folder);

/// Returns `folder` with the tree's models and scenarios, with short `hill` and `roll` under their own names. The files
/// are always identical, so a certificate measured with one folder is valid for the others.
std::filesystem::path write_short_data(const std::filesystem::path& folder);

}  // namespace tumble::test
