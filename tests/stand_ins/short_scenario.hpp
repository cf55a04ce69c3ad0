// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tumble::test {

/// A scenario of the catalogue under its own name, cut short for tests that ask what a program does and not how well: a
/// short rest, then `hill` 4 s instead of 10, `throw` 5 s instead of 9, `roll` 5 s instead of 14.5, along a line of 1.2
/// to 1.6 m. Written into `folder`, whose path of it is returned. Throws std::runtime_error when the catalogue has no
/// such scenario, or does not say any more what is replaced.
std::filesystem::path write_short_scenario(const std::string& name, const std::filesystem::path& folder);

/// The tree's models and scenarios below `folder`, which is returned, `hill` and `roll` short under their own names.
/// With the same files whenever and wherever, so that a certificate measured over one serves the others.
std::filesystem::path write_short_data(const std::filesystem::path& folder);

}  // namespace tumble::test
