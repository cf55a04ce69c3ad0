// SPDX-License-Identifier: BSD-3-Clause
// The test runs a user's Python function and a C program on a small benchmark: page, lines of JSON, and rejected input.
#include <stdlib.h>

#include "system/program.hpp"

namespace tumble::system_test {
namespace {

std::vector<json> lines_of(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (line.starts_with("{\"format\":\"tumble bench\"")) lines.push_back(json::parse(line));
  return lines;
}

class Bench : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("TUMBLE_PYTHON", "/usr/bin/python3", 0);  // tools/setup installs numpy for Debian's interpreter
    std::ofstream(folder_ / "small.yaml") << "name: small\ndoc: two draws\nmethods: [rate/raw]\ntimeout_s: 60\n"
                                             "draws: {mild: {bare: [1001]}, wild: {hill: [1001]}}\n";
    const fs::path examples = test::source_dir() / "examples" / "methods";
    for (const char* name : {"doubtful.py", "doubtful.c", "doubtful.yaml"}) fs::copy(examples / name, folder_ / name);
  }
  Ended bench(const std::vector<std::string>& methods, const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"bench", "--suite", path("small.yaml"), "--db", path("bench.db")};
    words.insert(words.end(), more.begin(), more.end());
    for (const std::string& each : methods) words.push_back(each.find('.') == std::string::npos ? each : path(each));
    return run_program(words);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Expects that the report which `bench` recommends compares both methods, and that each command on its page works.
  void expect_page_of(const std::string& database) const {
    run_successfully({"report", database, "-o", path("page.html")});
    const std::string page = read_file(folder_ / "page.html");
    EXPECT_THAT(page, HasSubstr("theirs"));
    EXPECT_THAT(page, HasSubstr("published result of build"));
    const std::string text = page.substr(0, page.find("<script id=\"plotly\">"));
    std::vector<std::string> verbs;
    for (std::size_t at = 0; (at = text.find("<pre>tumble ", at)) != std::string::npos;) {
      at += std::string("<pre>tumble ").size();
      std::istringstream command(text.substr(at, text.find('<', at) - at));
      std::vector<std::string> words{std::istream_iterator<std::string>(command), {}};
      verbs.push_back(words.front());
      if (words.front() == "run" || words.front() == "certify") continue;  // as for any other page
      if (words.front() == "sweep") words.insert(words.end(), {"--examples", "0"});
      const Ended ended = run_program(words);
      EXPECT_EQ(ended.status, 0) << testing::PrintToString(words) << ended.err;
    }
    EXPECT_THAT(verbs, testing::IsSupersetOf({"sweep", "report", "compare"}));
    EXPECT_THAT(verbs, Not(Contains("sensitivity"))) << "which needs more draws";
  }

  const fs::path folder_ = test_folder();
};

TEST_F(Bench, ForeignMethodsAreComparedWithOurs) {
  const std::string c = path("doubtful.c"), program = path("doubtful");
  ASSERT_EQ(std::system(("cc -O2 -Wall -Wextra -o " + program + " " + c + " -lm").c_str()), 0);
  std::ofstream(folder_ / "crashes.py") << "def rate(recording):\n    raise ValueError('out of luck')\n";

  Ended ended = bench({"rate/raw", "doubtful.py", "doubtful.yaml", "crashes.py"}, {"-o", path("lines.jsonl")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("rate_error_clipped_median_rad_s"));
  EXPECT_THAT(ended.out, HasSubstr("mild (1)"));
  EXPECT_THAT(ended.out, HasSubstr("ValueError: out of luck"));
  EXPECT_THAT(ended.out, Not(HasSubstr("\"format\""))) << "the table alone";
  const std::vector<json> lines = lines_of(read_file(folder_ / "lines.jsonl"));
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines[1]["method"], "doubtful");
  EXPECT_EQ(lines[3]["draws"][0]["status"], "crashed");
  const std::string metric = "rate_error_clipped_median_rad_s";
  const auto value = [&](std::size_t line, const std::string& name) {
    return lines[line]["draws"][1]["values"].at(name).get<double>();
  };
  EXPECT_EQ(value(1, metric), value(0, metric)) << "the gyro as it is";
  EXPECT_EQ(value(2, metric), value(0, metric)) << "and in C";
  EXPECT_EQ(value(2, "rate_coverage_3sigma"), value(1, "rate_coverage_3sigma"));
  EXPECT_GT(value(1, "rate_coverage_3sigma"), value(0, "rate_coverage_3sigma") + 0.2) << "it said how doubtful it was";

  // a second request runs nothing again, and its line is the same, costs included
  ended = bench({"rate/raw", "doubtful.py"}, {"--json"});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(lines_of(ended.out)[1]["draws"], lines[1]["draws"]);

  // the page shows published results of others, unless they belong to another suite or simulation
  const auto beside = [&](const std::string& was, const std::string& is) {
    std::string text = read_file(folder_ / "lines.jsonl");
    const std::size_t at = text.find(was);
    std::ofstream(folder_ / "theirs.jsonl") << text.replace(at, was.size(), is);
    return bench({"doubtful.py"}, {"--beside", path("theirs.jsonl")});
  };
  ended = beside("\"method\":\"raw\"", "\"method\":\"theirs\"");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("theirs"));
  EXPECT_THAT(ended.out, Not(HasSubstr("not compared")));
  EXPECT_THAT(ended.err, HasSubstr("this command writes a report page: tumble report " + path("bench_compared.db") +
                                   " -o report.html"));
  expect_page_of(path("bench_compared.db"));
  ended = beside("\"recording\":\"", "\"recording\":\"0");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("not compared"));
  ended = beside("\"suite_digest\":\"", "\"suite_digest\":\"0");
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("this comparison needs results of suite"));
}

TEST_F(Bench, WrongUseIsRefusedBeforeAnythingRuns) {
  EXPECT_THAT(bench({"rate/raw", "slam/tumble"}, {}).err, HasSubstr("two kinds"));
  EXPECT_THAT(bench({"no_such.yaml"}, {}).err, HasSubstr("no_such.yaml"));
  EXPECT_THAT(bench({"rate/raw"}, {"--beside", path("small.yaml")}).err, HasSubstr("small.yaml:1"));
  EXPECT_THAT(run_program({"bench", "rate/raw", "--suite", "hill"}).err, HasSubstr("no classes"));
  EXPECT_EQ(run_program({"bench"}).status, 2);
}

}  // namespace
}  // namespace tumble::system_test
