// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

class JsonMembers {
 public:
  JsonMembers(const std::filesystem::path& path, const nlohmann::json& object) : path_(path), object_(object) {}

  const nlohmann::json& member(const char* key) const {
    if (!object_.is_object() || !object_.contains(key)) throw BadInput(path_.string() + ": '" + key + "' is missing");
    return object_.at(key);
  }
  std::string text(const char* key) const {
    const nlohmann::json& found = member(key);
    if (!found.is_string()) complain(key, "text");
    return found.get<std::string>();
  }
  const nlohmann::json& object(const char* key) const {
    const nlohmann::json& found = member(key);
    if (!found.is_object()) complain(key, "an object");
    return found;
  }
  template <typename Enum>
  Enum named(const char* key, Enum last) const {
    const std::string name = text(key);
    std::string known;
    for (int k = 0; k <= static_cast<int>(last); ++k) {
      const char* const each = to_string(static_cast<Enum>(k));
      if (name == each) return static_cast<Enum>(k);
      known += (known.empty() ? "" : ", ") + std::string(each);
    }
    complain(key, "one of " + known);
  }
  [[noreturn]] void complain(const char* key, const std::string& wanted) const {
    throw BadInput(path_.string() + ": '" + key + "' is " + shortened(member(key).dump()) + "; it must be " + wanted);
  }

 private:
  const std::filesystem::path& path_;
  const nlohmann::json& object_;
};

}  // namespace tumble::scenarios
