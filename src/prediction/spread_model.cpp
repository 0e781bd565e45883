#include "prediction/spread_model.h"

#include <algorithm>
#include <cmath>

#include "geometry/spatial_grid.h"
#include "prediction/experts.h"
#include "prediction/spread_table.h"

namespace sumogamma {

namespace {
constexpr std::size_t kSeen = 8, kShown = 4, kAhead = 4;
constexpr double kFloor = 0.0005;     // errors below this tell nothing [m a step]
constexpr double kSlow = 0.1;         // [m/s]
constexpr double kScenePrior = 3.0;   // agents that count for "as usual"
constexpr double kMostClue = 3.0;     // what is odder than this is no clearer, logarithm
constexpr double kCircle = 2.145966;  // radius that holds 90 % of a normal cloud
}  // namespace

std::size_t spread_band(double speed) {
  std::size_t band = 0;
  while (band < kSpreadSpeeds.size() && speed >= kSpreadSpeeds[band]) ++band;
  return band;
}

namespace {

/// SpreadClues::mixture of everybody.
void add_mixtures(const ObservedScene& scene, std::vector<SpreadClues>& clues) {
  constexpr double kNear = 5.0, kReach = 3.0;  // scale [m], and scales beyond which nobody counts
  constexpr double kUnseen = 0.5;
  std::vector<Vec2> place, velocity;
  for (const ObservedAgent& agent : scene.agents) {
    place.push_back(agent.now());
    velocity.push_back(mean_displacement(agent.position, kSeen - 1) / scene.period);
  }
  SpatialGrid grid;
  grid.rebuild(place);
  for (std::size_t row = 0; row < clues.size(); ++row) {
    double weight = kUnseen, sum = kUnseen;
    grid.visit_within(place[row], kReach * kNear, [&](std::uint32_t other, double square) {
      if (other == row) return;
      const double near = std::exp(-square / (2.0 * kNear * kNear));
      weight += near;
      sum += near * (velocity[other] - velocity[row]).norm();
    });
    clues[row].mixture = std::log(sum / weight);
  }
}

}  // namespace

double unsteadiness(const ObservedAgent& agent) {
  const std::span<const Vec2> position =
      agent.position.size() > kSeen ? agent.position.last(kSeen) : agent.position;
  double last = 0, mean = 0, rounds = 0;
  for (std::size_t shown = kShown; shown < position.size(); ++shown) {
    const std::span<const Vec2> past = position.first(shown);
    const Vec2 one = displacement_before(past, 0), three = mean_displacement(past, 3);
    for (std::size_t ahead = 1; ahead <= kAhead && shown - 1 + ahead < position.size(); ++ahead) {
      const double steps = static_cast<double>(ahead);
      const Vec2 made = position[shown - 1 + ahead] - past.back();
      last += (made / steps - one).norm();
      mean += (made / steps - three).norm();
      rounds += 1;
    }
  }
  return rounds > 0 ? std::max(std::min(last, mean) / rounds, kFloor) : kFloor;
}

std::vector<SpreadClues> spread_clues(const AgentTypeTable& types, const ObservedScene& scene,
                                      SceneUnsteadiness* told) {
  std::vector<SpreadClues> clues(scene.agents.size());
  SceneUnsteadiness sums;
  std::array<double, kSpreadKinds> odd{}, counted{};
  for (std::size_t row = 0; row < clues.size(); ++row) {
    const ObservedAgent& agent = scene.agents[row];
    SpreadClues& clue = clues[row];
    clue.kind = type_of(types, agent.type).kinematics == Kinematics::Holonomic ? 0 : 1;
    const double speed = agent.last_velocity(scene.period).norm();
    clue.band = spread_band(speed);
    clue.speed = std::log(std::max(speed, kSlow));
    if (agent.position.size() <= kShown) continue;
    const double seen = std::log(unsteadiness(agent));
    clue.own = std::clamp(seen - kSpreadUsual[clue.kind][clue.band], -kMostClue, kMostClue);
    odd[clue.kind] += seen - kSpreadUsual[clue.kind][clue.band];
    counted[clue.kind] += 1;
    sums.sum[clue.kind][clue.band] += seen;
    sums.count[clue.kind][clue.band] += 1;
  }
  add_mixtures(scene, clues);
  for (SpreadClues& clue : clues) clue.scene = odd[clue.kind] / (counted[clue.kind] + kScenePrior);
  if (told != nullptr) *told = sums;
  return clues;
}

Vec2 Spread::departure(std::size_t k, double radius, const Vec2& direction) const {
  const double stretched = kCircle * std::pow(radius / kCircle, tail[k]);
  return stretched *
         (direction.x() * along[k] * forward + direction.y() * across[k] * left_of(forward));
}

Spread spread_for(const SpreadClues& clues, const Vec2& forward) {
  Spread spread;
  spread.forward = forward;
  for (std::size_t k = 0; k < kSpreadSteps; ++k) {
    const SpreadPower& power = kSpreadPowers[clues.kind][k];
    const SpreadEntry& entry = kSpreadTable[clues.kind][clues.band][k];
    const double scale = std::exp(power.own * clues.own + power.scene * clues.scene +
                                  power.mixture * clues.mixture + power.speed * clues.speed);
    spread.along[k] = scale * entry.along;
    spread.across[k] = scale * entry.across;
    spread.tail[k] = entry.tail;
  }
  return spread;
}

}  // namespace sumogamma
