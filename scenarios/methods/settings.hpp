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

/// Settings converts the `Params` struct of a library class to the parameters of a method, by the descriptions of the
/// struct's fields (common/parameters.hpp).
namespace tumble::scenarios {

namespace detail {

/// The axis comes before the unit: "lever_arm_x_m".
std::array<std::string, 3> coordinate_names(const std::string& name, const Field& field);

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

struct SettingsOptions {
  /// The recording contains the values of these fields, unless the user sets them; a name may end in `*`.
  std::vector<std::string> stated = {};
  /// Users cannot set these fields, because they follow from other parameters; a name may end in `*`.
  std::vector<std::string> fixed = {};
  std::vector<std::string> first = {};
  /// A field with the same name as a parameter of another stage gets `prefix` before its name.
  std::span<const sim::Parameter> beside = {};
  std::string prefix = {};
};

/// SettingsTable is the base class of all Settings and does not depend on the `Params` type.
class SettingsTable {
 public:
  virtual ~SettingsTable() = default;
  SettingsTable(const SettingsTable&) = delete;
  SettingsTable& operator=(const SettingsTable&) = delete;

  /// Frequently used parameters come first.
  std::span<const sim::Parameter> rows() const { return rows_; }
  std::size_t first_rows() const { return first_rows_; }
  bool is_whole(std::string_view name) const { return whole_.contains(name); }
  bool is_stated(std::string_view name) const { return stated_.contains(name); }
  /// Returns every number of the `Params` struct after applying `values`, by its name in the library.
  virtual std::map<std::string, double> numbers(const sim::Values& values) const = 0;

 protected:
  explicit SettingsTable(SettingsOptions options);
  void add(const std::string& field_name, double value, const Field& field, bool whole);
  void sort_rows();
  bool applies(const std::string& field_name, const sim::Values& values, std::string& name) const;

 private:
  std::string name_of(const std::string& field_name) const;

  SettingsOptions options_;
  std::vector<sim::Parameter> rows_;
  std::size_t first_rows_ = 0;
  std::set<std::string_view> first_, whole_, stated_;
  std::deque<std::string> texts_;  ///< owns the texts to which the other members refer
};

/// Parameters with a value in the recording are omitted unless the user sets them. Throws InvalidSituation like
/// sim::resolve, and also for a fraction where an integer is required.
sim::Values resolve_settings(const std::string& place, const sim::Values& given,
                             std::span<const SettingsTable* const> stages);

/// The names of the stages must differ.
std::vector<sim::Parameter> joined_rows(std::span<const SettingsTable* const> stages, std::size_t& first);

/// A Settings object must be static, because methods refer to it.
template <class Params>
class Settings : public SettingsTable {
 public:
  explicit Settings(const Params& defaults, SettingsOptions options = {})
      : SettingsTable(std::move(options)), defaults_(defaults) {
    detail::visit_numbers(defaults_, [this](const std::string& name, const auto& value, const Field& field,
                                            bool whole) { add(name, static_cast<double>(value), field, whole); });
    sort_rows();
  }
  const Params& defaults() const { return defaults_; }

  /// A field whose value comes from the recording keeps its value unless the user set it.
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
