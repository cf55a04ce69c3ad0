// SPDX-License-Identifier: BSD-3-Clause
// Empty: the headers that the tests share are parsed once, as part of this file (tests/CMakeLists.txt).
