#include "prediction/report.h"

#include <fmt/format.h>

#include <algorithm>

namespace sumogamma {

namespace {

constexpr PublishedResult kPublished[] = {
    {"eth", "GAMMA (paper, protocol A)", 0.51, 1.08},
    {"eth", "PORCA (paper)", 0.52, 1.09},
    {"eth", "SR-LSTM", 0.63, 1.25},
    {"eth", "STAR", 0.56, 1.11},
    {"eth", "SGAN, average of samples", 0.96, 1.87},
    {"eth", "social force", 0.67, 1.52},
    {"eth", "SGAN, best of 20", 0.81, 1.52},
    {"eth", "SoPhie, best of 20", 0.70, 1.43},
    {"eth", "MATF, best of 20", 1.01, 1.75},
    {"eth", "S-Ways, best of 20", 0.39, 0.64},
    {"eth", "SGCN, best of 20", 0.63, 1.03},
    {"eth", "GAMMA-d (paper), best of 20", 0.30, 0.65},
    {"hotel", "GAMMA (paper, protocol A)", 0.28, 0.59},
    {"hotel", "PORCA (paper)", 0.29, 0.60},
    {"hotel", "SR-LSTM", 0.37, 0.74},
    {"hotel", "STAR", 0.26, 0.50},
    {"hotel", "SGAN, average of samples", 0.61, 1.31},
    {"hotel", "social force", 0.52, 1.03},
    {"hotel", "SGAN, best of 20", 0.72, 1.61},
    {"hotel", "SoPhie, best of 20", 0.76, 1.67},
    {"hotel", "MATF, best of 20", 0.43, 0.80},
    {"hotel", "S-Ways, best of 20", 0.39, 0.66},
    {"hotel", "SGCN, best of 20", 0.32, 0.55},
    {"hotel", "GAMMA-d (paper), best of 20", 0.18, 0.40},
    {"univ", "GAMMA (paper, protocol A)", 0.44, 1.06},
    {"univ", "PORCA (paper)", 0.47, 1.09},
    {"univ", "SR-LSTM", 0.51, 1.10},
    {"univ", "STAR", 0.52, 1.15},
    {"univ", "SGAN, average of samples", 0.57, 1.22},
    {"univ", "social force", 0.74, 1.12},
    {"univ", "SGAN, best of 20", 0.60, 1.26},
    {"univ", "SoPhie, best of 20", 0.54, 1.24},
    {"univ", "MATF, best of 20", 0.44, 0.91},
    {"univ", "S-Ways, best of 20", 0.55, 1.31},
    {"univ", "SGCN, best of 20", 0.37, 0.70},
    {"univ", "GAMMA-d (paper), best of 20", 0.32, 0.79},
    {"zara1", "GAMMA (paper, protocol A)", 0.36, 0.86},
    {"zara1", "PORCA (paper)", 0.37, 0.87},
    {"zara1", "SR-LSTM", 0.41, 0.90},
    {"zara1", "STAR", 0.41, 0.90},
    {"zara1", "SGAN, average of samples", 0.45, 0.98},
    {"zara1", "social force", 0.40, 0.60},
    {"zara1", "SGAN, best of 20", 0.34, 0.69},
    {"zara1", "SoPhie, best of 20", 0.30, 0.63},
    {"zara1", "MATF, best of 20", 0.26, 0.45},
    {"zara1", "S-Ways, best of 20", 0.44, 0.64},
    {"zara1", "SGCN, best of 20", 0.29, 0.53},
    {"zara1", "GAMMA-d (paper), best of 20", 0.24, 0.57},
    {"zara2", "GAMMA (paper, protocol A)", 0.28, 0.68},
    {"zara2", "PORCA (paper)", 0.30, 0.70},
    {"zara2", "SR-LSTM", 0.32, 0.70},
    {"zara2", "STAR", 0.31, 0.71},
    {"zara2", "SGAN, average of samples", 0.39, 0.86},
    {"zara2", "social force", 0.40, 0.68},
    {"zara2", "SGAN, best of 20", 0.42, 0.84},
    {"zara2", "SoPhie, best of 20", 0.38, 0.78},
    {"zara2", "MATF, best of 20", 0.26, 0.57},
    {"zara2", "S-Ways, best of 20", 0.51, 0.92},
    {"zara2", "SGCN, best of 20", 0.25, 0.45},
    {"zara2", "GAMMA-d (paper), best of 20", 0.19, 0.46},
    {"cross", "GAMMA (paper, protocol A)", 0.64, 1.77},
    {"cross", "PORCA (paper)", 0.89, 2.10},
    {"cross", "SR-LSTM", 1.36, 3.17},
    {"cross", "SGAN", 0.93, 2.18},
    {"utown", "GAMMA (paper, protocol A)", 0.32, 0.84},
    {"utown", "PORCA (paper)", 0.34, 0.86},
    {"utown", "SR-LSTM", 0.41, 0.96},
    {"utown", "SGAN", 0.59, 1.43},
};

using Json = nlohmann::ordered_json;

/// Speed bands of the tables [m/s].
struct Band {
  const char* name;
  double low, high;
};
constexpr Band kBands[] = {
    {"under 0.5", 0, 0.5}, {"0.5 to 1.5", 0.5, 1.5}, {"1.5 to 3", 1.5, 3}, {"3 and more", 3, 1e9}};

Json to_json(const Interval& interval) { return Json::array({interval.low, interval.high}); }

Json summary_json(const Summary& summary, bool has_samples) {
  Json json = {{"windows", summary.windows},
               {"ade", summary.average},
               {"fde", summary.final},
               {"miss_rate", summary.miss_rate}};
  if (!has_samples) return json;
  json["min_ade"] = summary.best_average;
  json["min_fde"] = summary.best_final;
  json["negative_log_likelihood"] = summary.log_loss;
  json["energy_score"] = summary.energy;
  json["inside_50"] = summary.inside_50;
  json["inside_90"] = summary.inside_90;
  return json;
}

struct Intervals {
  Interval average, final;
};

Intervals intervals_of(const Evaluation& evaluation, std::uint64_t seed) {
  std::vector<double> average, final;
  std::vector<std::size_t> agent;
  for (const WindowScore& window : evaluation.windows) {
    average.push_back(window.error.average);
    final.push_back(window.error.final);
    agent.push_back(window.track);
  }
  return {bootstrap_mean(average, agent, seed), bootstrap_mean(final, agent, seed)};
}

double microseconds(const Evaluation& evaluation) {
  return evaluation.predictions > 0
             ? 1e6 * evaluation.cpu_seconds / static_cast<double>(evaluation.predictions)
             : 0.0;
}

}  // namespace

std::span<const PublishedResult> published_results() { return kPublished; }

nlohmann::ordered_json to_json(const Evaluation& evaluation, std::uint64_t seed) {
  const AgentTypeTable types = recorded_agent_types();
  Json json = {{"set", evaluation.set}, {"method", evaluation.method}, {"title", evaluation.title}};
  json["memory"] = name_of(evaluation.memory);
  json.update(summary_json(summarize(evaluation), evaluation.has_samples));
  const Intervals intervals = intervals_of(evaluation, seed);
  json["ade_95"] = to_json(intervals.average);
  json["fde_95"] = to_json(intervals.final);
  json["collision_rate"] = evaluation.collisions.rate();
  json["collision_pairs"] = evaluation.collisions.pairs;
  json["true_collision_rate"] = evaluation.true_collisions.rate();
  json["in_training"] = evaluation.in_training;
  json["cpu_us_per_agent_prediction"] = microseconds(evaluation);
  Json by_class = Json::object(), by_speed = Json::object();
  for (std::size_t t = 0; t < types.size(); ++t) {
    const Summary summary = summarize(evaluation, [&](const WindowScore& window) {
      return static_cast<std::size_t>(window.type) == t;
    });
    if (summary.windows > 0)
      by_class[types[t].name] = summary_json(summary, evaluation.has_samples);
  }
  for (const Band& band : kBands) {
    const Summary summary = summarize(evaluation, [&](const WindowScore& window) {
      return window.speed >= band.low && window.speed < band.high;
    });
    if (summary.windows > 0) by_speed[band.name] = summary_json(summary, evaluation.has_samples);
  }
  json["by_class"] = by_class;
  json["by_speed_mps"] = by_speed;
  return json;
}

std::string to_table(const std::vector<Evaluation>& evaluations, const Protocol& protocol,
                     std::uint64_t seed) {
  std::string text = fmt::format(
      "Protocol {}: {} frames seen, {} scored{}. ADE/FDE in m, 95 % intervals by bootstrap over "
      "agents.\n",
      protocol.letter, protocol.observed, protocol.steps,
      protocol.counts_present ? ", the present counted as the first" : "");
  const bool strict = evaluations.empty() || evaluations.front().memory == Memory::Strict;
  text += strict
              ? "Memory: strict. Each window by itself: what is seen of everybody in it, nothing "
                "else. Published rows are of this kind.\n"
              : "Memory: online. The recording so far may teach; rows with \"+ flow\" learn as "
                "sumo-gamma does. No published row is comparable, so none is printed.\n";
  text += "Parameters: one set, chosen on";
  for (const TrainingRecording& recording : training_recordings())
    text += " " + std::string(recording.name);
  text += ".\n";
  std::string set;
  auto published = [&] {
    if (!strict) return;
    for (const PublishedResult& row : published_results()) {
      // the paper's UNIV is both of its recordings together
      const bool both = row.set == "univ" && (set == "univ001" || set == "univ003");
      if (row.set == set || both)
        text += fmt::format("  {:<40} {:7.2f} {:7.2f}   as published{}\n", row.method, row.average,
                            row.final, both ? " for univ001 and univ003 together" : "");
    }
  };
  for (const Evaluation& evaluation : evaluations) {
    if (evaluation.set != set) {
      published();
      set = evaluation.set;
      text += fmt::format(
          "\n{}, {}: {} windows, COL of the truth {:.4f}, parameters chosen {} it\n", set,
          name_of(evaluation.memory), evaluation.windows.size(), evaluation.true_collisions.rate(),
          evaluation.in_training ? "with" : "without");
      text += fmt::format("  {:<40} {:>7} {:>7} {:>15} {:>6} {:>7} {:>8}", "", "ADE", "FDE",
                          "ADE 95 %", "miss", "COL", "us/pred");
      if (evaluation.has_samples) text += "   minADE  minFDE     NLL  energy  in 50  in 90";
      text += "\n";
    }
    const Summary summary = summarize(evaluation);
    const Interval average = intervals_of(evaluation, seed).average;
    text += fmt::format("  {:<40} {:7.4f} {:7.4f} [{:.3f}, {:.3f}] {:6.3f} {:7.4f} {:8.1f}",
                        evaluation.title, summary.average, summary.final, average.low, average.high,
                        summary.miss_rate, evaluation.collisions.rate(), microseconds(evaluation));
    if (evaluation.method == "oracle")
      text += fmt::format("  {:7.4f} {:7.4f}", summary.best_average, summary.best_final);
    else if (evaluation.has_samples)
      text += fmt::format("  {:7.4f} {:7.4f} {:7.3f} {:7.4f} {:6.3f} {:6.3f}", summary.best_average,
                          summary.best_final, summary.log_loss, summary.energy, summary.inside_50,
                          summary.inside_90);
    text += "\n";
  }
  published();
  return text;
}

}  // namespace sumogamma
