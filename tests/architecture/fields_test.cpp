// SPDX-License-Identifier: BSD-3-Clause
// Each number of a `Params` of the estimator is a field of it (tumble/common/parameters.hpp): what is no field has no
// bound, no place in a method's table and no effect on a command line.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tree.hpp"

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return std::regex_replace(out.str(), std::regex("//[^\n]*"), "");
}

/// What stands between the brace at or after `from` and the one that closes it.
std::string braced(const std::string& text, std::size_t from) {
  const std::size_t open = text.find('{', from);
  std::size_t at = open, depth = 0;
  do {
    if (text[at] == '{') ++depth;
    if (text[at] == '}') --depth;
  } while (depth > 0 && ++at < text.size());
  return text.substr(open + 1, at - open - 1);
}

/// Bodies of the structs whose heads match.
std::vector<std::string> structs_in(const std::string& header, const char* head) {
  const std::regex begin(head);
  std::vector<std::string> out;
  for (std::sregex_iterator it(header.begin(), header.end(), begin), end; it != end; ++it)
    out.push_back(braced(header, static_cast<std::size_t>(it->position())));
  return out;
}

bool has_fields(const std::string& body) {
  return body.find("static void fields(") != std::string::npos;
}

/// Bodies of the structs that declare `fields`.
std::vector<std::string> params_in(const std::string& header) {
  std::vector<std::string> out = structs_in(header, R"(struct \w+ \{)");
  std::erase_if(out, [](const std::string& body) { return !has_fields(body); });
  return out;
}

/// Members of a struct that are numbers.
std::set<std::string> numbers_in(const std::string& body) {
  static const std::regex member(R"(^\s*(?:double|int|bool|std::size_t|Eigen::Vector3d) ([^;]*?)(?:\{[^;]*)?;)"),
      name(R"((?:^|,\s*)(\w+)\s*(?==|$|,))");
  std::set<std::string> out;
  // a declaration on several lines is one
  const std::string declared_in = body.substr(0, body.find("template <class Self"));
  std::istringstream lines(std::regex_replace(declared_in, std::regex(",\\s*\n\\s*"), ", "));
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (!std::regex_search(line, found, member)) continue;
    const std::string declared = found[1];
    for (std::sregex_iterator it(declared.begin(), declared.end(), name), end; it != end; ++it) out.insert((*it)[1]);
  }
  return out;
}

/// Numbers of the struct that `fields` does not visit; `visits` is its text.
std::vector<std::string> forgotten(const std::string& body, const std::string& visits) {
  std::vector<std::string> out;
  for (const std::string& number : numbers_in(body)) {
    if (!std::regex_search(visits, std::regex("visit\\(\\s*p\\." + number + "\\b"))) out.push_back(number);
  }
  return out;
}

std::vector<fs::path> headers() {
  std::vector<fs::path> out;
  for (const char* folder : {"estimator/include", "estimator/src", "scenarios/baselines"})
    for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / folder))
      if (entry.path().extension() == ".hpp") out.push_back(entry.path());
  return out;
}

TEST(Fields, NameEachNumberOfAParams) {
  std::size_t structs = 0, numbers = 0;
  for (const fs::path& header_path : headers()) {
    const std::string header = text_of(header_path);
    for (const std::string& body : params_in(header)) {
      fs::path beside = header_path;
      beside.replace_filename(header_path.stem().string() + "_fields.hpp");
      const std::string visits = fs::exists(beside) ? text_of(beside) : body;
      for (const std::string& number : forgotten(body, visits)) {
        ADD_FAILURE() << header_path.string() << ": " << number << " is no field";
      }
      ++structs;
      numbers += numbers_in(body).size();
    }
  }
  EXPECT_GT(structs, 35u);
  EXPECT_GT(numbers, 350u);
}

/// Params that no method's user sets, checked by hand: what others derive them from has the fields.
const std::set<std::string> kDerived = {"carried_model.hpp", "force_errors.hpp", "rate_recovery.hpp"};

TEST(Fields, EveryParamsHasThem) {
  std::set<std::string> without;
  for (const fs::path& header : headers()) {
    for (const std::string& body : structs_in(text_of(header), R"(struct \w*Params \{)")) {
      if (!has_fields(body) && !numbers_in(body).empty()) without.insert(header.filename().string());
    }
  }
  EXPECT_EQ(without, kDerived);
}

/// Whether more than ten numbers stand beside `expert`, where the others belong.
bool crowded(const std::string& body) {
  return std::regex_search(body, std::regex(R"(\bExpert expert\b)")) && numbers_in(body).size() > 10;
}

TEST(Fields, BesideExpertStandTenAtMost) {
  std::size_t with_expert = 0;
  for (const fs::path& header : headers()) {
    for (const std::string& body : params_in(text_of(header))) {
      EXPECT_FALSE(crowded(body)) << header;
      with_expert += body.find("Expert expert") != std::string::npos ? 1 : 0;
    }
  }
  EXPECT_GE(with_expert, 5u);
  // negative control
  std::string body;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"})
    body += std::string("  double ") + name + "_m = 0.0;\n";
  EXPECT_FALSE(crowded(body + "  Expert expert = {};\n"));
  EXPECT_TRUE(crowded(body + "  double k_m = 0.0;\n  Expert expert = {};\n"));
}

TEST(Fields, OneThatIsForgottenIsFound) {
  const std::string header = R"(struct Params {
    double tau_s = 1.0;
    double lower_m = 0.0, upper_m = 5e-3;
    int count = 4;
    bool on = false;
    std::optional<double> stated = {};
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.tau_s, {"tau_s", "s", 0.0, 1.0, "a time"});
      visit(
          p.lower_m, {"lower_m", "m", 0.0, 1.0, "a length"});
      visit(p.on, on_off("on", "a switch"));
    }
  };)";
  ASSERT_EQ(params_in(header).size(), 1u);
  const std::string body = params_in(header).front();
  EXPECT_EQ(numbers_in(body), (std::set<std::string>{"tau_s", "lower_m", "upper_m", "count", "on"}));
  EXPECT_EQ(forgotten(body, body), (std::vector<std::string>{"count", "upper_m"}));
  EXPECT_TRUE(params_in("struct State { double tau_s = 1.0; };").empty());
}

}  // namespace
