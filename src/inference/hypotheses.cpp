#include "inference/hypotheses.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "geometry/rotation.h"

namespace sumogamma {

std::string_view name_of(IntentionHypothesis intention) {
  switch (intention) {
    case IntentionHypothesis::KeepVelocity:
      return "keep_velocity";
    case IntentionHypothesis::KeepAcceleration:
      return "keep_acceleration";
    case IntentionHypothesis::ConstantTurnRate:
      return "constant_turn_rate";
    case IntentionHypothesis::Stop:
      return "stop";
    case IntentionHypothesis::RoadAhead:
      return "road_ahead";
    case IntentionHypothesis::RoadLeft:
      return "road_left";
    case IntentionHypothesis::RoadRight:
      break;
  }
  return "road_right";
}

namespace {
/// Way at unit speed that is lost at a rate [s].
double faded_time(double rate, double time) {
  return rate > 1e-9 ? (1.0 - std::exp(-rate * time)) / rate : time;
}

/// Speed and direction, each with its own fading change. Integrated by the midpoint of each period.
void turning_path(const MotionEstimate& motion, const IntentionTimes& times,
                  std::span<Vec2> displacement) {
  const double speed = motion.velocity.norm();
  const Vec2 forward = speed > 1e-9 ? Vec2(motion.velocity / speed) : Vec2(1, 0);
  const double pull = motion.acceleration.dot(forward);
  Vec2 place = Vec2::Zero();
  for (std::size_t k = 0; k < displacement.size(); ++k) {
    const double turned = motion.turn_rate * times.turn[k];
    const double gained = pull * times.faster[k];
    const double kept = speed * times.kept[k];
    place += std::max(0.0, kept + gained) * times.period * from_body(rotation(turned), forward);
    displacement[k] = place;
  }
}
}  // namespace

IntentionTimes::IntentionTimes(const IntentionShape& shape, double step)
    : period(step), acceleration_decay(shape.acceleration_decay) {
  for (std::size_t k = 0; k < kMost; ++k) {
    const double time = (static_cast<double>(k) + 1.0) * period;
    const double middle = (static_cast<double>(k) + 0.5) * period;
    way[k] = faded_time(shape.speed_decay, time);
    gain[k] = time - faded_time(1.0 / shape.acceleration_decay, time);
    stop[k] = faded_time(1.0 / shape.stop_time, time);
    turn[k] = faded_time(1.0 / shape.turn_decay, middle);
    faster[k] = faded_time(1.0 / shape.acceleration_decay, middle);
    kept[k] = std::exp(-shape.speed_decay * middle);
  }
}

void intended_path(IntentionHypothesis intention, const MotionEstimate& motion,
                   const IntentionTimes& times, std::span<Vec2> displacement) {
  assert(displacement.size() <= IntentionTimes::kMost);
  if (intention == IntentionHypothesis::ConstantTurnRate) {
    turning_path(motion, times, displacement);
    return;
  }
  for (std::size_t k = 0; k < displacement.size(); ++k) {
    if (intention == IntentionHypothesis::Stop) {
      displacement[k] = motion.velocity * times.stop[k];
      continue;
    }
    displacement[k] = motion.velocity * times.way[k];
    if (intention != IntentionHypothesis::KeepVelocity)
      displacement[k] += motion.acceleration * times.acceleration_decay * times.gain[k];
  }
}

AttentionRange attention_of(const AgentType& type, std::size_t k) {
  return {type.attention_front + 2.0 * static_cast<double>(k), type.attention_rear};
}

double responsibility_of(std::size_t k) { return k == 0 ? 0.5 : 0.2; }

}  // namespace sumogamma
