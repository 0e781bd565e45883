#include "ego/planners.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>

#include "ego/driving_problem.h"
#include "ego/futures.h"
#include "ego/plan_trace.h"
#include "ego/search_planners.h"
#include "scene/extent.h"
#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

namespace {

/// Whoever is in the corridor that the ego sweeps on its way, nearest first; nobody: far away.
Followed leader_on_way(const EgoView& view) {
  constexpr double kBeside = 0.3;  // [m]
  const Scene& scene = view.world.scene;
  Followed leader{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  const Path* path = view.world.road.path(scene.path[view.row]);
  if (path == nullptr) return leader;
  const double along = scene.path_along[view.row];
  const OrientedBox own = box_of(scene, view.row);
  for (const std::size_t row : rows_seen(view)) {
    const PolylinePosition place = path->line.project(scene.position[row], along, along + kSeen);
    const Vec2 tangent = path->line.direction_at(place.along);
    const double across = half_extent(scene, row, left_of(tangent));
    const double gap = place.along - along - own.half.x() - half_extent(scene, row, tangent);
    if (place.distance > across + own.half.y() + kBeside || place.along <= along ||
        gap >= leader.gap)
      continue;
    leader.gap = gap;
    leader.speed = std::max(scene.velocity[row].dot(tangent), 0.0);
  }
  return leader;
}

/// The Intelligent Driver Model behind whoever is on the ego's way, and no faster than what the
/// rules of the road leave it where there are rules.
EgoAction follow_road(const EgoView& view) {
  const Scene& scene = view.world.scene;
  const RoadContext& context = scene.context[view.row];
  const AgentType& type = type_of(view.world.model.types, scene.type[view.row]);
  const double speed = scene.speed[view.row];
  const double free = std::min({type.max_speed, view.settings.max_speed,
                                context.active ? context.speed_limit : type.preferred_speed});
  const Followed leader = leader_on_way(view);
  EgoAction action;
  action.acceleration =
      following_acceleration(type, speed, std::max(free, 0.1), leader.gap, leader.speed);
  if (std::isfinite(context.allowed_speed))
    action.acceleration =
        std::min(action.acceleration, (context.allowed_speed - speed) * view.settings.rate);
  action.acceleration =
      std::clamp(action.acceleration, -type.max_deceleration, type.max_acceleration);
  return action;
}

/// Of the accelerations given the fastest with which it meets nobody in most of its futures,
/// braking afterwards; else the hardest braking.
class ByFutures {
 public:
  EgoAction operator()(const EgoView& view) {
    constexpr double kLeastGap = 0.5;   // [m]
    constexpr double kMostMeet = 0.11;  // share of the samples
    std::vector<double> choices = view.settings.accelerations;
    std::sort(choices.begin(), choices.end(), std::greater<>());
    EgoAction action;
    Futures futures;
    mind_->beliefs.observe(view, mind_->forward);
    for (const double acceleration : choices) {
      action.acceleration = acceleration;
      FuturesRequest request{{acceleration, acceleration, choices.back()},
                             9,
                             view.seed * 1000003u + static_cast<std::uint64_t>(view.plan)};
      futures = sample_futures(view, request, mind_->beliefs, mind_->forward);
      int meet = 0;
      for (std::size_t begin = 0; begin < futures.gap.size(); begin += futures.steps) {
        const auto gaps = std::span(futures.gap).subspan(begin, futures.steps);
        meet += *std::min_element(gaps.begin(), gaps.end()) < kLeastGap;
      }
      if (view.trace != nullptr) {
        const double share = static_cast<double>(meet) / request.samples;
        view.trace->choices.push_back({acceleration, share, share});
      }
      if (meet <= kMostMeet * request.samples) break;
    }
    if (view.trace != nullptr) note(view, futures);
    return action;
  }

 private:
  /// What was believed, and the futures of what was chosen.
  void note(const EgoView& view, const Futures& futures) const {
    view.trace->figures = PlanTrace::Figures::Meetings;
    trace_beliefs(view.world.model.types, plan_root(view, mind_->beliefs, false, 0),
                  futures.step * static_cast<double>(futures.steps), *view.trace);
    trace_futures(view.world.scene, futures, *view.trace);
  }

  struct Mind {
    ForwardModel forward;
    WayBeliefs beliefs;
  };
  std::shared_ptr<Mind> mind_ = std::make_shared<Mind>();
};

constexpr std::array kPlanners{
    PlannerEntry{"gamma", "drives the ego as one of the others: the reference run", nullptr},
    PlannerEntry{"idm", "IDM behind whoever is on its way, within the rules of the road",
                 [] { return Planner(follow_road); }},
    PlannerEntry{"futures", "the fastest acceleration whose sampled futures meet nobody",
                 [] { return Planner(ByFutures()); }},
    PlannerEntry{"pomdp-gamma", "belief tree search over what others may mean, by GAMMA",
                 [] { return make_search_planner(SearchPlanner::PomdpGamma); }},
    PlannerEntry{"rollout-gamma", "one acceleration, then a policy, in sampled worlds, by GAMMA",
                 [] { return make_search_planner(SearchPlanner::RolloutGamma); }},
    PlannerEntry{"pomdp-simple", "belief tree search, the others at constant speed",
                 [] { return make_search_planner(SearchPlanner::PomdpSimple); }},
    PlannerEntry{"policy", "by time to contact alone, without a search",
                 [] { return make_search_planner(SearchPlanner::Policy); }},
    PlannerEntry{"oracle", "pomdp-gamma that knows everybody's way",
                 [] { return make_search_planner(SearchPlanner::Oracle); }},
};

}  // namespace

std::span<const PlannerEntry> planners() { return kPlanners; }

Planner make_planner(std::string_view name) {
  const auto found = std::find_if(kPlanners.begin(), kPlanners.end(),
                                  [&](const PlannerEntry& entry) { return entry.name == name; });
  assert(found != kPlanners.end());
  return found->make == nullptr ? Planner() : found->make();
}

}  // namespace sumogamma
