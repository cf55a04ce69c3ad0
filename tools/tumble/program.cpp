// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/program.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "scenarios/errors.hpp"
#include "sim/parameters.hpp"
#include "sim/simulate.hpp"
#include "tools/tumble/arguments.hpp"
#include "tools/tumble/session.hpp"
#include "tools/tumble/verbs.hpp"

namespace tumble::tools {

namespace {

using scenarios::BadInput;

void check_verb(int argc, const char* const* argv) {
  std::vector<std::string> known;
  for (const Verb& verb : verbs()) known.emplace_back(verb.name);
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-') continue;
    return require_known("verb", argv[i], known);
  }
}

std::vector<const char*> without_help(int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  if (words.size() < 2 || std::string_view(words[1]) != "help") return words;
  words.erase(words.begin() + 1);
  if (words.size() > 1) {
    words.resize(2);
    words.push_back("--help");
  }
  return words;
}

const CLI::App& parsed(const CLI::App& app) {
  const auto subcommands = app.get_subcommands();
  return subcommands.empty() ? app : *subcommands.front();
}

std::string usage_line(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& verb = parsed(app);
  const std::string place = &verb == &app ? "" : verb.get_name() + ": ";
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !app.remaining(true).empty()) {
    const std::vector<std::string> extras = app.remaining(true);
    const auto option =
        std::find_if(extras.begin(), extras.end(), [](const std::string& e) { return e.rfind('-', 0) == 0; });
    if (option == extras.end())
      return fmt::format("{}'{}' is one argument too many; remove this argument", place, extras.front());
    std::vector<std::string> known;
    for (const CLI::Option* each : verb.get_options()) {
      for (const std::string& name : each->get_lnames()) known.push_back("--" + name);
    }
    if (std::ranges::find(known, *option) != known.end())
      return fmt::format("{0}'{1}' must follow the verb: tumble {2} {1}", place, *option, verb.get_name());
    const std::string near = sim::did_you_mean(*option, known);
    return place + "unknown option '" + *option + "'" + (near.empty() ? "" : "; " + near);
  }
  std::string reason = error.what();
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  if (&verb == &app) reason = "a verb is missing";
  return place + reason + "; see 'tumble " + (place.empty() ? "" : verb.get_name() + " ") + "--help'";
}

int say(const char* prefix, const std::string& line, int status) {
  // An error message is shortened, because a corrupt file may contain megabytes in place of a word.
  constexpr std::size_t kBegin = 1500, kEnd = 300;
  std::string shown =
      line.size() <= kBegin + kEnd ? line : line.substr(0, kBegin) + " ... " + line.substr(line.size() - kEnd);
  shown = terminal_text(shown);
  std::replace(shown.begin(), shown.end(), '\n', ' ');
  std::fprintf(stderr, "tumble: %s%s\n", prefix, shown.c_str());
  return status;
}

int show_the_way() {
  std::string text =
      "tumble simulates robots that tumble and roll, estimates their motion and scores the estimates\n\nfirst steps\n  "
      "tumble run hill                simulates a robot that tumbles down a hill, runs methods, writes scores and "
      "pictures\n  tumble run slip                does the same for a sphere that rolls and slips\n  tumble list "
      "scenarios          lists the scenarios; 'tumble list' also lists methods, sensors and suites\n\nyour own "
      "recording\n  tumble odometry BAG -o DIR     writes trajectory, map and replay from a bag with IMU and lidar\n  "
      "tumble doctor BAG              searches a bag for faults\n  tumble import FILE -o r.h5     imports a bag, IMU "
      "readings, lidar sweeps or a trajectory\n  tumble estimate r.h5 --method rate/tumble -o DIR\n                    "
      "             runs a method on the recording and writes the estimate to a folder\n  tumble score YOURS.tum r.h5  "
      "  scores an external trajectory against the truth of a recording\n\nverbs ('tumble VERB --help' explains the "
      "options of a verb)\n";
  for (const Verb& verb : verbs()) text += fmt::format("  {:<11}  {}\n", verb.name, verb.doc);
  std::fputs(text.c_str(), stdout);
  return kDone;
}

void add_table_format(CLI::App& options, Session& session) {
  const std::map<std::string, TableFormat> names = {
      {"text", TableFormat::text}, {"md", TableFormat::markdown}, {"csv", TableFormat::csv}, {"tex", TableFormat::tex}};
  const auto choose = [&session, names](const std::string& name) {
    std::vector<std::string> known;
    for (const auto& each : names) known.push_back(each.first);
    require_known("format of tables", name, known);
    session.format = names.at(name);
  };
  options
      .add_option_function<std::string>("--format", choose,
                                        "sets the format of tables: text, md, csv or tex [default: text]")
      ->type_name("TEXT");
}

int dispatch(int argc, const char* const* argv) {
  if (argc == 1) return show_the_way();
  CLI::App app("tumble simulates robots that tumble and roll, estimates their motion and scores the estimates.",
               "tumble");
  app.set_version_flag("--version", program_version());
  app.require_subcommand(1);
  app.footer("Exit status: 0 success, 1 a check failed, 2 wrong use or bad input, 3 defect of the program.");
  Session session;
  Action chosen;
  for (const Verb& verb : verbs()) {
    CLI::App* options = app.add_subcommand(verb.name, verb.doc);
    options->add_flag("--json", session.json, "prints tables as JSON on standard output");
    options->add_flag("--quiet", session.quiet, "suppresses notes and progress on standard error");
    VerbOptions declared(*options);
    options->callback([action = verb.declare(declared, session), &chosen] { chosen = action; });
    if (options->get_option_no_throw("--format") == nullptr) add_table_format(*options, session);
  }
  check_verb(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& done) {  // --help and --version
    return app.exit(done);
  } catch (const CLI::ParseError& error) {
    throw BadInput(usage_line(app, error));
  }
  return chosen();
}

}  // namespace

int run_program(int argc, const char* const* argv) {
  try {
    const std::vector<const char*> words = without_help(argc, argv);
    return dispatch(static_cast<int>(words.size()), words.data());
  } catch (const BadInput& error) {
    return say("", error.what(), kBadInput);
  } catch (const sim::InvalidSituation& error) {
    return say("", error.what(), kBadInput);
  } catch (const std::filesystem::filesystem_error& error) {
    return say("", error.what(), kBadInput);
  } catch (const std::system_error& error) {
    return say("", error.what(), kBadInput);
  } catch (const sim::SimulationFailure& error) {
    return say("the simulation rejected the run: ", error.what(), kCheckFailed);
  } catch (const std::bad_alloc&) {
    return say("", "the program needs more memory than is available", kBadInput);
  } catch (const std::exception& error) {
    return say("defect: ", error.what(), kDefect);
  } catch (...) {
    return say("defect: ", "unknown exception", kDefect);
  }
}

}  // namespace tumble::tools
