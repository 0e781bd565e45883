#pragma once

#include "traffic/junction/arbitration.h"
#include "traffic/junction/occupation.h"

namespace sumogamma {

/// Two who come to one conflict area, seen by one of them, the subject; the other is its foe. What
/// several laws ask of the pair stands here, each under its own name.
struct Encounter : TrafficView {
  const Traveller& subject;
  const PathLink& link;  ///< the subject's
  bool at_red = false;   ///< the subject goes over its link at red, where the way is free
  ConflictZone zone;     ///< both pieces as they are travelled; `yields`: the subject does
  const Approach& foe;
  const Connection& own_link;
  const Connection& foe_link;
  const AgentType& own_type;
  const AgentType& foe_type;
  const Waiting& foe_waits;     ///< what held the foe a tick ago
  bool foe_inside = false;      ///< its front has entered the area
  bool foe_clears = false;      ///< it clears the junction after its light changed
  Occupation ours{}, theirs{};  ///< of the area, filled where it comes to that
  double to_line() const { return link.stop_line - subject.front; }  ///< [m], < 0 past it
};

/// The pair's encounter in a zone of the link's table. `zone` holds for bodies of their widths.
Encounter meet(const TrafficView& view, const Traveller& subject, const PathLink& link, bool at_red,
               const ConflictZone& zone, const Approach& foe);

/// When either is in the area.
void foresee(Encounter& encounter);

/// Is a row somebody on foot?
bool is_on_foot(const TrafficView& view, std::size_t row);

/// Does somebody at `speed` [m/s] stop within `way` [m] at ease?
bool stops_at_ease(double speed, double way, const AgentType& type);

/// Is a front `past` the begin of its link [m] in a zone that begins there at `begin`? Not who has
/// come to rest at its edge.
bool has_entered(const TrafficParameters& parameters, double past, double begin);

/// Has a row waited for longer than another? The smaller id where they began together.
bool has_waited_longer(const TrafficView& view, std::size_t row, std::size_t other);

/// Does the foe stand and wait for the subject itself?
bool waits_for_subject(const Encounter& e);

/// Was the subject free to go a tick ago, and is it past `place` [m along its path], where it would
/// wait? Who has looked and set out needn't look again.
bool has_set_out_from(const Encounter& e, double place);

/// Does a foe that stands and waits let the subject go first? It waits for a signal or in a queue,
/// for this very agent, or it came later. Of two that wait for each other exactly one goes: who is
/// on foot, else who has waited longer.
bool lets_subject_go(const Encounter& e);

/// Is the subject past its line, or past its place to wait on the junction?
bool is_past_line(const Encounter& e);

/// Can the foe still halt at ease before the area?
bool foe_may_halt(const Encounter& e);

/// Is some of the subject's body on a junction, this one or one before?
bool is_on_junction(const Encounter& e);

/// From 0 to 1 while the subject waits (Daganzo's and SUMO's impatience).
double impatience(const Encounter& e);

/// Is somebody on wheels on the junction, past its line, in the way of one with the right of way?
/// The sooner it is gone the less of the green is lost.
bool holds_up(const TrafficView& view, std::size_t row, double past_line);

/// Is a vehicle past the line of a link that is red by now, or, for some time after the lights
/// changed, between the lines of an outer and an inner signal?
bool clears_junction(const TrafficView& view, std::size_t row, ConnectionId id, double past_line);

}  // namespace sumogamma
