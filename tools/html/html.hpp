// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tumble::tools::html {

std::string escaped(const std::string& text);

/// Each "<" of the JSON text is escaped, so that the text cannot end a script element in which it is embedded.
std::string script_json(const std::string& json);

std::string file_address(const std::string& path);

std::string png_address(std::span<const std::uint8_t> png);
std::string webp_address(std::span<const std::uint8_t> webp);

std::string base64(std::span<const std::uint8_t> bytes);

std::string cell(const std::string& text, const std::string& css_class = "");

std::string table_head(const std::vector<std::string>& columns, std::size_t numbers_from);

}  // namespace tumble::tools::html
