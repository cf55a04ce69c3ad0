// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tumble::scenarios {

/// Text of a file. Throws BadInput when it cannot be read or is larger than 4 MiB (no file of ours is).
std::string read_text_file(const std::filesystem::path& path);

/// A node of a YAML text that knows where it stands. All complaints are BadInput, one line: "FILE:LINE: PLACE: what".
/// Stricter than YAML: a key given twice, a key that is not text, and a second document are refused.
class YamlNode {
 public:
  /// Root of the one document in `text`; `file` begins the messages.
  static YamlNode parse(const std::string& text, const std::string& file);

  int line() const { return line_; }  ///< from 1
  const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& what) const;

  bool is_scalar() const { return node_.IsScalar(); }
  bool is_map() const { return node_.IsMap(); }

  /// A scalar as text, not empty.
  std::string text() const;
  /// A scalar as text, perhaps empty.
  std::string any_text() const;
  /// A scalar that is a lower-case identifier: a letter, then letters, digits and underscores, 100 at most.
  std::string identifier() const;
  /// A finite number, not quoted.
  double number() const;
  /// A number that may also be `.inf` or `-.inf`.
  double number_or_infinity() const;
  std::uint64_t unsigned_integer() const;
  std::vector<YamlNode> items() const;
  /// Of a map, in the order of the file.
  std::vector<std::pair<std::string, YamlNode>> entries() const;
  /// Of a map that has every key of `required` and none outside of `required` and `optional`.
  std::map<std::string, YamlNode> fields(std::span<const std::string> required,
                                         std::span<const std::string> optional = {}) const;

 private:
  YamlNode(const YAML::Node& node, std::string file, std::string place);
  double parse_number(bool infinity_allowed) const;

  YAML::Node node_;
  std::string file_;
  std::string place_;
  int line_ = 0;
};

/// "; did you mean 'slope_rad'?", or the list of known names when none is near.
std::string suggestion(const std::string& name, std::span<const std::string> known);

}  // namespace tumble::scenarios
