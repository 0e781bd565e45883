#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "app/command.h"
#include "app/demand_setup.h"
#include "base/error.h"
#include "base/print.h"
#include "base/staged_folder.h"
#include "base/subprocess.h"
#include "demand/demand.h"
#include "io/config.h"
#include "io/output_file.h"
#include "io/public_transport_file.h"
#include "io/scenario_files.h"
#include "osm/build_network.h"
#include "osm/driving_side.h"
#include "osm/import_report.h"
#include "scene/agent_type.h"

namespace sumogamma {
namespace {

struct ImportOptions {
  std::string map, folder, duration = "3600", side = "auto", demand;
  std::optional<std::string> bbox, agents;
  std::vector<std::string> without;
  bool force = false;
};

double parse_number(const std::string& option, const std::string& text,
                    const std::string& expected) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw Error(option + (text.empty() ? "" : " ") + text, "must be " + expected);
  return value;
}

long parse_agents(const std::string& text) {
  const std::string expected = "a whole number from 1 to 1000000";
  const double value = parse_number("--agents", text, expected);
  if (value < 1 || value > 1e6 || value != std::floor(value))
    throw Error("--agents " + text, "must be " + expected);
  return static_cast<long>(value);
}

double parse_duration(const std::string& text) {
  const std::string expected = "more than 0 and at most 1000000 s";
  const double value = parse_number("--duration", text, expected);
  if (value <= 0 || value > 1e6) throw Error("--duration " + text, "must be " + expected);
  return value;
}

osm::GeoBox parse_box(const std::string& text) {
  const std::string where = text.empty() ? "--bbox" : "--bbox " + text;
  std::vector<double> values;
  for (std::size_t start = 0; start <= text.size();) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    values.push_back(
        parse_number(where + ": part", text.substr(start, comma - start), "a number of degrees"));
    start = comma + 1;
  }
  if (values.size() != 4) throw Error(where, "needs four numbers: W,S,E,N in degrees");
  const osm::GeoBox box{values[0], values[1], values[2], values[3]};
  if (box.west < -180 || box.east > 180 || box.south < -90 || box.north > 90)
    throw Error(
        where,
        "is not in degrees: expected W,S,E,N with longitudes within 180 and latitudes within 90");
  if (!(box.west < box.east && box.south < box.north))
    throw Error(where, "is empty: expected W,S,E,N with west < east and south < north");
  return box;
}

osm::Side parse_side(const std::string& text) {
  return text == "left" ? osm::Side::Left : text == "right" ? osm::Side::Right : osm::Side::Auto;
}

/// What became of the map's lines of public transport; nothing where it has none.
void print_lines(std::FILE* out, const osm::BuildResult& built) {
  constexpr std::size_t kNames = 5;
  const osm::LineReport& lines = built.lines;
  if (lines.found.empty() && lines.others.empty()) return;
  long found = 0;
  for (const auto& [kind, count] : lines.found) found += count;
  print(out, "  public transport: {} of {} lines on roads, {} stops", lines.driven, found,
        built.transport.stops.size());
  std::map<std::string, std::vector<std::string>> by_reason;
  for (const auto& [line, why] : lines.left_out) by_reason[why].push_back(line);
  for (const auto& [why, names] : by_reason) {
    print(out, "; {}: ", why);
    for (std::size_t i = 0; i < std::min(kNames, names.size()); ++i)
      print(out, "{}{}", i == 0 ? "" : ", ", names[i]);
    if (names.size() > kNames) print(out, " and {} others", names.size() - kNames);
  }
  for (const auto& [kind, count] : lines.others)
    print(out, "{} {} {}", kind == lines.others.begin()->first ? "; not driven:" : ",", count,
          kind);
  print(out, "\n");
}

void print_summary(std::FILE* out, const osm::BuildResult& built, const DemandReport& demand,
                   const std::string& folder) {
  const auto count = [&](const char* name) { return static_cast<long>(built.built.at(name)); };
  print(out, "{}: {} edges, {} lanes, {} signals, {} crossings, {} buildings, traffic on the {}\n",
        folder, count("edges"), count("lanes"), count("signals"), count("crossings"),
        built.obstacles.at("buildings") + built.obstacles.at("buildings_cut"),
        built.left_hand ? "left" : "right");
  print_lines(out, built);
  print_demand(out, demand);
  for (const auto& [kind, issue] : built.log.issues())
    if (issue.severity == osm::Severity::Warning)
      print(out, "  warning: {} ({})\n", issue.what, issue.count);
}

/// Ends an import that was interrupted within two seconds, wherever it is: it looks for that itself
/// between its steps, but not within a library's long computation. What was made goes.
class InterruptWatch {
 public:
  explicit InterruptWatch(StagedFolder& folder) : thread_([this, &folder] { watch(folder); }) {}
  ~InterruptWatch() {
    ended_ = true;
    thread_.join();
  }
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  void watch(StagedFolder& folder) const {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds kLook(20), kGrace(1000);
    std::optional<Clock::time_point> seen;
    for (; !ended_; std::this_thread::sleep_for(kLook)) {
      if (!seen && interrupted()) seen = Clock::now();
      if (!seen || Clock::now() - *seen < kGrace) continue;
      kill_running_processes();
      folder.abandon();
      std::_Exit(kExitInterrupted);
    }
  }
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

struct Made {
  osm::BuildResult built;
  DemandReport demand;
};

/// Puts the files of [demand] beside the scenario, which then has all that it was made of.
DemandSettings with_own_files(DemandSettings settings, const std::filesystem::path& base,
                              const std::filesystem::path& folder) {
  if (!settings.od.empty()) {
    write_file(folder / "od.csv", read_file(base / settings.od));
    settings.od = "od.csv";
  }
  if (!settings.counts.empty()) {
    write_file(folder / "counts.xml", read_file(base / settings.counts));
    settings.counts = "counts.xml";
  }
  return settings;
}

/// [demand] of a file and of --set. Throws Error for keys of other sections, which an import would
/// not obey.
DemandSettings read_demand(const std::string& file, const std::vector<std::string>& set) {
  const ScenarioConfig config = read_config(file, set);
  for (const auto& [key, where] : config.given)
    if (key.rfind("demand.", 0) != 0)
      throw Error(where == "command line" ? "--set " + key : file,
                  "'" + key + "' is none of [demand], which is what import reads");
  return config.demand;
}

/// Writes the whole scenario into the folder; nothing where it was interrupted.
std::optional<Made> make_scenario(const ImportOptions& options, const osm::BuildRequest& build,
                                  const DemandSettings& settings, DemandRequest demand) {
  Made made;
  made.built = osm::build_network(build);
  const osm::BuildResult& built = made.built;
  if (built.stopped) return std::nullopt;

  build.progress("drawing and routing demand (duarouter)");
  demand.name = build.map.string();
  demand.network = build.folder / "net.net.xml";
  demand.routes = build.folder / "demand.rou.xml";
  demand.work = build.folder / "work";
  std::filesystem::create_directory(demand.work);
  if (!settings.window.empty()) demand.window = window_on(built.road, settings.window);
  if (settings.public_transport) demand.transport = transport_of(settings, built.transport);
  if (!built.transport.parts.empty())
    write_public_transport(build.folder / kPublicTransportFile, built.road, built.transport);
  made.demand = generate_demand(built.road, default_agent_types(), demand);
  if (made.demand.stopped) return std::nullopt;

  ScenarioFiles scenario;
  scenario.name = std::filesystem::path(options.folder).lexically_normal().filename().string();
  scenario.map = std::filesystem::path(options.map).filename().string();
  scenario.west = built.box.west;
  scenario.south = built.box.south;
  scenario.east = built.box.east;
  scenario.north = built.box.north;
  scenario.left_hand = built.left_hand;
  scenario.turn_on_red = osm::has_turns_on_red(built.box.center());
  scenario.agents = agents_alive(demand, made.demand);
  scenario.demand =
      with_own_files(settings, std::filesystem::path(options.demand).parent_path(), build.folder);
  scenario.on_foot = std::round(1000.0 * made.demand.on_foot) / 1000.0;
  scenario.duration = demand.duration;
  scenario.stops = made.demand.transport.buses > 0;
  write_scenario_files(build.folder, scenario, default_agent_types());
  nlohmann::ordered_json report = osm::import_report(built, scenario.map);
  report["demand"] = demand_report(made.demand, demand);
  write_file(build.folder / "import.json", report.dump(2) + "\n");
  std::filesystem::remove_all(demand.work);
  if (interrupted()) return std::nullopt;
  return made;
}

int run_import(const ImportOptions& options, const CommonOptions& common) {
  const DemandSettings settings = read_demand(options.demand, common.set);
  DemandRequest demand = request_of(settings, std::filesystem::path(options.demand).parent_path(),
                                    default_agent_types());
  demand.seed = common.seed;
  if (options.agents) demand.agents = parse_agents(*options.agents);
  demand.duration = parse_duration(options.duration);
  demand.should_stop = interrupted;
  osm::BuildRequest build;
  build.map = options.map;
  if (options.bbox) build.bbox = parse_box(*options.bbox);
  build.side = parse_side(options.side);
  build.without = {options.without.begin(), options.without.end()};
  osm::check_names(build.without);
  build.should_stop = interrupted;
  if (!common.quiet)
    build.progress = [](const std::string& text) { print(stderr, "import: {}\n", text); };

  StagedFolder folder(options.folder, options.force);
  build.folder = folder.path();
  std::optional<Made> made;
  {
    const InterruptWatch watch(folder);
    made = make_scenario(options, build, settings, std::move(demand));
  }
  if (!made) return kExitInterrupted;
  folder.commit();
  print_summary(common.out, made->built, made->demand, options.folder);
  return kExitDone;
}

}  // namespace

CommandRunner add_import_command(CLI::App& parent) {
  CLI::App* command = parent.add_subcommand(
      "import",
      "build a scenario folder from an OpenStreetMap extract: network, obstacles, demand");
  auto options = std::make_shared<ImportOptions>();
  command->add_option("map", options->map, "extract: .osm .osm.gz .osm.bz2 .osm.pbf")->required();
  command->add_option("-o,--output", options->folder, "scenario folder to write")->required();
  command->add_option("--bbox", options->bbox, "cut to W,S,E,N [degrees]");
  command->add_option("--agents", options->agents, "agents to keep alive (default: 100)");
  command->add_option(
      "--demand", options->demand,
      "TOML file with [demand]: shares by type, profile, window, origin-destination "
      "table, counts, public transport (docs/scenario.md)");
  command->add_option("--duration", options->duration, "time for which demand is written [s]")
      ->capture_default_str();
  command
      ->add_option("--side", options->side,
                   "side of the road: auto (from the place), left or right")
      ->check(CLI::IsMember({"auto", "left", "right"}))
      ->capture_default_str();
  command->add_option(
      "--without", options->without,
      "leave out a repair of the map or network, by its name in docs/import.md; may "
      "be given again");
  command->add_flag("--force", options->force, "write into a folder that is not empty");
  return [options](const CommonOptions& common) { return run_import(*options, common); };
}

}  // namespace sumogamma
