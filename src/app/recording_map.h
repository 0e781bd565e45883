#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "prediction/prediction_map.h"

namespace sumogamma {

/// What a user tells about the map under recordings.
struct MapArguments {
  std::filesystem::path map;   ///< empty: none
  std::vector<double> offset;  ///< x, y [m], or empty
  std::vector<double> origin;  ///< latitude, longitude, or empty
};

/// Is a file one of SUMO's networks, by its name?
bool is_sumo_network(const std::filesystem::path& file);

/// Adds --map, --map-offset and --map-origin.
void add_map_options(CLI::App& command, MapArguments& arguments);

/// A map that is read. Not to be moved: its PredictionMap refers to its network.
struct RecordingMap {
  RoadNetwork network;
  PredictionMap map;

  RecordingMap() = default;
  RecordingMap(const RecordingMap&) = delete;
  RecordingMap& operator=(const RecordingMap&) = delete;

  /// The same under a recording, whose first frame is time 0 of recorded signals.
  PredictionMap under(const TrackSet& set) const;
};

/// Reads a network, or that of a scenario folder (net.net.xml, or its only *.net.xml); null without
/// a map. Signals count whose programs scene-from wrote from a recording. Throws Error naming file
/// or option on what is no network, and where axes are told twice or the network isn't
/// georeferenced.
std::unique_ptr<const RecordingMap> read_recording_map(const MapArguments& arguments,
                                                       Workers& workers);

/// For the JSON of results; null without a map.
nlohmann::ordered_json map_json(const RecordingMap* map);

}  // namespace sumogamma
