#include "app/drive_episode.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "ego/ego_detour.h"
#include "ego/plan_tree.h"
#include "io/output_file.h"
#include "io/replay.h"
#include "io/replay_page.h"
#include "study/offences/rule_roads.h"

namespace sumogamma {

namespace {

/// SUMO's world, in which one vehicle is the ego from its first tick on.
class EgoWorld final : public World {
 public:
  using Seen = std::function<void(Scene&, RoadState&, std::size_t row)>;

  /// `entered`: called once; `seen`: at every tick on which it is there, after that.
  EgoWorld(SumoWorld& world, std::string id, Seen entered, Seen seen)
      : world_(world), id_(std::move(id)), entered_(std::move(entered)), seen_(std::move(seen)) {}

  void observe(Scene& scene, RoadState& road) override {
    world_.observe(scene, road);
    for (; !ego_ && known_ < world_.names().size(); ++known_)
      if (world_.names()[known_] == id_) ego_ = AgentId{static_cast<std::uint32_t>(known_)};
    if (!ego_) return;
    const std::size_t row = find_row(scene, *ego_);
    if (!std::exchange(has_come_, true)) enter(scene, road, row);
    if (row < scene.size()) seen_(scene, road, row);
  }
  void advance(const Scene& scene) override { world_.advance(scene); }
  bool finished() const override { return world_.finished(); }

  /// Its row, or the scene's size where it isn't there.
  std::size_t row(const Scene& scene) const { return ego_ ? find_row(scene, *ego_) : scene.size(); }
  bool has_come() const { return has_come_; }

 private:
  void enter(Scene& scene, RoadState& road, std::size_t row) {
    if (row == scene.size()) throw Error(id_, "can't be the ego: SUMO shows no place of it");
    entered_(scene, road, row);
  }

  SumoWorld& world_;
  std::string id_;
  Seen entered_, seen_;
  std::optional<AgentId> ego_;
  std::size_t known_ = 0;
  bool has_come_ = false;
};

/// An episode as it goes on.
class Episode {
 public:
  Episode(Drive& drive, std::uint64_t seed)
      : drive_(drive),
        sim_(*drive.sim),
        seed_(seed),
        backend_(start(drive, seed)),
        world_(sim_.model, *backend_, world_options()),
        ego_world_(
            world_, ego_id(),
            [this](Scene& scene, RoadState& road, std::size_t row) { enter(scene, road, row); },
            [this](Scene& scene, RoadState& road, std::size_t row) {
              if (driver_ && driver_->is_due())
                detour_.look({sim_.model, goal_, row, sim_.rules}, 1.0 / drive_.settings.rate,
                             scene, road);
            }),
        locator_(sim_.model.road),
        roads_(sim_.model.road, locator_, sim_.traffic.code),
        recorder_(roads_, sim_.model, sim_.dt),
        gridlock_(drive.settings.window, sim_.dt) {
    result_.seed = seed;
    result_.world_hash = kFnvBasis;
    if (!drive.replay.empty())
      replay_ = std::make_unique<ReplayRecorder>(drive.replay / "replay.bin", drive.plan.input.name,
                                                 sim_.model.road, sim_.model.types, kReplayPeriod);
  }
  ~Episode() { sim_.planned = nullptr; }
  Episode(const Episode&) = delete;
  Episode& operator=(const Episode&) = delete;

  std::optional<EpisodeResult> run() {
    const auto start = std::chrono::steady_clock::now();
    if (!warm_up() || !wait_for_ego()) return std::nullopt;
    while (result_.outcome.empty()) {
      if (interrupted()) return std::nullopt;
      tick(sim_, ego_world_, [this] { record(); });
      decide_outcome();
    }
    result_.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    finish();
    return std::move(result_);
  }

 private:
  static constexpr double kReplayPeriod = 0.1;  // [s]

  /// A simulation without anybody, and its SUMO.
  static std::unique_ptr<SumoBackend> start(Drive& drive, std::uint64_t seed) {
    Simulation& sim = *drive.sim;
    sim.model.types = drive.types;
    sim.model.kinematics = drive.kinematics;
    sim.model.options.trust_planned = drive.settings.trusted;
    sim.scene = {};
    sim.road = {};
    sim.traffic.state = {};
    sim.traffic.detours = 0;
    sim.traffic.waits = {};
    sim.planned = nullptr;
    drive.plan.clock.seed = seed;
    std::string name;
    return start_backend(drive.plan, sim.model.road, name);
  }

  SumoWorldOptions world_options() const {
    SumoWorldOptions options = world_options_of(drive_.plan);
    options.ego = ego_id();
    return options;
  }
  bool drawn() const { return drive_.settings.vehicle.empty(); }
  std::string ego_id() const { return drawn() ? kEgoId : drive_.settings.vehicle; }
  /// Is it moved along a planner's wish?
  bool planned() const { return drive_.external || drive_.settings.planner != "gamma"; }

  void tick_before() {
    tick(sim_, ego_world_, [this] {
      if (!ego_world_.has_come()) result_.world_hash = hash_state(sim_.scene, result_.world_hash);
      record();
    });
  }

  bool warm_up() {
    if (!drawn()) return true;
    const auto ticks = std::llround(drive_.settings.warm_up / sim_.dt);
    for (std::int64_t k = 0; k < ticks; ++k) {
      if (interrupted()) return false;
      tick_before();
    }
    return true;
  }

  /// Ticks until it is in the scene.
  bool wait_for_ego() {
    constexpr double kForRoom = 60.0, kAgain = 0.5;  // [s]
    const double from = sim_.scene.time;
    const double most = drawn() ? kForRoom : drive_.plan.clock.end - drive_.plan.clock.begin;
    double placed = -1e9;
    while (!ego_world_.has_come()) {
      if (interrupted()) return false;
      const double waited = sim_.scene.time - from;
      if (waited > most) refuse_to_wait(most);
      if (drawn() && !is_placed_ && waited - placed >= kAgain) {
        placed = waited;
        place();
      }
      tick_before();
    }
    return true;
  }

  [[noreturn]] void refuse_to_wait(double waited) const {
    if (!drawn())
      throw Error("[ego] vehicle " + drive_.settings.vehicle,
                  "hasn't departed within " + number_text(waited) +
                      " s: is it in the demand before the run ends?");
    throw Error("[ego] window", "seed " + std::to_string(seed_) + ": no start with room after " +
                                    std::to_string(draws_) + " draws over " + number_text(waited) +
                                    " s; give a larger window, less clearance or fewer agents");
  }

  /// Draws a start with room and asks SUMO for a vehicle there.
  void place() {
    constexpr std::uint64_t kDraws = 500;
    const AgentType& type =
        type_of(sim_.model.types, find_agent_type(sim_.model.types, drive_.settings.type));
    const StartDraw draw(sim_.model.road, type, drive_.settings);
    for (std::uint64_t k = 0; k < kDraws && !is_placed_; ++k) {
      const auto start = draw.draw(seed_, draws_++);
      if (!start || !is_free(sim_.scene, sim_.road, *start, type, drive_.settings.clearance))
        continue;
      SumoBackend::NewVehicle vehicle{ego_id(), kEgoTypeId, {}, 0, start->front};
      for (const EdgeId edge : start->route)
        vehicle.route.push_back(sim_.model.road.edge(edge).name);
      vehicle.lane_index = sim_.model.road.lane(start->lane).index;
      backend_->add_vehicle(vehicle);
      is_placed_ = true;
    }
  }

  void refuse_ego(const Scene& scene, std::size_t row) const {
    const AgentType& type = type_of(sim_.model.types, scene.type[row]);
    const std::string where = "[ego] vehicle " + ego_id();
    if (type.kinematics == Kinematics::Holonomic)
      throw Error(where, "is a person: an ego drives a vehicle");
    if (type.guided) throw Error(where, "rides on rails or water, where SUMO alone moves it");
    if (scene.control[row] != Control::Gamma)
      throw Error(where, "is none that GAMMA could drive: it waits, parks or is a taxi");
  }

  void enter(Scene& scene, const RoadState& road, std::size_t row) {
    refuse_ego(scene, row);
    const EgoSettings& settings = drive_.settings;
    const Path& path = *road.path(scene.path[row]);
    const double along = path.line.project(scene.position[row]).along;
    const double length = 2.0 * half_length(scene, row);
    goal_ = goal_on(sim_.model.road, path, along, length, settings, drawn());
    if (drawn()) {
      scene.speed[row] = 0.0;
      scene.velocity[row].setZero();
    }
    scene.preferred_speed[row] = std::min(scene.preferred_speed[row], settings.max_speed);
    result_.start = scene.position[row];
    result_.start_heading = scene.heading[row];
    result_.way = goal_.way;
    result_.others = scene.size() - 1;
    result_.world_hash = result_.state_hash = hash_state(scene, result_.world_hash);
    if (!planned()) return;
    scene.control[row] = Control::Planned;
    Planner planner =
        drive_.external
            ? Planner([this](const EgoView& view) { return drive_.external->decide(view); })
            : make_planner(settings.planner);
    EgoTask task{settings, goal_, seed_, sim_.dt, sim_.rules};
    if (replay_)
      task.look_on = [this](const PlanTrace& trace) {
        replay_->add_plan(trace);
        if (trace.tree.size() > largest_.tree.size()) largest_ = trace;
      };
    driver_.emplace(std::move(task), *sim_.workers, std::move(planner));
    sim_.planned = [this](const TrafficView& view, std::size_t ego) {
      return (*driver_)(view, ego);
    };
  }

  static double half_length(const Scene& scene, std::size_t row) {
    return scene.footprint[row].vertices[0].x();
  }

  /// After every tick, on another thread than SUMO's step where there are several.
  void record() {
    const std::size_t row = ego_world_.row(sim_.scene);
    gridlock_.add(sim_.model.types, sim_.scene, row);
    if (replay_) {
      const AgentName name_of = [&](AgentId id) -> std::string_view {
        return world_.names()[id.value];
      };
      replay_->add({sim_.scene, name_of, &sim_.road, &sim_.model.types, sim_.work.bindings});
    }
    if (row == sim_.scene.size()) return;
    ++ticks_;
    result_.state_hash = hash_state(sim_.scene, result_.state_hash);
    recorder_.add(sim_.scene, sim_.road, row, since());
    progress_ += recorder_.samples().back().progress;
    if (driver_) driver_->set_progress(progress_);
  }

  double since() const { return static_cast<double>(ticks_) * sim_.dt; }

  void decide_outcome() {
    const std::size_t row = ego_world_.row(sim_.scene);
    if (drive_.external && drive_.external->failed())
      result_.outcome = outcome::kClientFailed;
    else if (recorder_.contact())
      result_.outcome = outcome::kCollision;
    else if (row == sim_.scene.size())
      result_.outcome = outcome::kLost;
    else if (has_reached(goal_, sim_.scene, row))
      result_.outcome = outcome::kGoal;
    else if (since() >= drive_.settings.limit - 1e-9)
      result_.outcome = outcome::kTime;
  }

  void finish() {
    const EgoSettings& settings = drive_.settings;
    const std::size_t row = ego_world_.row(sim_.scene);
    if (drive_.external) {
      EgoObservation last;
      if (row < sim_.scene.size())
        last = observe_ego(sim_.model, sim_.road, sim_.scene, row, goal_, since());
      const bool ended =
          result_.outcome == outcome::kGoal || result_.outcome == outcome::kCollision;
      result_.failure = drive_.external->failure();
      result_.late = drive_.external->late();
      drive_.external->end_episode({result_.outcome, ended}, last, progress_, sim_.model.types);
    }
    result_.metrics = metrics_of(recorder_.samples(), sim_.dt, 1.0 / settings.rate);
    result_.restricted_time =
        result_.outcome == outcome::kGoal ? result_.metrics.time : settings.limit;
    result_.contact = recorder_.contact();
    if (result_.contact)
      result_.contact_type = type_of(sim_.model.types, result_.contact->foe_type).name;
    const double reference =
        drive_.reference ? drive_.reference(seed_).value_or(goal_.way) : goal_.way;
    result_.score = closed_loop_score(recorder_.samples(), result_.contact, reference, sim_.dt);
    result_.gridlock = gridlock_.found();
    if (driver_) {
      result_.plans = driver_->plans();
      result_.planning_times = driver_->planning_times();
      result_.detours = detour_.taken();
      result_.detours_missed = detour_.missed();
    }
    if (replay_) {
      replay_->close();
      write_replay_page(replay_page(drive_.replay, seed_), drive_.replay / "replay.bin");
      if (!largest_.tree.empty())
        write_file(drive_.replay / fmt::format("plan_tree_{}.svg", seed_), plan_tree_svg(largest_));
      std::filesystem::remove(drive_.replay / "replay.bin");
    }
    backend_->close();
  }

  Drive& drive_;
  Simulation& sim_;
  std::uint64_t seed_;
  std::unique_ptr<SumoBackend> backend_;
  SumoWorld world_;
  EgoWorld ego_world_;
  LaneLocator locator_;
  RuleRoads roads_;
  EgoRecorder recorder_;
  GridlockWatch gridlock_;
  std::unique_ptr<ReplayRecorder> replay_;
  PlanTrace largest_;  ///< of the plans that somebody looks on, the one with the largest tree
  std::optional<EgoDriver> driver_;
  EgoDetour detour_;
  EgoGoal goal_;
  EpisodeResult result_;
  double progress_ = 0;
  std::int64_t ticks_ = 0;
  std::uint64_t draws_ = 0;
  bool is_placed_ = false;
};

}  // namespace

std::filesystem::path replay_page(const std::filesystem::path& folder, std::uint64_t seed) {
  return folder / ("replay_" + std::to_string(seed) + ".html");
}

std::optional<EpisodeResult> run_episode(Drive& drive, std::uint64_t seed) {
  return Episode(drive, seed).run();
}

}  // namespace sumogamma
