// Cost of the coupling alone: poses in, one SUMO step, everything a tick needs out. No GAMMA in
// here. Wall and CPU time of this process and of SUMO's together, per agent and step, stand in the
// counters.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "sumo/backend.h"
#include "sumo/sumo_arguments.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

// a grid of 10 x 10 signalled junctions; vehicles and persons spread over all its edges, all
// wanting to depart at once
class Crowd {
 public:
  explicit Crowd(int agents) {
    ProcessRequest request;
    request.arguments = {"netgenerate",
                         "--grid",
                         "--grid.number",
                         "10",
                         "--grid.length",
                         "200",
                         "--default.lanenumber",
                         "2",
                         "--sidewalks.guess",
                         "--crossings.guess",
                         "--default-junction-type",
                         "traffic_light",
                         "-o",
                         folder_.file("net.net.xml")};
    if (!run_process(request).ok()) throw std::runtime_error("netgenerate failed");
    std::ofstream routes(folder_.file("routes.rou.xml"));
    routes << "<routes>\n";
    for (int i = 0; i < agents; ++i) {
      const std::string from = junction(i % 9, i / 9 % 10), to = junction(i % 9 + 1, i / 9 % 10),
                        third =
                            junction(i % 9 + 1, (i / 9 % 10 + 1) % 10 == 0 ? 8 : i / 9 % 10 + 1);
      routes << "<vehicle id=\"vehicle" << i
             << "\" depart=\"0\" departPos=\"free\" departLane=\"random\"><route edges=\"" << from
             << to << " " << to << third << "\"/></vehicle>\n";
    }
    routes << "</routes>\n";
    routes.close();
    folder_.write("scenario.sumocfg",
                  "<configuration><input><net-file value=\"net.net.xml\"/><route-files "
                  "value=\"routes.rou.xml\"/></input></configuration>");
  }
  std::unique_ptr<SumoBackend> start(bool in_process) const {
    SumoArguments wish;
    wish.config = folder_.file("scenario.sumocfg");
    SumoStart request;
    request.arguments = sumo_arguments(wish);
    return in_process ? start_libsumo_backend(request) : start_traci_backend(request);
  }

 private:
  static std::string junction(int column, int row) {
    return std::string(1, static_cast<char>('A' + column)) + std::to_string(row);
  }
  TemporaryFolder folder_;
};

// CPU seconds of this process
double own_cpu() {
  rusage self{};
  getrusage(RUSAGE_SELF, &self);
  return static_cast<double>(self.ru_utime.tv_sec + self.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(self.ru_utime.tv_usec + self.ru_stime.tv_usec);
}
// of the SUMO that runs as our child; nothing where it runs in process
double child_cpu() {
  std::ifstream children("/proc/self/task/" + std::to_string(getpid()) + "/children");
  double seconds = 0;
  for (std::string pid; children >> pid;) {
    std::ifstream statistics("/proc/" + pid + "/schedstat");
    double nanoseconds = 0;
    statistics >> nanoseconds;
    seconds += 1e-9 * nanoseconds;
  }
  return seconds;
}

struct Fleet {
  std::vector<std::string> ids;
  std::vector<SumoPose> poses;
};

void move(Fleet& fleet, int tick) {
  fleet.poses.resize(fleet.ids.size());
  for (std::size_t i = 0; i < fleet.ids.size(); ++i) {
    const double turn = 0.01 * tick + 0.1 * static_cast<double>(i);
    fleet.poses[i] = {&fleet.ids[i],
                      Vec2(900 + 800 * std::cos(turn * 0.1), 900 + 800 * std::sin(turn * 0.1)),
                      turn};
  }
}

// takes vehicles over as they depart until `wanted` are held
void gather(SumoBackend& sumo, Fleet& fleet, std::size_t wanted) {
  SumoStep step;
  for (int tick = 0; fleet.ids.size() < wanted && tick < 5000; ++tick) {
    move(fleet, tick);
    sumo.step(fleet.poses, {}, step);
    fleet.ids.insert(fleet.ids.end(), step.departed_vehicles.begin(), step.departed_vehicles.end());
  }
}

// range(0): in process; range(1): ghosts; range(2): 1 watches all of them too
void ghosts(benchmark::State& state) {
  const auto wanted = static_cast<std::size_t>(state.range(1));
  const Crowd crowd(static_cast<int>(wanted));
  auto sumo = crowd.start(state.range(0) != 0);
  Fleet fleet;
  gather(*sumo, fleet, wanted);
  if (fleet.ids.size() < wanted) state.SkipWithError("not all vehicles departed");
  if (state.range(2) != 0)
    for (const std::string& id : fleet.ids) sumo->watch(id, false);
  SumoStep step;
  int tick = 0;
  const double own = own_cpu(), child = child_cpu();
  for (auto _ : state) {
    move(fleet, ++tick);
    sumo->step(fleet.poses, {}, step);
    if (!step.lost.empty()) state.SkipWithError("a ghost was lost");
  }
  const double agent_steps = static_cast<double>(state.iterations()) * static_cast<double>(wanted);
  state.counters["own_cpu_us"] = (own_cpu() - own) * 1e6 / agent_steps;
  state.counters["sumo_cpu_us"] = (child_cpu() - child) * 1e6 / agent_steps;
}

// the baseline: SUMO drives, every agent is watched
void watched(benchmark::State& state) {
  const auto wanted = static_cast<std::size_t>(state.range(1));
  const Crowd crowd(static_cast<int>(wanted));
  auto sumo = crowd.start(state.range(0) != 0);
  SumoStep step;
  std::size_t alive = 0;
  for (int tick = 0; tick < 200 && alive < wanted; ++tick) {
    sumo->step({}, {}, step);
    for (const std::string& id : step.departed_vehicles)
      if (state.range(2) != 0) sumo->watch(id, false);
    alive += step.departed_vehicles.size();
    alive -= step.arrived_vehicles.size();
  }
  double agent_steps = 0;
  const double own = own_cpu(), child = child_cpu();
  for (auto _ : state) {
    sumo->step({}, {}, step);
    for (const std::string& id : step.departed_vehicles)
      if (state.range(2) != 0) sumo->watch(id, false);
    alive += step.departed_vehicles.size();
    alive -= step.arrived_vehicles.size();
    agent_steps += static_cast<double>(alive);
  }
  state.counters["alive"] = static_cast<double>(alive);
  state.counters["own_cpu_us"] = (own_cpu() - own) * 1e6 / agent_steps;
  state.counters["sumo_cpu_us"] = (child_cpu() - child) * 1e6 / agent_steps;
}

BENCHMARK(ghosts)
    ->ArgNames({"libsumo", "ghosts", "watched"})
    ->ArgsProduct({{0, 1}, {100, 1000, 5000}, {0, 1}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(watched)
    ->ArgNames({"libsumo", "vehicles", "watched"})
    ->ArgsProduct({{0, 1}, {100, 1000}, {0, 1}})
    ->Iterations(200)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sumogamma

BENCHMARK_MAIN();
