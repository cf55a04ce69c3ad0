// SPDX-License-Identifier: BSD-3-Clause
#include "stand_ins/short_scenario.hpp"

#include <fstream>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/tree.hpp"

namespace tumble::test {

namespace {

/// A Replaced lists texts of the catalogue and the texts that replace them.
using Replaced = std::vector<std::pair<std::string, std::string>>;

const Replaced& replaced_in(const std::string& name) {
  static const std::pair<std::string, std::string> rest = {"rest_s: {uniform: [1.5, 2.0]}", "rest_s: 0.8"};
  static const std::map<std::string, Replaced> all = {
      {"hill", {{"duration_s: 10\n", "duration_s: 4\n"}, rest}},
      {"stroll", {{"duration_s: 20\n", "duration_s: 6\n"}, rest}},
      {"roll",
       {{"duration_s: 14.5\n", "duration_s: 5\n"},
        rest,
        {"shape: {choice: [0, 1, 1, 2, 3]}", "shape: 0"},
        {"length_m: {uniform: [2.0, 6.0]}", "length_m: {uniform: [1.2, 1.6]}"}}}};
  const auto found = all.find(name);
  if (found == all.end()) throw std::runtime_error("no short scenario '" + name + "'");
  return found->second;
}

}  // namespace

std::filesystem::path write_short_scenario(const std::string& name, const std::filesystem::path& folder) {
  const std::filesystem::path catalogue = source_dir() / "scenarios" / "catalogue" / (name + ".yaml");
  std::ifstream stream(catalogue, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  for (const auto& [from, to] : replaced_in(name)) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::runtime_error(catalogue.string() + ": says no '" + from + "'");
    text.replace(at, from.size(), to);
  }
  std::filesystem::path file = folder / (name + ".yaml");
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

// the files are copies: links would make their digest depend on their location
std::filesystem::path write_short_data(const std::filesystem::path& folder) {
  constexpr auto kAll = std::filesystem::copy_options::recursive;
  std::filesystem::copy(source_dir() / "models", folder / "models", kAll);
  std::filesystem::create_directory(folder / "scenarios");
  for (const char* name : {"catalogue", "suites", "gates", "regressions"})
    std::filesystem::copy(source_dir() / "scenarios" / name, folder / "scenarios" / name, kAll);
  for (const char* name : {"hill", "roll"}) write_short_scenario(name, folder / "scenarios" / "catalogue");
  return folder;
}

}  // namespace tumble::test
