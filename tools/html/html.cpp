// SPDX-License-Identifier: BSD-3-Clause
#include "tools/html/html.hpp"

#include <algorithm>
#include <string_view>

namespace tumble::tools::html {

std::string escaped(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string script_json(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) group = (group << 8) | (j < count ? bytes[i + j] : 0u);
    for (std::size_t j = 0; j < 4; ++j) out += j <= count ? kDigits[(group >> (18 - 6 * j)) & 63u] : '=';
  }
  return out;
}

std::string file_address(const std::string& path) {
  static constexpr char kPlain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789/-._~";
  static constexpr char kHex[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : path) {
    if (c != '\0' && std::string_view(kPlain).find(c) != std::string_view::npos) {
      out += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      out += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out;
}

std::string png_address(std::span<const std::uint8_t> png) {
  return "data:image/png;base64," + base64(png);
}

std::string webp_address(std::span<const std::uint8_t> webp) {
  return "data:image/webp;base64," + base64(webp);
}

std::string table_head(const std::vector<std::string>& columns, std::size_t numbers_from) {
  std::string out = "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t i = 0; i < columns.size(); ++i)
    out += (i < numbers_from ? "<th>" : "<th class=\"number\">") + escaped(columns[i]) + "</th>";
  return out + "</tr></thead><tbody>\n";
}

std::string cell(const std::string& text, const std::string& css_class) {
  return (css_class.empty() ? "<td>" : "<td class=\"" + escaped(css_class) + "\">") + escaped(text) + "</td>";
}

}  // namespace tumble::tools::html
