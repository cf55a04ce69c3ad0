// SPDX-License-Identifier: BSD-3-Clause
// The test checks the files that a sweep writes next to its database, and the report made of both.
#include <signal.h>
#include <sys/resource.h>

#include "scenarios/sweep/results.hpp"
#include "system/program.hpp"
#include "system/short_sweep.hpp"

namespace tumble::system_test {
namespace {

/// Returns a page up to the Plotly bundle, which contains pictures and addresses that are not the page's.
std::string own_part(const fs::path& page) {
  const std::string text = read_file(page);
  return text.substr(0, text.find("<script id=\"plotly\">"));
}

/// Returns the files of a sweep of two draws with an example under `name`.db: a copy of one sweep that is made once per
/// process, because an animation takes longer than all draws.
fs::path copy_of_sweep(const fs::path& folder, const std::string& name) {
  static const fs::path made = [&] {
    const fs::path database = folder.parent_path() / "shared_sweep" / "r.db";
    fs::create_directories(database.parent_path());
    const Ended ended = run_shortened(sweep_arguments(database, "1..2", "1"));
    EXPECT_EQ(ended.status, 0) << ended.err;
    return database;
  }();
  const fs::path database = folder / (name + ".db");
  fs::copy_file(made, database);
  fs::copy(made.string() + ".files", database.string() + ".files", fs::copy_options::recursive);
  return database;
}

TEST(Report, IsOnePageThatAsksTheNetworkNothing) {
  const fs::path folder = test_folder();
  const fs::path database = copy_of_sweep(folder, "r"), page = folder / "report.html";
  const Ended ended = run_shortened({"report", database.string(), "-o", page.string()});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("position_end_error_share"));

  std::string text = read_file(page);
  const std::size_t bundle = text.find("<script id=\"plotly\">");
  ASSERT_NE(bundle, std::string::npos);
  const std::size_t end = text.find("</script>", bundle);
  EXPECT_GT(end - bundle, 1000000u) << "the Plotly bundle is inside";
  text.erase(bundle, end - bundle);
  // the bundle contains addresses as text; the rest of the page must contain none, and the page must load nothing
  for (const char* outside : {"http:", "https:", "@import", "url(", "<link"})
    EXPECT_THAT(text, Not(HasSubstr(outside)));
  EXPECT_THAT(text, HasSubstr("data:image/png;base64,iVBORw0KGgo")) << "no picture";
  EXPECT_THAT(text, HasSubstr("data:image/webp;base64,UklGR")) << "nothing moves";
  EXPECT_THAT(text, HasSubstr("rolling"));
  EXPECT_THAT(text, HasSubstr("id=\"path-roll-"));
  for (const char* part :
       {"id=\"certificate\"", "free_flight_energy", "id=\"motions\"", "distribution-motion_path_m"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  const json document = report_json(database);
  ASSERT_EQ(document["certificates"].size(), 1u);
  EXPECT_EQ(document["certificates"][0]["verdict"], "pass");
  EXPECT_FALSE(document["motions"].empty());
}

TEST(Report, IsAFunctionOfWhatASweepHasLeft) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "r.db", page = folder / "report.html";
  const fs::path list = folder / "r.db.files" / "examples.json";
  ASSERT_EQ(run_shortened(sweep_arguments(database, "1..2")).status, 0);
  EXPECT_FALSE(fs::exists(list)) << "none were asked for";
  std::vector<std::string> untold = sweep_arguments(database, "1..2");
  untold.erase(std::find(untold.begin(), untold.end(), "--examples"), untold.end() - 1);
  ASSERT_EQ(run_shortened(untold).status, 0);
  EXPECT_FALSE(fs::exists(list)) << "two draws do not pay for an example";
  const std::vector<std::string> report = {"report", database.string(), "-o", page.string()};
  Ended ended = run_shortened(report);
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(own_part(page), Not(HasSubstr("data:image/png;base64,iVBORw0KGgo")));
  EXPECT_THAT(own_part(page), HasSubstr("tumble sweep roll --seeds 1..2 --method rate/raw --method rolling --db "))
      << "it says what makes them";
  EXPECT_THAT(own_part(page), HasSubstr("r.db --examples 3")) << "so few draws get none unless told";
  EXPECT_THAT(ended.err, HasSubstr("no pictures of single simulated runs"));

  // results of another build would reject a sweep of this build: the page names the other build instead
  {
    scenarios::Results results(database, scenarios::Results::Mode::create_or_append);
    const auto page_where = [&](const std::string& key, const std::string& text) {
      const std::string as_it_was = results.note(key);
      results.set_note(key, text);
      EXPECT_EQ(run_shortened(report).status, 0);
      results.set_note(key, as_it_was);
      return own_part(page);
    };
    const std::string foreign = page_where("build", "another build"), mixed = page_where("build", "mixed");
    EXPECT_THAT(foreign, HasSubstr("by the build that computed these results (another build)"));
    EXPECT_THAT(foreign, Not(HasSubstr("tumble sweep roll")));
    EXPECT_THAT(mixed, HasSubstr("from several builds"));
    EXPECT_THAT(mixed, Not(HasSubstr("tumble sweep roll")));
    const std::string elsewhere = page_where("data", "other data");
    EXPECT_THAT(elsewhere, HasSubstr("(digest other data)"));
    EXPECT_THAT(elsewhere, Not(HasSubstr("tumble sweep roll")));
  }

  // the pages are made from existing files: only the draw that is shown runs again
  ended = run_shortened(sweep_arguments(database, "1..2", "1"));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(json_of(ended)["outcomes"], 0);
  EXPECT_THAT(ended.err, HasSubstr("simulates this run again to create its pictures"));
  const std::string left = read_file(list);
  ended = run_shortened(sweep_arguments(database, "1..2", "1"));
  EXPECT_THAT(ended.err, Not(HasSubstr("simulates this run again"))) << "they are there already";
  EXPECT_EQ(read_file(list), left);

  ASSERT_EQ(run_shortened(report).status, 0);
  EXPECT_THAT(own_part(page), HasSubstr("the same digest as in the results"));
  std::ofstream(list) << "damaged";
  ended = run_shortened(report);
  EXPECT_EQ(ended.status, 0) << "the scores are there all the same";
  EXPECT_THAT(own_part(page), HasSubstr("examples.json"));
}

TEST(Report, ShowsFailedDrawsInTheSectionOfFailures) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "f.db", page = folder / "report.html";
  std::ofstream(folder / "lost.yaml") << "name: lost\nkind: position\ncommand: [sh, -c, 'exit 3 # {output}']\n";
  std::vector<std::string> arguments = sweep_arguments(database, "1..3", "1");
  arguments.insert(arguments.end(), {"--method", (folder / "lost.yaml").string(), "--failures", "2"});
  const Ended ended = run_shortened(arguments);
  ASSERT_EQ(ended.status, 0) << ended.err;
  const json left = json::parse(read_file(folder / "f.db.files" / "examples.json"));
  // the examples are the typical draw and, of the first two failed draws, the one that is not the typical draw
  ASSERT_GE(left["examples"].size(), 2u) << ended.err;
  const json& failed = left["examples"].back();
  EXPECT_FALSE(left["examples"][0]["of_failure"]);
  EXPECT_TRUE(failed["of_failure"]);
  EXPECT_EQ(failed["pictures"].size(), 1u);
  EXPECT_TRUE(failed["plots"].empty());
  EXPECT_TRUE(fs::exists(folder / "f.db.files" / failed["replay"].get<std::string>()));
  ASSERT_EQ(run_shortened({"report", database.string(), "-o", page.string()}).status, 0);
  const std::string text = own_part(page), seed = std::to_string(failed["seed"].get<int>());
  EXPECT_THAT(text, HasSubstr("<details id=\"draw-roll-" + seed + "\"><summary>picture</summary>"));
  EXPECT_THAT(text, HasSubstr("<a href=\"f.db.files/" + failed["replay"].get<std::string>() + "\">replay</a>"));
  EXPECT_THAT(text, Not(HasSubstr("not match these results")));
}

TEST(Sweep, OfAnotherSuiteKeepsTheExamplesThatStandThere) {
  const fs::path folder = test_folder();
  const fs::path database = copy_of_sweep(folder, "s"), list = folder / "s.db.files" / "examples.json";
  const std::vector<std::string> arguments = sweep_arguments(database, "1..2", "1");
  json left = json::parse(read_file(list));
  ASSERT_EQ(left["examples"].size(), 1u);
  // a suite of another scenario would have left this entry
  left["examples"][0]["scenario"] = "elsewhere";
  for (json& picture : left["examples"][0]["pictures"]) {
    const std::string name = "elsewhere-1-" + picture["name"].get<std::string>() + ".png";
    fs::copy_file(list.parent_path() / picture["file"].get<std::string>(), list.parent_path() / name);
    picture["file"] = name;
  }
  json& moving = left["examples"][0]["moving"];
  fs::copy_file(list.parent_path() / moving["file"].get<std::string>(), list.parent_path() / "elsewhere-1-moving.webp");
  moving["file"] = "elsewhere-1-moving.webp";
  std::ofstream(list) << left.dump();
  ASSERT_EQ(run_shortened(arguments).status, 0);
  const json both = json::parse(read_file(list));
  ASSERT_EQ(both["examples"].size(), 2u);
  EXPECT_EQ(both["examples"][0]["scenario"], "elsewhere");
  EXPECT_EQ(both["examples"][1]["scenario"], "roll");

  // a damaged example is reported and does not affect the others
  left = both;
  left["examples"].push_back(left["examples"][0]);
  left["examples"][2].erase("motion");
  std::ofstream(list) << left.dump();
  const Ended ended = run_shortened(arguments);
  EXPECT_THAT(ended.err, HasSubstr("an existing example cannot be read and is left out"));
  EXPECT_THAT(ended.err, HasSubstr("example 3"));
  EXPECT_EQ(json::parse(read_file(list)), both);
  EXPECT_EQ(json::parse(read_file(folder / "s.db.files" / "examples.json.damaged")), left);
}

TEST(Sweep, StoppedAtItsPicturesSaysSoAndLeavesNone) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "s.db", files = folder / "s.db.files";
  Running running(sweep_arguments(database, "1..2", "1"), in_short_catalogue());
  // the folder is created just before the draw runs again
  for (int i = 0; i < 12000 && !running.has_ended() && !fs::exists(files); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(fs::exists(files));
  running.signal(SIGINT);
  const Ended stopped = running.wait();
  EXPECT_EQ(stopped.status, 1) << stopped.err;
  EXPECT_EQ(json_of(stopped)["draws_done"], 2);
  EXPECT_THAT(stopped.err, HasSubstr("stopped: all simulated runs are stored, but their pictures are missing"));
  EXPECT_FALSE(fs::exists(files)) << "nothing came into it";
}

TEST(Sweep, KeepsItsTableWhenPicturesCannotBeLeft) {
  const fs::path folder = test_folder();
  const fs::path database = folder / "s.db";
  std::ofstream(folder / "s.db.files") << "a file where the folder would stand";
  const Ended ended = run_shortened(sweep_arguments(database, "1..2", "1"));
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(json_of(ended)["draws_done"], 2);
  EXPECT_THAT(ended.err, HasSubstr("tumble: the pictures of single simulated runs could not be created: "));
}

TEST(Report, AFullDiskLeavesNeitherPageNorBadge) {
  const fs::path folder = test_folder();
  const fs::path database = copy_of_sweep(folder, "r"), page = folder / "r.html", badge = folder / "r.svg";
  const auto report = [&](rlim_t most) {
    return run_program({"report", database.string(), "-o", page.string(), "--badge", badge.string()}, [=] {
      in_short_catalogue()();
      const rlimit limit = {most, most};
      setrlimit(RLIMIT_FSIZE, &limit);
    });
  };
  EXPECT_EQ(report(64 * 1024).status, 2) << "the badge fits, the page does not";
  EXPECT_FALSE(fs::exists(page));
  EXPECT_FALSE(fs::exists(badge));
  EXPECT_EQ(report(RLIM_INFINITY).status, 0);
  EXPECT_TRUE(fs::exists(page) && fs::exists(badge));
}

}  // namespace
}  // namespace tumble::system_test
