#include "io/replay_stream.h"

#include <algorithm>

#include "base/units.h"
#include "geometry/heading.h"
#include "io/replay_map.h"

namespace sumogamma {

// The layout. count: unsigned, seven bits a byte, low first. signed: zigzag of a count. text:
// count, bytes. foe: count(id + 1), 0 for nobody.
//
//   "SGR3"  text(map JSON)  record*
//   record 1, a step:   count(milliseconds since the last step)
//                       count(gone)  count(index in the list of agents, less the previous one)*
//                       count(new)   newcomer*
//                       for every agent, in order of id: signed(second difference of x, of y in
//                       cm), signed(turn in 1/4096 of a circle), byte(why the road lets it go no
//                       faster, as LimitReason; +16: on a road; +32 * Control; +128: foe follows)
//                       [foe], byte(BindingKind; +128: foe follows) [foe; of an obstacle its
//                       number]
//     newcomer:         count(id) byte(type) text(name) byte(corners) signed(x, y of each corner
//                       in cm, body axes)* count(preferred speed in cm/s, responsibility in 1/100,
//                       attention ahead and behind in dm, factor on the headway in 1/100)
//                       byte(1: keeps every rule)
//   record 2, signals:  count(changed) [count(signal) text(state)]*
//   record 3, an event: byte(kind) count(milliseconds) signed(x, y in cm) count(a) foe(b)
//                       text(words); one of the same kind, time and agents takes its place
//   record 4, velocity spaces of the last step: count(agents) space*
//     space:            count(id) signed(x, y of the velocity, of v_pref, of Eq. 7's answer, of
//                       v_new) count(greatest speed that was looked at) count(by how much the
//                       soft planes can't be met) byte(BindingKind)
//                       count(index of the plane that binds + 1) count(hard planes)
//                       count(planes) [byte(ConstraintKind) foe signed(offset along the normal)
//                       count(normal's angle in 1/65536 of a circle)]*; speeds in mm/s. A plane
//                       admits v where v . normal >= offset
//   record 5, again:    all agents are gone, time is at zero and signals aren't known: readers may
//                       begin here
//   record 6, a plan of the ego, which holds until the next one:
//                       count(milliseconds) count(id) byte(0: along its way, 1: with steering, 2: a
//                       trajectory) signed(acceleration in mm/s^2) signed(steering in mrad)
//                       line(the trajectory) byte(PlanTrace::Figures)
//                       count(choices) [signed(acceleration) byte(1: its figures follow)
//                       [signed(lower, upper in 1/1000)]]*
//                       count(beliefs) [count(id) count(ways) [count(probability in 1/1000)
//                       line]*]*
//                       count(scenarios) [count(agents) [count(id) count(way + 1) line]*]*
//     line:             count(points) signed(x, y in cm less those of the point before)*
//   record 0: the end
//
// New agents stand at the end of the list: ids only grow. A new agent's differences start from
// zero.

namespace {

constexpr double kTurnSteps = 4096.0, kNormalSteps = 65536.0;
constexpr double kCentimetre = 0.01, kMillimetre = 0.001;
constexpr unsigned kOnRoad = 16, kControlUnit = 32, kFoeFollows = 128;

void append_count(std::uint64_t value, std::string& bytes) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<char>((value & 0x7f) | 0x80));
  bytes.push_back(static_cast<char>(value));
}

std::int64_t angle_steps(double angle, double steps) {
  return std::llround(angle / (2.0 * kPi) * steps) & (static_cast<std::int64_t>(steps) - 1);
}

std::uint64_t whole(double value, double unit) {
  return std::isfinite(value)
             ? static_cast<std::uint64_t>(std::llround(std::max(value, 0.0) / unit))
             : 0;
}

/// Does its type break none of the rules that people break?
bool keeps_rules(const ReplayStep& step, std::size_t row) {
  if (step.scene.manners[row].key == 0 || !step.types) return true;
  const Compliance& compliance = type_of(*step.types, step.scene.type[row]).compliance;
  return compliance.red_light_running == 0.0 && compliance.jaywalking_rate == 0.0 &&
         compliance.yielding_rate == 1.0 && compliance.rolling_stops == 0.0 &&
         compliance.creeping == 0.0;
}

}  // namespace

void ReplayEncoder::put_count(std::uint64_t value) { append_count(value, buffer_); }

void ReplayEncoder::put_signed(std::int64_t value) {
  put_count((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}

void ReplayEncoder::put_text(std::string_view text) {
  put_count(text.size());
  buffer_ += text;
}

void ReplayEncoder::put_point(const Vec2& point, double unit) {
  put_signed(std::llround(point.x() / unit));
  put_signed(std::llround(point.y() / unit));
}

void ReplayEncoder::put_line(const std::vector<Vec2>& line) {
  put_count(line.size());
  std::int64_t x = 0, y = 0;
  for (const Vec2& point : line) {
    const std::int64_t next_x = std::llround(point.x() / kCentimetre),
                       next_y = std::llround(point.y() / kCentimetre);
    put_signed(next_x - std::exchange(x, next_x));
    put_signed(next_y - std::exchange(y, next_y));
  }
}

bool ReplayEncoder::add_step(const ReplayStep& step) {
  const double time = step.scene.time;
  // a little early: sums of steps don't meet the period exactly
  if (started_ && time < next_time_ - 1e-6) return false;
  next_time_ = started_ ? std::max(next_time_ + period_, time) : time + period_;
  if (step.road) append_signals(*step.road);
  const std::int64_t ms = std::llround(time * 1000.0);
  put_byte(1);
  put_count(static_cast<std::uint64_t>(std::max<std::int64_t>(ms - last_ms_, 0)));
  last_ms_ = ms;
  last_time_ = time;
  started_ = true;
  append_changes(step);
  append_poses(step);
  return true;
}

void ReplayEncoder::begin_again() {
  put_byte(5);
  agents_.clear();
  signals_.clear();
  last_ms_ = 0;
}

void ReplayEncoder::append_changes(const ReplayStep& step) {
  const Scene& scene = step.scene;
  next_.clear();
  std::vector<std::uint64_t> gone;
  std::size_t row = 0;
  for (std::size_t i = 0; i < agents_.size(); ++i) {
    if (row < scene.size() && scene.id[row] == agents_[i].id) {
      next_.push_back(agents_[i]);
      ++row;
    } else {
      gone.push_back(i);
    }
  }
  put_count(gone.size());
  std::uint64_t previous = 0;
  for (const std::uint64_t index : gone) {
    put_count(index - previous);
    previous = index;
  }
  put_count(scene.size() - row);
  for (; row < scene.size(); ++row) append_newcomer(step, row);
  agents_.swap(next_);
}

void ReplayEncoder::append_newcomer(const ReplayStep& step, std::size_t row) {
  const Scene& scene = step.scene;
  next_.push_back({scene.id[row]});
  put_count(scene.id[row].value);
  put_byte(
      static_cast<unsigned>(step.types ? kind_of(*step.types, scene.type[row]) : scene.type[row]));
  put_text(step.name_of(scene.id[row]));
  put_byte(scene.footprint[row].count);
  for (const Vec2& corner : scene.footprint[row].outline()) put_point(corner, kCentimetre);
  const BehaviorState& behavior = scene.behavior[row];
  put_count(whole(scene.preferred_speed[row], 0.01));
  put_count(whole(behavior.responsibility, 0.01));
  put_count(whole(behavior.attention.front, 0.1));
  put_count(whole(behavior.attention.rear, 0.1));
  put_count(whole(scene.manners[row].headway_factor, 0.01));
  put_byte(keeps_rules(step, row) ? 1 : 0);
}

void ReplayEncoder::append_poses(const ReplayStep& step) {
  const Scene& scene = step.scene;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    Agent& agent = agents_[row];
    const std::int64_t x = std::llround(scene.position[row].x() / kCentimetre),
                       y = std::llround(scene.position[row].y() / kCentimetre);
    const std::int64_t step_x = x - agent.x, step_y = y - agent.y;
    put_signed(step_x - agent.step_x);
    put_signed(step_y - agent.step_y);
    const std::int64_t heading = angle_steps(scene.heading[row], kTurnSteps);
    std::int64_t turn = heading - agent.heading;
    const auto circle = static_cast<std::int64_t>(kTurnSteps);
    if (turn > circle / 2) turn -= circle;
    if (turn < -circle / 2) turn += circle;
    put_signed(turn);
    append_limits(step, row, agent);
    agent.x = x;
    agent.y = y;
    agent.heading = heading;
    agent.step_x = step_x;
    agent.step_y = step_y;
  }
}

void ReplayEncoder::append_limits(const ReplayStep& step, std::size_t row, Agent& agent) {
  const RoadContext& context = step.scene.context[row];
  const auto put = [&](unsigned byte, std::int64_t foe, std::int64_t& last) {
    put_byte(byte | (foe != last ? kFoeFollows : 0u));
    if (foe != last) put_count(static_cast<std::uint64_t>(foe + 1));
    last = foe;
  };
  put(static_cast<unsigned>(context.reason) | (context.active ? kOnRoad : 0u) |
          static_cast<unsigned>(step.scene.control[row]) * kControlUnit,
      context.foe, agent.foe);
  const Binding binding = row < step.bindings.size() ? step.bindings[row] : Binding{};
  put(static_cast<unsigned>(binding.kind), binding.foe, agent.binding_foe);
}

void ReplayEncoder::append_signals(const RoadState& road) {
  if (road.signal_states == signals_) return;
  signals_.resize(road.signal_states.size());
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < signals_.size(); ++i)
    if (signals_[i] != road.signal_states[i]) changed.push_back(i);
  put_byte(2);
  put_count(changed.size());
  for (const std::size_t i : changed) {
    put_count(i);
    put_text(road.signal_states[i]);
    signals_[i] = road.signal_states[i];
  }
}

void ReplayEncoder::add_event(const ReplayEvent& event) {
  put_byte(3);
  put_byte(static_cast<unsigned>(event.kind));
  put_count(whole(event.time, 0.001));
  put_point(event.position, kCentimetre);
  put_count(event.a.value);
  put_count(event.b.value == kReplayNobody ? 0 : std::uint64_t{event.b.value} + 1);
  put_text(event.words);
}

void ReplayEncoder::add_spaces(std::span<const InspectedAgent> agents) {
  if (agents.empty()) return;
  put_byte(4);
  put_count(agents.size());
  for (const InspectedAgent& agent : agents) append_space(agent);
}

void ReplayEncoder::append_space(const InspectedAgent& agent) {
  const ConstraintSet& all = agent.work.constraints;
  put_count(agent.id.value);
  for (const Vec2& point :
       {agent.velocity, agent.work.preferred, agent.work.result.point, agent.chosen})
    put_point(point, kMillimetre);
  put_count(whole(agent.work.fastest, kMillimetre));
  put_count(whole(agent.work.result.violation, kMillimetre));
  put_byte(static_cast<unsigned>(agent.binding.kind));
  put_count(static_cast<std::uint64_t>(agent.work.result.binding) + 1);
  put_count(all.hard_count);
  put_count(all.planes.size());
  for (std::size_t i = 0; i < all.planes.size(); ++i) {
    const HalfPlane& plane = all.planes[i];
    put_byte(static_cast<unsigned>(all.sources[i].kind));
    put_count(static_cast<std::uint64_t>(all.sources[i].foe + 1));
    put_signed(std::llround(plane.point.dot(plane.normal) / kMillimetre));
    put_count(static_cast<std::uint64_t>(angle_steps(heading_of(plane.normal), kNormalSteps)));
  }
}

void ReplayEncoder::add_plan(const PlanTrace& plan) {
  const EgoAction& action = plan.action;
  put_byte(6);
  put_count(whole(plan.time, 0.001));
  put_count(plan.ego.value);
  put_byte(!action.trajectory.empty() ? 2 : action.steering ? 1 : 0);
  put_signed(std::llround(action.acceleration / kMillimetre));
  put_signed(std::llround(action.steering.value_or(0.0) / 0.001));
  std::vector<Vec2> trajectory;
  for (const TrajectoryPoint& point : action.trajectory) trajectory.push_back(point.position);
  put_line(trajectory);
  append_choices(plan);
  put_count(plan.beliefs.size());
  for (const PlanTrace::Belief& belief : plan.beliefs) {
    put_count(belief.id.value);
    put_count(belief.ways.size());
    for (const PlanTrace::Way& way : belief.ways) {
      put_count(whole(way.probability, 0.001));
      put_line(way.line);
    }
  }
  put_count(plan.scenarios.size());
  for (const PlanTrace::Scenario& scenario : plan.scenarios) {
    put_count(scenario.size());
    for (const PlanTrace::Part& part : scenario) {
      put_count(part.id.value);
      put_count(static_cast<std::uint64_t>(part.way) + 1);
      put_line(part.line);
    }
  }
}

void ReplayEncoder::append_choices(const PlanTrace& plan) {
  put_byte(static_cast<unsigned>(plan.figures));
  put_count(plan.choices.size());
  for (const PlanTrace::Choice& choice : plan.choices) {
    put_signed(std::llround(choice.acceleration / kMillimetre));
    const bool known = std::isfinite(choice.lower);
    put_byte(known ? 1 : 0);
    if (!known) continue;
    put_signed(std::llround(choice.lower / 0.001));
    put_signed(std::llround(choice.upper / 0.001));
  }
}

std::string replay_header(const std::string& title, const RoadNetwork& network,
                          const AgentTypeTable& types) {
  const std::string map = replay_map_json(title, network, types);
  std::string header = "SGR3";
  append_count(map.size(), header);
  return header + map;
}

}  // namespace sumogamma
