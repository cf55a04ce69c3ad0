// SPDX-License-Identifier: BSD-3-Clause
#include "system/program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "stand_ins/short_scenario.hpp"

namespace tumble::system_test {

namespace {

void redirect(const fs::path& path, int descriptor) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || dup2(file, descriptor) < 0) _exit(126);
}

fs::path fresh_folder(const std::string& name) {
  const fs::path folder = fs::path(testing::TempDir()) / ("tumble_" + std::to_string(getpid())) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

/// Contains a baseline, a method of this project and an oracle of each kind. Tests of the library run all methods.
const std::map<std::string, std::vector<std::string>> kSharedMethods = {
    {"hill",
     {"rate/raw", "rate/tumble_lag", "rate/oracle", "attitude/vqf", "attitude/tumble", "slam/icp_raw", "slam/tumble",
      "slam/oracle"}},
    {"roll",
     {"rate/raw", "attitude/madgwick", "position/rolling", "position/tumble_live", "position/oracle",
      "slam/poses_rolling"}}};

int exit_status(int raw) {
  return WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
}

}  // namespace

Running::Running(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  static int count = 0;
  folder_ = fresh_folder("child_" + std::to_string(++count));
  pid_ = fork();
  if (pid_ != 0) return;
  setpgid(0, 0);  // a separate process group, as a shell creates it
  redirect(folder_ / "out", STDOUT_FILENO);
  redirect(folder_ / "err", STDERR_FILENO);
  // a certificate measured by one test serves the others, and no file is written to the user's home
  setenv("TUMBLE_CACHE", test::certificates().c_str(), 1);
  if (prepare) prepare();
  const std::string program = test::program();
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(program.c_str(), words.data());
  _exit(127);
}

Running::~Running() {
  if (pid_ > 0 && !reaped_) {
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

void Running::signal(int number) const {
  kill(-pid_, number);
}

bool Running::has_ended() {
  if (!reaped_ && waitpid(pid_, &raw_status_, WNOHANG) == pid_) reaped_ = true;
  return reaped_;
}

Ended Running::wait() {
  if (!reaped_) waitpid(pid_, &raw_status_, 0);
  reaped_ = true;
  return {exit_status(raw_status_), read_file(folder_ / "out"), read_file(folder_ / "err")};
}

Ended run_program(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  return Running(arguments, prepare).wait();
}

Ended run_successfully(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  const Ended ended = run_program(arguments, prepare);
  EXPECT_EQ(ended.status, 0) << ended.err;
  return ended;
}

fs::path test_folder() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "_" + test->name();
  std::replace(name.begin(), name.end(), '/', '_');
  return fresh_folder(name);
}

std::string shared_scenario(const std::string& name) {
  static std::map<std::string, std::string> made;
  std::string& file = made[name];
  if (file.empty()) file = test::write_short_scenario(name, fresh_folder("scenario_" + name)).string();
  return file;
}

std::function<void()> in_short_catalogue() {
  static const fs::path folder = test::write_short_data(fresh_folder("data"));
  return [] { setenv("TUMBLE_DATA", folder.c_str(), 1); };
}

fs::path shared_run(const std::string& scenario) {
  static std::map<std::string, fs::path> made;
  const auto found = made.find(scenario);
  if (found != made.end()) return found->second;
  const fs::path folder = fresh_folder("run_" + scenario);
  std::vector<std::string> arguments = {"run", shared_scenario(scenario), "--seed", "1",
                                        "-o",  folder.string(),           "--json"};
  for (const std::string& method : kSharedMethods.at(scenario)) arguments.insert(arguments.end(), {"--method", method});
  const Ended ended = run_program(arguments);
  EXPECT_EQ(ended.status, 0) << ended.err;
  std::ofstream(folder / "out.json") << ended.out;
  return made[scenario] = folder;
}

fs::path short_stroll() {
  static const fs::path recording = [] {
    std::string text = read_file(test::source_dir() / "scenarios/catalogue/stroll.yaml");
    const std::string whole = "duration_s: 20\n";
    if (text.find(whole) == std::string::npos) throw std::runtime_error("stroll.yaml has no '" + whole + "'");
    text.replace(text.find(whole), whole.size(), "duration_s: 7\n");
    const fs::path folder = fs::path(testing::TempDir()) / ("tumble_stroll_" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "stroll.yaml") << text;
    const Ended ended = run_program(
        {"record", (folder / "stroll.yaml").string(), "--seed", "1001", "-o", (folder / "stroll.h5").string()});
    if (ended.status != 0) throw std::runtime_error(ended.err);
    return folder / "stroll.h5";
  }();
  return recording;
}

nlohmann::json json_of(const Ended& ended) {
  nlohmann::json document = nlohmann::json::parse(ended.out, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << "not JSON: " << ended.out << ended.err;
  return document;
}

double metric(const nlohmann::json& scored, const std::string& name) {
  for (const nlohmann::json& row : scored["scores"]) {
    if (row["metric"] == name) return row["value"].get<double>();
  }
  return std::nan("");
}

std::size_t line_count(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace tumble::system_test
