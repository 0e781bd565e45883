#include "sumo/insertion.h"

#include <algorithm>
#include <utility>

#include "base/units.h"
#include "scene/behavior_draw.h"
#include "sumo/sumo_agents.h"

namespace sumogamma {

namespace {

/// The agent as it would stand at the start of `path`, by its size and habits.
AgentState newcomer(const Model& model, const PendingAgent& pending, const Path& path, AgentId id,
                    std::uint64_t seed) {
  const SumoAgentDetails& details = pending.details;
  const AgentType& type = type_of(model.types, pending.type);
  AgentState agent;
  agent.id = id;
  agent.type = pending.type;
  const bool own_size = details.is_person;
  const double length = details.length > 0.0 && !own_size ? details.length : type.length;
  const double width = details.width > 0.0 && !own_size ? details.width : type.width;
  agent.footprint = box_footprint(length, width);
  const Vec2 direction = path.line.direction_at(0.0);
  agent.manners = draw_manners(type.compliance, seed, id.value);
  agent.manners.path_offset = draw_path_offset(model, type, seed, id);
  const PathStretch& stretch = path.stretches.front();
  const double half_width = 0.5 * width;
  const double offset =
      std::clamp(agent.manners.path_offset, std::min(0.0, half_width + 0.1 - stretch.room_right),
                 std::max(0.0, stretch.room_left - half_width - 0.1));
  agent.position = path.line.point_at(0.0) + offset * left_of(direction);
  agent.heading = heading_of(direction);
  agent.preferred_speed =
      details.max_speed > 0.0
          ? std::min(details.max_speed * (details.is_person ? details.speed_factor : 1.0),
                     type.max_speed)
          : type.preferred_speed;
  if (type.compliance.free_speed > 0.0)
    agent.preferred_speed =
        std::min(draw_free_speed(type.compliance, seed, id.value), type.max_speed);
  agent.behavior = draw_behavior(type, seed, id.value);
  agent.path = static_cast<PathId>(id.value);
  return agent;
}

/// Puts somebody on foot where there is room beside the start of its path, no house and nobody;
/// nothing where there is none.
std::optional<double> place_on_foot(const EntryView& view, PendingAgent::Entry& entry,
                                    const Ground& ground, AgentState& agent) {
  const Path& path = *entry.path;
  const PathStretch& stretch = path.stretches.front();
  const Vec2 left = left_of(path.line.direction_at(0.0)), middle = path.line.point_at(0.0);
  const double half_width = agent.footprint.vertices[1].y();
  std::vector<double> places =
      entry_offsets((agent.position - middle).dot(left), half_width + 0.1 - stretch.room_right,
                    stretch.room_left - half_width - 0.1);
  const auto put_at = [&](double offset) { agent.position = middle + offset * left; };
  std::erase_if(places, [&](double offset) {
    put_at(offset);
    return is_walled_off(view.model, agent, middle);
  });
  // where walls leave nothing else, amid the way
  if (places.empty()) places.push_back(0.0);
  for (const double offset : places) {
    put_at(offset);
    if (const auto speed = entry_speed(view, path, agent, ground, 0.0, entry.blocker)) return speed;
  }
  return std::nullopt;
}

std::optional<Entrant> find_room_on(const EntryView& view, const PendingAgent& pending,
                                    PendingAgent::Entry& entry, AgentId id, std::uint64_t seed) {
  Entrant entrant{newcomer(view.model, pending, *entry.path, id, seed), entry.path};
  const PathStretch& stretch = entry.path->stretches.front();
  entrant.height = elevation_at(view.model.road.lane(stretch.lane), stretch.lane_from);
  const Ground ground{stretch.lane, stretch.lane_from, entrant.height};
  const std::optional<double> speed = pending.details.is_person
                                          ? place_on_foot(view, entry, ground, entrant.state)
                                          : entry_speed(view, *entry.path, entrant.state, ground,
                                                        pending.depart_speed, entry.blocker);
  if (!speed) return std::nullopt;
  entrant.state.speed = *speed;
  return entrant;
}

}  // namespace

std::optional<Entrant> find_room(const EntryView& view, PendingAgent& pending, AgentId id,
                                 std::uint64_t seed) {
  if (auto entrant = find_room_on(view, pending, pending.entry, id, seed)) return entrant;
  const Path& path = *pending.entry.path;
  if (!path.trip) return std::nullopt;
  if (!std::exchange(pending.looked_besides, true))
    for (auto& beside : paths_besides(view.model, pending.details, pending.type, path))
      pending.besides.push_back({std::move(beside), {}});
  for (PendingAgent::Entry& beside : pending.besides)
    if (auto entrant = find_room_on(view, pending, beside, id, seed)) return entrant;
  return std::nullopt;
}

}  // namespace sumogamma
