// SPDX-License-Identifier: BSD-3-Clause
#include "tools/html/html.hpp"

#include <nlohmann/json.hpp>

#include "tests/testing.hpp"

namespace tumble::tools::html {
namespace {

std::string base64_of(const std::string& text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  return base64(bytes);
}

TEST(Escaped, LeavesNoMarkup) {
  EXPECT_EQ(escaped("<img src=\"x\" onerror='alert(1)'> & co"),
            "&lt;img src=&quot;x&quot; onerror=&#39;alert(1)&#39;&gt; &amp; co");
  EXPECT_EQ(escaped("20–45°"), "20–45°");
}

TEST(ScriptJson, CannotEndItsElementAndMeansTheSame) {
  const nlohmann::json value = {{"name", "</script><script>alert(1)</script><!--"}};
  const std::string text = script_json(value.dump());
  EXPECT_EQ(text.find('<'), std::string::npos) << text;
  EXPECT_EQ(nlohmann::json::parse(text), value);
}

TEST(FileAddress, LeavesNothingThatAnAddressWouldReadOtherwise) {
  EXPECT_EQ(file_address("a.db.files/hill-3-replay.html"), "a.db.files/hill-3-replay.html");
  EXPECT_EQ(file_address("a b/c#d?e%f"), "a%20b/c%23d%3Fe%25f");
  EXPECT_EQ(file_address("javascript:x\"'<ä"), "javascript%3Ax%22%27%3C%C3%A4");
}

TEST(Base64, AgreesWithTheVectorsOfRfc4648) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foob"), "Zm9vYg==");
  EXPECT_EQ(base64_of("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::vector<std::uint8_t>{0xFB, 0xFF, 0xFE}), "+//+");
}

TEST(Cell, EscapesTextAndClass) {
  EXPECT_EQ(cell("<b>", "a\"b"), "<td class=\"a&quot;b\">&lt;b&gt;</td>");
}

}  // namespace
}  // namespace tumble::tools::html
