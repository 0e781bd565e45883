#pragma once

#include <cstdint>

namespace sumogamma {

/// How far the road users of a type keep the rules, and how they differ from each other. The
/// defaults are the preset `compliant`. docs/scenario.md tells where each number comes from.
struct Compliance {
  double red_light_running = 0;  ///< share of drivers that, meeting a red light, halt and then go
                                 ///< where the way is free
  double yielding_rate = 1;      ///< share of drivers that let people go first who wait at an
                                 ///< unsignalled crossing
  double jaywalking_rate = 0;    ///< share of people on foot that, meeting a red light, cross where
                                 ///< the way is free; and that cross roads between junctions
  double rolling_stops = 0;      ///< share of drivers that roll over the line of a stop sign where
                                 ///< the way is free, instead of halting there
  double creeping = 0;      ///< share of drivers that, first at a red light, roll on over its line
                            ///< and wait there
  double speed_factor = 0;  ///< mean of the desired speed over the limit (on foot and on bicycles:
                            ///< over the usual speed); 0: what SUMO drew from its vType
  double speed_factor_deviation = 0;
  double free_speed = 0;         ///< mean of the desired speed, whatever roads allow [m/s]; 0: as
                                 ///< speed_factor says
  double free_speed_spread = 0;  ///< of that to both sides, uniform [m/s]
  double headway_deviation = 0;  ///< of the factor on the type's headway, whose mean is 1
  double place_deviation = 0;    ///< of the place beside the middle of its lane that a driver likes
                                 ///< [m]; 0: nearly the middle (draw_path_offset)
  double responsibility_least = 0.5, responsibility_most = 0.6;  ///< gamma of Eq. 5, uniform
  double attention_least = 0.9, attention_most = 1.3;  ///< factor on the reach of Att, uniform
};

/// What was drawn for one agent when it came. The default keeps every rule.
struct Manners {
  double path_offset = 0;     ///< where beside its path it likes to be, positive left [m]
  std::uint64_t key = 0;      ///< of its draws an encounter, 0: keeps every rule
  double headway_factor = 1;  ///< on its type's headway
};

/// A pure function of seed and id.
Manners draw_manners(const Compliance& compliance, std::uint64_t seed, std::uint32_t id);

/// Factor on the desired speed of an agent whose type has one of its own (speed_factor > 0):
/// normal, cut off at twice the deviation, at least 0.2. A pure function of seed and id.
double draw_speed_factor(const Compliance& compliance, std::uint64_t seed, std::uint64_t id);

/// Desired speed of an agent whose type has a free_speed: uniform about it, at least 0.2 m/s [m/s].
/// A pure function of seed and id.
double draw_free_speed(const Compliance& compliance, std::uint64_t seed, std::uint64_t id);

/// For the share `jaywalking_rate` of all ids, who cross roads between junctions, a number in [0,
/// 1) that says where; -1 for the others. A pure function of seed and id.
double draw_mid_block(const Compliance& compliance, std::uint64_t seed, std::uint64_t id);

/// Draws an encounter: true for the share `rate` of all (agent, place) pairs, and always the same
/// for one pair.
bool runs_red_light(const Compliance& compliance, const Manners& manners, std::uint64_t place);
bool jaywalks(const Compliance& compliance, const Manners& manners, std::uint64_t place);
bool yields_to_people(const Compliance& compliance, const Manners& manners, std::uint64_t place);
bool rolls_at_stop_sign(const Compliance& compliance, const Manners& manners, std::uint64_t place);
bool creeps_at_red(const Compliance& compliance, const Manners& manners, std::uint64_t place);

}  // namespace sumogamma
