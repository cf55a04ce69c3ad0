// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// html.hpp writes text in HTML pages. Text from files and databases must pass through `escaped`.
namespace tumble::tools::html {

/// Replaces & < > " ' by entities, so that the text is safe as content and in quoted attributes.
std::string escaped(const std::string& text);

/// Escapes each "<" of a JSON text, so that the text cannot end a script element in which it is embedded.
std::string script_json(const std::string& json);

/// Returns a path as a file URL, relative or absolute. Characters other than letters, digits, "/", "-", ".", "_" and
/// "~" are percent-encoded (RFC 3986).
std::string file_address(const std::string& path);

/// Returns a data URL that contains a PNG or a WebP picture.
std::string png_address(std::span<const std::uint8_t> png);
std::string webp_address(std::span<const std::uint8_t> webp);

/// Returns the Base64 encoding with padding (RFC 4648).
std::string base64(std::span<const std::uint8_t> bytes);

/// Returns a table cell: "<td class='c'>escaped</td>".
std::string cell(const std::string& text, const std::string& css_class = "");

/// Returns the start of a table that scrolls horizontally, up to its first row. The caller closes the table with
/// "</tbody></table></div>". Columns from `numbers_from` are right-aligned.
std::string table_head(const std::vector<std::string>& columns, std::size_t numbers_from);

}  // namespace tumble::tools::html
