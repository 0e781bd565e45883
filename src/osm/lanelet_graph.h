#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "osm/lanelet_map.h"

namespace sumogamma::osm {

/// Lanelets for vehicles, cut and prolonged so that a network can be made of them, and how they
/// follow each other. Numbers are places in `lanelets`.
struct LaneletGraph {
  std::vector<Lanelet> lanelets;
  std::vector<std::vector<std::size_t>> next, before;
  std::vector<bool> on_junction;  ///< crosses another, or several follow or lead to it
  std::vector<std::pair<std::size_t, std::size_t>> meetings;  ///< pairs for which that is so
  std::size_t cut = 0;                                        ///< lanelets cut in two
  std::size_t prolonged = 0;  ///< lanes that go on beyond the map's end
};

/// Lanelets follow each other where they share both end nodes, or, where one has no such neighbour,
/// ends within 2 m in one direction. Rows of them that follow each other are one. Where one begins
/// or ends in the middle of another, that is cut in two there, and with it the lanes beside it.
/// Lanes that the map ends go on for `beyond` metres as a lane beside them does, else straight, or
/// to just before what they would cross.
LaneletGraph lanelet_graph_of(const LaneletMap& map, double beyond);

/// The lanelet right of one, behind a common border; its own number where there is none.
std::size_t right_of(const LaneletGraph& graph, std::size_t lanelet);

}  // namespace sumogamma::osm
