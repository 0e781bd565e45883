#include "prediction/baselines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "geometry/rotation.h"
#include "inference/motion_estimate.h"
#include "prediction/experts.h"
#include "prediction/roll_out.h"

namespace sumogamma {

namespace {

constexpr Baseline kBaselines[] = {
    {"cv", "constant velocity", constant_velocity},
    {"cv-smoothed", "constant velocity, smoothed speed", smoothed_velocity},
    {"mean", "mean of the last 3 displacements", mean_velocity},
    {"ca", "constant acceleration", constant_acceleration},
    {"ctra", "constant turn rate and acceleration", turning_acceleration},
    {"ctr", "constant turn rate", constant_turn_rate},
    {"kalman", "Kalman filter, constant velocity", kalman_velocity},
    {"orca", "ORCA (discs)", disc_orca},
    {"porca", "PORCA (discs, responsibility by type)", porca},
    {"social-force", "social force (energy form)", social_force},
};

// headings follow the motion above this speed [m/s]
constexpr double kMoving = 0.1;

/// Fills headings from the motion.
void point_along_motion(const ObservedScene& scene, Forecast& forecast) {
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    double heading = scene.agents[row].heading.back();
    Vec2 before = scene.agents[row].now();
    for (std::size_t k = 0; k < forecast.steps; ++k) {
      const Vec2 here = forecast.position[row * forecast.steps + k];
      const Vec2 step = here - before;
      if (step.norm() > kMoving * scene.period) heading = heading_of(step);
      forecast.heading[row * forecast.steps + k] = heading;
      before = here;
    }
  }
}

/// Straight on at a velocity by row.
template <typename VelocityOf>
Forecast go_straight(const ObservedScene& scene, std::size_t steps, VelocityOf&& velocity_of) {
  Forecast forecast;
  forecast.resize(scene.agents.size(), steps);
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    const Vec2 velocity = velocity_of(scene.agents[row]);
    for (std::size_t k = 0; k < steps; ++k)
      forecast.position[row * steps + k] =
          scene.agents[row].now() + static_cast<double>(k + 1) * scene.period * velocity;
  }
  point_along_motion(scene, forecast);
  return forecast;
}

/// Along displacements from now on, of what was seen of a row.
template <typename WayOf>
Forecast go_along(const ObservedScene& scene, std::size_t steps, WayOf&& way_of) {
  Forecast forecast;
  forecast.resize(scene.agents.size(), steps);
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    const ObservedAgent& agent = scene.agents[row];
    const std::span<Vec2> path(forecast.position.data() + row * steps, steps);
    way_of(agent.position, path);
    for (Vec2& point : path) point += agent.now();
  }
  point_along_motion(scene, forecast);
  return forecast;
}

/// The j-th last displacement over the period, the oldest known for older ones [m/s].
Vec2 earlier_velocity(const ObservedAgent& agent, std::size_t j, double period) {
  const std::size_t n = agent.position.size();
  if (n < 2) return Vec2::Zero();
  const std::size_t last = n - 1 - std::min(j, n - 2);
  return (agent.position[last] - agent.position[last - 1]) / period;
}

/// The model reduced to reciprocal avoidance of discs.
Model disc_model(bool shares_by_type) {
  Model model;
  model.types = recorded_agent_types();
  Workers workers(1);
  model.kinematics = build_kinematic_tables(model.types, workers);
  model.options.use_kinematics = false;
  model.options.use_polygons = false;
  model.options.use_guard = false;
  model.options.look_aside = false;
  model.options.creep_when_held = false;
  model.options.pass_as_intended = false;
  model.options.share_responsibility = shares_by_type;
  model.options.step = 0.4;
  return model;
}

Forecast roll_straight(const Model& model, const ObservedScene& seen, std::size_t steps,
                       bool shares_by_type) {
  // differs from ORCA: PORCA's wheels give way less to people on foot than these to them
  constexpr double kWalker = 0.6, kWheels = 0.4;
  std::vector<Vec2> velocity, path;
  for (const ObservedAgent& agent : seen.agents) {
    velocity.push_back(agent.last_velocity(seen.period));
    for (std::size_t k = 0; k < steps; ++k)
      path.push_back(agent.now() + static_cast<double>(k + 1) * seen.period * velocity.back());
  }
  Scene scene;
  build_scene(model.types, seen, velocity, scene);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const bool walks = type_of(model.types, scene.type[row]).kinematics == Kinematics::Holonomic;
    if (shares_by_type) scene.behavior[row].responsibility = walks ? kWalker : kWheels;
  }
  RollOut roll_out;
  Forecast forecast;
  roll_out.run(model, {.use_bodies = false, .rejoin = 0.0}, seen.period, path, steps, scene,
               forecast);
  return forecast;
}

}  // namespace

std::span<const Baseline> baselines() { return kBaselines; }

const Baseline& find_baseline(std::string_view name) {
  std::string known;
  for (const Baseline& baseline : kBaselines) {
    if (baseline.name == name) return baseline;
    known += (known.empty() ? "" : ", ") + std::string(baseline.name);
  }
  throw Error("--method", "\"" + std::string(name) + "\" is unknown, expected one of " + known);
}

Forecast constant_velocity(const ObservedScene& scene, std::size_t steps) {
  return go_straight(scene, steps,
                     [&](const ObservedAgent& agent) { return agent.last_velocity(scene.period); });
}

Forecast mean_velocity(const ObservedScene& scene, std::size_t steps) {
  return go_straight(scene, steps, [&](const ObservedAgent& agent) {
    return Vec2(mean_displacement(agent.position, 3) / scene.period);
  });
}

Forecast smoothed_velocity(const ObservedScene& scene, std::size_t steps) {
  constexpr std::array<double, 4> kWeights = {1.0, 0.8, 0.64, 0.4096};
  return go_straight(scene, steps, [&](const ObservedAgent& agent) {
    double speed = 0, weight = 0;
    for (std::size_t j = 0; j < kWeights.size() && j + 1 < agent.position.size(); ++j) {
      speed += kWeights[j] * earlier_velocity(agent, j, scene.period).norm();
      weight += kWeights[j];
    }
    const Vec2 last = agent.last_velocity(scene.period);
    const double norm = last.norm();
    return norm > 1e-12 && weight > 0 ? Vec2(last * (speed / weight / norm)) : Vec2(Vec2::Zero());
  });
}

Forecast constant_acceleration(const ObservedScene& scene, std::size_t steps) {
  return go_along(scene, steps, [](std::span<const Vec2> seen, std::span<Vec2> path) {
    accelerating_path(seen, path);
  });
}

Forecast turning_acceleration(const ObservedScene& scene, std::size_t steps) {
  return go_along(scene, steps, [](std::span<const Vec2> seen, std::span<Vec2> path) {
    turning_path(seen, 2, 0, path);
  });
}

Forecast constant_turn_rate(const ObservedScene& scene, std::size_t steps) {
  Forecast forecast;
  forecast.resize(scene.agents.size(), steps);
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    const ObservedAgent& agent = scene.agents[row];
    Vec2 velocity = agent.last_velocity(scene.period), position = agent.now();
    const Vec2 before = earlier_velocity(agent, 2, scene.period);
    const double turn = before.norm() > kMoving && velocity.norm() > kMoving
                            ? std::atan2(cross(before, velocity), before.dot(velocity)) / 2.0
                            : 0.0;
    const Vec2 rotate = rotation(turn);
    for (std::size_t k = 0; k < steps; ++k) {
      velocity = from_body(velocity, rotate);
      position += scene.period * velocity;
      forecast.position[row * steps + k] = position;
    }
  }
  point_along_motion(scene, forecast);
  return forecast;
}

Forecast kalman_velocity(const ObservedScene& scene, std::size_t steps) {
  // white acceleration of 0.5 m/s^2 over a period is a velocity drift of 0.25 * period; the
  // filter's own acceleration state is switched off
  static const MotionFilter filter({.observation = 0.05,
                                    .acceleration_variance = 1e-12,
                                    .acceleration_time = 1e-3,
                                    .velocity_drift = 0.1},
                                   0.4);
  return go_straight(scene, steps, [&](const ObservedAgent& agent) {
    return filter.estimate(agent.position).velocity;
  });
}

Forecast disc_orca(const ObservedScene& scene, std::size_t steps) {
  static const Model model = disc_model(false);
  return roll_straight(model, scene, steps, false);
}

Forecast porca(const ObservedScene& scene, std::size_t steps) {
  static const Model model = disc_model(true);
  return roll_straight(model, scene, steps, true);
}

namespace {

/// Pellegrini et al. 2009, table 1 (LTA with all terms): personal space, reach, view, speed and
/// direction; lengths in metres, times in seconds.
constexpr double kPersonal = 0.361, kReachOfOthers = 2.088, kView = 2.33, kSpeedWeight = 2.073,
                 kDirectionWeight = 2.401;
constexpr double kPersistence = 0.5;  // share of the old velocity kept in a step

/// One walker among others.
struct Walker {
  Vec2 position, velocity, wanted;
};

/// Energy of a candidate velocity.
double energy(const std::vector<Walker>& all, std::size_t self, const Vec2& candidate) {
  const Walker& own = all[self];
  double interaction = 0;
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (j == self) continue;
    const Vec2 apart = own.position - all[j].position;
    const double square = apart.squaredNorm();
    if (square > 64.0 || square < 1e-12) continue;
    const Vec2 relative = candidate - all[j].velocity;
    const double speed = std::max(relative.squaredNorm(), 1e-6);
    const double when = std::max(-apart.dot(relative) / speed, 0.0);
    const double closest = (apart + when * relative).squaredNorm();
    const double reach = std::exp(-square / (2 * kReachOfOthers * kReachOfOthers));
    const double cosine = own.velocity.norm() > 1e-9
                              ? -apart.dot(own.velocity) / (std::sqrt(square) * own.velocity.norm())
                              : 1.0;
    const double view = std::pow((1.0 + cosine) / 2.0, kView);
    interaction += reach * view * std::exp(-closest / (2 * kPersonal * kPersonal));
  }
  const double speed_off = own.wanted.norm() - candidate.norm();
  const double product = own.wanted.norm() * candidate.norm();
  const double direction = product > 1e-9 ? -own.wanted.dot(candidate) / product : 0.0;
  return interaction + kSpeedWeight * speed_off * speed_off + kDirectionWeight * direction;
}

/// Best velocity over a polar grid about the wanted one: small, coarse to fine, deterministic.
Vec2 best_velocity(const std::vector<Walker>& all, std::size_t self) {
  Vec2 best = all[self].wanted;
  double least = energy(all, self, best);
  double angle_step = 0.2, speed_step = 0.15;
  for (int level = 0; level < 3; ++level) {
    const Vec2 center = best;
    for (int a = -2; a <= 2; ++a)
      for (int s = -2; s <= 2; ++s) {
        const double scale = std::max(0.0, 1.0 + speed_step * s);
        const Vec2 candidate = scale * from_body(center, rotation(angle_step * a));
        const double cost = energy(all, self, candidate);
        if (cost < least - 1e-12) {
          least = cost;
          best = candidate;
        }
      }
    angle_step /= 2.5;
    speed_step /= 2.5;
  }
  return best;
}

}  // namespace

Forecast social_force(const ObservedScene& scene, std::size_t steps) {
  std::vector<Walker> walkers;
  for (const ObservedAgent& agent : scene.agents) {
    const Vec2 velocity = agent.last_velocity(scene.period);
    walkers.push_back({agent.now(), velocity, velocity});
  }
  Forecast forecast;
  forecast.resize(walkers.size(), steps);
  std::vector<Vec2> next(walkers.size());
  for (std::size_t k = 0; k < steps; ++k) {
    for (std::size_t row = 0; row < walkers.size(); ++row) next[row] = best_velocity(walkers, row);
    for (std::size_t row = 0; row < walkers.size(); ++row) {
      Walker& walker = walkers[row];
      walker.velocity = kPersistence * walker.velocity + (1 - kPersistence) * next[row];
      walker.position += scene.period * walker.velocity;
      forecast.position[row * steps + k] = walker.position;
    }
  }
  point_along_motion(scene, forecast);
  return forecast;
}

}  // namespace sumogamma
