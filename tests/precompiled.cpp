// SPDX-License-Identifier: BSD-3-Clause
// This file has no code: the compiler parses the headers that the tests share once, as part of this file
// (tests/CMakeLists.txt).
