#include "ego/ego_settings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/edit_distance.h"
#include "base/error.h"
#include "base/number_text.h"
#include "ego/planners.h"

namespace sumogamma {

namespace {

void check_planner(const std::string& name) {
  const auto known = planners();
  if (std::any_of(known.begin(), known.end(),
                  [&](const PlannerEntry& entry) { return entry.name == name; }))
    return;
  const auto nearest =
      nearest_named(name, known, [](const PlannerEntry& entry) { return entry.name; });
  throw Error("[ego] planner", "'" + name.substr(0, 60) + "' is none, the nearest known one is '" +
                                   std::string(nearest->name) + "'");
}

void check_window(const std::vector<double>& window) {
  if (window.empty()) return;
  const bool finite =
      std::all_of(window.begin(), window.end(), [](double value) { return std::isfinite(value); });
  if (window.size() == 4 && finite && window[0] < window[2] && window[1] < window[3]) return;
  throw Error("[ego] window", "must be X0, Y0, X1, Y1 of a box of the network [m]");
}

void check_accelerations(const std::vector<double>& accelerations) {
  const bool finite = std::all_of(accelerations.begin(), accelerations.end(),
                                  [](double value) { return std::isfinite(value); });
  const bool brakes = std::any_of(accelerations.begin(), accelerations.end(),
                                  [](double value) { return value < 0.0; });
  if (finite && brakes) return;
  throw Error("[ego] accelerations",
              "must be finite, and one of them below 0: an ego has to brake");
}

void check_search(const EgoSettings& settings) {
  const std::pair<const char*, int> counts[] = {{"agents_seen", settings.agents_seen},
                                                {"scenarios", settings.scenarios},
                                                {"depth", settings.depth},
                                                {"scene_steps", settings.scene_steps}};
  for (const auto& [name, count] : counts)
    if (count < 1)
      throw Error("[ego] " + std::string(name) + " " + std::to_string(count), "must be 1 or more");
  if (settings.trees != 1 && settings.trees != 2)
    throw Error("[ego] trees " + std::to_string(settings.trees), "must be 1 or 2");
}

}  // namespace

void check_settings(const EgoSettings& settings, double step, bool external) {
  if (!(settings.rate > 0.0) || settings.rate > 1.0 / step + 1e-9)
    throw Error("[ego] rate " + number_text(settings.rate),
                "must be above 0 and at most " + number_text(1.0 / step) +
                    " a second, one plan a tick of " + number_text(step) + " s");
  check_accelerations(settings.accelerations);
  check_window(settings.window);
  check_search(settings);
  if (!external) check_planner(settings.planner);
  if (settings.vehicle.empty() && settings.goal_edge.empty() && settings.goal_way < kGoalRadius)
    throw Error("[ego] goal_way " + number_text(settings.goal_way),
                "is nearer than " + number_text(kGoalRadius) + " m, at which a goal is reached");
}

}  // namespace sumogamma
