// SPDX-License-Identifier: BSD-3-Clause
// Each number of a `Params` struct of the estimator must be a field (tumble/common/parameters.hpp), because other
// numbers have no bounds and cannot be set.
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace {

std::string code_of(const fs::path& file) {
  return std::regex_replace(tumble::test::read_file(file), std::regex("//[^\n]*"), "");
}

/// Returns the text between the brace at or after `from` and its closing brace.
std::string braced(const std::string& text, std::size_t from) {
  const std::size_t open = text.find('{', from);
  std::size_t at = open, depth = 0;
  do {
    if (text[at] == '{') ++depth;
    if (text[at] == '}') --depth;
  } while (depth > 0 && ++at < text.size());
  return text.substr(open + 1, at - open - 1);
}

/// Returns the bodies of the structs whose heads match.
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

/// Returns the bodies of the structs that declare `fields`.
std::vector<std::string> params_in(const std::string& header) {
  std::vector<std::string> out = structs_in(header, R"(struct \w+ \{)");
  std::erase_if(out, [](const std::string& body) { return !has_fields(body); });
  return out;
}

/// Returns the members of a struct that are numbers.
std::set<std::string> numbers_in(const std::string& body) {
  static const std::regex member(R"(^\s*(?:double|int|bool|std::size_t|Eigen::Vector3d) ([^;]*?)(?:\{[^;]*)?;)"),
      name(R"((?:^|,\s*)(\w+)\s*(?==|$|,))");
  std::set<std::string> out;
  // a declaration on several lines counts as one
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

/// Returns the numbers of the struct that its `fields` omits.
std::vector<std::string> forgotten(const std::string& body) {
  std::vector<std::string> out;
  for (const std::string& number : numbers_in(body)) {
    if (!std::regex_search(body, std::regex("visit\\(\\s*p\\." + number + "\\b"))) out.push_back(number);
  }
  return out;
}

std::vector<fs::path> headers_with_params() {
  std::vector<fs::path> out;
  for (const char* folder : {"estimator/include", "estimator/src", "scenarios/baselines"})
    for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / folder))
      if (entry.path().extension() == ".hpp") out.push_back(entry.path());
  return out;
}

TEST(Fields, NameEachNumberOfAParams) {
  std::size_t structs = 0, numbers = 0;
  for (const fs::path& header_path : headers_with_params()) {
    const std::string header = code_of(header_path);
    for (const std::string& body : params_in(header)) {
      for (const std::string& number : forgotten(body)) {
        ADD_FAILURE() << header_path.string() << ": " << number << " is no field";
      }
      ++structs;
      numbers += numbers_in(body).size();
    }
  }
  EXPECT_GT(structs, 30u);
  EXPECT_GT(numbers, 150u);
}

/// These Params are not set by users of a method (checked by hand); they are derived from structs that have the fields.
const std::set<std::string> kDerived = {"hand_held_model.hpp", "registration.hpp", "rigid_odometry.hpp"};

TEST(Fields, EveryParamsHasThem) {
  std::set<std::string> without;
  for (const fs::path& header : headers_with_params()) {
    for (const std::string& body : structs_in(code_of(header), R"(struct \w*Params \{)")) {
      if (!has_fields(body) && !numbers_in(body).empty()) without.insert(header.filename().string());
    }
  }
  EXPECT_EQ(without, kDerived);
}

/// Counts fields and groups of a struct, except those under its `expert` member, which holds rarely used fields.
std::size_t own_options(const std::string& body) {
  static const std::regex visited(R"re(visit(?:\.group)?\(\s*(?:"[^"]*",\s*)?p\.(?!expert\b))re");
  return static_cast<std::size_t>(std::distance(std::sregex_iterator(body.begin(), body.end(), visited), {}));
}

/// Returns the structs with fields that a public header offers to users.
std::vector<std::string> offered_in(const std::string& header) {
  std::vector<std::string> out = structs_in(header, R"(struct (?!\w*Expert(?:Params)? \{)\w+ \{)");
  std::erase_if(out, [](const std::string& body) { return !has_fields(body); });
  return out;
}

TEST(Fields, OfAPublicParamsAreTenAtMostBesideExpert) {
  std::size_t offered = 0, with_expert = 0;
  const fs::path library = tumble::test::source_dir() / "estimator/include";
  for (const fs::path& header : headers_with_params()) {
    const bool is_public = header.string().starts_with(library.string()) && header.parent_path().filename() != "detail";
    if (!is_public) continue;
    for (const std::string& body : offered_in(code_of(header))) {
      EXPECT_LE(own_options(body), 10u) << header;
      ++offered;
      with_expert += body.find("HeapValue<Expert> expert") != std::string::npos ? 1 : 0;
    }
  }
  EXPECT_GT(offered, 5u);
  EXPECT_EQ(with_expert, 2u) << "those of the two public classes";
  // negative controls
  std::string visits = "static void fields(Self& p, Visitor& visit) {\n";
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h", "i"})
    visits += std::string("visit(p.") + name + "_m, {\"" + name + "_m\", \"m\", 0.0, 1.0, \"a length\"});\n";
  visits += "visit.group(\"rest_\", p.rest);\n";
  EXPECT_EQ(own_options(visits + "visit.group(\"\", p.expert);"), 10u);
  EXPECT_EQ(own_options(visits + "visit(\n p.k_m, {\"k_m\", \"m\", 0.0, 1.0, \"a length\"});"), 11u);
  EXPECT_EQ(offered_in("struct AParams {" + visits + "} };").size(), 1u);
  EXPECT_EQ(offered_in("struct AExpertParams {" + visits + "} };").size(), 0u);
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
  EXPECT_EQ(forgotten(body), (std::vector<std::string>{"count", "upper_m"}));
  EXPECT_TRUE(params_in("struct State { double tau_s = 1.0; };").empty());
}

}  // namespace
