#pragma once

#include <string>

#include "ego/plan_trace.h"

namespace sumogamma {

/// The search tree of a plan as a picture: belief nodes by depth, as large as their share of the
/// scenarios, under the accelerations that lead to them. Precondition: the trace has a tree.
std::string plan_tree_svg(const PlanTrace& trace);

}  // namespace sumogamma
