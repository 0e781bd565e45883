#include "prediction/walking_model.h"

#include <algorithm>
#include <cmath>

#include "prediction/walking_coefficients.h"

namespace sumogamma {

namespace {

constexpr std::size_t kSeen = 8;            // frames looked at
constexpr double kMoving = 0.12;            // slower people show no direction [m a period]
constexpr double kCompanion = 2.0;          // scale over which people are near each other [m]
constexpr double kAlikeMean = 0.08;         // scale over which mean displacements are alike [m]
constexpr double kAlikeLast = 0.10;         // likewise of last displacements [m]
constexpr double kNear = 5.0, kFar = 15.0;  // scales of the axes [m]
constexpr double kReach = 4.0;              // scales beyond which nobody counts
constexpr double kCompanionPrior = 0.5;     // companions that count for "as it goes itself"
constexpr double kAxisPrior = 2.0;          // likewise for axes
// logarithm of the ratio of errors at which both kinds of recordings are as likely, and its scale
constexpr double kGateMiddle = 0.05, kGateScale = 0.1;
constexpr double kGateFloor = 0.2;  // errors below this tell nothing [m]

/// One agent as the features see it.
struct Walker {
  Vec2 place, last, mean, direction;
  bool walks = false, known = false, moving = false;
};

std::span<const Vec2> lately(const ObservedAgent& agent) {
  return agent.position.size() > kSeen ? agent.position.last(kSeen) : agent.position;
}

/// How much the mean of three displacements is to be believed, against the last alone: by what each
/// would have said of everybody's last frames, 1 to 4 steps ahead.
double trust_in_means(const ObservedScene& scene, const std::vector<Walker>& walkers) {
  double last = kGateFloor, mean = kGateFloor;
  for (std::size_t row = 0; row < walkers.size(); ++row) {
    if (!walkers[row].walks) continue;
    const std::span<const Vec2> position = lately(scene.agents[row]);
    const std::size_t n = position.size();
    for (std::size_t ahead = 1; ahead <= 4 && ahead + 4 <= n; ++ahead) {
      const std::span<const Vec2> past = position.first(n - ahead);
      const double steps = static_cast<double>(ahead);
      last += (past.back() + steps * displacement_before(past, 0) - position.back()).norm();
      mean += (past.back() + steps * mean_displacement(past, 3) - position.back()).norm();
    }
  }
  return 1.0 / (1.0 + std::exp((std::log(mean / last) - kGateMiddle) / kGateScale));
}

std::vector<Walker> walkers_of(const AgentTypeTable& types, const ObservedScene& scene) {
  std::vector<Walker> walkers;
  for (const ObservedAgent& agent : scene.agents) {
    const std::span<const Vec2> position = lately(agent);
    Walker walker{agent.now(), displacement_before(position, 0), mean_displacement(position, 3),
                  Vec2::Zero()};
    const Vec2 along = mean_displacement(position, kSeen - 1);
    walker.walks = type_of(types, agent.type).kinematics == Kinematics::Holonomic;
    walker.known = walker.walks && position.size() >= 2;
    walker.moving = walker.known && along.norm() > kMoving;
    if (walker.moving) walker.direction = along.normalized();
    walkers.push_back(walker);
  }
  return walkers;
}

double bump(double square, double scale) { return std::exp(-square / (2.0 * scale * scale)); }

/// Sums over the others for one walker.
struct Company {
  Vec2 mean = Vec2::Zero(), last = Vec2::Zero();
  double mean_weight = 0, last_weight = 0;
  std::array<Vec2, 2> axis = {Vec2::Zero(), Vec2::Zero()};  ///< near and far
  std::array<double, 2> axis_weight{};
  Vec2 alike = Vec2::Zero();
  double alike_weight = 0;

  /// `weight`: of the other at the near and the far scale.
  void add_direction(const Walker& self, const Walker& other, const std::array<double, 2>& weight) {
    if (!other.moving) return;
    const double forward = other.direction.dot(self.mean);
    for (std::size_t k = 0; k < weight.size(); ++k) {
      axis[k] += weight[k] * forward * other.direction;
      axis_weight[k] += weight[k];
    }
    const double speed = self.mean.norm();
    const double same = weight[0] * std::max(forward / std::max(speed, 1e-9), 0.0);
    alike += same * speed * other.direction;
    alike_weight += same;
  }
};

/// Two who may be companions: what each sums up of the other.
void add_companions(const Walker& one, const Walker& other, double square, Company& of_one,
                    Company& of_other) {
  const double near = bump(square, kCompanion);
  const Vec2 mean_off = other.mean - one.mean, last_off = other.last - one.last;
  const double mean_alike = near * bump(mean_off.squaredNorm(), kAlikeMean);
  const double last_alike = near * bump(last_off.squaredNorm(), kAlikeLast);
  of_one.mean += mean_alike * mean_off;
  of_one.mean_weight += mean_alike;
  of_one.last += last_alike * last_off;
  of_one.last_weight += last_alike;
  of_other.mean -= mean_alike * mean_off;
  of_other.mean_weight += mean_alike;
  of_other.last -= last_alike * last_off;
  of_other.last_weight += last_alike;
}

/// Sums over the others for everybody. Pairs are weighed once for both; each one's sums run over
/// the others in their order.
std::vector<Company> companies_of(const std::vector<Walker>& walkers) {
  std::vector<Company> companies(walkers.size());
  for (std::size_t a = 0; a < walkers.size(); ++a) {
    if (!walkers[a].known) continue;
    for (std::size_t b = a + 1; b < walkers.size(); ++b) {
      const Walker &one = walkers[a], &other = walkers[b];
      if (!other.known) continue;
      const double square = (other.place - one.place).squaredNorm();
      if (square > kReach * kReach * kFar * kFar) continue;
      if (square < kReach * kReach * kCompanion * kCompanion)
        add_companions(one, other, square, companies[a], companies[b]);
      if (!one.moving && !other.moving) continue;
      const std::array<double, 2> weight = {bump(square, kNear), bump(square, kFar)};
      companies[a].add_direction(one, other, weight);
      companies[b].add_direction(other, one, weight);
    }
  }
  return companies;
}

}  // namespace

void walking_features(const AgentTypeTable& types, const ObservedScene& scene,
                      std::vector<WalkingFeatures>& features) {
  const std::vector<Walker> walkers = walkers_of(types, scene);
  const std::vector<Company> companies = companies_of(walkers);
  const double trust = trust_in_means(scene, walkers);
  features.resize(walkers.size());
  for (std::size_t row = 0; row < walkers.size(); ++row) {
    features[row].fill(Vec2::Zero());
    const Walker& self = walkers[row];
    if (!self.known) continue;
    const Company& company = companies[row];
    const std::span<const Vec2> position = lately(scene.agents[row]);
    std::array<Vec2, 5> twice;
    auto d = [&](std::size_t j) { return displacement_before(position, j); };
    twice[0] = d(0);
    twice[1] = (d(1) + d(2)) / 2.0;
    twice[2] = (d(3) + d(4) + d(5) + d(6)) / 4.0;
    twice[3] = company.mean / (kCompanionPrior + company.mean_weight);
    twice[4] = company.last / (kCompanionPrior + company.last_weight);
    for (std::size_t k = 0; k < twice.size(); ++k) {
      features[row][2 * k] = trust * twice[k];
      features[row][2 * k + 1] = (1.0 - trust) * twice[k];
    }
    for (std::size_t k = 0; k < 2; ++k)
      features[row][10 + k] = (company.axis[k] - company.axis_weight[k] * self.mean) /
                              (kAxisPrior + company.axis_weight[k]);
    features[row][12] =
        (company.alike - company.alike_weight * self.mean) / (kAxisPrior + company.alike_weight);
  }
}

void walking_path(const WalkingFeatures& features, std::span<Vec2> displacement) {
  Vec2 rate = Vec2::Zero(), bend = Vec2::Zero();
  for (std::size_t f = 0; f < kWalkingFeatures; ++f) {
    rate += kWalkingCoefficients[f][0] * features[f];
    bend += kWalkingCoefficients[f][1] * features[f];
  }
  for (std::size_t k = 0; k < displacement.size(); ++k) {
    const double step = static_cast<double>(k + 1);
    displacement[k] = step * rate + step * step / 12.0 * bend;
  }
}

}  // namespace sumogamma
