#pragma once

#include <string_view>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// The region with left-hand traffic that holds the place, e.g. "Great Britain and Ireland"; empty
/// where traffic keeps right. Coarse outlines of about 10 km at land borders, less where a city
/// lies on one (Hong Kong): within that of a border `--side left|right` should be given. Source:
/// countries by side of road, as of 2024.
std::string_view left_hand_region(GeoPoint place);

/// Is a place where one may turn at red after a halt, to the side that traffic keeps to: in the
/// United States and Canada, but not in New York City and on the island of Montreal? Within some
/// kilometres of Mexico the answer is that of the United States.
bool has_turns_on_red(GeoPoint place);

/// What the map itself says: how many closed one-way roundabouts turn clockwise (left-hand traffic)
/// and how many counter-clockwise. Rings with another ring about them may turn either way
/// (Swindon), so this is a cross-check only.
struct RoundaboutTurns {
  int clockwise = 0, counter_clockwise = 0;
};
RoundaboutTurns count_roundabout_turns(const OsmMap& map);

}  // namespace sumogamma::osm
