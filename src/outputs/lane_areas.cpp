#include "outputs/lane_areas.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/xml_text.h"

namespace sumogamma {

namespace {

constexpr double kUnset = std::numeric_limits<double>::max();

}  // namespace

LaneArea::LaneArea(const RoadNetwork& network, const AskedOutput& output,
                   std::shared_ptr<SumoFile> file, double run_begin, double step)
    : file_(std::move(file)),
      id_(attribute_or(output.attributes, "id")),
      halting_speed_(number_of(output, output.attributes, "speedThreshold", 5.0 / 3.6)),
      halting_time_(time_of(output, {"timeThreshold"}, 1.0)),
      step_(step),
      types_(attribute_or(output.attributes, "vTypes")),
      intervals_(time_of(output, {"period", "freq"}, 0.0), run_begin, run_begin) {
  set_pieces(network, output);
}

/// The lanes within junctions between the last piece and `to`.
void LaneArea::append_links(const RoadNetwork& network, const AskedOutput& output, LaneId to,
                            double& offset) {
  LaneId lane = pieces_.back().lane;
  for (bool found = false; !found;) {
    LaneId next = kNoLane;
    for (const ConnectionId id : network.lane(lane).outgoing) {
      const Connection& link = network.connection(id);
      if (link.to == to) next = link.via != kNoLane ? link.via : link.to;
    }
    if (next == kNoLane)
      throw Error(output.source, output.what + " " + id_ + ": no link leads from lane '" +
                                     network.lane(lane).name + "' to '" + network.lane(to).name +
                                     "'");
    found = next == to;
    if (found) break;
    pieces_.push_back({next, offset});
    offset += network.lane(next).length;
    lane = next;
  }
}

void LaneArea::set_pieces(const RoadNetwork& network, const AskedOutput& output) {
  const auto& attributes = output.attributes;
  double begin = number_of(output, attributes, "pos", kUnset);
  double end = number_of(output, attributes, "endPos", kUnset);
  const double length = number_of(output, attributes, "length", kUnset);
  std::vector<LaneId> lanes;
  for (const std::string& name : words_of(attribute_or(attributes, "lanes")))
    lanes.push_back(lane_of(network, output, {{"lane", name}}, "lane"));
  if (lanes.empty()) {
    const bool named = attributes.contains("lane");
    lanes.push_back(lane_of(network, output, attributes, named ? "lane" : "id"));
    const Lane& lane = network.lane(lanes.front());
    // from the other two where the lane's ends aren't meant
    if (end != kUnset && end < 0.0) end += lane.length;
    if (begin != kUnset && begin < 0.0) begin += lane.length;
    if (length != kUnset && length > 0.0 && begin == kUnset && end != kUnset) begin = end - length;
    if (length != kUnset && length > 0.0 && end == kUnset && begin != kUnset) end = begin + length;
    constexpr double kRounded = 0.1;  // SUMO's POSITION_EPS [m]
    if ((begin != kUnset && begin < -kRounded) || (end != kUnset && end > lane.length + kRounded))
      throw Error(output.source,
                  output.what + " " + id_ +
                      ": reaches over its lane's ends; name its lanes in the "
                      "attribute lanes, with pos on the first and endPos on the last");
  }
  const Lane& first = network.lane(lanes.front());
  const Lane& last = network.lane(lanes.back());
  begin = begin == kUnset ? 0.0 : place_on(first, begin);
  end = end == kUnset ? last.length : place_on(last, end);
  double offset = -begin;
  for (const LaneId lane : lanes) {
    if (!pieces_.empty()) append_links(network, output, lane, offset);
    pieces_.push_back({lane, offset});
    offset += network.lane(lane).length;
  }
  length_ = offset - last.length + end;
  if (length_ <= 0.0)
    throw Error(output.source, output.what + " " + id_ + ": ends before it begins");
}

void LaneArea::add(const OutputStep& step) {
  seen_.clear();
  std::map<std::uint32_t, std::pair<const LanePassage*, double>> foremost;
  std::set<std::uint32_t> gone;
  for (const Piece& piece : pieces_)
    for (const LanePassage& passage : step.passages_on(piece.lane)) {
      if (!types_.counts(step.vehicle(passage))) continue;
      if (passage.exit != LaneExit::None && passage.exit != LaneExit::Junction)
        gone.insert(passage.vehicle);
      if (passage.duration <= 0.0) continue;
      auto& [best, offset] = foremost[passage.vehicle];
      if (best != nullptr && offset > piece.offset) continue;
      best = &passage;
      offset = piece.offset;
    }
  for (const auto& [vehicle, place] : foremost)
    see(*place.first, place.second, step.vehicles[vehicle]);
  // who changed lanes, arrived, or turned off before the end
  std::erase_if(inside_, [&](std::uint32_t vehicle) {
    const bool left = gone.contains(vehicle) || !foremost.contains(vehicle);
    left_ += left ? 1 : 0;
    return left;
  });
  add_jams();
  if (intervals_.is_over(step.end, false)) write(step.end);
}

void LaneArea::finish(double time) {
  if (intervals_.is_over(time, true)) write(time);
}

void LaneArea::see(const LanePassage& passage, double offset, const OutputVehicle& vehicle) {
  const double from = passage.from + offset, to = passage.to + offset;
  if (to <= 0.0) return;
  const double leaves_at = length_ + vehicle.length;
  if (from >= leaves_at) return;
  if (inside_.insert(passage.vehicle).second) {
    ++entered_;
    ++seen_number_;
  }
  // the time that some of it is on the detector
  const double enters = from < 0.0 ? passage.passing_time(-offset) : 0.0;
  const double leaves =
      to > leaves_at ? passage.passing_time(leaves_at - offset) : passage.duration;
  const double time = leaves - enters;
  samples_ += time;
  speed_sum_ += passage.speed * time;
  if (passage.to == passage.from)
    time_loss_ += time;
  else if (passage.free_speed > 0.0)
    time_loss_ += std::max(0.0, time * (passage.free_speed - passage.speed) / passage.free_speed);
  const double on = std::min(vehicle.length, to) + std::min(0.0, length_ - to);
  seen_.push_back({passage.vehicle, length_ - to, std::max(0.0, on), passage.speed});
  if (to >= leaves_at) {
    inside_.erase(passage.vehicle);
    ++left_;
  }
}

bool LaneArea::is_jammed(const Seen& seen, std::map<std::uint32_t, Halt>& halts) {
  const auto before = halting_.find(seen.vehicle);
  if (seen.speed >= halting_speed_) {
    if (before != halting_.end()) halts_over_.push_back(before->second);
    return false;
  }
  Halt halt = before == halting_.end() ? Halt{} : before->second;
  if (before == halting_.end()) ++halts_begun_;
  halt.whole += step_;
  halt.in_interval += step_;
  halts.emplace(seen.vehicle, halt);
  return halt.whole > halting_time_ + 1e-6;
}

void LaneArea::add_jams() {
  std::sort(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) {
    return std::pair(a.to_end, a.vehicle) < std::pair(b.to_end, b.vehicle);
  });
  double occupied = 0.0, longest = 0.0;
  std::int64_t most = 0;
  // a queue is of all who halt with nobody between them who doesn't: in 1.15 SUMO's jamThreshold
  // parts none
  const Seen *first = nullptr, *last = nullptr;
  std::int64_t number = 0;
  const auto close = [&] {
    if (first == nullptr) return;
    const double meters = std::max(last->to_end, 0.0) - std::max(first->to_end, 0.0) + last->length;
    jam_sum_ += meters;
    jam_vehicles_sum_ += number;
    longest = std::max(longest, meters);
    most = std::max(most, number);
    first = nullptr;
    number = 0;
  };
  std::map<std::uint32_t, Halt> halts;
  for (const Seen& seen : seen_) {
    occupied += seen.length;
    if (!is_jammed(seen, halts)) {
      close();
      continue;
    }
    if (first == nullptr) first = &seen;
    last = &seen;
    ++number;
  }
  close();
  halting_ = std::move(halts);
  const double share = 100.0 * occupied / length_;
  ++steps_;
  occupancy_sum_ += share;
  occupancy_most_ = std::max(occupancy_most_, share);
  jam_mean_ += longest;
  jam_vehicles_mean_ += most;
  jam_most_ = std::max(jam_most_, longest);
  jam_vehicles_most_ = std::max(jam_vehicles_most_, most);
  vehicles_sum_ += static_cast<std::int64_t>(seen_.size());
  vehicles_most_ = std::max(vehicles_most_, static_cast<std::int64_t>(seen_.size()));
}

void LaneArea::write(double time) {
  const auto steps = static_cast<double>(std::max<std::int64_t>(steps_, 1));
  file_->open("interval").time("begin", intervals_.begin()).time("end", time).word("id", id_);
  file_->number("sampledSeconds", samples_).count("nVehEntered", entered_);
  file_->count("nVehLeft", left_).count("nVehSeen", seen_number_);
  file_->number("meanSpeed", samples_ > 0.0 ? speed_sum_ / samples_ : -1.0);
  file_->number("meanTimeLoss",
                seen_number_ > 0 ? time_loss_ / static_cast<double>(seen_number_) : -1.0);
  file_->number("meanOccupancy", occupancy_sum_ / steps).number("maxOccupancy", occupancy_most_);
  file_->number("meanMaxJamLengthInVehicles", static_cast<double>(jam_vehicles_mean_) / steps);
  file_->number("meanMaxJamLengthInMeters", jam_mean_ / steps);
  file_->count("maxJamLengthInVehicles", jam_vehicles_most_);
  file_->number("maxJamLengthInMeters", jam_most_);
  file_->count("jamLengthInVehiclesSum", jam_vehicles_sum_);
  file_->number("jamLengthInMetersSum", jam_sum_);
  write_halts();
  file_->number("startedHalts", static_cast<double>(halts_begun_));
  file_->number("meanVehicleNumber", static_cast<double>(vehicles_sum_) / steps);
  file_->count("maxVehicleNumber", vehicles_most_).close();

  seen_number_ -= left_;
  samples_ = speed_sum_ = time_loss_ = occupancy_sum_ = occupancy_most_ = 0.0;
  jam_sum_ = jam_mean_ = jam_most_ = 0.0;
  jam_vehicles_sum_ = jam_vehicles_mean_ = jam_vehicles_most_ = 0;
  entered_ = left_ = steps_ = halts_begun_ = vehicles_sum_ = vehicles_most_ = 0;
  for (auto& [vehicle, halt] : halting_) halt.in_interval = 0.0;
  halts_over_.clear();
  intervals_.next(time);
}

void LaneArea::write_halts() {
  double sum = 0.0, most = 0.0, sum_within = 0.0, most_within = 0.0;
  double number = 0.0;
  const auto count = [&](const Halt& halt) {
    sum += halt.whole;
    most = std::max(most, halt.whole);
    sum_within += halt.in_interval;
    most_within = std::max(most_within, halt.in_interval);
    number += 1.0;
  };
  for (const Halt& halt : halts_over_) count(halt);
  for (const auto& [vehicle, halt] : halting_) count(halt);
  const double all = std::max(number, 1.0);
  file_->time("meanHaltingDuration", sum / all).time("maxHaltingDuration", most);
  file_->time("haltingDurationSum", sum).time("meanIntervalHaltingDuration", sum_within / all);
  file_->time("maxIntervalHaltingDuration", most_within);
  file_->time("intervalHaltingDurationSum", sum_within);
}

}  // namespace sumogamma
