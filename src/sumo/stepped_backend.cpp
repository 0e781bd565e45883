#include "sumo/stepped_backend.h"

#include <algorithm>

namespace sumogamma {

void SteppedBackend::step(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
                          SumoStep& result) {
  talk_to_sumo([&] {
    for (const std::span<const SumoPose> poses : {vehicles, persons})
      for (const SumoPose& pose : poses)
        require_finite_pose(*pose.id, pose.position, pose.angle, pose.speed);
    for (auto* const list : {&result.departed_vehicles, &result.departed_persons,
                             &result.arrived_vehicles, &result.arrived_persons, &result.lost})
      list->clear();
    result.gone.clear();
    result.signal_states.resize(signal_ids_.size());
    std::vector<std::string> route;
    if (vehicle_test_.pending() && !vehicles.empty()) route = route_of(*vehicles.front().id);
    move_and_step(vehicles, persons, result);
    time_ = result.time;
    started_ = true;
    finish_test(vehicle_test_, false, vehicles, result, route);
    finish_test(person_test_, true, persons, result, {});
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
