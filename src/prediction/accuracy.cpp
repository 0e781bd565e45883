#include "prediction/accuracy.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "geometry/oriented_box.h"

namespace sumogamma {

namespace {
OrientedBox box_at(const AgentType& type, const Vec2& reference, double heading) {
  const Vec2 forward = direction_of(heading);
  return {reference + type.rear_axle_to_center * forward, forward,
          Vec2(0.5 * type.length, 0.5 * type.width)};
}

double reach(const AgentType& type) { return 0.5 * std::hypot(type.length, type.width); }

/// Boxes of all rows and steps.
struct Boxes {
  std::size_t steps = 0;
  std::vector<OrientedBox> box;
  std::vector<double> radius;      ///< by row [m]
  std::vector<std::size_t> alive;  ///< by row: steps at which it exists

  bool overlap(std::size_t a, std::size_t b) const {
    const double reach_of_both = radius[a] + radius[b];
    for (std::size_t k = 0; k < std::min(alive[a], alive[b]); ++k) {
      const OrientedBox &x = box[a * steps + k], &y = box[b * steps + k];
      if ((x.center - y.center).squaredNorm() > reach_of_both * reach_of_both) continue;
      if (separation(x, y) < 0) return true;
    }
    return false;
  }

  CollisionCount count() const {
    CollisionCount result;
    for (std::size_t a = 0; a < radius.size(); ++a)
      for (std::size_t b = a + 1; b < radius.size(); ++b) {
        ++result.pairs;
        result.overlapping += overlap(a, b);
      }
    return result;
  }
};
}  // namespace

WindowError window_error(const Track& truth, int frame, std::span<const Vec2> predicted,
                         const Protocol& protocol) {
  const auto now = static_cast<std::size_t>(frame - truth.first);
  const std::size_t rows = static_cast<std::size_t>(protocol.steps);
  const std::size_t used = protocol.counts_present ? rows - 1 : rows;
  WindowError error;
  for (std::size_t k = 0; k < used; ++k) {
    error.final = (predicted[k] - truth.position[now + 1 + k]).norm();
    error.average += error.final;
  }
  error.average /= static_cast<double>(rows);
  return error;
}

CollisionCount count_collisions(const AgentTypeTable& types, const ObservedScene& scene,
                                const Forecast& forecast, std::span<const std::size_t> rows,
                                std::size_t steps) {
  Boxes boxes;
  boxes.steps = steps;
  for (const std::size_t row : rows) {
    const AgentType& type = type_of(types, scene.agents[row].type);
    for (std::size_t k = 0; k < steps; ++k)
      boxes.box.push_back(box_at(type, forecast.row(row)[k], forecast.headings(row)[k]));
    boxes.radius.push_back(reach(type));
    boxes.alive.push_back(steps);
  }
  return boxes.count();
}

CollisionCount count_true_collisions(const AgentTypeTable& types, const TrackSet& set, int frame,
                                     std::span<const std::size_t> tracks, std::size_t steps) {
  Boxes boxes;
  boxes.steps = steps;
  for (const std::size_t t : tracks) {
    const Track& track = set.tracks[t];
    const AgentType& type = type_of(types, track.type);
    const auto alive = std::min(steps, static_cast<std::size_t>(track.last() - frame));
    const auto now = static_cast<std::size_t>(frame - track.first);
    for (std::size_t k = 0; k < steps; ++k) {
      const std::size_t at = now + 1 + std::min(k, alive - (alive > 0 ? 1 : 0));
      const std::size_t safe = std::min(at, track.position.size() - 1);
      boxes.box.push_back(box_at(type, track.position[safe], track.heading[safe]));
    }
    boxes.radius.push_back(reach(type));
    boxes.alive.push_back(alive);
  }
  return boxes.count();
}

Interval bootstrap_mean(std::span<const double> value, std::span<const std::size_t> agent,
                        std::uint64_t seed, int draws) {
  Interval interval;
  if (value.empty()) return interval;
  // sum and count by agent
  const std::size_t agents = *std::max_element(agent.begin(), agent.end()) + 1;
  std::vector<double> sums(agents, 0.0), counts(agents, 0.0);
  for (std::size_t k = 0; k < value.size(); ++k) {
    sums[agent[k]] += value[k];
    counts[agent[k]] += 1;
  }
  std::vector<std::size_t> present;
  double sum = 0, count = 0;
  for (std::size_t a = 0; a < agents; ++a)
    if (counts[a] > 0) {
      present.push_back(a);
      sum += sums[a];
      count += counts[a];
    }
  interval.mean = sum / count;
  std::vector<double> means;
  for (int draw = 0; draw < draws; ++draw) {
    double drawn_sum = 0, drawn_count = 0;
    for (std::size_t k = 0; k < present.size(); ++k) {
      const double u =
          random_uniform(seed, k, static_cast<std::uint64_t>(draw), Draw::ProcessNoise);
      const std::size_t a =
          present[static_cast<std::size_t>(u * static_cast<double>(present.size()))];
      drawn_sum += sums[a];
      drawn_count += counts[a];
    }
    means.push_back(drawn_sum / drawn_count);
  }
  std::sort(means.begin(), means.end());
  const auto at = [&](double share) {
    return means[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(means.size() - 1)))];
  };
  interval.low = at(0.025);
  interval.high = at(0.975);
  return interval;
}

}  // namespace sumogamma
