#include "app/run_session.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <utility>

#include "app/progress.h"
#include "app/run_observers.h"
#include "app/run_plan.h"
#include "app/sumo_files.h"
#include "base/error.h"
#include "base/print.h"
#include "io/output_folder.h"
#include "io/results.h"
#include "model/kinematic_set.h"
#include "osm/obstacles.h"
#include "road/road.h"
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

/// Where the user's programs keep what they can make again (XDG base directories); empty where
/// there is no such place.
std::filesystem::path cache_folder() {
  const char* const given = std::getenv("XDG_CACHE_HOME");
  if (given && *given == '/') return std::filesystem::path(given) / "sumo-gamma";
  const char* const home = std::getenv("HOME");
  if (home && *home == '/') return std::filesystem::path(home) / ".cache" / "sumo-gamma";
  return {};
}

std::unique_ptr<Simulation> make_simulation(const RunPlan& plan, unsigned threads) {
  auto sim = std::make_unique<Simulation>();
  sim->dt = plan.clock.step;
  sim->workers = std::make_unique<Workers>(threads);
  sim->model.types = plan.config.types;
  sim->model.options = plan.config.model;
  sim->traffic.parameters = plan.config.traffic;
  sim->traffic.code = plan.config.code;
  sim->model.options.step = plan.clock.step;
  // of whom a scenario has, when the first of them comes (VehicleTypeRows)
  sim->model.kinematics.resize(sim->model.types.size());
  RoadCache cache;
  if (!plan.options.no_cache) cache.folder = cache_folder();
  Road road = read_road(plan.input.network, cache, *sim->workers);
  sim->model.road = std::move(road.network);
  sim->model.conflicts = std::move(road.conflicts);
  sim->model.swept_ways = std::move(road.swept_ways);
  read_all_obstacles(plan, sim->model.road);
  sim->model.obstacles = ObstacleIndex(sim->model.road.obstacles);
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
      print(stderr, "run: SUMO waits at 127.0.0.1:{} for {} more TraCI client{}\n", port,
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

SumoWorldOptions world_options_of(const RunPlan& plan) {
  SumoWorldOptions options;
  options.control = plan.control;
  options.max_vehicles = plan.control.any() ? plan.vehicles : 0;
  options.seed = plan.clock.seed;
  options.dt = plan.clock.step;
  options.rerouter_edges = plan.inventory.rerouter_edges;
  options.sign_lanes = plan.inventory.sign_lanes;
  options.others_steer = !plan.options.connect.empty() || plan.options.clients > 1;
  for (const auto& [key, where] : plan.config.given)
    if (key.rfind("types.", 0) == 0) options.type_keys.insert(key);
  return options;
}

/// What was run.
void fill_plan(const RunPlan& plan, const CommonOptions& common, RunResults& results) {
  results.sumo_gamma_version = SUMOGAMMA_VERSION;
  results.scenario = plan.input.name;
  results.clock = plan.clock;
  results.not_followed = plan.inventory.not_followed;
  results.control = plan.control_text;
  results.preset = name_of(plan.config.preset);
  results.types = plan.config.types;
  results.threads = common.threads;
}

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

bool failed(const RunOptions& options, const RunResults& results) {
  bool failed = false;
  for (const std::string& what : options.fail_on) {
    const std::uint64_t count = what == "collision"        ? results.collisions.unique_pairs
                                : what == "deep-collision" ? results.collisions.deep_pairs
                                : what == "red-light"      ? results.rules.all.red_light_crossings
                                : what == "stuck"          ? results.flow.stuck_agents
                                                           : results.agents.removed.size();
    if (count == 0) continue;
    print(stderr, "sumo-gamma: --fail-on {}: happened {} times\n", what, count);
    failed = true;
  }
  return failed;
}

/// Ticks until the duration is over, the user interrupts, or nothing is left. Returns how it ended.
std::string run_ticks(const RunPlan& plan, Simulation& sim, SumoWorld& world,
                      RunObservers& observers, bool quiet) {
  const double duration = plan.clock.end - plan.clock.begin;
  Progress progress("run", duration, "s", quiet);
  const auto ticks = static_cast<std::int64_t>(std::llround(duration / plan.clock.step));
  const Clock::time_point start = Clock::now();
  for (std::int64_t tick_index = 0; tick_index < ticks; ++tick_index) {
    if (interrupted()) return "interrupted";
    tick(sim, world, [&] { observers.add(); });
    if (progress.due()) {
      const double simulated = static_cast<double>(tick_index + 1) * plan.clock.step;
      progress.update(simulated, fmt::format("{:.0f} s simulated, {} agents, {:.1f} x real time",
                                             simulated, sim.scene.size(),
                                             simulated / std::max(seconds_since(start), 1e-6)));
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
  HiddenOutputs hidden(plan);
  if (!common.quiet) print(stderr, "run: reading {}\n", plan.input.network.string());
  for (const NotFollowed& item : plan.inventory.not_followed) spdlog::warn("{}", describe(item));
  const std::unique_ptr<Simulation> sim = make_simulation(plan, common.threads);
  RunResults results;
  const std::unique_ptr<SumoBackend> backend =
      start_backend(plan, sim->model.road, results.backend);
  converted.keep();
  if (!options.connect.empty()) require_no_outputs(*backend, plan);
  settle_begin(backend->time(), plan);
  if (!common.quiet) print(stderr, "run: {}\n", describe(plan));

  SumoWorld world(sim->model, *backend, world_options_of(plan));
  RunObservers observers(plan, *sim, world);
  hidden.keep();

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

  fill_plan(plan, common, results);
  results.duration = simulated;
  observers.fill(results);
  observers.close();
  write_results(options.output / "results.json", results);

  if (!failure.empty())
    throw SumoError("SUMO", failure + "; what ran until then is in " + options.output.string());
  print_results_table(stdout, results);
  if (options.replay) print(stdout, "replay: {}\n", (options.output / "replay.html").string());
  if (results.ended == "interrupted") return kExitInterrupted;
  return failed(options, results) ? kExitNotHeld : kExitDone;
}

}  // namespace sumogamma
