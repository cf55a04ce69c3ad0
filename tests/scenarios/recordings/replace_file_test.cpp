// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/replace_file.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <iostream>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using test::read_file;
using ReplaceFile = test::TemporaryFolder;

TEST_F(ReplaceFile, WritesAndReplaces) {
  const fs::path path = folder_ / "a";
  replace_file(path, "first, and longer");
  EXPECT_EQ(read_file(path), "first, and longer");
  replace_file(path, "second");
  EXPECT_EQ(read_file(path), "second");
  replace_file(path, std::string_view());
  EXPECT_EQ(read_file(path), "");
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

// a folder that contains only such files counts as empty
TEST_F(ReplaceFile, AFolderOfAKilledProcessIsUsedAgain) {
  const pid_t child = fork();
  if (child == 0) {
    const OutputFolder left(folder_ / "bag");
    const OutputFile file(folder_ / "bag" / "bag_0.db3");
    kill(getpid(), SIGKILL);
  }
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  ASSERT_FALSE(fs::is_empty(folder_ / "bag"));
  export_ros2_bag(fixture::small_sensors(), {}, folder_ / "bag");
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& each : fs::directory_iterator(folder_ / "bag")) ++count;
  EXPECT_EQ(count, 2u) << "bag_0.db3 and metadata.yaml";
}

// the next process removes the files that a killed process leaves, and keeps the files that a living one writes
TEST_F(ReplaceFile, FilesOfKilledProcessesAreRemoved) {
  fs::create_directory(folder_ / "x");
  const OutputFile own(folder_ / "x" / ".." / "own");  // the same folder under another name, for a second look
  const pid_t child = fork();
  if (child == 0) {
    const OutputFile left(folder_ / "a.h5");
    kill(getpid(), SIGKILL);
  }
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  ASSERT_EQ(files(), 3u);
  replace_file(folder_ / "b", "x");
  EXPECT_TRUE(fs::exists(own.unfinished()));
  EXPECT_EQ(files(), 3u) << "x, own and b";
}

TEST_F(ReplaceFile, ImpossiblePlacesAreNamed) {
  const auto complaint_of = [](const fs::path& path) { return test::complaint([&] { replace_file(path, "x"); }); };
  EXPECT_EQ(complaint_of(folder_ / "none/a"),
            (folder_ / "none/a").string() + ": cannot be written: No such file or directory");
  replace_file(folder_ / "file", "x");
  EXPECT_THAT(complaint_of(folder_ / "file/a"), HasSubstr("Not a directory"));
  fs::create_directories(folder_ / "folder/full");
  EXPECT_THAT(complaint_of(folder_ / "folder"), HasSubstr("Is a directory"));
  EXPECT_THAT(complaint_of("/proc/tumble_recording"), HasSubstr("cannot be written"))
      << "not even root can write there";
  EXPECT_EQ(files(), 2u) << "no temporary file stays";
}

TEST_F(ReplaceFile, ReadOnlyFolderIsRefused) {
  using fs::perms;
  fs::permissions(folder_, perms::owner_read | perms::owner_exec | perms::others_read | perms::others_exec);
  // root may write into a read-only folder, so another user tries
  constexpr uid_t kNobody = 65534;
  const bool root = geteuid() == 0;
  if (root && seteuid(kNobody) != 0) {  // a container with one user: in the kernel's folders, root cannot write either
    fs::permissions(folder_, perms::owner_all);
    EXPECT_THAT(test::complaint([] { replace_file("/sys/kernel/a", "x"); }), HasSubstr("cannot be written"));
    return;
  }
  const std::string message = test::complaint([&] { replace_file(folder_ / "a", "x"); });
  if (root) {
    ASSERT_EQ(seteuid(0), 0);
  }
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_THAT(message, HasSubstr("Permission denied"));
}

TEST_F(ReplaceFile, ADeviceAPipeAndASocketStay) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(test::complaint([&] { replace_file(pipe, "x"); }), HasSubstr("it must be a regular file"));
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_THAT(test::complaint([&] { replace_file("/dev/null", "x"); }), HasSubstr("it must be a regular file"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(ReplaceFile, FollowsSymbolicLinks) {
  fs::create_directory(folder_ / "far");
  fs::create_symlink("far/target", folder_ / "link");
  fs::create_symlink("link", folder_ / "link_to_link");
  replace_file(folder_ / "link_to_link", "made at its end");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link_to_link"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read_file(folder_ / "far/target"), "made at its end");
  replace_file(folder_ / "link", "replaced");
  EXPECT_EQ(read_file(folder_ / "far/target"), "replaced");
  fs::create_symlink("round", folder_ / "round");
  EXPECT_THAT(test::complaint([&] { replace_file(folder_ / "round", "x"); }), HasSubstr("symbolic links"));
}

TEST_F(ReplaceFile, KeepsModeAndOwner) {
  const fs::path path = folder_ / "a";
  replace_file(path, "first");
  ASSERT_EQ(chmod(path.c_str(), 0600), 0);
  const bool root = geteuid() == 0;
  if (root) {
    ASSERT_EQ(chown(path.c_str(), 1234, 1235), 0);
  }
  replace_file(path, "second");
  struct stat status {};
  ASSERT_EQ(stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777u, 0600u);
  EXPECT_EQ(status.st_uid, root ? 1234u : geteuid());
  EXPECT_EQ(status.st_gid, root ? 1235u : getegid());
  EXPECT_EQ(read_file(path), "second");
}

TEST_F(ReplaceFile, AnInputIsKnownUnderAnyName) {
  replace_file(folder_ / "in", "x");
  fs::create_symlink("in", folder_ / "link");
  fs::create_hard_link(folder_ / "in", folder_ / "hard");
  const std::vector<fs::path> inputs = {"", folder_ / "none", folder_ / "in"};
  for (const char* name : {"in", "link", "hard", "../"}) {
    const fs::path output = name == std::string("../") ? folder_ / "." / "in" : folder_ / name;
    EXPECT_THAT(test::complaint([&] { require_not_an_input(output, inputs); }), HasSubstr("both input and output"))
        << output;
  }
  replace_file(folder_ / "other", "x");
  EXPECT_NO_THROW(require_not_an_input(folder_ / "other", inputs));
  EXPECT_NO_THROW(require_not_an_input(folder_ / "absent", inputs));
}

TEST_F(ReplaceFile, AFileOfAFolderThatIsReadIsNotWrittenOver) {
  fs::create_directories(folder_ / "in/deep");
  replace_file(folder_ / "in/a", "x");
  replace_file(folder_ / "in/deep/b", "x");
  replace_file(folder_ / "inside", "x");
  fs::create_directory_symlink("in", folder_ / "link");
  fs::create_symlink("in/a", folder_ / "to_a");
  for (const char* input : {"in", "link", "in/"}) {
    const std::vector<fs::path> inputs = {"", folder_ / "none", folder_ / input};
    for (const char* output : {"in/a", "link/a", "in/deep/b", "in/deep/../a", "to_a"}) {
      EXPECT_THAT(test::complaint([&] { require_not_an_input(folder_ / output, inputs); }),
                  HasSubstr("is one of the files in the input folder"))
          << output;
    }
    EXPECT_NO_THROW(require_not_an_input(folder_ / "inside", inputs)) << "a name that begins alike";
    EXPECT_NO_THROW(require_not_an_input(folder_ / "in/new", inputs)) << "nothing is written over";
  }
}

TEST_F(ReplaceFile, AFolderIsFreshOrRefusedAndGoesWithoutBeingKept) {
  const fs::path made = folder_ / "a/b";
  {
    const OutputFolder output(made);
    replace_file(made / "half", "x");
  }
  EXPECT_FALSE(fs::exists(made));
  {
    OutputFolder output(made);
    replace_file(made / "whole", "x");
    output.keep();
  }
  EXPECT_EQ(read_file(made / "whole"), "x");
  EXPECT_THAT(test::complaint([&] { OutputFolder again(made); }), HasSubstr("the output folder contains files"));
  EXPECT_EQ(read_file(made / "whole"), "x");
  EXPECT_THAT(test::complaint([&] { OutputFolder file(made / "whole"); }), HasSubstr("cannot be written"));
  fs::create_directory(folder_ / "empty");
  {
    const OutputFolder output(folder_ / "empty");
    replace_file(folder_ / "empty/half", "x");
  }
  EXPECT_TRUE(fs::is_empty(folder_ / "empty"));
}

/// Exports a bag with little disk space; the process ends with 0 when BadInput reports that and no file is left.
[[noreturn]] void export_with_little_room(const fs::path& folder) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{4096, 4096};
  setrlimit(RLIMIT_FSIZE, &limit);
  const sim::Recording recording = fixture::recording();
  const std::string message = test::complaint([&] { export_ros1_bag(recording.sensors, {}, folder / "a.bag"); });
  std::cerr << message;
  // the process skips the leak check at its end, because the library keeps its buffers when its file cannot be closed
  std::_Exit(message.empty() || !fs::is_empty(folder) ? 1 : 0);
}

// the library closes the file in its destructor, which throws
TEST_F(ReplaceFile, AFullDiskEndsABagInOneLine) {
  EXPECT_EXIT(export_with_little_room(folder_), testing::ExitedWithCode(0), "a.bag: cannot be written");
}

/// Ends the process with 0 when a recording cannot be written, BadInput reports that and no file is left.
[[noreturn]] void write_with_little_room(const fs::path& folder, const std::string& old_bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{4096, 4096};
  setrlimit(RLIMIT_FSIZE, &limit);
  const sim::Recording recording = fixture::recording();
  const std::string message =
      test::complaint([&] { write_recording(folder / "a.h5", fixture::info(), recording.sensors, &recording.truth); });
  const auto left = std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  std::cerr << message;
  std::exit(message.empty() || left != 1 || read_file(folder / "a.h5") != old_bytes ? 1 : 0);
}

// A limit on the size of files makes write() fail midway as a full disk does (with EFBIG instead of ENOSPC).
TEST_F(ReplaceFile, AFullDiskLeavesTheOldFileAndNoPart) {
  const sim::Recording recording = fixture::recording();
  write_recording(folder_ / "a.h5", {}, recording.sensors, nullptr);
  const std::string old_bytes = read_file(folder_ / "a.h5");
  ASSERT_GT(old_bytes.size(), 4096u);
  EXPECT_EXIT(write_with_little_room(folder_, old_bytes), testing::ExitedWithCode(0),
              "a.h5: cannot be written: File too large");
}

}  // namespace
}  // namespace tumble::scenarios
