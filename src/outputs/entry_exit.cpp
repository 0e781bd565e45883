#include "outputs/entry_exit.h"

#include <algorithm>
#include <utility>

namespace sumogamma {

EntryExit::EntryExit(const RoadNetwork& network, const AskedOutput& output,
                     std::shared_ptr<SumoFile> file, double run_begin, double step)
    : file_(std::move(file)),
      id_(attribute_or(output.attributes, "id")),
      halting_speed_(number_of(output, output.attributes, "speedThreshold", 5.0 / 3.6)),
      halting_time_(time_of(output, {"timeThreshold"}, 1.0)),
      step_(step),
      types_(attribute_or(output.attributes, "vTypes")),
      intervals_(time_of(output, {"period", "freq"}, 0.0), run_begin, run_begin) {
  for (const auto& [kind, attributes] : output.parts) {
    const LaneId lane = lane_of(network, output, attributes, "lane");
    const double along = place_on(network.lane(lane), number_of(output, attributes, "pos", 0.0));
    (kind == "detEntry" ? entries_ : exits_).push_back({lane, along});
  }
}

void EntryExit::add(const OutputStep& step) {
  for (const Place& entry : entries_)
    for (const LanePassage& passage : step.passages_on(entry.lane))
      if (types_.counts(step.vehicle(passage))) enter(entry, passage, step);
  for (const Place& exit : exits_)
    for (const LanePassage& passage : step.passages_on(exit.lane)) leave(exit, passage, step);
  if (!within_.empty())
    for (const LanePassage& passage : step.passages())
      if (passage.exit == LaneExit::Arrived || passage.exit == LaneExit::Taken)
        within_.erase(passage.vehicle);
  go_on(step);
  if (intervals_.is_over(step.end, false)) write(step.end);
}

void EntryExit::finish(double time) {
  if (intervals_.is_over(time, true)) write(time);
}

void EntryExit::enter(const Place& entry, const LanePassage& passage, const OutputStep& step) {
  if (passage.from > entry.along || passage.to <= entry.along || within_.contains(passage.vehicle))
    return;
  Within one;
  // SUMO tells these times a step earlier than those of its other detectors
  const double before = passage.passing_time(entry.along);
  one.entered = passage.begin - step_ + before;
  one.way = one.way_in_interval = passage.speed * (passage.duration - before);
  one.halts_since = passage.speed < halting_speed_ ? one.entered : -1.0;
  one.loss_before = one.loss_noted = step.motion.odometer(passage.vehicle).time_loss;
  within_.emplace(passage.vehicle, one);
}

void EntryExit::leave(const Place& exit, const LanePassage& passage, const OutputStep& step) {
  const double length = step.vehicle(passage).length;
  const auto within = within_.find(passage.vehicle);
  if (within == within_.end() || passage.duration <= 0.0) return;
  Within& one = within->second;
  const double begin = passage.begin - step_;
  if (passage.from < exit.along && passage.to >= exit.along)
    one.front_left = begin + passage.passing_time(exit.along);
  if (passage.from - length >= exit.along || passage.to - length < exit.along) return;
  const double before = passage.passing_time(exit.along, length);
  const double time = begin + before - one.entered;
  const double way = one.way + passage.speed * before;
  left_.push_back({one.front_left - one.entered, time, time > 0.0 ? way / time : 0.0,
                   step.motion.odometer(passage.vehicle).time_loss - one.loss_before, one.halts});
  within_.erase(within);
}

/// What the vehicles within did in this step.
void EntryExit::go_on(const OutputStep& step) {
  losses_.clear();
  for (auto& [vehicle, one] : within_) {
    const double speed = step.motion.last_place(vehicle).speed;
    losses_[vehicle] = step.motion.odometer(vehicle).time_loss;
    // in the step of its entry a part was counted
    if (one.entered + step_ < step.begin) {
      one.way += speed * step_;
      one.way_in_interval += speed * step_;
    }
    if (speed >= halting_speed_) {
      one.halts_since = -1.0;
      continue;
    }
    if (one.halts_since < 0.0) one.halts_since = step.begin;
    const double halted = step.begin - one.halts_since;
    if (halted < halting_time_ - 1e-6 || halted >= halting_time_ + step_ - 1e-6) continue;
    ++one.halts;
    ++one.halts_in_interval;
  }
}

void EntryExit::write(double time) {
  file_->open("interval").time("begin", intervals_.begin()).time("end", time).word("id", id_);
  write_left();
  write_within(time);
  file_->close();
  left_.clear();
  intervals_.next(time);
}

void EntryExit::write_left() {
  Left sum{};
  for (const Left& one : left_) {
    sum.travel_time += one.travel_time;
    sum.overlap_time += one.overlap_time;
    sum.speed += one.speed;
    sum.time_loss += one.time_loss;
    sum.halts += one.halts;
  }
  const auto mean = [&](double value) {
    return left_.empty() ? -1.0 : value / static_cast<double>(left_.size());
  };
  file_->number("meanTravelTime", mean(sum.travel_time));
  file_->number("meanOverlapTravelTime", mean(sum.overlap_time));
  file_->number("meanSpeed", mean(sum.speed));
  file_->number("meanHaltsPerVehicle", mean(static_cast<double>(sum.halts)));
  file_->number("meanTimeLoss", mean(sum.time_loss));
  file_->count("vehicleSum", static_cast<std::int64_t>(left_.size()));
}

void EntryExit::write_within(double time) {
  double speed = 0.0, halts = 0.0, duration = 0.0;
  double speed_in_interval = 0.0, halts_in_interval = 0.0, duration_in_interval = 0.0, loss = 0.0;
  for (auto& [vehicle, one] : within_) {
    const double whole = time - one.entered;
    const double part = std::min(whole, time - intervals_.begin());
    speed += one.way / whole;
    speed_in_interval += one.way_in_interval / part;
    halts += static_cast<double>(one.halts);
    halts_in_interval += static_cast<double>(one.halts_in_interval);
    duration += whole;
    duration_in_interval += part;
    const double now = losses_.contains(vehicle) ? losses_.at(vehicle) : one.loss_noted;
    loss += now - one.loss_noted;
    one.loss_noted = now;
    one.halts_in_interval = 0;
    one.way_in_interval = 0.0;
  }
  const auto mean = [&](double value) {
    return within_.empty() ? -1.0 : value / static_cast<double>(within_.size());
  };
  file_->number("meanSpeedWithin", mean(speed));
  file_->number("meanHaltsPerVehicleWithin", mean(halts));
  file_->number("meanDurationWithin", mean(duration));
  file_->count("vehicleSumWithin", static_cast<std::int64_t>(within_.size()));
  file_->number("meanIntervalSpeedWithin", mean(speed_in_interval));
  file_->number("meanIntervalHaltsPerVehicleWithin", mean(halts_in_interval));
  file_->number("meanIntervalDurationWithin", mean(duration_in_interval));
  file_->number("meanTimeLossWithin", mean(loss));
}

}  // namespace sumogamma
