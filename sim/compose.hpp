// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "sim/engine/model.hpp"

namespace tumble::sim::engine {

World compose(const ResolvedSituation& situation, const std::filesystem::path& models);

}  // namespace tumble::sim::engine
