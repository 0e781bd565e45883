#pragma once

#include "traffic/junction/arbitration.h"
#include "traffic/junction/occupation.h"
#include "traffic/junction/waiting_place.h"

namespace sumogamma {

/// One of the two who come to a conflict area. Lengths are [m past its link's begin]. Laws read
/// what held it from `waits`: contexts, and what stands in TrafficState beside them, are being
/// written.
struct Party {
  Approach at;              ///< its front, speed and length on the way over its link
  const PathLink& on_path;  ///< the link as its path has it
  const Connection& link;
  const AgentType& type;
  const Waiting& waits;  ///< what held it a tick ago
  Piece area;            ///< as it travels it
  bool on_foot = false;
  bool at_red = false;  ///< it goes over its link at red, where the way is free
  bool yields = false;  ///< the law has it give way to the other
  bool inside = false;  ///< its front has entered the area
  bool clears = false;  ///< it clears the junction after its light changed
  bool rests = false;   ///< as things are, it will come to rest in the area
  Occupation stay{};    ///< in the area, filled by `foresee`

  std::size_t row() const { return at.row; }
  double to_area() const { return area.begin - at.front; }
};

/// Two who come to one conflict area, the same whoever of them asks.
struct Encounter : TrafficView {
  Party a, b;
  bool unruled = false;  ///< no rule says who goes first
};

/// The encounter of a traveller, the first party, with who approaches by the link of a zone of its
/// own link's table. `zone` holds for bodies of their widths.
Encounter meet(const TrafficView& view, const Traveller& traveller, const PathLink& link,
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

/// Is one past its line, or past its place to wait on the junction?
bool is_past_line(const Encounter& e, const Party& one);

/// Can one still halt at ease before the area?
bool may_halt(const Party& one);

/// Is some of its body on a junction, this one or one before?
bool is_on_junction(const Encounter& e, const Party& one);

/// Has it halted before its link, or where a halt counts for that?
bool has_halted(const Encounter& e, const Party& one);

/// Was one free to go a tick ago, and is it past `place` [m along its path], where it would wait?
/// Who has looked and set out needn't look again.
bool has_set_out_from(const Encounter& e, const Party& one, double place);

/// Does one stand and wait for the other?
bool waits_for(const Encounter& e, const Party& one, const Party& other);

/// Does a body that stands leave free what another sweeps of the area?
bool gets_past(const Encounter& e, const Party& one, const Party& standing);

/// Is somebody on wheels on the junction, past its line, in the way of one with the right of way?
/// The sooner it is gone the less of the green is lost.
bool holds_up(const TrafficView& view, std::size_t row, double past_line);

/// Is a vehicle past the line of a link that is red by now, or, for some time after the lights
/// changed, between the lines of an outer and an inner signal?
bool clears_junction(const TrafficView& view, std::size_t row, ConnectionId id, double past_line);

}  // namespace sumogamma
