// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>

#include "tools/tumble/session.hpp"
#include "tools/tumble/verb_options.hpp"

namespace tumble::tools {

using Action = std::function<int()>;

/// The declaration of a verb adds its options to `verb` and returns its action; the session outlives the action.
struct Verb {
  const char* name;
  const char* doc;
  Action (*declare)(VerbOptions& verb, const Session& session);
};

std::span<const Verb> verbs();

Action declare_list(VerbOptions& verb, const Session& session);
Action declare_run(VerbOptions& verb, const Session& session);
Action declare_record(VerbOptions& verb, const Session& session);
Action declare_odometry(VerbOptions& verb, const Session& session);
Action declare_doctor(VerbOptions& verb, const Session& session);
Action declare_estimate(VerbOptions& verb, const Session& session);
Action declare_score(VerbOptions& verb, const Session& session);
Action declare_sweep(VerbOptions& verb, const Session& session);
Action declare_merge(VerbOptions& verb, const Session& session);
Action declare_report(VerbOptions& verb, const Session& session);
Action declare_compare(VerbOptions& verb, const Session& session);
Action declare_sensitivity(VerbOptions& verb, const Session& session);
Action declare_search(VerbOptions& verb, const Session& session);
Action declare_render(VerbOptions& verb, const Session& session);
Action declare_replay(VerbOptions& verb, const Session& session);
Action declare_bench(VerbOptions& verb, const Session& session);
Action declare_gate(VerbOptions& verb, const Session& session);
Action declare_triage(VerbOptions& verb, const Session& session);
Action declare_shrink(VerbOptions& verb, const Session& session);
Action declare_export(VerbOptions& verb, const Session& session);
Action declare_import(VerbOptions& verb, const Session& session);
Action declare_certify(VerbOptions& verb, const Session& session);

}  // namespace tumble::tools
