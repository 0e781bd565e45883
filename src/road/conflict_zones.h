#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "road/path.h"

namespace sumogamma {

/// Lorries and buses: they need more of their lane than cars [m].
inline constexpr double kWideBody = 2.1;

/// Where the ways over two links are too near to each other for two bodies. Distances [m] run from
/// where a link begins (its stop line).
struct SharedStretch {
  double begin = 0, end = 0;          ///< on this link
  double foe_begin = 0, foe_end = 0;  ///< on the foe
};

/// Where two links of a junction get in each other's way, seen from one of them: for whatever
/// drives on them.
struct ConflictZone : SharedStretch {
  ConnectionId foe = kNoConnection;
  bool yields = false;      ///< this link must let the foe pass
  bool foe_yields = false;  ///< the foe must let this one pass
  bool unruled =
      false;  ///< the matrix knows no conflict, but bodies would meet: first come, first served
  bool foe_is_crossing = false;
  /// If neither body is wider than kWideBody; none where such two pass each other.
  std::optional<SharedStretch> of_narrow;
};

/// The zone as it is for two bodies, one of which is wide, or neither: none where they pass each
/// other.
std::optional<ConflictZone> zone_for(const ConflictZone& zone, bool one_is_wide);

/// By connection: its conflicts with the other links of its junction, from the right-of-way matrix
/// and the geometry of the ways that are driven (corners rounded as for a car, or for a bicycle
/// where only those may drive; sampled every metre; ways conflict where their swept widths meet).
/// Links that the matrix calls conflicting but whose ways never come near are left out, as are the
/// two directions of one narrow road side by side; links that it calls free of conflict but whose
/// ways meet, as of opposite turns on a narrow junction, are in.
using ConflictTable = std::vector<std::vector<ConflictZone>>;
ConflictTable build_conflict_table(const RoadNetwork& network, Workers& workers);
inline ConflictTable build_conflict_table(const RoadNetwork& network) {
  Workers alone;
  return build_conflict_table(network, alone);
}

/// The way of a body with that turning radius over a link, with up to `before` [m] of the lane that
/// it comes from and `after` of the one into which it leads: the line, the link with its stop
/// line and end, and where the kerbs of the three lanes are. Empty for a link without lanes of its
/// own.
Path rounded_way(const RoadNetwork& network, ConnectionId id, double before, double after,
                 const Cornering& cornering);

/// Likewise over links that follow each other, the lanes between them whole; `after` is on the last
/// lane, the link is the first one. Precondition: not empty.
Path rounded_way(const RoadNetwork& network, std::span<const ConnectionId> ids, double before,
                 double after, const Cornering& cornering);

/// Does a link lead vehicles over a junction, from lane to lane?
bool is_driven(const RoadNetwork& network, ConnectionId id);

/// Those of a junction's links that do, in the order of its matrix.
std::vector<ConnectionId> driven_links(const RoadNetwork& network, const Junction& junction);

/// Centreline of a link over its junction: its internal lanes in order, or the crossing that it
/// enters.
Polyline link_geometry(const RoadNetwork& network, ConnectionId id);

}  // namespace sumogamma
