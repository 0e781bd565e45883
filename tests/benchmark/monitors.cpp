#include <benchmark/benchmark.h>

#include "base/random.h"
#include "base/units.h"
#include "study/collisions.h"
#include "study/flow_metrics.h"
#include "study/rule_metrics.h"
#include "study/smoothness_metrics.h"
#include "support/small_net.h"
#include "support/synthetic_traffic.h"

namespace sumogamma {
namespace {

/// 300 agents of all types where about one in three has another within a few metres.
Scene crowd(const AgentTypeTable& types, std::size_t count) {
  Scene scene;
  const double side = 12.0 * std::sqrt(static_cast<double>(count));
  for (std::uint64_t i = 0; i < count; ++i) {
    AgentState agent;
    agent.id = AgentId{static_cast<std::uint32_t>(i)};
    agent.type = static_cast<AgentTypeId>(random_bits(1, i, 0, Draw::Demand) % types.size());
    agent.footprint =
        box_footprint(type_of(types, agent.type).length, type_of(types, agent.type).width);
    agent.position = {random_uniform(1, i, 1, Draw::Demand, 0, side),
                      random_uniform(1, i, 2, Draw::Demand, 0, side)};
    agent.heading = random_uniform(1, i, 3, Draw::Demand, -kPi, kPi);
    agent.speed = 5;
    append_agent(scene, agent);
  }
  return scene;
}

void per_agent(benchmark::State& state, std::size_t count) {
  state.counters["per_agent"] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

void collisions(benchmark::State& state) {
  const AgentTypeTable types = default_agent_types();
  const auto count = static_cast<std::size_t>(state.range(0));
  const Scene scene = crowd(types, count);
  CollisionMonitor monitor(0.05);
  for (auto _ : state) monitor.add(scene, types);
  per_agent(state, count);
}
BENCHMARK(collisions)->Arg(100)->Arg(300)->Arg(3000);

void rules_flow_smoothness(benchmark::State& state) {
  const AgentTypeTable types = default_agent_types();
  const auto count = static_cast<std::size_t>(state.range(0));
  const Scene scene = crowd(types, count);
  const RoadNetwork net = testing::small_net();
  const LaneLocator locator(net);
  RoadState road;
  road.signal_states = {"Gr"};
  Workers workers;
  RuleMonitor rules(0.05, net, locator);
  FlowMonitor flow(0.05, net);
  SmoothnessMonitor smoothness(0.05);
  for (auto _ : state) {
    rules.add(scene, types, road, workers);
    flow.add(scene, types, road, WaitGraph(scene));
    smoothness.add(scene, types);
  }
  per_agent(state, count);
}
BENCHMARK(rules_flow_smoothness)->Arg(100)->Arg(300);

// who is on its lane, as most are; the crowd above is off every road
void rules_on_lanes(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0));
  const RoadNetwork net = testing::small_net();
  const testing::SyntheticTraffic traffic(net, count, 0.05);
  const LaneLocator locator(net);
  Workers workers(static_cast<std::size_t>(state.range(1)));
  RuleMonitor rules(0.05, net, locator);
  for (auto _ : state) rules.add(traffic.scene, traffic.types, traffic.road, workers);
  per_agent(state, count);
}
BENCHMARK(rules_on_lanes)->ArgsProduct({{300, 3000}, {1, 2}})->UseRealTime();

}  // namespace
}  // namespace sumogamma

BENCHMARK_MAIN();
