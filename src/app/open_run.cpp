#include "app/open_run.h"

#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <utility>

#include "app/run_setup.h"
#include "base/error.h"
#include "base/print.h"
#include "sumo/net_conversion.h"

namespace sumogamma {

namespace {

double cpu_of(int who) {
  rusage usage{};
  getrusage(who, &usage);
  auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
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

}  // namespace

ConvertedNetwork::~ConvertedNetwork() {
  std::error_code ignored;
  if (!file_.empty()) std::filesystem::remove(file_, ignored);
}

void ConvertedNetwork::make(RunPlan& plan) {
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

OpenRun::OpenRun(const RunOptions& options, const CommonOptions& common_options)
    : common(common_options), plan(make_plan(options, common)) {
  const bool writes = !options.output.empty();
  if (writes) {
    folder_.emplace(options.output, options.force);
  } else if (options.convert || options.replay || options.serve) {
    throw Error(options.convert  ? "--convert"
                : options.replay ? "--replay"
                                 : "--serve",
                "needs an output folder, give -o");
  } else if (!plan.inventory.outputs.empty() && !plan.options.joins()) {
    const AskedOutput& first = plan.inventory.outputs.front();
    throw Error(first.source, first.what +
                                  ": needs an output folder, give -o: SUMO alone writes it wrongly "
                                  "for who GAMMA drives");
  }
  if (plan.options.serve) {
    page.emplace(*plan.options.serve);
    print(stderr, "run: shown at {}\n", page->address());
  }
  converted_.make(plan);
  if (writes) hidden_.emplace(plan);
  if (!common.quiet) print(stderr, "run: reading {}\n", plan.input.network.string());
  for (const NotFollowed& item : plan.inventory.not_followed) spdlog::warn("{}", describe(item));
  sim = make_simulation(plan, common.threads);
  backend = start_backend(plan, sim->model.road, backend_name_);
  converted_.keep();
  if (plan.options.joins()) require_no_outputs(*backend, plan);
  settle_begin(backend->time(), plan);
  if (!common.quiet) print(stderr, "run: {}\n", describe(plan));
  world.emplace(sim->model, *backend, world_options_of(plan));
  if (writes) {
    observers.emplace(plan, *sim, *world, *backend, page ? &*page : nullptr);
    hidden_->keep();
  }
  start_ = std::chrono::steady_clock::now();
  cpu_start_ = cpu_of(RUSAGE_SELF);
}

RunResults OpenRun::finish(const std::string& ended, const std::string& failure) {
  RunResults results;
  results.ended = ended;
  results.backend = backend_name_;
  const double simulated = static_cast<double>(sim->scene.tick) * plan.clock.step;
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
  fill_timing(sim->times, wall.count(), simulated, results.timing);
  results.sumo_version = backend->version();
  for (const std::string& warning : backend->take_warnings()) spdlog::info("{}", warning);
  results.sumo_warnings = static_cast<std::uint64_t>(std::max(backend->sumo_warnings(), 0L));
  try {
    backend->close();
  } catch (const std::exception& error) {
    if (failure.empty()) spdlog::warn("{}", error.what());
  }
  results.timing.cpu_s = cpu_of(RUSAGE_SELF) - cpu_start_ + cpu_of(RUSAGE_CHILDREN);
  fill_plan(plan, common, results);
  results.duration = simulated;
  if (!observers) return results;
  observers->fill(results);
  observers->close();
  page.reset();
  write_results(plan.options.output / "results.json", results);
  return results;
}

}  // namespace sumogamma
