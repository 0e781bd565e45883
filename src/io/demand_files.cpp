#include "io/demand_files.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <utility>

#include "base/csv_text.h"
#include "base/edit_distance.h"
#include "base/error.h"
#include "io/output_file.h"

namespace sumogamma {

namespace {

void check_type(const std::string& where, const std::string& name, const AgentTypeTable& types) {
  const auto is = [&](const AgentType& type) { return type.name == name; };
  if (std::any_of(types.begin(), types.end(), is)) return;
  const auto nearest = nearest_named(name, types, [](const AgentType& type) { return type.name; });
  throw Error(where, "'" + name.substr(0, 60) + "' is no agent type, the nearest known one is '" +
                         nearest->name + "'");
}

/// A count of an element; throws Error where it is none.
double count_of(const std::string& file, const pugi::xml_node& element, const char* attribute) {
  const pugi::xml_attribute text = element.attribute(attribute);
  const double value = text.as_double(-1);
  const bool begins_well = text && std::string_view(text.value()).find_first_of("0123456789") == 0;
  if (begins_well && std::isfinite(value) && value >= 0) return value;
  throw Error(file, std::string("an <") + element.name() + "> of interval " +
                        element.parent().attribute("begin").value() + " has no " + attribute +
                        " of 0 or more");
}

}  // namespace

std::vector<AskedTrips> read_od_table(const std::filesystem::path& file,
                                      const AgentTypeTable& types) {
  std::vector<AskedTrips> trips;
  std::string text = read_file(file);
  std::erase(text, '\r');
  std::size_t line = 1;
  visit_csv_rows(text, [&](const CsvRow& row) {
    const std::string where = file.string() + ":" + std::to_string(++line);
    for (const char* const column : {"from", "to", "type", "per_hour"})
      if (std::find(row.header.begin(), row.header.end(), column) == row.header.end())
        throw Error(file.string(),
                    std::string("has no column '") + column + "'; expected from,to,type,per_hour");
    if (row.fields.size() == 1 && row.fields.front().empty()) return;
    AskedTrips asked{std::string(row.text("type")), std::string(row.text("from")),
                     std::string(row.text("to")), row.number("per_hour").value_or(-1)};
    check_type(where, asked.type, types);
    if (!std::isfinite(asked.per_hour) || asked.per_hour < 0)
      throw Error(where, "per_hour must be a number of 0 or more");
    trips.push_back(std::move(asked));
  });
  if (trips.empty()) throw Error(file.string(), "holds no trips below its header");
  return trips;
}

std::vector<EdgeCount> read_counts(const std::filesystem::path& file) {
  pugi::xml_document document;
  const std::string text = read_file(file);
  if (!document.load_buffer(text.data(), text.size()))
    throw Error(file.string(),
                "is no XML; expected <interval>s with <edge id entered> as edgeData");
  std::map<std::pair<std::string, std::string>, double> counted;
  double hours = 0;
  for (const pugi::xml_node interval : document.document_element().children("interval")) {
    const double seconds =
        interval.attribute("end").as_double() - interval.attribute("begin").as_double();
    if (!(seconds > 0) || !std::isfinite(seconds))
      throw Error(file.string(), std::string("an interval from ") +
                                     interval.attribute("begin").value() + " ends at or before it");
    hours += seconds / 3600;
    for (const pugi::xml_node edge : interval.children("edge"))
      counted[{edge.attribute("id").value(), ""}] += count_of(file.string(), edge, "entered");
    for (const pugi::xml_node turn : interval.children("edgeRelation"))
      counted[{turn.attribute("from").value(), turn.attribute("to").value()}] +=
          count_of(file.string(), turn, "count");
  }
  if (counted.empty())
    throw Error(file.string(),
                "counts nothing; expected <interval>s with <edge id entered> or "
                "<edgeRelation from to count>");
  std::vector<EdgeCount> counts;
  for (const auto& [edges, count] : counted)
    counts.push_back({edges.first, edges.second, count / hours});
  return counts;
}

}  // namespace sumogamma
