#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/recording_map.h"
#include "app/scene_reading.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/print.h"
#include "base/staged_folder.h"
#include "io/output_file.h"
#include "io/output_folder.h"
#include "osm/lanelet_network.h"
#include "osm/recorded_signals.h"
#include "realism/map_matching.h"
#include "realism/scene_export.h"
#include "road/sumo_net_reader.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct SceneFromOptions {
  std::string recording;
  fs::path map, output;
  std::vector<double> origin;
  fs::path signals, signal_map;
  double beyond = 100.0;
  double at = 1.0;
  bool force = false;
  SceneArguments reading;
};

Json described(const RecordedScene& scene) {
  return {{"version", SUMOGAMMA_VERSION},
          {"recording", scene.name},
          {"format", scene.format},
          {"duration_s", scene.duration()},
          {"agents", scene.agents.size()},
          {"default_boxes", scene.default_boxes},
          {"tracks_left_out", scene.too_short},
          {"notes", scene.notes}};
}

/// Without a map: open ground.
void write_open_scene(const RecordedScene& scene, const SceneFromOptions& options, std::FILE* out) {
  const int start = scene.first + static_cast<int>(std::lround(options.at / kScoreStep));
  const OpenScene open = open_scene_of(scene, start);
  write_file(options.output / "scene.csv", open.scene);
  write_file(options.output / "arrivals.csv", open.arrivals);
  if (!open.obstacles.empty()) write_file(options.output / "obstacles.json", open.obstacles);
  Json json = described(scene);
  json["start_s"] = kScoreStep * (open.start - scene.first);
  json["present"] = open.present;
  json["arriving"] = open.arriving;
  json["obstacles"] = scene.obstacles.size();
  json["given"] = {"place, heading and speed at the start", "size, or the type's",
                   "goal: the last recorded place",
                   "preferred speed: 85th percentile of the recorded ones"};
  json["scene_command_leaves_out"] = {"arrivals.csv", "obstacles.json"};
  write_file(options.output / "scene.json", json.dump(1) + "\n");
  print(out, "{}: {} agents are there at {:.1f} s (scene.csv), {} come later (arrivals.csv)\n",
        scene.name, open.present, json["start_s"].get<double>(), open.arriving);
  print(out,
        "`sumo-gamma scene` drives scene.csv alone: nobody comes, and {} obstacles aren't "
        "there\n",
        scene.obstacles.size());
}

/// "1, 2, 3 …" of many.
std::string first_of(const std::vector<std::uint32_t>& ids) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t k = 0; k < std::min(ids.size(), kMost); ++k)
    text += (k > 0 ? ", " : "") + std::to_string(ids[k]);
  return text + (ids.size() > kMost ? " …" : "");
}

/// Throws Error where the recording doesn't lie on the network.
void require_on_routes(const RoadScene& road, const SceneFromOptions& options) {
  if (road.points == 0)
    throw Error(options.recording, "has no motor vehicles, which a map is for; leave out --map");
  const double share = static_cast<double>(road.near) / static_cast<double>(road.points);
  if (share >= kLeastOnRoutes) return;
  throw Error(
      options.map.string(),
      fmt::format("{:.1f} % of the motor vehicles' points lie within {} m of a route on it, "
                  "expected {:.0f} %; {} vehicles don't (ids {}): the map is another "
                  "place's, in other axes, or lacks lanes",
                  100.0 * share, kOnRoute, 100.0 * kLeastOnRoutes, road.worst.size(),
                  first_of(road.worst)));
}

/// A Lanelet2 map as a network of SUMO's: its plain files and the network in a folder of their own.
/// Returns what is told of it.
Json convert_lanelets(const RecordedScene& scene, const SceneFromOptions& options,
                      const fs::path& folder) {
  std::optional<osm::GeoPoint> origin;
  if (!options.origin.empty()) origin = osm::GeoPoint{options.origin[1], options.origin[0]};
  osm::LaneletMap map = osm::read_lanelet_map(options.map, origin);
  std::vector<osm::SignalledWay> signalled;
  osm::SignalChanges changes;
  if (!options.signals.empty()) {
    changes = osm::read_signal_changes(options.signals, scene.own_period);
    signalled = osm::read_signal_map(options.signal_map, origin.value_or(osm::GeoPoint{}));
    osm::mark_signalled(signalled, map);
  }
  const osm::PlainNetwork plain = osm::plain_network_of(map, options.beyond, options.map);
  const std::string name = options.map.stem().string();
  osm::write_lanelet_network(plain, folder, name);
  Json signals;
  if (!options.signals.empty()) {
    const osm::SignalReplay replay = osm::replay_signals(folder / (name + ".net.xml"), signalled,
                                                         changes, kScoreStep * scene.first);
    signals = {{"programs", replay.signals},
               {"links", replay.links},
               {"links_without_a_group", replay.unknown},
               {"phases", replay.phases}};
  }
  return {{"axes", map.axes},
          {"signals", signals},
          {"lanelets", map.lanelets.size()},
          {"lanelets_turned", map.turned},
          {"lanelets_without_a_limit", map.without_a_limit},
          {"edges", plain.edge_count},
          {"lanes", plain.lane_count},
          {"ways_over_junctions", plain.turn_count},
          {"junctions", plain.junction_count},
          {"junctions_without_a_rule", plain.without_a_rule},
          {"lanelets_cut", plain.cut},
          {"lanes_prolonged", plain.prolonged},
          {"left_out", map.left_out}};
}

/// What a user has to know of a map that was made here.
void print_lanelets(const Json& lanelets, const SceneFromOptions& options, std::FILE* out) {
  print(out, "{}: {} lanelets in axes of {}; {} edges with {} lanes, {} ways over {} junctions\n",
        options.map.filename().string(), lanelets["lanelets"].get<std::size_t>(),
        lanelets["axes"].get<std::string>(), lanelets["edges"].get<std::size_t>(),
        lanelets["lanes"].get<std::size_t>(), lanelets["ways_over_junctions"].get<std::size_t>(),
        lanelets["junctions"].get<std::size_t>());
  print(out, "assumed: {} lanes go on for up to {:.0f} m behind the map's end\n",
        lanelets["lanes_prolonged"].get<std::size_t>(), options.beyond);
  if (lanelets["lanelets_without_a_limit"] > 0)
    print(out, "assumed: 50 km/h on {} lanelets of which the map tells no limit\n",
          lanelets["lanelets_without_a_limit"].get<std::size_t>());
  if (lanelets["junctions_without_a_rule"] > 0)
    print(out, "assumed: netconvert's right of way at {} junctions of which the map tells none\n",
          lanelets["junctions_without_a_rule"].get<std::size_t>());
  const Json& signals = lanelets["signals"];
  if (signals.is_null())
    print(out, "left out: signals as recorded (--signals, --signal-map)\n");
  else
    print(out,
          "signals: {} programs of {} phases as recorded; {} of {} ways have no signal group\n",
          signals["programs"].get<std::size_t>(), signals["phases"].get<std::size_t>(),
          signals["links_without_a_group"].get<std::size_t>(), signals["links"].get<std::size_t>());
  for (const auto& [kind, count] : lanelets["left_out"].items())
    print(out, "left out of the map: {} {}\n", count.get<long>(), kind);
}

void write_road_scene(const RecordedScene& scene, const SceneFromOptions& options, std::FILE* out) {
  std::optional<StagedFolder> made;
  fs::path file = options.map;
  Json lanelets;
  if (file.extension() == ".osm") {
    made.emplace(options.output / "lanelets", options.force);
    lanelets = convert_lanelets(scene, options, made->path());
    file = made->path() / (options.map.stem().string() + ".net.xml");
  }
  const RoadNetwork network = read_sumo_net(file);
  const RoadScene road = road_scene_of(scene, network);
  require_on_routes(road, options);
  const std::string net = file.filename().string();
  write_file(options.output / net, read_file(file));
  if (made) {
    fs::remove(file);
    made->commit();
  }
  if (made && !lanelets.is_null()) print_lanelets(lanelets, options, out);
  write_file(options.output / "recorded.rou.xml", road.routes);
  // everybody gets half as long again as the recording took
  write_file(options.output / "recorded.sumocfg",
             fmt::format("<configuration>\n  <input>\n    <net-file value=\"{}\"/>\n"
                         "    <route-files value=\"recorded.rou.xml\"/>\n  </input>\n  <time>\n"
                         "    <begin value=\"0\"/>\n    <end value=\"{:.0f}\"/>\n  </time>\n"
                         "</configuration>\n",
                         net, std::ceil(1.5 * scene.duration())));
  Json json = described(scene);
  json["map"] = net;
  if (!lanelets.is_null()) json["lanelets"] = lanelets;
  json["vehicles"] = road.vehicles;
  json["people"] = road.people;
  json["vehicles_without_a_route"] = road.no_route;
  json["bicycles_beside_lanes"] = road.beside_lanes;
  json["people_without_a_sidewalk"] = road.no_sidewalk;
  json["points"] = road.points;
  json["points_on_routes"] = road.near;
  json["vehicles_off_their_route"] = road.worst;
  json["given"] = {"time, lane, place and speed of departure", "size, or the type's", "route",
                   "place of arrival"};
  write_file(options.output / "scene.json", json.dump(1) + "\n");
  print(out,
        "{}: {} vehicles and {} people (recorded.sumocfg); {:.1f} % of the motor vehicles' points "
        "lie "
        "within {} m of their routes\n",
        scene.name, road.vehicles, road.people,
        100.0 * static_cast<double>(road.near) / static_cast<double>(road.points), kOnRoute);
  print(
      out,
      "left out: {} vehicles without a route, {} bicycles that ride where the map has no lane, {} "
      "people without a sidewalk within 10 m\n",
      road.no_route, road.beside_lanes, road.no_sidewalk);
}

int make_scene(const SceneFromOptions& options, const CommonOptions& common) {
  const std::string map = options.map.filename().string();
  const bool is_net = is_sumo_network(options.map);
  if (!map.empty() && !is_net && !map.ends_with(".osm"))
    throw Error("--map " + options.map.string(),
                "is no map, expected NAME.net.xml, NAME.net.xml.gz or a Lanelet2 map NAME.osm");
  if (options.signals.empty() != options.signal_map.empty())
    throw Error("--signals",
                "and --signal-map go together: what groups showed, and whose they are");
  if (!options.signals.empty() && !map.ends_with(".osm"))
    throw Error("--signals", "takes a Lanelet2 map, whose network is made here");
  require_without(options.output, "scene.json", options.force);
  const RecordedScene scene =
      read_recorded_scene(options.recording, scene_reading(options.reading));
  const OutputFolder folder(options.output, options.force);
  if (!common.quiet)
    for (const std::string& note : scene.notes) print(stderr, "{}: {}\n", scene.name, note);
  if (!common.quiet && scene.default_boxes > 0)
    print(stderr, "{}: {} of {} agents have no size in it and get their type's box\n", scene.name,
          scene.default_boxes, scene.agents.size());
  if (map.empty())
    write_open_scene(scene, options, common.out);
  else
    write_road_scene(scene, options, common.out);
  return kExitDone;
}

}  // namespace

CommandRunner add_scene_from_command(CLI::App& parent) {
  CLI::App* command =
      parent.add_subcommand("scene-from", "a recording as a scene, or as a scenario on a network");
  auto options = std::make_shared<SceneFromOptions>();
  command->add_option("RECORDING", options->recording, "as `predict` reads it")->required();
  command->add_option("-o,--output", options->output, "folder for the scene")->required();
  command->add_option("--map", options->map,
                      "map of the place: a SUMO network in the recording's axes (NAME.net.xml), or "
                      "a Lanelet2 map (NAME.osm); without: open ground");
  command
      ->add_option("--origin", options->origin,
                   "of a Lanelet2 map: LAT,LON of the origin of the recording's axes")
      ->delimiter(',')
      ->expected(2);
  command
      ->add_option("--beyond", options->beyond,
                   "of a Lanelet2 map: lanes go straight on behind its end for so long [m]")
      ->check(finite_number(0.0, 1e4))
      ->capture_default_str();
  command->add_option("--signals", options->signals,
                      "on a Lanelet2 map: what signal groups showed (CSV: signal_group, time_s or "
                      "frame, state)");
  command->add_option("--signal-map", options->signal_map,
                      "with --signals: KML of lanes with their sinks and signal groups");
  command
      ->add_option("--at", options->at,
                   "on open ground: the scene is that of so long after the recording's begin [s]")
      ->check(finite_number(0.0, 1e6))
      ->capture_default_str();
  command->add_flag("--force", options->force, "write into a folder that holds other results");
  add_scene_reading_options(*command, options->reading);
  return [options](const CommonOptions& common) { return make_scene(*options, common); };
}

}  // namespace sumogamma
