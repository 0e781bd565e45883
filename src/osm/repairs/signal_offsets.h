#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "road/road_network.h"

namespace sumogamma::osm {

/// A signal program of fixed times, second by second (SUMO page Simulation/Traffic_Lights).
struct SignalProgram {
  std::string name;                 ///< of the signal
  std::vector<std::string> states;  ///< a letter a link, for each second of the cycle
};

/// The programs of a network whose phases last whole seconds.
std::vector<SignalProgram> read_signal_programs(const pugi::xml_node& net);

/// Offsets [s, from 0 to the cycle], by signal, with which whoever gets green at one signal finds
/// the next one green when it gets there, as far as that can be: for signals with no more than 60 m
/// of road between them, in which a queue has hardly any room. Signals without such a neighbour are
/// not in it, nor are pairs whose cycles differ.
///
/// What is made small is the mean wait at the second signal of those who come over the first one at
/// any time of its green; straight on counts for more than turning, a short road for more than a
/// long one, and on along a road or path for more than out of one onto the other. Signal by signal
/// takes its best offset, given the others', until none gets better.
std::map<std::string, int> signal_offsets(const RoadNetwork& road,
                                          const std::vector<SignalProgram>& programs);

/// Gives signals of a network their offsets.
void set_signal_offsets(pugi::xml_node net, const std::map<std::string, int>& offsets);

}  // namespace sumogamma::osm
