#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "ego/forward_model.h"
#include "inference/candidate_ways.h"

namespace sumogamma {

/// How others are taken to go on.
enum class OthersModel : std::uint8_t {
  Gamma,          ///< by GAMMA, under the rules of the road where there are rules
  ConstantSpeed,  ///< along their way at their present speed, whatever happens
};

/// One way on that somebody may take.
struct WayOn {
  std::shared_ptr<const Path> path;             ///< of a vehicle; null: as `intention` says
  Intention intention = {IntentionKind::Stop};  ///< without a path: to stop, or a velocity
};

/// What may be in somebody's mind: its candidate ways, the last of them to stop.
struct WayBelief {
  AgentId id;
  LaneId lane = kNoLane;  ///< on which a vehicle's ways begin
  std::vector<WayOn> ways;
  std::vector<double> weights;  ///< of the ways; add up to 1
  double seen = 0;              ///< when it last was [s]
};

/// Ways on of somebody on foot: on, to the left, to the right and back from where it walks (who
/// stands: from where it looks, at its type's pace), and to stop.
std::vector<WayOn> ways_on_foot(const AgentType& type, const Vec2& velocity, double heading);

/// A step of everybody but the ego along its path at its present speed, `dt` [s] long.
void advance_at_constant_speed(const RoadState& road, std::size_t ego, double dt, Scene& scene);

/// Beliefs over the ways of those about an ego by Eqs. 8 to 10, from poses alone: at each look
/// every candidate is weighed by how the step that it predicts from the look before agrees with
/// what was seen. Uniform again where a vehicle's candidates change and where a walker has turned,
/// as a walker's ways turn with it. Forgotten after 2 s out of sight.
class WayBeliefs {
 public:
  explicit WayBeliefs(OthersModel model = OthersModel::Gamma) : model_(model) {}

  /// Once a period of about ForwardModel::kStep.
  void observe(const EgoView& view, ForwardModel& forward);

  /// In order of id.
  std::span<const WayBelief> all() const { return beliefs_; }
  const WayBelief* of(AgentId id) const;

 private:
  void weigh(const EgoView& view, ForwardModel& forward);
  void take_in(const EgoView& view);

  OthersModel model_;
  std::unique_ptr<CandidateWays> candidates_;
  const RoadNetwork* network_ = nullptr;  ///< whose ways the candidates are
  std::vector<WayBelief> beliefs_;
  Fork before_;  ///< those seen at the last look, without their own paths
  std::size_t before_ego_ = 0;
  Fork trial_;
};

/// How well a predicted displacement agrees with the one that was seen [m]: (N(turn; 0, 5 degrees)
/// + 0.001) * (N(way; 0, 0.1 m) + 0.001), the densities as shares of their peaks.
double likelihood(const Vec2& predicted, const Vec2& seen);

/// A fork of the ego and those about it whose only path is the ego's: what can be seen. `ego`: its
/// row there.
Fork seen_fork(const EgoView& view, std::size_t& ego);

/// Sends a row along a way, from where it is beside it.
void send_along(const WayOn& way, std::size_t row, Fork& fork);

}  // namespace sumogamma
