#include "app/run_setup.h"

#include <spdlog/spdlog.h>

#include <charconv>
#include <cstdlib>
#include <utility>

#include "base/error.h"
#include "base/print.h"
#include "model/kinematic_set.h"
#include "osm/obstacles.h"
#include "road/road.h"
#include "road/sumo_net_reader.h"
#include "sumo/connect_check.h"
#include "sumo/net_conversion.h"
#include "sumo/sumo_arguments.h"

namespace sumogamma {

namespace {

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
  // SUMO counts those whom we keep waiting as well
  if (!plan.control.takes_newcomers() && plan.vehicles > 0)
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

}  // namespace

std::unique_ptr<Simulation> make_simulation(const RunPlan& plan, unsigned threads) {
  auto sim = std::make_unique<Simulation>();
  sim->dt = plan.clock.step;
  sim->workers = std::make_unique<Workers>(threads);
  sim->model.types = plan.config.types;
  sim->model.options = plan.config.model;
  sim->rules = keeps_rules(plan.config.preset);
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
  start.signals_by_schedule =
      !plan.inventory.switches_programs && !plan.options.gui && !plan.options.own_loop;
  start.on_listening = [&](int port) {
    if (plan.options.clients > 1)
      print(stderr, "run: SUMO waits at 127.0.0.1:{} for {} more TraCI client{}\n", port,
            plan.options.clients - 1, plan.options.clients > 2 ? "s" : "");
  };
  start.socket = plan.options.socket;
  const bool connects = !plan.options.connect.empty();
  if (connects) set_host_and_port(plan.options.connect, start);
  name = plan.options.socket >= 0 ? "traci" : plan.options.backend.value_or(plan.config.backend);
  std::unique_ptr<SumoBackend> backend;
  try {
    backend = name == "libsumo" ? start_libsumo_backend(start) : start_traci_backend(start);
  } catch (const SumoError&) {
    throw;
  } catch (const Error& error) {
    explain_refusal(plan, error);
  }
  if (!plan.options.joins()) return backend;
  const std::string where = connects ? "--connect " + plan.options.connect : "attached SUMO";
  ConnectExpectation expected{where, &plan.input, &network, plan.clock.step, {}};
  if (connects && !plan.input.options.contains("load-state")) expected.begin = plan.clock.begin;
  require_same_run(*backend, expected);
  return backend;
}

SumoWorldOptions world_options_of(const RunPlan& plan) {
  SumoWorldOptions options;
  options.control = plan.control;
  options.max_vehicles = plan.control.takes_newcomers() ? plan.vehicles : 0;
  options.seed = plan.clock.seed;
  options.dt = plan.clock.step;
  options.rerouter_edges = plan.inventory.rerouter_edges;
  options.sign_lanes = plan.inventory.sign_lanes;
  options.depart_speeds = plan.inventory.depart_speeds;
  options.others_steer = plan.options.joins() || plan.options.clients > 1;
  for (const auto& [key, where] : plan.config.given)
    if (key.rfind("types.", 0) == 0) options.type_keys.insert(key);
  return options;
}

}  // namespace sumogamma
