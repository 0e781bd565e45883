#pragma once

#include "traffic/traffic_view.h"

namespace sumogamma {

/// Whether, where and why an agent must halt before a link of its path.
struct LinkDecision {
  bool must_stop = false;
  double stop_at = 0;  ///< along the path, for the front [m]
  LimitReason reason = LimitReason::None;
  std::int64_t foe = -1;
};

/// The traveller whose link is judged.
struct Traveller {
  std::size_t row = 0;
  double front = 0;   ///< along its path [m]
  double length = 0;  ///< [m]
  double speed = 0;   ///< along its path [m/s]
};

/// Signals, priority and occupied conflict zones (facts of the network) applied to one link.
LinkDecision decide_link(const TrafficView& view, const Traveller& traveller, const PathLink& link);

/// Does a body leave free what a traveller sweeps between two places [m past its link's begin]?
/// Conflict zones and swept ways are wider than bodies.
bool stands_beside(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                   double begin, double end, const Approach& foe);

/// Do two links lead from lanes of one road into one lane?
bool runs_together(const Model& model, ConnectionId a, ConnectionId b);

/// Does anybody cross or join at a link but those who come from the next lane of the same road?
bool has_crossing_traffic(const Model& model, ConnectionId link);

/// Whom to follow where lanes run together like the teeth of a zipper, into one lane from lanes of
/// one road: who is nearer to the end of the common ground goes first.
struct ZipperLeader {
  double gap = 0, speed = 0;  ///< between the fronts less the other's length [m]; of it [m/s]
  std::int64_t id = -1;       ///< -1: nobody
};
ZipperLeader find_zipper_leader(const TrafficView& view, const Traveller& traveller,
                                const PathLink& link);

}  // namespace sumogamma
