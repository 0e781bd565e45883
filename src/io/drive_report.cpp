#include "io/drive_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/xml_text.h"
#include "io/episode_files.h"
#include "io/output_file.h"

namespace sumogamma {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMain = 3;  // the panels

struct FigureKind {
  const char* key;
  const char* unit;
  const char* what;
  bool share;  ///< of episodes: yes or no
};
constexpr FigureKind kFigures[] = {
    {"contact", "", "episodes with a contact", true},
    {"restricted_time_s", "s", "time to the goal, at most the limit", false},
    {"speed_change_per_m", "m/s per m", "changes of speed per metre driven", false},
    {"contact_moving", "", "contacts while the ego moved", true},
    {"contact_at_fault", "", "contacts at fault", true},
    {"near_miss", "", "episodes with a gap under 1 m", true},
    {"mean_speed", "m/s", "mean speed", false},
    {"progress_m", "m", "way made", false},
    {"braking_share", "", "periods with a drop of speed", false},
    {"braking_of_others_s", "s", "hard braking of others for it", false},
    {"delay_of_others_s", "s", "delay of others by it", false},
    {"score_without_comfort", "", "score without comfort", false},
    {"score", "", "score", false}};

using Rows = std::vector<Json>;

/// Episodes of a drive by seed, those of failed clients left out.
std::map<std::uint64_t, Json> read_rows(const std::filesystem::path& folder) {
  std::map<std::uint64_t, Json> rows;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "episodes")) {
    if (entry.path().extension() != ".json") continue;
    const std::string name = entry.path().stem().string();
    if (name.empty() || name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::uint64_t seed = std::stoull(name);
    Json row = read_episode(folder, seed)["episode"];
    if (row["outcome"] != outcome::kClientFailed) rows.emplace(seed, std::move(row));
  }
  return rows;
}

std::vector<double> values_of(const Rows& rows, const char* key) {
  std::vector<double> values;
  for (const Json& row : rows) values.push_back(row[key].get<double>());
  return values;
}

PairedCounts pairs_of(const std::vector<double>& one, const std::vector<double>& other) {
  PairedCounts counts;
  for (std::size_t k = 0; k < one.size(); ++k) {
    const bool a = one[k] != 0.0, b = other[k] != 0.0;
    ++(a && b ? counts.both : a ? counts.first : b ? counts.second : counts.neither);
  }
  return counts;
}

DriveFigure figure_of(const FigureKind& kind, const std::vector<Rows>& drives) {
  constexpr std::uint64_t kKey = 20260101;
  DriveFigure figure{kind.key, kind.unit, kind.what, {}, {}, {}};
  const std::vector<double> first = values_of(drives.front(), kind.key);
  for (std::size_t drive = 0; drive < drives.size(); ++drive) {
    const std::vector<double> values = values_of(drives[drive], kind.key);
    if (kind.share) {
      const auto count = static_cast<std::size_t>(
          std::count_if(values.begin(), values.end(), [](double value) { return value != 0.0; }));
      const ShareInterval interval = wilson_interval(count, values.size());
      figure.of.push_back({static_cast<double>(count) / static_cast<double>(values.size()),
                           interval.low, interval.high});
    } else {
      figure.of.push_back(bootstrap_mean(values, kKey));
    }
    if (drive == 0) continue;
    if (kind.share) {
      const PairedCounts counts = pairs_of(values, first);
      figure.difference.push_back(paired_difference(counts));
      figure.p.push_back(mcnemar_mid_p(counts));
      continue;
    }
    std::vector<double> difference(values.size());
    for (std::size_t k = 0; k < values.size(); ++k) difference[k] = values[k] - first[k];
    figure.difference.push_back(bootstrap_mean(difference, kKey));
    const bool same = std::all_of(difference.begin(), difference.end(),
                                  [](double value) { return value == 0.0; });
    figure.p.push_back(same ? 1.0 : bootstrap_p(difference, kKey));
  }
  return figure;
}

/// Over the main figures and all comparisons at once.
void adjust(std::vector<DriveFigure>& figures) {
  std::vector<double> all;
  for (std::size_t k = 0; k < kMain; ++k)
    all.insert(all.end(), figures[k].p.begin(), figures[k].p.end());
  const std::vector<double> adjusted = holm(all);
  std::size_t next = 0;
  for (std::size_t k = 0; k < kMain; ++k)
    for (double& p : figures[k].p) p = adjusted[next++];
}

const std::string kNote =
    "95 % intervals: Wilson's and Newcombe's of shares, BCa bootstrap over seeds of means. p: "
    "McNemar's mid-p, bootstrap; of the first three figures adjusted after Holm.";

std::string text_of(const IntervalEstimate& estimate) {
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", estimate.value, estimate.low, estimate.high);
}

/// One panel: a point and its interval for each drive.
std::string panel_of(const DriveFigure& figure, const std::vector<std::string>& names) {
  constexpr double kWidth = 320, kHeight = 236, kFoot = 56, kHead = 34;
  double most = 0;
  for (const IntervalEstimate& one : figure.of) most = std::max(most, one.high);
  if (most <= 0.0) most = 1.0;
  const auto height = [&](double value) {
    return kHeight - kFoot - (kHeight - kFoot - kHead) * std::max(value, 0.0) / most;
  };
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\"><text x=\"8\" "
      "y=\"18\">{2}{3}</text><line x1=\"40\" y1=\"{4}\" x2=\"{5}\" y2=\"{4}\" stroke=\"#888\"/>"
      "<text x=\"36\" y=\"{4}\" text-anchor=\"end\">0</text><text x=\"36\" y=\"{6}\" "
      "text-anchor=\"end\">{7:.3g}</text>",
      kWidth, kHeight, escaped(figure.what), figure.unit.empty() ? "" : " [" + figure.unit + "]",
      height(0), kWidth - 8, kHead + 4, most);
  for (std::size_t k = 0; k < figure.of.size(); ++k) {
    const IntervalEstimate& one = figure.of[k];
    const double x =
        40 + (kWidth - 48) * (static_cast<double>(k) + 0.5) / static_cast<double>(names.size());
    svg += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\" stroke=\"#246\" "
        "stroke-width=\"2\"/><circle cx=\"{0:.1f}\" cy=\"{3:.1f}\" r=\"5\" fill=\"#246\"/><text "
        "x=\"{0:.1f}\" y=\"{4}\" text-anchor=\"middle\">{5}</text>",
        x, height(one.low), height(one.high), height(one.value),
        // every other name a line lower, so that long ones don't run into each other
        kHeight - 34 + (k % 2 == 1 ? 16 : 0), escaped(names[k]));
  }
  return svg + "</svg>";
}

}  // namespace

bool is_drive(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "settings.json") &&
         std::filesystem::is_directory(folder / "episodes");
}

DriveReport compare_drives(std::span<const std::filesystem::path> folders) {
  DriveReport report;
  std::vector<std::map<std::uint64_t, Json>> all;
  for (const auto& folder : folders) {
    if (!is_drive(folder)) throw Error(folder.string(), "is no folder of a drive, as the first is");
    all.push_back(read_rows(folder));
    const auto plain = folder.lexically_normal();
    report.names.push_back(
        (plain.has_filename() ? plain : plain.parent_path()).filename().string());
  }
  std::vector<Rows> drives(all.size());
  for (const auto& [seed, row] : all.front()) {
    bool common = true, locked = false;
    for (const auto& rows : all) {
      const auto found = rows.find(seed);
      common = common && found != rows.end();
      locked = locked || (found != rows.end() && found->second["gridlock"] != 0);
      if (found != rows.end() && found->second["world_hash"] != row["world_hash"])
        throw Error(folders.back().string(), "seed " + std::to_string(seed) +
                                                 " is another world than in " +
                                                 folders.front().string() + ": not paired");
    }
    if (common && locked) ++report.left_out;
    if (!common || locked) continue;
    for (std::size_t k = 0; k < all.size(); ++k) drives[k].push_back(all[k].at(seed));
  }
  report.seeds = drives.front().size();
  if (report.seeds == 0)
    throw Error(folders.front().string(), "has no seed in common with the others that counts");
  for (const FigureKind& kind : kFigures) report.figures.push_back(figure_of(kind, drives));
  adjust(report.figures);
  return report;
}

std::string drive_report_markdown(const DriveReport& report) {
  std::string text = fmt::format("{} paired seeds, {} left out for a gridlock\n\n| |", report.seeds,
                                 report.left_out);
  for (const std::string& name : report.names) text += " " + name + " |";
  for (std::size_t k = 1; k < report.names.size(); ++k)
    text += " " + report.names[k] + " less " + report.names.front() + " | p |";
  text += "\n|---|";
  for (std::size_t k = 0; k < 3 * report.names.size() - 2; ++k) text += "---|";
  text += "\n";
  for (const DriveFigure& figure : report.figures) {
    text += "| " + figure.what + (figure.unit.empty() ? "" : " [" + figure.unit + "]") + " |";
    for (const IntervalEstimate& one : figure.of) text += " " + text_of(one) + " |";
    for (std::size_t k = 0; k < figure.difference.size(); ++k)
      text += " " + text_of(figure.difference[k]) + fmt::format(" | {:.3g} |", figure.p[k]);
    text += "\n";
  }
  return text + "\n" + kNote + "\n";
}

std::string drive_report_html(const DriveReport& report) {
  std::string page =
      "<!DOCTYPE html><html lang=\"en\"><meta charset=\"utf-8\"><title>Drives</title><style>body{"
      "font:14px sans-serif;margin:2em}td,th{padding:2px 10px;text-align:left;border-bottom:1px "
      "solid #ddd}td+td{white-space:nowrap}svg text{font-size:12px}</style>";
  page +=
      fmt::format("<h1>Drives side by side</h1><p>{} paired seeds, {} left out for a gridlock</p>",
                  report.seeds, report.left_out);
  for (std::size_t k = 0; k < kMain; ++k) page += panel_of(report.figures[k], report.names);
  page += "<table><tr><th></th>";
  for (const std::string& name : report.names) page += "<th>" + escaped(name) + "</th>";
  for (std::size_t k = 1; k < report.names.size(); ++k)
    page += "<th>" + escaped(report.names[k] + " less " + report.names.front()) + "</th><th>p</th>";
  page += "</tr>";
  for (const DriveFigure& figure : report.figures) {
    page += "<tr><td>" + escaped(figure.what) +
            (figure.unit.empty() ? "" : " [" + figure.unit + "]") + "</td>";
    for (const IntervalEstimate& one : figure.of) page += "<td>" + text_of(one) + "</td>";
    for (std::size_t k = 0; k < figure.difference.size(); ++k)
      page +=
          "<td>" + text_of(figure.difference[k]) + fmt::format("</td><td>{:.3g}</td>", figure.p[k]);
    page += "</tr>";
  }
  return page + "</table><p>" + escaped(kNote) + "</p></html>\n";
}

}  // namespace sumogamma
