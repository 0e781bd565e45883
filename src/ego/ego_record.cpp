#include "ego/ego_record.h"

#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"
#include "scene/extent.h"
#include "scene/storey.h"
#include "study/offences/ground.h"

namespace sumogamma {

namespace {

constexpr double kMoving = 0.1;       // [m/s]
constexpr double kHardBraking = 3.0;  // [m/s^2]
constexpr double kCorner = 0.3;       // of a corner off the road, that counts [m]

/// Is the whole body between the borders of the lane that it is on?
bool is_in_one_lane(const Model& model, const Scene& scene, std::size_t row) {
  const LanePosition& place = scene.lane[row];
  if (place.lane == kNoLane) return false;
  const Lane& lane = model.road.lane(place.lane);
  const PolylinePosition here = lane.centerline.project(scene.position[row]);
  const double half = half_extent(scene, row, left_of(lane.centerline.direction_at(here.along)));
  return std::abs(here.offset) + half <= 0.5 * lane.width;
}

bool may_meet(const Model& model, const Scene& scene, std::size_t ego, std::size_t other,
              double reach) {
  const double radii = scene.footprint[ego].radius + scene.footprint[other].radius;
  return other != ego && scene.control[other] != Control::Parked &&
         (scene.position[other] - scene.position[ego]).norm() < radii + reach &&
         !on_other_storey(model.road, scene, ego, other);
}

double meeting_time(const Scene& scene, std::size_t ego, std::size_t other, double most) {
  constexpr double kLookEvery = 0.1;  // [s]
  OrientedBox own = box_of(scene, ego), their = box_of(scene, other);
  const Vec2 start = own.center, foe = their.center;
  const int steps = static_cast<int>(std::lround(most / kLookEvery));
  for (int k = 1; k <= steps; ++k) {
    const double time = kLookEvery * k;
    own.center = start + time * scene.velocity[ego];
    their.center = foe + time * scene.velocity[other];
    if (separation(own, their) <= 0.0) return time;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

bool is_at_fault(const EgoContact& contact) {
  switch (contact.kind) {
    case ContactKind::OtherStood:
    case ContactKind::Front:
      return true;
    case ContactKind::Side:
      return !contact.in_one_lane;
    case ContactKind::Standing:
    case ContactKind::FromBehind:
      break;
  }
  return false;
}

ContactKind contact_kind(const Scene& scene, std::size_t ego, std::size_t foe) {
  constexpr double kStands = 0.05;  // [m/s]
  if (scene.velocity[ego].norm() < kMoving) return ContactKind::Standing;
  if (scene.velocity[foe].norm() < kStands) return ContactKind::OtherStood;
  const OrientedBox own = box_of(scene, ego), their = box_of(scene, foe);
  // the thin strip of the own front, or rear, touches it
  const auto end_touches = [&](double side) {
    constexpr double kStrip = 0.1;  // [m]
    OrientedBox strip = own;
    strip.center += side * (own.half.x() - kStrip) * own.forward;
    strip.half = Vec2(kStrip, 0.95 * own.half.y());
    strip.half.x() += 0.02;  // they may only just touch
    return separation(strip, their) <= 0.0;
  };
  if (end_touches(1.0)) return ContactKind::Front;
  return end_touches(-1.0) ? ContactKind::FromBehind : ContactKind::Side;
}

double time_to_collision(const Model& model, const Scene& scene, std::size_t ego,
                         bool in_one_lane) {
  constexpr double kHorizon = 5.0;  // [s]
  double least = std::numeric_limits<double>::infinity();
  if (scene.velocity[ego].norm() < kMoving) return least;
  const OrientedBox own = box_of(scene, ego);
  for (std::size_t other = 0; other < scene.size(); ++other) {
    const double reach = kHorizon * (scene.velocity[ego].norm() + scene.velocity[other].norm());
    if (!may_meet(model, scene, ego, other, reach)) continue;
    const Vec2 place = to_body(scene.position[other] - own.center, own.forward);
    const bool ahead = place.x() > own.half.x();
    const bool beside = std::abs(place.x()) <= own.half.x();
    if (!ahead && !(beside && !in_one_lane)) continue;
    least = std::min(least, meeting_time(scene, ego, other, std::min(kHorizon, least)));
  }
  return least;
}

void EgoRecorder::add(const Scene& scene, const RoadState& road, std::size_t row, double since) {
  EgoSample sample;
  sample.time = since;
  sample.position = scene.position[row];
  sample.heading = scene.heading[row];
  sample.speed = scene.speed[row];
  if (!samples_.empty()) {
    const RoadContext& context = scene.context[row];
    const Vec2 moved = sample.position - samples_.back().position;
    sample.progress = context.active ? moved.dot(context.tangent) : moved.norm();
  }
  if (scene.lane[row].lane != kNoLane)
    sample.limit = model_.road.lane(scene.lane[row].lane).speed_limit;
  sample.in_one_lane = is_in_one_lane(model_, scene, row);
  look_at_ground(scene, road, row, sample);
  look_at_others(scene, row, sample);
  sample.time_to_collision = time_to_collision(model_, scene, row, sample.in_one_lane);
  samples_.push_back(sample);
}

void EgoRecorder::look_at_ground(const Scene& scene, const RoadState& road, std::size_t row,
                                 EgoSample& sample) {
  const RuleView view{roads_, scene, model_.types, road, road, step_};
  const OrientedBox box = box_of(scene, row);
  for (const Vec2& side : {Vec2(1, 1), Vec2(1, -1), Vec2(-1, 1), Vec2(-1, -1)}) {
    const Vec2 corner(side.x() * std::max(box.half.x() - kCorner, 0.0),
                      side.y() * std::max(box.half.y() - kCorner, 0.0));
    const Place here = place_at(view, row, box.center + from_body(corner, box.forward), work_);
    sample.off_area = sample.off_area || (here.none && !here.junction) || here.walkway;
  }
  const bool moves = scene.velocity[row].norm() > kMoving;
  if (moves && place_at(view, row, box.center, work_).against)
    sample.against = scene.velocity[row].norm() * step_;
}

void EgoRecorder::look_at_others(const Scene& scene, std::size_t row, EgoSample& sample) {
  constexpr double kNear = 30.0;  // [m]
  const OrientedBox own = box_of(scene, row);
  for (std::size_t other = 0; other < scene.size(); ++other) {
    const RoadContext& context = scene.context[other];
    if (other != row && context.active && context.foe == scene.id[row].value) {
      const double braking = -scene.acceleration[other].dot(direction_of(scene.heading[other]));
      if (braking > kHardBraking) ++sample.braking_others;
      const double wish = std::max(context.speed_limit, 0.1);
      sample.delay_of_others +=
          step_ * std::clamp(1.0 - scene.velocity[other].norm() / wish, 0.0, 1.0);
    }
    if (!may_meet(model_, scene, row, other, kNear)) continue;
    const OrientedBox their = box_of(scene, other);
    sample.gap = std::min(sample.gap, distance(own, their));
    constexpr double kContact = 1e-3;  // as in results.json [m]
    if (contact_ || separation(own, their) > -kContact) continue;
    contact_ = EgoContact{sample.time,
                          scene.id[other].value,
                          scene.type[other],
                          contact_kind(scene, row, other),
                          scene.velocity[row].norm() > kMoving,
                          sample.in_one_lane};
  }
}

}  // namespace sumogamma
