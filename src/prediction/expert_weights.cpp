#include "prediction/expert_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sumogamma {

void normalize_losses(std::span<double> error, double floor) {
  double most = floor;
  for (const double e : error) most = std::max(most, e);
  for (double& e : error) e /= most;
}

std::array<double, kExperts> exponential_weights(const std::array<double, kExperts>& prior,
                                                 const std::array<double, kExperts>& loss,
                                                 double rate) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < kExperts; ++e)
    if (prior[e] > 0) least = std::min(least, loss[e]);
  std::array<double, kExperts> weight{};
  double sum = 0;
  for (std::size_t e = 0; e < kExperts; ++e) {
    if (prior[e] > 0) weight[e] = prior[e] * std::exp(-rate * (loss[e] - least));
    sum += weight[e];
  }
  for (double& w : weight) w /= sum;
  return weight;
}

std::array<double, kExperts> ExpertWeights::weights(std::uint32_t agent, std::size_t kind,
                                                    const ExpertRate& rate) const {
  Losses loss = loss_[kind], prior{};
  // the rate falls as rounds come in, as the least bound on the regret has it; or else the best
  // over four steps would rule out whoever is better over twelve
  const double share = std::min(1.0, rate.others / std::max(rounds_[kind], 1.0));
  for (double& l : loss) l *= share;
  if (const auto found = history_.find(agent); found != history_.end())
    for (std::size_t e = 0; e < kExperts; ++e) loss[e] += rate.own * found->second.loss[e];
  prior.fill(1);
  prior[static_cast<std::size_t>(Expert::Model)] = rate.model;
  prior[static_cast<std::size_t>(Expert::Walking)] = kind == kWalkerKind ? rate.walking : 0.0;
  for (std::size_t e = kFirstLaneExpert; e < kExperts; ++e)
    prior[e] = kind == kLanesKind || kind == kStandingKind ? rate.lane : 0.0;
  return exponential_weights(prior, loss, rate.rate);
}

void ExpertWeights::resolve(std::uint32_t agent, const Vec2& position, const ExpertRate& rate) {
  const auto found = history_.find(agent);
  if (found == history_.end()) return;
  History& history = found->second;
  for (double& loss : history.loss) loss *= rate.keep;
  for (std::size_t age = 1; age <= history.count; ++age) {
    const Pending& pending = history.recent[(history.next + kAhead - age) % kAhead];
    if (!pending.counts) continue;
    Losses error;
    for (std::size_t e = 0; e < kExperts; ++e)
      error[e] = (position - pending.place[e][age - 1]).norm();
    normalize_losses(error, kFloor);
    rounds_[history.kind] += 1.0;
    for (std::size_t e = 0; e < kExperts; ++e) {
      history.loss[e] += error[e];
      loss_[history.kind][e] += error[e];
    }
  }
}

void ExpertWeights::remember(std::uint32_t agent, std::size_t kind, const Vec2& position,
                             std::size_t seen, std::span<const ExpertPath, kExperts> paths) {
  History& history = history_[agent];
  Pending& pending = history.recent[history.next];
  pending.counts = seen >= kSeen;
  for (std::size_t e = 0; e < kExperts; ++e)
    for (std::size_t k = 0; k < kAhead; ++k) pending.place[e][k] = position + paths[e][k];
  history.next = (history.next + 1) % kAhead;
  history.count = std::min(history.count + 1, kAhead);
  history.kind = kind;
  history.seen = true;
}

void ExpertWeights::end_frame(const ExpertRate& walker, const ExpertRate& wheels) {
  std::erase_if(history_, [](const auto& entry) { return !entry.second.seen; });
  for (auto& entry : history_) entry.second.seen = false;
  for (std::size_t kind = 0; kind < kExpertKinds; ++kind) {
    const double keep = kind == kWalkerKind ? walker.keep : wheels.keep;
    for (double& loss : loss_[kind]) loss *= keep;
    rounds_[kind] *= keep;
  }
}

}  // namespace sumogamma
