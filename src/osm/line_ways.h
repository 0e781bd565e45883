#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// A way that a line takes, with its points in the direction of travel.
struct LineWay {
  std::int64_t way = 0;
  std::vector<GeoPoint> places;
};

/// Where a line halts, as the map has it: beside the road (a platform) or on it.
struct LineStop {
  std::string id;  ///< "n123" or "w123"
  std::string name;
  GeoPoint place;
};

/// A line of public transport: one relation of the map.
struct MapLine {
  std::int64_t id = 0;
  std::string line;    ///< its ref, else its name, else its number in the map
  std::string kind;    ///< "bus", "trolleybus", ...
  double headway = 0;  ///< [s]; 0: the map doesn't say
  /// One direction, its ways in order; else both directions, as ways in any order.
  bool directed = false;
  /// Ways that follow each other within the extract. Of a line that isn't directed one run, which
  /// holds a way once for each direction that the line may take it in.
  std::vector<std::vector<LineWay>> runs;
  std::vector<LineStop> stops;  ///< in the order of the relation
};

/// What an extract has of public transport.
struct MapLines {
  std::vector<MapLine> lines;          ///< on roads, by id
  std::vector<LineStop> stops;         ///< all stops of buses, of lines or not, by id
  std::map<std::string, long> others;  ///< relations of kinds that no road carries, by kind
};

/// Lines and stops of the map as it was read: before repairs move, cut and join its ways. A
/// relation after the schema of 2011 (public_transport:version=2), or one of several with the same
/// ref, is one direction; another one stands for both.
MapLines find_lines(const OsmMap& map);

/// Seconds between two departures, of OpenStreetMap's `interval`: minutes ("10"), HH:MM,
/// HH:MM:SS, or the mean of two of these ("00:06-00:12"); 0 for anything else.
double headway_of(const std::string& interval);

}  // namespace sumogamma::osm
