// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "sim/parameters.hpp"
#include "tumble/common/fields_by_name.hpp"
#include "tumble/common/parameters.hpp"

/// The templates in settings.hpp convert the `Params` struct of a library class to the parameters of a method. The
/// templates use only the descriptions of the struct's fields (common/parameters.hpp), like tables, parsing and tests.
namespace tumble::scenarios {

namespace detail {

/// Returns the names of a vector's coordinates; the axis comes before the unit: "lever_arm_x_m".
std::array<std::string, 3> coordinate_names(const std::string& name, const Field& field);

/// Calls `each(name, value, field, whole)` for each number in a `Params` struct; a vector has three numbers.
template <class Params, class Each>
void visit_numbers(Params& params, Each each) {
  visit_by_name(params, [&each](const std::string& name, auto& value, const Field& field) {
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, Eigen::Vector3d>) {
      const std::array<std::string, 3> names = coordinate_names(name, field);
      for (int j = 0; j < 3; ++j) each(names[static_cast<std::size_t>(j)], value[j], field, false);
    } else {
      each(name, value, field, !std::is_floating_point_v<Value>);
    }
  });
}

}  // namespace detail

/// SettingsOptions lists the fields of a `Params` struct that a method treats specially.
struct SettingsOptions {
  /// Fields whose values come from the recording, unless the user sets them; a name may end in `*`.
  std::vector<std::string> stated = {};
  /// Fields that follow from other parameters, so users cannot set them; a name may end in `*`.
  std::vector<std::string> fixed = {};
  /// Fields that are first in the list of parameters.
  std::vector<std::string> first = {};
  /// Parameters of another stage of the method. A field with the same name as a parameter of that stage gets `prefix`
  /// before its name.
  std::span<const sim::Parameter> beside = {};
  std::string prefix = {};
};

/// SettingsTable contains the names, descriptions and values of a method's parameters. SettingsTable is the base class
/// of all Settings and does not depend on the `Params` type.
class SettingsTable {
 public:
  virtual ~SettingsTable() = default;
  SettingsTable(const SettingsTable&) = delete;
  SettingsTable& operator=(const SettingsTable&) = delete;

  /// Returns the descriptions of the parameters, frequently used parameters first.
  std::span<const sim::Parameter> rows() const { return rows_; }
  std::size_t first_rows() const { return first_rows_; }
  /// Returns true if a parameter must be an integer: a count, a switch or a choice.
  bool is_whole(std::string_view name) const { return whole_.contains(name); }
  /// Returns true if the value comes from the recording, unless the user sets it.
  bool is_stated(std::string_view name) const { return stated_.contains(name); }
  /// Returns every number of the `Params` struct after applying `values`, by its name in the library.
  virtual std::map<std::string, double> numbers(const sim::Values& values) const = 0;

 protected:
  explicit SettingsTable(SettingsOptions options);
  void add(const std::string& field_name, double value, const Field& field, bool whole);
  void sort_rows();
  /// Returns true if `values` contains the field, and writes the parameter's name to `name`.
  bool applies(const std::string& field_name, const sim::Values& values, std::string& name) const;

 private:
  std::string name_of(const std::string& field_name) const;

  SettingsOptions options_;
  std::vector<sim::Parameter> rows_;
  std::size_t first_rows_ = 0;
  std::set<std::string_view> first_, whole_, stated_;
  std::deque<std::string> texts_;  ///< owns the texts to which the other members refer
};

/// Determines the values of all parameters of a method's stages, as sim::resolve does. Parameters with a value in the
/// recording are omitted unless the user sets them. Throws InvalidSituation like sim::resolve, and also for a fraction
/// where an integer is required.
sim::Values resolve_settings(const std::string& place, const sim::Values& given,
                             std::span<const SettingsTable* const> stages);

/// Returns the parameter descriptions of several stages, whose names must differ. Frequently used parameters come
/// first; `first` receives their number.
std::vector<sim::Parameter> joined_rows(std::span<const SettingsTable* const> stages, std::size_t& first);

/// Settings contains the parameters of one stage of a method. A Settings object must be static, because methods refer
/// to it.
template <class Params>
class Settings : public SettingsTable {
 public:
  /// `defaults` contains the default values of the method.
  explicit Settings(const Params& defaults, SettingsOptions options = {})
      : SettingsTable(std::move(options)), defaults_(defaults) {
    detail::visit_numbers(defaults_, [this](const std::string& name, const auto& value, const Field& field,
                                            bool whole) { add(name, static_cast<double>(value), field, whole); });
    sort_rows();
  }
  const Params& defaults() const { return defaults_; }

  /// Copies the values to the fields of `params`. A field whose value comes from the recording keeps its value unless
  /// the user set it.
  void apply(const sim::Values& values, Params& params) const {
    detail::visit_numbers(params, [&](const std::string& field_name, auto& value, const Field&, bool) {
      using Value = std::remove_cvref_t<decltype(value)>;
      std::string name;
      if (!applies(field_name, values, name)) return;
      if constexpr (std::is_enum_v<Value> || std::is_integral_v<Value>) {
        value = static_cast<Value>(std::llround(values.at(name)));
      } else {
        value = values.at(name);
      }
    });
  }

  /// Returns the default parameters, overridden by `values`.
  Params read(const sim::Values& values) const {
    Params params = defaults_;
    apply(values, params);
    return params;
  }

  std::map<std::string, double> numbers(const sim::Values& values) const override {
    std::map<std::string, double> out;
    const Params params = read(values);
    detail::visit_numbers(params, [&](const std::string& name, const auto& value, const Field&, bool) {
      out[name] = static_cast<double>(value);
    });
    return out;
  }

 private:
  Params defaults_;
};

}  // namespace tumble::scenarios
