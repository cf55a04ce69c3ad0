// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

/// What reads files of strangers, and how it is held to "a clear error, never a crash".
namespace tumble::fuzz {

/// A reader of one kind of file.
struct Reader {
  std::string_view name;                            ///< also the folder of its seeds
  std::string_view file;                            ///< name that the file is given: some readers look at its ending
  void (*read)(const std::filesystem::path& file);  ///< BadInput is a refusal; whatever else it throws is a defect
};

/// All of them, in the order of registration: a new one is a function and a line in readers.cpp, and a folder of seeds.
std::span<const Reader> readers();
/// Null when none is called so.
const Reader* find_reader(std::string_view name);

/// Puts `bytes` into the reader's file in `folder`, reads it and says whether it was taken. Throws what the reader
/// throws but for refusals.
bool takes(const Reader& reader, std::string_view bytes, const std::filesystem::path& folder);

}  // namespace tumble::fuzz
