// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nanobind/nanobind.h>

#include <Eigen/Core>
#include <string>
#include <type_traits>
#include <vector>

#include "tumble/common/parameters.hpp"

/// parameters.hpp exposes the fields of a `Params` structure as Python keywords. The field descriptions come from
/// common/parameters.hpp.
namespace tumble::python {

namespace nb = nanobind;

/// Parameter describes one field of a `Params` structure. The Python function `parameters()` of a class lists its
/// parameters.
struct Parameter {
  std::string name, unit;
  nb::object value;  ///< the default
  double low, high;
  std::string meaning;
  bool first;  ///< true: a user should set this parameter before the others
};

/// Returns the stub signature of a constructor that accepts Keywords.
inline nb::sig takes_options() {
  return {"def __init__(self, **options: object) -> None"};
}

/// Keywords holds the keyword arguments of a constructor. take(), need() and read() mark a name as known; done()
/// rejects unknown names.
class Keywords {
 public:
  /// @param of  name of the class, for error messages
  Keywords(const char* of, const nb::kwargs& given) : of_(of), given_(given) {}

  /// Returns the argument `name`, or an invalid object if it is missing.
  nb::object take(const std::string& name);
  /// Same as take(), but raises TumbleError `empty` if no value is given.
  nb::object need(const std::string& name);
  /// Reads a number and checks the bounds of its field.
  void read(const std::string& name, const ParameterInfo& field, bool whole, double& out);
  void read(const std::string& name, const ParameterInfo& field, Eigen::Vector3d& out);
  /// Raises TumbleError `unknown` for the first unknown keyword. The message names the nearest known keyword, and lists
  /// all known keywords if they are few.
  void done() const;

 private:
  std::string of_;
  const nb::kwargs& given_;
  std::vector<std::string> known_;
};

/// Calls `each(name, value, field)` for each field of `params` except the hidden fields (`matches_any_pattern`). Hidden
/// fields are derived from other fields.
template <class Params, class Each>
void visit_shown(Params& params, const std::vector<const char*>& hidden, Each each) {
  for_each_parameter(params, [&](const std::string& name, auto& value, const ParameterInfo& field) {
    if (!matches_any_pattern<const char*>(name, hidden)) each(name, value, field);
  });
}

/// Reads all given keywords into the fields of `params`.
template <class Params>
void read_fields(Keywords& keywords, Params& params, const std::vector<const char*>& hidden = {}) {
  visit_shown(params, hidden, [&](const std::string& name, auto& value, const ParameterInfo& field) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
      keywords.read(name, field, value);
    } else {
      double number = static_cast<double>(value);
      keywords.read(name, field, !std::is_floating_point_v<Value>, number);
      value = static_cast<Value>(number);
    }
  });
}

nb::object as_object(const Eigen::Vector3d& value);

/// Lists the parameters that `read_fields` accepts, with the defaults of `params`.
template <class Params>
std::vector<Parameter> list_fields(const Params& params, const std::vector<const char*>& hidden = {}) {
  std::vector<Parameter> out;
  visit_shown(params, hidden, [&](const std::string& name, const auto& value, const ParameterInfo& field) {
    using Value = std::remove_cvref_t<decltype(value)>;
    nb::object number;
    if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
      number = as_object(value);
    } else if constexpr (std::is_floating_point_v<Value>) {
      number = nb::float_(value);
    } else if constexpr (std::is_same_v<Value, bool>) {
      number = nb::bool_(value);
    } else {
      number = nb::int_(static_cast<long long>(value));
    }
    out.push_back({name, field.unit, number, field.low, field.high, field.description,
                   field.audience == ParameterAudience::common_use});
  });
  return out;
}

/// Binds Parameter.
void bind_parameter(nb::module_& m);

}  // namespace tumble::python
