// SPDX-License-Identifier: BSD-3-Clause
// The test checks what a verb leaves when a signal ends it.
#include <unistd.h>

#include <csignal>

#include "scenarios/recordings/bags/packed.hpp"
#include "scenarios/recordings/bags/ros1_chunks.hpp"
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

/// Ends a verb by a signal as soon as `folder` contains something, and returns its exit status.
int status_after(const std::vector<std::string>& arguments, const fs::path& folder, int number) {
  Running running(arguments, [&] { setenv("TMPDIR", folder.c_str(), 1); });
  while (fs::is_empty(folder) && !running.has_ended()) usleep(200);
  running.signal(number);
  return running.wait().status;
}

struct Verb {
  const char* name;
  std::vector<std::string> arguments;  ///< without the output, which is in the folder
};

TEST(Interrupted, NothingHalfDoneIsLeft) {
  const fs::path made = shared_run("hill");
  const std::string recording = (made / "recording.h5").string();
  const fs::path bags = test_folder();
  run_successfully({"export", recording, "--format", "rosbag1", "-o", (bags / "plain.bag").string()});
  scenarios::copy_ros1_bag(bags / "plain.bag", bags / "lz4.bag", [](scenarios::Ros1Chunk& chunk) {
    chunk.data = scenarios::packed_lz4(chunk.data);
    chunk.compression = "lz4";
  });
  const Verb verbs[] = {{"mcap", {"export", recording, "--format", "mcap"}},
                        {"rosbag1", {"export", recording, "--format", "rosbag1"}},
                        {"rosbag2", {"export", recording, "--format", "rosbag2"}},
                        {"ply", {"export", recording, "--format", "ply"}},
                        {"peer", {"export", recording, "--for", "rko-lio"}},
                        {"unpacked", {"import", (bags / "lz4.bag").string()}},
                        {"estimate", {"estimate", recording, "--method", "slam/icp_raw"}},
                        {"run", {"run", "hill"}}};
  const fs::path folder = bags / "out";
  for (const Verb& verb : verbs) {
    for (const int number : {SIGTERM, SIGINT}) {
      fs::remove_all(folder);
      fs::create_directory(folder);
      std::vector<std::string> arguments = verb.arguments;
      const std::string name = arguments.front() == "import" ? "o.h5" : "o";
      arguments.insert(arguments.end(), {"-o", (folder / name).string()});
      EXPECT_EQ(status_after(arguments, folder, number), 128 + number) << verb.name;
      EXPECT_TRUE(fs::is_empty(folder)) << verb.name << " left " << fs::directory_iterator(folder)->path();
    }
  }
  // the test must detect remaining files
  fs::remove_all(folder);
  fs::create_directory(folder);
  EXPECT_EQ(status_after({"export", recording, "--format", "mcap", "-o", (folder / "o").string()}, folder, SIGKILL),
            128 + SIGKILL);
  EXPECT_FALSE(fs::is_empty(folder));
}

// the files that the output's folder contained before must remain
TEST(Interrupted, WhatWasThereStays) {
  const std::string recording = (shared_run("hill") / "recording.h5").string();
  const fs::path folder = test_folder() / "out";
  fs::create_directory(folder);
  EXPECT_EQ(status_after({"export", recording, "--format", "ply", "-o", folder.string()}, folder, SIGTERM),
            128 + SIGTERM);
  EXPECT_TRUE(fs::is_directory(folder));
  EXPECT_TRUE(fs::is_empty(folder));
  const fs::path file = folder / "a.mcap";
  run_successfully({"export", (shared_run("roll") / "recording.h5").string(), "-o", file.string()});
  const std::string before = read_file(file);
  Running running({"export", recording, "-o", file.string()});
  while (std::distance(fs::directory_iterator(folder), fs::directory_iterator()) < 2 && !running.has_ended())
    usleep(200);
  running.signal(SIGTERM);
  EXPECT_EQ(running.wait().status, 128 + SIGTERM);
  EXPECT_EQ(read_file(file), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace tumble::system_test
