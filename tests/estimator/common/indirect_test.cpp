// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/parameters.hpp"

#include "tests/testing.hpp"

namespace tumble {
namespace {

struct Later;
/// Holder is a public struct, which is complete although `Later` is not.
struct Holder {
  HeapValue<Later> value;
};
struct Later {
  int number = 3;
};

TEST(HeapValue, CopiesTheValue) {
  Holder first;
  EXPECT_EQ(first.value->number, 3);
  Holder copy = first;
  copy.value->number = 4;
  EXPECT_EQ(first.value->number, 3);
  first = copy;
  copy.value->number = 5;
  EXPECT_EQ(first.value->number, 4);
  const Holder moved = std::move(first);
  EXPECT_EQ(moved.value->number, 4);
  first = moved;
  EXPECT_EQ(first.value->number, 4) << "assignment to a moved-from object";
  EXPECT_EQ(HeapValue<Later>(std::make_unique<Later>(Later{6}))->number, 6);
  static_assert(std::is_same_v<decltype(*moved.value), const Later&>, "a constant HeapValue has a constant value");
}

}  // namespace
}  // namespace tumble
