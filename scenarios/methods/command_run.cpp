// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/command_run.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <system_error>

#include "scenarios/draw/strict_yaml.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kVersionLimit_s = 30.0;
constexpr std::size_t kFirstLineMax = 120;

}  // namespace

std::string without_trailing_folder(std::string text, const std::filesystem::path& folder) {
  const std::string whole = folder.string();
  for (std::size_t at = 0; !whole.empty() && (at = text.find(whole, at)) != std::string::npos;) {
    const bool within = at + whole.size() < text.size() && text[at + whole.size()] == '/';
    text.replace(at, whole.size() + (within ? 1 : 0), within ? "" : ".");
  }
  return text;
}

std::string with_output_tail(const std::string& what, const CommandEnd& end) {
  return end.output_tail.empty() ? what
                                 : fmt::format("{}; the last output of the command is: {}", what, end.output_tail);
}

void require_done(const CommandEnd& end) {
  if (end.how == CommandEnd::How::done) return;
  if (end.how == CommandEnd::How::timed_out)
    throw NoAnswer(
        NoAnswer::Why::timed_out,
        with_output_tail(
            fmt::format("{}; to change the limit, set the key time_limit_s in the method's description", end.reason),
            end));
  throw NoAnswer(NoAnswer::Why::crashed, with_output_tail(end.reason, end));
}

std::string reported_version(Command command, const std::string& place) {
  command.time_limit_s = kVersionLimit_s;
  const CommandEnd end = run_command(command);
  if (end.how != CommandEnd::How::done) throw BadInput(place + with_output_tail(end.reason, end));
  const std::string said = read_text_file(command.transcript);
  if (said.empty())
    throw BadInput(
        fmt::format("{}the version command printed nothing; it must print a text that identifies this version", place));
  return fmt::format("{}; the digest of the complete output is {:016x}",
                     said.substr(0, std::min(said.find('\n'), kFirstLineMax)), XXH3_64bits(said.data(), said.size()));
}

}  // namespace tumble::scenarios
