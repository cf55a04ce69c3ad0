// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tumble::sim {

/// Parameter is a number that the user can set. A switch is a parameter with the values 0 (off) and 1 (on).
struct Parameter {
  std::string_view name;  ///< name with the unit as suffix, for example "slope_rad"
  double default_value;
  double low;
  double high;
  std::string_view unit;  ///< "1" if dimensionless
  std::string_view doc;   ///< meaning and source, one sentence
};

template <std::size_t M, std::size_t N>
constexpr std::array<Parameter, M + N> joined(const std::array<Parameter, M>& first,
                                              const std::array<Parameter, N>& second) {
  std::array<Parameter, M + N> all{};
  for (std::size_t i = 0; i < M; ++i) all[i] = first[i];
  for (std::size_t i = 0; i < N; ++i) all[M + i] = second[i];
  return all;
}

class InvalidSituation : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Values {
 public:
  void set(const std::string& name, double value) { numbers_[name] = value; }
  bool has(const std::string& name) const { return numbers_.contains(name); }
  double at(std::string_view name) const;
  const std::map<std::string, double>& all() const { return numbers_; }
  bool operator==(const Values&) const = default;

 private:
  std::map<std::string, double> numbers_;
};

Values resolve(const std::string& place, const Values& given, std::span<const Parameter> known);

/// Returns a hint such as "did you mean 'a' or 'b'?", or an empty text if no known name is similar. The candidates are
/// up to three known names that start with `name`. If no known name starts with `name`, the candidate is the known name
/// with the smallest edit distance. Letter case is ignored.
std::string did_you_mean(std::string_view name, std::span<const std::string> known);

struct ComponentType {
  std::string name;
  std::string doc;
  std::span<const Parameter> parameters;
};

struct Component {
  std::string type;
  Values values;
  bool operator==(const Component&) const = default;
};

}  // namespace tumble::sim
