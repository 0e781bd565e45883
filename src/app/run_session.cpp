#include "app/run_session.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/progress.h"
#include "base/error.h"
#include "base/hash.h"
#include "io/config.h"
#include "io/output_file.h"
#include "io/replay.h"
#include "io/results.h"
#include "io/trajectories.h"
#include "model/kinematic_set.h"
#include "osm/obstacles.h"
#include "prediction/live_predictor.h"
#include "road/lane_locator.h"
#include "road/sumo_net_reader.h"
#include "simulation/simulation.h"
#include "sumo/scenario_input.h"
#include "sumo/sumo_arguments.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double cpu_of(int who) {
  rusage usage{};
  getrusage(who, &usage);
  auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// What the options and scenario.toml together say.
struct RunPlan {
  RunOptions options;
  ScenarioInput input;
  ScenarioConfig config;
  ControlChoice control;
  double step = 0.05, duration = 0;
  std::size_t vehicles = 0;  ///< at once, at the most; 0: as many as the demand has
  std::string control_text;
};

/// Where `agents` are to be alive, 0 for as many as the demand has, how many may be vehicles. SUMO
/// can hold back vehicles alone: people come as the demand has them, and leave the vehicles their
/// share. A tenth more gets in: a bound at the mean would cut off every fluctuation, and who drives
/// more slowly would get less of the same demand.
std::size_t most_vehicles(long agents, double on_foot) {
  constexpr double kSlack = 1.1;
  if (agents <= 0) return 0;
  const long vehicles = std::lround(kSlack * static_cast<double>(agents) * (1.0 - on_foot));
  return static_cast<std::size_t>(std::max(vehicles, 1L));
}

ControlChoice control_choice(const RunOptions& options, const std::string& from_config,
                             std::string& text) {
  std::vector<std::string> words =
      options.control.empty() ? std::vector<std::string>{from_config} : options.control;
  ControlChoice control;
  control.all = words == std::vector<std::string>{"all"};
  if (!control.all && words != std::vector<std::string>{"none"})
    control.names.insert(words.begin(), words.end());
  if (control.names.count("all") + control.names.count("none") > 0)
    throw Error("--control", "'all' and 'none' stand alone, expected all, none, or types and ids");
  text.clear();
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  if (options.region.size() == 4) {
    control.all = false;
    control.has_region = true;
    control.region_low = {std::min(options.region[0], options.region[2]),
                          std::min(options.region[1], options.region[3])};
    control.region_high = {std::max(options.region[0], options.region[2]),
                           std::max(options.region[1], options.region[3])};
    text = "region";
  }
  return control;
}

RunPlan make_plan(const RunOptions& options, const CommonOptions& common) {
  RunPlan plan;
  plan.options = options;
  plan.input = find_scenario(options.scenario);
  std::vector<std::string> overrides = common.set;
  if (options.preset) overrides.push_back("behavior.preset=" + *options.preset);
  plan.config = read_config(plan.input.settings, overrides);
  plan.step = options.step.value_or(plan.config.step);
  // a user's own .sumocfg may say itself how long it is
  const bool set = std::any_of(common.set.begin(), common.set.end(), [](const std::string& key) {
    return key.rfind("run.duration", 0) == 0;
  });
  const double length = plan.input.end - plan.input.begin;
  const bool own_length = plan.input.settings.empty() && !set && length > 0.0;
  plan.duration = options.duration.value_or(own_length ? length : plan.config.duration);
  // the cap of scenario.toml belongs to imported demand; a user's own .sumocfg brings as many as it
  // likes
  const long cap = options.agents.value_or(plan.input.settings.empty() ? 0 : plan.config.agents);
  plan.vehicles = most_vehicles(cap, plan.config.on_foot);
  plan.control = control_choice(options, plan.config.control, plan.control_text);
  return plan;
}

/// Obstacles of the additional files. An import has looked at the lanes already; polyconvert's
/// houses stand on sidewalks.
void read_all_obstacles(const RunPlan& plan, RoadNetwork& road) {
  for (const auto& file : plan.input.additional) read_obstacles(file, road);
  if (!plan.input.settings.empty() || road.obstacles.empty()) return;
  const std::size_t all = road.obstacles.size();
  const osm::ClearedObstacles cleared = osm::clear_lanes(road);
  if (cleared.cut + cleared.left_out > 0)
    spdlog::warn(
        "{}: {} of {} houses and walls of its polygons stand on lanes: what is on the ground of a "
        "lane is no wall there",
        plan.input.name, cleared.cut + cleared.left_out, all);
}

std::unique_ptr<Simulation> make_simulation(const RunPlan& plan, unsigned threads) {
  auto sim = std::make_unique<Simulation>();
  sim->dt = plan.step;
  sim->workers = std::make_unique<Workers>(threads);
  sim->model.types = plan.config.types;
  sim->model.options = plan.config.model;
  sim->model.options.step = plan.step;
  sim->model.kinematics = build_kinematic_tables(sim->model.types, *sim->workers);
  sim->model.road = read_sumo_net(plan.input.network);
  read_all_obstacles(plan, sim->model.road);
  sim->model.obstacles = ObstacleIndex(sim->model.road.obstacles);
  sim->model.conflicts = build_conflict_table(sim->model.road);
  sim->model.swept_ways = find_swept_ways(sim->model.road, sim->model.conflicts);
  sim->model.options.keep_left = sim->model.road.left_hand;
  return sim;
}

std::unique_ptr<SumoBackend> start_backend(const RunPlan& plan, std::uint64_t seed,
                                           std::string& name) {
  SumoStart start;
  start.binary = plan.options.gui ? "sumo-gui" : "sumo";
  SumoArguments wish;
  wish.config = plan.input.config.string();
  wish.step_length = plan.step;
  wish.gui = plan.options.gui;
  wish.plain = !plan.control.any();
  wish.own = {"--seed", std::to_string(seed % 2147483647u)};
  if (wish.plain && plan.vehicles > 0)
    wish.own.insert(wish.own.end(), {"--max-num-vehicles", std::to_string(plan.vehicles)});
  wish.user = split_options(plan.options.sumo_options);
  start.arguments = sumo_arguments(wish);
  if (!plan.options.connect.empty()) {
    const std::size_t colon = plan.options.connect.rfind(':');
    if (colon == std::string::npos)
      throw Error("--connect " + plan.options.connect, "is not HOST:PORT");
    start.connect_host = plan.options.connect.substr(0, colon);
    try {
      start.connect_port = std::stoi(plan.options.connect.substr(colon + 1));
    } catch (const std::exception&) {
      throw Error("--connect " + plan.options.connect, "has no port number after the colon");
    }
  }
  name = plan.options.backend.value_or(plan.config.backend);
  return name == "libsumo" ? start_libsumo_backend(start) : start_traci_backend(start);
}

/// Everything that watches a run and writes about it.
class Observers {
 public:
  Observers(const RunPlan& plan, const Simulation& sim, const SumoWorld& world)
      : sim_(sim),
        world_(world),
        output_(plan.options.output),
        locator_(sim.model.road),
        collisions_(sim.dt, &sim.model.road),
        flow_(sim.dt, sim.model.road),
        rules_(sim.dt, sim.model.road, locator_),
        smoothness_(sim.dt),
        trajectories_(output_ / "trajectories.fcd.xml.gz", plan.options.trajectory_period,
                      sim.model.road, &locator_) {
    if (plan.options.predict)
      predictor_ = std::make_unique<LivePredictor>(sim.model.types, live_predictor_parameters(),
                                                   &sim.model.road);
    if (plan.options.replay)
      replay_ =
          std::make_unique<ReplayRecorder>(output_ / "replay.bin", plan.input.name, sim.model.road,
                                           sim.model.types, plan.options.replay_period);
  }

  void add() {
    const Scene& scene = sim_.scene;
    const AgentTypeTable& types = sim_.model.types;
    const AgentName name = name_of();
    collisions_.add(scene, types);
    flow_.add(scene, types, sim_.road);
    rules_.add(scene, types, sim_.road);
    smoothness_.add(scene, types);
    trajectories_.add(scene, types, name);
    if (predictor_) predictor_->observe(scene);
    if (replay_) {
      replay_->add(scene, &sim_.road, name);
      for (; collisions_marked_ < collisions_.pairs().size(); ++collisions_marked_) {
        const CollisionPair& pair = collisions_.pairs()[collisions_marked_];
        replay_->add_event(ReplayEventKind::Collision, pair.since, pair.position, pair.a, pair.b);
      }
      for (const RedLightEvent& event : rules_.new_events())
        replay_->add_event(ReplayEventKind::RedLight, event.time, event.position, event.id);
      for (; stuck_marked_ < flow_.stuck().size(); ++stuck_marked_) {
        const StuckAgent& stuck = flow_.stuck()[stuck_marked_];
        replay_->add_event(ReplayEventKind::Stuck, scene.time, stuck.position, stuck.id);
      }
    }
    hash_ = hash_state(scene, hash_);
    const auto driven = static_cast<std::uint64_t>(
        std::count(scene.control.begin(), scene.control.end(), Control::Gamma));
    controlled_sum_ += driven;
    controlled_peak_ = std::max(controlled_peak_, driven);
    controlled_now_ = driven;
    ++ticks_;
  }

  void fill(RunResults& results) const {
    results.collisions = collisions_.result();
    results.flow = flow_.result(sim_.model.types);
    results.rules = rules_.result(sim_.model.types);
    results.smoothness = smoothness_.result(sim_.model.types);
    if (predictor_) results.prediction = {true, predictor_->score(), predictor_->scores()};
    results.state_hash = hash_;
    results.agents.controlled_now = controlled_now_;
    results.agents.controlled_peak = controlled_peak_;
    results.agents.controlled_mean =
        ticks_ > 0 ? static_cast<double>(controlled_sum_) / static_cast<double>(ticks_) : 0.0;
  }

  /// Completes every file but results.json.
  void close() {
    trajectories_.close();
    const AgentName name = name_of();
    write_file(output_ / "stuck.csv",
               stuck_csv(flow_.stuck(), sim_.model.types, sim_.model.road, name));
    write_file(output_ / "held.csv",
               stuck_csv(flow_.held(), sim_.model.types, sim_.model.road, name));
    write_file(output_ / "trips.csv", trips_csv(world_.life_cycle().trips, sim_.model.types, name));
    write_file(output_ / "collisions.csv",
               collisions_csv(collisions_.pairs(), sim_.model.types, name));
    write_file(output_ / "offences.csv", offences_csv(rules_.offences(), sim_.model.types, name));
    if (replay_) {
      replay_->close();
      write_replay_page(output_ / "replay.html", output_ / "replay.bin");
    }
  }

 private:
  AgentName name_of() const {
    return [this](AgentId id) -> std::string_view { return world_.names()[id.value]; };
  }

  const Simulation& sim_;
  const SumoWorld& world_;
  std::filesystem::path output_;
  LaneLocator locator_;
  CollisionMonitor collisions_;
  FlowMonitor flow_;
  RuleMonitor rules_;
  SmoothnessMonitor smoothness_;
  TrajectoryWriter trajectories_;
  std::unique_ptr<LivePredictor> predictor_;
  std::unique_ptr<ReplayRecorder> replay_;
  std::size_t stuck_marked_ = 0, collisions_marked_ = 0;
  std::uint64_t hash_ = kFnvBasis, controlled_sum_ = 0, controlled_peak_ = 0, controlled_now_ = 0,
                ticks_ = 0;
};

void fill_timing(const PhaseTimes& times, double wall, double simulated, RunTiming& timing) {
  timing.wall_s = wall;
  timing.real_time_factor = wall > 0.0 ? simulated / wall : 0.0;
  const double whole = std::max(wall, 1e-9);
  timing.observe = times.observe / whole;
  timing.context = times.context / whole;
  timing.model = times.model / whole;
  timing.track = times.track / whole;
  timing.advance_sumo = times.advance / whole;
  timing.record = times.record / whole;
  timing.model_cpu_us_per_agent_step =
      times.agent_steps > 0 ? 1e6 * times.model_cpu / static_cast<double>(times.agent_steps) : 0.0;
}

void fill_agents(const LifeCycle& life, const AgentTypeTable& types, AgentCounts& agents) {
  for (const auto& [type, count] : life.by_type) {
    AgentCounts::ByType& counts = agents.by_type[type];
    counts.inserted = static_cast<std::uint64_t>(count.inserted);
    counts.arrived = static_cast<std::uint64_t>(count.arrived);
    agents.inserted += counts.inserted;
    agents.arrived += counts.arrived;
  }
  for (const FinishedTrip& trip : life.trips) {
    const double time = trip.arrived - trip.departed;
    AgentCounts::ByType& counts = agents.by_type[type_of(types, trip.type).name];
    counts.mean_travel_time += time / static_cast<double>(counts.arrived);
    agents.mean_travel_time += time / static_cast<double>(agents.arrived);
  }
  for (const auto& [reason, count] : life.removed)
    agents.removed[reason] = static_cast<std::uint64_t>(count);
}

bool failed(const RunOptions& options, const RunResults& results) {
  bool failed = false;
  for (const std::string& what : options.fail_on) {
    const std::uint64_t count = what == "collision"        ? results.collisions.unique_pairs
                                : what == "deep-collision" ? results.collisions.deep_pairs
                                : what == "red-light"      ? results.rules.all.red_light_crossings
                                : what == "stuck"          ? results.flow.stuck_agents
                                                           : results.agents.removed.size();
    if (count == 0) continue;
    std::fprintf(stderr, "sumo-gamma: --fail-on %s: happened %llu times\n", what.c_str(),
                 static_cast<unsigned long long>(count));
    failed = true;
  }
  return failed;
}

/// Makes the output folder, and takes it away again where the run ends before it wrote anything.
class OutputFolder {
 public:
  explicit OutputFolder(std::filesystem::path folder)
      : folder_(std::move(folder)), existed_(std::filesystem::exists(folder_)) {
    make_output_folder(folder_);
  }
  ~OutputFolder() {
    std::error_code not_empty;
    if (!existed_) std::filesystem::remove(folder_, not_empty);
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  std::filesystem::path folder_;
  bool existed_;
};

/// Ticks until the duration is over, the user interrupts, or nothing is left. Returns how it ended.
std::string run_ticks(const RunPlan& plan, Simulation& sim, SumoWorld& world, Observers& observers,
                      bool quiet) {
  Progress progress("run", plan.duration, "s", quiet);
  const auto ticks = static_cast<std::int64_t>(std::llround(plan.duration / plan.step));
  const Clock::time_point start = Clock::now();
  for (std::int64_t tick_index = 0; tick_index < ticks; ++tick_index) {
    if (interrupted()) return "interrupted";
    tick(sim, world);
    const Clock::time_point recording = Clock::now();
    observers.add();
    sim.times.record += seconds_since(recording);
    if (progress.due()) {
      const double simulated = static_cast<double>(tick_index + 1) * plan.step;
      char detail[96];
      std::snprintf(detail, sizeof detail, "%.0f s simulated, %zu agents, %.1f x real time",
                    simulated, sim.scene.size(), simulated / std::max(seconds_since(start), 1e-6));
      progress.update(simulated, detail);
    }
    if (world.finished()) break;
  }
  return "done";
}

}  // namespace

int run_session(const RunOptions& options, const CommonOptions& common) {
  const RunPlan plan = make_plan(options, common);
  const OutputFolder folder(options.output);
  if (!common.quiet) std::fprintf(stderr, "run: reading %s\n", plan.input.network.string().c_str());
  const std::unique_ptr<Simulation> sim = make_simulation(plan, common.threads);
  RunResults results;
  const std::unique_ptr<SumoBackend> backend = start_backend(plan, common.seed, results.backend);

  SumoWorldOptions world_options;
  world_options.control = plan.control;
  world_options.max_vehicles = plan.control.any() ? plan.vehicles : 0;
  world_options.seed = common.seed;
  world_options.dt = plan.step;
  SumoWorld world(sim->model, *backend, world_options);
  CouplingMonitor coupling;
  world.coupling().compare = [&](const Vec2& written, const Vec2& reported) {
    coupling.add(written, reported);
  };
  Observers observers(plan, *sim, world);

  const Clock::time_point start = Clock::now();
  const double cpu_start = cpu_of(RUSAGE_SELF);
  std::string failure;
  try {
    results.ended = run_ticks(plan, *sim, world, observers, common.quiet);
  } catch (const SumoError& error) {
    failure = error.what();
    results.ended = "SUMO failed";
  }
  const double simulated = static_cast<double>(sim->scene.tick) * plan.step;
  fill_timing(sim->times, seconds_since(start), simulated, results.timing);
  results.sumo_version = backend->version();
  for (const std::string& warning : backend->take_warnings()) spdlog::info("{}", warning);
  results.sumo_warnings = static_cast<std::uint64_t>(std::max(backend->sumo_warnings(), 0L));
  try {
    backend->close();
  } catch (const std::exception& error) {
    if (failure.empty()) spdlog::warn("{}", error.what());
  }
  results.timing.cpu_s = cpu_of(RUSAGE_SELF) - cpu_start + cpu_of(RUSAGE_CHILDREN);

  results.sumo_gamma_version = SUMOGAMMA_VERSION;
  results.scenario = plan.input.name;
  results.seed = common.seed;
  results.step = plan.step;
  results.duration = simulated;
  results.control = plan.control_text;
  results.preset = name_of(plan.config.preset);
  results.types = plan.config.types;
  results.threads = common.threads;
  observers.fill(results);
  fill_agents(world.life_cycle(), sim->model.types, results.agents);
  results.agents.detours = sim->detours;
  results.coupling = coupling.result();
  results.teleports = static_cast<std::uint64_t>(world.coupling().teleports);
  results.emergency_stops = static_cast<std::uint64_t>(world.coupling().emergency_stops);
  observers.close();
  write_results(options.output / "results.json", results);

  if (!failure.empty())
    throw SumoError("SUMO", failure + "; what ran until then is in " + options.output.string());
  print_results_table(stdout, results);
  if (options.replay)
    std::printf("replay: %s\n", (options.output / "replay.html").string().c_str());
  if (results.ended == "interrupted") return kExitInterrupted;
  return failed(options, results) ? kExitNotHeld : kExitDone;
}

}  // namespace sumogamma
