// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "scenarios/data_root.hpp"
#include "sim/recording.hpp"
#include "sim/situation.hpp"

namespace tumble::bench {

/// Returns the recording `folder`/`name`.h5 if the file exists. Otherwise simulates `situation`, and stores the
/// recording if `folder` is not empty.
sim::Recording kept_recording(const scenarios::DataRoot& data, const std::filesystem::path& folder,
                              const std::string& name, const std::string& scenario, std::uint64_t seed,
                              const std::function<sim::Situation()>& situation);

}  // namespace tumble::bench
