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

std::string read_text_file(const std::filesystem::path& path);

class YamlNode {
 public:
  static YamlNode parse(const std::string& text, const std::string& file);

  int line() const { return line_; }  ///< starts at 1
  const std::string& place() const { return place_; }
  [[noreturn]] void fail(const std::string& what) const;

  bool is_scalar() const { return node_.IsScalar(); }
  bool is_map() const { return node_.IsMap(); }

  std::string text() const;
  std::string any_text() const;
  /// Returns the text as an identifier: a lower-case letter, followed by lower-case letters, digits and underscores,
  /// with at most 100 characters in total.
  std::string identifier() const;
  double number() const;
  double number_or_infinity() const;
  std::uint64_t unsigned_integer() const;
  std::vector<YamlNode> items() const;
  std::vector<std::pair<std::string, YamlNode>> entries() const;
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

std::string suggestion(const std::string& name, std::span<const std::string> known);

}  // namespace tumble::scenarios
