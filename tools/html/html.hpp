// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// Text that goes into a page. Everything that comes from a file or a database passes through `escaped`.
namespace tumble::tools::html {

/// Replaces & < > " ' by their entities: safe in text and in quoted attributes.
std::string escaped(const std::string& text);

/// JSON that may stand inside a script element: "<" is written as an escape, so that no "</script>" can end it.
std::string script_json(const std::string& json);

/// A path as the address of a file, relative or not: all but letters, digits, "/", "-", ".", "_" and "~" as %XX (RFC
/// 3986).
std::string file_address(const std::string& path);

/// A data: address that carries a PNG, or a WebP.
std::string png_address(std::span<const std::uint8_t> png);
std::string webp_address(std::span<const std::uint8_t> webp);

/// Base64 (RFC 4648, with padding).
std::string base64(std::span<const std::uint8_t> bytes);

/// "<td class='c'>escaped</td>"
std::string cell(const std::string& text, const std::string& css_class = "");

/// A table that scrolls within its own width, up to where its rows begin; to be ended by "</tbody></table></div>".
/// Columns from `numbers_from` on are aligned to the right.
std::string table_head(const std::vector<std::string>& columns, std::size_t numbers_from);

}  // namespace tumble::tools::html
