// SPDX-License-Identifier: BSD-3-Clause
// The test checks exports and imports of one recording: their clock, tables, and what the user states.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "system/program.hpp"

namespace tumble::system_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

TEST(Exchange, AStatedZeroIsAPoseAndColumnsAreNamed) {
  const fs::path folder = test_folder();
  const std::string table = (folder / "a.csv").string(), back = (folder / "back.h5").string();
  {
    std::ofstream file(table);
    file << "clock,w1,w2,w3,f1,f2,f3\n";
    for (int k = 0; k < 100; ++k) file << 5000 * k << ",0,0,0,0,0,9.8\n";
  }
  const std::vector<std::string> import = {"import", table, "-o", back};
  EXPECT_THAT(run_program(import).err, HasSubstr("Name the columns: --columns time=NAME,gyro=X,Y,Z,accel=X,Y,Z"));
  std::vector<std::string> named = import;
  named.insert(named.end(), {"--columns", "time=clock,gyro=w1,w2,w3,accel=f1,f2,f3"});
  const Ended without = run_program(named);
  EXPECT_EQ(without.status, 0) << without.err;
  EXPECT_THAT(without.err, HasSubstr("--lever-arm is missing"));
  named.insert(named.end(), {"--lever-arm", "0", "0", "0"});
  const Ended stated = run_program(named);
  EXPECT_EQ(stated.status, 0) << stated.err;
  EXPECT_THAT(stated.err, testing::Not(HasSubstr("--lever-arm")));
}

TEST(Exchange, AFolderOfTablesComesBackWithItsTruth) {
  const fs::path folder = test_folder();
  const std::string recording = (shared_run("hill") / "recording.h5").string(), csv = (folder / "csv").string();
  const std::string back = (folder / "back.h5").string(), tum = (folder / "truth.tum").string();
  for (const auto& [format, out] : {std::pair{"csv", csv}, {"tum", tum}})
    ASSERT_EQ(run_program({"export", recording, "--format", format, "-o", out, "--quiet"}).status, 0);
  std::ofstream(folder / "csv" / "notes.csv") << "day,weather\nMonday,rain\n";
  const Ended imported = run_program({"import", csv, "--robot", "rig", "-o", back, "--json"});
  ASSERT_EQ(imported.status, 0) << imported.err;
  const json said = json_of(imported);
  EXPECT_EQ(said["format"], "csv");
  EXPECT_EQ(said["has_reference"], true);
  EXPECT_THAT(said["notes"].dump(), HasSubstr("the reference poses come from truth.csv in the imported folder"));
  EXPECT_THAT(said["notes"].dump(), HasSubstr("'imu' is the primary IMU"));
  EXPECT_THAT(said["notes"].dump(), HasSubstr("notes.csv:1: the header contains no known column name"));
  const Ended scored = run_program({"score", tum, back, "--frame", "body", "--json"});
  ASSERT_EQ(scored.status, 0) << scored.err;
  EXPECT_LT(metric(json_of(scored), "ate_m"), 1e-6);
}

// a user wrote rates at the stamps of the exported table
TEST(Exchange, RatesAtTheStampsOfAnExportAreScored) {
  const fs::path folder = test_folder(), given = folder / "estimate";
  const fs::path rates = folder / "rates";
  const std::string recording = (shared_run("hill") / "recording.h5").string();
  ASSERT_EQ(run_program({"estimate", recording, "--method", "rate/raw", "-o", rates.string(), "--quiet"}).status, 0);
  fs::copy(rates, given);
  std::istringstream rows(read_file(rates / "rates.csv"));
  std::ofstream moved(given / "rates.csv");
  std::string line;
  std::getline(rows, line);
  moved << line << '\n';
  while (std::getline(rows, line)) {
    const std::size_t comma = line.find(',');
    moved << std::stoll(line.substr(0, comma)) + 1'000'000'000'000'000'000 << line.substr(comma) << '\n';
  }
  moved.close();
  const Ended of_export = run_program({"score", given.string(), recording, "--json"});
  ASSERT_EQ(of_export.status, 0) << of_export.err;
  EXPECT_EQ(json_of(of_export)["scores"],
            json_of(run_program({"score", rates.string(), recording, "--json"}))["scores"]);
}

}  // namespace
}  // namespace tumble::system_test
