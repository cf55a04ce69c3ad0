// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

class SuiteTest : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    // the suite reads only the names of scenarios
    write("scenarios/catalogue/hill.yaml", "");
    write("scenarios/catalogue/roll.yaml", "");
  }

  DataRoot data() const { return {folder_}; }

  std::string complaint(const std::string& text) const {
    write("scenarios/suites/test.yaml", text);
    return test::complaint([&] { load_suite(data(), "test"); });
  }
};

TEST_F(SuiteTest, ReadsWhatIsWritten) {
  write("scenarios/suites/test.yaml",
        "name: test\ndoc: Some words.\nscenarios: [hill, roll]\nseeds: {first: 3, last: 18446744073709551615}\n"
        "methods: [raw, rate/oracle]\ntimeout_s: 12.5\n");
  const Suite suite = load_suite(data(), "test");
  EXPECT_EQ(suite.name, "test");
  EXPECT_EQ(suite.doc, "Some words.");
  EXPECT_EQ(suite.scenarios, (std::vector<std::string>{"hill", "roll"}));
  EXPECT_EQ(suite.first_seed, 3u);
  EXPECT_EQ(suite.last_seed, 18446744073709551615u);
  EXPECT_EQ(suite.methods, (std::vector<std::string>{"raw", "rate/oracle"}));
  EXPECT_EQ(suite.timeout_s, 12.5);
  EXPECT_EQ(suite_names(data()), (std::vector<std::string>{"test"}));
}

TEST_F(SuiteTest, AScenarioIsASuiteOfItsOwn) {
  write("scenarios/suites/test.yaml", "");
  const Suite suite = load_suite(data(), "roll");
  EXPECT_EQ(suite.scenarios, (std::vector<std::string>{"roll"}));
  EXPECT_EQ(suite.methods.size(), methods().size());
}

TEST_F(SuiteTest, ComplaintsNameFileLineAndNearestName) {
  const std::string head = "name: test\ndoc: d\n";
  EXPECT_NE(complaint(head + "scenarios: [hil]\nseeds: {first: 1, last: 2}\n").find("test.yaml:3"), std::string::npos);
  EXPECT_NE(complaint(head + "scenarios: [hil]\nseeds: {first: 1, last: 2}\n").find("did you mean 'hill'"),
            std::string::npos);
  EXPECT_NE(complaint(head + "scenarios: [hill]\nseeds: {first: 1, last: 2}\nmethods: [saav]\n").find("'saave'"),
            std::string::npos);
  EXPECT_NE(complaint(head + "scenarios: [hill, hill]\nseeds: {first: 1, last: 2}\n").find("'hill' occurs twice"),
            std::string::npos);
  EXPECT_NE(complaint(head + "scenarios: [hill]\nseeds: [1, 2]\n").find("must be a map with the keys first, last"),
            std::string::npos);
  EXPECT_NE(
      complaint(head + "scenarios: [hill]\nseeds: {first: 2, last: 1}\n").find("the last seed is below the first"),
      std::string::npos);
  EXPECT_NE(complaint(head + "scenarios: [hill]\nseeds: {first: 1, last: 2}\ntimeout: 5\n").find("timeout"),
            std::string::npos);
  EXPECT_NE(complaint(head + "scenarios: [hill]\nseeds: {first: 1, last: 2}\ntimeout_s: -5\n").find("timeout_s"),
            std::string::npos);
  EXPECT_NE(complaint(head + "seeds: {first: 1, last: 2}\n"), "");
  EXPECT_THAT(test::complaint([&] { load_suite(data(), "tset"); }), HasSubstr("did you mean 'test'"));
}

TEST_F(SuiteTest, AScenarioIsDistinguishedFromASuite) {
  EXPECT_THAT(
      complaint("name: icy\ndoc: d\nduration_s: 4\nmotion: {type: push}\n"),
      AllOf(HasSubstr("test.yaml:4: motion: this key belongs to a scenario"), HasSubstr("scenarios/catalogue")));
}

TEST_F(SuiteTest, DrawsMayBeNamedInClasses) {
  write("scenarios/suites/test.yaml",
        "name: test\ndoc: d\ndraws:\n  mild: {hill: [7, 3], roll: [5]}\n  wild: {hill: [9]}\n"
        "metrics: [ate_m]\n");
  Suite suite = load_suite(data(), "test");
  ASSERT_EQ(suite.classes.size(), 2u);
  EXPECT_EQ(suite.classes[0].draws,
            (std::vector<std::pair<std::string, std::uint64_t>>{{"hill", 7}, {"hill", 3}, {"roll", 5}}));
  EXPECT_EQ(suite.first_seed, 3u);
  EXPECT_EQ(suite.last_seed, 9u);
  EXPECT_EQ(suite.draw_count(), 4u);
  EXPECT_TRUE(suite.has_draw("hill", 9));
  EXPECT_FALSE(suite.has_draw("roll", 9));
  EXPECT_EQ(suite.shown_metrics, (std::vector<std::string>{"ate_m"}));
  suite.last_seed = 5;  // a shard
  EXPECT_EQ(suite.draw_count(), 2u);

  const std::string head = "name: test\ndoc: d\n";
  EXPECT_THAT(complaint(head + "draws: {mild: {hil: [1]}}\n"), HasSubstr("did you mean 'hill'"));
  EXPECT_THAT(complaint(head + "draws: {mild: {hill: [1]}, wild: {hill: [1]}}\n"), HasSubstr("twice"));
  EXPECT_THAT(complaint(head + "draws: {mild: {}}\n"), HasSubstr("needs at least one simulated run"));
  EXPECT_THAT(complaint(head + "draws: {}\n"), HasSubstr("needs at least one simulated run"));
  EXPECT_THAT(complaint(head + "draws: {mild: {hill: [1]}}\nscenarios: [hill]\n"), HasSubstr("is not allowed"));
  EXPECT_THAT(complaint(head + "draws: {mild: {hill: [1]}}\nmetrics: [ate]\n"), HasSubstr("ate_m"));
}

// the project's suites are loaded with the project's catalogue
TEST(Suites, OfTheTreeLoad) {
  const DataRoot data{test::source_dir()};
  ASSERT_TRUE(fs::exists(data.catalogue())) << data.catalogue();
  const auto names = suite_names(data);
  ASSERT_GE(names.size(), 4u);
  for (const std::string& name : names) EXPECT_NO_THROW(load_suite(data, name)) << name;
  EXPECT_EQ(load_suite(data, "gate").methods.size(), methods().size()) << "a suite that names none runs all";
  EXPECT_THAT(load_suite(data, "demo").methods,
              ::testing::IsSupersetOf<std::string>({"rate/raw", "rate/saave", "position/rolling"}));
}

}  // namespace
}  // namespace tumble::scenarios
