#pragma once

#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// One rule of who is driven by GAMMA: all that it says must hold for an agent.
struct ControlRule {
  /// Agent types ("car"), SUMO's vTypes and ids, with * for any letters and ? for one; empty:
  /// everybody.
  std::vector<std::string> who;
  double share = 1.0;  ///< of these, in [0, 1]: drawn once for each, from seed and id
  std::vector<std::vector<Vec2>>
      areas;              ///< rings [m], in one of which it has to be; empty: anywhere
  std::string area_file;  ///< FILE, FILE#ID or #ID of a polygon, not read yet
  std::string around;     ///< id of an agent, not further than `radius` from it
  double radius = 0;      ///< [m]
  double from = -std::numeric_limits<double>::infinity(),
         to = std::numeric_limits<double>::infinity();  ///< on SUMO's clock [s]

  /// Does it depend on place and time? Who is chosen by another kind of rule is ours all the way.
  bool changes() const { return !areas.empty() || !around.empty() || from > -1e300 || to < 1e300; }
};

/// Which agents GAMMA takes over: those for whom one rule holds.
struct ControlChoice {
  std::vector<ControlRule> rules;

  bool any() const { return !rules.empty(); }
  /// Everybody, everywhere, all the time?
  bool all() const;
  bool changes() const;
  /// Is anybody ours from its departure on?
  bool takes_newcomers() const;
  /// What rules call types and ids, patterns included.
  std::set<std::string> names() const;
};

/// The ring of a box (x0, y0, x1, y1) or of three points and more (x, y, x, y, ...); empty where it
/// is neither.
std::vector<Vec2> ring_of(const std::vector<double>& numbers);

/// Everybody, always.
ControlChoice control_of_all();

/// Does `text` fit a pattern with * and ?
bool matches(std::string_view pattern, std::string_view text);

/// Is an agent one of those of whom a rule speaks? A pure function of its arguments.
bool concerns(const ControlRule& rule, std::string_view type, std::string_view vtype,
              std::string_view id, std::uint64_t seed);

/// Does a rule hold at a place and time? Who is in already stays in until it is `slack` [m]
/// outside. `center`: of the circle, not finite where its agent isn't there.
bool holds(const ControlRule& rule, const Vec2& position, const Vec2& center, double time,
           double slack);

}  // namespace sumogamma
