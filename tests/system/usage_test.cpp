// SPDX-License-Identifier: BSD-3-Clause
// The test checks help, names and listings, which a newcomer uses first.
#include <sched.h>

#include "system/program.hpp"

namespace tumble::system_test {
namespace {

class EachVerb : public testing::TestWithParam<const char*> {};

TEST_P(EachVerb, HasHelp) {
  const Ended ended = run_program({GetParam(), "--help"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
  EXPECT_THAT(ended.out, HasSubstr("--json"));
  EXPECT_THAT(ended.out, HasSubstr("--quiet"));
}

INSTANTIATE_TEST_SUITE_P(Program, EachVerb,
                         testing::Values("list", "run", "record", "estimate", "score", "sweep", "merge", "report",
                                         "compare", "sensitivity", "search", "render", "replay", "certify", "bench",
                                         "gate", "triage", "shrink", "export", "import", "odometry", "doctor"));

/// OSMesa depends on LLVM, and PCL's readers depend on VTK: both are loaded only when they are needed.
TEST(Program, BeginsWithoutTheLibrariesThatFewVerbsNeed) {
  // the loader lists the libraries that it would load, and ends
  const Ended listed = run_program({"--version"}, [] { setenv("LD_TRACE_LOADED_OBJECTS", "1", 1); });
  EXPECT_THAT(listed.out, HasSubstr("libmujoco"));
  for (const char* dear : {"libOSMesa", "libLLVM", "libpcl_io", "libvtk"})
    EXPECT_THAT(listed.out, Not(HasSubstr(dear)));
  const fs::path folder = test::program().parent_path().parent_path();
  EXPECT_THAT(read_file(folder / "lib/tumble/tumble_pcl_reader.so"), HasSubstr("libpcl_io")) << "negative control";
}

struct Wrong {
  const char* what;
  std::vector<std::string> arguments;
  const char* says;
};
void PrintTo(const Wrong& wrong, std::ostream* stream) {
  *stream << wrong.what;
}

class WrongUse : public testing::TestWithParam<Wrong> {};

TEST_P(WrongUse, EndsWithTwoAndOneClearLine) {
  const Ended ended = run_program(GetParam().arguments);
  EXPECT_EQ(ended.status, 2) << ended.err;
  EXPECT_EQ(line_count(ended.err), 1u) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr(GetParam().says));
  EXPECT_EQ(ended.out, "");
}

INSTANTIATE_TEST_SUITE_P(
    Program, WrongUse,
    testing::Values(
        Wrong{"no verb", {"--json"}, "a verb is missing"},
        Wrong{"option before the verb", {"--quiet", "list", "methods"}, "must follow the verb"},
        Wrong{"option of a verb", {"run", "hill", "--jsno"}, "unknown option '--jsno'"},
        Wrong{"option of a list", {"list", "methods", "--jsno"}, "unknown option '--jsno'"},
        Wrong{"verb", {"rnu", "hill"}, "did you mean 'run'?"},
        Wrong{"method", {"run", "hill", "--seed", "1", "--method", "saavee"}, "saave"},
        Wrong{"list", {"list", "scenarois"}, "did you mean 'scenarios'?"},
        Wrong{"no seed", {"record", "hill", "-o", "x.h5"}, "--seed"},
        Wrong{"scenario before seed and output", {"record", "hil"}, "did you mean 'hill'?"},
        Wrong{"scenario before seed and method", {"triage", "hil"}, "did you mean 'hill'?"},
        Wrong{"scenario file before what is missing", {"record", "absent.yaml"}, "absent.yaml"},
        Wrong{"scenario before the picture", {"render", "hil"}, "did you mean 'hill'?"},
        Wrong{"recording before the method", {"estimate", "absent.h5"}, "absent.h5: no such file"},
        Wrong{"recording before the page", {"replay", "absent.h5"}, "absent.h5"},
        Wrong{"suite before its database", {"sweep", "dmeo"}, "did you mean 'demo'?"},
        Wrong{"threads", {"run", "hill", "--seed", "1", "--threads", "0"}, "--threads"},
        Wrong{"absent database", {"report", "absent.db"}, "absent.db"},
        Wrong{"row of the certificate", {"certify", "--row", "free_fal"}, "'free_fall'"},
        Wrong{"margin of a gate", {"gate", "gate", "--accept", "--margin", "-1"}, "--margin"},
        Wrong{"format of tables",
              {"list", "suites", "--format", "jsno"},
              "unknown format of tables 'jsno'; known: csv md"},
        Wrong{"a device for a recording",
              {"export", "/dev/null", "--format", "tum", "-o", "x"},
              "/dev/null: is a device"},
        Wrong{"a folder of TUM's poses", {"import", "/proc", "--format", "tum", "-o", "x.h5"}, "/proc: is a folder"},
        Wrong{"import of no file", {"import", "absent.dat", "-o", "x.h5"}, "absent.dat: the file does not exist"},
        Wrong{"shrink without a name",
              {"shrink", "hill", "--seed", "1", "--method", "rate/raw", "-o", "A b.yaml"},
              "NAME.yaml"},
        Wrong{"shrink by no bound",
              {"shrink", "hill", "--seed", "1", "--method", "rate/raw", "--failure", "1", "-o", "a.yaml"},
              "write 'METRIC > VALUE'"},
        Wrong{"search without a failure",
              {"search", "roll", "--method", "rate/raw", "--db", "a.db"},
              "give either --failure 'METRIC > VALUE' or --worst METRIC"},
        Wrong{
            "search in the better direction",
            {"search", "roll", "--method", "rate/raw", "--failure", "rate_error_free_median_rad_s < 1", "--db", "a.db"},
            "higher values of this metric are worse"},
        Wrong{"search with a small budget",
              {"search", "roll", "--method", "rate/raw", "--worst", "rate_error_free_median_rad_s", "--budget", "20",
               "--db", "a.db"},
              "--budget is 20; it must be at least --population, 50"},
        Wrong{"a point of no curve", {"run", "hill", "--seed", "1", "--vary", "world.rock_count"}, "KEY=NUMBER"},
        Wrong{"a point beyond its bound", {"run", "hill", "--seed", "1", "--vary", "world.rock_count=-1"}, "within"},
        Wrong{"triage of one draw by results",
              {"triage", "hill", "--seed", "1", "--method", "rate/raw", "--db", "x.db"},
              "single simulated run"},
        Wrong{"a case's gate against another", {"gate", "regressions", "--against", "x.yaml"}, "its own expectations"},
        Wrong{"triage of many methods", {"triage", "hill", "--seed", "1", "--method", "tumble"}, "rate/tumble"},
        Wrong{"metric of a triage",
              {"triage", "hill", "--seed", "1", "--method", "rate/raw", "--failure", "rate_error > 1"},
              "metric"},
        Wrong{"lever arm that is no number",
              {"import", "absent.csv", "--lever-arm", "nan", "0", "0", "-o", "x.h5"},
              "--lever-arm: nan is out of range; each number must be from -10 to 10"},
        Wrong{"limit that is no number",
              {"triage", "roll", "--seed", "1", "--method", "position/rolling", "--failure",
               "position_end_error_m > nan"},
              "--failure"},
        Wrong{"seeds that are empty", {"sweep", "demo", "--seeds", "", "--db", "x.db"}, "--seeds"},
        Wrong{"methods that do not apply",
              {"run", "roll", "--seed", "1", "--method", "slam/icp"},
              "does not support the robot 'sphere'"},
        Wrong{"a map without a lidar", {"run", "twirl", "--seed", "1", "--method", "slam/icp"}, "needs a lidar"}));

TEST(Message, IsOfALengthThatCanBeRead) {
  const Ended ended = run_program({"import", std::string(100'000, 'x') + ".csv", "-o", "x.h5"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("File name too long"));
  EXPECT_EQ(line_count(ended.err), 1u);
  EXPECT_LT(ended.err.size(), 2500u);
}

TEST(FirstMinutes, TheProgramAloneShowsTheWay) {
  const Ended ended = run_program({});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "");
  for (const char* word : {"tumble run hill", "tumble list scenarios", "tumble import", "tumble score", "triage"})
    EXPECT_THAT(ended.out, HasSubstr(word));
}

TEST(FirstMinutes, HelpIsAVerbToo) {
  const Ended alone = run_program({"help"});
  EXPECT_EQ(alone.status, 0);
  EXPECT_EQ(alone.out, run_program({}).out);
  EXPECT_EQ(run_program({"help", "merge"}).out, run_program({"merge", "--help"}).out);
  const Ended unknown = run_program({"help", "marge"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'merge'?"));
}

TEST(FirstMinutes, JobsAreTheProcessors) {
  // with one processor, the default number of processes is one
  const Ended one = run_program({"sweep", "--help"}, [] {
    cpu_set_t all, first;
    sched_getaffinity(0, sizeof all, &all);
    CPU_ZERO(&first);
    for (int k = 0; k < CPU_SETSIZE && CPU_COUNT(&first) == 0; ++k) {
      if (CPU_ISSET(k, &all)) CPU_SET(k, &first);
    }
    sched_setaffinity(0, sizeof first, &first);
  });
  const std::string before = "--jobs INT:INT in [1 - 1024]=";
  EXPECT_THAT(one.out, HasSubstr(before + "1\n"));
  cpu_set_t own;
  CPU_ZERO(&own);
  ASSERT_EQ(sched_getaffinity(0, sizeof own, &own), 0);
  for (const char* verb : {"sweep", "gate"}) {
    EXPECT_THAT(run_program({verb, "--help"}).out, HasSubstr(before + std::to_string(CPU_COUNT(&own)) + "\n"));
  }
}

TEST(List, NamesWhatThereIs) {
  const auto names = [](const char* what) {
    std::vector<std::string> out;
    for (const auto& entry : json_of(run_program({"list", what, "--json"}))) {
      out.push_back(entry.value("name", entry.value("device", "")));
    }
    return out;
  };
  EXPECT_THAT(names("scenarios"), testing::IsSupersetOf({"hill", "roll", "slip"}));
  EXPECT_THAT(names("methods"),
              testing::IsSupersetOf({"raw", "saave", "oracle", "integrate", "madgwick", "rolling", "icp"}));
  EXPECT_THAT(names("sensors"), testing::IsSupersetOf({"mti30", "vn100", "rs16", "phidget1044", "mid100"}));
  EXPECT_THAT(names("suites"), testing::IsSupersetOf({"hill", "slip", "demo", "gate"}));
  EXPECT_THAT(names("metrics"), testing::IsSupersetOf({"map_overlap", "pose_nees", "rate_coverage_3sigma"}));
}

TEST(List, AMetricSaysWhatIsBetter) {
  const auto of = [](const char* metric) { return json_of(run_program({"list", "metrics", metric, "--json"})).at(0); };
  const nlohmann::json error = of("translation_error_end_m"), overlap = of("map_overlap"), nees = of("pose_nees");
  EXPECT_EQ(error.value("unit", ""), "m");
  EXPECT_EQ(error.value("kind", ""), "slam");
  EXPECT_EQ(error.value("sense", ""), "lower is better");
  EXPECT_TRUE(error.value("headline", false));
  EXPECT_EQ(overlap.value("sense", ""), "higher is better");
  EXPECT_EQ(nees.value("sense", ""), "best near 1");
  EXPECT_NE(nees.value("doc", ""), "");
  EXPECT_THAT(run_program({"list", "metrics", "map_overlop"}).err, HasSubstr("map_overlap"));
}

TEST(List, EveryNumberOfASensorHasUnitAndSource) {
  const nlohmann::json sensors = json_of(run_program({"list", "sensors", "--json"}));
  std::size_t numbers = 0;
  for (const auto& sensor : sensors) {
    for (const auto& number : sensor["numbers"]) {
      EXPECT_NE(number.value("unit", ""), "") << number;
      EXPECT_NE(number.value("source", ""), "") << number;
      ++numbers;
    }
  }
  EXPECT_GT(numbers, 20u) << "an empty list would pass the above";
}

}  // namespace
}  // namespace tumble::system_test
