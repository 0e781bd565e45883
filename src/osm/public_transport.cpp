#include "osm/public_transport.h"

#include <algorithm>

#include "osm/line_stops.h"

namespace sumogamma::osm {
namespace {

/// As people know it: "5 (relation/2218008)".
std::string full_name(const MapLine& line) {
  return line.line + " (relation/" + std::to_string(line.id) + ")";
}

/// SUMO's lists of lines are parted by blanks.
std::string one_word(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c <= ' '; }, '_');
  return text;
}

/// Does a part serve the stops of another, one after the other?
bool serves_all_of(const LinePart& part, const LinePart& other) {
  return std::search(part.stops.begin(), part.stops.end(), other.stops.begin(), other.stops.end(),
                     [](const ServedStop& a, const ServedStop& b) { return a.stop == b.stop; }) !=
         part.stops.end();
}

/// Leaves out parts whose stops others serve in the same order: two roads that a line comes by,
/// say.
void drop_doubled(std::vector<LinePart>& parts) {
  std::vector<LinePart> kept;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    bool doubled = false;
    for (std::size_t k = 0; k < parts.size() && !doubled; ++k)
      // of two alike the first stays
      doubled = k != i && serves_all_of(parts[k], parts[i]) &&
                (k < i || !serves_all_of(parts[i], parts[k]));
    if (!doubled) kept.push_back(parts[i]);
  }
  parts = std::move(kept);
}

/// The parts of one line, in the order in which it has them.
std::vector<LinePart> parts_of(const LineGround& ground, const MapLine& line,
                               const std::vector<LineStop>& stops, bool in_order,
                               StopPlacer& placer, std::string& why) {
  const auto routes = line_routes(ground, line);
  why = routes.empty() && stops.size() > 1 ? "no road of it that a bus may use"
                                           : "fewer than two stops in the map";
  std::vector<LinePart> parts;
  for (const std::vector<EdgeId>& route : routes) {
    auto served = placer.along(route, stops, in_order);
    if (served.size() < 2) continue;
    parts.push_back({std::to_string(line.id) + "." + std::to_string(parts.size()),
                     one_word(line.line), line.kind, line.headway, route, std::move(served)});
  }
  if (!line.directed) drop_doubled(parts);
  return parts;
}

/// Leaves out stops that nobody serves.
void keep_served(PublicTransport& transport) {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> row(transport.stops.size(), kNone);
  for (const LinePart& part : transport.parts)
    for (const ServedStop& served : part.stops) row[served.stop] = 0;
  std::vector<BusStop> kept;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] == kNone) continue;
    row[i] = kept.size();
    kept.push_back(std::move(transport.stops[i]));
  }
  transport.stops = std::move(kept);
  for (LinePart& part : transport.parts)
    for (ServedStop& served : part.stops) served.stop = row[served.stop];
}

}  // namespace

PublicTransport place_lines(const LineGround& ground, const MapLines& lines, LineReport& report) {
  PublicTransport transport;
  StopPlacer placer(ground.road, ground.projection);
  report.others = lines.others;
  for (const MapLine& line : lines.lines) {
    ++report.found[line.kind];
    const bool names_stops = !line.stops.empty();
    std::string why;
    auto parts = parts_of(ground, line, names_stops ? line.stops : lines.stops,
                          line.directed && names_stops, placer, why);
    if (parts.empty()) {
      report.left_out.emplace_back(full_name(line), why);
      continue;
    }
    ++report.driven;
    if (!names_stops) report.at_all_stops.push_back(full_name(line));
    for (LinePart& part : parts) transport.parts.push_back(std::move(part));
  }
  transport.stops = placer.take();
  keep_served(transport);
  return transport;
}

}  // namespace sumogamma::osm
