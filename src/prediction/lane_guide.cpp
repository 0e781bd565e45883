#include "prediction/lane_guide.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "road/signal_program.h"
#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

namespace {

constexpr double kFastest = 50.0;   // lanes and bends tell how fast a way is, not types [m/s]
constexpr double kUnderWay = 1.0;   // slower than this a body points where it goes [m/s]
constexpr double kNearWay = 3.0;    // who is farther from a way isn't on it [m]
constexpr double kDriftTime = 1.0;  // in which a speed across a way dies away [s]
constexpr double kMostDrift = 2.0;  // [m]
constexpr double kSightAhead = 60;  // leaders farther ahead don't count [m]
constexpr double kSideRoom = 0.2;   // less between two bodies' sides is too little to pass [m]
constexpr double kDriveStep = 0.2;  // [s]
constexpr double kOverLine = 1.0;   // whose front is so far over a line has passed it [m]
constexpr double kPastJunction =
    20.0;  // of a way behind its first junction where it is still near [m]

// what weighs ways
constexpr double kLaneChange = 0.1, kTurnBack = 0.03;  // beside a way without
constexpr double kDirection = 0.15;                    // deviation of directions [rad]
constexpr double kDrifted = 0.35;                      // likewise of offsets [m]
constexpr double kTooFast = 0.2;                       // likewise of speeds, as a share
constexpr double kLeastWeight = 1e-3;

/// Exponent of a normal density of this deviation.
double misfit(double error, double deviation) {
  return 0.5 * error * error / (deviation * deviation);
}

/// As far along a way as an agent on the lane that it begins with can be [m].
double reach_of(const Path& path) {
  const double length = path.line.length();
  return path.links.empty() ? length : std::min(length, path.links.front().end + kPastJunction);
}

/// What is known of a way beforehand.
double prior_of(const RoadNetwork& network, const LaneWay& way) {
  const auto link = way.path->link_from(way.along);
  if (link == way.path->links.end()) return 1.0;
  const Connection& connection = network.connection(link->connection);
  double prior = connection.direction == TurnDirection::Turnaround ? kTurnBack : 1.0;
  // before its line: does it leave the lane under it?
  if (way.along < link->stop_line && connection.from != way.path->stretch_at(way.along).lane)
    prior *= kLaneChange;
  return prior;
}

/// Direction in which an agent goes [rad].
double direction_of_motion(const ObservedAgent& agent, const Vec2& velocity) {
  return velocity.norm() > kUnderWay ? heading_of(velocity) : agent.heading.back();
}

/// A point of a way, straight on behind its end.
Vec2 beside(const Polyline& line, double along, double offset) {
  const Vec2 direction = line.direction_at(along);
  return line.point_at(along) + std::max(0.0, along - line.length()) * direction +
         offset * left_of(direction);
}

}  // namespace

LaneGuide::LaneGuide(const AgentTypeTable& types, const PredictionMap& map)
    : types_(types), map_(map), locator_(*map.network), candidates_(*map.network) {
  for (AgentType& type : types_) type.max_speed = kFastest;
}

void LaneGuide::place(const ObservedScene& scene) {
  rows_.resize(scene.agents.size());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = scene.agents[r];
    const AgentType& type = type_of(types_, agent.type);
    Row& row = rows_[r];
    row.ways.clear();
    row.position = agent.now() + map_.offset;
    row.velocity = agent.last_velocity(scene.period);
    row.front = type.rear_axle_to_center + 0.5 * type.length;
    row.rear = 0.5 * type.length - type.rear_axle_to_center;
    row.driven = 0;
    row.rolling = row.velocity.norm();
  }
}

void LaneGuide::look(const ObservedScene& scene, std::size_t steps) {
  period_ = scene.period;
  steps_ = steps;
  place(scene);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    find_ways(scene.agents[r], rows_[r]);
    weigh(scene.agents[r], rows_[r]);
  }
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (LaneWay& way : rows_[r].ways) {
      find_leader(scene, r, way);
      find_red(scene, type_of(types_, scene.agents[r].type), rows_[r], way);
    }
  drive(scene);
}

void LaneGuide::find_ways(const ObservedAgent& agent, Row& row) {
  const AgentType& type = type_of(types_, agent.type);
  const double heading = direction_of_motion(agent, row.velocity);
  find_lanes_under(locator_, *map_.network, type, row.position, heading, hits_);
  for (const LaneHit& hit : hits_)
    for (const std::shared_ptr<const Path>& path : candidates_.ways(type, agent.type, hit.lane)) {
      const PolylinePosition at = path->line.project(row.position, 0.0, reach_of(*path));
      if (at.distance > kNearWay) continue;
      LaneWay way;
      way.path = path;
      way.along = at.along;
      way.offset = at.offset;
      way.drift = cross(path->line.direction_at(at.along), row.velocity);
      row.ways.push_back(std::move(way));
    }
}

void LaneGuide::weigh(const ObservedAgent& agent, Row& row) const {
  constexpr std::size_t kBack = 3;  // displacements
  const double speed = row.velocity.norm();
  const std::size_t back = std::min(kBack, agent.position.size() - 1);
  const Vec2 before = agent.position[agent.position.size() - 1 - back] + map_.offset;
  std::vector<double> misfits;
  double least = std::numeric_limits<double>::infinity();
  for (const LaneWay& way : row.ways) {
    double sum = 0;
    if (speed > kUnderWay) {
      const double turned =
          heading_of(way.path->line.direction_at(way.along)) - heading_of(row.velocity);
      sum += misfit(wrap_angle(turned), kDirection);
      const double allowed = std::max(way.path->profile_at(way.along + row.front), kUnderWay);
      sum += misfit(std::max(0.0, speed / allowed - 1.0), kTooFast);
    }
    const PolylinePosition was = way.path->line.project(before, 0.0, std::max(way.along, 1e-3));
    // a place before the way's begin tells nothing
    if (was.along > 0.0) sum += misfit(way.offset - was.offset, kDrifted);
    misfits.push_back(sum);
    least = std::min(least, sum);
  }
  double sum = 0;
  for (std::size_t k = 0; k < row.ways.size(); ++k) {
    LaneWay& way = row.ways[k];
    way.weight =
        prior_of(*map_.network, way) * std::max(std::exp(least - misfits[k]), kLeastWeight);
    sum += way.weight;
  }
  for (LaneWay& way : row.ways) way.weight /= sum;
}

void LaneGuide::find_leader(const ObservedScene& scene, std::size_t r, LaneWay& way) const {
  const Row& own = rows_[r];
  const Polyline& line = way.path->line;
  const double width = type_of(types_, scene.agents[r].type).width;
  double nearest = kSightAhead;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Row& other = rows_[k];
    if (k == r || (other.position - own.position).squaredNorm() > kSightAhead * kSightAhead)
      continue;
    const double aside = 0.5 * (width + type_of(types_, scene.agents[k].type).width) + kSideRoom;
    const PolylinePosition at =
        line.project_near(other.position, way.along, way.along + kSightAhead, 2.0 * kNearWay);
    if (at.distance > 2.0 * kNearWay || at.along <= way.along || at.along - way.along >= nearest)
      continue;
    // the way leads on beside its middle as far as the agent is beside it now
    if (std::abs(at.offset - way.offset) > aside) continue;
    const double along = other.velocity.dot(line.direction_at(at.along));
    // who crosses the way is nobody to follow
    if (other.velocity.norm() > kUnderWay && along < 0.5 * other.velocity.norm()) continue;
    nearest = at.along - way.along;
    way.leader = k;
    way.leader_speed = std::max(0.0, along);
    way.gap = nearest - own.front - other.rear;
  }
}

void LaneGuide::find_red(const ObservedScene& scene, const AgentType& type, const Row& row,
                         LaneWay& way) const {
  const double front = way.along + row.front, speed = row.velocity.norm();
  for (auto link = way.path->link_from(way.along); link != way.path->links.end(); ++link) {
    const Connection& connection = map_.network->connection(link->connection);
    if (connection.signal == kNoSignal || !map_.recorded[index_of(connection.signal)]) continue;
    if (front > link->stop_line + kOverLine) continue;
    const Light light = light_by_program(*map_.network, connection,
                                         scene.period * (scene.frame - map_.first_frame));
    if (light != Light::Red && light != Light::Amber) continue;
    const double left = link->halt - front;
    const double most =
        light == Light::Amber ? type.comfortable_deceleration : type.max_deceleration;
    if (deceleration_to_stop(speed, left + kOverLine) > most) continue;
    way.to_red = std::max(left, 0.0);
    return;
  }
}

void LaneGuide::find_drivers() {
  drivers_.clear();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    Row& row = rows_[r];
    const auto likeliest =
        std::max_element(row.ways.begin(), row.ways.end(),
                         [](const LaneWay& a, const LaneWay& b) { return a.weight < b.weight; });
    double allowed = kUnderWay;
    for (const LaneWay& way : row.ways)
      allowed = std::max(allowed, way.path->profile_at(way.along + row.front));
    // who is faster than the road allows now means to be
    const double speed = row.velocity.norm(), factor = std::max(1.0, speed / allowed);
    for (auto way = row.ways.begin(); way != row.ways.end(); ++way)
      drivers_.push_back({r, &*way, 0.0, speed, factor, way == likeliest});
  }
}

double LaneGuide::acceleration_of(const AgentType& type, const Driver& driver,
                                  double passed) const {
  const LaneWay& way = *driver.way;
  const double at = way.along + driver.driven + rows_[driver.row].front;
  const double free = driver.factor * way.path->profile_at(at);
  // the model halts its least gap before what stands
  const double to_red = way.to_red - driver.driven + type.min_gap;
  const double acceleration = following_acceleration(type, driver.speed, free, to_red, 0.0);
  if (!way.leader) return acceleration;
  const Row& leader = rows_[*way.leader];
  const bool drives = !leader.ways.empty();
  const double ahead = drives ? leader.driven : passed * way.leader_speed;
  const Followed followed{way.gap + ahead - driver.driven,
                          drives ? leader.rolling : way.leader_speed, 0.0};
  return std::min(acceleration, behind_acceleration(type, driver.speed, free, followed));
}

void LaneGuide::drive(const ObservedScene& scene) {
  find_drivers();
  const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(period_ / kDriveStep)));
  const double dt = period_ / static_cast<double>(parts);
  for (std::size_t part = 0; part < parts * steps_; ++part) {
    for (Driver& driver : drivers_) {
      const AgentType& type = type_of(types_, scene.agents[driver.row].type);
      const double before = driver.speed;
      driver.speed = std::max(
          0.0, before + dt * acceleration_of(type, driver, dt * static_cast<double>(part)));
      driver.driven += 0.5 * dt * (before + driver.speed);
    }
    // frozen: all have moved before anybody is seen to
    for (const Driver& driver : drivers_) {
      if (driver.likeliest) {
        rows_[driver.row].driven = driver.driven;
        rows_[driver.row].rolling = driver.speed;
      }
      if ((part + 1) % parts == 0) driver.way->driven[part / parts] = driver.driven;
    }
  }
}

void LaneGuide::paths(std::size_t r, std::span<const double, FlowMemory::kSteps> changing,
                      std::span<ExpertPath, kLaneMotions> paths) const {
  for (ExpertPath& path : paths) path.fill(Vec2::Zero());
  const Row& row = rows_[r];
  const double speed = row.velocity.norm();
  for (const LaneWay& way : row.ways) {
    const Polyline& line = way.path->line;
    for (std::size_t k = 0; k < steps_; ++k) {
      const double time = period_ * static_cast<double>(k + 1);
      const double drifted = way.drift * kDriftTime * (1.0 - std::exp(-time / kDriftTime));
      const double offset = way.offset + std::clamp(drifted, -kMostDrift, kMostDrift);
      const double progress[kLaneMotions] = {speed * time, changing[k], way.driven[k]};
      for (std::size_t m = 0; m < kLaneMotions; ++m)
        paths[m][k] += way.weight * (beside(line, way.along + progress[m], offset) - row.position);
    }
  }
}

}  // namespace sumogamma
