#pragma once

#include <span>

#include "osm/osm_map.h"
#include "osm/repair_names.h"

namespace sumogamma::osm {

/// What stays of ways beyond the place, so that junctions at its edge stay whole [m].
inline constexpr double kBeyondBox = 60.0;

/// What repairs of a map need to know besides it.
struct MapFacts {
  GeoBox box;              ///< the place asked for
  bool clip = true;        ///< false where the extract does not say what it covers
  bool left_hand = false;  ///< traffic keeps left
};

/// One step between what people mapped and what netconvert 1.15 understands. It changes the map in
/// place and says in the log what it guessed, moved or dropped.
struct MapRepair {
  RepairName name;
  void (*mend)(OsmMap&, const MapFacts&, IssueLog&);
};

/// In the order in which they run: each expects what those before it leave.
std::span<const MapRepair> map_repairs();

/// Runs all of them but those that are switched off.
void repair_map(OsmMap& map, const MapFacts& facts, const RepairSet& off, IssueLog& log);

}  // namespace sumogamma::osm
