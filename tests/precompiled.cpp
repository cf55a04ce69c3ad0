// SPDX-License-Identifier: BSD-3-Clause
// This file is empty. The headers that the tests share are precompiled with it (tests/CMakeLists.txt).
