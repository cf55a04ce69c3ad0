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

/// The numbers of a library's `Params` as parameters of a method: what its fields say of them (common/parameters.hpp)
/// is all that the method's table, its reading and its tests know.
namespace tumble::scenarios {

namespace detail {

/// Names of a vector's coordinates: the axis stands before the unit, "lever_arm_x_m".
std::array<std::string, 3> coordinate_names(const std::string& name, const Field& field);

/// Calls `each(name, value, field, whole)` for each number of a `Params`, a vector being three of them.
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

/// Which fields of a `Params` a method treats apart.
struct SettingsOptions {
  /// What the recording states: a value takes precedence over it only when somebody chose it. A name may end in `*`.
  std::vector<std::string> stated = {};
  /// What follows from other parameters and cannot be set. A name may end in `*`.
  std::vector<std::string> fixed = {};
  /// What this method's user sets before others although it stands further down elsewhere.
  std::vector<std::string> first = {};
  /// Another stage's parameters: a field that is called as one of them bears `prefix`.
  std::span<const sim::Parameter> beside = {};
  std::string prefix = {};
};

/// Names, rows and values without their type: what all Settings share.
class SettingsTable {
 public:
  virtual ~SettingsTable() = default;
  SettingsTable(const SettingsTable&) = delete;
  SettingsTable& operator=(const SettingsTable&) = delete;

  /// Those that a user sets before others stand first.
  std::span<const sim::Parameter> rows() const { return rows_; }
  std::size_t first_rows() const { return first_rows_; }
  /// Whether there are no halves of a parameter: a number of things, a switch, a choice.
  bool is_whole(std::string_view name) const { return whole_.contains(name); }
  /// Whether a recording states it, so that only a value that somebody gave counts.
  bool is_stated(std::string_view name) const { return stated_.contains(name); }
  /// Every number of the `Params`, by the library's names, as read from `values`.
  virtual std::map<std::string, double> numbers(const sim::Values& values) const = 0;

 protected:
  explicit SettingsTable(SettingsOptions options);
  void add(const std::string& field_name, double value, const Field& field, bool whole);
  /// Those that a user sets first stand first.
  void sort_rows();
  /// Whether the value of a field is to be taken from `values`, and its name there.
  bool applies(const std::string& field_name, const sim::Values& values, std::string& name) const;

 private:
  std::string name_of(const std::string& field_name) const;

  SettingsOptions options_;
  std::vector<sim::Parameter> rows_;
  std::size_t first_rows_ = 0;
  std::set<std::string_view> first_, whole_, stated_;
  std::deque<std::string> texts_;  ///< what all of these refer to
};

/// Values for all `rows` of the stages, as sim::resolve gives them; without those that a recording states and nobody
/// gave. Throws InvalidSituation as it does, and for halves of what is whole.
sim::Values resolve_settings(const std::string& place, const sim::Values& given,
                             std::span<const SettingsTable* const> stages);

/// The rows of several stages, whose names differ: first those that a user sets before others, so many in `first`.
std::vector<sim::Parameter> joined_rows(std::span<const SettingsTable* const> stages, std::size_t& first);

/// The parameters of one stage of a method. Static, as its rows are referred to.
template <class Params>
class Settings : public SettingsTable {
 public:
  /// `defaults` are the library's but for what the method states otherwise.
  explicit Settings(const Params& defaults, SettingsOptions options = {})
      : SettingsTable(std::move(options)), defaults_(defaults) {
    detail::visit_numbers(defaults_, [this](const std::string& name, const auto& value, const Field& field,
                                            bool whole) { add(name, static_cast<double>(value), field, whole); });
    sort_rows();
  }
  const Params& defaults() const { return defaults_; }

  /// Puts the values into `params`; what the recording states and nobody chose stays as it is.
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

  /// The values alone, in place of the defaults.
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
