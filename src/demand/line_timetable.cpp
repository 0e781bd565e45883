#include "demand/line_timetable.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>

#include "demand/draws.h"
#include "demand/route_fit.h"

namespace sumogamma {

namespace {

/// The row of the route on which a bus is after so many seconds, or the next one that is long
/// enough to appear on and before the last stop; past the end where there is none.
std::size_t row_after(const RoadNetwork& road, const AgentType& bus, const LinePart& part,
                      const std::vector<double>& arrival, double seconds) {
  std::size_t row = 0;
  while (row < part.route.size() && arrival[row + 1] <= seconds) ++row;
  while (row < part.route.size() &&
         road.lane(road.edge(part.route[row]).lanes.front()).length < bus.length + 8.0)
    ++row;
  return row < part.stops.back().edge ? row : part.route.size();
}

/// Can a bus that has come by the route from row `begin` go on to row `next`?
bool leads_on(const RoadNetwork& road, const AgentType& bus, const LinePart& part,
              std::size_t begin, std::size_t next) {
  const std::size_t first = std::max(begin + 2, next) - 2;  // the last turn and the lanes before it
  return suits(road, bus, std::span(part.route).subspan(first, next + 1 - first));
}

/// Rows [begin, end) of a part; none where they hold fewer than two stops.
std::optional<LinePart> piece_of(const LinePart& part, std::size_t begin, std::size_t end) {
  LinePart piece{part.id, part.line, part.kind, part.headway, {}, {}};
  for (const ServedStop& served : part.stops)
    if (served.edge >= begin && served.edge < end)
      piece.stops.push_back({served.stop, served.edge - begin});
  if (piece.stops.size() < 2) return std::nullopt;
  piece.route.assign(part.route.begin() + static_cast<std::ptrdiff_t>(begin),
                     part.route.begin() + static_cast<std::ptrdiff_t>(end));
  return piece;
}

}  // namespace

std::vector<double> arrival_times(const RoadNetwork& road, const AgentType& bus,
                                  const LinePart& part, double slowness) {
  std::vector<double> times{0.0};
  const VehicleClassMask mask = vehicle_class_from_name(bus.sumo_class);
  std::size_t stop = 0;
  for (std::size_t row = 0; row < part.route.size(); ++row) {
    double limit = 0.5, length = 0;
    for (const LaneId id : road.edge(part.route[row]).lanes) {
      const Lane& lane = road.lane(id);
      length = lane.length;
      if ((lane.allowed & mask) != 0) limit = std::max(limit, lane.speed_limit);
    }
    double seconds = slowness * length / std::min(limit, bus.max_speed);
    for (; stop < part.stops.size() && part.stops[stop].edge == row; ++stop) seconds += kDwell;
    times.push_back(times.back() + seconds);
  }
  return times;
}

std::vector<LinePart> drivable_parts(const RoadNetwork& road, const AgentType& bus,
                                     const std::vector<LinePart>& parts, TransportDemand& report) {
  std::vector<LinePart> drivable;
  for (const LinePart& part : parts) {
    std::size_t begin = 0, pieces = 0;
    for (std::size_t end = 1; end <= part.route.size(); ++end) {
      if (end < part.route.size() && leads_on(road, bus, part, begin, end)) continue;
      std::optional<LinePart> piece = piece_of(part, begin, end);
      begin = end;
      if (!piece) continue;
      if (pieces++ > 0) piece->id += "." + std::to_string(pieces);
      drivable.push_back(std::move(*piece));
    }
    if (pieces == 0)
      report.left_out.emplace_back(
          part.line + " (" + part.id + ")",
          "turns or lane changes that no bus can drive leave no two of its stops together");
  }
  // SUMO lets people into any bus of a line that they ask for, the other direction's, too
  std::map<std::string, int> of_line;
  for (LinePart& part : drivable) {
    const int number = of_line[part.line]++;
    part.line += ":" + std::to_string(number);
  }
  return drivable;
}

std::vector<BusRun> line_timetable(const RoadNetwork& road, const AgentType& bus,
                                   const DemandRequest& request, TransportDemand& report) {
  std::vector<BusRun> runs;
  const AskedTransport& asked = *request.transport;
  for (std::size_t i = 0; i < asked.transport.parts.size(); ++i) {
    const LinePart& part = asked.transport.parts[i];
    const std::vector<double> arrival = arrival_times(road, bus, part, request.slowness);
    const double headway = part.headway > 0 ? part.headway : asked.headway;
    DemandDraws draws(request.seed, 3000000 + i);
    const double phase = headway * draws.uniform();
    long number = 0;
    const auto add = [&](double time, std::size_t first) {
      runs.push_back(
          {"bus." + part.id + "." + std::to_string(number++), &part, time, arrival, first});
    };
    for (double back = std::ceil(arrival.back() / headway); back >= 1; --back) {
      const std::size_t row = row_after(road, bus, part, arrival, back * headway - phase);
      const double time = draws.uniform(0, std::min(request.warm_up, request.duration));
      if (row >= part.route.size()) continue;
      add(time, row);
      ++report.initial;
    }
    for (double time = phase; time < request.duration; time += headway) add(time, 0);
    report.alive += arrival.back() / headway;
    ++report.parts;
  }
  std::stable_sort(runs.begin(), runs.end(),
                   [](const BusRun& a, const BusRun& b) { return a.time < b.time; });
  report.buses = static_cast<long>(runs.size());
  return runs;
}

}  // namespace sumogamma
