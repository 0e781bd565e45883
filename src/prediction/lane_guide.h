#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "inference/candidate_ways.h"
#include "prediction/experts.h"
#include "prediction/observed_scene.h"
#include "prediction/prediction_map.h"

namespace sumogamma {

/// How somebody gets on along the ways that its lane offers.
enum class LaneMotion : std::size_t {
  Steady,    ///< at the speed that it was seen at
  Changing,  ///< as far as its present acceleration leads
  Driven,    ///< towards the limits of road and bends, behind who is ahead, up to red lights
};
inline constexpr std::size_t kLaneMotions = 3;

/// A way on that somebody who lies on a lane may take.
struct LaneWay {
  std::shared_ptr<const Path> path;
  double weight = 0;                  ///< of all ways of an agent together 1
  double along = 0, offset = 0;       ///< of the agent's point on it now [m]
  double drift = 0;                   ///< its speed across it, positive to the left [m/s]
  std::optional<std::size_t> leader;  ///< row of who is next ahead on it
  double leader_speed = 0;            ///< of that one along the way now [m/s]
  double gap = 0;                     ///< from its front to that one's rear [m]
  /// From its front to where it halts for a red light that it can halt for; infinite: there is
  /// none [m].
  double to_red = std::numeric_limits<double>::infinity();
  std::array<double, FlowMemory::kSteps> driven{};  ///< by LaneMotion::Driven at each step [m]
};

/// Where lanes lead those who lie on them: candidate ways as the planner has them, each with a
/// weight, and how far everybody gets on them. What was seen up to the scene alone counts, and
/// nothing is kept from one scene to the next.
class LaneGuide {
 public:
  /// The map's network must outlive it.
  LaneGuide(const AgentTypeTable& types, const PredictionMap& map);

  /// Finds everybody's ways in a scene. A way's weight is a product of what is known beforehand
  /// (less where it takes a lane change, less still where it turns back) and of how the agent goes
  /// along it: direction, drift over the last three displacements, and how much faster it is than
  /// the way's bends allow. Signals count as they show in this frame, for as long as anybody asks.
  /// `steps`: of the ways that will be asked for, at most FlowMemory::kSteps.
  void look(const ObservedScene& scene, std::size_t steps = FlowMemory::kSteps);

  /// Does a row of the scene lie on a lane that leads anywhere?
  bool guides(std::size_t row) const { return !rows_[row].ways.empty(); }
  std::span<const LaneWay> ways(std::size_t row) const { return rows_[row].ways; }

  /// Displacements of a row [m] by each motion, the mean over its ways by their weights. It keeps
  /// its distance to the way, after the speed across it has died away within a second or two.
  /// `changing`: how far its acceleration leads by each step [m]. Of the steps that look() was told
  /// of; null behind them. Precondition: guides(row).
  void paths(std::size_t row, std::span<const double, FlowMemory::kSteps> changing,
             std::span<ExpertPath, kLaneMotions> paths) const;

 private:
  struct Row {
    std::vector<LaneWay> ways;
    Vec2 position = Vec2::Zero();    ///< on the network [m]
    Vec2 velocity = Vec2::Zero();    ///< of the last displacement [m/s]
    double front = 0, rear = 0;      ///< of its body from its point [m]
    double driven = 0, rolling = 0;  ///< so far along its likeliest way [m], and how fast [m/s]
  };
  void place(const ObservedScene& scene);
  void find_ways(const ObservedAgent& agent, Row& row);
  void weigh(const ObservedAgent& agent, Row& row) const;
  void find_leader(const ObservedScene& scene, std::size_t row, LaneWay& way) const;
  void find_red(const ObservedScene& scene, const AgentType& type, const Row& row,
                LaneWay& way) const;
  /// Somebody on its way in the joint roll-out of LaneMotion::Driven.
  struct Driver {
    std::size_t row = 0;
    LaneWay* way = nullptr;
    double driven = 0, speed = 0;  ///< so far [m], and now [m/s]
    double factor = 1;             ///< on what the way allows
    bool likeliest = false;        ///< of its row's ways: where others see it
  };
  void find_drivers();
  double acceleration_of(const AgentType& type, const Driver& driver, double passed) const;
  void drive(const ObservedScene& scene);

  AgentTypeTable types_;
  PredictionMap map_;
  double period_ = 0.4;
  std::size_t steps_ = FlowMemory::kSteps;
  LaneLocator locator_;
  CandidateWays candidates_;
  std::vector<LaneHit> hits_;
  std::vector<Row> rows_;
  std::vector<Driver> drivers_;
};

}  // namespace sumogamma
