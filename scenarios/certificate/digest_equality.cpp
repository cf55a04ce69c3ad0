// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/certificate/set_up.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/processes/process.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/unfinished.hpp"
#include "sim/simulate.hpp"

namespace tumble::scenarios {

namespace {

std::string digest_of(const CertificateInput& input, const sim::Situation& situation, int threads) {
  const sim::Recording recording = sim::simulate(build(input, situation), threads);
  return digest(recording.sensors, &recording.truth);
}

std::string digest_after_restart(const CertificateInput& input, const std::string& scenario, std::uint64_t seed) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("tumble_certify_" + std::to_string(getpid()) + ".h5");
  const Unfinished gone_on_signals(file, Unfinished::Kind::file);
  const std::string root = "TUMBLE_DATA=" + input.data.root.string();
  Process process(
      [&](int fd) {
        dup2(fd, STDOUT_FILENO);
        putenv(const_cast<char*>(root.c_str()));
        const std::string seed_text = std::to_string(seed);
        execl(input.program.c_str(), "tumble", "record", scenario.c_str(), "--seed", seed_text.c_str(), "-o",
              file.c_str(), "--json", "--quiet", static_cast<char*>(nullptr));
        throw std::runtime_error("cannot be started");
      },
      false);
  std::string text;
  while (process.read_available(text)) usleep(20000);
  const Process::End end = process.wait();
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  if (!end.normal) throw std::runtime_error(input.program.string() + " " + end.describe());
  return nlohmann::json::parse(text).at("digest").get<std::string>();
}

CertificateEntry entry(const std::string& row, const std::string& subject, const std::string& law, int differing) {
  return {row, subject, law, "1", static_cast<double>(differing), 0.0, 0.0, ""};
}

}  // namespace

std::vector<CertificateEntry> certify_digests(const CertificateInput& input, const DigestSetup& setup) {
  sim::Situation first = draw(input.data, load_scenario(input.data, setup.scenario), setup.seed);
  sim::Situation second = draw(input.data, load_scenario(input.data, setup.other_scenario), setup.seed);
  first.duration_s = second.duration_s = setup.duration_s;
  sim::Situation first_again = first, second_again = second;
  first_again.duration_s += setup.disturbance;
  second_again.duration_s += setup.disturbance;

  const std::string first_forward = digest_of(input, first, 1), second_forward = digest_of(input, second, 1);
  int threads = 0;
  for (const int count : {2, 4}) threads += digest_of(input, first_again, count) != first_forward ? 1 : 0;
  int order = digest_of(input, second_again, 1) != second_forward ? 1 : 0;
  order += digest_of(input, first_again, 1) != first_forward ? 1 : 0;
  std::vector<CertificateEntry> entries = {
      entry("digest_threads", setup.scenario,
            "recordings with 2 and 4 threads equal the recording with 1 thread; the value is the number of digests "
            "that differ",
            threads),
      entry("digest_order", setup.scenario + ", " + setup.other_scenario,
            "simulated runs in reverse order give equal recordings; the value is the number of digests that differ",
            order)};

  CertificateEntry restart =
      entry("digest_restart", setup.other_scenario,
            "a restarted program gives an equal recording; the value is the number of digests that differ", 0);
  try {
    const sim::Situation whole = draw(input.data, load_scenario(input.data, setup.other_scenario), setup.seed);
    const std::string again = digest_after_restart(input, setup.other_scenario, setup.restart_seed);
    restart.value = again != digest_of(input, whole, 1) ? 1.0 : 0.0;
  } catch (const std::exception& error) {
    restart.value = std::nan("");
    restart.note = error.what();
  }
  entries.push_back(restart);
  return entries;
}

}  // namespace tumble::scenarios
