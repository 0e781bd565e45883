#include "app/run_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "app/open_run.h"
#include "app/progress.h"
#include "base/error.h"
#include "base/print.h"

namespace sumogamma {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
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

/// Keeps steps apart where a window shows them: SUMO's own delay isn't heeded while clients make
/// its steps. Who is late isn't hurried afterwards.
class Pace {
 public:
  explicit Pace(double delay)
      : delay_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(delay))) {}
  void wait() {
    constexpr std::chrono::milliseconds kSlice{100};  // a user's Ctrl-C is heeded after that
    while (Clock::now() < next_ && !interrupted())
      std::this_thread::sleep_until(std::min(next_, Clock::now() + kSlice));
    next_ = std::max(next_ + delay_, Clock::now());
  }

 private:
  Clock::duration delay_;
  Clock::time_point next_ = Clock::now();
};

/// Ticks until the duration is over, the user interrupts, or nothing is left. Returns how it ended.
std::string run_ticks(OpenRun& run) {
  const RunPlan& plan = run.plan;
  const double duration = plan.clock.end - plan.clock.begin;
  Progress progress("run", duration, "s", run.common.quiet);
  const auto ticks = static_cast<std::int64_t>(std::llround(duration / plan.clock.step));
  const Clock::time_point start = Clock::now();
  Pace pace(plan.delay);
  for (std::int64_t tick_index = 0; tick_index < ticks; ++tick_index) {
    if (plan.delay > 0.0) pace.wait();
    if (interrupted()) return "interrupted";
    tick(
        *run.sim, *run.world, [&] { run.observers->add(); }, [&] { run.observers->look(); });
    if (progress.due()) {
      const double simulated = static_cast<double>(tick_index + 1) * plan.clock.step;
      progress.update(simulated, fmt::format("{:.0f} s simulated, {} agents, {:.1f} x real time",
                                             simulated, run.sim->scene.size(),
                                             simulated / std::max(seconds_since(start), 1e-6)));
    }
    if (run.world->finished()) break;
  }
  return "done";
}

}  // namespace

int run_session(const RunOptions& options, const CommonOptions& common) {
  OpenRun run(options, common);
  std::string ended, failure;
  try {
    ended = run_ticks(run);
  } catch (const SumoError& error) {
    failure = error.what();
    ended = "SUMO failed";
  }
  const RunResults results = run.finish(ended, failure);
  if (!failure.empty())
    throw SumoError("SUMO", failure + "; what ran until then is in " + options.output.string());
  print_results_table(common.out, results);
  if (options.replay) print(common.out, "replay: {}\n", (options.output / "replay.html").string());
  if (results.ended == "interrupted") return kExitInterrupted;
  return failed(options, results) ? kExitNotHeld : kExitDone;
}

}  // namespace sumogamma
