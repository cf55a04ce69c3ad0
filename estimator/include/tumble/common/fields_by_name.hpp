// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "tumble/common/parameters.hpp"

namespace tumble {

namespace detail {

/// Prepends the prefixes of nested groups to each parameter's name.
template <class Each>
class PrefixedNameVisitor {
 public:
  explicit PrefixedNameVisitor(Each& each) : callback_(each) {}

  template <class T>
  void operator()(T& value, const Field& field) {
    callback_(prefix_ + field.name, value, field);
  }
  template <class Params>
  void group(const char* prefix, Params& params) {
    const std::string outer = prefix_;
    prefix_ += prefix;
    std::remove_cv_t<Params>::fields(params, *this);
    prefix_ = outer;
  }

 private:
  Each& callback_;
  std::string prefix_;
};

}  // namespace detail

/// Calls `each(name, value, field)` for each parameter in the struct `params`, in order of declaration. `name` is a
/// std::string that starts with the prefixes of the parameter's groups.
template <class Params, class Each>
void visit_by_name(Params& params, Each each) {
  detail::PrefixedNameVisitor<Each> visitor(each);
  std::remove_cv_t<Params>::fields(params, visitor);
}

/// Returns true if `name` equals one of `patterns`. A pattern that ends in '*' matches every name with that prefix.
template <class Text>
bool matches_any(std::string_view name, std::span<const Text> patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](std::string_view pattern) {
    if (!pattern.ends_with('*')) return name == pattern;
    return name.starts_with(pattern.substr(0, pattern.size() - 1));
  });
}

}  // namespace tumble
