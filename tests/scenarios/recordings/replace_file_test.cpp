// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/replace_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>

#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using fixture::bytes_of;
using testing::HasSubstr;
using ReplaceFile = fixture::Folder;

TEST_F(ReplaceFile, WritesAndReplaces) {
  const std::filesystem::path path = folder_ / "a";
  replace_file(path, "first, and longer");
  EXPECT_EQ(bytes_of(path), "first, and longer");
  replace_file(path, "second");
  EXPECT_EQ(bytes_of(path), "second");
  replace_file(path, std::string_view());
  EXPECT_EQ(bytes_of(path), "");
  EXPECT_EQ(files(), 1u);
}

TEST_F(ReplaceFile, FollowsTheUsersMask) {
  const mode_t before = umask(027);
  replace_file(folder_ / "a", "x");
  umask(before);
  struct stat status {};
  ASSERT_EQ(stat((folder_ / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0640u);
}

TEST_F(ReplaceFile, ImpossiblePlacesAreNamed) {
  const auto complaint_of = [](const std::filesystem::path& path) {
    return fixture::complaint([&] { replace_file(path, "x"); });
  };
  EXPECT_EQ(complaint_of(folder_ / "none/a"),
            (folder_ / "none/a").string() + ": cannot be written: No such file or directory");
  replace_file(folder_ / "file", "x");
  EXPECT_THAT(complaint_of(folder_ / "file/a"), HasSubstr("Not a directory"));
  std::filesystem::create_directories(folder_ / "folder/full");
  EXPECT_THAT(complaint_of(folder_ / "folder"), HasSubstr("Is a directory"));
  EXPECT_THAT(complaint_of("/proc/tumble_recording"), HasSubstr("cannot be written"))
      << "not even root can write there";
  EXPECT_EQ(files(), 2u) << "no temporary file stays";
}

TEST_F(ReplaceFile, ReadOnlyFolderIsRefused) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write into a read-only folder; /proc stands for it above";
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const std::string message = fixture::complaint([&] { replace_file(folder_ / "a", "x"); });
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
  EXPECT_THAT(message, HasSubstr("Permission denied"));
}

/// Ends the process with 0 when a recording cannot be written, BadInput says so and nothing is left of it.
[[noreturn]] void write_with_little_room(const std::filesystem::path& folder, const std::string& old_bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{4096, 4096};
  setrlimit(RLIMIT_FSIZE, &limit);
  const sim::Recording recording = fixture::recording();
  const std::string message = fixture::complaint(
      [&] { write_recording(folder / "a.h5", fixture::info(), recording.sensors, &recording.truth); });
  const auto left = std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
  std::cerr << message;
  std::exit(message.empty() || left != 1 || bytes_of(folder / "a.h5") != old_bytes ? 1 : 0);
}

// A limit on the size of files makes write() fail midway as a full disk does (EFBIG for ENOSPC).
TEST_F(ReplaceFile, AFullDiskLeavesTheOldFileAndNoPart) {
  const sim::Recording recording = fixture::recording();
  write_recording(folder_ / "a.h5", {}, recording.sensors, nullptr);
  const std::string old_bytes = bytes_of(folder_ / "a.h5");
  ASSERT_GT(old_bytes.size(), 4096u);
  EXPECT_EXIT(write_with_little_room(folder_, old_bytes), testing::ExitedWithCode(0),
              "a.h5: cannot be written: File too large");
}

}  // namespace
}  // namespace tumble::scenarios
