#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "osm/lanelet_map.h"

namespace sumogamma::osm {

/// A way over a junction that a signal group is for, by a map of lanes and groups.
struct SignalledWay {
  int group = 0;
  Vec2 from = Vec2::Zero();  ///< where its lane ends, at the stop line [m]
  Vec2 to = Vec2::Zero();    ///< where the lane begins that it leads to [m]
};

/// What signal groups showed: SUMO's letters by time [s], of each group; 'G' stands for green.
using SignalChanges = std::map<int, std::map<double, char>>;

/// Reads CSV with columns signal_group, state and time_s or frame, a row a change, where states are
/// those of SAE J2735 (STOP_AND_REMAIN, PRE_MOVEMENT, PERMISSIVE_MOVEMENT_ALLOWED, ...), SUMO's
/// letters, or 0 red, 1 green, 3 yellow. `period`: of a frame [s]. Throws Error naming file and
/// line.
SignalChanges read_signal_changes(const std::filesystem::path& file, double period);

/// Reads a KML map of the form of the Test Area Baden-Württemberg: placemarks with a line from the
/// junction outwards, Source, and for lanes that lead to it Sink and SignalGroup, lists of equal
/// length. `origin`: of the recording's axes. Throws Error naming the file and the lane.
std::vector<SignalledWay> read_signal_map(const std::filesystem::path& file, GeoPoint origin);

/// Marks the lanelets at whose lanes' ends a signal stands. Returns how many.
std::size_t mark_signalled(const std::vector<SignalledWay>& ways, LaneletMap& map);

/// What became of recorded signals in a network.
struct SignalReplay {
  std::size_t signals = 0, links = 0, phases = 0;
  std::size_t unknown = 0;  ///< links of these of which no group is known: no signal there
};

/// Replaces the programs of a network's signals by one long one each that shows what was recorded,
/// from `begin` on, the time of the recording at the network's time 0 [s]; the last state holds.
/// Green is SUMO's 'G' where nobody who has green, too, goes first there, else 'g'. Throws Error
/// naming the file.
SignalReplay replay_signals(const std::filesystem::path& network,
                            const std::vector<SignalledWay>& ways, const SignalChanges& changes,
                            double begin);

/// Ids of a network's signals whose programs replay_signals wrote. Throws Error naming the file.
std::set<std::string> replayed_signals(const std::filesystem::path& network);

}  // namespace sumogamma::osm
