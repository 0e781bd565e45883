#include "prediction/flow_trust.h"

#include <algorithm>

namespace sumogamma {

void FlowTrust::remember(std::uint32_t agent, std::size_t kind, std::span<const Vec2> predicted,
                         std::span<const Vec2> flow) {
  Forecast& forecast = recent_.add(agent, kind);
  for (std::size_t check = 0; check < forecast.flow.size(); ++check) {
    const std::size_t step = recent_.step_of(check);
    forecast.predicted[check] = predicted[step];
    forecast.flow[check] = flow[step];
  }
}

void FlowTrust::resolve(std::uint32_t agent, const Vec2& position) {
  recent_.for_due(agent, [&](std::size_t kind, std::size_t check, const Forecast& forecast) {
    const Vec2& flow = forecast.flow[check];
    explained_[kind] += flow.dot(position - forecast.predicted[check]);
    square_[kind] += flow.squaredNorm();
  });
}

void FlowTrust::end_frame() {
  recent_.end_frame();
  for (std::size_t kind = 0; kind < share_.size(); ++kind) {
    explained_[kind] *= kKeep;
    square_[kind] *= kKeep;
    share_[kind] = std::clamp((kPrior + explained_[kind]) / (kPrior + square_[kind]), 0.0, 1.0);
  }
}

void FlowTrust::clear() {
  recent_.clear();
  explained_ = square_ = {};
  share_ = {1, 1};
}

}  // namespace sumogamma
