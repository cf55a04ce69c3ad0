// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/session.hpp"

#include "tests/testing.hpp"

namespace tumble::tools {
namespace {

TEST(TerminalText, KeepsTextAndLineEnds) {
  EXPECT_EQ(terminal_text("a b\nc"), "a b\nc");
  EXPECT_EQ(terminal_text("\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80"), "\xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
  EXPECT_EQ(terminal_text(""), "");
}

TEST(TerminalText, NothingThatMovesACursorPasses) {
  EXPECT_EQ(terminal_text("\x1b[2J\r\x07\x7f"), "?[2J???");
  EXPECT_EQ(terminal_text("\xc2\x9b"
                          "31m"),
            "?31m")
      << "an escape of one character (C1)";
  EXPECT_EQ(terminal_text(std::string_view("a\0b", 3)), "a?b");
}

TEST(TerminalText, BytesThatAreNoTextBecomeMarks) {
  EXPECT_EQ(terminal_text("\xff\xfe"), "??");
  EXPECT_EQ(terminal_text("\xc3"), "?");
  EXPECT_EQ(terminal_text("\xc3(\xe2\x82"), "?(??");
  EXPECT_EQ(terminal_text("\xc0\xaf"), "??") << "an overlong slash";
}

}  // namespace
}  // namespace tumble::tools
