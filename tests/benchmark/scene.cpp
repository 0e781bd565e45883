// Cost of the model on the scenes that the tests use, made in code, so that it runs anywhere.
#include <benchmark/benchmark.h>

#include "geometry/half_plane_program.h"
#include "model/gamma_velocity.h"
#include "support/made_scenes.h"

namespace sumogamma {
namespace {

Model model_for(const SceneFile& file) {
  Model model;
  Workers workers(2);
  model.types = file.types;
  model.kinematics = build_kinematic_tables(file.types, workers);
  return model;
}

/// A tick without the moving: preparation, velocities, tracking. Items are agent-steps.
void run_ticks(benchmark::State& state, double area) {
  const SceneFile file = test::mixed_scene(1, static_cast<int>(state.range(0)), area);
  const Model model = model_for(file);
  Workers workers(1);
  Scene scene = file.scene;
  TickGeometry geometry;
  Workspace work;
  std::vector<BodyState> next(scene.size());
  for (auto _ : state) {
    prepare_tick(model, scene, workers, geometry);
    for (std::size_t row = 0; row < scene.size(); ++row) {
      const Vec2 velocity = gamma_velocity(model, scene, geometry, row, scene.behavior[row], work);
      next[row] = next_body(model, scene, row, velocity, 0.05, work);
    }
    state.PauseTiming();
    for (std::size_t row = 0; row < scene.size(); ++row) place_body(next[row], scene, row);
    // for ever in the dense phase: back to the start every ten seconds
    if (++scene.tick == 200) scene = file.scene;
    state.ResumeTiming();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scene.size()));
}

void dense(benchmark::State& state) { run_ticks(state, 28); }
void sparse(benchmark::State& state) { run_ticks(state, 112); }
BENCHMARK(dense)->Arg(300)->Arg(1000)->Arg(3000);
BENCHMARK(sparse)->Arg(1000);

void solver(benchmark::State& state) {
  std::vector<HalfPlane> planes;
  for (int k = 0; k < 12; ++k) {
    const Vec2 normal =
        direction_of(random_uniform(1, static_cast<std::uint64_t>(k), 0, Draw::Demand, -kPi, kPi));
    planes.push_back(
        {random_uniform(1, static_cast<std::uint64_t>(k), 1, Draw::Demand, -3, 0.3) * normal,
         normal});
  }
  ProgramScratch scratch;
  for (auto _ : state) benchmark::DoNotOptimize(closest_point(planes, 0, Vec2(4, 1), 5, scratch));
}
BENCHMARK(solver);

void kinematic_tables(benchmark::State& state) {
  const AgentTypeTable types = default_agent_types();
  Workers workers(1);
  for (auto _ : state) benchmark::DoNotOptimize(build_kinematic_tables(types, workers));
}
BENCHMARK(kinematic_tables)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sumogamma

BENCHMARK_MAIN();
