// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

/// Readers of external files, which must report a clear error and never crash.
namespace tumble::fuzz {

/// A reader of one kind of file.
struct Reader {
  std::string_view name;                            ///< also the name of the folder with its seeds
  std::string_view file;                            ///< file name, because some readers check its ending
  void (*read)(const std::filesystem::path& file);  ///< may throw BadInput; any other exception is a defect
};

/// Returns all readers, in the order of registration. A new reader needs a function and a line in readers.cpp, and a
/// folder of seeds.
std::span<const Reader> readers();
/// Returns the reader of this name, or null.
const Reader* find_reader(std::string_view name);

/// Writes `bytes` to the reader's file in `folder` and reads it. Returns whether the reader accepts it. Throws all
/// exceptions of the reader except BadInput.
bool takes(const Reader& reader, std::string_view bytes, const std::filesystem::path& folder);

}  // namespace tumble::fuzz
