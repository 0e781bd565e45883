#include "app/recording_map.h"

#include <algorithm>
#include <set>

#include "app/validators.h"
#include "base/error.h"
#include "osm/geo_projection.h"
#include "osm/recorded_signals.h"
#include "road/sumo_net_reader.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;

/// The network that a user means by a file or a scenario folder.
fs::path network_of(const fs::path& map) {
  if (!fs::is_directory(map)) {
    if (!is_sumo_network(map))
      throw Error(map.string(),
                  "is no map, expected NAME.net.xml, NAME.net.xml.gz or a scenario folder; "
                  "`sumo-gamma scene-from RECORDING --map NAME.osm -o FOLDER` makes one of a "
                  "Lanelet2 map");
    return map;
  }
  if (fs::exists(map / "net.net.xml")) return map / "net.net.xml";
  std::set<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(map))
    if (is_sumo_network(entry.path())) found.insert(entry.path());
  if (found.size() != 1)
    throw Error(map.string(), "has " + std::to_string(found.size()) +
                                  " networks (*.net.xml), expected net.net.xml or one other: name "
                                  "the file that is meant");
  return *found.begin();
}

Vec2 offset_of(const MapArguments& arguments, const fs::path& file, const RoadNetwork& network) {
  if (!arguments.offset.empty() && !arguments.origin.empty())
    throw Error("--map-offset", "says the same as --map-origin, expected one of them");
  if (!arguments.offset.empty()) return {arguments.offset[0], arguments.offset[1]};
  if (arguments.origin.empty()) return Vec2::Zero();
  if (network.projection.empty() || network.projection == "!")
    throw Error(file.string(),
                "isn't georeferenced (projParameter is \"!\"), so --map-origin can't be placed on "
                "it: --map-offset X,Y takes metres");
  const osm::GeoProjection projection(network.projection);
  return projection.to_plane({arguments.origin[1], arguments.origin[0]}) +
         network.projection_offset;
}

}  // namespace

bool is_sumo_network(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(".net.xml") || name.ends_with(".net.xml.gz");
}

void add_map_options(CLI::App& command, MapArguments& arguments) {
  command.add_option("--map", arguments.map,
                     "SUMO network of the place (NAME.net.xml) or a scenario folder: agents on "
                     "wheels that lie on its lanes may follow them, behind others and by signals "
                     "where scene-from made them of recorded ones");
  command
      .add_option("--map-offset", arguments.offset,
                  "X,Y [m]: added to the recording's positions gives the network's")
      ->delimiter(',')
      ->expected(2)
      ->check(finite_number(-1e7, 1e7));
  command
      .add_option("--map-origin", arguments.origin,
                  "LAT,LON of the origin of the recording's axes (x east, y north), on a "
                  "georeferenced network")
      ->delimiter(',')
      ->expected(2)
      ->check(finite_number(-180, 180));
}

PredictionMap RecordingMap::under(const TrackSet& set) const {
  PredictionMap own = map;
  own.first_frame = set.first_frame;
  return own;
}

std::unique_ptr<const RecordingMap> read_recording_map(const MapArguments& arguments,
                                                       Workers& workers) {
  if (arguments.map.empty()) {
    if (!arguments.offset.empty() || !arguments.origin.empty())
      throw Error(arguments.offset.empty() ? "--map-origin" : "--map-offset",
                  "places a map, expected --map NAME.net.xml, too");
    return nullptr;
  }
  const fs::path file = network_of(arguments.map);
  auto read = std::make_unique<RecordingMap>();
  read->network = read_sumo_net(file, workers);
  read->map.name = file.string();
  read->map.network = &read->network;
  read->map.offset = offset_of(arguments, file, read->network);
  const std::set<std::string> recorded = osm::replayed_signals(file);
  for (const Signal& signal : read->network.signals)
    read->map.recorded.push_back(recorded.contains(signal.name));
  return read;
}

nlohmann::ordered_json map_json(const RecordingMap* map) {
  if (map == nullptr) return nullptr;
  const std::vector<bool>& recorded = map->map.recorded;
  return {{"network", map->map.name},
          {"offset_m", {map->map.offset.x(), map->map.offset.y()}},
          {"signals", recorded.size()},
          {"recorded_signals", std::count(recorded.begin(), recorded.end(), true)}};
}

}  // namespace sumogamma
