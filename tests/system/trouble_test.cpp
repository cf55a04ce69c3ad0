// SPDX-License-Identifier: BSD-3-Clause
// The test checks errors of the surroundings (paths, limits, a full standard output), and gaps in the data.
#include <sys/resource.h>

#include "system/program.hpp"

namespace tumble::system_test {
namespace {

void expect_one_line(const Ended& ended, const std::string& says) {
  EXPECT_EQ(ended.status, 2) << ended.err;
  EXPECT_EQ(line_count(ended.err), 1u) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr(says));
}

TEST(ErrorCode, FolderThatCannotBeWritten) {
  // a path below a regular file is rejected for root too
  const fs::path folder = test_folder();
  std::ofstream(folder / "file") << "x";
  const std::string below = (folder / "file" / "below").string();
  expect_one_line(run_program({"run", "roll", "--seed", "1", "-o", below}), "file/below");
  expect_one_line(run_program({"record", "roll", "--seed", "1", "-o", below + "/r.h5"}), "file/below");
  expect_one_line(
      run_program({"estimate", (shared_run("roll") / "recording.h5").string(), "--method", "rate/raw", "-o", below}),
      "file/below");
  expect_one_line(run_program({"sweep", "roll", "--seeds", "1", "--db", below + "/x.db"}), "file/below");
  expect_one_line(run_program({"render", (shared_run("roll") / "recording.h5").string(), "-o", below + "/p.png"}),
                  "file/below");
  expect_one_line(run_program({"replay", (shared_run("roll") / "recording.h5").string(), "-o", below + "/p.html"}),
                  "file/below");
}

TEST(ErrorCode, FilesOfAnotherKindAreNotReplaced) {
  const fs::path folder = test_folder();
  const std::string recording = (shared_run("roll") / "recording.h5").string();
  std::ofstream(folder / "imu.csv") << "sec,nsec,wx,wy,wz,fx,fy,fz\n0,0,0,0,0,0,0,9.8\n";
  const auto kept = [&](const char* name, std::vector<std::string> words, const char* ending) {
    const fs::path file = folder / name;
    std::ofstream(file) << "precious";
    words.push_back(file.string());
    expect_one_line(run_program(words), ending);
    EXPECT_EQ(read_file(file), "precious") << words.front();
  };
  kept("a.h5", {"report", (folder / "x.db").string(), "-o"}, "a.h5: the name of this output must end in .html");
  kept("a.html", {"report", (folder / "x.db").string(), "--badge"}, "must end in .svg");
  kept("a.yaml", {"render", "roll", "--seed", "1", "-o"}, "must end in .png");
  kept("a.png", {"render", recording, "--video", "-o"}, "must end in .webp");
  kept("a.h5", {"replay", recording, "-o"}, "must end in .html");
  kept("a.yaml", {"record", "roll", "--seed", "1", "-o"}, "must end in .h5 or .hdf5");
  kept("a.csv", {"import", (folder / "imu.csv").string(), "-o"}, "must end in .h5 or .hdf5");
  kept("a.h5", {"bench", "rate/raw", "-o"}, "must end in .jsonl");
  kept("a.h5", {"export", recording, "--format", "tum", "-o"}, "choose another output name that ends in .tum or .txt");
  kept("a.tum", {"export", recording, "--format", "mcap", "-o"}, "ends in .mcap");
}

TEST(ErrorCode, TooFewFilesAreNoDefect) {
  const fs::path folder = test_folder();
  const std::string recording = (shared_run("hill") / "recording.h5").string();
  // the number of files that this process has open is unknown: below some limit the program cannot even be loaded
  std::size_t met = 0;
  for (rlim_t files = 4; files <= 12; ++files) {
    fs::remove_all(folder / "o.mcap");
    const Ended ended = run_program({"export", recording, "-o", (folder / "o.mcap").string()}, [&] {
      const rlimit limit = {files, files};
      setrlimit(RLIMIT_NOFILE, &limit);
    });
    if (ended.status == 127) continue;
    EXPECT_THAT(ended.status, testing::AnyOf(0, 2)) << files << " files: " << ended.err;
    if (ended.status != 2) continue;
    met += ended.err.find("pipe: Too many open files") != std::string::npos;
    EXPECT_TRUE(fs::is_empty(folder)) << fs::directory_iterator(folder)->path();
  }
  EXPECT_GT(met, 0u);
}

TEST(ErrorCode, FullStandardOutputIsSaid) {
  const Ended ended = run_program({"list", "methods"}, [] {
    if (std::freopen("/dev/full", "w", stdout) == nullptr) _exit(126);
  });
  expect_one_line(ended, "standard output");
}

TEST(ErrorCode, DataThatAreNotThereAreSaid) {
  const Ended ended = run_program({"list", "scenarios"}, [] { setenv("TUMBLE_DATA", "/nowhere", 1); });
  expect_one_line(ended, "/nowhere");
}

TEST(ErrorCode, AGapIsSaidWithItsPlace) {
  const fs::path folder = test_folder();
  std::ofstream csv(folder / "gap.csv");
  csv << "sec,nsec,wx,wy,wz,fx,fy,fz\n";
  for (int k = 0; k < 500; ++k) {
    const int cs = k < 200 ? k : k + 150;  // a gap of 1.5 s
    csv << cs / 100 << ',' << cs % 100 * 10'000'000 << ",0.01,0," << 0.001 * (k % 7) << ",0,0,9.8\n";
  }
  csv.close();
  const std::string recording = (folder / "gap.h5").string();
  const Ended imported = run_program({"import", (folder / "gap.csv").string(), "-o", recording});
  ASSERT_EQ(imported.status, 0);
  EXPECT_THAT(imported.err, HasSubstr("--lever-arm is missing"));
  const Ended ended = run_program({"estimate", recording, "--method", "rate/raw", "-o", (folder / "e").string()});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("imu has no readings between 1.990 and 3.500 s"));
}

TEST(ErrorCode, AFrameIsCheckedWithoutATrajectoryToo) {
  expect_one_line(run_program({"replay", (shared_run("roll") / "recording.h5").string(), "--frame", "limu", "-o",
                               (test_folder() / "p.html").string()}),
                  "unknown frame 'limu'");
}

}  // namespace
}  // namespace tumble::system_test
