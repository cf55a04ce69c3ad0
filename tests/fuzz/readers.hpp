// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

/// readers.hpp lists the readers of foreign files, which must give "a clear error, never a crash".
namespace tumble::fuzz {

/// Reader is a reader of one kind of file.
struct Reader {
  std::string_view name;                            ///< also the name of the folder with its seeds
  std::string_view file;                            ///< file name, because some readers check its ending
  void (*read)(const std::filesystem::path& file);  ///< may throw BadInput; any other exception is a defect
};

/// Returns all readers, in the order of registration; a new reader needs a function and a line in readers.cpp, and a
/// folder of seeds.
std::span<const Reader> readers();
/// Returns null if no reader has this name.
const Reader* find_reader(std::string_view name);

/// Writes `bytes` to the reader's file in `folder`, reads it and returns whether it was accepted. Throws the exceptions
/// of the reader, except rejections.
bool takes(const Reader& reader, std::string_view bytes, const std::filesystem::path& folder);

}  // namespace tumble::fuzz
