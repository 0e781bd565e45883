#include "prediction/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

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

/// The simple baselines of docs/prediction.md, which need neither model nor memory.
bool is_simple(const Evaluation& evaluation) {
  constexpr std::string_view kSimple[] = {"cv", "mean", "kalman", "ca", "ctra"};
  return std::find(std::begin(kSimple), std::end(kSimple), evaluation.method) != std::end(kSimple);
}

/// What an evaluation is compared with window by window: the simple baseline of the same recording
/// with the least average error, null where there is none or it is the same.
const Evaluation* best_simple(const Evaluation& evaluation,
                              const std::vector<Evaluation>& evaluations) {
  const Evaluation* best = nullptr;
  double least = 0;
  for (const Evaluation& other : evaluations) {
    if (other.set != evaluation.set || !is_simple(other) ||
        other.windows.size() != evaluation.windows.size())
      continue;
    const double error = summarize(other).average;
    if (best == nullptr || error < least) {
      best = &other;
      least = error;
    }
  }
  return best == &evaluation ? nullptr : best;
}

/// What gamma with a map is compared with: the same without, where both were run.
const Evaluation* without_map(const Evaluation& evaluation,
                              const std::vector<Evaluation>& evaluations) {
  if (evaluation.method != "gamma") return nullptr;
  for (const Evaluation& other : evaluations)
    if (other.set == evaluation.set && other.method == kWithoutMap) return &other;
  return nullptr;
}

/// Differences to another evaluation of the same windows, bootstrapped over agents.
Intervals paired_intervals(const Evaluation& evaluation, const Evaluation& other,
                           std::uint64_t seed) {
  std::vector<double> average, final;
  std::vector<std::size_t> agent;
  for (std::size_t k = 0; k < evaluation.windows.size(); ++k) {
    average.push_back(evaluation.windows[k].error.average - other.windows[k].error.average);
    final.push_back(evaluation.windows[k].error.final - other.windows[k].error.final);
    agent.push_back(evaluation.windows[k].track);
  }
  return {bootstrap_mean(average, agent, seed), bootstrap_mean(final, agent, seed)};
}

Json against_json(const Evaluation& evaluation, const Evaluation& other, std::uint64_t seed) {
  const Intervals paired = paired_intervals(evaluation, other, seed);
  return {{"method", other.method},
          {"ade", paired.average.mean},
          {"ade_95", to_json(paired.average)},
          {"fde", paired.final.mean},
          {"fde_95", to_json(paired.final)}};
}

/// Windows of a class and a speed band, where there are any.
struct Stratum {
  std::string type;
  std::string_view band;
  std::size_t windows = 0;
  std::vector<PointScore> steps;
};

std::vector<Stratum> strata_of(const Evaluation& evaluation) {
  const AgentTypeTable types = recorded_agent_types();
  std::vector<Stratum> strata;
  for (std::size_t t = 0; t < types.size(); ++t)
    for (const Band& band : kBands) {
      const auto inside = [&](const WindowScore& window) {
        return static_cast<std::size_t>(window.type) == t && window.speed >= band.low &&
               window.speed < band.high;
      };
      Stratum stratum{types[t].name, band.name, 0, summarize_steps(evaluation, inside)};
      stratum.windows = summarize(evaluation, inside).windows;
      if (!stratum.steps.empty()) strata.push_back(std::move(stratum));
    }
  return strata;
}

Json calibration_json(const Evaluation& evaluation) {
  Json all = Json::array();
  for (const Stratum& stratum : strata_of(evaluation)) {
    Json json = {
        {"class", stratum.type}, {"speed_mps", stratum.band}, {"windows", stratum.windows}};
    for (const PointScore& step : stratum.steps) {
      json["inside_50"].push_back(step.inside_50);
      json["inside_90"].push_back(step.inside_90);
      json["negative_log_likelihood"].push_back(step.log_loss);
      json["energy_score"].push_back(step.energy);
    }
    all.push_back(std::move(json));
  }
  return all;
}

double microseconds(const Evaluation& evaluation) {
  return evaluation.predictions > 0
             ? 1e6 * evaluation.cpu_seconds / static_cast<double>(evaluation.predictions)
             : 0.0;
}

}  // namespace

std::span<const PublishedResult> published_results() { return kPublished; }

nlohmann::ordered_json to_json(const Evaluation& evaluation,
                               const std::vector<Evaluation>& evaluations, std::uint64_t seed) {
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
  if (const Evaluation* other = best_simple(evaluation, evaluations))
    json["against"] = against_json(evaluation, *other, seed);
  if (const Evaluation* other = without_map(evaluation, evaluations))
    json["against_without_map"] = against_json(evaluation, *other, seed);
  if (evaluation.has_samples) {
    json["draws"] = evaluation.draws;
    json["sample_collision_rate"] = evaluation.sample_collisions.rate();
    json["calibration"] = calibration_json(evaluation);
  }
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

namespace {

/// What a table says once, above all rows.
std::string preamble(const Protocol& protocol, bool strict) {
  std::string text = fmt::format(
      "Protocol {}: {} frames seen, {} scored{}. ADE/FDE in m, 95 % intervals by bootstrap over "
      "agents.\n",
      protocol.letter, protocol.observed, protocol.steps,
      protocol.counts_present ? ", the present counted as the first" : "");
  text += strict
              ? "Memory: strict. Each window by itself: what is seen of everybody in it, nothing "
                "else. Published rows are of this kind.\n"
              : "Memory: online. The recording so far may teach; rows with \"+ flow\" learn as "
                "sumo-gamma does. No published row is comparable, so none is printed.\n";
  text += "Parameters: one set, chosen on";
  for (const TrainingRecording& recording : training_recordings())
    text += " " + std::string(recording.name);
  return text +
         ".\nagainst: ADE less that of the best simple baseline printed (cv, mean, kalman, ca, "
         "ctra), window by window.\n";
}

/// Published rows for a recording.
std::string published_rows(std::string_view set) {
  std::string text;
  for (const PublishedResult& row : published_results()) {
    // the paper's UNIV is both of its recordings together
    const bool both = row.set == "univ" && (set == "univ001" || set == "univ003");
    if (row.set == set || both)
      text += fmt::format("  {:<40} {:7.2f} {:7.2f}   as published{}\n", row.method, row.average,
                          row.final, both ? " for univ001 and univ003 together" : "");
  }
  return text;
}

std::string head_of(const Evaluation& evaluation, bool has_samples) {
  std::string text =
      fmt::format("\n{}, {}: {} windows, COL of the truth {:.4f}, parameters chosen {} it\n",
                  evaluation.set, name_of(evaluation.memory), evaluation.windows.size(),
                  evaluation.true_collisions.rate(), evaluation.in_training ? "with" : "without");
  text += fmt::format("  {:<40} {:>7} {:>7} {:>15} {:>6} {:>7} {:>8} {:>24}", "", "ADE", "FDE",
                      "ADE 95 %", "miss", "COL", "us/pred", "against");
  if (has_samples)
    text += fmt::format(" {:>11} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6} {:>7}", "draws", "minADE",
                        "minFDE", "NLL", "energy", "in 50", "in 90", "COL");
  return text + "\n";
}

std::string row_of(const Evaluation& evaluation, const Evaluation* other, std::uint64_t seed) {
  const Summary summary = summarize(evaluation);
  const Interval average = intervals_of(evaluation, seed).average;
  std::string against;
  if (other != nullptr) {
    const Interval paired = paired_intervals(evaluation, *other, seed).average;
    against = fmt::format("{:+.3f} [{:+.3f}, {:+.3f}]", paired.mean, paired.low, paired.high);
  }
  std::string text = fmt::format(
      "  {:<40} {:7.4f} {:7.4f} [{:.3f}, {:.3f}] {:6.3f} {:7.4f} {:8.1f} {:>24}", evaluation.title,
      summary.average, summary.final, average.low, average.high, summary.miss_rate,
      evaluation.collisions.rate(), microseconds(evaluation), against);
  if (evaluation.has_samples) {
    text += fmt::format(" {:>11} {:7.4f} {:7.4f}", evaluation.draws, summary.best_average,
                        summary.best_final);
    if (evaluation.method != "oracle")
      text +=
          fmt::format(" {:7.3f} {:7.4f} {:6.3f} {:6.3f} {:7.4f}", summary.log_loss, summary.energy,
                      summary.inside_50, summary.inside_90, evaluation.sample_collisions.rate());
  }
  return text + "\n";
}

/// What the map is worth.
std::string map_row(const Evaluation& evaluation, const Evaluation& other, std::uint64_t seed) {
  const Intervals paired = paired_intervals(evaluation, other, seed);
  return fmt::format(
      "  with the map less without it: ADE {:+.3f} [{:+.3f}, {:+.3f}], FDE {:+.3f} [{:+.3f}, "
      "{:+.3f}]\n",
      paired.average.mean, paired.average.low, paired.average.high, paired.final.mean,
      paired.final.low, paired.final.high);
}

}  // namespace

std::string to_table(const std::vector<Evaluation>& evaluations, const Protocol& protocol,
                     std::uint64_t seed) {
  const bool strict = evaluations.empty() || evaluations.front().memory == Memory::Strict;
  const bool has_samples =
      std::any_of(evaluations.begin(), evaluations.end(),
                  [](const Evaluation& evaluation) { return evaluation.has_samples; });
  std::string text = preamble(protocol, strict), set;
  for (const Evaluation& evaluation : evaluations) {
    if (evaluation.set != set) {
      if (strict) text += published_rows(set);
      set = evaluation.set;
      text += head_of(evaluation, has_samples);
    }
    text += row_of(evaluation, best_simple(evaluation, evaluations), seed);
    if (const Evaluation* other = without_map(evaluation, evaluations))
      text += map_row(evaluation, *other, seed);
  }
  return strict ? text + published_rows(set) : text;
}

std::string calibration_table(const std::vector<Evaluation>& evaluations) {
  std::string text =
      "\nCalibration: of a hundred truths, how many lie in the 50 and in the 90 % region at each "
      "step.\n";
  for (const Evaluation& evaluation : evaluations) {
    if (!evaluation.has_samples || evaluation.method == "oracle") continue;
    text += fmt::format("\n{}, {}, {}, {} draws\n", evaluation.set, name_of(evaluation.memory),
                        evaluation.title, evaluation.draws);
    for (const Stratum& stratum : strata_of(evaluation))
      for (const bool half : {true, false}) {
        text += fmt::format("  {:<18} {:<11} {:>6} in {}", half ? stratum.type : "",
                            half ? stratum.band : "", half ? std::to_string(stratum.windows) : "",
                            half ? 50 : 90);
        for (const PointScore& step : stratum.steps)
          text += fmt::format(" {:5.1f}", 100.0 * (half ? step.inside_50 : step.inside_90));
        text += "\n";
      }
  }
  return text;
}

}  // namespace sumogamma
