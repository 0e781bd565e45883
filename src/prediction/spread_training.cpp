#include "prediction/spread_training.h"

#include <fmt/format.h>

#include <cmath>

#include "prediction/gamma_predictor.h"

namespace sumogamma {

namespace {

void write_header(std::ostream& out) {
  out << "set,kind,band,own,mixture,speed";
  for (std::size_t band = 0; band < kSpreadBands; ++band) out << ",sum" << band << ",count" << band;
  for (std::size_t k = 1; k <= kSpreadSteps; ++k) out << ",along" << k << ",across" << k;
  out << '\n';
}

/// A scene whose agents are predicted, and what it tells.
struct Shown {
  TrackSet window;
  ObservedScene scene;
  Forecast forecast;
  std::vector<SpreadClues> clues;
  SceneUnsteadiness sums;
};

void write_row(std::ostream& out, const TrackSet& truth, const Window& asked, const Shown& shown,
               const GammaPredictor& predictor) {
  const Track& track = truth.tracks[asked.track];
  std::size_t row = 0;
  while (shown.scene.agents[row].id != track.id) ++row;
  const SpreadClues& clue = shown.clues[row];
  fmt::memory_buffer line;
  auto to = std::back_inserter(line);
  fmt::format_to(to, "{},{},{},{:.6g},{:.6g},{:.6g}", truth.name, clue.kind, clue.band,
                 std::log(unsteadiness(shown.scene.agents[row])), clue.mixture, clue.speed);
  for (std::size_t band = 0; band < kSpreadBands; ++band)
    fmt::format_to(to, ",{:.6g},{:.6g}", shown.sums.sum[clue.kind][band],
                   shown.sums.count[clue.kind][band]);
  const Vec2 forward = predictor.forward_of(row);
  const auto now = static_cast<std::size_t>(asked.frame - track.first);
  for (std::size_t k = 0; k < kSpreadSteps; ++k) {
    const Vec2 error = track.position[now + 1 + k] - shown.forecast.row(row)[k];
    fmt::format_to(to, ",{:.6g},{:.6g}", error.dot(forward), cross(forward, error));
  }
  out << fmt::to_string(line) << '\n';
}

}  // namespace

void write_spread_rows(std::ostream& out, const TrackSet& seen, const TrackSet& truth,
                       const PredictorParameters& parameters, bool header) {
  const AgentTypeTable types = recorded_agent_types();
  const Protocol protocol = protocol_from_letter("C");
  if (header) write_header(out);
  GammaPredictor predictor(types, parameters, {}, seen.period, seen.obstacles);
  int last = seen.first_frame - 1;
  Shown shown;
  for (const Window& asked : windows_of(seen, protocol)) {
    if (asked.frame != last) {
      last = asked.frame;
      shown.window = window_of(seen, last - protocol.observed + 1, last);
      predictor.forget();
      for (int frame = shown.window.first_frame; frame <= last; ++frame)
        predictor.observe(observe(shown.window, frame));
      shown.scene = observe(shown.window, last);
      shown.forecast = predictor.forecast(kSpreadSteps);
      shown.clues = spread_clues(types, shown.scene, &shown.sums);
    }
    write_row(out, truth, asked, shown, predictor);
  }
}

}  // namespace sumogamma
