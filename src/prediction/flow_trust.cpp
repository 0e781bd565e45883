#include "prediction/flow_trust.h"

#include <algorithm>

namespace sumogamma {

void FlowTrust::remember(std::uint32_t agent, std::size_t kind, std::span<const Vec2> predicted,
                         std::span<const Vec2> flow) {
  History& history = history_[agent];
  Pending& pending = history.recent[history.next];
  for (std::size_t k = 0; k < kChecks; ++k) {
    const std::size_t step = (k + 1) * kEvery - 1;
    pending.predicted[k] = predicted[step];
    pending.flow[k] = flow[step];
  }
  history.next = (history.next + 1) % kSteps;
  history.count = std::min(history.count + 1, kSteps);
  history.kind = kind;
  history.seen = true;
}

void FlowTrust::resolve(std::uint32_t agent, const Vec2& position) {
  const auto found = history_.find(agent);
  if (found == history_.end()) return;
  const History& history = found->second;
  for (std::size_t check = 0; check < kChecks; ++check) {
    const std::size_t age = (check + 1) * kEvery;
    if (age > history.count) break;
    const Pending& pending = history.recent[(history.next + kSteps - age) % kSteps];
    const Vec2& flow = pending.flow[check];
    explained_[history.kind] += flow.dot(position - pending.predicted[check]);
    square_[history.kind] += flow.squaredNorm();
  }
}

void FlowTrust::end_frame() {
  std::erase_if(history_, [](const auto& entry) { return !entry.second.seen; });
  for (auto& entry : history_) entry.second.seen = false;
  for (std::size_t kind = 0; kind < share_.size(); ++kind) {
    explained_[kind] *= kKeep;
    square_[kind] *= kKeep;
    share_[kind] = std::clamp((kPrior + explained_[kind]) / (kPrior + square_[kind]), 0.0, 1.0);
  }
}

void FlowTrust::clear() {
  history_.clear();
  explained_ = square_ = {};
  share_ = {1, 1};
}

}  // namespace sumogamma
