// SPDX-License-Identifier: BSD-3-Clause
#include "tests/scenarios/testing.hpp"
#include "tools/tumble/import_options.hpp"

namespace tumble::tools {
namespace {

class ImportFormat : public test::TemporaryFolder {
 protected:
  std::string format(const std::string& name) const {
    ImportOptions options;
    options.path = folder_ / name;
    try {
      return format_of(options);
    } catch (const scenarios::BadInput& error) {
      return error.what();
    }
  }
};

TEST_F(ImportFormat, EndingsInUpperCaseAreKnown) {
  write("a.CSV", "time,gyro_x\n1,2\n");
  write("A.BAG", ""), write("a.Mcap", ""), write("scans/1.PCD", ""), write("bins/1.BIN", "");
  EXPECT_EQ(format("a.CSV"), "csv");
  EXPECT_EQ(format("A.BAG"), "rosbag1");
  EXPECT_EQ(format("a.Mcap"), "mcap");
  EXPECT_EQ(format("scans"), "pcd");
  EXPECT_EQ(format("bins"), "kitti");
}

TEST_F(ImportFormat, TheContentCountsWithoutAnEndingOrAgainstIt) {
  write("run", "#ROSBAG V2.0\n"), write("run.db3", "\x89MCAP0\r\n"), write("other", "SQLite format 3");
  write("table", "time,gyro_x\n1,2\n");
  EXPECT_EQ(format("run"), "rosbag1");
  EXPECT_EQ(format("run.db3"), "mcap");
  EXPECT_EQ(format("other"), "rosbag2");
  EXPECT_EQ(format("table"), "csv");
  write("xsens.txt", "// Start Time: Unknown\n\nPacketCounter\tSampleTimeFine\tAcc_X\n1\t2\t3\n");
  write("poses.txt", "# poses\n1 0 0 0 0 0 0 1\n");
  EXPECT_EQ(format("xsens.txt"), "csv");
  EXPECT_EQ(format("poses.txt"), "tum");
  write("run.dat", "1 2 3\n");
  EXPECT_THAT(format("run.dat"), HasSubstr("the file name does not reveal the format; give --format"));
  EXPECT_THAT(format("absent.dat"), HasSubstr("the file does not exist"));
}

TEST_F(ImportFormat, AFolderOfBagsIsOneBagInParts) {
  write("parts/run_0.bag", ""), write("parts/run_1.bag", "");
  EXPECT_EQ(format("parts"), "rosbag1");
  write("loose/run_0.mcap", ""), write("loose/run_1.mcap", "");
  EXPECT_EQ(format("loose"), "rosbag2");
  write("loose/run_0.bag", "");
  EXPECT_THAT(format("loose"), HasSubstr("this folder contains files of the formats"));
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(format("empty"), HasSubstr("contains no .ply, .pcd, .vtk"));
}

}  // namespace
}  // namespace tumble::tools
