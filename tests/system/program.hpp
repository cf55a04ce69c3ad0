// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// The program as a child process: its standard output and error in files, and its exit status.
namespace tumble::system_test {

struct Ended {
  int status = -1;  ///< exit status; 128 + n if signal n ended it
  std::string out, err;
};

/// Runs the program in a child process and waits. `prepare` runs in the child before the program (limits, signals).
Ended run_program(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});

/// A child process that continues to run, for signals.
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
  std::filesystem::path folder_;
  pid_t pid_ = -1;
  bool reaped_ = false;
  int raw_status_ = 0;
};

/// An empty folder for the current test.
std::filesystem::path test_folder();
/// Returns a shortened scenario file of this name for tests that do not measure accuracy
/// (`stand_ins/short_scenario.hpp`), written once per process.
std::string shared_scenario(const std::string& name);
/// Prepares a child process: it uses the data of this tree, with shortened `hill` and `roll`. The folder belongs to the
/// process; its files are always identical, so a certificate measured with one folder is valid for the others.
std::function<void()> in_short_catalogue();
/// Returns the folder of `tumble run SHARED_SCENARIO --seed 1 -o ...`, written once per process. Tests must not change
/// it.
std::filesystem::path shared_run(const std::string& scenario);

std::string read_file(const std::filesystem::path& path);
/// Returns the standard output as JSON; the test fails if it is invalid.
nlohmann::json json_of(const Ended& ended);
/// Returns the number of lines, all of which must be complete.
std::size_t line_count(const std::string& text);

}  // namespace tumble::system_test
