#include "app/sumo_files.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "base/error.h"
#include "outputs/front_place.h"
#include "sumo/compatibility.h"

namespace sumogamma {

namespace {

/// Means of trips are made from SUMO's tripinfo: where nobody asks for that it is ours alone.
std::filesystem::path helper_tripinfo(const RunPlan& plan) {
  const std::vector<AskedOutput>& asked = plan.inventory.outputs;
  if (!asks_for(asked, "statistic-output") || asks_for(asked, "tripinfo-output")) return {};
  return plan.options.output / "tripinfo.xml";
}

OutputRequest request_of(const RunPlan& plan) {
  OutputRequest request;
  request.asked = plan.inventory.outputs;
  request.folders = plan.inventory.output_folders;
  request.names = plan.output_names;
  request.helper_tripinfo = helper_tripinfo(plan);
  if (!request.helper_tripinfo.empty()) request.folders.push_back(plan.options.output);
  request.begin = plan.clock.begin;
  request.step = plan.clock.step;
  const auto precision = plan.input.options.find("precision");
  if (precision != plan.input.options.end()) {
    const std::string& text = precision->second.value;
    std::from_chars(text.data(), text.data() + text.size(), request.precision);
  }
  return request;
}

}  // namespace

HiddenOutputs::HiddenOutputs(RunPlan& plan) : plan_(plan) {
  if (plan.inventory.outputs.empty()) return;
  const AskedOutput& first = plan.inventory.outputs.front();
  if (plan.options.joins())
    throw Error(first.source,
                first.what +
                    ": a SUMO that runs already writes it by itself, and "
                    "wrong for who GAMMA drives; leave it out, or leave --connect out");
  plan.output_names = output_names(plan.input.options);
  const OutputRequest request = request_of(plan);
  std::vector<std::string>& words = plan.sumo_words;
  words.insert(words.end(), {"--output-prefix", plan.output_names.sumo_prefix()});
  if (!request.helper_tripinfo.empty())
    words.insert(words.end(), {"--tripinfo-output", request.helper_tripinfo.string()});
}

HiddenOutputs::~HiddenOutputs() {
  if (!started_ && !plan_.output_names.marker.empty())
    drop_outputs(plan_.output_names, request_of(plan_).folders);
}

SumoFiles::SumoFiles(const WatchedRun& run)
    : RunObserver(run), outputs_(run.sim.model.road, request_of(run.plan)) {}

void SumoFiles::register_vehicle(const KnownAgent& known) {
  constexpr double kUsualGap = 2.5;  // SUMO's for cars, where it tells none [m]
  OutputVehicle vehicle;
  vehicle.name = known.sumo_id;
  vehicle.type = known.type_id;
  vehicle.length = known.length;
  vehicle.min_gap = known.min_gap >= 0.0 ? known.min_gap : kUsualGap;
  vehicle.max_speed = known.max_speed;
  vehicle.speed_factor = known.speed_factor;
  outputs_.add_vehicle(std::move(vehicle), known.bicycle, known.waited);
}

VehiclePlace SumoFiles::place_of(std::size_t row, const KnownAgent& known) {
  const Scene& scene = run_.sim.scene;
  const RoadNetwork& network = run_.sim.model.road;
  VehiclePlace place;
  place.speed = scene.speed[row];
  place.stopped = scene.halt[row].left > 0.0 || scene.control[row] == Control::Parked;
  if (known.is_person) {
    place.lane = scene.lane[row].lane;
    if (place.lane == kNoLane) return place;
    const Lane& lane = network.lane(place.lane);
    const double whole = lane.centerline.length();
    const double scale = whole > 0.0 ? lane.length / whole : 1.0;
    place.front = lane.kind == LaneKind::WalkingArea
                      ? 0.0
                      : std::clamp(scene.lane[row].along * scale, 0.0, lane.length);
    return place;
  }
  if (scene.control[row] == Control::Parked) return place;
  if (is_ours(scene.control[row])) {
    if (const auto front = front_place(network, run_.sim.road, scene, row, known.length,
                                       outputs_.last_lane(known.sumo_id))) {
      place.lane = front->lane;
      place.front = front->along;
    }
  } else {
    place.lane = known.sumo_lane;
    place.front = known.sumo_along;
  }
  if (place.lane == kNoLane) return place;
  const SpeedLimits limits = run_.world.speed_limits();
  place.speed_limit =
      limits ? (*limits)[index_of(place.lane)] : network.lane(place.lane).speed_limit;
  return place;
}

bool SumoFiles::shows_persons() const {
  const std::vector<AskedOutput>& asked = run_.plan.inventory.outputs;
  return asks_for(asked, "fcd-output") || asks_for(asked, "person-summary-output");
}

void SumoFiles::see(std::size_t row, bool with_persons) {
  const Scene& scene = run_.sim.scene;
  const KnownAgent& known = run_.world.known_agents()[scene.id[row].value];
  if (known.is_person && !with_persons) return;
  if (!known.is_person && !outputs_.knows(known.sumo_id)) register_vehicle(known);
  SeenAgent agent;
  agent.name = run_.name_of(scene.id[row]);
  agent.is_person = known.is_person;
  agent.driven = is_ours(scene.control[row]) || known.service != StopService::None;
  agent.place = place_of(row, known);
  step_.agents.push_back(agent);
}

void SumoFiles::see_waiting() {
  step_.waiting.clear();
  step_.waiting_vehicles = 0;
  const auto wait = [&](const PendingAgent& pending) {
    step_.waiting.emplace_back(pending.details.id, pending.details.is_person);
    if (!pending.details.is_person && !outputs_.knows(pending.details.id)) ++step_.waiting_vehicles;
  };
  for (const PendingAgent& pending : run_.world.pending()) wait(pending);
  for (const DelayedVehicle& delayed : run_.world.delayed()) wait(delayed.pending);
  step_.riding = static_cast<std::int64_t>(run_.world.riding());
}

void SumoFiles::add(std::vector<ReplayEvent>&) {
  const Scene& scene = run_.sim.scene;
  const bool with_persons = shows_persons();
  const auto& trips = run_.world.life_cycle().trips;
  for (; arrivals_ < trips.size(); ++arrivals_)
    outputs_.note_arrival(run_.name_of(trips[arrivals_].id));
  // SUMO has brought those whom it drives to where they were when this tick began
  if (has_step_) {
    for (std::size_t row = 0; row < scene.size(); ++row) {
      if (!is_ours(scene.control[row]))
        see(row, with_persons);
      else
        step_.unseen.emplace_back(run_.name_of(scene.id[row]));
    }
    outputs_.add(step_);
  }
  step_.agents.clear();
  step_.unseen.clear();
  step_.begin = scene.time - run_.sim.dt;
  has_step_ = true;
  see_waiting();
  for (std::size_t row = 0; row < scene.size(); ++row)
    if (is_ours(scene.control[row])) see(row, with_persons);
}

void SumoFiles::close() {
  if (has_step_) {
    step_.is_last = true;
    outputs_.add(step_);
  }
  outputs_.finish(run_.sim.scene.time);
}

void require_no_outputs(SumoBackend& backend, const RunPlan& plan) {
  if (!plan.control.any()) return;
  for (const CompatibilityRow& row : compatibility_table()) {
    if (row.part != ScenarioPart::Option) continue;
    if (row.treatment != Treatment::Written && row.treatment != Treatment::Refused) continue;
    const std::string name(row.name.substr(0, row.name.find('*')));
    if (!name.ends_with("-output") && name != "netstate-dump") continue;
    if (is_null_output(backend.option(name))) continue;
    throw Error(plan.options.connect,
                "that SUMO writes " + name +
                    ", which would be wrong for who GAMMA drives; start it without, or leave "
                    "--connect out");
  }
}

}  // namespace sumogamma
