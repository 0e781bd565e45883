#include "outputs/mean_data.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/xml_text.h"

namespace sumogamma {

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr double kSame = 1e-6;

/// The time of a step for which a vehicle is on a lane, and when it comes and goes [s].
struct TimeOnLane {
  double front_enters = 0, front_leaves = 0, back_enters = 0, back_leaves = 0;
};

TimeOnLane time_on_lane(const LanePassage& passage, double length, double lane_length) {
  const auto passing = [&](double place, double offset) {
    const double from = passage.from - offset, to = passage.to - offset;
    if (to <= place) return passage.duration;
    return from >= place ? 0.0 : passage.passing_time(place, offset);
  };
  return {passage.from >= 0.0 ? 0.0 : passing(0.0, 0.0), passing(lane_length, 0.0),
          passing(0.0, length), passing(lane_length, length)};
}

/// The length on the lane with the front there [m].
double length_on_lane(double front, double length, double lane_length) {
  return std::max(0.0, std::min({lane_length, length, length - (front - lane_length), front}));
}

/// Integrated over a step: it is linear between the moments at which an end comes or goes [m s].
double occupied_by(const LanePassage& passage, double length, double lane_length,
                   const TimeOnLane& times) {
  double moments[] = {times.front_enters, times.front_leaves, times.back_enters, times.back_leaves};
  std::sort(std::begin(moments), std::end(moments));
  const double speed =
      passage.duration > 0.0 ? (passage.to - passage.from) / passage.duration : 0.0;
  double sum = 0.0, before = 0.0;
  const auto occupied = [&](double time) {
    return length_on_lane(passage.from + speed * time, length, lane_length);
  };
  for (const double moment : moments) {
    sum += 0.5 * (moment - before) * (occupied(before) + occupied(moment));
    before = moment;
  }
  return sum + 0.5 * (passage.duration - before) * (occupied(before) + occupied(passage.duration));
}

/// SUMO looks at the first letter.
bool is_yes(std::string_view text) {
  return !text.empty() && std::string_view("tT1x").find(text.front()) != std::string_view::npos;
}

/// The options edgedata-output and lanedata-output have no attributes: SUMO's own defaults.
bool is_option(const AskedOutput& output) { return output.what.ends_with("-output"); }

std::string id_of(const AskedOutput& output) {
  if (!is_option(output)) return std::string(attribute_or(output.attributes, "id"));
  return output.what == "edgedata-output" ? "DEFAULT_EDGEDATA" : "DEFAULT_LANEDATA";
}

double end_of(const AskedOutput& output) {
  const double end = time_of(output, {"end"}, -1.0);
  return end < 0.0 ? kForever : end;
}

}  // namespace

bool LaneSums::is_empty() const {
  return sampled == 0.0 && departed == 0 && arrived == 0 && entered == 0 && left == 0 &&
         changed_from == 0 && changed_to == 0;
}

LaneSums& LaneSums::operator+=(const LaneSums& other) {
  sampled += other.sampled;
  travelled += other.travelled;
  front_time += other.front_time;
  front_way += other.front_way;
  length_time += other.length_time;
  occupied += other.occupied;
  waiting += other.waiting;
  time_loss += other.time_loss;
  if (other.shortest > 0.0)
    shortest = shortest > 0.0 ? std::min(shortest, other.shortest) : other.shortest;
  departed += other.departed;
  arrived += other.arrived;
  entered += other.entered;
  left += other.left;
  changed_from += other.changed_from;
  changed_to += other.changed_to;
  return *this;
}

MeanData::MeanData(const RoadNetwork& network, const AskedOutput& output,
                   std::shared_ptr<SumoFile> file, double run_begin, double step)
    : network_(network),
      file_(std::move(file)),
      id_(id_of(output)),
      by_lane_(output.what == "laneData" || output.what == "lanedata-output"),
      least_samples_(number_of(output, output.attributes, "minSamples", 0.0)),
      longest_travel_time_(number_of(output, output.attributes, "maxTraveltime", 100000.0)),
      halting_speed_(number_of(output, output.attributes, "speedThreshold", 0.1)),
      begin_(std::max(run_begin, time_of(output, {"begin"}, run_begin))),
      end_(end_of(output)),
      step_(step),
      types_(attribute_or(output.attributes, "vTypes")),
      intervals_(time_of(output, {"period", "freq"}, end_ < kForever ? end_ - begin_ : 0.0),
                 time_of(output, {"begin"}, run_begin), run_begin),
      counted_(network.edges.size(), false),
      sums_(network.lanes.size()) {
  const std::string_view exclude = attribute_or(output.attributes, "excludeEmpty", "false");
  with_defaults_ = exclude == "defaults";
  with_empty_ = !is_option(output) && (with_defaults_ || !is_yes(exclude));
  for (std::string& name : words_of(attribute_or(output.attributes, "writeAttributes")))
    attributes_.insert(std::move(name));
  for (const std::string& name : words_of(attribute_or(output.attributes, "edges"))) {
    const auto edge = network.edge_by_name.find(name);
    if (edge == network.edge_by_name.end())
      throw Error(output.source, output.what + " " + id_ + " names the edge '" + name +
                                     "', which the network doesn't have");
    edges_.push_back(edge->second);
  }
  const bool inside = is_yes(attribute_or(output.attributes, "withInternal"));
  const bool all = edges_.empty();
  for (std::size_t i = 0; all && i < network.edges.size(); ++i) {
    const LaneKind kind = network.edges[i].kind;
    if (kind == LaneKind::Normal || (inside && kind == LaneKind::Internal))
      edges_.push_back(static_cast<EdgeId>(i));
  }
  for (const EdgeId edge : edges_) counted_[index_of(edge)] = true;
}

void MeanData::count(const LanePassage& passage, const OutputVehicle& vehicle,
                     LaneSums& sums) const {
  sums.departed += passage.entry == LaneEntry::Departed ? 1 : 0;
  sums.entered += passage.entry == LaneEntry::Junction || passage.entry == LaneEntry::Placed;
  sums.changed_to += passage.entry == LaneEntry::LaneChange ? 1 : 0;
  sums.arrived += passage.exit == LaneExit::Arrived ? 1 : 0;
  sums.left += passage.exit == LaneExit::Junction || passage.exit == LaneExit::Taken;
  sums.changed_from += passage.exit == LaneExit::LaneChange ? 1 : 0;
  if (passage.duration <= 0.0) return;
  const double lane_length = network_.lane(passage.lane).length;
  const TimeOnLane times = time_on_lane(passage, vehicle.length, lane_length);
  const double time = times.back_leaves - times.front_enters;
  if (time <= 0.0) return;
  const double front_time = std::max(0.0, times.front_leaves - times.front_enters);
  sums.sampled += time;
  sums.travelled += time * passage.speed;
  sums.front_time += front_time;
  sums.front_way += front_time * passage.speed;
  sums.length_time += vehicle.length * time;
  sums.occupied += occupied_by(passage, vehicle.length, lane_length, times);
  const double with_gap = vehicle.length + vehicle.min_gap;
  sums.shortest = sums.shortest > 0.0 ? std::min(sums.shortest, with_gap) : with_gap;
  if (passage.stopped) return;
  if (passage.speed < halting_speed_) sums.waiting += time;
  if (passage.free_speed > 0.0)
    sums.time_loss += time * std::max(0.0, passage.free_speed - passage.speed) / passage.free_speed;
}

void MeanData::add(const OutputStep& step) {
  if (step.begin < begin_ - kSame) return;
  for (const LanePassage& passage : step.passages()) {
    const OutputVehicle& vehicle = step.vehicle(passage);
    if (counted_[index_of(network_.lane(passage.lane).edge)] && types_.counts(vehicle))
      count(passage, vehicle, sums_[index_of(passage.lane)]);
  }
  if (intervals_.is_over(step.end, false)) write(step.end);
}

void MeanData::finish(double time) {
  if (intervals_.is_over(time, true)) write(time);
}

void MeanData::write(double time) {
  const double from = intervals_.begin();
  // one that began before the run, off the raster of its period, is left out, as by SUMO
  if (from >= begin_ - kSame && end_ - step_ >= from - kSame) {
    file_->open("interval").time("begin", from).time("end", time).word("id", id_);
    for (const EdgeId edge : edges_) write_edge(network_.edge(edge), time - from);
    file_->close();
  }
  std::fill(sums_.begin(), sums_.end(), LaneSums{});
  intervals_.next(time);
}

void MeanData::write_edge(const Edge& edge, double period) {
  if (edge.lanes.empty()) return;
  if (!by_lane_) {
    LaneSums all;
    for (const LaneId lane : edge.lanes) all += sums_[index_of(lane)];
    if (all.is_empty() && !with_empty_) return;
    file_->open("edge").word("id", edge.name);
    write_sums(all, network_.lane(edge.lanes.front()), static_cast<double>(edge.lanes.size()),
               period);
    return;
  }
  const bool any = std::any_of(edge.lanes.begin(), edge.lanes.end(),
                               [&](LaneId lane) { return !sums_[index_of(lane)].is_empty(); });
  if (!any && !with_empty_) return;
  file_->open("edge").word("id", edge.name);
  for (const LaneId lane : edge.lanes) {
    if (sums_[index_of(lane)].is_empty() && !with_empty_) continue;
    file_->open("lane").word("id", network_.lane(lane).name);
    write_sums(sums_[index_of(lane)], network_.lane(lane), 1.0, period);
  }
  file_->close();
}

void MeanData::write_sums(const LaneSums& sums, const Lane& lane, double lanes, double period) {
  number("sampledSeconds", sums.sampled);
  if (sums.sampled > least_samples_) {
    write_flow(sums, lane, lanes, period);
  } else if (with_defaults_ && lane.speed_limit > 0.0) {
    number("traveltime", lane.length / lane.speed_limit);
    number("speed", lane.speed_limit);
    number("speedRelative", 1.0);
  }
  write_counts(sums);
  file_->close();
}

void MeanData::write_flow(const LaneSums& sums, const Lane& lane, double lanes, double period) {
  const double density = std::min(1000.0 * sums.sampled / period / lane.length,
                                  1000.0 * lanes / std::max(sums.shortest, 1e-3));
  if (sums.front_way > 1e-3)
    number("traveltime",
           std::min(longest_travel_time_, lane.length * sums.front_time / sums.front_way));
  else if (with_defaults_ && lane.speed_limit > 0.0)
    number("traveltime", lane.length / lane.speed_limit);
  const double way = lane.length + sums.length_time / sums.sampled;
  number("overlapTraveltime",
         sums.travelled > 0.0 ? std::min(longest_travel_time_, way * sums.sampled / sums.travelled)
                              : longest_travel_time_);
  number("density", density);
  number("laneDensity", density / lanes);
  number("occupancy", 100.0 * sums.occupied / period / lane.length / lanes);
  number("waitingTime", sums.waiting);
  number("timeLoss", sums.time_loss);
  const double speed = sums.travelled / sums.sampled;
  number("speed", speed);
  number("speedRelative", lane.speed_limit > 0.0 ? speed / lane.speed_limit : 0.0);
}

void MeanData::write_counts(const LaneSums& sums) {
  count("departed", sums.departed);
  count("arrived", sums.arrived);
  count("entered", sums.entered);
  count("left", sums.left);
  count("laneChangedFrom", sums.changed_from);
  count("laneChangedTo", sums.changed_to);
}

void MeanData::number(std::string_view name, double value) {
  if (attributes_.empty() || attributes_.contains(name)) file_->number(name, value);
}

void MeanData::count(std::string_view name, std::int64_t value) {
  if (attributes_.empty() || attributes_.contains(name)) file_->count(name, value);
}

}  // namespace sumogamma
