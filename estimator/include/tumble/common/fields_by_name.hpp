// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "tumble/common/parameters.hpp"

/// The fields of a `Params` by the names that a user writes: what a command line, a table and keywords of Python know.
namespace tumble {

namespace detail {

/// Carries the prefixes of the groups about a field.
template <class Each>
class ByWholeName {
 public:
  explicit ByWholeName(Each& each) : each_(each) {}

  template <class T>
  void operator()(T& value, const Field& field) {
    each_(prefix_ + field.name, value, field);
  }
  template <class Params>
  void group(const char* prefix, Params& params) {
    const std::string outer = prefix_;
    prefix_ += prefix;
    std::remove_cv_t<Params>::fields(params, *this);
    prefix_ = outer;
  }

 private:
  Each& each_;
  std::string prefix_;
};

}  // namespace detail

/// Calls `each(name, value, field)` for each field of `params`, const or not, in order: a number (`Number`) or a whole
/// Vector3d. `name`, a std::string, begins with the prefixes of the groups about the field.
template <class Params, class Each>
void visit_by_name(Params& params, Each each) {
  detail::ByWholeName<Each> visitor(each);
  std::remove_cv_t<Params>::fields(params, visitor);
}

/// Whether a name is one of `patterns`: equal, or begins as one that ends in '*'.
template <class Text>
bool is_among(std::string_view name, std::span<const Text> patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](std::string_view pattern) {
    if (!pattern.ends_with('*')) return name == pattern;
    return name.starts_with(pattern.substr(0, pattern.size() - 1));
  });
}

}  // namespace tumble
