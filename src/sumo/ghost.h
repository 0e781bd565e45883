#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// How moveToXY is used for an agent that we drive.
enum class GhostMode {
  OffLane,  ///< keepRoute 2 with a negative threshold: no lane is ever matched, so SUMO leaves the
            ///< agent alone
  OnLane,   ///< keepRoute 3 with an endless threshold: the fallback, mapped onto the lanes of its
            ///< route where possible
};

/// SUMO's speed mode in which setSpeed is obeyed as it stands, by no limit of lane, type or
/// braking.
constexpr int kSpeedModeFree = 0;
/// SUMO's default one.
constexpr int kSpeedModeSafe = 31;
/// Lane change modes: SUMO's default; none but those that TraCI asks for.
constexpr int kLaneChangesOwn = 1621, kLaneChangesNone = 512;

/// The two arguments of moveToXY that make a ghost.
struct GhostArguments {
  int keep_route = 2;
  double match_threshold = -1e9;
};
/// Those that put it onto the nearest lane of its route, at its very pose.
inline constexpr GhostArguments kOntoLane{3, 100.0};
constexpr GhostArguments ghost_arguments(GhostMode mode) {
  return mode == GhostMode::OffLane ? GhostArguments{2, -1e9} : GhostArguments{3, 1e9};
}

/// A lane's name in two parts, as moveToXY and stops want it; no lane: an empty edge.
struct LaneHint {
  std::string edge;
  int index = 0;
};
LaneHint lane_hint(const std::string& lane);

/// The time between two looks of a vehicle's rerouting device [s] from the text of its parameter
/// "device.rerouting.period"; negative: it has none.
double reroute_period(const std::string& parameter);

/// The same angle in [0, 360) [deg]. SUMO subtracts 360 in a loop, so an angle must be wrapped
/// before it is sent.
double wrapped_degrees(double angle);

/// Throws std::logic_error for a pose that is not finite: our own bug, which SUMO would answer with
/// garbage or a hang.
void require_finite_pose(std::string_view id, Vec2 position, double angle, double speed = 0);

/// What SUMO says of an agent, for the start-up self-test.
struct GhostObservation {
  Vec2 position = Vec2::Zero();
  double angle = 0;  ///< [deg]
  std::string lane;
  std::vector<std::string> route;
};

/// The start-up self-test of a ghost: after a step SUMO must report the very pose that was sent
/// (1e-6 m, 1e-3 deg), no lane (OffLane only, vehicles only) and an unchanged route (vehicles).
/// Returns what is wrong, empty: nothing.
std::string ghost_fault(GhostMode mode, bool is_person, const GhostObservation& sent,
                        const GhostObservation& reported);

/// The self-test as it goes along with the first agent of a kind that is driven: test OffLane, fall
/// back to OnLane, test that.
class GhostSelfTest {
 public:
  explicit GhostSelfTest(bool is_person) : is_person_(is_person) {}

  bool pending() const { return pending_; }
  GhostMode mode() const { return mode_; }
  /// Takes one observation into account. Returns a warning for the user, empty: all is well. Throws
  /// Error where persons can't be driven at all (a pedestrian model that ignores poses).
  std::string judge(const GhostObservation& sent, const GhostObservation& reported);

 private:
  bool is_person_;
  bool pending_ = true;
  GhostMode mode_ = GhostMode::OffLane;
};

}  // namespace sumogamma
