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

/// Reads a file and returns its text. Throws BadInput if the file cannot be read or exceeds 4 MiB.
std::string read_text_file(const std::filesystem::path& path);

/// YamlNode is a YAML node with its location in the file. Each error is a BadInput with a one-line message: "FILE:LINE:
/// PLACE: what". YamlNode rejects some valid YAML: repeated keys, keys that are not text, and a second document.
class YamlNode {
 public:
  /// Parses a YAML text with one document and returns the root node. Error messages start with `file`.
  static YamlNode parse(const std::string& text, const std::string& file);

  int line() const { return line_; }  ///< starts at 1
  const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& what) const;

  bool is_scalar() const { return node_.IsScalar(); }
  bool is_map() const { return node_.IsMap(); }

  /// Returns the value as text; the value must be a non-empty scalar.
  std::string text() const;
  /// Returns the value as text; the value must be a scalar, possibly empty.
  std::string any_text() const;
  /// Returns the value as an identifier: a lower-case letter followed by lower-case letters, digits and underscores; at
  /// most 100 characters.
  std::string identifier() const;
  /// Returns the value as a finite number; quoted text is an error.
  double number() const;
  /// Returns the value as a number, which may be `.inf` or `-.inf`.
  double number_or_infinity() const;
  std::uint64_t unsigned_integer() const;
  std::vector<YamlNode> items() const;
  /// Returns the entries of a YAML map in the order of the file.
  std::vector<std::pair<std::string, YamlNode>> entries() const;
  /// Returns the entries of a YAML map by key. The map must contain all keys in `required` and may contain the keys in
  /// `optional`.
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

/// Suggests a known name: returns "; did you mean 'slope_rad'?" if a known name is similar, and otherwise a list of the
/// known names.
std::string suggestion(const std::string& name, std::span<const std::string> known);

}  // namespace tumble::scenarios
