#include "outputs/induction_loops.h"

#include <algorithm>
#include <utility>

namespace sumogamma {

namespace {

/// Does a vehicle come upon a lane from beside, or begin there?
bool comes_from_beside(const LanePassage& passage) {
  return passage.entry != LaneEntry::None && passage.entry != LaneEntry::Junction;
}

bool goes_off(const LanePassage& passage) {
  return passage.exit != LaneExit::None && passage.exit != LaneExit::Junction;
}

}  // namespace

InductionLoop::InductionLoop(const RoadNetwork& network, const AskedOutput& output,
                             std::shared_ptr<SumoFile> file, double run_begin, double step)
    : file_(std::move(file)),
      id_(attribute_or(output.attributes, "id")),
      lane_(lane_of(network, output, output.attributes, "lane")),
      place_(place_on(network.lane(lane_), number_of(output, output.attributes, "pos", 0.0))),
      end_(place_ + number_of(output, output.attributes, "length", 0.0)),
      step_(step),
      types_(attribute_or(output.attributes, "vTypes")),
      intervals_(time_of(output, {"period", "freq"}, 0.0), run_begin, run_begin) {}

void InductionLoop::add(const OutputStep& step) {
  for (const LanePassage& passage : step.passages_on(lane_))
    if (types_.counts(step.vehicle(passage))) pass(passage, step.vehicle(passage));
  if (intervals_.is_over(step.end, false)) write(step.end);
}

void InductionLoop::finish(double time) {
  if (intervals_.is_over(time, true)) write(time);
}

void InductionLoop::pass(const LanePassage& passage, const OutputVehicle& vehicle) {
  const double back = passage.from - vehicle.length, new_back = passage.to - vehicle.length;
  const bool begins_upon = comes_from_beside(passage) && passage.from >= place_ && back < place_;
  if (begins_upon || (passage.from < place_ && passage.to >= place_)) {
    upon_[passage.vehicle] = passage.begin + (begins_upon ? 0.0 : passage.passing_time(place_));
    ++entered_;
  }
  if (new_back > end_ && back <= end_)
    leave(passage, vehicle, passage.begin + passage.passing_time(end_, vehicle.length), false);
  if (goes_off(passage)) leave(passage, vehicle, passage.begin + step_, true);
}

void InductionLoop::leave(const LanePassage& passage, const OutputVehicle& vehicle, double time,
                          bool early) {
  const auto upon = upon_.find(passage.vehicle);
  if (upon == upon_.end()) return;
  passed_.push_back({upon->second, time, vehicle.length, early});
  upon_.erase(upon);
}

void InductionLoop::write(double time) {
  const double from = intervals_.begin(), period = time - from;
  double occupied = 0.0, speeds = 0.0, slowness = 0.0, lengths = 0.0;
  std::int64_t counted = 0;
  for (const Passed& one : passed_) {
    occupied += std::min(one.left - std::max(from, one.entered), period);
    if (one.left_early) continue;
    const double speed = one.length / std::max(one.left - one.entered, 1e-3);
    speeds += speed;
    slowness += 1.0 / speed;
    lengths += one.length;
    ++counted;
  }
  for (const auto& [vehicle, since] : upon_) occupied += time - std::max(from, since);
  const auto number = static_cast<double>(counted);
  const auto mean = [&](double sum) { return counted > 0 ? sum / number : -1.0; };
  file_->open("interval").number("begin", from).number("end", time).word("id", id_);
  file_->count("nVehContrib", counted).number("flow", number / period * 3600.0);
  file_->number("occupancy", 100.0 * occupied / period).number("speed", mean(speeds));
  file_->number("harmonicMeanSpeed", counted > 0 ? number / slowness : -1.0);
  file_->number("length", mean(lengths)).count("nVehEntered", entered_).close();
  passed_.clear();
  entered_ = 0;
  intervals_.next(time);
}

InstantLoop::InstantLoop(const RoadNetwork& network, const AskedOutput& output,
                         std::shared_ptr<SumoFile> file, double step)
    : file_(std::move(file)),
      id_(attribute_or(output.attributes, "id")),
      lane_(lane_of(network, output, output.attributes, "lane")),
      place_(place_on(network.lane(lane_), number_of(output, output.attributes, "pos", 0.0))),
      step_(step),
      types_(attribute_or(output.attributes, "vTypes")) {}

void InstantLoop::add(const OutputStep& step) {
  for (const LanePassage& passage : step.passages_on(lane_))
    if (types_.counts(step.vehicle(passage))) pass(passage, step.vehicle(passage));
}

void InstantLoop::pass(const LanePassage& passage, const OutputVehicle& vehicle) {
  // SUMO tells these times a step earlier than those of its other detectors
  const double begin = passage.begin - step_;
  if (passage.from < place_ && passage.to >= place_) {
    const double time = begin + passage.passing_time(place_);
    if (last_left_ >= 0.0)
      write("enter", time, passage.speed, vehicle, "gap", time - last_left_);
    else
      write("enter", time, passage.speed, vehicle);
    upon_[passage.vehicle] = time;
  }
  const auto upon = upon_.find(passage.vehicle);
  if (passage.duration > 0.0 && passage.to - vehicle.length > place_) {
    if (upon == upon_.end()) return;
    const double time = begin + passage.passing_time(place_, vehicle.length);
    write("leave", time, passage.speed, vehicle, "occupancy", time - upon->second);
    last_left_ = time;
    upon_.erase(upon);
  } else if (passage.duration > 0.0 && passage.to >= place_) {
    write("stay", passage.begin, passage.speed, vehicle);
  }
  if (goes_off(passage) && upon_.erase(passage.vehicle) > 0)
    write("leave", passage.begin, passage.speed, vehicle);
}

void InstantLoop::write(const char* state, double time, double speed, const OutputVehicle& vehicle,
                        const char* further, double value) {
  file_->open("instantOut").word("id", id_).number("time", time).word("state", state);
  file_->word("vehID", vehicle.name).number("speed", speed).number("length", vehicle.length);
  file_->word("type", vehicle.type);
  if (further != nullptr) file_->number(further, value);
  file_->close();
}

}  // namespace sumogamma
