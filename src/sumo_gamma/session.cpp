#include "sumo_gamma/session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include "app/open_run.h"
#include "app/program.h"
#include "base/hash.h"

namespace sumogamma {

namespace {

/// What comes next in the loop.
RunRequest request_of(const std::vector<std::string>& words, int socket) {
  try {
    RunRequest request = parse_run(words);
    request.common.quiet = true;
    request.run.socket = socket;
    request.run.own_loop = true;
    return request;
  } catch (const UsageError& error) {
    throw Error("session", error.what());
  }
}

std::string_view name_of(LimitReason reason) {
  constexpr std::array<std::string_view, 11> kNames{
      "none", "signal", "yield",     "crossing",     "blocked_junction", "leader",
      "stop", "merge",  "gives_way", "turning_room", "lets_in"};
  return kNames.at(static_cast<std::size_t>(reason));
}

std::string_view name_of(ConstraintKind kind) {
  constexpr std::array<std::string_view, 6> kNames{"kinematic",     "neighbour", "obstacle",
                                                   "lane_boundary", "direction", "road_limit"};
  return kNames.at(static_cast<std::size_t>(kind));
}

/// The member of each element that `first` is of element 0.
template <typename Value, typename Element>
Column<Value> column(Value* first, const std::vector<Element>& elements) {
  return {first, sizeof(Element), elements.size()};
}

}  // namespace

struct Session::State {
  enum class Phase { Observe, Step, Advance, Closed };

  State(const RunRequest& request) : run(request.run, request.common) {
    control_by_wish = run.plan.options.joins() || run.plan.control_text == "called";
  }

  Scene& scene() { return run.sim->scene; }
  void require(Phase wanted, const char* call, const char* instead) {
    if (phase == Phase::Closed) throw Error(call, "the session is closed");
    if (phase != wanted) throw Error(call, instead);
  }
  std::size_t checked(std::size_t row, const char* call) {
    if (row < scene().size()) return row;
    throw Error(call, "there is no row " + std::to_string(row) + ", the scene has " +
                          std::to_string(scene().size()));
  }
  /// SUMO's failure ends the session, its files completed.
  template <typename Talk>
  void talk_to_sumo(Talk&& talk) {
    try {
      talk();
    } catch (const SumoError& error) {
      phase = Phase::Closed;
      run.finish("SUMO failed", error.what());
      throw;
    }
  }
  void wish(const std::string& id, const char* what) {
    if (phase == Phase::Closed) throw Error(what, "the session is closed");
    if (!control_by_wish)
      throw Error(what, "needs a session with --control called, or on a shared connection");
    run.backend->set_parameter(id, "sumo-gamma.control", what);
  }

  /// Columns that somebody still holds keep their memory: the scene goes on in a copy.
  void leave_held_columns() {
    if (held.use_count() > 1) {
      Scene copy = scene();
      std::swap(copy, scene());
      *held = std::move(copy);
      held = std::make_shared<Scene>();
    }
  }

  OpenRun run;
  std::shared_ptr<Scene> held = std::make_shared<Scene>();
  Phase phase = Phase::Observe;
  bool control_by_wish = false;
  bool sent = false;  ///< poses, whose step another client makes
  std::uint64_t hash = kFnvBasis;
  std::vector<std::pair<std::size_t, Intention>> preferred;  ///< rows, and what they meant before
  mutable Workspace work;
};

Session::Session(const std::vector<std::string>& words) : Session(words, -1) {}
Session::Session(const std::vector<std::string>& words, int socket)
    : state_(std::make_unique<State>(request_of(words, socket))) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() {
  try {
    if (state_) close();
  } catch (const std::exception&) {
    // a destructor has nobody to tell: close() does
  }
}

void Session::observe() {
  state_->require(State::Phase::Observe, "observe()", "step() and advance() come first");
  OpenRun& run = state_->run;
  state_->leave_held_columns();
  state_->talk_to_sumo([&] {
    if (std::exchange(state_->sent, false)) {
      run.world->receive();
      if (run.observers) run.observers->add();
    }
    sumogamma::observe(*run.sim, *run.world);
  });
  state_->phase = State::Phase::Step;
}

void Session::step() {
  state_->require(State::Phase::Step, "step()", "observe() comes first");
  OpenRun& run = state_->run;
  if (run.observers) run.observers->look();
  move_everybody(*run.sim);
  for (const auto& [row, before] : state_->preferred)
    run.sim->scene.behavior[row].intention = before;
  state_->preferred.clear();
  state_->hash = hash_state(run.sim->scene, state_->hash);
  state_->phase = State::Phase::Advance;
}

void Session::advance() {
  state_->require(State::Phase::Advance, "advance()", "observe() and step() come first");
  OpenRun& run = state_->run;
  state_->talk_to_sumo([&] {
    run.world->send(run.sim->scene);
    state_->sent = run.plan.options.socket >= 0;
    if (state_->sent) return;
    run.world->receive();
    if (run.observers) run.observers->add();
  });
  state_->phase = State::Phase::Observe;
}

bool Session::finished() const {
  const OpenRun& run = state_->run;
  if (state_->phase == State::Phase::Closed || interrupted()) return true;
  if (run.plan.options.socket >= 0) return false;
  const double whole = (run.plan.clock.end - run.plan.clock.begin) / run.plan.clock.step;
  return run.sim->scene.tick >= std::llround(whole) || run.world->finished();
}

void Session::close() {
  if (state_->phase == State::Phase::Closed) return;
  state_->phase = State::Phase::Closed;
  const bool done = finished() && !interrupted();
  state_->run.finish(done ? "done" : "interrupted", "");
}

double Session::time() const { return state_->scene().time; }
double Session::step_length() const { return state_->run.plan.clock.step; }
std::string Session::state_hash() const { return hash_text(state_->hash); }

std::size_t Session::size() const { return state_->scene().size(); }
std::string_view Session::id(std::size_t row) const {
  const Scene& scene = state_->scene();
  return state_->run.world->names()[scene.id[state_->checked(row, "id()")].value];
}
std::string_view Session::type(std::size_t row) const {
  const Scene& scene = state_->scene();
  return type_of(state_->run.sim->model.types, scene.type[state_->checked(row, "type()")]).name;
}
bool Session::driven(std::size_t row) const {
  return state_->scene().control[state_->checked(row, "driven()")] == Control::Gamma;
}
std::size_t Session::find(std::string_view sumo_id) const {
  const Scene& scene = state_->scene();
  const std::vector<std::string>& names = state_->run.world->names();
  for (std::size_t row = 0; row < scene.size(); ++row)
    if (names[scene.id[row].value] == sumo_id) return row;
  return scene.size();
}

Column<const double> Session::x() const {
  const auto& all = state_->scene().position;
  return column<const double>(all.empty() ? nullptr : &all.front().x(), all);
}
Column<const double> Session::y() const {
  const auto& all = state_->scene().position;
  return column<const double>(all.empty() ? nullptr : &all.front().y(), all);
}
Column<const double> Session::heading() const {
  static_assert(std::is_standard_layout_v<Heading>);
  const auto& all = state_->scene().heading;
  // the angle is its first member
  return column<const double>(reinterpret_cast<const double*>(all.data()), all);
}
Column<const double> Session::velocity_x() const {
  const auto& all = state_->scene().velocity;
  return column<const double>(all.empty() ? nullptr : &all.front().x(), all);
}
Column<const double> Session::velocity_y() const {
  const auto& all = state_->scene().velocity;
  return column<const double>(all.empty() ? nullptr : &all.front().y(), all);
}
Column<const double> Session::speed() const {
  const auto& all = state_->scene().speed;
  return column<const double>(all.data(), all);
}
Column<const double> Session::radius() const {
  const auto& all = state_->scene().footprint;
  return column<const double>(all.empty() ? nullptr : &all.front().radius, all);
}
Column<double> Session::allowed_speed() {
  auto& all = state_->scene().context;
  return column<double>(all.empty() ? nullptr : &all.front().allowed_speed, all);
}
std::shared_ptr<const void> Session::hold() const { return state_->held; }
std::string_view Session::reason(std::size_t row) const {
  return name_of(state_->scene().context[state_->checked(row, "reason()")].reason);
}

void Session::prefer(std::size_t row, double velocity_x, double velocity_y) {
  state_->require(State::Phase::Step, "prefer()", "comes between observe() and step()");
  if (!std::isfinite(velocity_x) || !std::isfinite(velocity_y))
    throw Error("prefer()", "the velocity must be finite");
  Intention& intention = state_->scene().behavior[state_->checked(row, "prefer()")].intention;
  if (intention.kind != IntentionKind::Velocity) state_->preferred.emplace_back(row, intention);
  intention = {IntentionKind::Velocity, Vec2(velocity_x, velocity_y)};
}

VelocitySpace Session::velocity_space(std::size_t row) const {
  state_->require(State::Phase::Step, "velocity_space()", "comes between observe() and step()");
  const Scene& scene = state_->scene();
  if (scene.control[state_->checked(row, "velocity_space()")] != Control::Gamma)
    throw Error("velocity_space()", "'" + std::string(id(row)) + "' is driven by SUMO");
  const Simulation& sim = *state_->run.sim;
  Workspace& work = state_->work;
  const Vec2 chosen =
      gamma_velocity(sim.model, scene, sim.work.geometry, row, scene.behavior[row], work);
  VelocitySpace space;
  const ConstraintSet& all = work.constraints;
  for (std::size_t i = 0; i < all.planes.size(); ++i) {
    const HalfPlane& plane = all.planes[i];
    space.planes.push_back({plane.point.x(), plane.point.y(), plane.normal.x(), plane.normal.y()});
    space.kinds.emplace_back(name_of(all.sources[i].kind));
    const bool agent = all.sources[i].kind != ConstraintKind::Obstacle && all.sources[i].foe >= 0;
    const std::size_t foe = agent ? find_foe(scene, all.sources[i].foe) : 0;
    space.foes.push_back(!agent               ? all.sources[i].foe
                         : foe < scene.size() ? static_cast<std::int64_t>(foe)
                                              : -1);
  }
  space.hard = all.hard_count;
  std::copy_n(work.preferred.data(), 2, space.preferred);
  std::copy_n(chosen.data(), 2, space.chosen);
  return space;
}

void Session::take(const std::string& sumo_id) { state_->wish(sumo_id, "take"); }
void Session::release(const std::string& sumo_id) { state_->wish(sumo_id, "release"); }

}  // namespace sumogamma
