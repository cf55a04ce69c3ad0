// SPDX-License-Identifier: BSD-3-Clause
#include "parameters.hpp"

#include <nanobind/stl/string.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "arrays.hpp"
#include "trouble.hpp"

namespace tumble::python {

namespace {

/// kListedMax is the maximum number of keywords that an error message lists.
constexpr std::size_t kListedMax = 12;

std::string bounds_text(const ParameterInfo& field) {
  const nb::object text = nb::str("within [{:g}, {:g}]").attr("format")(field.low, field.high);
  return nb::cast<std::string>(text);
}

void require_within_field(const std::string& name, const ParameterInfo& field, double value) {
  if (value >= field.low && value <= field.high) return;  // false for NaN
  raise_input("out_of_range", name, nb::float_(value), nb::str(bounds_text(field).c_str()));
}

/// Returns the Levenshtein distance of two names.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t corner = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = corner + (a[i - 1] == b[j - 1] ? 0 : 1);
      corner = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

nb::object Keywords::take(const std::string& name) {
  if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.push_back(name);
  const nb::str key(name.c_str());
  return given_.contains(key) ? nb::object(given_[key]) : nb::object();
}

nb::object Keywords::need(const std::string& name) {
  nb::object value = take(name);
  if (!value.is_valid()) raise_input("empty", name, nb::none(), nb::str("given, because it has no default"));
  return value;
}

void Keywords::read(const std::string& name, const ParameterInfo& field, bool whole, double& out) {
  const nb::object given = take(name);
  if (!given.is_valid()) return;
  const double value = number_of(given, name);
  if (whole && value != std::floor(value)) raise_input("out_of_range", name, given, nb::str("a whole number"));
  require_within_field(name, field, value);
  out = value;
}

void Keywords::read(const std::string& name, const ParameterInfo& field, Eigen::Vector3d& out) {
  const nb::object given = take(name);
  if (!given.is_valid()) return;
  const Eigen::Vector3d value = vector_of(given, name);
  for (const double coordinate : value) require_within_field(name, field, coordinate);
  out = value;
}

void Keywords::done() const {
  for (const auto [key, value] : given_) {
    const std::string name = nb::cast<std::string>(key);
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const auto nearer = [&](const std::string& a, const std::string& b) {
      return distance(a, name) < distance(b, name);
    };
    std::string text = "one of the " + std::to_string(known_.size()) + " keywords of " + of_;
    if (!known_.empty()) text += " (nearest: " + *std::min_element(known_.begin(), known_.end(), nearer) + ")";
    for (std::size_t k = 0; k < known_.size() && known_.size() <= kListedMax; ++k)
      text += (k == 0 ? ": " : ", ") + known_[k];
    raise_input("unknown", "keyword", nb::str(name.c_str()), nb::str(text.c_str()));
  }
}

nb::object as_object(const Eigen::Vector3d& value) {
  return nb::make_tuple(value.x(), value.y(), value.z());
}

void bind_parameter(nb::module_& m) {
  nb::class_<Parameter>(
      m, "Parameter",
      "A parameter of a class, which its constructor accepts as a keyword. `parameters()` of the class lists them.")
      .def_ro("name", &Parameter::name)
      .def_ro("unit", &Parameter::unit, "\"1\" if dimensionless")
      .def_ro("default", &Parameter::value,
              nb::for_getter(nb::sig("def default(self) -> bool | int | float | tuple[float, float, float]")))
      .def_ro("low", &Parameter::low, "smallest allowed value; for a vector, of each coordinate")
      .def_ro("high", &Parameter::high, "largest allowed value")
      .def_ro("meaning", &Parameter::meaning)
      .def_ro("first", &Parameter::first, "True for the basic parameters, which a user should set before all others")
      .def(
          "__repr__",
          [](const Parameter& p) {
            return nb::str("{} = {} [{}] within [{:g}, {:g}]: {}")
                .attr("format")(p.name, p.value, p.unit, p.low, p.high, p.meaning);
          },
          nb::sig("def __repr__(self) -> str"));
}

}  // namespace tumble::python
