// SPDX-License-Identifier: BSD-3-Clause
// The test checks an external command as a method: what the command receives, what it leaves, and every way in which it
// may end.
#include "scenarios/external/external_method.hpp"
#include "scenarios/methods/registry.hpp"

#include <signal.h>

#include "scenarios/recordings/recording_file.hpp"
#include "tests/scenarios/methods/external_runs.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

/// This awk program returns the gyro's readings unchanged: columns 9 to 11 of the exported CSV contain them, and an
/// exact time is two whole numbers.
const std::string kRawByAwk =
    "awk -F, 'BEGIN { print \"time_ns,wx_rad_s,wy_rad_s,wz_rad_s\" } "
    "NR > 1 { printf \"%d%09d,%s,%s,%s\\n\", $1, $2, $9, $10, $11 }' {csv}/imu.csv > {output}";

class ExternalMethod : public testing::ExternalRuns {
 protected:
  fs::path describe(const std::string& kind, const std::string& script, const std::string& more = "") {
    write("theirs.yaml",
          "name: theirs\nkind: " + kind + "\ncommand:\n  - sh\n  - -c\n  - >-\n    " + script + "\n" + more);
    return folder_ / "theirs.yaml";
  }
};

TEST_F(ExternalMethod, AnswersAsTheSameMethodOfOursDoes) {
  expect_same_as_raw(run(describe("rate", kRawByAwk)));
}

TEST_F(ExternalMethod, PosesAndAttitudesComeAsTum) {
  const std::string two = "printf '0.1 1 2 3 0 0 0 1\\n0.2 1 2 4 0 0 0 1\\n' > {output}";
  const Estimate poses = run(describe("slam", two, "frame: lidar\n"));
  ASSERT_EQ(poses.poses.size(), 2u);
  EXPECT_EQ(poses.frame, Frame::lidar);
  EXPECT_EQ(poses.poses[1].time_ns, 200'000'000);
  EXPECT_EQ(poses.poses[1].position_W_m, Vector3d(1, 2, 4));
  const Estimate attitudes = run(describe("attitude", two));
  EXPECT_EQ(attitudes.attitudes.size(), 2u);
  EXPECT_TRUE(attitudes.poses.empty());
}

TEST_F(ExternalMethod, StampsOfTheBagAreUnderstood) {
  const Estimate poses = run(describe("slam", "printf '1000000000.25 1 2 3 0 0 0 1\\n' > {output}"));
  ASSERT_EQ(poses.poses.size(), 1u);
  EXPECT_EQ(poses.poses[0].time_ns, 250'000'000);
}

TEST_F(ExternalMethod, NeverSeesTheTruthAndLeavesNoFolder) {
  const auto copy = folder_ / "seen.h5", place = folder_ / "place";
  refused(describe("rate", "cp {recording} " + copy.string() + "; pwd > " + place.string() + " # {output}"));
  EXPECT_FALSE(read_info(copy).has_truth);
  EXPECT_FALSE(read_sensors(copy).imus.empty());
  std::string scratch;
  std::getline(std::ifstream(place) >> std::ws, scratch);
  ASSERT_FALSE(scratch.empty());
  EXPECT_FALSE(fs::exists(scratch));
}

TEST_F(ExternalMethod, ACrashIsNoAnswerWithItsLastWords) {
  const auto [why, what] = no_answer(describe("rate", "echo out of luck >&2; kill -SEGV $$ # {output}"));
  EXPECT_EQ(why, NoAnswer::Why::crashed);
  EXPECT_THAT(what, HasSubstr("signal 11"));
  EXPECT_THAT(what, HasSubstr("out of luck"));
  EXPECT_THAT(no_answer(describe("rate", "exit 3 # {output}")).second, HasSubstr("exit status 3"));
  // the message must contain the cause, however much output followed it
  const std::string long_one =
      no_answer(describe("rate", "echo the cause; seq 5000; echo the end; exit 3 # {output}")).second;
  EXPECT_THAT(long_one, AllOf(HasSubstr("the cause 1 2 3"), HasSubstr(" ... "), HasSubstr("5000 the end")));
  EXPECT_LT(long_one.size(), 1000u);
}

// the output is kept, whatever the result of the run
TEST_F(ExternalMethod, WhatItSaysIsKept) {
  EXPECT_EQ(run(describe("rate", kRawByAwk + "; echo well; echo done >&2")).transcript, "well\ndone\n");
  const auto said = [&](const std::string& script) -> std::string {
    const Method method = external_method(describe("rate", script));
    try {
      method.run(recording().sensors, {}, {});
    } catch (const NoAnswer& error) {
      return "no answer: " + error.transcript();
    } catch (const RefusedAnswer& error) {
      return "refused: " + error.transcript();
    }
    return "";
  };
  EXPECT_EQ(said("echo oh; exit 3 # {output}"), "no answer: oh\n");
  EXPECT_EQ(said("echo here; echo nonsense > {output}"), "refused: here\n");
  const std::string much = said("yes 0123456789012345 | head -n 100000; exit 3 # {output}");
  EXPECT_GT(much.size(), 1'048'576u);
  EXPECT_LT(much.size(), 1'050'000u) << "1.7 MB, of which both ends are kept";
}

TEST_F(ExternalMethod, AHangIsEndedWithAllItHasStarted) {
  const auto pid = folder_ / "pid";
  const auto [why, what] =
      no_answer(describe("rate", "sleep 600 & echo $! > " + pid.string() + "; wait # {output}", "time_limit_s: 0.5\n"));
  EXPECT_EQ(why, NoAnswer::Why::timed_out);
  pid_t child = 0;
  std::ifstream(pid) >> child;
  ASSERT_GT(child, 0);
  bool gone = false;  // killed with its process group; the adopting process removes it soon
  for (int k = 0; k < 500 && !gone; ++k) {
    std::ifstream stat("/proc/" + std::to_string(child) + "/stat");
    std::string number, name, state;
    gone = !(stat >> number >> name >> state) || state == "Z";
    if (!gone) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(gone);
}

TEST_F(ExternalMethod, MemoryBeyondItsLimitIsRefusedIt) {
  const auto [why, what] =
      no_answer(describe("rate", "head -c 400000000 /dev/zero | tail -n 1 > {output}", "memory_limit_mib: 64\n"));
  EXPECT_EQ(why, NoAnswer::Why::crashed);
  EXPECT_THAT(what, HasSubstr("memory"));
}

TEST_F(ExternalMethod, AProgramThatIsNotThereIsNamed) {
  write("theirs.yaml", "name: theirs\nkind: rate\ncommand: [no_such_program_anywhere, '{output}']\n");
  const auto [why, what] = no_answer(folder_ / "theirs.yaml");
  EXPECT_EQ(why, NoAnswer::Why::crashed);
  EXPECT_THAT(what, HasSubstr("no_such_program_anywhere"));
}

TEST_F(ExternalMethod, WhatItLeavesIsRefusedWithItsPlace) {
  EXPECT_THAT(refused(describe("rate", "true # {output}")), HasSubstr("the command did not write this file"));
  EXPECT_THAT(refused(describe("slam", "true # {output}")), HasSubstr("the command did not write this file"));
  EXPECT_THAT(refused(describe("rate", "echo nonsense > {output}")), HasSubstr("rates.csv:1"));
  EXPECT_THAT(refused(describe("rate", kRawByAwk + "; mv {output} a; ln -s a {output}")),
              HasSubstr("is not a regular file"));
  EXPECT_THAT(refused(describe("rate", kRawByAwk + "; sed -i '$d' {output}")), HasSubstr("one per sample"));
  EXPECT_THAT(refused(describe("rate", kRawByAwk + "; sed -i '7s/^/1/' {output}")), HasSubstr("rates.csv:7"));
  EXPECT_THAT(refused(describe("slam", "printf '0.1 1 2 3 0 0 0 1\\n0.1 1' > {output}")), HasSubstr("poses.tum:2"));
  EXPECT_THAT(refused(describe("slam", "printf '0.2 1 2 3 0 0 0 1\\n0.1 1 2 3 0 0 0 1\\n' > {output}")),
              HasSubstr("must increase"));
}

TEST_F(ExternalMethod, WhatItLeavesIsBoundedBeforeItIsRead) {
  EXPECT_THAT(refused(describe("slam", "truncate -s 100000000000 {output}")),
              HasSubstr("poses.tum: the output file has 100000000000 bytes; for this recording, it may have at most"));
  EXPECT_THAT(refused(describe("rate", "truncate -s 100000000000 {output}")),
              HasSubstr("rates.csv: the output file has 100000000000 bytes"));
  EXPECT_THAT(refused(describe("position", "mkdir {output}; truncate -s 100000000000 {output}/estimate.json",
                               "output: estimate\n")),
              HasSubstr("estimate.json: the output file has 100000000000 bytes"));
  const std::string pose = "printf '0.1 1 2 3 0 0 0 1\\n' > {output}; ";
  EXPECT_THAT(refused(describe("slam", pose + "truncate -s 100000000000 {map}")),
              HasSubstr("map.ply: the output file has 100000000000 bytes"));
  EXPECT_THAT(refused(describe("slam", "mkfifo {output}")), HasSubstr("not a regular file"));
  EXPECT_THAT(refused(describe("slam", "ln -s /dev/zero {output}")), HasSubstr("not a regular file"));
}

TEST_F(ExternalMethod, AMapIsAnyPlyWithPlaces) {
  const std::string pose = "printf '0.1 1 2 3 0 0 0 1\\n' > {output}; ";
  const std::string head = "printf 'ply\\nformat ascii 1.0\\nelement vertex 2\\nproperty float x\\nproperty float y\\n";
  const Estimate bare =
      run(describe("slam", pose + head + "property float z\\nend_header\\n1 2 3\\n4 5 6\\n' > {map}"));
  ASSERT_EQ(bare.map.size(), 2u);
  EXPECT_EQ(bare.map[1].position_W_m, Vector3f(4, 5, 6));
  EXPECT_EQ(bare.map[1].sigma_m, 0.0f);
  const Estimate more = run(describe(
      "slam",
      pose + head + "property float z\\nproperty float sigma\\nend_header\\n1 2 3 0.5\\n4 5 6 0.25\\n' > {map}"));
  EXPECT_EQ(more.map.at(1).sigma_m, 0.25f);
  EXPECT_THAT(refused(describe("slam", pose + head + "end_header\\n1 2\\n4 5\\n' > {map}")),
              HasSubstr("must have the columns x, y and z"));
  EXPECT_THAT(refused(describe("slam", pose + head + "property float z\\nend_header\\n1 2 3\\n4 nan 6\\n' > {map}")),
              HasSubstr("map"));
}

TEST_F(ExternalMethod, NonsenseIsRefusedWithLineValueAndBound) {
  const auto left = [&](const std::string& row, const std::string& kind = "slam") {
    return refused(describe(kind, "printf '# a word\\n0.1 0 0 0 0 0 0 1\\n" + row + "\\n' > {output}"));
  };
  EXPECT_THAT(left("0.2 nan 0 0 0 0 0 1"), HasSubstr("poses.tum:3: the pose is not finite"));
  EXPECT_THAT(left("0.2 0 0 0 nan 0 0 1"), HasSubstr("poses.tum:3: the pose is not finite"));
  EXPECT_THAT(left("0.2 0 0 0 0 0 0 1e200"), HasSubstr("poses.tum:3: the quaternion has norm 1e+200; it must be 1"));
  EXPECT_THAT(left("0.2 0 0 0 0 0 0 1e200", "attitude"), HasSubstr("poses.tum:3: the quaternion has norm 1e+200"));
  EXPECT_THAT(left("0.2 1e300 0 0 0 0 0 1"),
              HasSubstr("poses.tum:3: the position is (1e+300, 0, 0) m; it must be finite and within 1e+07 m"));
  EXPECT_THAT(left("1000000 0 0 0 0 0 0 1"),
              HasSubstr("poses.tum:3: the time stamp is 1000000 s; it must be between -10 and"));
  EXPECT_THAT(left("1000000 0 0 0 0 0 0 1", "attitude"), HasSubstr("poses.tum:3: the time stamp is 1000000 s"));
  EXPECT_THAT(refused(describe("position", "printf '%s\\n' '-1000000000 0 0 0 0 0 0 1' > {output}")),
              HasSubstr("poses.tum:1: the time stamp is -1e+09 s"));
  EXPECT_THAT(refused(describe("rate", kRawByAwk + "; sed -i '7s/,[^,]*/,nan/' {output}")),
              HasSubstr("rates.csv:7: the rate is (nan,"));
  EXPECT_THAT(refused(describe("rate", kRawByAwk + "; sed -i '7s/,[^,]*/,1e7/' {output}")), HasSubstr("1e+06 rad/s"));
}

TEST_F(ExternalMethod, StampsInAnotherUnitAreNamedWithTheFirstThatIsOutside) {
  const auto in = [&](const std::string& power, const std::string& kind = "slam") {
    return describe(kind, "awk -F, 'NR > 1 { printf \"%.9f 0 0 0 0 0 0 1\\n\", ($1 + 1e-9 * $2) * 1e" + power +
                              " }' {csv}/imu.csv > {output}");
  };
  EXPECT_GT(run(in("0")).poses.size(), 100u);
  EXPECT_THAT(refused(in("9")), AllOf(HasSubstr("poses.tum:1: the time stamp is"),
                                      HasSubstr("must be in seconds; the time stamps seem to be in nanoseconds")));
  EXPECT_THAT(refused(in("6", "position")), HasSubstr("the time stamps seem to be in microseconds"));
  EXPECT_THAT(refused(in("3", "attitude")), HasSubstr("the time stamps seem to be in milliseconds"));
  EXPECT_THAT(refused(in("-3")), HasSubstr("must be in seconds"));
}

TEST_F(ExternalMethod, MessagesDoNotNameAFolderThatIsGone) {
  const std::string gone = "tumble-method";
  const auto plain = [&](const std::string& what) { return what.find(gone) == std::string::npos; };
  const std::string columns = refused(describe("slam", "printf '0.1 1\\n' > {output}"));
  EXPECT_THAT(columns, StartsWith("poses.tum:1: "));
  EXPECT_TRUE(plain(columns));
  const std::string said = no_answer(describe("slam", "echo cannot write {output} in $PWD; exit 3")).second;
  EXPECT_THAT(said, HasSubstr("cannot write poses.tum in ."));
  EXPECT_TRUE(plain(said));
}

TEST_F(ExternalMethod, WhatIsNoCovarianceIsRefused) {
  const auto with = [&](const std::string& covariance) {
    return describe("rate", kRawByAwk + "; sed -i -e 's/$/," + covariance +
                                "/' -e '1s/,[^a-z].*$/,cxx,cxy,cxz,cyy,cyz,czz/' {output}");
  };
  EXPECT_THAT(refused(with("1,0,0,-2,0,1")),
              HasSubstr("rates.csv:2: the covariance has a variance of -2; variances must be at least 0"));
  EXPECT_THAT(refused(with("1,3,0,4,0,1")), HasSubstr("two components have the covariance 3 and the variances 1 and 4; "
                                                      "the magnitude of the covariance must be at most 2"));
  EXPECT_EQ(run(with("1,2,0,4,0,1")).rates[0].covariance_rad2_s2(0, 1), 2.0);
}

TEST_F(ExternalMethod, DescriptionsAreCheckedBeforeAnythingRuns) {
  EXPECT_THAT(refused(describe("rate", "{csw} {output}")), HasSubstr("did you mean 'csv'"));
  const std::string placeholder = refused(describe("rate", "{bag} {output}"));
  EXPECT_THAT(placeholder, HasSubstr("rosbag1 rosbag2 mcap"));
  const std::string unlike = refused(describe("rate", "{x_y_z_9_9_9} {output}"));
  EXPECT_NE(unlike.find("rosbag1"), std::string::npos);
  EXPECT_EQ(unlike.find("rosbag1"), unlike.rfind("rosbag1")) << "said once: " << unlike;
  EXPECT_THAT(refused(describe("rate", "{output}", "robots: [rigg]\n")),
              HasSubstr("robots[0]: unknown robot 'rigg'; did you mean 'rig'"));
  EXPECT_THAT(refused(describe("rate", "{output}", "robots: [rig, car]\n")), HasSubstr("unknown robot 'car'"));
  EXPECT_THAT(refused(describe("rate", "true")), HasSubstr("{output}"));
  EXPECT_THAT(refused(describe("rates", "{output}")), HasSubstr("did you mean 'rate'"));
  EXPECT_THAT(refused(describe("rate", "{output}", "time_limit_s: 0\n")), HasSubstr("time_limit_s"));
  EXPECT_THAT(refused(describe("rate", "{output}", "timelimit: 3\n")), HasSubstr("timelimit"));
  EXPECT_THAT(refused(describe("rate", "{output}", "output: tum\n")), HasSubstr("output"));
  EXPECT_THAT(refused(describe("rate", "{output}", "version: [sh, -c, 'exit 1']\n")), HasSubstr("version"));
  EXPECT_THAT(refused(describe("rate", "{output} {" + std::string(500'000, 'a') + "}")), HasSubstr("at most 4096"));
}

TEST_F(ExternalMethod, AVersionContainsProgramAndDescription) {
  const std::string first = external_method(describe("rate", "{output}", "version: [echo, v7]\n")).info.version;
  const std::string second = external_method(describe("rate", "{output} ", "version: [echo, v7, b]\n")).info.version;
  EXPECT_THAT(first, HasSubstr("v7"));
  EXPECT_NE(first, second);
  EXPECT_THAT(refused(describe("rate", "{output}", "version: [\"true\"]\n")),
              AllOf(HasSubstr("theirs.yaml: its version command: "), HasSubstr("printed nothing")));
}

// otherwise a sweep or a benchmark would continue with the rows of the old program
TEST_F(ExternalMethod, ARebuiltProgramIsAnotherVersion) {
  const auto version = [&] { return external_method(folder_ / "theirs.yaml").info.version; };
  for (const char* command : {"sh {folder}/mine.sh {output}", "{folder}/mine.sh>{output}"}) {
    write("mine.sh", "echo one\n");
    describe("rate", command);
    const std::string first = version();
    write("beside.sh", "echo\n");
    EXPECT_EQ(version(), first) << "of no word of it";
    write("mine.sh", "echo two\n");
    EXPECT_NE(version(), first) << command;
    write("mine.sh", "echo one\n");
    EXPECT_EQ(version(), first) << "when and where it was made is no matter";
  }
}

TEST_F(ExternalMethod, NamesAreTheirOwn) {
  write("ours.yaml", "name: raw\nkind: rate\ncommand: [true, '{output}']\n");
  EXPECT_THROW(find_methods((folder_ / "ours.yaml").string()), BadInput);
  write("a.yaml", "name: theirs\nkind: rate\ncommand: [true, '{output}']\n");
  write("b.yaml", "name: theirs\nkind: rate\ncommand: [false, '{output}']\n");
  const std::vector<std::string> twice = {(folder_ / "a.yaml").string(), (folder_ / "a.yaml").string()};
  EXPECT_EQ(find_methods(twice).size(), 1u);
  const std::vector<std::string> two = {(folder_ / "a.yaml").string(), (folder_ / "b.yaml").string()};
  EXPECT_THROW(find_methods(two), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
