// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/run_again.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>

namespace tumble::scenarios {
namespace {

/// Returns what a shell makes of `words` as one argument.
std::string seen_by_a_shell(const std::string& words) {
  const std::string command = "printf '%s|' " + words;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::array<char, 256> buffer{};
  std::string out;
  while (pipe && std::fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) out += buffer.data();
  return out;
}

TEST(SweepNotes, AShellReadsAWordAsItWas) {
  for (const std::string text : {"hill", "o u t/x.db", "it's", "$HOME", "a;b", "`id`", "\"", "", "*", "-x", "x\\y"})
    EXPECT_EQ(seen_by_a_shell(shell_word(text)), text + "|") << text;
  EXPECT_NE(seen_by_a_shell("o u t/x.db"), "o u t/x.db|") << "negative control";
  EXPECT_EQ(shell_word("suites/my-own_1.yaml"), "suites/my-own_1.yaml") << "no quotes where none are needed";
}

TEST(SweepNotes, EachCommandStandsOnceInItsOrder) {
  std::string note = with_commands("", "hill --seeds 1..4");
  note = with_commands(note, "throw --seeds 1..4");
  note = with_commands(note, "hill --seeds 1..4\nhill --seeds 5..8");
  const std::vector<std::string> all = {"hill --seeds 1..4", "throw --seeds 1..4", "hill --seeds 5..8"};
  EXPECT_EQ(commands_of(note), all);
  EXPECT_TRUE(commands_of("").empty());
  EXPECT_EQ(with_commands(note, ""), note);
}

}  // namespace
}  // namespace tumble::scenarios
