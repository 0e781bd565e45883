#include "outputs/run_outputs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "outputs/entry_exit.h"
#include "outputs/induction_loops.h"
#include "outputs/lane_areas.h"
#include "outputs/mean_data.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

struct Schema {
  std::string_view what, root, file;
};

constexpr Schema kSchemas[] = {{"e1Detector", "detector", "det_e1_file.xsd"},
                               {"instantInductionLoop", "instantE1", "instant_e1_file.xsd"},
                               {"e2Detector", "detector", "det_e2_file.xsd"},
                               {"e3Detector", "e3Detector", "det_e3_file.xsd"},
                               {"edgeData", "meandata", "meandata_file.xsd"},
                               {"laneData", "meandata", "meandata_file.xsd"},
                               {"edgedata-output", "meandata", "meandata_file.xsd"},
                               {"lanedata-output", "meandata", "meandata_file.xsd"}};

const Schema* schema_of(const AskedOutput& output) {
  for (const Schema& schema : kSchemas)
    if (schema.what == output.what) return &schema;
  return nullptr;
}

std::int64_t milliseconds(double seconds) { return std::llround(1000.0 * seconds); }

}  // namespace

RunOutputs::RunOutputs(const RoadNetwork& network, OutputRequest request)
    : network_(network), request_(std::move(request)), motion_(network, request_.step) {
  for (const AskedOutput& output : request_.asked)
    if (schema_of(output) != nullptr) add_detector(output);
  for (const AskedOutput& output : request_.asked)
    if (output.what == "fcd-output")
      fcd_.emplace(request_.names.hidden(output.file).string() + ".places");
}

RunOutputs::~RunOutputs() = default;

std::shared_ptr<SumoFile> RunOutputs::file_for(const AskedOutput& output) {
  std::shared_ptr<SumoFile>& file = files_[output.file.lexically_normal()];
  const Schema& schema = *schema_of(output);
  if (!file)
    file = std::make_shared<SumoFile>(request_.names.hidden(output.file).string() + ".ours",
                                      request_.names.shown(output.file), schema.root, schema.file,
                                      request_.precision);
  return file;
}

void RunOutputs::add_detector(const AskedOutput& output) {
  std::shared_ptr<SumoFile> file = file_for(output);
  const double begin = request_.begin, step = request_.step;
  if (output.what == "e1Detector")
    outputs_.push_back(std::make_unique<InductionLoop>(network_, output, file, begin, step));
  else if (output.what == "instantInductionLoop")
    outputs_.push_back(std::make_unique<InstantLoop>(network_, output, file, step));
  else if (output.what == "e2Detector")
    outputs_.push_back(std::make_unique<LaneArea>(network_, output, file, begin, step));
  else if (output.what == "e3Detector")
    outputs_.push_back(std::make_unique<EntryExit>(network_, output, file, begin, step));
  else
    outputs_.push_back(std::make_unique<MeanData>(network_, output, file, begin, step));
}

void RunOutputs::add_vehicle(OutputVehicle vehicle, bool bicycle, double waited) {
  const auto index = static_cast<std::uint32_t>(vehicles_.size());
  TripFigures& trip = trips_[vehicle.name];
  trip.driven = false;
  trip.bicycle = bicycle;
  trip.waited = waited;
  waited_ += waited;
  index_.emplace(vehicle.name, index);
  vehicles_.push_back(std::move(vehicle));
  figures_.push_back(&trip);
  on_road_.push_back(false);
  seen_.push_back(false);
  arrived_.push_back(false);
}

void RunOutputs::note_arrival(std::string_view name) {
  const auto found = index_.find(std::string(name));
  if (found == index_.end()) return;
  arrived_[found->second] = true;
  waited_arrived_ += figures_[found->second]->waited;
}

LaneId RunOutputs::last_lane(std::string_view name) const {
  const auto found = index_.find(std::string(name));
  if (found == index_.end() || !on_road_[found->second]) return kNoLane;
  return motion_.last_place(found->second).lane;
}

void RunOutputs::add(SeenStep& step) {
  motion_.begin_step(step.begin);
  move_vehicles(step);
  motion_.end_step();
  note_trips(step);
  sum_up(step);
  keep_places(step);
  const OutputStep now{step.begin, step.begin + request_.step, vehicles_, motion_};
  for (const auto& output : outputs_) output->add(now);
}

void RunOutputs::move_vehicles(SeenStep& step) {
  std::fill(seen_.begin(), seen_.end(), false);
  for (SeenAgent& agent : step.agents) {
    if (agent.is_person) continue;
    const std::uint32_t vehicle = index_.at(agent.name);
    if (seen_[vehicle]) continue;
    seen_[vehicle] = true;
    agent.place.vehicle = vehicle;
    motion_.move(vehicles_[vehicle], agent.place);
    on_road_[vehicle] = true;
    figures_[vehicle]->driven |= agent.driven;
  }
  for (const std::string& name : step.unseen) {
    const auto found = index_.find(name);
    if (found != index_.end()) seen_[found->second] = true;
  }
  end_missing(step.is_last);
}

void RunOutputs::end_missing(bool is_last) {
  for (std::uint32_t vehicle = 0; vehicle < vehicles_.size(); ++vehicle) {
    if (!on_road_[vehicle] || seen_[vehicle] || (is_last && !arrived_[vehicle])) continue;
    motion_.end(vehicles_[vehicle], vehicle, arrived_[vehicle]);
    on_road_[vehicle] = false;
  }
}

/// Where its stops begin.
void RunOutputs::note_trips(const SeenStep& step) {
  for (const SeenAgent& agent : step.agents) {
    if (agent.is_person || !agent.place.stopped) continue;
    const std::uint32_t vehicle = agent.place.vehicle;
    if (!motion_.has_departed(vehicle)) continue;
    const TripOdometer& odometer = motion_.odometer(vehicle);
    std::vector<TripFigures::Halt>& halts = figures_[vehicle]->halts;
    if (halts.empty() || halts.back().distance < odometer.distance - 0.1)
      halts.push_back({step.begin, odometer.distance, odometer.time_loss});
  }
}

void RunOutputs::sum_up(const SeenStep& step) {
  if (!asks_for(request_.asked, "summary-output") &&
      !asks_for(request_.asked, "person-summary-output"))
    return;
  constexpr double kHalting = 0.1;  // SUMO's [m/s]
  SummaryFigures now;
  double speed = 0.0, relative = 0.0, number = 0.0;
  std::vector<bool> counted(vehicles_.size(), false);
  now.driven = step.waiting_vehicles > 0;
  for (const SeenAgent& agent : step.agents) {
    walked_ |= agent.is_person && agent.driven;
    now.driven |= !agent.is_person && agent.driven;
    if (agent.is_person || counted[agent.place.vehicle]) continue;
    counted[agent.place.vehicle] = true;
    if (agent.place.speed < kHalting) ++now.halting;
    if (agent.place.stopped || agent.place.lane == kNoLane) continue;
    number += 1.0;
    speed += agent.place.speed;
    if (agent.place.speed_limit > 0.0) relative += agent.place.speed / agent.place.speed_limit;
  }
  if (number > 0.0) {
    now.speed = speed / number;
    now.relative_speed = relative / number;
  }
  now.walked = walked_;
  now.waiting = step.waiting_vehicles;
  now.riding = step.riding;
  now.waited = waited_;
  now.waited_arrived = waited_arrived_;
  summary_.emplace_hint(summary_.end(), milliseconds(step.begin), now);
}

void RunOutputs::keep_places(const SeenStep& step) {
  // until it comes SUMO has it on its way
  for (const auto& [name, is_person] : step.waiting)
    if (!is_person && !knows(name)) trips_[name].driven = true;
  if (!fcd_) return;
  fcd_->begin_step(milliseconds(step.begin));
  for (const SeenAgent& agent : step.agents)
    if (agent.driven && agent.place.lane != kNoLane)
      fcd_->add(agent.name, agent.is_person, agent.place.lane, agent.place.front);
  for (const auto& [name, is_person] : step.waiting) fcd_->add_waiting(name, is_person);
}

void RunOutputs::take_figures() {
  for (std::uint32_t vehicle = 0; vehicle < vehicles_.size(); ++vehicle) {
    if (!motion_.has_departed(vehicle)) continue;
    TripFigures& trip = *figures_[vehicle];
    trip.entered = true;
    trip.arrived = arrived_[vehicle];
    trip.first = motion_.first_place(vehicle);
    trip.last = motion_.last_place(vehicle);
    trip.odometer = motion_.odometer(vehicle);
  }
}

/// From SUMO's own files and our figures.
void RunOutputs::write_own() {
  const OutputNames& names = request_.names;
  const auto tripinfo =
      std::find_if(request_.asked.begin(), request_.asked.end(),
                   [](const AskedOutput& output) { return output.what == "tripinfo-output"; });
  fs::path trips;
  if (tripinfo != request_.asked.end()) {
    trips = names.shown(tripinfo->file);
    write_tripinfo(names.hidden(tripinfo->file), trips, network_, trips_, request_.precision);
  } else if (!request_.helper_tripinfo.empty()) {
    trips = names.hidden(request_.helper_tripinfo).string() + ".ours";
    write_tripinfo(names.hidden(request_.helper_tripinfo), trips, network_, trips_,
                   request_.precision);
  }
  for (const AskedOutput& output : request_.asked) {
    const fs::path from = names.hidden(output.file), to = names.shown(output.file);
    if (output.what == "statistic-output")
      write_statistics(from, to, trips, trips_, request_.precision);
    else if (output.what == "summary-output")
      write_summary(from, to, summary_, request_.precision);
    else if (output.what == "person-summary-output")
      write_person_summary(from, to, summary_);
    else if (output.what == "fcd-output")
      fcd_->write(from, to, network_, request_.precision);
  }
  if (tripinfo == request_.asked.end() && !trips.empty()) {
    std::error_code ignored;
    fs::remove(trips, ignored);
  }
}

void RunOutputs::finish(double time) {
  if (std::exchange(finished_, true)) return;
  for (const auto& output : outputs_) output->finish(time);
  outputs_.clear();
  for (auto& [name, file] : files_) file->finish();
  take_figures();
  write_own();
  fcd_.reset();
  std::vector<fs::path> written;
  for (const AskedOutput& output : request_.asked) written.push_back(output.file);
  if (!request_.helper_tripinfo.empty()) written.push_back(request_.helper_tripinfo);
  show_outputs(request_.names, request_.folders, written);
}

}  // namespace sumogamma
