#include "traffic/junction/waiting_place.h"

#include <algorithm>

#include "scene/extent.h"
#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

Piece as_travelled(const Path& path, double link_begin, double begin, double end) {
  if (!path.walking) return {begin, end};
  const PathStretch& stretch = path.stretch_at(link_begin + 0.01);
  if (!stretch.reversed) return {begin, end};
  const double length = stretch.to - stretch.from;
  return {length - end, length - begin};
}

WaitingPlace waiting_place(const TrafficParameters& parameters, const PathLink& link,
                           double zone_begin) {
  const double begin = link.stop_line + zone_begin;
  const double place = std::min(link.inside, begin) - parameters.line_tolerance;
  if (begin < link.inside - parameters.waiting_room ||
      place < link.stop_line + parameters.waiting_room)
    return {link.stop_line, false};
  return {place, true};
}

namespace {

/// Is somebody in a zone of a foe's link, or will be soon?
bool comes_soon(const TrafficParameters& parameters, const ConflictZone& zone,
                const Approach& foe) {
  if (foe.front - foe.length > zone.foe_end) return false;
  return foe.front > 0.0 ||
         (!foe.stands && zone.foe_begin - foe.front <
                             parameters.outlook * std::max(foe.speed, parameters.flow_speed));
}

}  // namespace

void keep_zones_free(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                     LinkDecision& decision) {
  const Model& model = view.model;
  const RoadState& road = view.road;
  const Scene& scene = view.scene;
  const ApproachTable& approaches = view.approaches;
  const Path& path = *road.path(scene.path[traveller.row]);
  const AgentType& type = type_of(model.types, scene.type[traveller.row]);
  const bool wide = is_wide(scene, traveller.row);
  for (bool again = true; again;) {
    again = false;
    for (const ConflictZone& zone : model.conflicts[index_of(link.connection)]) {
      if (runs_together(model, link.connection, zone.foe)) continue;
      for (const Approach& foe : approaches.of(zone.foe)) {
        if (foe.row == traveller.row) continue;
        const auto theirs = zone_for(zone, wide || foe.wide);
        if (!theirs || !comes_soon(view.parameters, *theirs, foe)) continue;
        const Piece piece = as_travelled(path, link.stop_line, theirs->begin, theirs->end);
        const double begin = link.stop_line + piece.begin, end = link.stop_line + piece.end;
        const double line = std::max(begin, link.stop_line) - view.parameters.stop_margin;
        if (decision.stop_at <= begin || decision.stop_at - traveller.length >= end) continue;
        if (line >= decision.stop_at || line < traveller.front) continue;
        if (deceleration_to_stop(traveller.speed, line - traveller.front) >
            type.comfortable_deceleration)
          continue;
        decision.stop_at = line;
        again = true;
      }
    }
  }
}

}  // namespace sumogamma
