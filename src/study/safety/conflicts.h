#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "road/road_network.h"
#include "scene/agent_type.h"
#include "scene/scene.h"
#include "scene/storey.h"
#include "study/agent_track.h"
#include "study/safety/encroachment.h"
#include "study/safety/pair_measures.h"

namespace sumogamma {

/// From where on a measure is one of a conflict.
struct ConflictThresholds {
  double time_to_collision = 0;  ///< below [s]
  double post_encroachment = 0;  ///< below [s]
  double deceleration = 0;       ///< DRAC above [m/s^2]
};

/// The defaults of SUMO's SSM device.
inline constexpr ConflictThresholds kSumoThresholds{3.0, 2.0, 3.0};
/// FHWA's Surrogate Safety Assessment Model (FHWA-HRT-08-051, chapter 6): a conflict is what comes
/// within 1.5 s of a collision; neither encroachment nor deceleration makes one by itself.
inline constexpr ConflictThresholds kFhwaThresholds{1.5, 0.0,
                                                    std::numeric_limits<double>::infinity()};

/// By the angle of the two ways, as SSAM has it: rear end up to 30 degrees, crossing from 85.
enum class ConflictKind : std::uint8_t { RearEnd, LaneChange, Crossing };

/// One encounter of two road users, from when a measure first passed SUMO's thresholds until none
/// has for ConflictMonitor::kOver.
struct Conflict {
  AgentId a, b;  ///< a < b
  AgentTypeId type_a{}, type_b{};
  double since = 0, until = 0;  ///< [s]
  double time = 0;              ///< of the least time to collision, or of the encroachment [s]
  Vec2 place = Vec2::Zero();    ///< midway between the two then [m]
  ConflictKind kind = ConflictKind::RearEnd;
  double time_to_collision = std::numeric_limits<double>::infinity();  ///< least [s]
  double post_encroachment = std::numeric_limits<double>::infinity();  ///< least [s]
  double deceleration = 0, modified_deceleration = 0;                  ///< most [m/s^2]
  double gap = std::numeric_limits<double>::infinity();                ///< least [m]
  double relative_speed = 0;                                           ///< at `time` [m/s]
  bool touched = false;                                                ///< they overlapped

  bool is_beyond(const ConflictThresholds& thresholds) const {
    return time_to_collision < thresholds.time_to_collision ||
           post_encroachment < thresholds.post_encroachment ||
           deceleration > thresholds.deceleration;
  }
  /// Hayward's near miss: under a second to collision, and none.
  bool is_near_miss() const { return !touched && time_to_collision < 1.0; }
};

/// Keys of `safety` in results.json.
struct SafetyResult {
  std::uint64_t conflicts_sumo = 0, conflicts_fhwa = 0;  ///< encounters beyond each set
  std::uint64_t near_misses = 0;
  std::uint64_t ttc_below_1_5 = 0, pet_below_2 = 0, drac_above_3 = 0, mdrac_above_3 = 0;
  double conflicts_fhwa_per_100_km = 0;
  double time_exposed_s = 0;  ///< summed over pairs: to collision in less than 1.5 s
  double least_gap_m = -1;    ///< of those that didn't touch; -1 where there was no encounter
  std::map<std::string, std::uint64_t> by_types;  ///< beyond FHWA's, "car-pedestrian"
  std::map<std::string, std::uint64_t> by_kind;   ///< beyond FHWA's: rear_end, ...
};

const char* name_of(ConflictKind kind);

/// Watches all pairs of road users, whoever drives them, but two on foot: for them nothing is in
/// danger. Who stands off the road (Control::Parked) is left out, too, and so are agents above one
/// another. Times to collision are looked at every kPeriod, encroachments at every step.
class ConflictMonitor {
 public:
  static constexpr double kPeriod = 0.1;  ///< [s]
  static constexpr double kOver = 3.0;    ///< [s]

  /// `step`: time between two calls of add [s]. `road`: for heights, or null; must outlive the
  /// monitor.
  explicit ConflictMonitor(double step, const RoadNetwork* road = nullptr);

  void add(const Scene& scene, const AgentTypeTable& types);

  /// Those that are over, in order of their ends.
  const std::vector<Conflict>& over() const { return over_; }
  /// Those that are over and those that aren't, in order of their beginning, then of ids.
  std::vector<Conflict> conflicts() const;
  SafetyResult result(const AgentTypeTable& types) const;

 private:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  struct State {
    bool known = false;
    double heading = 0, turn_rate = 0;
  };
  struct Reach {
    double left = 0, right = 0;
    std::uint32_t row = 0;
  };
  void update_bodies(const Scene& scene, const AgentTypeTable& types);
  void look_at_pairs(const Scene& scene);
  void look_at(const Scene& scene, std::uint32_t a, std::uint32_t b);
  void add_encroachments(const Scene& scene);
  bool counts(const Scene& scene, std::uint32_t a, std::uint32_t b) const;
  /// The running encounter of a pair, begun where there is none.
  Conflict& encounter(const Scene& scene, std::uint32_t a, std::uint32_t b);
  void end_old(double now);

  double step_;
  std::int64_t every_, tick_ = 0;
  const RoadNetwork* road_;
  bool has_storeys_;
  double driven_ = 0;   ///< way of all [m]
  double exposed_ = 0;  ///< [s]
  EncroachmentMonitor encroachments_;
  AgentTrack<State> track_;
  std::map<Pair, Conflict> open_;
  std::vector<Conflict> over_;

  // scratch of one tick
  std::vector<MovingBody> bodies_;
  std::vector<bool> on_foot_;
  std::vector<Reach> reaches_;
};

}  // namespace sumogamma
