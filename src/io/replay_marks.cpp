#include "io/replay_marks.h"

#include <fmt/format.h>

#include <cmath>

#include "io/results.h"

namespace sumogamma {

ReplayEvent mark_of(const CollisionPair& pair, bool over) {
  ReplayEvent mark{ReplayEventKind::Collision, pair.since, pair.position, pair.a, pair.b, ""};
  if (over)
    mark.words = fmt::format("up to {:.2f} m deep, {:.1f} s in all", pair.depth, pair.duration);
  return mark;
}

ReplayEvent mark_of(const OffenceSpan& offence, bool over) {
  ReplayEventKind kind = ReplayEventKind::RedLight;
  if (offence.kind == Offence::WrongWay) kind = ReplayEventKind::WrongWay;
  if (offence.kind == Offence::OffRoad) kind = ReplayEventKind::OffRoad;
  if (offence.kind == Offence::Sidewalk) kind = ReplayEventKind::Sidewalk;
  ReplayEvent mark{kind, offence.since, offence.position, offence.id, {kReplayNobody}, ""};
  if (over && offence.kind != Offence::RedLight)
    mark.words = fmt::format("for {:.1f} s", offence.duration);
  return mark;
}

ReplayEvent mark_of(const Conflict& conflict) {
  const bool severe = conflict.is_beyond(kFhwaThresholds);
  ReplayEvent mark{severe ? ReplayEventKind::Conflict : ReplayEventKind::Encounter,
                   conflict.time,
                   conflict.place,
                   conflict.a,
                   conflict.b,
                   ""};
  mark.words = conflict.kind == ConflictKind::RearEnd      ? "rear end"
               : conflict.kind == ConflictKind::LaneChange ? "lane change"
                                                           : "crossing";
  if (std::isfinite(conflict.time_to_collision))
    mark.words += fmt::format(", {:.1f} s to a collision", conflict.time_to_collision);
  if (std::isfinite(conflict.post_encroachment))
    mark.words += fmt::format(", {:.1f} s one after the other", conflict.post_encroachment);
  if (conflict.deceleration > 0.0)
    mark.words += fmt::format(", braking of {:.1f} m/s² asked", conflict.deceleration);
  return mark;
}

ReplayEvent mark_of(const StuckAgent& stuck, double time, const AgentName& name_of) {
  const auto named = [&](std::int64_t id) {
    return std::string(name_of(AgentId{static_cast<std::uint32_t>(id)}));
  };
  ReplayEvent mark{ReplayEventKind::Stuck, time, stuck.position, stuck.id, {kReplayNobody}, ""};
  if (stuck.foe >= 0) mark.b = AgentId{static_cast<std::uint32_t>(stuck.foe)};
  mark.words = fmt::format("stands since {:.0f} s", stuck.since);
  if (stuck.reason != LimitReason::None)
    mark.words += fmt::format(", because of: {}", name_of_reason(stuck.reason));
  if (stuck.ring)
    mark.words += ", those who wait for one another are a ring";
  else if (stuck.head >= 0 && stuck.head != stuck.foe)
    mark.words += fmt::format(", first of the queue is {} ({})", named(stuck.head),
                              name_of_reason(stuck.head_reason));
  return mark;
}

}  // namespace sumogamma
