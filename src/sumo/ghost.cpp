#include "sumo/ghost.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/error.h"

namespace sumogamma {

LaneHint lane_hint(const std::string& lane) {
  const std::size_t line = lane.rfind('_');
  if (line == std::string::npos) return {};
  LaneHint hint{lane.substr(0, line), 0};
  std::from_chars(lane.data() + line + 1, lane.data() + lane.size(), hint.index);
  return hint;
}

double reroute_period(const std::string& parameter) {
  double period = -1.0;
  std::from_chars(parameter.data(), parameter.data() + parameter.size(), period);
  return period;
}

double wrapped_degrees(double angle) {
  const double wrapped = std::fmod(angle, 360.0);
  const double positive = wrapped < 0.0 ? wrapped + 360.0 : wrapped;
  return positive >= 360.0 ? 0.0 : positive;
}

void require_finite_pose(std::string_view id, Vec2 position, double angle, double speed) {
  if (std::isfinite(position.x()) && std::isfinite(position.y()) && std::isfinite(angle) &&
      std::isfinite(speed))
    return;
  throw std::logic_error("the pose of agent '" + std::string(id) + "' is not finite");
}

std::string ghost_fault(GhostMode mode, bool is_person, const GhostObservation& sent,
                        const GhostObservation& reported) {
  constexpr double kPositionTolerance = 1e-6, kAngleTolerance = 1e-3;
  std::ostringstream fault;
  const double distance = (reported.position - sent.position).norm();
  const double turned = std::abs(std::remainder(reported.angle - sent.angle, 360.0));
  if (!(distance <= kPositionTolerance)) {
    fault << "it stands " << distance << " m from where it was put";
  } else if (!(turned <= kAngleTolerance)) {
    fault << "it is turned by " << turned << " degrees";
  } else if (!is_person && mode == GhostMode::OffLane && !reported.lane.empty()) {
    fault << "it is on lane '" << reported.lane << "'";
  } else if (!is_person && reported.route != sent.route) {
    fault << "its route was changed";
  }
  return fault.str();
}

std::string GhostSelfTest::judge(const GhostObservation& sent, const GhostObservation& reported) {
  const std::string fault = ghost_fault(mode_, is_person_, sent, reported);
  const std::string kind = is_person_ ? "persons" : "vehicles";
  if (fault.empty()) {
    pending_ = false;
    return "";
  }
  if (mode_ == GhostMode::OffLane) {
    mode_ = GhostMode::OnLane;
    return "this SUMO does not hold " + kind + " off its lanes (" + fault +
           "): they are mapped onto lanes instead, which is slower";
  }
  pending_ = false;
  if (is_person_)
    throw Error("--pedestrian.model",
                "this SUMO ignores the poses of persons (" + fault +
                    "); run it with --pedestrian.model striping or leave persons to SUMO");
  return "this SUMO does not show " + kind + " at their exact pose (" + fault + ")";
}

}  // namespace sumogamma
