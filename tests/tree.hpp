// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// The functions here return the paths of what is not compiled into the tests. They are functions, and not definitions
/// on the command line: only tree.cpp contains the paths of this checkout, so a compiler cache works for all other
/// files in other checkouts.
namespace tumble::test {

/// Returns the root of the checkout.
std::filesystem::path source_dir();
/// Returns the program `tumble` of this build.
std::filesystem::path program();
/// Returns the folder where tests keep certificates of this build, so that a certificate measured by one test serves
/// the others.
std::filesystem::path certificates();
/// Returns the folder of the real recordings: the environment's TUMBLE_SHARED_DATA, or else the folder next to the
/// checkout. The folder need not exist.
std::filesystem::path shared_data();

}  // namespace tumble::test
