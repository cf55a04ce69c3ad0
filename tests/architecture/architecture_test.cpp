// SPDX-License-Identifier: BSD-3-Clause
// Checks which folder may use which: compares every #include and every link of the tree with the table of the design.
// The checker is a function of (folder, include), so that negative controls can use it next to the real scan.
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace {

struct Rule {
  std::string folder;                  // applies to sources in this folder of the tree
  std::vector<std::string> forbidden;  // regular expressions on the text of an include
};

const std::vector<Rule>& rules() {
  static const std::vector<Rule> all = {
      {"estimator",
       {"^sim/", "^scenarios/", "^tools/", "mujoco", "embree", "^fstream$", "^iostream$", "^cstdio$", "^filesystem$",
        "^thread$", "^hdf5", "^yaml-cpp", "^sqlite", "^SQLiteCpp", "^nlohmann", "^fmt/", "^spdlog", "^tbb/",
        "^oneapi/"}},
      {"estimator/include/tumble/common",
       {"^pcl/", "^tumble/(angular_velocity|attitude|rolling|mapping|odometry|pcl)/"}},
      {"estimator/include/tumble/angular_velocity", {"^pcl/", "^tumble/(attitude|rolling|mapping|odometry|pcl)/"}},
      {"estimator/include/tumble/attitude", {"^pcl/", "^tumble/(rolling|mapping|odometry|pcl)/"}},
      {"estimator/include/tumble/rolling", {"^pcl/", "^tumble/(mapping|odometry|pcl)/"}},
      {"estimator/include/tumble/mapping", {"^pcl/", "^tumble/(odometry|pcl)/"}},
      {"estimator/include/tumble/odometry", {"^pcl/", "^tumble/pcl/"}},
      {"estimator/src/common", {"^pcl/", "^(tumble|\\.\\.)/(angular_velocity|attitude|rolling|mapping|odometry|pcl)/"}},
      {"estimator/src/angular_velocity", {"^pcl/", "^(tumble|\\.\\.)/(attitude|rolling|mapping|odometry|pcl)/"}},
      {"estimator/src/attitude", {"^pcl/", "^(tumble|\\.\\.)/(rolling|mapping|odometry|pcl)/"}},
      {"estimator/src/rolling", {"^pcl/", "^(tumble|\\.\\.)/(mapping|odometry|pcl)/"}},
      {"estimator/src/mapping", {"^pcl/", "^(tumble|\\.\\.)/(odometry|pcl)/"}},
      {"estimator/src/odometry", {"^pcl/", "^(tumble|\\.\\.)/pcl/"}},
      {"sim",
       {"^tumble/", "^estimator/", "^scenarios/", "^tools/", "^hdf5", "^yaml-cpp", "^sqlite", "^SQLiteCpp", "^nlohmann",
        "^pcl/"}},
      {"scenarios/baselines",
       {"^sim/", "^scenarios/(?!baselines/)", "^pcl/", "^fstream$", "^iostream$", "^cstdio$", "^filesystem$",
        "^thread$", "^hdf5", "^yaml-cpp", "^SQLiteCpp", "^nlohmann", "^fmt/"}},
      {"scenarios", {"mujoco", "embree", "^sim/engine/", "^sim/compose", "^estimator/src/", "^tools/", "osmesa"}},
      {"tools", {"mujoco", "embree", "^sim/engine/", "^sim/compose", "^estimator/src/", "osmesa", "^tests/"}},
      // the package for Python may use the library, but nothing of the harness
      {"python/bindings",
       {"^sim/", "^scenarios/", "^tools/", "^estimator/", "^pcl/", "mujoco", "embree", "^hdf5", "^yaml-cpp", "^sqlite",
        "^SQLiteCpp", "^nlohmann", "^fmt/", "^iostream$", "^fstream$", "^thread$"}},
      // the ROS 2 package may use the library's public headers; only its nodes may use ROS
      {"ros",
       {"^sim/", "^scenarios/", "^tools/", "^estimator/", "^tumble/.*detail/", "^pcl/", "mujoco", "embree", "^hdf5",
        "^yaml-cpp", "^sqlite", "^SQLiteCpp", "^nlohmann", "^fmt/", "^thread$"}},
      {"ros/include", {"^rclcpp", "_msgs/", "_srvs/", "^tf2", "^iostream$", "^fstream$", "^filesystem$"}},
      {"ros/src", {"^rclcpp", "_msgs/", "_srvs/", "^tf2", "^iostream$", "^fstream$", "^filesystem$"}},
      // the code between evalio and the package may use only the headers of both and Python
      {"python/evalio/bindings",
       {"^sim/", "^scenarios/", "^tools/", "^estimator/", "^tumble/", "^pcl/", "mujoco", "embree", "^hdf5", "^fmt/",
        "^iostream$", "^fstream$", "^thread$"}},
      // the report page is a function of results and of files next to them, so it may not simulate, estimate or draw
      {"tools/report",
       {"^sim/", "^tumble/", "^scenarios/(draw|estimates|external|methods|diagnosis|recordings|processes)/",
        "^scenarios/sweep/(sweep|draw_process|evaluate|recorded_draw)\\.hpp", "^tools/tumble/",
        "^tools/pictures/(?!colours)", "^tools/examples/(?!example\\.hpp)"}},
  };
  return all;
}

/// Headers of sim that others include must not include mujoco.h, Embree or OSMesa.
const std::vector<std::string> kPublicSimHeaders = {
    "sim/parameters.hpp",        "sim/built_situation.hpp", "sim/situation.hpp",       "sim/recording.hpp",
    "sim/simulate.hpp",          "sim/random/stream.hpp",   "sim/lidar/surface.hpp",   "sim/render/renderer.hpp",
    "sim/render/world_mesh.hpp", "sim/trial/trial.hpp",     "sim/trial/ray_trial.hpp", "sim/imu/allan.hpp",
    "sim/imu/imu_simulation.hpp"};

std::vector<std::string> includes_of(const fs::path& file) {
  static const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::ifstream stream(file);
  std::vector<std::string> out;
  std::string line;
  std::smatch match;
  while (std::getline(stream, line)) {
    if (std::regex_search(line, match, pattern)) out.push_back(match[1]);
  }
  return out;
}

bool is_below(const std::string& path, const std::string& folder) {
  return path.rfind(folder + "/", 0) == 0;
}

/// Returns the rule that a file at `path` breaks by including `include`, or an empty text.
std::string broken_rule(const std::string& path, const std::string& include) {
  for (const Rule& rule : rules()) {
    if (!is_below(path, rule.folder)) continue;
    for (const std::string& pattern : rule.forbidden) {
      if (std::regex_search(include, std::regex(pattern, std::regex::icase)))
        return rule.folder + " must not include " + pattern;
    }
  }
  return "";
}

std::vector<fs::path> sources_below(const std::vector<std::string>& folders) {
  std::vector<fs::path> out;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".hpp" || extension == ".cpp") out.push_back(entry.path());
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<fs::path> all_sources() {
  return sources_below({"estimator", "sim", "scenarios", "tools", "python/bindings", "python/evalio/bindings", "ros"});
}

std::string path_in_tree(const fs::path& path) {
  return fs::relative(path, tumble::test::source_dir()).generic_string();
}

/// Only a module may reach its private headers, so the function follows the includes of a public header.
void collect_reachable(const std::string& header, std::vector<std::string>& seen) {
  if (std::find(seen.begin(), seen.end(), header) != seen.end()) return;
  seen.push_back(header);
  const fs::path file = tumble::test::source_dir() / header;
  if (!fs::exists(file)) return;
  for (const std::string& include : includes_of(file)) collect_reachable(include, seen);
}

/// Returns the build folder, derived from the location of this program.
fs::path build_dir() {
  return tumble::test::program().parent_path().parent_path();
}

std::string output_of(const std::string& command) {
  std::array<char, 4096> buffer;
  std::string out;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  if (!pipe) return out;
  while (fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) out += buffer.data();
  return out;
}

TEST(Architecture, EveryIncludeFollowsTheTable) {
  const std::vector<fs::path> files = all_sources();
  ASSERT_GT(files.size(), 40u) << "the scan found too few files to mean anything";
  for (const fs::path& file : files) {
    for (const std::string& include : includes_of(file)) {
      EXPECT_EQ(broken_rule(path_in_tree(file), include), "") << path_in_tree(file) << " includes " << include;
    }
  }
}

TEST(Architecture, CheckerRefusesForbiddenIncludes) {
  EXPECT_NE(broken_rule("estimator/src/attitude/vqf.cpp", "sim/recording.hpp"), "");
  EXPECT_NE(broken_rule("estimator/include/tumble/common/types.hpp", "fstream"), "");
  EXPECT_NE(broken_rule("estimator/src/rolling/x.cpp", "pcl/point_types.h"), "");
  EXPECT_NE(broken_rule("scenarios/draw/x.cpp", "mujoco/mujoco.h"), "");
  EXPECT_NE(broken_rule("python/bindings/x.cpp", "scenarios/methods/bridge.hpp"), "");
  EXPECT_EQ(broken_rule("python/bindings/x.cpp", "tumble/tumble.hpp"), "");
  EXPECT_NE(broken_rule("ros/src/x.cpp", "tumble/mapping/detail/localisation.hpp"), "");
  EXPECT_NE(broken_rule("ros/src/x.cpp", "rclcpp/rclcpp.hpp"), "");
  EXPECT_NE(broken_rule("ros/nodes/x.cpp", "scenarios/recordings/import.hpp"), "");
  EXPECT_EQ(broken_rule("ros/nodes/x.cpp", "rclcpp/rclcpp.hpp"), "");
  EXPECT_EQ(broken_rule("ros/src/x.cpp", "tumble/tumble.hpp"), "");
  EXPECT_NE(broken_rule("python/evalio/bindings/x.cpp", "tumble/tumble.hpp"), "");
  EXPECT_EQ(broken_rule("python/evalio/bindings/x.cpp", "evalio/pipeline.h"), "");
  EXPECT_NE(broken_rule("scenarios/baselines/attitude/x.cpp", "scenarios/estimates/method.hpp"), "");
  EXPECT_NE(broken_rule("scenarios/baselines/attitude/x.cpp", "sim/recording.hpp"), "");
  EXPECT_EQ(broken_rule("scenarios/baselines/attitude/x.cpp", "scenarios/baselines/attitude/madgwick_step.hpp"), "");
  EXPECT_NE(broken_rule("scenarios/draw/x.cpp", "sim/engine/model.hpp"), "");
  EXPECT_NE(broken_rule("sim/imu/x.cpp", "tumble/common/types.hpp"), "");
  EXPECT_NE(broken_rule("sim/imu/x.cpp", "yaml-cpp/yaml.h"), "");
  EXPECT_NE(broken_rule("tools/tumble/x.cpp", "embree3/rtcore.h"), "");
  EXPECT_NE(broken_rule("scenarios/draw/x.cpp", "sim/compose.hpp"), "");
  for (const char* include : {"scenarios/sweep/evaluate.hpp", "scenarios/estimates/method.hpp", "sim/recording.hpp",
                              "tools/examples/make_example.hpp", "tools/pictures/pictures.hpp"})
    EXPECT_NE(broken_rule("tools/report/page.cpp", include), "") << include;
  EXPECT_EQ(broken_rule("tools/report/page.cpp", "tools/examples/example.hpp"), "");
  EXPECT_EQ(broken_rule("scenarios/methods/x.cpp", "tumble/common/types.hpp"), "");
  EXPECT_NE(broken_rule("estimator/src/mapping/x.cpp", "pcl/point_types.h"), "");
  EXPECT_NE(broken_rule("estimator/src/mapping/x.cpp", "tumble/odometry/tumbling_odometry.hpp"), "");
  EXPECT_NE(broken_rule("estimator/src/attitude/x.cpp", "../mapping/tracking.hpp"), "");
  EXPECT_EQ(broken_rule("estimator/src/attitude/x.cpp", "../common/dense.hpp"), "");
  EXPECT_EQ(broken_rule("estimator/src/pcl/x.cpp", "pcl/point_types.h"), "");
}

TEST(Architecture, PublicSimHeadersDoNotBringTheEngine) {
  for (const std::string& header : kPublicSimHeaders) {
    ASSERT_TRUE(fs::exists(tumble::test::source_dir() / header)) << header;
    std::vector<std::string> reachable;
    collect_reachable(header, reachable);
    for (const std::string& include : reachable) {
      EXPECT_EQ(include.find("mujoco"), std::string::npos) << header << " reaches " << include;
      EXPECT_EQ(include.find("embree"), std::string::npos) << header << " reaches " << include;
      EXPECT_EQ(include.find("osmesa"), std::string::npos) << header << " reaches " << include;
    }
  }
  std::vector<std::string> private_header;
  collect_reachable("sim/engine/model.hpp", private_header);
  EXPECT_NE(std::find(private_header.begin(), private_header.end(), "mujoco/mujoco.h"), private_header.end())
      << "negative control: the private header does include the engine";
}

/// Links names patterns that the undefined symbols of a library must not match.
struct Links {
  const char* library;  // path in the build folder
  const char* forbidden;
  const char* control;  // a symbol that the pattern must find (negative control)
};

const std::array kLinks = {
    Links{
        "estimator/libtumble_estimator.a",
        R"(\b(mj_|rtc[A-Z]|H5[A-Z]|pcl::|YAML::|sqlite3_|std::cout|std::cerr|printf\b|fopen\b|exit\b|pthread_create|tumble::(sim|scenarios|tools)\b))",
        "mj_step"},
    Links{
        "estimator/libtumble_mapping.a",
        R"(\b(mj_|rtc[A-Z]|H5[A-Z]|pcl::|YAML::|sqlite3_|std::cout|std::cerr|printf\b|fopen\b|exit\b|pthread_create|tumble::(sim|scenarios|tools)\b))",
        "tumble::scenarios::metrics()"},
    Links{
        "estimator/libtumble_odometry.a",
        R"(\b(mj_|rtc[A-Z]|H5[A-Z]|pcl::|YAML::|sqlite3_|std::cout|std::cerr|printf\b|fopen\b|exit\b|pthread_create|tumble::(sim|scenarios|tools)\b))",
        "tumble::scenarios::metrics()"},
    Links{
        "scenarios/baselines/libtumble_baselines.a",
        R"(\b(mj_|rtc[A-Z]|H5[A-Z]|pcl::|YAML::|sqlite3_|std::cout|std::cerr|printf\b|fopen\b|exit\b|pthread_create|tumble::(sim|scenarios|tools)\b))",
        "tumble::sim::simulate(tumble::sim::BuiltSituation const&, int)"},
    Links{"sim/libtumble_sim.a", R"(\b(H5[A-Z]|pcl::|YAML::|sqlite3_|std::cout|std::cerr|tumble::(?!sim\b)))",
          "tumble::AngularRateModel::AngularRateModel()"},
    Links{"scenarios/libtumble_scenarios.a", R"(\b(mj_|rtc[A-Z]|OSMesa|tumble::(sim::engine|tools)\b))",
          "OSMesaMakeCurrent"},
    Links{"tools/libtumble_tools.a", R"(\b(mj_|rtc[A-Z]|OSMesa|H5[A-Z]|tumble::sim::engine\b))", "rtcNewScene"},
};

TEST(Architecture, EveryLibraryLinksAsTheTableSays) {
  std::size_t looked_at = 0;
  for (const Links& links : kLinks) {
    const std::regex forbidden(links.forbidden);
    std::smatch match;
    const std::string control = "                 U " + std::string(links.control) + "\n";
    EXPECT_TRUE(std::regex_search(control, forbidden)) << "negative control of " << links.library;
    const fs::path library = build_dir() / links.library;
    if (!fs::exists(library)) continue;  // this build has only some targets
    ++looked_at;
    const std::string undefined = output_of("nm -C --undefined-only " + library.string());
    ASSERT_NE(undefined.find("U "), std::string::npos) << "nm printed nothing to judge";
    std::istringstream lines(undefined);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_FALSE(std::regex_search(line, match, forbidden)) << links.library << " uses " << line;
    }
  }
  EXPECT_GE(looked_at, 1u);
}

/// Returns pairs ("a b", a before b) of folders that use each other, directly or indirectly. A folder and a folder
/// within it may use each other, because the outer folder contains what all inner folders share. Headers and sources of
/// the estimator with one name count as one folder.
std::set<std::string> mutual_folders(const std::vector<std::pair<std::string, std::string>>& uses) {
  std::map<std::string, std::set<std::string>> reached;
  for (const auto& [from, to] : uses) {
    if (!is_below(to, from) && !is_below(from, to)) reached[from].insert(to);
  }
  for (bool grown = true; grown;) {
    grown = false;
    for (auto& [from, own] : reached) {
      std::set<std::string> more = own;
      for (const std::string& by : own) {
        if (const auto next = reached.find(by); next != reached.end())
          more.insert(next->second.begin(), next->second.end());
      }
      grown = grown || more.size() > own.size();
      own = std::move(more);
    }
  }
  std::set<std::string> mutual;
  for (const auto& [from, own] : reached) {
    for (const std::string& to : own) {
      const auto back = reached.find(to);
      if (from < to && back != reached.end() && back->second.contains(from)) mutual.insert(from + " " + to);
    }
  }
  return mutual;
}

std::string folder_of(const std::string& path) {
  const std::string folder = fs::path(path).parent_path().generic_string();
  return std::regex_replace(folder, std::regex("^estimator/(include/tumble|src)"), "estimator");
}

/// Returns the header of the tree that an include of this file means; tests may name it from their folder or from
/// tests.
std::string header_of(const fs::path& file, const std::string& include) {
  if (include.starts_with("../")) return path_in_tree((file.parent_path() / include).lexically_normal());
  if (include.starts_with("tumble/")) return "estimator/include/" + include;
  if (!is_below(path_in_tree(file), "tests")) return include;
  const std::string beside = path_in_tree(file.parent_path() / include);
  for (const std::string& meant : {beside, include}) {
    if (fs::exists(tumble::test::source_dir() / meant)) return meant;
  }
  return "tests/" + include;
}

/// Returns pairs (folder, folder from which one of its files includes) for these files.
std::vector<std::pair<std::string, std::string>> folder_uses(const std::vector<fs::path>& files) {
  std::vector<std::pair<std::string, std::string>> uses;
  for (const fs::path& file : files) {
    for (const std::string& include : includes_of(file)) {
      const std::string header = header_of(file, include);
      if (!fs::exists(tumble::test::source_dir() / header)) continue;
      const std::string from = folder_of(path_in_tree(file)), to = folder_of(header);
      if (from != to) uses.emplace_back(from, to);
    }
  }
  return uses;
}

/// Returns pairs (folder of tests, folder of tests whose source one of its executables also compiles).
std::vector<std::pair<std::string, std::string>> borrowed_sources() {
  std::vector<std::pair<std::string, std::string>> uses;
  for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / "tests")) {
    if (entry.path().filename() != "CMakeLists.txt") continue;
    std::ifstream stream(entry.path());
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    const std::regex borrowed(R"((\.\./[\w./]+)\.cpp)");
    for (std::sregex_iterator found(text.begin(), text.end(), borrowed), end; found != end; ++found) {
      const fs::path source = (entry.path().parent_path() / (*found)[1].str()).lexically_normal();
      uses.emplace_back(folder_of(path_in_tree(entry.path())), folder_of(path_in_tree(source)));
    }
  }
  return uses;
}

TEST(Architecture, NoFoldersUseEachOther) {
  const auto uses = folder_uses(all_sources());
  ASSERT_GT(uses.size(), 200u) << "the scan found too little to mean anything";
  EXPECT_EQ(mutual_folders(uses), std::set<std::string>{});
  // negative controls
  EXPECT_EQ(mutual_folders({{"a/b", "c"}, {"c", "a/b"}, {"c", "d"}}), std::set<std::string>{"a/b c"});
  EXPECT_EQ(mutual_folders({{"a", "b"}, {"b", "c"}, {"c", "a"}}), (std::set<std::string>{"a b", "a c", "b c"}))
      << "by way of a third";
  EXPECT_TRUE(mutual_folders({{"a", "a/b"}, {"a/b", "a"}}).empty());
}

TEST(Architecture, NoFoldersOfTestsUseEachOther) {
  auto uses = folder_uses(sources_below({"tests"}));
  ASSERT_GT(uses.size(), 200u) << "the scan found too little to mean anything";
  const auto borrowed = borrowed_sources();
  ASSERT_FALSE(borrowed.empty());
  uses.insert(uses.end(), borrowed.begin(), borrowed.end());
  EXPECT_EQ(mutual_folders(uses), std::set<std::string>{});
  // negative control: the found uses suffice to detect a fault, however its header is named
  const std::string shared = "tests/scenarios/methods", user = "tests/scenarios/sweep";
  ASSERT_TRUE(std::count(uses.begin(), uses.end(), std::pair(user, shared)) > 0);
  uses.emplace_back(shared, user);
  EXPECT_EQ(mutual_folders(uses), std::set<std::string>{shared + " " + user});
}

TEST(Architecture, FilesStayBelowTheirCeilings) {
  std::vector<fs::path> files = sources_below({"tests"});
  for (const fs::path& file : all_sources()) files.push_back(file);
  for (const fs::path& file : files) {
    std::ifstream stream(file);
    const auto lines = std::count(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>(), '\n');
    EXPECT_LE(lines, file.extension() == ".hpp" ? 300 : 400) << path_in_tree(file);
  }
}

TEST(Architecture, EverySourceCarriesTheLicence) {
  for (const fs::path& file : all_sources()) {
    std::ifstream stream(file);
    std::string line;
    std::getline(stream, line);
    EXPECT_EQ(line, "// SPDX-License-Identifier: BSD-3-Clause") << path_in_tree(file);
  }
}

}  // namespace
