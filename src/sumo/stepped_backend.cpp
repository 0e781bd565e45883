#include "sumo/stepped_backend.h"

#include <algorithm>
#include <limits>

namespace sumogamma {

SteppedBackend::SteppedBackend(const SumoStart& start)
    : by_schedule_(start.signals_by_schedule && start.socket < 0 && start.connect_host.empty() &&
                   !start.client_order && start.clients <= 1) {}

double SteppedBackend::next_switch(std::size_t signal) {
  if (by_schedule_) return next_switch_[signal];
  double at = 0.0;
  talk_to_sumo([&] { at = ask_next_switch(signal); });
  return at;
}

void SteppedBackend::send(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons) {
  talk_to_sumo([&] {
    for (const std::span<const SumoPose> poses : {vehicles, persons})
      for (const SumoPose& pose : poses)
        require_finite_pose(*pose.id, pose.position, pose.angle, pose.speed);
    sent_vehicles_ = vehicles;
    sent_persons_ = persons;
    sent_route_.clear();
    if (vehicle_test_.pending() && !vehicles.empty()) sent_route_ = route_of(*vehicles.front().id);
    lost_ahead_.clear();
    move_ahead(vehicles, persons, lost_ahead_);
  });
}

void SteppedBackend::receive(SumoStep& result) {
  talk_to_sumo([&] {
    for (auto* const list : {&result.departed_vehicles, &result.departed_persons,
                             &result.arrived_vehicles, &result.arrived_persons, &result.lost})
      list->clear();
    result.gone.clear();
    result.asked_signals.clear();
    result.signal_states.resize(signal_ids_.size());
    next_switch_.resize(signal_ids_.size(), -std::numeric_limits<double>::infinity());
    move_and_step(sent_vehicles_, sent_persons_, result);
    result.lost.insert(result.lost.end(), lost_ahead_.begin(), lost_ahead_.end());
    time_ = result.time;
    started_ = true;
    finish_test(vehicle_test_, false, sent_vehicles_, result, sent_route_);
    finish_test(person_test_, true, sent_persons_, result, {});
    sent_vehicles_ = sent_persons_ = {};
    for (const std::string& id : result.arrived_vehicles) unwatch(id, false);
    for (const std::string& id : result.arrived_persons) unwatch(id, true);
    std::vector<WatchList::Entry> gone;
    read_watched(watched_.entries(), result.agents, gone);
    for (const WatchList::Entry& entry : gone) {
      result.gone.emplace_back(entry.is_person, entry.id);
      unwatch(entry.id, entry.is_person);
    }
  });
}

void SteppedBackend::finish_test(GhostSelfTest& test, bool is_person,
                                 std::span<const SumoPose> poses, const SumoStep& result,
                                 const std::vector<std::string>& route) {
  if (!test.pending() || poses.empty()) return;
  const SumoPose& pose = poses.front();
  if (std::find(result.lost.begin(), result.lost.end(), *pose.id) != result.lost.end()) return;
  const std::optional<GhostObservation> reported = observe(*pose.id, is_person);
  if (!reported) return;  // it left within this very step: the next one is tested
  const GhostObservation sent{pose.position, wrapped_degrees(pose.angle), "", route};
  const std::string warning = test.judge(sent, *reported);
  if (!warning.empty()) warnings_.push_back(warning);
}

}  // namespace sumogamma
