#include "app/window_colors.h"

namespace sumogamma {

namespace {

constexpr WindowColor kFree{223, 229, 234}, kSignal{213, 94, 0}, kGivesWay{204, 121, 167},
    kLeader{86, 180, 233}, kStop{166, 118, 29}, kOthers{0, 166, 122}, kEdge{230, 159, 0},
    kBody{79, 131, 204}, kGuard{255, 59, 48};

WindowColor color_of(LimitReason reason) {
  switch (reason) {
    case LimitReason::Leader:
      return kLeader;
    case LimitReason::Stop:
    case LimitReason::Merge:
      return kStop;
    case LimitReason::Signal:
    case LimitReason::None:  // a red crossing
      return kSignal;
    default:
      return kGivesWay;
  }
}

}  // namespace

WindowColor window_color(LimitReason reason, const Binding& binding) {
  switch (binding.kind) {
    case BindingKind::None:
      return kFree;
    case BindingKind::Kinematic:
      return kBody;
    case BindingKind::Neighbour:
      return kOthers;
    case BindingKind::Obstacle:
    case BindingKind::LaneBoundary:
    case BindingKind::Direction:
      return kEdge;
    case BindingKind::RoadLimit:
      return color_of(reason);
    case BindingKind::Guard:
    case BindingKind::BackingOut:
      return kGuard;
  }
  return kFree;
}

void WindowColors::note() {
  const Scene& scene = sim_.scene;
  const std::vector<Binding>& bindings = sim_.work.bindings;
  for (std::size_t row = 0; row < scene.size() && row < bindings.size(); ++row) {
    const std::size_t id = scene.id[row].value;
    if (id >= shown_.size()) shown_.resize(id + 1, WindowColor{});
    const bool ours = scene.control[row] == Control::Gamma;
    if (!ours && shown_[id] == WindowColor{}) continue;
    const WindowColor color =
        ours ? window_color(scene.context[row].reason, bindings[row]) : kSumoColor;
    if (color == shown_[id]) continue;
    shown_[id] = color;
    changed_.emplace_back(id, color);
  }
}

void WindowColors::paint() {
  const Scene& scene = sim_.scene;
  for (const auto& [id, color] : changed_) {
    const AgentId agent{static_cast<std::uint32_t>(id)};
    const std::size_t row = find_row(scene, agent);
    if (row == scene.size()) continue;  // it left meanwhile
    const bool walks =
        type_of(sim_.model.types, scene.type[row]).kinematics == Kinematics::Holonomic;
    backend_.set_color(world_.names()[id], walks, color);
  }
  changed_.clear();
}

}  // namespace sumogamma
