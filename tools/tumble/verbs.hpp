// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include "tools/tumble/session.hpp"

namespace CLI {
class App;
}

namespace tumble::tools {

/// What a verb does once its options are read; returns the exit status.
using Action = std::function<int()>;

/// One verb of the program: declares its options on `options` and returns its action. The session outlives the action.
struct Verb {
  const char* name;
  const char* doc;
  Action (*declare)(CLI::App& options, const Session& session);
};

/// All verbs, in the order of the data.
std::span<const Verb> verbs();

// One file each.
Action declare_list(CLI::App& options, const Session& session);
Action declare_run(CLI::App& options, const Session& session);
Action declare_record(CLI::App& options, const Session& session);
Action declare_estimate(CLI::App& options, const Session& session);
Action declare_score(CLI::App& options, const Session& session);
Action declare_sweep(CLI::App& options, const Session& session);
Action declare_merge(CLI::App& options, const Session& session);
Action declare_report(CLI::App& options, const Session& session);
Action declare_compare(CLI::App& options, const Session& session);
Action declare_sensitivity(CLI::App& options, const Session& session);
Action declare_render(CLI::App& options, const Session& session);
Action declare_replay(CLI::App& options, const Session& session);
Action declare_bench(CLI::App& options, const Session& session);
Action declare_gate(CLI::App& options, const Session& session);
Action declare_triage(CLI::App& options, const Session& session);
Action declare_shrink(CLI::App& options, const Session& session);
Action declare_export(CLI::App& options, const Session& session);
Action declare_import(CLI::App& options, const Session& session);
Action declare_certify(CLI::App& options, const Session& session);

}  // namespace tumble::tools
