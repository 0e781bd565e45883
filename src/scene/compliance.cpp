#include "scene/compliance.h"

#include <algorithm>

#include "base/random.h"

namespace sumogamma {

namespace {

/// Normal about `mean`, cut off at twice the deviation and below `least`.
double draw_normal(double mean, double deviation, double least, std::uint64_t seed,
                   std::uint64_t id, Draw purpose) {
  const double draw = std::clamp(random_normal(seed, id, 0, purpose), -2.0, 2.0);
  return std::max(mean + deviation * draw, least);
}

/// For the share `rate` of all (agent, place) pairs; nobody whose manners weren't drawn breaks a
/// rule.
bool breaks(const Manners& manners, std::uint64_t place, Draw purpose, double rate) {
  return manners.key != 0 && random_uniform(manners.key, place, 0, purpose) < rate;
}

}  // namespace

Manners draw_manners(const Compliance& compliance, std::uint64_t seed, std::uint32_t id) {
  Manners manners;
  manners.key = std::max<std::uint64_t>(random_bits(seed, id, 0, Draw::Compliance), 1);
  manners.headway_factor =
      draw_normal(1.0, compliance.headway_deviation, 0.3, seed, id, Draw::Headway);
  return manners;
}

double draw_speed_factor(const Compliance& compliance, std::uint64_t seed, std::uint64_t id) {
  return draw_normal(compliance.speed_factor, compliance.speed_factor_deviation, 0.2, seed, id,
                     Draw::DesiredSpeed);
}

double draw_free_speed(const Compliance& compliance, std::uint64_t seed, std::uint64_t id) {
  constexpr double kLeast = 0.2;  // [m/s]
  const double aside = random_uniform(seed, id, 1, Draw::DesiredSpeed, -1.0, 1.0);
  return std::max(compliance.free_speed + compliance.free_speed_spread * aside, kLeast);
}

double draw_mid_block(const Compliance& compliance, std::uint64_t seed, std::uint64_t id) {
  const double draw = random_uniform(seed, id, 0, Draw::MidBlock);
  return draw < compliance.jaywalking_rate ? draw / compliance.jaywalking_rate : -1.0;
}

bool runs_red_light(const Compliance& compliance, const Manners& manners, std::uint64_t place) {
  return breaks(manners, place, Draw::Compliance, compliance.red_light_running);
}

bool jaywalks(const Compliance& compliance, const Manners& manners, std::uint64_t place) {
  return breaks(manners, place, Draw::Jaywalking, compliance.jaywalking_rate);
}

bool yields_to_people(const Compliance& compliance, const Manners& manners, std::uint64_t place) {
  return manners.key == 0 ||
         random_uniform(manners.key, place, 0, Draw::Yielding) < compliance.yielding_rate;
}

bool rolls_at_stop_sign(const Compliance& compliance, const Manners& manners, std::uint64_t place) {
  return breaks(manners, place, Draw::RollingStop, compliance.rolling_stops);
}

bool creeps_at_red(const Compliance& compliance, const Manners& manners, std::uint64_t place) {
  return breaks(manners, place, Draw::Creeping, compliance.creeping);
}

}  // namespace sumogamma
