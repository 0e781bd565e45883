#include "realism/score_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/csv_text.h"

namespace sumogamma {

namespace {

using Json = nlohmann::ordered_json;

std::string cell(double value, int digits = 3) {
  return std::isnan(value) ? "–" : fmt::format("{:.{}f}", value, digits);
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// Figures of a score by name, in the order of files.
std::vector<std::pair<std::string, double>> named_figures(const ScoreSums& sums) {
  const ScoreFigures figures = figures_of(sums);
  std::vector<std::pair<std::string, double>> named{{"composite", figures.composite},
                                                    {"kinematic", figures.kinematic}};
  for (std::size_t k = 0; k < kScoreFeatures; ++k)
    named.emplace_back(std::string("likelihood_") + score_features()[k].name,
                       figures.likelihood[k]);
  named.emplace_back("colliding", figures.colliding);
  named.emplace_back("colliding_anew", figures.colliding_anew);
  named.emplace_back("colliding_with_entering", figures.colliding_with_entering);
  named.emplace_back("progress", figures.progress);
  named.emplace_back("min_ade_m", figures.min_ade);
  named.emplace_back("off_road", figures.off_road);
  named.emplace_back("at_red", figures.at_red);
  return named;
}

std::string label_of(const std::string& method) {
  for (const ScoreMethodInfo& info : score_methods())
    if (method == info.name) return info.label;
  return method;
}

std::string label_of(const MethodScore& method) {
  return method.rollouts > 1
             ? fmt::format("{}, {} rollouts", label_of(method.name), method.rollouts)
             : label_of(method.name);
}

/// Figures of free runs by name, in the order of files.
std::vector<std::pair<std::string, double>> named_figures(const FreeScore& score) {
  return {{"pet_under_2_s", share_under_two_seconds(score.counts)},
          {"travel_time_rmspe", score.travel_rmspe},
          {"lateral_deviation_m", score.lateral_deviation},
          {"left", score.left},
          {"colliding", score.colliding}};
}

std::string row_of(const std::string& label, const std::vector<double>& values) {
  std::string row = "| " + label + " |";
  for (const double value : values) row += " " + cell(value) + " |";
  return row + "\n";
}

constexpr const char* kScoreHead =
    "| | composite | 95 % | kinematic | nearest | TTC | colliding | anew | progress | minADE [m] |";
constexpr const char* kScoreRule = "|---|---|---|---|---|---|---|---|---|---|";

bool has_map(const RecordingScore& score) {
  return !score.methods.empty() && !std::isnan(figures_of(score.methods.front().sums).off_road);
}

std::string score_row(const MethodScore& method) {
  const ScoreFigures figures = figures_of(method.sums);
  return fmt::format(
      "| {} | {} | {} to {} | {} | {} | {} | {} | {} | {} | {} |", label_of(method),
      cell(figures.composite), cell(method.composite_low), cell(method.composite_high),
      cell(figures.kinematic),
      cell(figures.likelihood[static_cast<std::size_t>(ScoreFeature::Nearest)]),
      cell(figures.likelihood[static_cast<std::size_t>(ScoreFeature::TimeToCollision)]),
      cell(figures.colliding, 4), cell(figures.colliding_anew, 4), cell(figures.progress, 2),
      cell(figures.min_ade, 2));
}

std::vector<double> distances(const MotionCounts& a, const MotionCounts& b) {
  const auto apart = hellinger(a, b);
  return {apart.begin(), apart.end()};
}

Json distances_json(const std::vector<double>& distances) {
  Json json;
  for (std::size_t k = 0; k < kCountedMeasures; ++k)
    json[counted_measures()[k].name] = distances.empty() ? Json() : number(distances[k]);
  return json;
}

Json figures_json(const ScoreSums& sums) {
  Json json;
  for (const auto& [name, value] : named_figures(sums)) json[name] = number(value);
  json["agents"] = sums.scored;
  return json;
}

Json free_json(const RecordingScore& score, const FreeScore& one) {
  Json json{{"method", one.name},
            {"runs", one.runs},
            {"hellinger", distances_json(distances(score.free_log, one.counts))}};
  for (const auto& [name, value] : named_figures(one)) json[name] = number(value);
  json["ways"] = one.ways;
  json["pet_under_2_s_of_log"] = number(share_under_two_seconds(score.free_log));
  json["lateral_deviation_of_log_m"] = number(score.free_lateral_deviation);
  json["left_in_log"] = one.left_in_log;
  for (std::size_t k = 0; k < kCountedMeasures; ++k)
    json["counts"][counted_measures()[k].name] = one.counts.counts[k];
  return json;
}

Json method_json(const RecordingScore& score, const MethodScore& method) {
  Json json{{"method", method.name}, {"rollouts", method.rollouts}};
  json.update(figures_json(method.sums));
  json["composite_95"] = {number(method.composite_low), number(method.composite_high)};
  json["hellinger"] = distances_json(distances(score.log, method.counts));
  if (drives_by_itself(method.name))
    json["entering"] = {{"entered", method.entries.entered},
                        {"delayed", method.entries.delayed},
                        {"shut_out", method.entries.shut_out},
                        {"unplaced", method.entries.unplaced}};
  for (const auto& [type, sums] : method.by_type) json["by_type"][type] = figures_json(sums);
  for (std::size_t k = 0; k < kCountedMeasures; ++k)
    json["counts"][counted_measures()[k].name] = method.counts.counts[k];
  return json;
}

std::map<std::string, std::size_t> agents_by_type(const RecordedScene& scene) {
  std::map<std::string, std::size_t> counts;
  for (const RecordedAgent& agent : scene.agents) ++counts[type_of(scene.types, agent.type).name];
  return counts;
}

}  // namespace

std::vector<std::string> scoring_notes(const RecordedScene& scene, const RecordingScore& score) {
  std::string types;
  for (const auto& [type, count] : agents_by_type(scene))
    types += fmt::format("{}{} {}", types.empty() ? "" : ", ", count, type);
  std::vector<std::string> notes{fmt::format("read as {}, {:.1f} s, a frame every {:.4g} s: {}",
                                             scene.format, scene.duration(), scene.own_period,
                                             types)};
  notes.insert(notes.end(), scene.notes.begin(), scene.notes.end());
  if (scene.too_short > 0)
    notes.push_back(
        fmt::format("{} tracks of under {} points are left out", scene.too_short, kLeastPoints));
  if (scene.default_boxes > 0)
    notes.push_back(fmt::format("{} of {} agents have no size in it and get their type's box",
                                scene.default_boxes, scene.agents.size()));
  notes.push_back(
      fmt::format("{} windows of 8 s with {} agents are scored, {} with fewer than two "
                  "are left out",
                  score.windows, score.scored, score.left_out));
  if (score.noise_floor.empty())
    notes.push_back(
        fmt::format("holds {} whole parts of five minutes: no noise floor, which takes "
                    "two",
                    score.parts));
  for (const MethodScore& method : score.methods)
    if (method.entries.delayed + method.entries.shut_out > 0)
      notes.push_back(
          fmt::format("{}: of {} who come during a window {} came late and {} not at "
                      "all, since somebody was in their place",
                      method.name, method.entries.entered + method.entries.shut_out,
                      method.entries.delayed, method.entries.shut_out));
  for (const MethodScore& method : score.methods)
    if (method.entries.unplaced > 0)
      notes.push_back(
          fmt::format("{}: {} times SUMO didn't insert one of those scored, which then "
                      "keeps its velocity",
                      method.name, method.entries.unplaced));
  if (!score.methods.empty() && score.methods.front().sums.colliding_in_log > 0)
    notes.push_back(fmt::format("{} of {} agents overlap another in the recording itself",
                                score.methods.front().sums.colliding_in_log, score.scored));
  return notes;
}

std::string score_table(const RecordingScore& score) {
  const bool mapped = has_map(score);
  std::string text = kScoreHead, rule = "|---|";
  text += mapped ? " edge | off road | at red |\n" : "\n";
  text += std::string(kScoreRule) + (mapped ? "---|---|---|\n" : "\n");
  for (const MethodScore& method : score.methods) {
    text += score_row(method);
    const ScoreFigures figures = figures_of(method.sums);
    if (mapped)
      text +=
          fmt::format(" {} | {} | {} |",
                      cell(figures.likelihood[static_cast<std::size_t>(ScoreFeature::RoadEdge)]),
                      cell(figures.off_road), cell(figures.at_red));
    text += "\n";
  }
  text += "\n| Hellinger distance |";
  for (const CountedMeasureInfo& info : counted_measures()) {
    text += fmt::format(" {} |", info.name);
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const MethodScore& method : score.methods)
    text += row_of(label_of(method), distances(score.log, method.counts));
  if (!score.noise_floor.empty())
    text += row_of(fmt::format("noise floor, {} parts of 5 min", score.parts), score.noise_floor);
  return text;
}

std::string free_table(const RecordingScore& score) {
  if (score.free_scores.empty()) return "";
  std::string text = "| free runs, Hellinger distance |", rule = "|---|";
  for (const CountedMeasureInfo& info : counted_measures()) {
    text += fmt::format(" {} |", info.name);
    rule += "---|";
  }
  text += " PET < 2 s | travel time RMSPE | sd in the lane [m] | arrived | colliding |\n";
  text += rule + "---|---|---|---|---|\n";
  const auto row = [&](const std::string& label, const std::vector<double>& apart, double pet,
                       double rmspe, double aside, double left, double colliding) {
    text += "| " + label + " |";
    for (const double value : apart) text += " " + cell(value) + " |";
    text += fmt::format(" {} | {} | {} | {} | {} |\n", cell(pet), cell(rmspe), cell(aside, 2),
                        cell(left, 1), cell(colliding, 4));
  };
  const std::vector<double> none(kCountedMeasures, std::numeric_limits<double>::quiet_NaN());
  row("recording", none, share_under_two_seconds(score.free_log), none[0],
      score.free_lateral_deviation, score.free_scores.front().left_in_log, none[0]);
  for (const FreeScore& one : score.free_scores)
    row(fmt::format("{}, {} runs", label_of(one.name), one.runs),
        distances(score.free_log, one.counts), share_under_two_seconds(one.counts),
        one.travel_rmspe, one.lateral_deviation, one.left, one.colliding);
  return text;
}

std::string mean_table(std::span<const RecordingScore> scores) {
  std::string text =
      "| mean of the recordings | composite | kinematic | nearest | TTC | colliding | progress | "
      "minADE [m] |\n|---|---|---|---|---|---|---|---|\n";
  for (std::size_t m = 0; m < scores.front().methods.size(); ++m) {
    std::vector<double> sums(7, 0.0);
    for (const RecordingScore& score : scores) {
      const ScoreFigures figures = figures_of(score.methods[m].sums);
      const double values[] = {
          figures.composite,
          figures.kinematic,
          figures.likelihood[static_cast<std::size_t>(ScoreFeature::Nearest)],
          figures.likelihood[static_cast<std::size_t>(ScoreFeature::TimeToCollision)],
          figures.colliding,
          figures.progress,
          figures.min_ade};
      for (std::size_t k = 0; k < sums.size(); ++k)
        sums[k] += values[k] / static_cast<double>(scores.size());
    }
    text += row_of(label_of(scores.front().methods[m]), sums);
  }
  return text;
}

std::string score_csv(std::span<const RecordingScore> scores) {
  std::string text = "recording,method,types,figure,value\n";
  const auto add = [&](const RecordingScore& score, const std::string& method,
                       const std::string& types, const std::string& figure, double value) {
    text += fmt::format("{},{},{},{},", csv_field(score.name), method, types, figure);
    text += std::isfinite(value) ? fmt::format("{:.6f}\n", value) : "\n";
  };
  for (const RecordingScore& score : scores) {
    for (const MethodScore& method : score.methods) {
      for (const auto& [name, value] : named_figures(method.sums))
        add(score, method.name, "all", name, value);
      for (const auto& [type, sums] : method.by_type)
        for (const auto& [name, value] : named_figures(sums))
          add(score, method.name, type, name, value);
      const std::vector<double> apart = distances(score.log, method.counts);
      for (std::size_t k = 0; k < kCountedMeasures; ++k)
        add(score, method.name, "all", std::string("hellinger_") + counted_measures()[k].name,
            apart[k]);
    }
    for (const FreeScore& one : score.free_scores) {
      const std::vector<double> apart = distances(score.free_log, one.counts);
      for (std::size_t k = 0; k < kCountedMeasures; ++k)
        add(score, one.name, "all", std::string("free_hellinger_") + counted_measures()[k].name,
            apart[k]);
      for (const auto& [name, value] : named_figures(one))
        add(score, one.name, "all", "free_" + name, value);
    }
    for (std::size_t k = 0; k < score.noise_floor.size(); ++k)
      add(score, "noise floor", "all", std::string("hellinger_") + counted_measures()[k].name,
          score.noise_floor[k]);
  }
  return text;
}

Json score_json(const RecordedScene& scene, const RecordingScore& score) {
  Json json{{"recording", score.name},
            {"format", scene.format},
            {"duration_s", scene.duration()},
            {"own_period_s", scene.own_period},
            {"agents_by_type", agents_by_type(scene)},
            {"default_boxes", scene.default_boxes},
            {"tracks_left_out", scene.too_short},
            {"windows", score.windows},
            {"windows_left_out", score.left_out},
            {"agents_scored", score.scored},
            {"parts_of_5_min", score.parts},
            {"noise_floor", distances_json(score.noise_floor)},
            {"notes", scoring_notes(scene, score)}};
  for (std::size_t k = 0; k < kCountedMeasures; ++k)
    json["counts_of_log"][counted_measures()[k].name] = score.log.counts[k];
  json["methods"] = Json::array();
  for (const MethodScore& method : score.methods)
    json["methods"].push_back(method_json(score, method));
  for (const FreeScore& one : score.free_scores) json["free_runs"].push_back(free_json(score, one));
  return json;
}

}  // namespace sumogamma
