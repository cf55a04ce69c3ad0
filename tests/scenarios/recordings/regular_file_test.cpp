// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/regular_file.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "scenarios/estimates/estimate_file.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"

namespace tumble::scenarios {
namespace {

using test::complaint;

class RegularFile : public test::TemporaryFolder {
 protected:
  std::string refused(const std::string& name) const {
    const std::string said = complaint([&] { require_regular_file(folder_ / name); });
    EXPECT_EQ(complaint([&] { open_regular_file(folder_ / name); }), said);
    return said;
  }
};

TEST_F(RegularFile, IsTakenAlsoBehindALink) {
  fixture::put(folder_ / "file", "text");
  fs::create_symlink("file", folder_ / "link");
  for (const char* name : {"file", "link"}) {
    EXPECT_EQ(refused(name), "");
    std::string word;
    EXPECT_TRUE(open_regular_file(folder_ / name) >> word);
    EXPECT_EQ(word, "text");
  }
}

TEST_F(RegularFile, AnythingElseIsCalledWhatItIs) {
  const std::string at = folder_.string() + "/";
  EXPECT_EQ(refused("none"), at + "none: no such file");
  fs::create_symlink("none", folder_ / "to_none");
  EXPECT_EQ(refused("to_none"), at + "to_none: no such file");
  fixture::put(folder_ / "file", "text");
  EXPECT_EQ(refused("file/below"), at + "file/below: no such file");
  fs::create_directory(folder_ / "folder");
  EXPECT_EQ(refused("folder"), at + "folder: is a folder; it must be a file");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(refused("pipe"), at + "pipe: is a pipe; it must be a regular file");
  fs::create_symlink("/dev/zero", folder_ / "device");
  EXPECT_EQ(refused("device"), at + "device: is a device; it must be a regular file");
  fs::create_symlink("ring", folder_ / "ring");
  EXPECT_THAT(refused("ring"), HasSubstr("ring: cannot be read: Too many levels of symbolic links"));
  EXPECT_THAT(refused(std::string(300, 'x')), HasSubstr("cannot be read: File name too long"));

  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string socket_at = at + "socket";
  if (socket_at.size() >= sizeof address.sun_path) return;  // the path of the test folder is too long
  socket_at.copy(address.sun_path, socket_at.size());
  const int made = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(made);
  EXPECT_EQ(refused("socket"), socket_at + ": is a socket; it must be a regular file");
}

TEST_F(RegularFile, WhatIsReadOnceMayBeAPipe) {
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(complaint([&] { require_file(folder_ / "pipe"); }), "");
  EXPECT_THAT(complaint([&] { require_file(folder_); }), HasSubstr("is a folder; it must be a file"));
}

// opening a pipe for reading would wait for a writer
TEST_F(RegularFile, ReadersRefuseAPipeAndDoNotWaitForIt) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string said = pipe.string() + ": is a pipe; it must be a regular file";
  EXPECT_EQ(complaint([&] { import_imu_csv(pipe, {}); }), said);
  EXPECT_EQ(complaint([&] { import_ros1_bag(pipe, {}); }), said);
  EXPECT_EQ(complaint([&] { import_ros2_bag(pipe, {}); }), said);
  EXPECT_EQ(complaint([&] { import_mcap(pipe, {}); }), said);
  EXPECT_EQ(complaint([&] { pose_format(pipe); }), said);
  EXPECT_FALSE(is_pose_table(pipe));
  EXPECT_EQ(complaint([&] { read_pose_table(pipe, false); }), said);
  Kind kind{};
  std::string method;
  fs::create_directory(folder_ / "estimate");
  ASSERT_EQ(mkfifo((folder_ / "estimate/estimate.json").c_str(), 0600), 0);
  EXPECT_THAT(complaint([&] { read_estimate(folder_ / "estimate", kind, method, Frame::body); }),
              HasSubstr("estimate.json: is a pipe"));
}

}  // namespace
}  // namespace tumble::scenarios
