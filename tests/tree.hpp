// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

/// Paths that tests need at run time. The paths are functions instead of definitions on the command line: only tree.cpp
/// contains paths of this checkout, so a compiler cache serves all other files.
namespace tumble::test {

/// Returns the root of the checkout.
std::filesystem::path source_dir();
/// Returns the program `tumble` of this build.
std::filesystem::path program();
/// Folder in which tests store certificates of this build, so that other tests can use them.
std::filesystem::path certificates();
/// Folder of the real recordings: TUMBLE_SHARED_DATA of the environment, or a folder next to the checkout. The folder
/// may be missing.
std::filesystem::path shared_data();

}  // namespace tumble::test
