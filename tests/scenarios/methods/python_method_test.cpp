// SPDX-License-Identifier: BSD-3-Clause
// The test checks a Python function as a method: what it receives, what it may return, and every way in which it may
// fail.
#include "scenarios/external/python_method.hpp"
#include "scenarios/methods/registry.hpp"

#include <stdlib.h>

#include "tests/scenarios/methods/external_runs.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

class PythonMethod : public testing::ExternalRuns {
 protected:
  // tools/setup installs numpy for Debian's Python; another Python may come first in PATH
  static void SetUpTestSuite() { setenv("TUMBLE_PYTHON", "/usr/bin/python3", 0); }

  fs::path function(const std::string& kind, const std::string& body, const std::string& more = "") const {
    write("theirs.py", "import os, sys, time\nimport numpy as np\n\ndef " + kind + "(recording):\n    " + body + "\n");
    write("theirs.yaml", "name: theirs\nkind: " + kind + "\npython: theirs.py\n" + more);
    return folder_ / "theirs.yaml";
  }
  std::string wrong(const std::string& kind, const std::string& returned) const {
    return refused(
        function(kind, "imu = recording.imus[0]; n = len(imu.time_ns); t = imu.time_ns; return " + returned));
  }
};

TEST_F(PythonMethod, AnswersAsTheSameMethodOfOursDoes) {
  expect_same_as_raw(run(function("rate", "return recording.imus[0].gyro")));
}

TEST_F(PythonMethod, AFileAloneIsAMethodOfItsName) {
  write("believer.py",
        "def helper(x):\n    return x\n\ndef rate(recording):\n    return helper(recording.imus[0].gyro)\n");
  const Method method = external_method(folder_ / "believer.py");
  EXPECT_EQ(method.info.name, "believer");
  EXPECT_EQ(method.info.kind, Kind::rate);
  EXPECT_EQ(method.run(recording().sensors, {}, {}).rates.size(), recording().sensors.imus[0].time_ns.size());
  for (const char* body :
       {"rate = lambda r: r.imus[0].gyro\n",
        "class Mine:\n    def __call__(self, r):\n        return r.imus[0].gyro\n\nrate = Mine()\n",
        "rate = 100\ndef attitude(r):\n    return r.imus[0].time_ns, [[0, 0, 0, 1]] * len(r.imus[0].time_ns)\n"}) {
    write("called.py", body);
    EXPECT_NO_THROW(run(folder_ / "called.py")) << body;
  }
  write("number.py", "rate = 100\n");
  EXPECT_THAT(refused(folder_ / "number.py"), HasSubstr("no function 'rate'"));
  write("two.py", "def rate(r):\n    pass\ndef slam(r):\n    pass\n");
  EXPECT_THAT(refused(folder_ / "two.py"), HasSubstr("2 functions"));
  write("none.py", "def rates(r):\n    pass\n");
  EXPECT_THAT(refused(folder_ / "none.py"), HasSubstr("0 functions"));
  write("My-Method.py", "def rate(r):\n    pass\n");
  EXPECT_THAT(refused(folder_ / "My-Method.py"), HasSubstr("My-Method"));
}

TEST_F(PythonMethod, CovariancesComeAsATupleOrByName) {
  const std::string covariance =
      "np.tile(np.diag([1.0, 2.0, 3.0]) + 0.5 * (np.eye(3, k=1) + np.eye(3, k=-1)), (n, 1, 1))";
  const std::string of = "imu = recording.imus[0]; n = len(imu.time_ns); ";
  const Estimate tuple = run(function("rate", of + "return imu.gyro, " + covariance));
  EXPECT_EQ(tuple.rates[7].covariance_rad2_s2, (Matrix3d() << 1, 0.5, 0, 0.5, 2, 0.5, 0, 0.5, 3).finished());
  const Estimate named = run(function(
      "rate", of + "import types; return types.SimpleNamespace(rate=imu.gyro, covariance=" + covariance + ")"));
  EXPECT_EQ(named.rates[7].covariance_rad2_s2, tuple.rates[7].covariance_rad2_s2);
}

TEST_F(PythonMethod, PosesAttitudesAndMaps) {
  const std::string two = "t = np.array([100, 200]); q = np.array([[0, 0, 0, 1], [0, 0, 0.6, 0.8]]); ";
  const Estimate attitudes = run(function("attitude", two + "return t, q"));
  ASSERT_EQ(attitudes.attitudes.size(), 2u);
  EXPECT_TRUE(attitudes.poses.empty());
  EXPECT_NEAR(attitudes.attitudes[1].orientation_W.z(), 0.6, 1e-15);
  const Estimate poses = run(function("position", two + "return t, np.array([[1, 2, 3], [4, 5, 6]]), q"));
  ASSERT_EQ(poses.poses.size(), 2u);
  EXPECT_EQ(poses.poses[1].position_W_m, Vector3d(4, 5, 6));
  const Estimate map =
      run(function("slam", two + "return t, np.zeros((2, 3)), q, recording.lidars[0][3].position", "frame: lidar\n"));
  EXPECT_EQ(map.frame, Frame::lidar);
  const sim::LidarRecord& lidar = recording().sensors.lidars[0];
  ASSERT_EQ(map.map.size(), lidar.sweep_first[4] - lidar.sweep_first[3]);
  EXPECT_EQ(map.map[5].position_W_m, lidar.position_L_m[lidar.sweep_first[3] + 5]);
  const Estimate bare = run(function("slam", two + "return t, np.zeros((2, 3)), q, np.zeros((0, 3))"));
  EXPECT_EQ(bare.poses.size(), 2u);
  EXPECT_TRUE(bare.map.empty());
}

TEST_F(PythonMethod, SeesTheSensorsAloneAndCannotChangeThem) {
  EXPECT_THAT(no_answer(function("rate", "raise ValueError(sorted(vars(recording)))")).second,
              HasSubstr("['gravity_m_s2', 'imus', 'lidars', 'robot', 'series', 'sphere_radius_m']"));
  EXPECT_THAT(no_answer(function("rate", "recording.imus[0].gyro[0] = 0")).second, HasSubstr("read-only"));
  EXPECT_THAT(no_answer(function("rate", "os.pwrite(int(sys.argv[4]), b'x', 0)")).second, HasSubstr("PermissionError"));
}

TEST_F(PythonMethod, SeesTheSeriesOfOtherSensors) {
  sim::Sensors sensors = recording().sensors;
  const std::size_t samples = sensors.imus[0].time_ns.size();
  // a quantity may have any name of letters, digits and _, also the name of an entry in the exchanged data
  sensors.series.push_back(
      {"barometer", "barometer", "bmp388", 20000000, Eigen::Isometry3d::Identity(), {}, {}, {{"air_k", 288.0}}});
  sim::SeriesRecord& series = sensors.series.back();
  for (const char* name : {"pressure_pa", "offset"}) series.quantities.push_back({name, "Pa", 2.0, {}});
  for (std::size_t k = 0; k < samples; ++k) {
    series.time_ns.push_back(static_cast<std::int64_t>(k));
    series.quantities[0].values.push_back(1e5 + static_cast<double>(k));
    series.quantities[1].values.push_back(-static_cast<double>(k));
  }
  const Method method = external_method(function(
      "rate",
      "b, = recording.series; assert b.noise['offset'] == 2 and b.units['pressure_pa'] == 'Pa' and b.constants == "
      "{'air_k': 288} and b.kind == "
      "'barometer' and b.T_BX.shape == (4, 4)\n    return np.stack((b.values['pressure_pa'], b.values['offset'], "
      "b.time_ns), 1)"));
  const Estimate estimate = method.run(sensors, {}, {});
  ASSERT_EQ(estimate.rates.size(), samples);
  EXPECT_EQ(estimate.rates[3].w_WI_I_rad_s, Vector3d(1e5 + 3.0, -3.0, 3.0));
}

TEST_F(PythonMethod, WhatItRaisesIsTheMessageWithPlace) {
  const auto [why, what] = no_answer(function("rate", "return 1 / len(recording.robot[:0])"));
  EXPECT_EQ(why, NoAnswer::Why::crashed);
  EXPECT_THAT(what,
              AllOf(HasSubstr("ZeroDivisionError"), HasSubstr("theirs.py\", line 5"), Not(HasSubstr("<string>"))));
  EXPECT_THAT(no_answer(function("rate", "return (")).second, HasSubstr("SyntaxError"));
  EXPECT_THAT(no_answer(function("rate", "sys.exit(3)")).second, HasSubstr("SystemExit: 3"));
}

TEST_F(PythonMethod, ACrashAHangAndALackOfMemoryAreNoAnswer) {
  EXPECT_THAT(no_answer(function("rate", "os.kill(os.getpid(), 11)")).second, HasSubstr("signal 11"));
  EXPECT_EQ(no_answer(function("rate", "time.sleep(600)", "time_limit_s: 1\n")).first, NoAnswer::Why::timed_out);
  const auto [why, what] = no_answer(function("rate", "return np.ones(10**9)", "memory_limit_mib: 1024\n"));
  EXPECT_EQ(why, NoAnswer::Why::crashed);
  EXPECT_THAT(what, HasSubstr("Unable to allocate"));
}

TEST_F(PythonMethod, WhatItReturnsIsRefusedWithPlaceValueAndBound) {
  EXPECT_THAT(wrong("rate", "None"), HasSubstr("nothing was returned"));
  EXPECT_THAT(wrong("rate", "'fast'"), HasSubstr("must be an array of numbers; it is a str"));
  EXPECT_THAT(wrong("rate", "imu.gyro[1:]"),
              HasSubstr("must be (" + std::to_string(recording().sensors.imus[0].time_ns.size())));
  EXPECT_THAT(wrong("rate", "imu.gyro[:, :2]"), HasSubstr("has the shape"));
  EXPECT_THAT(wrong("rate", "np.where(np.arange(n)[:, None] == 17, np.nan, imu.gyro)"),
              AllOf(HasSubstr("rate[17] is [nan, nan, nan]"), HasSubstr("1 of")));
  EXPECT_THAT(wrong("rate", "imu.gyro, np.full((n, 3, 3), np.inf)"), HasSubstr("covariance[0]"));
  EXPECT_THAT(wrong("rate", "imu.gyro, np.zeros((n, 3))"), HasSubstr("covariance has the shape"));
  EXPECT_THAT(wrong("rate", "1, 2, 3"), HasSubstr("at most 2"));
  EXPECT_THAT(wrong("attitude", "t"), HasSubstr("has no quaternion"));
  EXPECT_THAT(wrong("attitude", "t * 1e-9, np.tile([0, 0, 0, 1], (n, 1))"), HasSubstr("must be integers"));
  EXPECT_THAT(wrong("attitude", "t[:0], np.zeros((0, 4))"), HasSubstr("is empty"));
  EXPECT_THAT(wrong("attitude", "np.minimum(t, t[9]), np.tile([0, 0, 0, 1], (n, 1))"), HasSubstr("time_ns[10]"));
  EXPECT_THAT(wrong("attitude", "t, np.tile([0, 0, 0, 2], (n, 1))"), HasSubstr("norm 2"));
  EXPECT_THAT(wrong("position", "t, np.full((n, 3), 1e300), np.tile([0, 0, 0, 1], (n, 1))"),
              AllOf(HasSubstr("pose 0 of the result"), HasSubstr("within 1e+07 m")));
  EXPECT_THAT(wrong("attitude", "t + 10**15, np.tile([0, 0, 0, 1], (n, 1))"), HasSubstr("the time stamp is 1000000"));
  EXPECT_THAT(wrong("slam", "t, np.zeros((n, 3)), np.tile([0, 0, 0, 1], (n, 1)), np.full((1, 3), 1e300)"),
              HasSubstr("map: point 0"));
  EXPECT_THAT(wrong("rate", "imu.gyro + 1e7"), HasSubstr("rate[0]: the rate is (1e+07"));
  EXPECT_THAT(refused(function("rate", "os.ftruncate(int(sys.argv[5]), 10**11); os._exit(0)")),
              HasSubstr("100000000000 bytes; for this recording, it may have at most"));
  EXPECT_THAT(refused(function("rate", "os._exit(0)")), HasSubstr("ended before the function returned a result"));
  EXPECT_THAT(refused(function("rate", "os.write(int(sys.argv[5]), b'x' * 100); os._exit(0)")), HasSubstr("damaged"));
  EXPECT_THAT(refused(function("rate", "pass", "function: rote\n")), HasSubstr("no function 'rote'"));
}

// an earlier version accepted each of these values and converted it to other numbers
TEST_F(PythonMethod, WhatWouldLoseAPartOfItselfIsRefused) {
  const std::string q = "np.tile([0, 0, 0, 1], (n, 1))";
  EXPECT_THAT(wrong("rate", "imu.gyro * 1j"),
              HasSubstr("rate must be an array of numbers; it is an array of complex128"));
  EXPECT_THAT(wrong("rate", "(imu.gyro * 1j).tolist()"), HasSubstr("it is a list"));
  EXPECT_THAT(wrong("position", "t, np.zeros((n, 3)) + 1j, " + q), HasSubstr("position must be an array of numbers"));
  EXPECT_THAT(wrong("rate", "imu.gyro.astype(str)"), HasSubstr("it is an array of <U"));
  EXPECT_THAT(wrong("rate", "imu.gyro.astype(str).astype(object)"), HasSubstr("it is an array of object"));
  EXPECT_THAT(wrong("rate", "imu.gyro > 0"), HasSubstr("it is an array of bool"));
  EXPECT_THAT(wrong("rate", "np.ma.masked_greater(imu.gyro, 0)"), HasSubstr("rate is masked in places"));
  EXPECT_THAT(wrong("attitude", "np.ma.masked_less(t, t[9]), " + q), HasSubstr("time_ns is masked"));
  EXPECT_THAT(
      wrong("rate", "imu.gyro, np.where(np.arange(n)[:, None, None] < 3, np.eye(3), np.eye(3) + 0.5 * np.eye(3, k=1))"),
      AllOf(HasSubstr("covariance[3] is [[1.0, 0.5"), HasSubstr("must be symmetric")));
  for (const char* same :
       {"imu.gyro.astype(object)", "imu.gyro.tolist()", "np.ma.masked_greater(imu.gyro, 1e9)", "imu.gyro, None"})
    EXPECT_EQ(run(function("rate", std::string("imu = recording.imus[0]; return ") + same)).rates[7].w_WI_I_rad_s,
              recording().sensors.imus[0].gyro_rad_s[7])
        << same;
}

TEST_F(PythonMethod, TimesInAnotherUnitAreNamed) {
  const std::string all = ", np.zeros((len(s), 3)), np.tile([0, 0, 0, 1], (len(s), 1))";
  const auto of = [&](const std::string& times) {
    return function("slam", "s = np.unique(recording.imus[0].time_ns" + times + "); return s" + all);
  };
  EXPECT_THAT(
      refused(of(" // 1000")),
      AllOf(HasSubstr("pose "), HasSubstr("must be in nanoseconds; the time stamps seem to be in microseconds")));
  EXPECT_THAT(refused(of(" // 1000000")), HasSubstr("the time stamps seem to be in milliseconds"));
  EXPECT_THAT(refused(of("[:10] // 10**5")),
              AllOf(HasSubstr("must be in nanoseconds"), Not(HasSubstr("seem to be in"))));
  EXPECT_THAT(refused(of(" * 1000")), AllOf(HasSubstr("stamp"), HasSubstr("s")));
  EXPECT_EQ(run(of("[:9] // 1000")).poses.size(), 9u);
  EXPECT_GT(run(of("[5:50]")).poses.size(), 40u);
}

TEST_F(PythonMethod, DescriptionsAndInterpretersAreCheckedBeforeAnythingRuns) {
  EXPECT_THAT(refused(function("rate", "pass", "command: [true, '{output}']\n")), HasSubstr("one of the keys"));
  EXPECT_THAT(refused(function("rate", "pass", "output: rates\n")), HasSubstr("output"));
  EXPECT_THAT(refused(function("rate", "pass", "interpreter: [/usr/bin/python3, -I, -S]\n")),
              HasSubstr("has no numpy"));
  EXPECT_THAT(refused(function("rate", "pass", "interpreter: [no_such_python]\n")), HasSubstr("no_such_python"));
  write("gone.yaml", "name: gone\nkind: rate\npython: gone.py\n");
  EXPECT_THAT(refused(folder_ / "gone.yaml"), HasSubstr("is not a file"));
  write("both.yaml", "name: both\nkind: rate\ncommand: [true, '{output}']\nfunction: rate\n");
  EXPECT_THAT(refused(folder_ / "both.yaml"), HasSubstr("function"));
}

TEST_F(PythonMethod, AVersionContainsInterpreterAndFile) {
  const std::string first = external_method(function("rate", "return 1")).info.version;
  const std::string second = external_method(function("rate", "return 2")).info.version;
  EXPECT_THAT(first, AllOf(HasSubstr("Python 3"), HasSubstr("numpy"), HasSubstr("theirs.py")));
  EXPECT_NE(first, second);
}

/// The test cuts a good answer at any length and damages any byte: the answer is accepted or rejected, and nothing else
/// happens.
TEST_F(PythonMethod, AnyAnswerInMemoryIsTakenOrRefused) {
  sim::Sensors one;
  one.imus.emplace_back();
  one.imus[0].time_ns = {1};
  std::string good = R"({"arrays":{"rate":{"dtype":"<f8","shape":[1,3],"offset":0}}})";
  good.insert(0, std::string(1, static_cast<char>(good.size())) + std::string(7, '\0'));
  good.resize(128, ' ');
  good.resize(152, '\0');
  const auto taken = [&](const std::string& bytes) {
    SharedMemory memory("test");
    memory.append(std::as_bytes(std::span(bytes)));
    try {
      return read_answer(memory, Kind::rate, Frame::imu, one).rates.size() == 1;
    } catch (const BadInput&) {
      return false;
    }
  };
  EXPECT_TRUE(taken(good));
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(taken(good.substr(0, size))) << size;
  for (std::size_t at = 0; at < good.size(); ++at)
    for (const char byte : {'\0', '9', '{', '\xff'}) taken(std::string(good).replace(at, 1, 1, byte));
}

}  // namespace
}  // namespace tumble::scenarios
