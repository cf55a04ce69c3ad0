// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <type_traits>

#include "state_visitor.hpp"
#include "tumble/common/parameters.hpp"

/// state_params.hpp visits a `Params` structure that is part of a saved state (see state_visitor.hpp).
namespace tumble {

namespace detail {

/// FieldsAsMembers passes the fields of a `Params` structure to a StateVisitor.
template <class Visitor>
class FieldsAsMembers {
 public:
  explicit FieldsAsMembers(Visitor& visit) : visit_(visit) {}
  template <class T>
  void operator()(T& value, const Field& field) {
    using V = std::remove_const_t<T>;
    if constexpr (std::is_enum_v<V>) {
      visit_(field.name, value, static_cast<V>(static_cast<int>(field.high)));
    } else {
      visit_(field.name, value);
    }
  }
  template <class Params>
  void group(const char* /*prefix*/, Params& params) {
    std::remove_const_t<Params>::fields(params, *this);
  }

 private:
  Visitor& visit_;
};

}  // namespace detail

/// Visits all members of a `Params` structure: its Fields and its other members.
template <class Params, class Visitor>
void visit_params(Params& params, Visitor& visit) {
  detail::FieldsAsMembers<Visitor> fields(visit);
  std::remove_const_t<Params>::fields(params, fields);
  if constexpr (requires { others(params, visit); }) others(params, visit);
}

}  // namespace tumble
