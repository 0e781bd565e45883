#include "io/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/csv_text.h"
#include "base/error.h"
#include "base/xml_text.h"
#include "io/output_file.h"
#include "io/page_assets.h"

namespace sumogamma {

namespace {

using Json = nlohmann::ordered_json;

/// Six significant digits: a report is read by people, results.json keeps the rest.
std::string number_text(double value) {
  const bool whole = std::abs(value) < 1e15 && value == std::floor(value);
  return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.5g}", value);
}

void flatten(const Json& json, const std::string& prefix, std::vector<RunColumn::Value>& values) {
  for (const auto& [key, value] : json.items()) {
    const std::string full = prefix.empty() ? key : prefix + "." + key;
    if (value.is_object()) {
      flatten(value, full, values);
    } else if (value.is_number()) {
      values.push_back({full, number_text(value.get<double>()), value.get<double>(), true});
    } else {
      values.push_back(
          {full, value.is_string() ? value.get<std::string>() : value.dump(), 0, false});
    }
  }
}

/// Keys of all runs, each behind the key that it follows in the run where it stands.
std::vector<std::string> all_keys(std::span<const RunColumn> runs) {
  std::vector<std::string> keys;
  for (const RunColumn& run : runs) {
    std::size_t at = 0;
    for (const RunColumn::Value& value : run.values) {
      const auto found = std::find(keys.begin(), keys.end(), value.key);
      if (found != keys.end()) {
        at = static_cast<std::size_t>(found - keys.begin()) + 1;
      } else {
        keys.insert(keys.begin() + static_cast<std::ptrdiff_t>(at), value.key);
        ++at;
      }
    }
  }
  return keys;
}

const RunColumn::Value* find_value(const RunColumn& run, const std::string& key) {
  const auto found = std::find_if(run.values.begin(), run.values.end(),
                                  [&](const RunColumn::Value& value) { return value.key == key; });
  return found == run.values.end() ? nullptr : &*found;
}

std::string escape_markdown(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2)
    text.replace(at, 1, "\\|");
  return text;
}

/// A bar of the value's share of the row's largest, and the change against the first run.
std::string number_cell(const RunColumn::Value& value, double largest,
                        const RunColumn::Value* first) {
  const double share = largest > 0 ? std::clamp(std::abs(value.number) / largest, 0.0, 1.0) : 0.0;
  const std::string bar =
      fmt::format(R"(<svg width="90" height="10" role="presentation"><rect class="all" )"
                  R"(width="90" height="10" rx="2"/>)"
                  R"(<rect class="bar" width="{:.1f}" height="10" rx="2"/></svg>)",
                  90.0 * share);
  std::string cell = "<td class=\"number\">" + escaped(value.text);
  if (first && first->is_number && first->number != 0.0 && value.number != first->number) {
    const double percent = 100.0 * (value.number - first->number) / std::abs(first->number);
    cell += fmt::format("<small>{:+.{}f} %</small>", percent, std::abs(percent) < 10 ? 1 : 0);
  }
  return cell + "</td><td class=\"graph\">" + bar + "</td>";
}

std::string html_row(std::span<const RunColumn> runs, const std::string& key,
                     const std::string& label) {
  double largest = 0;
  for (const RunColumn& run : runs)
    if (const RunColumn::Value* value = find_value(run, key); value && value->is_number)
      largest = std::max(largest, std::abs(value->number));
  const RunColumn::Value* first = find_value(runs.front(), key);
  // seed, step and the like are settings: nothing to compare
  const bool compared = key.find('.') != std::string::npos;
  std::string row = "<tr><th title=\"" + escaped(key) + "\">" + escaped(label) + "</th>";
  for (const RunColumn& run : runs) {
    const RunColumn::Value* value = find_value(run, key);
    if (!value)
      row += "<td class=\"none\" colspan=\"2\">–</td>";
    else if (value->is_number && compared)
      row += number_cell(*value, largest, value == first ? nullptr : first);
    else
      row += R"(<td class="text" colspan="2">)" + escaped(value->text) + "</td>";
  }
  return row + "</tr>\n";
}

}  // namespace

std::vector<RunColumn> read_runs(std::span<const std::filesystem::path> folders) {
  std::vector<RunColumn> runs;
  std::set<std::string> used;
  for (const std::filesystem::path& folder : folders) {
    const std::filesystem::path file =
        std::filesystem::is_directory(folder) ? folder / "results.json" : folder;
    const std::string content = read_file(file);
    const Json json = Json::parse(content, nullptr, false);
    if (!json.is_object() || !json.contains("state_hash") || !json.contains("agents"))
      throw Error(file.string(),
                  "isn't a run's results, expected results.json of `sumo-gamma run`");
    RunColumn run;
    // the last two parts of the path tell runs of one study apart
    const std::filesystem::path whole =
        std::filesystem::absolute(file).lexically_normal().parent_path();
    run.name = whole.filename().string();
    if (used.contains(run.name))
      run.name = whole.parent_path().filename().string() + "/" + run.name;
    for (int copy = 2; !used.insert(run.name).second; ++copy)
      run.name = whole.filename().string() + " (" + std::to_string(copy) + ")";
    flatten(json, "", run.values);
    runs.push_back(std::move(run));
  }
  return runs;
}

bool same_metrics(std::span<const RunColumn> runs) {
  const auto version = [](const RunColumn& run) {
    const RunColumn::Value* value = find_value(run, "metrics_version");
    return value ? value->text : std::string();
  };
  return std::all_of(runs.begin(), runs.end(),
                     [&](const RunColumn& run) { return version(run) == version(runs.front()); });
}

std::string report_markdown(std::span<const RunColumn> runs) {
  std::string text = "| key |", rule = "|---|";
  for (const RunColumn& run : runs) {
    text += " " + escape_markdown(run.name) + " |";
    rule += "---:|";
  }
  text += "\n" + rule + "\n";
  for (const std::string& key : all_keys(runs)) {
    text += "| " + escape_markdown(key) + " |";
    for (const RunColumn& run : runs) {
      const RunColumn::Value* value = find_value(run, key);
      text += " " + (value ? escape_markdown(value->text) : "") + " |";
    }
    text += "\n";
  }
  return text;
}

std::string report_csv(std::span<const RunColumn> runs) {
  std::string text = "key";
  for (const RunColumn& run : runs) text += "," + csv_field(run.name);
  text += "\n";
  for (const std::string& key : all_keys(runs)) {
    text += csv_field(key);
    for (const RunColumn& run : runs) {
      const RunColumn::Value* value = find_value(run, key);
      text += "," + (value ? csv_field(value->text) : "");
    }
    text += "\n";
  }
  return text;
}

std::string report_html(std::span<const RunColumn> runs) {
  std::string columns = "<col class=\"key\">";
  for (std::size_t i = 0; i < runs.size(); ++i) columns += "<col><col class=\"bars\">";
  std::string head = "<tr><th></th>";
  for (const RunColumn& run : runs) head += "<th colspan=\"2\">" + escaped(run.name) + "</th>";
  head += "</tr>\n";
  std::string sections, section = "run", rows;
  auto close_section = [&] {
    if (!rows.empty())
      sections += "<section>\n<h2>" + escaped(section) + "</h2>\n<table>\n" + columns + "<thead>" +
                  head + "</thead>\n<tbody>\n" + rows + "</tbody>\n</table>\n</section>\n";
    rows.clear();
  };
  for (const std::string& key : all_keys(runs)) {
    const std::size_t dot = key.find('.');
    const std::string group = dot == std::string::npos ? "run" : key.substr(0, dot);
    if (group != section) close_section();
    section = group;
    rows += html_row(runs, key, dot == std::string::npos ? key : key.substr(dot + 1));
  }
  close_section();
  std::string page(kReportPageHtml);
  const std::string mark = "<!--SECTIONS-->";
  return page.replace(page.find(mark), mark.size(), sections);
}

}  // namespace sumogamma
