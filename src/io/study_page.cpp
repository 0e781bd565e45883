#include "io/study_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "base/csv_text.h"
#include "base/xml_text.h"
#include "io/output_file.h"
#include "io/page_assets.h"
#include "io/svg_plot.h"
#include "study/measures.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPictured = 3;   // variants beside the baseline in one picture
constexpr std::size_t kMostPoints = 2000;  // of one series in one picture

std::string number(double value) {
  const double size = std::abs(value);
  if (size >= 1000) return fmt::format("{:.0f}", value);
  return size >= 100 ? fmt::format("{:.1f}", value) : fmt::format("{:.3g}", value);
}

/// With its sign, by a minus of its own width.
std::string signed_number(double value) {
  return (value < 0 ? "−" : value > 0 ? "+" : "") + number(std::abs(value));
}

std::string name_of(const Measure& measure) {
  return std::string(measure.label) +
         (measure.unit.empty() ? "" : " [" + std::string(measure.unit) + "]");
}

enum class Verdict { Better, Worse, Same, Neither };

/// Better or worse only where the interval leaves out no difference.
Verdict verdict_of(const Measure& measure, const Estimate& difference) {
  if (!difference.has_interval() || difference.count < 2) return Verdict::Same;
  if (difference.low <= 0.0 && difference.high >= 0.0) return Verdict::Same;
  if (measure.better == Better::Neither) return Verdict::Neither;
  const bool more = difference.mean > 0.0;
  return more == (measure.better == Better::Higher) ? Verdict::Better : Verdict::Worse;
}

std::string verdict_cell(Verdict verdict, bool more) {
  switch (verdict) {
    case Verdict::Better:
      return fmt::format(R"(<td class="better">{} better</td>)", more ? "▲" : "▼");
    case Verdict::Worse:
      return fmt::format(R"(<td class="worse">{} worse</td>)", more ? "▲" : "▼");
    case Verdict::Neither:
      return fmt::format("<td>{} differs</td>", more ? "▲" : "▼");
    case Verdict::Same:
      break;
  }
  return R"(<td class="same">= no difference shown</td>)";
}

class StudyPage {
 public:
  StudyPage(fs::path folder, const Study& study, std::span<const StudyRunResult> runs,
            std::span<const SummaryRow> rows)
      : folder_(std::move(folder)), study_(study), runs_(runs), rows_(rows) {
    over_ = study.scenarios.size() > 1 ? kAllScenarios : study.scenarios.front().name;
    pictured_.push_back(study.baseline);
    for (std::size_t v = 0; v < study.variants.size() && pictured_.size() <= kMostPictured; ++v)
      if (v != study.baseline) pictured_.push_back(v);
  }

  std::string body() const {
    return head() + answer() + measures_table() + pictures() + by_scenario() + by_type() +
           provenance();
  }

 private:
  const SummaryRow* find(const std::string& measure, const std::string& variant,
                         const std::string& scenario) const {
    for (const SummaryRow& row : rows_)
      if (row.measure == measure && row.variant == variant && row.scenario == scenario) return &row;
    return nullptr;
  }
  const std::string& baseline() const { return study_.variants[study_.baseline].name; }

  std::string head() const {
    const std::string question =
        study_.question.empty() ? "How do the variants differ?" : study_.question;
    return fmt::format("<p class=\"study\">Study “{}”</p>\n<h1>{}</h1>\n", escaped(study_.name),
                       escaped(question));
  }

  /// "arrived agents (+12, +5 to +19)"
  std::string in_words(const std::string& key, const SummaryRow& row) const {
    const Measure measure = measure_of(key);
    const std::string unit = measure.unit.empty() ? "" : " " + std::string(measure.unit);
    return fmt::format("{} ({}{})", escaped(measure.label), signed_number(row.difference.mean),
                       unit);
  }

  std::string answer() const {
    std::string text;
    for (const StudyVariant& variant : study_.variants) {
      if (variant.name == baseline()) continue;
      std::vector<std::string> better, worse;
      std::size_t same = 0;
      for (const std::string& key : study_.measures) {
        const SummaryRow* row = find(key, variant.name, over_);
        if (!row) continue;
        const Verdict verdict = verdict_of(measure_of(key), row->difference);
        if (verdict == Verdict::Better)
          better.push_back(in_words(key, *row));
        else if (verdict == Verdict::Worse)
          worse.push_back(in_words(key, *row));
        else
          ++same;
      }
      text +=
          fmt::format("<p class=\"answer\"><b>{}</b> against <b>{}</b>: ", escaped(variant.name),
                      escaped(baseline()));
      text += part("better", "better", better) + "; " + part("worse", "worse", worse);
      if (same > 0) text += fmt::format("; no difference shown in {}", same);
      text += ".</p>\n";
    }
    std::size_t failed = 0;
    for (const StudyRunResult& run : runs_) failed += run.status == RunStatus::Failed ? 1 : 0;
    text += fmt::format(
        "<p class=\"how\">{} run{} on {} scenario{} with {} seed{} each{}. A difference is over "
        "pairs of the same scenario and seed, with its 95 % interval; better and worse are said "
        "where that leaves out 0.</p>\n",
        runs_.size(), runs_.size() == 1 ? "" : "s", study_.scenarios.size(),
        study_.scenarios.size() == 1 ? "" : "s", seeds(), seeds() == 1 ? "" : "s",
        failed > 0 ? fmt::format(" ({} failed and are left out)", failed) : "");
    return text;
  }
  static std::string part(const char* style, const char* word,
                          const std::vector<std::string>& items) {
    if (items.empty()) return std::string(word) + " in nothing";
    std::string list;
    constexpr std::size_t kNamed = 4;
    for (std::size_t k = 0; k < std::min(items.size(), kNamed); ++k)
      list += (k > 0 ? ", " : "") + items[k];
    if (items.size() > kNamed) list += fmt::format(" and {} more", items.size() - kNamed);
    return fmt::format("<span class=\"{}\">{} in {}</span>: {}", style, word, items.size(), list);
  }

  std::size_t seeds() const {
    return runs_.size() / (study_.scenarios.size() * study_.variants.size());
  }

  std::string measures_table() const {
    std::string text = fmt::format(
        "<div class=\"wide\"><table><thead><tr><th>Measure</th><th>Variant</th><th class=\"n\">"
        "Mean</th><th class=\"n\">{}</th><th class=\"n\">Difference</th><th>95 % interval</th>"
        "<th></th><th></th></tr></thead><tbody>\n",
        escaped(baseline()));
    std::string never;
    for (const std::string& key : study_.measures) {
      const SummaryRow* base = find(key, baseline(), over_);
      if (!base) continue;
      if (is_all_zero(key)) {
        never += (never.empty() ? "" : "; ") + escaped(measure_of(key).label);
        continue;
      }
      double reach = 0;
      for (const StudyVariant& variant : study_.variants)
        if (const SummaryRow* row = find(key, variant.name, over_);
            row && row->difference.count > 0)
          for (const double value :
               {row->difference.low, row->difference.high, row->difference.mean})
            if (std::isfinite(value)) reach = std::max(reach, std::abs(value));
      for (const StudyVariant& variant : study_.variants) {
        const SummaryRow* row = find(key, variant.name, over_);
        if (!row || (row == base && study_.variants.size() > 1)) continue;
        text += measure_row(key, *row, *base, reach > 0 ? reach : 1.0);
      }
    }
    text += "</tbody></table></div>\n";
    if (!never.empty()) text += "<p class=\"how\">0 in every run: " + never + ".</p>\n";
    return text;
  }
  bool is_all_zero(const std::string& measure) const {
    return std::none_of(rows_.begin(), rows_.end(), [&](const SummaryRow& row) {
      return row.measure == measure && (row.value.mean != 0.0 || row.value.deviation != 0.0);
    });
  }
  static std::string measure_row(const std::string& key, const SummaryRow& row,
                                 const SummaryRow& base, double reach) {
    const Measure measure = measure_of(key);
    std::string text = fmt::format(
        "<tr><th title=\"{}\">{}</th><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>",
        escaped(key), escaped(name_of(measure)), escaped(row.variant), number(row.value.mean),
        number(base.value.mean));
    const Estimate& difference = row.difference;
    if (difference.count == 0) return text + "<td></td><td></td><td></td><td></td></tr>\n";
    text += fmt::format("<td class=\"n\">{}</td>", signed_number(difference.mean));
    if (difference.has_interval())
      text += fmt::format("<td>{} to {}</td><td>{}</td>", signed_number(difference.low),
                          signed_number(difference.high),
                          interval_svg(difference.low, difference.mean, difference.high, reach));
    else
      text += "<td class=\"same\">one pair</td><td></td>";
    return text + verdict_cell(verdict_of(measure, difference), difference.mean > 0) + "</tr>\n";
  }

  /// Rows of a CSV file of all runs of a variant, each a map from column to text.
  template <typename Visit>
  void visit_csv(std::size_t variant, std::optional<std::size_t> scenario, const char* name,
                 Visit&& visit) const {
    for (const StudyRunResult& run : runs_) {
      if (run.status != RunStatus::Done || run.run.variant != variant) continue;
      if (scenario && run.run.scenario != *scenario) continue;
      const fs::path file = folder_ / folder_of(study_, run.run) / name;
      if (fs::exists(file)) visit_csv_rows(read_file(file), visit);
    }
  }

  std::vector<PlotSeries> series_of(const char* file, std::optional<std::size_t> scenario,
                                    const char* x, const char* y, const char* column,
                                    const char* wanted) const {
    std::vector<PlotSeries> all;
    for (const std::size_t variant : pictured_) {
      PlotSeries series{study_.variants[variant].name, {}, {}};
      visit_csv(variant, scenario, file, [&](const CsvRow& row) {
        if (column && row.text(column) != wanted) return;
        if (series.x.size() >= kMostPoints && y) return;
        const std::optional<double> at_x = row.number(x), at_y = y ? row.number(y) : 0.0;
        if (!at_x || !at_y) return;
        series.x.push_back(*at_x);
        series.y.push_back(*at_y);
      });
      all.push_back(std::move(series));
    }
    return all;
  }

  std::string key() const {
    constexpr const char* kShapes[] = {"●", "□", "△"};
    constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7"};
    std::string text = "<ul class=\"key\">";
    for (std::size_t k = 0; k < pictured_.size(); ++k)
      text += fmt::format("<li><span style=\"color:{}\">{}</span> {}{}</li>", kColours[k % 4],
                          kShapes[k % 3], escaped(study_.variants[pictured_[k]].name),
                          k == 0 ? " (baseline)" : "");
    return text + "</ul>\n";
  }

  std::string pictures() const {
    const auto figure = [](const std::string& svg) { return "<figure>" + svg + "</figure>\n"; };
    std::string text = "<h2>Pictures</h2>\n" + key() + "<div class=\"pictures\">\n";
    for (std::size_t m = 0; m < std::min<std::size_t>(study_.measures.size(), 3); ++m) {
      const std::string& measure = study_.measures[m];
      std::vector<PlotSeries> series;
      for (const std::size_t variant : pictured_) {
        PlotSeries one{study_.variants[variant].name, {}, {}};
        for (const auto& values : values_by_scenario(study_, runs_, variant, measure, false))
          one.x.insert(one.x.end(), values.begin(), values.end());
        series.push_back(std::move(one));
      }
      const std::string label = name_of(measure_of(measure));
      text += figure(strip_svg({label + ", a mark a run", label, ""}, series));
    }
    text += figure(
        histogram_svg({"Delay of agents", "delay [s]", "share of agents"},
                      series_of("journeys.csv", {}, "delay_s", nullptr, nullptr, nullptr), 40));
    text += figure(
        histogram_svg({"Mean speed of agents", "speed over the whole way [m/s]", "share of agents"},
                      series_of("journeys.csv", {}, "mean_speed", nullptr, nullptr, nullptr), 40));
    text += figure(scatter_svg(
        {"Fundamental diagram, a mark a lane and interval", "density [1/km]", "flow [1/h]"},
        series_of("lanes.csv", {}, "density_per_km", "flow_per_h", "type", "all")));
    for (std::size_t s = 0; s < std::min<std::size_t>(study_.scenarios.size(), 6); ++s)
      text += figure(scatter_svg({"Conflicts (TTC < 1.5 s): " + study_.scenarios[s].name, "x [m]",
                                  "y [m]", 420, 360, true},
                                 series_of("conflicts.csv", s, "x", "y", "beyond_fhwa", "1")));
    return text + "</div>\n";
  }

  std::string by_scenario() const {
    if (study_.scenarios.size() < 2) return "";
    std::string text =
        "<h2>By scenario</h2>\n<div class=\"wide\"><table><thead><tr><th>Measure</th><th>Scenario"
        "</th>";
    for (const std::size_t variant : pictured_)
      text += "<th class=\"n\">" + escaped(study_.variants[variant].name) + "</th>";
    text += "</tr></thead><tbody>\n";
    for (const std::string& measure : study_.measures)
      for (const StudyScenario& scenario : study_.scenarios) {
        if (!find(measure, baseline(), scenario.name) || is_all_zero(measure)) continue;
        text += fmt::format("<tr><th>{}</th><td>{}</td>", escaped(name_of(measure_of(measure))),
                            escaped(scenario.name));
        for (const std::size_t variant : pictured_)
          text += value_cell(find(measure, study_.variants[variant].name, scenario.name));
        text += "</tr>\n";
      }
    return text + "</tbody></table></div>\n";
  }
  static std::string value_cell(const SummaryRow* row) {
    if (!row) return "<td class=\"n\">–</td>";
    std::string text = "<td class=\"n\">" + number(row->value.mean);
    if (row->difference.count > 0 && row->difference.has_interval())
      text += fmt::format(" <span class=\"same\">({} to {})</span>",
                          signed_number(row->difference.low), signed_number(row->difference.high));
    return text + "</td>";
  }

  std::string by_type() const {
    constexpr std::pair<const char*, const char*> kOfType[] = {
        {"agents.by_type.{}.arrived", "Arrived"},
        {"agents.by_type.{}.mean_travel_time_s", "Travel time [s]"},
        {"flow.mean_speed_by_type.{}", "Mean speed [m/s]"},
        {"smoothness.by_type.{}.accel_p95", "Acceleration, 95th percentile [m/s²]"}};
    std::vector<std::string> types;
    const std::string begin = "flow.mean_speed_by_type.";
    for (const SummaryRow& row : rows_)
      if (row.measure.rfind(begin, 0) == 0 && row.scenario == over_) {
        const std::string type = row.measure.substr(begin.size());
        if (std::find(types.begin(), types.end(), type) == types.end()) types.push_back(type);
      }
    std::string text =
        "<h2>By type</h2>\n<div class=\"wide\"><table><thead><tr><th>Type</th><th>Measure</th>";
    for (const std::size_t variant : pictured_)
      text += "<th class=\"n\">" + escaped(study_.variants[variant].name) + "</th>";
    text += "</tr></thead><tbody>\n";
    for (const std::string& type : types)
      for (const auto& [pattern, label] : kOfType) {
        const std::string measure = fmt::format(fmt::runtime(pattern), type);
        text += fmt::format("<tr><th>{}</th><td>{}</td>", escaped(type), label);
        for (const std::size_t variant : pictured_)
          text += value_cell(find(measure, study_.variants[variant].name, over_));
        text += "</tr>\n";
      }
    return text + "</tbody></table></div>\n";
  }

  std::string provenance() const {
    std::string variants;
    for (const StudyVariant& variant : study_.variants) {
      variants += variant.name + ": " + (variant.plain ? "plain SUMO" : "GAMMA");
      for (const StudySetting& setting : variant.set)
        variants += " --set " + setting.key + "=" + setting.value;
      for (const std::string& option : variant.options) variants += " " + option;
      variants += "\n";
    }
    std::string options, hashes, failures;
    for (const std::string& option : study_.options) options += option + " ";
    for (const StudyRunResult& run : runs_) {
      const std::string place = folder_of(study_, run.run).string();
      if (run.status == RunStatus::Done) hashes += run.state_hash + "  " + place + "\n";
      if (run.status == RunStatus::Failed) failures += place + "/log.txt: " + run.failure + "\n";
    }
    const fs::path identity = folder_ / "study.json";
    std::string text = "<h2>How it was run</h2>\n";
    if (!failures.empty())
      text += "<details open><summary>Runs that failed</summary><pre>" + escaped(failures) +
              "</pre></details>\n";
    text += "<details><summary>Variants and options</summary><pre>options: " + escaped(options) +
            "\n" + escaped(variants) + "</pre></details>\n";
    if (fs::exists(identity))
      text += "<details><summary>Program and scenario files, by hash</summary><pre>" +
              escaped(read_file(identity)) + "</pre></details>\n";
    text += "<details><summary>Every run, by the hash of its states</summary><pre>" +
            escaped(hashes) + "</pre></details>\n";
    return text +
           "<details><summary>To repeat it</summary><pre>sumo-gamma batch STUDY.toml -o FOLDER\n"
           "sumo-gamma report FOLDER -o report.html</pre></details>\n";
  }

  fs::path folder_;
  const Study& study_;
  std::span<const StudyRunResult> runs_;
  std::span<const SummaryRow> rows_;
  std::string over_;
  std::vector<std::size_t> pictured_;  ///< variants in pictures and wide tables, the baseline first
};

void replace_mark(std::string& page, const std::string& mark, const std::string& text) {
  page.replace(page.find(mark), mark.size(), text);
}

}  // namespace

std::string study_html(const fs::path& folder, const Study& study,
                       std::span<const StudyRunResult> runs, std::span<const SummaryRow> rows) {
  std::string page(kStudyPageHtml);
  replace_mark(page, "<!--TITLE-->", escaped(study.name));
  replace_mark(page, "<!--BODY-->", StudyPage(folder, study, runs, rows).body());
  return page;
}

}  // namespace sumogamma
