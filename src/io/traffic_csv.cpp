#include "io/traffic_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "base/csv_text.h"

namespace sumogamma {

namespace {

/// Of a polygon [m^2].
double area_of(std::span<const Vec2> outline) {
  double doubled = 0;
  for (std::size_t k = 0; k < outline.size(); ++k)
    doubled += cross(outline[k], outline[(k + 1) % outline.size()]);
  return 0.5 * std::abs(doubled);
}

void append_lane_line(const LaneInterval& interval, const Presence& presence, std::string_view type,
                      const RoadNetwork& network, std::string& text) {
  const Lane& lane = network.lane(interval.lane);
  const bool has_length = lane.kind != LaneKind::WalkingArea;
  const double length = has_length ? lane.centerline.length() : 0.0;
  const double area = has_length ? length * lane.width : area_of(lane.outline);
  const EdieFigures figures = edie_figures(presence, length, area, interval.end - interval.begin);
  text += fmt::format("{:.2f},{:.2f},{},{},{},", interval.begin, interval.end,
                      csv_field(network.edge(lane.edge).name), csv_field(lane.name), type);
  if (length > 0.0)
    text += fmt::format("{:.2f},{:.4f},", 3600.0 * figures.flow, 1000.0 * figures.density);
  else
    text += ",,";
  text += fmt::format("{:.6f},{:.3f},{:.2f},{:.2f},{:.2f},{:.2f}\n", figures.area_density,
                      figures.speed, presence.time, presence.distance, presence.waiting,
                      presence.delay);
}

}  // namespace

std::string lanes_csv(std::span<const LaneInterval> intervals, const RoadNetwork& network,
                      const AgentTypeTable& types) {
  std::string text =
      "begin_s,end_s,edge,lane,type,flow_per_h,density_per_km,density_per_m2,speed,agent_s,"
      "distance_m,waiting_s,delay_s\n";
  for (std::size_t first = 0; first < intervals.size();) {
    Presence all;
    std::size_t last = first;
    for (; last < intervals.size() && intervals[last].lane == intervals[first].lane &&
           intervals[last].begin == intervals[first].begin;
         ++last)
      all.add(intervals[last].presence);
    append_lane_line(intervals[first], all, "all", network, text);
    for (; first < last; ++first)
      append_lane_line(intervals[first], intervals[first].presence,
                       csv_field(type_of(types, intervals[first].type).name), network, text);
  }
  return text;
}

std::string traffic_csv(std::span<const TypeInterval> intervals, const AgentTypeTable& types) {
  std::string text =
      "begin_s,end_s,type,entered,left,mean_alive,mean_speed,distance_m,waiting_s,delay_s\n";
  for (const TypeInterval& one : intervals) {
    const Presence& sums = one.presence;
    text += fmt::format("{:.2f},{:.2f},{},{},{},{:.3f},{:.3f},{:.2f},{:.2f},{:.2f}\n", one.begin,
                        one.end, csv_field(type_of(types, one.type).name), one.entered, one.left,
                        sums.time / (one.end - one.begin),
                        sums.time > 0.0 ? sums.distance / sums.time : 0.0, sums.distance,
                        sums.waiting, sums.delay);
  }
  return text;
}

std::string journeys_csv(std::span<const AgentJourney> journeys, const AgentTypeTable& types,
                         const std::function<std::string_view(AgentId)>& name_of) {
  std::string text = "agent,type,entered_s,left_s,distance_m,mean_speed,waiting_s,delay_s\n";
  for (const AgentJourney& one : journeys) {
    const Presence& sums = one.presence;
    text +=
        fmt::format("{},{},{:.2f},{},{:.2f},{:.3f},{:.2f},{:.2f}\n", csv_field(name_of(one.id)),
                    csv_field(type_of(types, one.type).name), one.entered,
                    one.left < 0.0 ? "" : fmt::format("{:.2f}", one.left), sums.distance,
                    sums.time > 0.0 ? sums.distance / sums.time : 0.0, sums.waiting, sums.delay);
  }
  return text;
}

}  // namespace sumogamma
