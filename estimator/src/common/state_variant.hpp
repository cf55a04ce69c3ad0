// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>

/// state_variant.hpp visits the std::variant members of a saved state (see state_visitor.hpp).
namespace tumble {

/// Visits the index of the alternative that a variant contains, and the members of this alternative.
template <class Variant, class Visitor, std::size_t... Kinds>
void visit_variant(const char* name, Variant& value, Visitor& visit, std::index_sequence<Kinds...>) {
  using V = std::remove_const_t<Variant>;
  std::size_t kind = value.index();
  visit(name, kind, 0.0, double(sizeof...(Kinds) - 1));
  const auto one = [&]<std::size_t Kind>(std::integral_constant<std::size_t, Kind>) {
    if constexpr (Visitor::kDescribes) {
      const std::variant_alternative_t<Kind, V> as_at_the_start{};
      visit(name, as_at_the_start);
    } else if (kind == Kind) {
      if constexpr (Visitor::kReads) value.template emplace<Kind>();
      visit(name, *std::get_if<Kind>(&value));
    }
  };
  (one(std::integral_constant<std::size_t, Kinds>{}), ...);
}
template <class Variant, class Visitor>
void visit_variant(const char* name, Variant& value, Visitor& visit) {
  visit_variant(name, value, visit, std::make_index_sequence<std::variant_size_v<std::remove_const_t<Variant>>>());
}

}  // namespace tumble
