// SPDX-License-Identifier: BSD-3-Clause
// The test exports recordings to other formats and imports them. The library's tests cover the formats themselves.
#include "stand_ins/stand_ins.hpp"
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

/// The user's scenario has a sensor that is neither IMU nor lidar, and ends during the fall.
TEST(Exchange, OtherSensorsAreExportedOrReported) {
  const fs::path folder = test_folder();
  const std::string scenario = (folder / "falls.yaml").string(), recording = (folder / "a.h5").string();
  std::ofstream(scenario) << R"(name: falls
doc: A rig dropped, and no time to land.
duration_s: 1.5
world: {type: floor}
robot: {type: rig}
motion: {type: drop, rest_s: 1.2, height_m: 2}
sensors:
  - {name: imu, kind: imu, device: mti30, site: mti30}
  - {name: height, kind: barometer, device: bmp388, site: rs16}
)";
  const Ended recorded = run_successfully({"record", scenario, "--seed", "1", "-o", recording});
  EXPECT_THAT(recorded.out, testing::ContainsRegex("height +bmp388 +75"));
  EXPECT_THAT(recorded.err, HasSubstr("the robot still moves at the end of the recording, with "));
  const Ended csv = run_successfully({"export", recording, "--format", "csv", "-o", (folder / "csv").string()});
  EXPECT_EQ(line_count(read_file(folder / "csv" / "height.csv")), 76u);
  const Ended bag = run_successfully({"export", recording, "-o", (folder / "a.mcap").string()});
  EXPECT_THAT(bag.err, HasSubstr("sensor 'height' of kind 'barometer' is left out"));
}

// foreign data enter as files with sweeps, an IMU and reference poses, and the results are scores
TEST(Exchange, SweepsWithAnImuAndReferencePosesAreScored) {
  const fs::path folder = test_folder();
  const std::string recording = (shared_run("roll") / "recording.h5").string(), back = (folder / "back.h5").string();
  for (const auto& [format, out] : {std::pair{"ply", "ply"}, {"csv", "csv"}, {"tum", "truth.txt"}}) {
    run_successfully({"export", recording, "--format", format, "-o", (folder / out).string(), "--quiet"});
  }
  const Ended imported =
      run_successfully({"import", (folder / "ply").string(), "--imu", (folder / "csv" / "imu.csv").string(), "--device",
                        "phidget1044", "--lidar", "mid100", "--robot", "sphere", "--radius", "0.145", "--reference",
                        (folder / "truth.txt").string(), "--reference-frame", "body", "-o", back, "--json"});
  const json said = json_of(imported);
  EXPECT_EQ(said["has_reference"], true);
  EXPECT_EQ(said["point_times"], "measured");
  EXPECT_EQ(said["sweep_period_ns"], 100000000);
  EXPECT_EQ(said["origin_ns"], 1000000000000000000) << "all exports have one clock";
  // the truth as a foreign estimate has no error, and the truth shifted in time has one
  const std::vector<std::string> score = {"score", (folder / "truth.txt").string(), back, "--frame", "body", "--json"};
  const Ended scored = run_successfully(score);
  EXPECT_EQ(json_of(scored)["status"], "ok");
  EXPECT_LT(metric(json_of(scored), "ate_m"), 1e-9);
  const Ended of_lidar =
      run_program({"score", (folder / "truth.txt").string(), recording, "--frame", "centre", "--json"});
  EXPECT_GE(metric(json_of(of_lidar), "ate_m"), 0.0) << of_lidar.err;
  // an estimate from these files is scored like any other
  const Ended estimate =
      run_successfully({"estimate", back, "--method", "position/rolling", "-o", (folder / "e").string()});
  const Ended rolled = run_successfully({"score", (folder / "e").string(), back, "--json"});
  EXPECT_EQ(run_program({"score", back, (folder / "e").string(), "--json"}).out, rolled.out) << "the recording first";
  EXPECT_LT(metric(json_of(rolled), "position_end_error_m"), 1.0);
}

/// Copies some sweeps of an exported folder, with their stamps (one line each, after a comment line).
void copy_sweeps(const fs::path& from, const fs::path& to, int first, int count) {
  fs::create_directories(to);
  std::ifstream stamps(from / "lidar_times.txt");
  std::ofstream kept(to / "lidar_times.txt");
  std::string line;
  std::getline(stamps, line);
  for (int k = 0; std::getline(stamps, line) && k < first + count; ++k) {
    if (k < first) continue;
    const std::string number = std::to_string(k);
    const std::string name = "lidar_" + std::string(6 - number.size(), '0') + number + ".ply";
    fs::copy_file(from / name, to / name);
    kept << line << '\n';
  }
}

// the files contain only sweeps and reference poses, without an IMU
TEST(Exchange, SweepsAloneAreImported) {
  const fs::path folder = test_folder();
  const std::string recording = (folder / "hill.h5").string(), truth = (folder / "truth.txt").string();
  run_successfully({"record", "hill", "--seed", "1001", "-o", recording, "--quiet"});
  run_successfully({"export", recording, "--format", "ply", "-o", (folder / "all").string(), "--quiet"});
  run_successfully({"export", recording, "--format", "tum", "-o", truth, "--quiet"});
  copy_sweeps(folder / "all", folder / "some", 60, 12);  // the rig has landed and rocks
  const std::string back = (folder / "back.h5").string();
  const Ended imported = run_successfully({"import", (folder / "some").string(), "--lidar", "rs16", "--robot", "rig",
                                           "--reference", truth, "--reference-frame", "body", "-o", back, "--json"});
  EXPECT_EQ(json_of(imported)["sweeps"], 12);
  EXPECT_EQ(json_of(imported)["has_reference"], true);
  EXPECT_FALSE(json_of(imported).contains("samples"));
  // a method that needs an IMU reports that
  const Ended refused = run_program({"estimate", back, "--method", "slam/tumble", "-o", (folder / "x").string()});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("the method needs an IMU"));
}

TEST(Exchange, AnMcapIsRecognisedByItsNameAndContainsEstimates) {
  const fs::path folder = test_folder();
  const std::string recording = (shared_run("roll") / "recording.h5").string(), mcap = (folder / "a.mcap").string();
  const std::string estimate = (folder / "rolled").string(), back = (folder / "back.h5").string();
  run_successfully({"estimate", recording, "--method", "position/rolling", "-o", estimate, "--quiet"});
  const Ended exported =
      run_successfully({"export", recording, "--with-truth", "--estimate", estimate, "-o", mcap, "--json"});
  EXPECT_EQ(json_of(exported)["format"], "mcap");
  // the estimate's topic is a reference like the truth's: a comparison with it gives what `score` reports of the
  // estimate
  const std::vector<std::string> import = {"import", mcap, "--robot", "sphere", "--radius",
                                           "0.145",  "-o", back,      "--json"};
  std::vector<std::string> with_reference = import;
  with_reference.insert(with_reference.end(), {"--reference-topic", "/position_rolling"});
  const Ended imported = run_successfully(with_reference);
  EXPECT_EQ(json_of(imported)["has_reference"], true);
  EXPECT_THAT(json_of(imported)["notes"].dump(),
              HasSubstr("/position_rolling/points: the points are in frame 'world'"));
  const Ended tum = run_successfully({"export", back, "-o", (folder / "rolled.tum").string(), "--quiet"});
  const Ended again =
      run_successfully({"score", (folder / "rolled.tum").string(), recording, "--frame", "body", "--json"});
  EXPECT_NEAR(metric(json_of(again), "position_end_error_m"),
              metric(json_of(run_program({"score", estimate, recording, "--json"})), "position_end_error_m"), 0.02);
  for (const auto& [words, complaint] :
       {std::pair<std::vector<std::string>, const char*>{{"export", recording, "-o", (folder / "x").string()},
                                                         "--format is missing"},
        {{"export", recording, "-o", (folder / "x.tum").string(), "--estimate", estimate},
         "--estimate applies to bags only"},
        {{"export", recording, "-o", (folder / "x.mcap").string(), "--estimate", (folder / "none").string()},
         "none"}}) {
    const Ended refused = run_program(words);
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(line_count(refused.err), 1u) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr(complaint));
  }
}

TEST(Exchange, ATrajectoryAloneIsARecordingToScoreAgainst) {
  const fs::path folder = test_folder();
  std::ofstream(folder / "reference.txt") << "1617333602.0 0 0 0 0 0 0 1\n1617333602.1 1 0 0 0 0 0 1\n"
                                             "1617333602.2 2 0 0 0 0 0 1\n1617333602.3 3 0 0 0 0 0 1\n";
  std::ofstream(folder / "estimate.tum") << "1617333602.0 5 0 0 0 0 0 1\n1617333602.1 6 0 0 0 0 0 1\n"
                                            "1617333602.2 7 0 0 0 0 0 1\n1617333602.3 8 0.5 0 0 0 0 1\n";
  const std::string recording = (folder / "r.h5").string();
  const Ended imported = run_successfully({"import", (folder / "reference.txt").string(), "-o", recording, "--json"});
  EXPECT_EQ(json_of(imported)["origin_ns"], 1617333602000000000);
  const Ended scored = run_successfully({"score", (folder / "estimate.tum").string(), recording, "--json"});
  EXPECT_NEAR(metric(json_of(scored), "position_end_error_m"), 0.5, 1e-9);
  const Ended drawn = run_program({"render", recording, "-o", (folder / "x.png").string()});
  EXPECT_EQ(drawn.status, 2);
  EXPECT_THAT(drawn.err, HasSubstr("its world cannot be rendered"));
  const Ended estimated =
      run_program({"estimate", recording, "--method", "attitude/vqf", "-o", (folder / "e").string()});
  EXPECT_EQ(estimated.status, 2);
  EXPECT_THAT(estimated.err, HasSubstr("the method needs an IMU, but the recording contains no IMU"));
}

// a foreign TUM file is scored as position and as slam, over the whole recording and over half of it
TEST(Exchange, ATrajectoryIsScoredWithItsRotationAndOverWhatItCovers) {
  const fs::path folder = test_folder();
  const std::string recording = (shared_run("roll") / "recording.h5").string(), tum = (folder / "t.tum").string();
  run_successfully({"export", recording, "--format", "tum", "-o", tum, "--quiet"});
  const auto score = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"score", tum, recording, "--frame", "body", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words);
  };
  const json whole = json_of(score({"--kind", "slam"}));
  EXPECT_EQ(whole["kind"], "slam");
  EXPECT_EQ(whole["status"], "ok");
  EXPECT_EQ(whole["alignment"]["of"], "position and yaw");
  EXPECT_NEAR(whole["covered"]["share"].get<double>(), 1.0, 0.01);
  EXPECT_LT(metric(whole, "translation_error_end_m"), 1e-9);
  EXPECT_LT(metric(whole, "rotation_error_end_rad"), 1e-6);
  EXPECT_TRUE(std::isnan(metric(whole, "map_failed"))) << "it has no map that could have failed";
  EXPECT_EQ(json_of(score({}))["kind"], "position") << "a rolling sphere";
  EXPECT_THAT(score({}).err, HasSubstr("aligned in position and yaw"));
  EXPECT_THAT(score({"--kind", "slma"}).err, HasSubstr("did you mean 'slam'?"));

  // the file has the first half, and a turn of 0.1 rad about x at its last pose
  std::ifstream all(tum);
  std::vector<std::string> lines;
  for (std::string line; std::getline(all, line);) lines.push_back(line);
  ASSERT_GT(lines.size(), 100u);
  lines.resize(lines.size() / 2);
  std::istringstream last(lines.back());
  std::string stamp;
  double x, y, z, qx, qy, qz, qw;
  ASSERT_TRUE(last >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw);
  const double c = std::cos(0.05), s = std::sin(0.05);  // q * (s, 0, 0, c)
  std::ofstream half(tum);
  for (std::size_t k = 0; k + 1 < lines.size(); ++k) half << lines[k] << '\n';
  half << stamp << ' ' << x << ' ' << y << ' ' << z << ' ' << qw * s + qx * c << ' ' << qy * c + qz * s << ' '
       << qz * c - qy * s << ' ' << qw * c - qx * s << '\n';
  half.close();
  const Ended ended = score({"--kind", "slam"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const json part = json_of(ended);
  EXPECT_EQ(part["status"], "partial");
  EXPECT_THAT(run_program({"score", tum, recording, "--frame", "body", "--kind", "slam"}).out, HasSubstr("partial"));
  EXPECT_NEAR(part["covered"]["share"].get<double>(), 0.5, 0.05);
  EXPECT_NEAR(metric(part, "rotation_error_end_rad"), 0.1, 1e-3);
  EXPECT_LT(metric(part, "translation_error_end_m"), 1e-3);
  EXPECT_THAT(ended.err, HasSubstr("% of the recording's time"));
}

// the Python package imports these data sets, and the program names the function
TEST(Exchange, FilesOfOtherDataSetsAreReferredToThePythonPackage) {
  const fs::path folder = test_folder(),
                 wand = test::written(test::data_folders("repoimu").front()) / test::kStandInWand,
                 trial = test::written(test::data_folders("broad").front()) / "00_stand_in_hand.hdf5",
                 flight = folder / "flight.csv";
  std::ofstream(flight) << "timestamp_seconds,raw_angular_rate_x_deg_per_s\n1,2\n";
  for (const auto& [file, reader] :
       {std::pair{wand, "tumble.read_repoimu(\"TStick_StandIn.csv\")"}, std::pair{trial, "tumble.read_broad"},
        std::pair{flight, "tumble.read_airbrakes(\"flight.csv\")"}}) {
    const Ended ended = run_program({"import", file.string(), "-o", (folder / "x.h5").string()});
    EXPECT_EQ(ended.status, 2);
    EXPECT_EQ(line_count(ended.err), 1u) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr(reader));
  }
}

// The test checks exports and imports of one recording: their clock, tables, and what the user states.
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
  const Ended without = run_successfully(named);
  EXPECT_THAT(without.err, HasSubstr("--lever-arm is missing"));
  named.insert(named.end(), {"--lever-arm", "0", "0", "0"});
  const Ended stated = run_successfully(named);
  EXPECT_THAT(stated.err, Not(HasSubstr("--lever-arm")));
}

TEST(Exchange, AFolderOfTablesComesBackWithItsTruth) {
  const fs::path folder = test_folder();
  const std::string recording = (shared_run("hill") / "recording.h5").string(), csv = (folder / "csv").string();
  const std::string back = (folder / "back.h5").string(), tum = (folder / "truth.tum").string();
  for (const auto& [format, out] : {std::pair{"csv", csv}, {"tum", tum}})
    run_successfully({"export", recording, "--format", format, "-o", out, "--quiet"});
  std::ofstream(folder / "csv" / "notes.csv") << "day,weather\nMonday,rain\n";
  const Ended imported = run_successfully({"import", csv, "--robot", "rig", "-o", back, "--json"});
  const json said = json_of(imported);
  EXPECT_EQ(said["format"], "csv");
  EXPECT_EQ(said["has_reference"], true);
  EXPECT_THAT(said["notes"].dump(), HasSubstr("the reference poses come from truth.csv in the imported folder"));
  EXPECT_THAT(said["notes"].dump(), HasSubstr("'imu' is the primary IMU"));
  EXPECT_THAT(said["notes"].dump(), HasSubstr("notes.csv:1: the header contains no known column name"));
  const Ended scored = run_successfully({"score", tum, back, "--frame", "body", "--json"});
  EXPECT_LT(metric(json_of(scored), "ate_m"), 1e-6);
}

// a user wrote rates at the stamps of the exported table
TEST(Exchange, RatesAtTheStampsOfAnExportAreScored) {
  const fs::path folder = test_folder(), given = folder / "estimate";
  const fs::path rates = folder / "rates";
  const std::string recording = (shared_run("hill") / "recording.h5").string();
  run_successfully({"estimate", recording, "--method", "rate/raw", "-o", rates.string(), "--quiet"});
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
  const Ended of_export = run_successfully({"score", given.string(), recording, "--json"});
  EXPECT_EQ(json_of(of_export)["scores"],
            json_of(run_program({"score", rates.string(), recording, "--json"}))["scores"]);
}

}  // namespace
}  // namespace tumble::system_test
