#include "app/run_session.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/progress.h"
#include "app/run_plan.h"
#include "base/error.h"
#include "base/hash.h"
#include "io/output_file.h"
#include "io/output_folder.h"
#include "io/replay.h"
#include "io/results.h"
#include "io/trajectories.h"
#include "model/kinematic_set.h"
#include "osm/obstacles.h"
#include "prediction/live_predictor.h"
#include "road/lane_locator.h"
#include "road/sumo_net_reader.h"
#include "simulation/simulation.h"
#include "sumo/connect_check.h"
#include "sumo/net_conversion.h"
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
  sim->dt = plan.clock.step;
  sim->workers = std::make_unique<Workers>(threads);
  sim->model.types = plan.config.types;
  sim->model.options = plan.config.model;
  sim->model.options.step = plan.clock.step;
  sim->model.kinematics = build_kinematic_tables(sim->model.types, *sim->workers);
  sim->model.road = read_sumo_net(plan.input.network);
  read_all_obstacles(plan, sim->model.road);
  sim->model.obstacles = ObstacleIndex(sim->model.road.obstacles);
  sim->model.conflicts = build_conflict_table(sim->model.road);
  sim->model.swept_ways = find_swept_ways(sim->model.road, sim->model.conflicts);
  sim->model.options.keep_left = sim->model.road.left_hand;
  return sim;
}

void set_host_and_port(const std::string& connect, SumoStart& start) {
  const std::size_t colon = connect.rfind(':');
  if (colon == std::string::npos || colon == 0)
    throw Error("--connect " + connect, "is not HOST:PORT");
  start.connect_host = connect.substr(0, colon);
  const std::string port = connect.substr(colon + 1);
  const auto [end, error] =
      std::from_chars(port.data(), port.data() + port.size(), start.connect_port);
  if (error != std::errc() || end != port.data() + port.size() || start.connect_port < 1 ||
      start.connect_port > 65535)
    throw Error("--connect " + connect, "has no port from 1 to 65535 behind its colon");
}

SumoArguments arguments_of(const RunPlan& plan) {
  SumoArguments wish;
  wish.config = plan.input.config_for_sumo;
  wish.scenario = plan.input.options;
  wish.clients = plan.options.clients;
  wish.step_length = plan.clock.step;
  wish.gui = plan.options.gui;
  wish.plain = !plan.control.any();
  wish.own = {"--seed", std::to_string(plan.clock.seed % 2147483647u)};
  if (wish.plain && plan.vehicles > 0)
    wish.own.insert(wish.own.end(), {"--max-num-vehicles", std::to_string(plan.vehicles)});
  wish.user = plan.sumo_words;
  return wish;
}

/// SUMO's own words for what a newer one wrote don't say what to do.
[[noreturn]] void explain_refusal(const RunPlan& plan, const Error& error) {
  const std::string_view words = error.what();
  if (words.find("nknown vehicle class") != std::string_view::npos) {
    const ForeignClasses classes = find_foreign_classes(plan.input.network);
    throw Error(plan.input.network.string(),
                "a newer SUMO made it (network version " + classes.version +
                    "): the one here doesn't know its vehicle classes " + describe(classes) +
                    "; give --convert to run on a copy without them");
  }
  if (words.find("The vehicle class '") != std::string_view::npos &&
      words.find("is not known") != std::string_view::npos)
    throw Error(
        error.what(),
        "where a newer SUMO made the demand, give its vType a class that the one here knows");
  throw error;
}

/// --convert: the copy of the network that SUMO and we run on; gone again where the run doesn't
/// start.
class ConvertedNetwork {
 public:
  void make(RunPlan& plan) {
    if (!plan.options.convert) return;
    if (!plan.options.connect.empty())
      throw Error("--convert", "a SUMO that runs already has its network; leave --connect out");
    const ForeignClasses classes = find_foreign_classes(plan.input.network);
    if (classes.places.empty()) return;
    file_ = plan.options.output / "converted.net.xml";
    write_without_foreign_classes(plan.input.network, file_);
    spdlog::warn(
        "{}: left out are vehicle classes of a newer SUMO (network version {}): {}; runs on {}",
        plan.input.network.filename().string(), classes.version, describe(classes), file_.string());
    plan.input.network = file_;
    std::vector<std::string>& words = plan.sumo_words;
    words.insert(words.end(), {"--net-file", file_.string()});
  }
  void keep() { file_.clear(); }
  ~ConvertedNetwork() {
    std::error_code ignored;
    if (!file_.empty()) std::filesystem::remove(file_, ignored);
  }

 private:
  std::filesystem::path file_;
};

std::unique_ptr<SumoBackend> start_backend(const RunPlan& plan, const RoadNetwork& network,
                                           std::string& name) {
  SumoStart start;
  start.binary = plan.options.gui ? "sumo-gui" : "sumo";
  start.arguments = sumo_arguments(arguments_of(plan));
  start.client_order = plan.options.client_order;
  // SUMO goes by the order of its clients where there are several
  if (plan.options.clients > 1 && !start.client_order) start.client_order = 1;
  start.clients = plan.options.clients;
  start.port = plan.options.remote_port;
  start.on_listening = [&](int port) {
    if (plan.options.clients > 1)
      std::fprintf(stderr, "run: SUMO waits at 127.0.0.1:%d for %d more TraCI client%s\n", port,
                   plan.options.clients - 1, plan.options.clients > 2 ? "s" : "");
  };
  const bool connects = !plan.options.connect.empty();
  if (connects) set_host_and_port(plan.options.connect, start);
  name = plan.options.backend.value_or(plan.config.backend);
  std::unique_ptr<SumoBackend> backend;
  try {
    backend = name == "libsumo" ? start_libsumo_backend(start) : start_traci_backend(start);
  } catch (const SumoError&) {
    throw;
  } catch (const Error& error) {
    explain_refusal(plan, error);
  }
  if (!connects) return backend;
  ConnectExpectation expected{plan.options.connect, &plan.input, &network, plan.clock.step, {}};
  if (!plan.input.options.contains("load-state")) expected.begin = plan.clock.begin;
  require_same_run(*backend, expected);
  return backend;
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
        trajectories_(output_ / "trajectories.fcd.xml.gz", plan.options.trajectory_period, sim.dt,
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
    rules_.add(scene, types, sim_.road, *sim_.workers);
    smoothness_.add(scene, types);
    trajectories_.add(scene, types, name);
    if (predictor_) predictor_->observe(scene, &types);
    if (replay_) {
      replay_->add(scene, &sim_.road, name, &types);
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
  const auto copy = [](const std::map<std::string, std::int64_t>& from, auto& to) {
    for (const auto& [reason, count] : from) to[reason] = static_cast<std::uint64_t>(count);
  };
  copy(life.removed, agents.removed);
  copy(life.left_to_sumo, agents.left_to_sumo);
  agents.stops_served = static_cast<std::uint64_t>(life.stops_served);
  agents.rides = static_cast<std::uint64_t>(life.rides);
  agents.taken_over = static_cast<std::uint64_t>(life.taken_over);
  agents.handed_back = static_cast<std::uint64_t>(life.handed_back);
  agents.kept_on_foot = static_cast<std::uint64_t>(life.kept_on_foot);
  agents.insertions_delayed = static_cast<std::uint64_t>(life.insertions_delayed);
}

Quantiles quantiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.5), at(0.95), values.back()};
}

HandBackResult summary_of(const std::vector<HandBack>& backs) {
  const auto spread = [&](double HandBack::*figure) {
    std::vector<double> values;
    for (const HandBack& back : backs) values.push_back(back.*figure);
    return quantiles_of(std::move(values));
  };
  return {backs.size(), spread(&HandBack::position), spread(&HandBack::heading),
          spread(&HandBack::speed), spread(&HandBack::acceleration)};
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

/// Ticks until the duration is over, the user interrupts, or nothing is left. Returns how it ended.
std::string run_ticks(const RunPlan& plan, Simulation& sim, SumoWorld& world, Observers& observers,
                      bool quiet) {
  const double duration = plan.clock.end - plan.clock.begin;
  Progress progress("run", duration, "s", quiet);
  const auto ticks = static_cast<std::int64_t>(std::llround(duration / plan.clock.step));
  const Clock::time_point start = Clock::now();
  for (std::int64_t tick_index = 0; tick_index < ticks; ++tick_index) {
    if (interrupted()) return "interrupted";
    tick(sim, world);
    const Clock::time_point recording = Clock::now();
    observers.add();
    sim.times.record += seconds_since(recording);
    if (progress.due()) {
      const double simulated = static_cast<double>(tick_index + 1) * plan.clock.step;
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
  RunPlan plan = make_plan(options, common);
  const OutputFolder folder(options.output, options.force);
  ConvertedNetwork converted;
  converted.make(plan);
  if (!common.quiet) std::fprintf(stderr, "run: reading %s\n", plan.input.network.string().c_str());
  for (const NotFollowed& item : plan.inventory.not_followed) spdlog::warn("{}", describe(item));
  const std::unique_ptr<Simulation> sim = make_simulation(plan, common.threads);
  RunResults results;
  const std::unique_ptr<SumoBackend> backend =
      start_backend(plan, sim->model.road, results.backend);
  converted.keep();
  settle_begin(backend->time(), plan);
  if (!common.quiet) std::fprintf(stderr, "run: %s\n", describe(plan).c_str());

  SumoWorldOptions world_options;
  world_options.control = plan.control;
  world_options.max_vehicles = plan.control.any() ? plan.vehicles : 0;
  world_options.seed = plan.clock.seed;
  world_options.dt = plan.clock.step;
  world_options.rerouter_edges = plan.inventory.rerouter_edges;
  world_options.sign_lanes = plan.inventory.sign_lanes;
  world_options.others_steer = !plan.options.connect.empty() || plan.options.clients > 1;
  for (const auto& [key, where] : plan.config.given)
    if (key.rfind("types.", 0) == 0) world_options.type_keys.insert(key);
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
  const double simulated = static_cast<double>(sim->scene.tick) * plan.clock.step;
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
  results.clock = plan.clock;
  results.not_followed = plan.inventory.not_followed;
  results.duration = simulated;
  results.control = plan.control_text;
  results.preset = name_of(plan.config.preset);
  results.types = plan.config.types;
  results.threads = common.threads;
  observers.fill(results);
  fill_agents(world.life_cycle(), sim->model.types, results.agents);
  results.agents.detours = sim->detours;
  results.coupling = coupling.result();
  results.hand_back = summary_of(world.coupling().hand_backs);
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
