#include "realism/score_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "base/xml_text.h"

namespace sumogamma {

namespace {

constexpr double kWidth = 300.0, kHeight = 150.0, kLeft = 8.0, kBottom = 18.0;  // [px]

/// How a method is drawn: GAMMA stands out, nobody is told by colour alone.
struct Look {
  const char *method, *colour, *dashes;
  double width;
};
constexpr Look kLooks[] = {
    {"gamma", "#0b5394", "", 2.5},           {"sumo-krauss", "#b35900", "", 1.3},
    {"sumo-idm", "#b35900", "5 3", 1.3},     {"sumo-eidm", "#7a3e9d", "2 2", 1.3},
    {"sumo-sublane", "#2e7d32", "8 3", 1.3}, {"cv-fan", "#57606a", "1 3", 1.3},
};

/// What a picture holds: a name and its counts.
using Line = std::pair<const Look*, const MotionCounts*>;

std::vector<double> shares(const std::vector<double>& counts) {
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  std::vector<double> result;
  result.reserve(counts.size());
  for (const double count : counts) result.push_back(all > 0 ? count / all : 0.0);
  return result;
}

/// The outline of a histogram as the points of a path.
std::string steps(const std::vector<double>& shares, double most) {
  std::string points;
  const double width = (kWidth - 2 * kLeft) / static_cast<double>(shares.size());
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double x = kLeft + width * static_cast<double>(k);
    const double y = (kHeight - kBottom) * (1.0 - shares[k] / most);
    points += fmt::format(" {:.1f},{:.1f} {:.1f},{:.1f}", x, y, x + width, y);
  }
  return points;
}

/// One measure: the recording as an area, methods as lines. Empty where the recording has no value.
std::string picture(std::size_t measure, const MotionCounts& log, const std::vector<Line>& lines) {
  const CountedMeasureInfo& info = counted_measures()[measure];
  const std::vector<double> recorded = shares(log.counts[measure]);
  double most = *std::max_element(recorded.begin(), recorded.end());
  if (most <= 0.0) return "";
  for (const auto& [look, counts] : lines)
    for (const double share : shares(counts->counts[measure])) most = std::max(most, share);
  const double ground = kHeight - kBottom;
  std::string svg = fmt::format(
      "<figure><figcaption>{} [{}]</figcaption><svg width='{}' height='{}' role='img' "
      "aria-label='distribution of {}'><polygon class='log' points='{:.1f},{:.1f}{} "
      "{:.1f},{:.1f}'/>",
      escaped(info.name), escaped(info.unit), kWidth, kHeight, escaped(info.name), kLeft, ground,
      steps(recorded, most), kWidth - kLeft, ground);
  for (const auto& [look, counts] : lines)
    svg += fmt::format(
        "<polyline fill='none' stroke='{}' stroke-width='{}' stroke-dasharray='{}' points='{}'/>",
        look->colour, look->width, look->dashes, steps(shares(counts->counts[measure]), most));
  for (const double at : {0.0, 0.5, 1.0})
    svg += fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{:g}</text>",
                       kLeft + at * (kWidth - 2 * kLeft), kHeight - 4.0,
                       at == 0.0   ? "start"
                       : at == 1.0 ? "end"
                                   : "middle",
                       info.bins.low + at * (info.bins.high - info.bins.low));
  return svg + "</svg></figure>\n";
}

std::string pictures(const std::string& title, const MotionCounts& log,
                     const std::vector<Line>& lines) {
  std::string text =
      "<h3>" + title + "</h3><p class='key'><span class='log'>&#9632;</span> recording";
  for (const auto& [look, counts] : lines)
    text += fmt::format(
        "<span><svg width='34' height='10'><line x1='2' x2='32' y1='5' y2='5' stroke='{}' "
        "stroke-width='{}' stroke-dasharray='{}'/></svg> {}</span>",
        look->colour, look->width, look->dashes, look->method);
  text += "</p><div>";
  for (std::size_t measure = 0; measure < kCountedMeasures; ++measure)
    text += picture(measure, log, lines);
  return text + "</div>\n";
}

template <class Score>
std::vector<Line> lines_of(const std::vector<Score>& methods) {
  std::vector<Line> lines;
  for (const Look& look : kLooks)
    for (const Score& method : methods)
      if (method.name == look.method) lines.emplace_back(&look, &method.counts);
  return lines;
}

constexpr const char* kHead = R"(<!doctype html><html lang="en"><meta charset="utf-8">
<title>sumo-gamma: rollouts beside recordings</title><meta name="viewport" content="width=device-width">
<style>
body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:76rem;padding:0 1rem;color:#1b1f24}
h1{font-size:1.5rem}h2{font-size:1.2rem;margin:2rem 0 .2rem}h3{font-size:1rem;margin:1rem 0 .2rem}
div{display:flex;flex-wrap:wrap;gap:.6rem 1.2rem}figure{margin:0}figcaption{color:#57606a;font-size:.9em}
svg text{font:11px system-ui,sans-serif;fill:#57606a}.log{fill:#cfd6dd;color:#cfd6dd}.key span{margin-left:1rem}.key span.log{margin:0}
</style>
)";

}  // namespace

std::string score_page(std::span<const RecordingScore> scores, const std::string& version) {
  std::string page = kHead;
  page += fmt::format(
      "<h1>Rollouts beside recordings, sumo-gamma {}</h1><p>Shares of values by bin; what lies "
      "beyond an end counts in the bin there. Figures: score.csv.</p>\n",
      escaped(version));
  for (const RecordingScore& score : scores) {
    page += "<h2>" + escaped(score.name) + "</h2>\n";
    page += pictures(fmt::format("Windows of 8 s ({})", score.windows), score.log,
                     lines_of(score.methods));
    if (!score.free_scores.empty())
      page += pictures(fmt::format("Free runs ({} a method)", score.free_scores.front().runs),
                       score.free_log, lines_of(score.free_scores));
  }
  return page + "</html>\n";
}

}  // namespace sumogamma
