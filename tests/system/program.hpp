// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// The program as a user has it: a child process, its standard output and error in files, its exit status.
namespace tumble::system_test {

struct Ended {
  int status = -1;  ///< exit status; 128 + n when signal n ended it
  std::string out, err;
};

/// Runs the program in a child and waits. `prepare` runs in the child before the program (limits, signals).
Ended run_program(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});

/// A child that runs on, to be signalled.
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

/// An empty folder of the test that runs.
std::filesystem::path test_folder();
/// What `tumble` takes for the scenario of that name where how well methods do is not asked: a file with less of it
/// (`stand_ins/short_scenario.hpp`), made once per process.
std::string shared_scenario(const std::string& name);
/// To prepare a child with: its data are this tree's, but `hill` and `roll` are the shared scenarios. In a folder of
/// the process, with the same files in each, so that a certificate measured over one serves the others.
std::function<void()> in_short_catalogue();
/// The folder of `tumble run SHARED_SCENARIO --seed 1 -o ...`, made once per process. Not to be changed.
std::filesystem::path shared_run(const std::string& scenario);

std::string read_file(const std::filesystem::path& path);
/// Standard output as JSON; a failure of the test when it is not.
nlohmann::json json_of(const Ended& ended);
/// Number of lines, all ended.
std::size_t line_count(const std::string& text);

}  // namespace tumble::system_test
