// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/merge.hpp"

#include <memory>
#include <nlohmann/json.hpp>

#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/sweep/keep.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

struct MergeOptions {
  std::filesystem::path out;
  std::vector<std::filesystem::path> in;
  bool mixed = false;
};

int merge(const Session& session, const MergeOptions& options) {
  scenarios::require_not_an_input(options.out, options.in);
  const scenarios::DatabaseOwner owner(options.out);
  const scenarios::MergeCounts counts = scenarios::merge_results(owner, options.in, options.mixed);
  const std::size_t kept = options.mixed ? 0 : scenarios::merge_kept(owner, options.in);
  Table table("", {"database", "databases merged", "rows added", "replaced worse rows", "already present",
                   "draws rejected", "draws kept"});
  table.align_right_from(1);
  table.add_row({options.out.string(), std::to_string(options.in.size()), std::to_string(counts.added),
                 std::to_string(counts.replaced), std::to_string(counts.held), std::to_string(counts.rejected),
                 std::to_string(kept)});
  session.print({table}, {{"database", options.out.string()},
                          {"joined", options.in.size()},
                          {"outcomes", counts.added + counts.replaced - counts.rejected},
                          {"replaced", counts.replaced},
                          {"held", counts.held},
                          {"rejected", counts.rejected},
                          {"kept", kept}});
  return kDone;
}

}  // namespace

Action declare_merge(VerbOptions& verb, const Session& session) {
  auto options = std::make_shared<MergeOptions>();
  verb.add("OUT", options->out, "creates this results database, or adds rows to an existing database").required();
  verb.add("IN", options->in, "adds the results of these databases to the output database").required();
  verb.add_flag("--mixed-builds", options->mixed, "also accepts results of different builds of the program");
  return [&session, options] { return merge(session, *options); };
}

}  // namespace tumble::tools
