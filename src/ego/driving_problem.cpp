#include "ego/driving_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/hash.h"
#include "base/random.h"
#include "scene/behavior_draw.h"
#include "scene/extent.h"

namespace sumogamma {

namespace {

constexpr double kStep = ForwardModel::kStep;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStands = 1e-3;  // slower is standing [m/s]
/// Standard deviation, as a share, of the pace at which somebody goes on, whatever it is seen to
/// drive or walk at.
constexpr double kPaceSpread = 0.04;

std::uint64_t take(std::uint64_t hash, double value, double cell) {
  const auto number = static_cast<std::int64_t>(std::floor(value / cell));
  for (int byte = 0; byte < 4; ++byte)
    hash = fnv1a(hash, static_cast<unsigned char>(number >> (8 * byte)));
  return hash;
}

}  // namespace

PlanRoot plan_root(const EgoView& view, const WayBeliefs& beliefs, bool knows,
                   std::size_t observed) {
  PlanRoot root;
  root.fork = seen_fork(view, root.ego);
  Scene& scene = root.fork.scene;
  root.choices.resize(scene.size());
  const Scene& world = view.world.scene;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (row == root.ego) continue;
    const auto add = [&](const WayOn& way, double weight) {
      const auto place = static_cast<PathId>(root.fork.road.paths.size());
      root.choices[row].push_back({way.path ? place : kNoPath, way.intention, weight});
      if (way.path) root.fork.road.paths.push_back(way.path);
    };
    if (knows) {
      const PathId own = world.path[find_row(world, scene.id[row])];
      if (view.world.road.path(own) != nullptr)
        add({view.world.road.paths[static_cast<std::size_t>(own)]}, 1.0);
      continue;
    }
    const WayBelief* belief = beliefs.of(scene.id[row]);
    if (belief == nullptr) continue;
    for (std::size_t i = 0; i < belief->ways.size(); ++i) add(belief->ways[i], belief->weights[i]);
  }
  for (const std::size_t row : rows_about(view.world.model, world, view.row, kSeen, observed)) {
    const std::size_t own = find_row(scene, world.id[row]);
    if (own < scene.size()) root.observed.push_back(own);
  }
  return root;
}

std::size_t draw_choice(const PlanRoot& root, std::size_t row, std::uint64_t key,
                        std::uint32_t index, std::uint32_t count) {
  const std::uint32_t id = root.fork.scene.id[row].value;
  const std::vector<PlanRoot::Choice>& choices = root.choices[row];
  // a tooth of the agent's own comb: which one is a matter of rank among random numbers
  std::uint32_t tooth = 0;
  const std::uint64_t rank = random_bits(key, id, index, Draw::Intention);
  for (std::uint32_t other = 0; other < count; ++other)
    tooth += random_bits(key, id, other, Draw::Intention) < rank ? 1u : 0u;
  const double place = (tooth + random_uniform(key, id, count, Draw::Intention)) / count;
  std::size_t chosen = 0;
  for (double up_to = choices[0].weight; place >= up_to && chosen + 1 < choices.size();)
    up_to += choices[++chosen].weight;
  return chosen;
}

void draw_scenario(const Model& model, const PlanRoot& root, std::uint64_t key, std::uint32_t index,
                   std::uint32_t count, DrivingState& state) {
  state.scene = root.fork.scene;
  state.road = root.fork.road;
  state.traffic = root.fork.traffic.state;
  Scene& scene = state.scene;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (row == root.ego) continue;
    const std::uint32_t id = scene.id[row].value;
    const AgentType& type = type_of(model.types, scene.type[row]);
    const std::uint64_t own = random_bits(key, id, index, Draw::Scenario);
    const IntentionKind intention = scene.behavior[row].intention.kind;
    scene.behavior[row] = draw_behavior(type, own, id);
    scene.behavior[row].intention.kind = intention;
    scene.manners[row] = draw_manners(type.compliance, own, id);
    const double pace = 1.0 + kPaceSpread * random_normal(own, id, 0, Draw::DesiredSpeed);
    scene.preferred_speed[row] *= std::max(pace, 0.0);
    const std::vector<PlanRoot::Choice>& choices = root.choices[row];
    if (choices.empty()) continue;
    const PlanRoot::Choice& chosen = choices[draw_choice(root, row, key, index, count)];
    if (chosen.path == kNoPath) {
      Intention& way = scene.behavior[row].intention = chosen.intention;
      if (way.kind == IntentionKind::Velocity) way.goal *= std::max(pace, 0.0);
      continue;
    }
    scene.path[row] = chosen.path;
    scene.path_along[row] = state.road.path(chosen.path)->line.project(scene.position[row]).along;
    scene.behavior[row].intention.kind = IntentionKind::Path;
  }
}

DrivingProblem::DrivingProblem(const EgoView& view, const PlanRoot& root, OthersModel others,
                               const DrivingParameters& parameters, ForwardModel& forward)
    : view_(view),
      root_(root),
      others_(others),
      parameters_(parameters),
      forward_(forward),
      accelerations_(view.settings.accelerations) {
  fork_.traffic.parameters = root.fork.traffic.parameters;
  fork_.traffic.code = root.fork.traffic.code;
  parameters_.control.top_speed = view.settings.max_speed;
  const auto begin = accelerations_.begin();
  fastest_ = static_cast<int>(std::max_element(begin, accelerations_.end()) - begin);
  hardest_ = static_cast<int>(std::min_element(begin, accelerations_.end()) - begin);
  keep_ = static_cast<int>(
      std::min_element(begin, accelerations_.end(),
                       [](double a, double b) { return std::abs(a) < std::abs(b); }) -
      begin);
}

bool DrivingProblem::crashes(const Scene& scene) const {
  if (scene.speed[root_.ego] < kStands) return false;
  const OrientedBox ego = box_of(scene, root_.ego);
  for (std::size_t row = 0; row < scene.size(); ++row)
    if (row != root_.ego && (scene.position[row] - ego.center).norm() < 20.0 &&
        is_in_the_way(ego, box_of(scene, row), parameters_.control))
      return true;
  return false;
}

/// The ego rolls along its path; nobody is asked.
void DrivingProblem::move_ego_alone(double acceleration, State& state) const {
  Scene& scene = state.scene;
  const std::size_t row = root_.ego;
  const double speed =
      std::clamp(scene.speed[row] + acceleration * kStep, 0.0, parameters_.control.top_speed);
  const Path* path = state.road.path(scene.path[row]);
  if (path == nullptr) {
    scene.position[row] += kStep * speed * direction_of(scene.heading[row]);
  } else {
    scene.path_along[row] += kStep * speed;
    scene.position[row] = path->line.point_at(scene.path_along[row]);
    scene.heading[row] = heading_of(path->line.direction_at(scene.path_along[row]));
  }
  scene.speed[row] = speed;
  scene.velocity[row] = speed * direction_of(scene.heading[row]);
}

StepOutcome DrivingProblem::step(State& state, int action, double draw) {
  const double wanted = draw < parameters_.noise ? 0.0 : acceleration_of(action);
  if (others_ == OthersModel::ConstantSpeed) {
    advance_at_constant_speed(state.road, root_.ego, kStep, state.scene);
    move_ego_alone(wanted, state);
  } else {
    std::swap(fork_.scene, state.scene);
    std::swap(fork_.road, state.road);
    std::swap(fork_.traffic.state, state.traffic);
    fork_.traffic.waits.rebuild(fork_.scene);
    EgoAction asked;
    asked.acceleration = wanted;
    forward_.advance(fork_, view_.rules, [&](const TrafficView& world, std::size_t row) {
      return velocity_of(asked, world.model, world.scene, row,
                         {parameters_.control.top_speed, 0.0, kStep});
    });
    std::swap(fork_.scene, state.scene);
    std::swap(fork_.road, state.road);
    std::swap(fork_.traffic.state, state.traffic);
  }
  const Scene& scene = state.scene;
  const double speed = scene.speed[root_.ego], top = parameters_.control.top_speed;
  if (crashes(scene)) return {-parameters_.crash * (speed * speed + 0.5), 0, true};
  if (has_reached(view_.goal, scene, root_.ego)) return {0, 0, true};
  StepOutcome outcome{parameters_.speed * (std::min(speed, top) - top) / top, 0, false};
  if (acceleration_of(action) < 0) outcome.reward -= parameters_.braking;
  outcome.observation = observation(scene);
  return outcome;
}

std::uint64_t DrivingProblem::observation(const Scene& scene) const {
  std::uint64_t hash = take(kFnvBasis, scene.path_along[root_.ego], parameters_.position_cell);
  hash = take(hash, scene.speed[root_.ego], parameters_.speed_cell);
  for (const std::size_t row : root_.observed) {
    hash = take(hash, scene.position[row].x(), parameters_.position_cell);
    hash = take(hash, scene.position[row].y(), parameters_.position_cell);
  }
  return hash;
}

/// From the front to the next line that shows red or amber, or infinite [m]. Lines under the body
/// are behind it.
double DrivingProblem::way_to_red(const State& state) const {
  if (!view_.rules) return kInfinity;
  const Scene& scene = state.scene;
  const Path* path = state.road.path(scene.path[root_.ego]);
  if (path == nullptr) return kInfinity;
  const double front = scene.path_along[root_.ego] +
                       half_extent(scene, root_.ego, direction_of(scene.heading[root_.ego]));
  for (auto link = path->link_after(front); link != path->links.end(); ++link) {
    const Light light = state.road.signal(view_.world.model.road.connection(link->connection));
    if (is_red(light) || is_amber(light)) return std::max(link->halt, link->stop_line) - front;
  }
  return kInfinity;
}

std::span<const int> DrivingProblem::actions(const ScenarioGroup<State>& group) {
  // of a step the half of the change in speed is driven, too
  const auto way_after = [&](double speed, double acceleration) {
    const double after =
        std::clamp(speed + acceleration * kStep, 0.0, parameters_.control.top_speed);
    return std::max(after, 0.5 * (speed + after)) * kStep +
           after * after / (2 * parameters_.red_deceleration) + 0.5 * after * kStep;
  };
  legal_.clear();
  for (int action = 0; action < static_cast<int>(accelerations_.size()); ++action) {
    bool legal = true;
    for (std::size_t i = 0; i < group.size() && legal && action != hardest_; ++i) {
      const double speed = group.state(i).scene.speed[root_.ego];
      const double red = way_to_red(group.state(i));
      legal = red == kInfinity || way_after(speed, acceleration_of(action)) <= red;
    }
    if (legal) legal_.push_back(action);
  }
  return legal_;
}

/// [s], everybody at its present velocity, the ego along its path no slower than 1 m/s; infinite
/// where none comes within kLookAhead.
double DrivingProblem::time_to_contact(const State& state) const {
  constexpr double kLookAhead = 10 * kStep, kLeastSpeed = 1.0, kReach = 30.0;
  const Scene& scene = state.scene;
  const std::size_t ego = root_.ego;
  const Path* path = state.road.path(scene.path[ego]);
  const double speed = std::max(scene.speed[ego], kLeastSpeed);
  OrientedBox box = box_of(scene, ego);
  const Vec2 aside = path == nullptr
                         ? Vec2(Vec2::Zero())
                         : Vec2(box.center - path->line.point_at(scene.path_along[ego]));
  for (double time = kStep; time <= kLookAhead + 1e-9; time += kStep) {
    if (path == nullptr) {
      box.center += kStep * speed * box.forward;
    } else {
      const double along = scene.path_along[ego] + speed * time;
      box.center = path->line.point_at(along) + aside;
      box.forward = path->line.direction_at(along);
    }
    for (std::size_t row = 0; row < scene.size(); ++row) {
      if (row == ego) continue;
      const Vec2 place = scene.position[row] + time * scene.velocity[row];
      if ((place - box.center).squaredNorm() > kReach * kReach) continue;
      OrientedBox other = box_of(scene, row);
      other.center += time * scene.velocity[row];
      if (is_in_the_way(box, other, parameters_.control)) return time;
    }
  }
  return kInfinity;
}

int DrivingProblem::default_action(const ScenarioGroup<State>& group) {
  constexpr double kReact = 2 * kStep;
  int wanted = fastest_;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const State& state = group.state(i);
    const double stop = state.scene.speed[root_.ego] / std::max(-acceleration_of(hardest_), 0.1);
    const double contact = time_to_contact(state);
    const int asked = contact <= stop + kReact       ? hardest_
                      : contact <= stop + 2 * kReact ? keep_
                                                     : fastest_;
    if (acceleration_of(asked) < acceleration_of(wanted)) wanted = asked;
  }
  // no faster than is legal
  int legal = hardest_;
  for (const int action : actions(group))
    if (acceleration_of(action) <= acceleration_of(wanted) &&
        acceleration_of(action) > acceleration_of(legal))
      legal = action;
  return legal;
}

double DrivingProblem::value_at_end(const State& state) const {
  const double speed = state.scene.speed[root_.ego];
  const double stop = std::round(speed / (std::max(-acceleration_of(hardest_), 0.1) * kStep));
  if (speed >= kStands && stop * kStep > time_to_contact(state))
    return -parameters_.crash * (speed * speed + 0.5);
  return -parameters_.speed / (1 - parameters_.discount);
}

double DrivingProblem::upper_bound(const State& state, int) const {
  const double top = parameters_.control.top_speed;
  double speed = std::min(state.scene.speed[root_.ego], top), sum = 0;
  if (acceleration_of(fastest_) <= 0) return 0;
  for (double discount = 1; speed < top; discount *= parameters_.discount) {
    speed = std::min(speed + acceleration_of(fastest_) * kStep, top);
    sum += discount * parameters_.speed * (speed - top) / top;
  }
  return sum;
}

}  // namespace sumogamma
