#include "osm/traffic_graph.h"

#include <cmath>
#include <set>

#include "base/units.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

bool may_go(const MapWay& way, int direction) {
  return !is_one_way(way) || (is_reversed(way) ? direction < 0 : direction > 0);
}

}  // namespace

TrafficGraph::TrafficGraph(const OsmMap& map) : map_(map) {
  for (const MapWay& way : map.ways) {
    if (!is_car_way(way)) continue;
    for (std::size_t i = 0; i < way.nodes.size(); ++i) {
      const bool closing = i + 1 == way.nodes.size() && way.nodes[i] == way.nodes[0];
      if (i > 0) add(way, i, -1);
      if (i + 1 < way.nodes.size() && !closing) add(way, i, 1);
    }
  }
}

void TrafficGraph::add(const MapWay& way, std::size_t index, int direction) {
  arms_[way.nodes[index]].push_back({&way, index, direction});
  inputs_[way.nodes[index]] += may_go(way, -direction) ? 1 : 0;
}

bool TrafficGraph::is_junction(std::int64_t node) const {
  const auto found = arms_.find(node);
  return found != arms_.end() && found->second.size() >= 3 && inputs_.at(node) >= 2;
}

std::vector<Step> TrafficGraph::exits(std::int64_t node) const {
  std::vector<Step> result;
  if (const auto found = arms_.find(node); found != arms_.end())
    for (const Step& step : found->second)
      if (may_go(*step.way, step.direction)) result.push_back(step);
  return result;
}

/// The way on from a node that is no junction: where a slip lane leaves, the one straight ahead.
std::optional<Step> TrafficGraph::straightest_exit(std::int64_t node,
                                                   std::int64_t came_from) const {
  std::optional<Step> best;
  double least = kPi / 4;
  const GeoPoint here = map_.nodes.at(node).place;
  const LocalMetric metric(here);
  const double before = metric.bearing(map_.nodes.at(came_from).place, here);
  for (const Step& exit : exits(node)) {
    const std::size_t after = exit.direction > 0 ? exit.index + 1 : exit.index - 1;
    const std::int64_t next = exit.way->nodes[after];
    if (next == came_from) continue;
    const double turn =
        std::abs(wrap_angle(metric.bearing(here, map_.nodes.at(next).place) - before));
    if (turn >= least) continue;
    least = turn;
    best = exit;
  }
  return best;
}

std::int64_t TrafficGraph::junction_ahead(Step step, double reach, double& distance,
                                          Step* last) const {
  distance = 0;
  std::set<std::int64_t> seen;
  while (distance <= reach) {
    const std::size_t next = step.direction > 0 ? step.index + 1 : step.index - 1;
    const std::int64_t here = step.way->nodes[step.index], there = step.way->nodes[next];
    const GeoPoint a = map_.nodes.at(here).place, b = map_.nodes.at(there).place;
    distance += LocalMetric(a).distance(a, b);
    if (distance > reach || !seen.insert(there).second) return 0;
    if (last != nullptr) *last = step;
    if (is_junction(there)) return there;
    const std::optional<Step> on = straightest_exit(there, here);
    if (!on) return 0;
    step = *on;
  }
  return 0;
}

bool TrafficGraph::junction_within(std::int64_t node, double reach) const {
  for (const Step& arm : arms_.at(node)) {
    double distance = 0;
    for (std::size_t i = arm.index;;) {
      if (arm.direction < 0 ? i == 0 : i + 1 == arm.way->nodes.size()) break;
      const std::size_t next = arm.direction > 0 ? i + 1 : i - 1;
      const GeoPoint a = map_.nodes.at(arm.way->nodes[i]).place,
                     b = map_.nodes.at(arm.way->nodes[next]).place;
      distance += LocalMetric(a).distance(a, b);
      if (distance > reach) break;
      if (arm_count(arm.way->nodes[next]) >= 3) return true;
      i = next;
    }
  }
  return false;
}

bool faces(const Tags& tags, int direction) {
  for (const char* key :
       {"traffic_signals:direction", "give_way:direction", "stop:direction", "direction"}) {
    if (tag_is(tags, key, {"forward"})) return direction > 0;
    if (tag_is(tags, key, {"backward"})) return direction < 0;
  }
  return true;
}

}  // namespace sumogamma::osm
