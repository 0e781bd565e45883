#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "ego/ego_view.h"
#include "study/offences/judges.h"

namespace sumogamma {

/// How the ego met somebody.
enum class ContactKind : std::uint8_t {
  Standing,    ///< the ego stood
  FromBehind,  ///< it was hit from behind
  Front,       ///< with its own front
  OtherStood,  ///< the other stood
  Side,        ///< side to side
};

/// What is noted of the ego once a tick: everything that metrics and scores are made of.
struct EgoSample {
  double time = 0;  ///< since the episode's begin [s]
  Vec2 position = Vec2::Zero();
  double heading = 0;   ///< [rad]
  double speed = 0;     ///< [m/s]
  double progress = 0;  ///< along its way since the tick before [m]
  double limit = std::numeric_limits<double>::infinity();  ///< speed limit of its lane [m/s]
  double gap = std::numeric_limits<double>::infinity();    ///< to the nearest body [m]
  double time_to_collision = std::numeric_limits<double>::infinity();  ///< [s], as nuPlan's
  bool off_area = false;       ///< a corner is more than 0.3 m off the ground for vehicles
  double against = 0;          ///< driven against the lane since the tick before [m]
  bool in_one_lane = true;     ///< its whole body
  int braking_others = 0;      ///< who brake harder than 3 m/s^2 for it
  double delay_of_others = 0;  ///< lost by those whom it holds up, since the tick before [s]
};

/// A contact as it began.
struct EgoContact {
  double time = 0;  ///< since the episode's begin [s]
  std::uint32_t foe = 0;
  AgentTypeId foe_type{};
  ContactKind kind{};
  bool moving = false;      ///< the ego was faster than 0.1 m/s
  bool in_one_lane = true;  ///< the ego's whole body was in one lane
};

/// Does the ego answer for it (nuPlan's rule)? The other stood, it ran into it with its front, or
/// side to side while it was not wholly in one lane. Never while it stands or is hit from behind.
bool is_at_fault(const EgoContact& contact);

/// What the ego's contact with another body is, by both bodies and velocities now.
ContactKind contact_kind(const Scene& scene, std::size_t ego, std::size_t foe);

/// Time until two boxes that keep their velocities touch, in steps of 0.1 s up to 5 s, as the
/// score has it: with those ahead, and with those beside only while the ego isn't wholly in one
/// lane [s]; infinite where none is met, or the ego stands.
double time_to_collision(const Model& model, const Scene& scene, std::size_t ego, bool in_one_lane);

/// Watches the ego from tick to tick.
class EgoRecorder {
 public:
  EgoRecorder(const RuleRoads& roads, const Model& model, double step)
      : roads_(roads), model_(model), step_(step) {}

  /// The state after a tick in which the ego was in the scene; `since` the episode's begin [s].
  void add(const Scene& scene, const RoadState& road, std::size_t row, double since);

  const std::vector<EgoSample>& samples() const { return samples_; }
  const std::optional<EgoContact>& contact() const { return contact_; }

 private:
  void look_at_ground(const Scene& scene, const RoadState& road, std::size_t row,
                      EgoSample& sample);
  void look_at_others(const Scene& scene, std::size_t row, EgoSample& sample);

  const RuleRoads& roads_;
  const Model& model_;
  double step_;
  RuleWork work_;
  std::vector<EgoSample> samples_;
  std::optional<EgoContact> contact_;
};

}  // namespace sumogamma
