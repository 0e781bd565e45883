// What a newcomer's path and places on it cost: a route of 10 km with a vertex every few metres.
#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "base/random.h"
#include "road/smoothing.h"
#include "road/speed_profile.h"

namespace sumogamma {
namespace {

/// A path of that length [m]: streets of 100 m that turn into one another, drawn with kinks.
Path raw_path(double length) {
  std::vector<Vec2> points{Vec2::Zero()};
  Vec2 forward(1, 0);
  double along = 0.0;
  for (std::uint64_t i = 1; along < length; ++i) {
    const double piece = random_uniform(1, i, 0, Draw::ProcessNoise, 5.0, 40.0);
    const double turn = i % 5 == 0 ? random_uniform(1, i, 1, Draw::ProcessNoise, -1.5, 1.5)
                                   : random_uniform(1, i, 1, Draw::ProcessNoise, -0.05, 0.05);
    forward = from_body({std::cos(turn), std::sin(turn)}, forward);
    points.push_back(points.back() + piece * forward);
    along += piece;
  }
  Path path;
  path.line = Polyline(points);
  path.arrival = path.line.length();
  PathStretch stretch;
  stretch.to = path.arrival;
  stretch.speed_limit = 13.9;
  path.stretches.push_back(stretch);
  return path;
}

void smooth_a_path(benchmark::State& state) {
  const Path raw = raw_path(static_cast<double>(state.range(0)));
  PathRequest request;
  request.cornering = {3.8, 4.5, 1.8};
  std::size_t bytes = 0;
  for (auto _ : state) {
    const std::size_t before = mallinfo2().uordblks;
    Path path = raw;
    round_corners(request.cornering, path);
    compute_speed_profile(request, path);
    benchmark::DoNotOptimize(path);
    bytes = mallinfo2().uordblks - before;
  }
  state.counters["bytes"] = static_cast<double>(bytes);  // that its agent keeps
}
BENCHMARK(smooth_a_path)->Arg(1000)->Arg(10000)->Unit(benchmark::kMicrosecond);

void project_onto_a_path(benchmark::State& state) {
  Path path = raw_path(10000.0);
  round_corners({3.8, 4.5, 1.8}, path);
  double along = 0.0;
  for (auto _ : state) {
    along = along > 9000.0 ? 0.0 : along + 37.0;
    const Vec2 beside = path.line.point_at(along) + Vec2(1, 1);
    benchmark::DoNotOptimize(path.line.project(beside, along - 20.0, along + 60.0));
  }
}
BENCHMARK(project_onto_a_path);

}  // namespace
}  // namespace sumogamma

BENCHMARK_MAIN();
