// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// Where the tests find what is not compiled into them. Functions, not definitions on the command line: only tree.cpp
/// knows the paths of this checkout, and a compiler cache serves all others with the rest.
namespace tumble::test {

/// The root of the checkout.
std::filesystem::path source_dir();
/// The program `tumble` of this build.
std::filesystem::path program();
/// Where tests keep certificates of this build, so that what one has measured serves the others.
std::filesystem::path certificates();
/// Folder of the real recordings: the environment's TUMBLE_SHARED_DATA, else the one beside the checkout. It need not
/// be there.
std::filesystem::path shared_data();

}  // namespace tumble::test
