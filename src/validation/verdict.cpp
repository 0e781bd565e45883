#include "validation/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/xml_text.h"

namespace sumogamma {

namespace {

using Json = nlohmann::ordered_json;

/// Four significant digits.
std::string number_text(double value) {
  if (!std::isfinite(value)) return "–";
  const double size = std::abs(value);
  if (size >= 1000.0) return fmt::format("{:.0f}", value);
  return size >= 100.0 ? fmt::format("{:.1f}", value) : fmt::format("{:.3g}", value);
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double mean_of(const std::vector<double>& values) {
  const Estimate estimate = estimate_mean(values);
  return estimate.count > 0 ? estimate.mean : std::nan("");
}

std::string interval_text(const Estimate& estimate) {
  if (estimate.count == 0) return "nothing to measure";
  if (!estimate.has_interval()) return number_text(estimate.mean);
  return fmt::format("{} ({} to {})", number_text(estimate.mean), number_text(estimate.low),
                     number_text(estimate.high));
}

}  // namespace

Outcome judge(const Trial& trial, const Criterion& criterion, std::vector<double> values,
              std::vector<double> sumo) {
  Outcome outcome{&trial, &criterion, std::move(values), std::move(sumo), {}, Judgement::Fail};
  outcome.estimate = estimate_mean(outcome.values);
  // a seed that gave nothing to measure is no seed to leave out
  const bool measured =
      outcome.estimate.count > 0 && outcome.estimate.count == outcome.values.size();
  const bool inside = measured && outcome.estimate.mean >= criterion.band.low &&
                      outcome.estimate.mean <= criterion.band.high;
  if (inside)
    outcome.verdict = Judgement::Pass;
  else if (measured && criterion.empirical)
    outcome.verdict = Judgement::Note;
  return outcome;
}

std::string to_string(Judgement verdict) {
  switch (verdict) {
    case Judgement::Pass:
      return "PASS";
    case Judgement::Note:
      return "NOTE";
    case Judgement::Fail:
      break;
  }
  return "FAIL";
}

std::string band_text(const Band& band) {
  if (!std::isfinite(band.low)) return "at most " + number_text(band.high);
  if (!std::isfinite(band.high)) return "at least " + number_text(band.low);
  if (band.low == band.high) return number_text(band.low);
  return number_text(band.low) + " to " + number_text(band.high);
}

std::string outcomes_json(const std::vector<Outcome>& outcomes, const std::string& version) {
  Json rows = Json::array();
  for (const Outcome& outcome : outcomes) {
    const Criterion& asked = *outcome.criterion;
    Json values = Json::array();
    for (const double value : outcome.values) values.push_back(number_or_null(value));
    rows.push_back({{"id", outcome.trial->id},
                    {"asks", outcome.trial->asks},
                    {"setup", outcome.trial->setup},
                    {"figure", asked.figure},
                    {"unit", asked.unit},
                    {"band", {number_or_null(asked.band.low), number_or_null(asked.band.high)}},
                    {"source", asked.source},
                    {"empirical", asked.empirical},
                    {"values", values},
                    {"mean", outcome.estimate.count > 0 ? Json(outcome.estimate.mean) : Json()},
                    {"interval", outcome.estimate.has_interval()
                                     ? Json{outcome.estimate.low, outcome.estimate.high}
                                     : Json()},
                    {"sumo_mean", number_or_null(mean_of(outcome.sumo))},
                    {"verdict", to_string(outcome.verdict)}});
  }
  return Json{{"sumo_gamma_version", version}, {"outcomes", rows}}.dump(1) + "\n";
}

std::string outcomes_markdown(const std::vector<Outcome>& outcomes) {
  std::string text =
      "| | trial | figure | expected | GAMMA, mean (95 %) | SUMO | verdict |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const Outcome& outcome : outcomes)
    text += fmt::format("| {} | {} | {}{} | {} | {} | {} | {} |\n", outcome.trial->id,
                        outcome.trial->asks, outcome.criterion->figure,
                        outcome.criterion->unit.empty() ? "" : " [" + outcome.criterion->unit + "]",
                        band_text(outcome.criterion->band), interval_text(outcome.estimate),
                        number_text(mean_of(outcome.sumo)), to_string(outcome.verdict));
  return text;
}

namespace {

/// The band as a bar, each seed a dot, the mean a line, SUMO's a hollow mark.
std::string picture(const Outcome& outcome) {
  constexpr double kWidth = 260.0, kHeight = 34.0, kEdge = 8.0;
  std::vector<double> marks;
  const auto take = [&](double value) {
    if (std::isfinite(value)) marks.push_back(value);
  };
  const Band& band = outcome.criterion->band;
  const double sumo = mean_of(outcome.sumo);
  for (const double value : outcome.values) take(value);
  take(band.low);
  take(band.high);
  take(sumo);
  if (marks.empty()) return "";
  const auto [least, most] = std::minmax_element(marks.begin(), marks.end());
  const double spread = std::max(*most - *least, 1e-3 * std::max(std::abs(*most), 1e-3));
  const double low = *least - 0.15 * spread, high = *most + 0.15 * spread;
  const auto place = [&](double value) {
    return kEdge + (kWidth - 2 * kEdge) * std::clamp((value - low) / (high - low), 0.0, 1.0);
  };
  std::string svg = fmt::format(
      "<svg width='{}' height='{}' role='img' aria-label='{}'>"
      "<line x1='{:.1f}' x2='{:.1f}' y1='17' y2='17' class='axis'/>",
      kWidth, kHeight, escaped(to_string(outcome.verdict) + ", expected " + band_text(band)), kEdge,
      kWidth - kEdge);
  const double from = place(std::max(band.low, low)), to = place(std::min(band.high, high));
  svg += fmt::format("<rect x='{:.1f}' y='9' width='{:.1f}' height='16' class='band'/>", from,
                     std::max(to - from, 2.0));
  for (const double value : outcome.values)
    if (std::isfinite(value))
      svg += fmt::format("<circle cx='{:.1f}' cy='17' r='3' class='seed'/>", place(value));
  if (outcome.estimate.count > 0)
    svg += fmt::format("<line x1='{0:.1f}' x2='{0:.1f}' y1='5' y2='29' class='mean'/>",
                       place(outcome.estimate.mean));
  if (std::isfinite(sumo))
    svg += fmt::format("<path d='M{:.1f} 12 l5 5 l-5 5 l-5 -5 z' class='sumo'/>", place(sumo));
  return svg + "</svg>";
}

std::string row_html(const Outcome& outcome) {
  const Criterion& asked = *outcome.criterion;
  const std::string verdict = to_string(outcome.verdict);
  const char* sign = outcome.verdict == Judgement::Pass   ? "✓"
                     : outcome.verdict == Judgement::Note ? "•"
                                                          : "✗";
  return fmt::format(
      "<tr class='{}'><td>{} {}</td><td>{}{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
      "<td class='source'>{}</td></tr>\n",
      verdict, sign, verdict, escaped(asked.figure),
      asked.unit.empty() ? "" : " [" + escaped(asked.unit) + "]", band_text(asked.band),
      interval_text(outcome.estimate), number_text(mean_of(outcome.sumo)), picture(outcome),
      escaped(asked.source));
}

constexpr const char* kHead = R"(<!doctype html><html lang="en"><meta charset="utf-8">
<title>sumo-gamma: validation</title><meta name="viewport" content="width=device-width">
<style>
body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:76rem;padding:0 1rem;color:#1b1f24}
h1{font-size:1.5rem}h2{font-size:1.05rem;margin:1.8rem 0 .2rem}p{margin:.2rem 0 .5rem}
table{border-collapse:collapse;width:100%}td,th{text-align:left;padding:.25rem .6rem;border-top:1px solid #d8dee4;vertical-align:middle}
.FAIL td:first-child{color:#9a3412;font-weight:600}.NOTE td:first-child{color:#57606a;font-weight:600}.PASS td:first-child{color:#0b5394}
.axis{stroke:#afb8c1}.band{fill:#cfe3f5}.seed{fill:#1f4e79;fill-opacity:.55}.mean{stroke:#1b1f24;stroke-width:2}.sumo{fill:none;stroke:#b35900;stroke-width:1.5}
.source{color:#57606a;font-size:.85em}
</style>
)";

}  // namespace

std::string outcomes_html(const std::vector<Outcome>& outcomes, const std::string& version) {
  const auto count = [&](Judgement verdict) {
    return std::count_if(outcomes.begin(), outcomes.end(),
                         [&](const Outcome& outcome) { return outcome.verdict == verdict; });
  };
  const std::string heads =
      "<tr><th>verdict</th><th>figure</th><th>expected</th><th>mean (95 %)</th><th>SUMO</th>"
      "<th>seeds on the band</th><th>source</th></tr>\n";
  std::string page = kHead;
  page += fmt::format(
      "<h1>Validation of sumo-gamma {}</h1><p><b>{} of {}</b> figures lie in their bands, {} are "
      "off where the band is empirical only (NOTE), <b>{} fail</b>.</p><p>Blue bar: what is "
      "expected. Dots: seeds. Line: their mean. Hollow diamond: plain SUMO in the same case.</p>\n",
      escaped(version), count(Judgement::Pass), outcomes.size(), count(Judgement::Note),
      count(Judgement::Fail));
  if (count(Judgement::Fail) > 0) {
    page += "<h2>What fails</h2><table>" + heads;
    for (const Outcome& outcome : outcomes)
      if (outcome.verdict == Judgement::Fail) page += row_html(outcome);
    page += "</table>\n";
  }
  const Trial* last = nullptr;
  for (const Outcome& outcome : outcomes) {
    if (outcome.trial != last) {
      if (last != nullptr) page += "</table>\n";
      last = outcome.trial;
      page += fmt::format("<h2>{}: {}</h2><p>{}</p><table>{}", escaped(last->id),
                          escaped(last->asks), escaped(last->setup), heads);
    }
    page += row_html(outcome);
  }
  return page + (last != nullptr ? "</table></html>\n" : "</html>\n");
}

}  // namespace sumogamma
