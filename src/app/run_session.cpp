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
#include "app/run_setup.h"
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
