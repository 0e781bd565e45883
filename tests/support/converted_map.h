#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "osm/netconvert.h"
#include "osm/network_file.h"
#include "road/sumo_net_reader.h"

namespace sumogamma::osm {

/// A map around 51 N, 1 W in a folder of its own, for netconvert; gone with this.
struct ConvertedMap {
  NetconvertRequest request;

  ConvertedMap(const char* map, bool left_hand) {
    request.folder = std::filesystem::temp_directory_path() /
                     ("sumogamma_converted_" + std::to_string(getpid()));
    std::filesystem::create_directories(request.folder / "work");
    std::ofstream(request.folder / request.prepared) << map;
    request.projection = "+proj=tmerc +lat_0=51 +lon_0=-1 +ellps=WGS84 +units=m +no_defs";
    request.left_hand = left_hand;
  }
  ConvertedMap(const ConvertedMap&) = delete;
  ConvertedMap& operator=(const ConvertedMap&) = delete;
  ~ConvertedMap() { std::filesystem::remove_all(request.folder); }

  std::filesystem::path network() const { return request.folder / request.network; }
  NetworkFile load() const { return load_network(network()); }
  RoadNetwork read() const { return read_sumo_net(network()); }
};

}  // namespace sumogamma::osm
