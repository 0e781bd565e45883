#include "sumo/control_choice.h"

#include <algorithm>
#include <cmath>

#include "base/hash.h"
#include "base/random.h"
#include "geometry/segment.h"

namespace sumogamma {

namespace {

/// Distance of a place from a ring's inside [m]: 0 within.
double distance_outside(const std::vector<Vec2>& ring, const Vec2& place) {
  bool inside = false;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++) {
    const Vec2 &a = ring[before], &b = ring[i];
    if ((a.y() > place.y()) != (b.y() > place.y()) &&
        place.x() < a.x() + (b.x() - a.x()) * (place.y() - a.y()) / (b.y() - a.y()))
      inside = !inside;
    nearest = std::min(nearest, distance_to_segment(a, b, place));
  }
  return inside ? 0.0 : nearest;
}

}  // namespace

bool ControlChoice::all() const {
  return std::any_of(rules.begin(), rules.end(), [](const ControlRule& rule) {
    return rule.who.empty() && rule.share >= 1.0 && !rule.changes();
  });
}

bool ControlChoice::takes_newcomers() const {
  return std::any_of(rules.begin(), rules.end(),
                     [](const ControlRule& rule) { return !rule.changes(); });
}

bool ControlChoice::changes() const {
  return std::any_of(rules.begin(), rules.end(),
                     [](const ControlRule& rule) { return rule.changes(); });
}

std::set<std::string> ControlChoice::names() const {
  std::set<std::string> names;
  for (const ControlRule& rule : rules) {
    names.insert(rule.who.begin(), rule.who.end());
    if (!rule.around.empty()) names.insert(rule.around);
  }
  return names;
}

std::vector<Vec2> ring_of(const std::vector<double>& numbers) {
  if (numbers.size() % 2 != 0 || numbers.size() < 4) return {};
  if (numbers.size() == 4) {
    const double x0 = numbers[0], y0 = numbers[1], x1 = numbers[2], y1 = numbers[3];
    return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  }
  std::vector<Vec2> ring;
  for (std::size_t i = 0; i < numbers.size(); i += 2) ring.emplace_back(numbers[i], numbers[i + 1]);
  return ring;
}

ControlChoice control_of_all() { return {{ControlRule{}}}; }

bool matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t]) && pattern[p] != '*') {
      ++p;
      ++t;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

bool concerns(const ControlRule& rule, std::string_view type, std::string_view vtype,
              std::string_view id, std::uint64_t seed) {
  const bool named =
      rule.who.empty() || std::any_of(rule.who.begin(), rule.who.end(), [&](const auto& who) {
        return matches(who, type) || matches(who, vtype) || matches(who, id);
      });
  return named &&
         (rule.share >= 1.0 || random_uniform(seed, fnv1a(id), 0, Draw::Control) < rule.share);
}

bool holds(const ControlRule& rule, const Vec2& position, const Vec2& center, double time,
           double slack) {
  if (time < rule.from || time >= rule.to) return false;
  if (!rule.around.empty() && !((position - center).norm() <= rule.radius + slack)) return false;
  return rule.areas.empty() ||
         std::any_of(rule.areas.begin(), rule.areas.end(), [&](const std::vector<Vec2>& ring) {
           return distance_outside(ring, position) <= slack;
         });
}

}  // namespace sumogamma
