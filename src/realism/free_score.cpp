#include "realism/free_score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "scene/scene.h"

namespace sumogamma {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kLongestEncroachment = 10.0;      // [s]
constexpr std::size_t kLeastTravellers = 3;        // of a way
constexpr int kLookEvery = 5;                      // steps, for places in the lane
constexpr double kDrives = 1.0;                    // [m/s]
constexpr double kNarrowest = 2.8, kWidest = 4.2;  // of lanes [m]

/// Everybody who is there at a step, with the row of its agent as id.
Scene scene_at(const RecordedScene& recorded, int step) {
  Scene scene;
  scene.time = kScoreStep * (step - recorded.first);
  for (std::size_t row = 0; row < recorded.agents.size(); ++row) {
    const RecordedAgent& agent = recorded.agents[row];
    if (agent.present(step))
      append_body(scene, row, agent.at(step), Vec2(agent.length, agent.width));
  }
  return scene;
}

/// What somebody's way is called.
std::string way_of(const RecordedScene& scene, const RecordedRoad* road, std::size_t agent) {
  if (!road) return type_of(scene.types, scene.agents[agent].type).name;
  const RoadNetwork& network = road->road.network;
  const MatchedRoute& route = road->routes[agent];
  return network.edge(route.edges.front()).name + " " + network.edge(route.to).name;
}

struct Mean {
  double sum = 0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double value() const { return count > 0 ? sum / static_cast<double>(count) : kNone; }
};

/// Counts a recording, or a free run, and notes of each agent and window whether it collides.
void count(const RecordedScene& recorded, MotionCounts& counts, Mean& colliding) {
  const int steps = free_steps(recorded);
  for (const ScoreWindow& window : find_windows(recorded).windows) {
    if (window.start + kWindowSteps > recorded.first + steps) continue;
    const MotionFeatures features = features_of(window.log, window.bodies);
    counts.add_motion(features);
    for (std::size_t row = 0; row < window.agents.size(); ++row)
      colliding.add(collides(features, row));
  }
  counts.add_encroachments(
      static_cast<std::size_t>(steps) + 1,
      [&](std::size_t step) { return scene_at(recorded, recorded.first + static_cast<int>(step)); },
      kLongestEncroachment);
}

std::size_t left_by_end(const RecordedScene& scene) {
  const int end = scene.first + free_steps(scene);
  return static_cast<std::size_t>(std::count_if(
      scene.agents.begin(), scene.agents.end(),
      [&](const RecordedAgent& agent) { return agent.last() < std::min(scene.last, end); }));
}

}  // namespace

MotionCounts count_motion(const RecordedScene& scene) {
  MotionCounts counts;
  Mean colliding;
  count(scene, counts, colliding);
  return counts;
}

double travel_time_error(const RecordedScene& scene, const RecordedRoad* road,
                         const std::vector<FreeRun>& runs, std::size_t& ways) {
  std::map<std::string, Mean> recorded, driven;
  const int end = scene.first + free_steps(scene);
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    const RecordedAgent& agent = scene.agents[row];
    if (agent.last() < std::min(scene.last, end))
      recorded[way_of(scene, road, row)].add(kScoreStep * (agent.last() - agent.first));
  }
  for (const FreeRun& run : runs)
    for (std::size_t k = 0; k < run.who.size(); ++k)
      if (run.arrived[k])
        driven[way_of(scene, road, run.who[k])].add(
            kScoreStep * (run.driven.agents[k].last() - scene.agents[run.who[k]].first));
  Mean squares;
  for (const auto& [way, time] : recorded) {
    if (time.count < kLeastTravellers || !driven.contains(way)) continue;
    const double error = driven[way].value() / time.value() - 1.0;
    squares.add(error * error);
  }
  ways = squares.count;
  return std::sqrt(squares.value());
}

double lateral_deviation(const RecordedRoad& road, const RecordedScene& driven,
                         const std::vector<std::size_t>& who) {
  const RoadNetwork& network = road.road.network;
  Mean offsets, squares;
  for (std::size_t k = 0; k < who.size(); ++k) {
    const RecordedAgent& agent = driven.agents[k];
    const VehicleClassMask classes =
        vehicle_class_from_name(type_of(driven.types, agent.type).sumo_class);
    for (int step = agent.first; step <= agent.last(); step += kLookEvery) {
      const MotionState state = agent.at(step);
      if (state.velocity.norm() < kDrives) continue;
      const Lane& lane =
          network.lane(place_on_route(network, road.routes[who[k]], state, classes).on);
      if (lane.width < kNarrowest || lane.width > kWidest || lane.kind != LaneKind::Normal)
        continue;
      const PolylinePosition place = lane.centerline.project(state.position);
      if (place.distance > 0.5 * lane.width) continue;
      offsets.add(place.offset);
      squares.add(place.offset * place.offset);
    }
  }
  const double mean = offsets.value();
  return std::sqrt(std::max(0.0, squares.value() - mean * mean));
}

double share_under_two_seconds(const MotionCounts& counts) {
  const std::vector<double>& pet =
      counts.counts[static_cast<std::size_t>(CountedMeasure::PostEncroachment)];
  const double all = counts.total(CountedMeasure::PostEncroachment);
  return all > 0 ? (pet[0] + pet[1]) / all : kNone;
}

FreeScore score_free_runs(const RecordedScene& scene, const RecordedRoad* road,
                          const std::string& method, const std::vector<FreeRun>& runs) {
  FreeScore score;
  score.name = method;
  score.runs = runs.size();
  Mean left, aside, colliding;
  for (const FreeRun& run : runs) {
    count(run.driven, score.counts, colliding);
    left.add(static_cast<double>(std::count(run.arrived.begin(), run.arrived.end(), true)));
    if (road) aside.add(lateral_deviation(*road, run.driven, run.who));
  }
  score.left = left.value();
  score.left_in_log = static_cast<double>(left_by_end(scene));
  score.lateral_deviation = aside.value();
  score.colliding = colliding.value();
  score.travel_rmspe = travel_time_error(scene, road, runs, score.ways);
  return score;
}

}  // namespace sumogamma
