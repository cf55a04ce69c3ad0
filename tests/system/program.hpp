// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>

#include "tests/testing.hpp"
#include "tests/tree.hpp"

/// The functions here run the program as a user does: as a child process, with its standard output and error in files,
/// and its exit status.
namespace tumble::system_test {

using nlohmann::json;
using test::read_file;

struct Ended {
  int status = -1;  ///< exit status; 128 + n if signal n ended it
  std::string out, err;
};

/// Runs the program in a child process and waits. `prepare` runs in the child before the program (limits, signals).
Ended run_program(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});
/// Runs the program like `run_program`, and expects that its exit status is 0.
Ended run_successfully(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});

/// Running is a child process that runs on, so that the test can send it signals.
class Running {
 public:
  explicit Running(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  void signal(int number) const;
  bool has_ended();
  Ended wait();

 private:
  fs::path folder_;
  pid_t pid_ = -1;
  bool reaped_ = false;
  int raw_status_ = 0;
};

/// Returns an empty folder for the running test.
fs::path test_folder();
/// Returns the scenario that `tumble` uses under that name in tests that do not measure accuracy: a file of a shorter
/// one (`stand_ins/short_scenario.hpp`), made once per process.
std::string shared_scenario(const std::string& name);
/// Prepares a child whose data are this repository's, except that `hill` and `roll` are the shared scenarios. The data
/// are in a folder of the process with the same files in each process, so that a certificate measured over one serves
/// the others.
std::function<void()> in_short_catalogue();
/// Returns the folder of `tumble run SHARED_SCENARIO --seed 1 -o ...` with some methods of each kind, made once per
/// process. Tests must not change the folder.
fs::path shared_run(const std::string& scenario);

/// Returns a recording of `stroll`, seven seconds of 20, made once per process.
fs::path short_stroll();

/// Returns standard output as JSON; output that is no JSON fails the test.
nlohmann::json json_of(const Ended& ended);
/// Returns the value of a metric in the answer of `score --json`, or NaN when it is absent.
double metric(const nlohmann::json& scored, const std::string& name);
/// Returns the number of lines, which must all be terminated.
std::size_t line_count(const std::string& text);

}  // namespace tumble::system_test
