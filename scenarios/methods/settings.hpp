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
#include "tumble/common/parameters.hpp"

/// Settings makes the fields of a `Params` struct available as method parameters that a user sets by name
/// (common/parameters.hpp).
namespace tumble::scenarios {

namespace detail {

std::array<std::string, 3> coordinate_names(const std::string& name, const ParameterInfo& field);

template <class Params, class Each>
void visit_numbers(Params& params, Each each) {
  for_each_parameter(params, [&each](const std::string& name, auto& value, const ParameterInfo& field) {
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
  /// `stated` contains the names of fields whose values come from the recording unless the user sets them; a name may
  /// end in the wildcard `*`.
  std::vector<std::string> stated = {};
  /// `fixed` contains the names of fields that users cannot set, because the fields follow from other parameters; a
  /// name may end in the wildcard `*`.
  std::vector<std::string> fixed = {};
  std::vector<std::string> first = {};
  /// `beside` contains the parameters of another stage of the same method. A field whose name also occurs in `beside`
  /// gets `prefix` before its name.
  std::span<const sim::Parameter> beside = {};
  std::string prefix = {};
};

class SettingsTable {
 public:
  virtual ~SettingsTable() = default;
  SettingsTable(const SettingsTable&) = delete;
  SettingsTable& operator=(const SettingsTable&) = delete;

  /// Returns the parameters of a method; frequently used parameters come first.
  std::span<const sim::Parameter> rows() const { return rows_; }
  std::size_t first_rows() const { return first_rows_; }
  bool is_whole(std::string_view name) const { return whole_.contains(name); }
  bool is_stated(std::string_view name) const { return stated_.contains(name); }
  virtual std::map<std::string, double> numbers(const sim::Values& values) const = 0;

 protected:
  explicit SettingsTable(SettingsOptions options);
  void add(const std::string& field_name, double value, const ParameterInfo& field, bool whole);
  void sort_rows();
  bool applies(const std::string& field_name, const sim::Values& values, std::string& name) const;

 private:
  std::string name_of(const std::string& field_name) const;

  SettingsOptions options_;
  std::vector<sim::Parameter> rows_;
  std::size_t first_rows_ = 0;
  std::set<std::string_view> first_, whole_, stated_;
  std::deque<std::string> texts_;  ///< storage of the texts
};

sim::Values resolve_settings(const std::string& place, const sim::Values& given,
                             std::span<const SettingsTable* const> stages);

std::vector<sim::Parameter> joined_rows(std::span<const SettingsTable* const> stages, std::size_t& first);

/// A Settings object must be static, because methods keep pointers to it.
template <class Params>
class Settings : public SettingsTable {
 public:
  explicit Settings(const Params& defaults, SettingsOptions options = {})
      : SettingsTable(std::move(options)), defaults_(defaults) {
    detail::visit_numbers(defaults_, [this](const std::string& name, const auto& value, const ParameterInfo& field,
                                            bool whole) { add(name, static_cast<double>(value), field, whole); });
    sort_rows();
  }
  const Params& defaults() const { return defaults_; }

  void apply(const sim::Values& values, Params& params) const {
    detail::visit_numbers(params, [&](const std::string& field_name, auto& value, const ParameterInfo&, bool) {
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
    detail::visit_numbers(params, [&](const std::string& name, const auto& value, const ParameterInfo&, bool) {
      out[name] = static_cast<double>(value);
    });
    return out;
  }

 private:
  Params defaults_;
};

template <class Params>
const Settings<Params>& default_settings() {
  static const Settings<Params> all(Params{});
  return all;
}

}  // namespace tumble::scenarios
