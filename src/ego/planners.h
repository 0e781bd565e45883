#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "ego/ego_action.h"
#include "ego/ego_view.h"

namespace sumogamma {

/// What an ego does until the next plan. Called once a period; keeps what it likes in between. The
/// same sequence of views gives the same actions.
using Planner = std::function<EgoAction(const EgoView&)>;

/// A planner in the box.
struct PlannerEntry {
  std::string_view name;
  std::string_view what;  ///< one line for --help
  Planner (*make)();      ///< for one episode; null: the ego is driven as one of the others
};

/// All there are. The first is the reference run.
std::span<const PlannerEntry> planners();

/// The planner of that name, for one episode; empty for the one that drives it as one of the
/// others. Precondition: check_settings() knows it.
Planner make_planner(std::string_view name);

}  // namespace sumogamma
