#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <utility>

#include "app/drive_episode.h"
#include "app/drive_options.h"
#include "app/progress.h"
#include "app/scenario_hash.h"
#include "base/error.h"
#include "base/print.h"
#include "io/episode_files.h"
#include "io/output_file.h"
#include "io/output_folder.h"
#include "study/shard.h"

namespace sumogamma {

namespace {

using Json = nlohmann::ordered_json;
using Seeds = std::vector<std::uint64_t>;

constexpr const char* kSettingsFile = "settings.json";

std::uint64_t parse_whole(const std::string& option, std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size())
    throw Error(option, "'" + std::string(text.substr(0, 40)) +
                            "' is no whole number; expected such as 7, 1..200 or 1..10,20");
  return value;
}

/// [ego] with the options over it.
EgoSettings settings_of(const DriveOptions& options, const ScenarioConfig& config) {
  EgoSettings settings = config.ego;
  const bool named = options.planner || config.given.contains("ego.planner");
  if (!options.address.empty() && named)
    throw Error("--ego",
                "an ego that joins has its own planner: leave --planner and [ego] planner "
                "out");
  if (options.planner) settings.planner = *options.planner;
  if (!options.address.empty()) settings.planner = "external";
  if (options.vehicle) settings.vehicle = *options.vehicle;
  if (options.type) settings.type = *options.type;
  if (options.goal_edge) settings.goal_edge = *options.goal_edge;
  if (options.goal_way) settings.goal_way = *options.goal_way;
  if (options.max_speed) settings.max_speed = *options.max_speed;
  if (options.deadline) settings.deadline = *options.deadline;
  if (!options.window.empty()) settings.window = options.window;
  if (options.untrusted) settings.trusted = false;
  if (options.emergency_brake) settings.emergency_brake = true;
  return settings;
}

/// All that decides on what an episode is. Folders with the same may be merged.
Json settings_json(const Drive& drive, const CommonOptions& common) {
  const EgoSettings& ego = drive.settings;
  return {{"version", SUMOGAMMA_VERSION},
          {"scenario", drive.plan.input.name},
          {"files", hash_of_files(drive.plan.input)},
          {"step", drive.plan.clock.step},
          {"vehicles", drive.plan.vehicles},
          {"control", drive.plan.control_text},
          {"preset", name_of(drive.plan.config.preset)},
          {"set", common.set},
          {"planner", ego.planner},
          {"vehicle", ego.vehicle},
          {"type", ego.type},
          {"window", ego.window},
          {"goal_edge", ego.goal_edge},
          {"goal_at", ego.goal_at},
          {"goal_way", ego.goal_way},
          {"max_speed", ego.max_speed},
          {"accelerations", ego.accelerations},
          {"rate", ego.rate},
          {"agents_seen", ego.agents_seen},
          {"scenarios", ego.scenarios},
          {"depth", ego.depth},
          {"trees", ego.trees},
          {"scene_steps", ego.scene_steps},
          {"deadline", ego.deadline},
          {"trusted", ego.trusted},
          {"emergency_brake", ego.emergency_brake},
          {"warm_up", ego.warm_up},
          {"clearance", ego.clearance},
          {"limit", ego.limit},
          {"reference", drive.reference ? "gamma" : "way"}};
}

/// Throws Error where a folder is that of another drive.
void require_same_drive(const std::filesystem::path& folder, const Json& settings) {
  const Json there = Json::parse(read_file(folder / kSettingsFile), nullptr, false);
  if (there == settings) return;
  for (const auto& [key, value] : settings.items())
    if (!there.is_object() || !there.contains(key) || there[key] != value)
      throw Error(folder.string(),
                  "holds another drive: its " + key + " is " +
                      (there.is_object() && there.contains(key) ? there[key].dump() : "not there") +
                      ", not " + value.dump() + "; choose another folder");
  throw Error(folder.string(), "holds another drive, choose another folder");
}

bool has_episodes(const std::filesystem::path& folder) {
  const std::filesystem::path episodes = folder / "episodes";
  return std::filesystem::exists(episodes) && !std::filesystem::is_empty(episodes);
}

/// Makes the folder this drive's own, or finds that it is. One whose drive came to nothing (a
/// window without a lane, say) is free for the next.
void claim(const std::filesystem::path& folder, const Json& settings) {
  make_output_folder(folder);
  const bool is_ours = std::filesystem::exists(folder / kSettingsFile);
  if (is_ours && has_episodes(folder)) {
    require_same_drive(folder, settings);
  } else {
    for (const char* const file : {"results.json", "drive.json"})
      if (!is_ours && std::filesystem::exists(folder / file))
        throw Error(folder.string(),
                    "holds " + std::string(file) + " of something else, choose another folder");
    write_file(folder / kSettingsFile, settings.dump(2) + "\n");
  }
  make_output_folder(folder / "episodes");
}

/// Takes over what others have done of these seeds.
void merge_from(const std::filesystem::path& from, const std::filesystem::path& to,
                const Json& settings, const Seeds& seeds) {
  if (!std::filesystem::exists(from / kSettingsFile))
    throw Error("--merge " + from.string(), "is no folder of a drive");
  require_same_drive(from, settings);
  for (const std::uint64_t seed : seeds)
    if (!read_episode(from, seed).is_null())
      write_file(episode_file(to, seed), read_file(episode_file(from, seed)));
}

bool is_done(const std::filesystem::path& folder, std::uint64_t seed) {
  const Json episode = read_episode(folder, seed);
  // a client may have been mended meanwhile
  return !episode.is_null() && episode["episode"]["outcome"] != outcome::kClientFailed;
}

/// Seeds of which a page is asked for. Throws Error where one is none of `seeds`.
Seeds replays_of(const DriveOptions& options, const Seeds& seeds) {
  if (options.replay.empty()) return {};
  Seeds replays = parse_seeds("--replay", options.replay);
  for (const std::uint64_t seed : replays)
    if (!std::binary_search(seeds.begin(), seeds.end(), seed))
      throw Error("--replay",
                  "seed " + std::to_string(seed) + " is none of --seeds: add it there, too");
  return replays;
}

/// Those that aren't done, or lack the page that is asked for: of a planner in the box, which
/// drives the same again.
Seeds left_of_drive(const std::filesystem::path& folder, const Seeds& seeds, const Seeds& replays) {
  Seeds left;
  std::copy_if(seeds.begin(), seeds.end(), std::back_inserter(left), [&](std::uint64_t seed) {
    return !is_done(folder, seed) || (std::binary_search(replays.begin(), replays.end(), seed) &&
                                      !std::filesystem::exists(replay_page(folder, seed)));
  });
  return left;
}

/// What somebody who joins is told first.
nlohmann::json hello_of(const Drive& drive, const Seeds& seeds) {
  const RoadNetwork& road = drive.sim->model.road;
  const EgoSettings& ego = drive.settings;
  const AgentType& type = type_of(drive.types, find_agent_type(drive.types, ego.type));
  nlohmann::json types = nlohmann::json::array();
  for (const AgentType& one : drive.types)
    types.push_back({{"name", one.name}, {"length", one.length}, {"width", one.width}});
  return {{"type", "hello"},
          {"protocol", kEgoProtocol},
          {"version", SUMOGAMMA_VERSION},
          {"scenario", drive.plan.input.name},
          {"map",
           {{"lower", {road.lower_corner.x(), road.lower_corner.y()}},
            {"upper", {road.upper_corner.x(), road.upper_corner.y()}},
            {"left_hand", road.left_hand},
            {"projection", road.projection},
            {"offset", {road.projection_offset.x(), road.projection_offset.y()}}}},
          {"types", std::move(types)},
          {"seeds", seeds},
          {"rate", ego.rate},
          {"step", drive.plan.clock.step},
          {"limit", ego.limit},
          {"limits",
           {{"max_speed", std::min(ego.max_speed, type.max_speed)},
            {"max_acceleration", type.max_acceleration},
            {"max_deceleration", type.max_deceleration},
            {"max_steering", type.max_steering},
            {"wheelbase", type.wheelbase},
            {"accelerations", ego.accelerations}}}};
}

/// SUMO needs a vType of the ego whose start is drawn.
void provide_type(Drive& drive, const std::filesystem::path& folder) {
  RunPlan& plan = drive.plan;
  if (!drive.settings.vehicle.empty()) return;
  const AgentType& type =
      type_of(plan.config.types, find_agent_type(plan.config.types, drive.settings.type));
  const std::filesystem::path file = std::filesystem::absolute(folder / "ego.add.xml");
  write_file(file,
             fmt::format("<additional><vType id=\"{}\" vClass=\"{}\" length=\"{}\" "
                         "width=\"{}\" maxSpeed=\"{}\" speedDev=\"0\"/></additional>\n",
                         kEgoTypeId, type.sumo_class, type.length, type.width, type.max_speed));
  std::string files;
  for (const auto& one : plan.input.additional)
    files += std::filesystem::absolute(one).string() + ",";
  plan.sumo_words.insert(plan.sumo_words.end(), {"--additional-files", files + file.string()});
}

/// An id that nobody of the demand has, or a person's, would be waited for in vain.
void check_vehicle(const Drive& drive) {
  const std::string& id = drive.settings.vehicle;
  if (id.empty()) {
    const AgentType& type = type_of(drive.plan.config.types,
                                    find_agent_type(drive.plan.config.types, drive.settings.type));
    if (type.kinematics == Kinematics::Holonomic || type.guided)
      throw Error("[ego] type", "'" + type.name + "' is none that drives on a road");
    return;
  }
  const ScenarioInventory all = take_inventory(drive.plan.input, false, true);
  if (all.complete && !has_id(all, id))
    throw Error("[ego] vehicle", "the demand has no '" + id.substr(0, 60) + "'");
}

Drive make_drive(const DriveOptions& options, const CommonOptions& common) {
  Drive drive;
  drive.plan = make_plan(options.run, common);
  drive.settings = settings_of(options, drive.plan.config);
  check_settings(drive.settings, drive.plan.clock.step, !options.address.empty());
  check_vehicle(drive);
  if (!drive.plan.control.all()) {
    ControlRule rule;
    rule.who = {drive.settings.vehicle.empty() ? kEgoId : drive.settings.vehicle};
    drive.plan.control.rules.push_back(std::move(rule));
  }
  if (!options.reference.empty()) {
    if (!std::filesystem::exists(options.reference / kSettingsFile))
      throw Error("--reference " + options.reference.string(), "is no folder of a drive");
    const Json there = Json::parse(read_file(options.reference / kSettingsFile), nullptr, false);
    if (!there.is_object() || there.value("planner", "") != "gamma")
      throw Error("--reference " + options.reference.string(), "is no drive of the planner gamma");
    drive.reference = [folder = options.reference](std::uint64_t seed) -> std::optional<double> {
      const Json episode = read_episode(folder, seed);
      if (episode.is_null()) return std::nullopt;
      return episode["episode"]["progress_m"].get<double>();
    };
  }
  return drive;
}

struct Ended {
  bool interrupted = false, client_left = false;
  std::size_t failed = 0;
};

/// Episodes one after the other until none is left, or nobody drives any more.
Ended drive_episodes(Drive& drive, const std::filesystem::path& folder, Seeds left,
                     const Seeds& replays, bool quiet) {
  Ended ended;
  const std::size_t wanted = left.size();
  Progress progress("drive", static_cast<double>(wanted), "episodes", quiet);
  while (!left.empty() && !interrupted()) {
    std::uint64_t seed = left.front();
    if (drive.external) {
      const auto next = drive.external->next_episode(left);
      ended.client_left = !next && !interrupted();
      if (!next) break;
      seed = *next;
    }
    const bool shown = std::find(replays.begin(), replays.end(), seed) != replays.end();
    drive.replay = shown ? folder : std::filesystem::path();
    const std::optional<EpisodeResult> result = run_episode(drive, seed);
    if (!result) break;
    write_episode(folder, *result);
    ended.failed += result->outcome == outcome::kClientFailed ? 1 : 0;
    std::erase(left, seed);
    progress.update(static_cast<double>(wanted - left.size()),
                    fmt::format("seed {}: {}", seed, result->outcome));
  }
  ended.interrupted = interrupted();
  return ended;
}

void print_summary(const std::filesystem::path& folder, const std::vector<Json>& episodes) {
  std::map<std::string, std::size_t> outcomes;
  std::size_t cut = 0;
  for (const Json& episode : episodes) {
    ++outcomes[episode["episode"]["outcome"].get<std::string>()];
    cut += episode["episode"].value("cut", std::size_t{0});
  }
  std::string text;
  for (const auto& [name, count] : outcomes)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name);
  print(stdout, "{} episodes: {}; tables in {}\n", episodes.size(), text.empty() ? "none" : text,
        folder.string());
  if (cut > 0)
    print(stderr,
          "sumo-gamma: --deadline cut {} plans short: this drive can't be repeated exactly\n", cut);
}

int exit_code(const Drive& drive, const Ended& ended, std::size_t done, std::size_t wanted) {
  if (ended.interrupted) return kExitInterrupted;
  if (drive.external)
    for (const std::string& what : drive.external->failures())
      print(stderr, "sumo-gamma: --ego: a client failed: {}\n", what);
  const bool failed = drive.external && !drive.external->failures().empty();
  if (done < wanted && ended.client_left)
    print(stderr, "sumo-gamma: --ego: {}, {} of {} seeds aren't done; run again to go on\n",
          drive.external->closed() ? "the client has closed" : "nobody has joined", wanted - done,
          wanted);
  return failed || done < wanted ? kExitNotHeld : kExitDone;
}

}  // namespace

Seeds parse_seeds(const std::string& option, const std::string& text) {
  constexpr std::uint64_t kMost = 1000000;
  Seeds seeds;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::string_view one = std::string_view(text).substr(begin, comma - begin);
    const std::size_t dots = one.find("..");
    const std::uint64_t first = parse_whole(option, one.substr(0, dots));
    const std::uint64_t last =
        dots == std::string_view::npos ? first : parse_whole(option, one.substr(dots + 2));
    if (last < first || last - first >= kMost)
      throw Error(option, "'" + std::string(one) + "' must be A..B with A at most B, a million " +
                              "seeds at the most");
    for (std::uint64_t seed = first; seed <= last && seed >= first; ++seed) seeds.push_back(seed);
    begin = comma + 1;
  }
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  return seeds;
}

int drive_session(const DriveOptions& options, const CommonOptions& common) {
  const Shard shard = parse_shard(options.shard);
  const Seeds all = parse_seeds("--seeds", options.seeds);
  const Seeds seeds = shard_of(all, shard), replays = replays_of(options, all);
  Drive drive = make_drive(options, common);
  const std::filesystem::path& folder = options.run.output;
  make_output_folder(folder);
  const FolderLock lock(folder, "drive");
  const Json settings = settings_json(drive, common);
  claim(folder, settings);
  for (const auto& from : options.merge) merge_from(from, folder, settings, seeds);

  Ended ended;
  std::exception_ptr failure;
  const Seeds left = left_of_drive(folder, seeds, options.address.empty() ? replays : Seeds());
  if (!left.empty()) {
    provide_type(drive, folder);
    if (!common.quiet) print(stderr, "drive: reading {}\n", drive.plan.input.network.string());
    drive.sim = make_simulation(drive.plan, common.threads);
    drive.types = drive.sim->model.types;
    // once for all episodes
    drive.kinematics = build_kinematic_tables(drive.types, *drive.sim->workers);
    if (!options.address.empty()) {
      drive.external =
          std::make_unique<ExternalEgo>(options.address, options.anywhere, options.limits,
                                        hello_of(drive, left), [] { return interrupted(); });
      print(stderr, "drive: waits for an ego at {}\n", drive.external->address());
    }
    try {
      ended = drive_episodes(drive, folder, left, replays, common.quiet);
    } catch (...) {  // SUMO failed, say: what was driven until then has its tables
      failure = std::current_exception();
    }
  }
  std::vector<Json> episodes;
  std::size_t done = 0;
  for (const std::uint64_t seed : seeds) {
    Json episode = read_episode(folder, seed);
    if (episode.is_null()) continue;
    done += episode["episode"]["outcome"] != outcome::kClientFailed ? 1 : 0;
    episodes.push_back(std::move(episode));
  }
  if (!failure || !episodes.empty()) {
    write_drive(folder, settings, episodes);
    print_summary(folder, episodes);
  }
  if (failure) std::rethrow_exception(failure);
  return exit_code(drive, ended, done, seeds.size());
}

}  // namespace sumogamma
