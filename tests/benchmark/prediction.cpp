// Cost of a prediction, belief included, on a made scene of walkers that cross: ns per
// agent-prediction.
#include <benchmark/benchmark.h>

#include "prediction/gamma_predictor.h"

namespace {

using namespace sumogamma;

TrackSet crossing_walkers(int agents) {
  TrackSet set;
  for (int a = 0; a < agents; ++a) {
    Track track{static_cast<std::uint32_t>(a), {}, 0, {}, {}};
    const Vec2 velocity = direction_of(2.4 * a);
    const Vec2 start(1.7 * (a % 9), 1.7 * (a / 9));
    for (int k = 0; k < 40; ++k) {
      track.position.push_back(start + 0.4 * k * velocity);
      track.heading.push_back(heading_of(velocity));
    }
    set.tracks.push_back(std::move(track));
  }
  set.last_frame = 39;
  return set;
}

void predict(benchmark::State& state) {
  const TrackSet set = crossing_walkers(static_cast<int>(state.range(0)));
  std::int64_t predictions = 0;
  for (auto _ : state) {
    GammaPredictor predictor(recorded_agent_types(), default_predictor_parameters(), {}, 0.4);
    for (int frame = 0; frame < 40; ++frame) {
      predictor.observe(observe(set, frame));
      benchmark::DoNotOptimize(predictor.forecast(12));
      predictions += state.range(0);
    }
  }
  state.counters["us_per_prediction"] =
      benchmark::Counter(static_cast<double>(predictions) * 1e-6,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(predict)->Arg(9)->Arg(36)->Arg(144)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
