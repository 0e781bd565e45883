// Draws the kinematic set K of every built-in type at several speeds: draw_kinematic_sets >
// docs/kinematic_sets.svg Build it with `cmake --build build/dev --target draw_kinematic_sets`.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "model/kinematic_set.h"
#include "model/model.h"

namespace sumogamma {
namespace {

constexpr double kCell = 130, kLeft = 130, kTop = 60;  // [px]

/// The part of a convex polygon on the free side of a plane.
std::vector<Vec2> clip(const std::vector<Vec2>& polygon, const HalfPlane& plane) {
  std::vector<Vec2> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const double at_a = slack(plane, a), at_b = slack(plane, b);
    if (at_a >= 0) kept.push_back(a);
    if ((at_a >= 0) != (at_b >= 0)) kept.push_back(a + (at_a / (at_a - at_b)) * (b - a));
  }
  return kept;
}

std::vector<Vec2> outline_of(const Model& model, std::size_t type, double speed) {
  Scene scene;
  AgentState agent;
  agent.type = static_cast<AgentTypeId>(type);
  agent.speed = speed;
  append_agent(scene, agent);
  ConstraintSet set;
  append_kinematic_constraints(model, scene, 0, Vec2(1, 0), set);
  std::vector<Vec2> polygon;
  for (int k = 0; k < 90; ++k)
    polygon.push_back(model.types[type].max_speed * direction_of(k * 3.14159265358979 / 45));
  for (const HalfPlane& plane : set.planes) polygon = clip(polygon, plane);
  return polygon;
}

void draw_cell(const Model& model, std::size_t type, double speed, double x, double y) {
  const std::vector<Vec2> polygon = outline_of(model, type, speed);
  double most = 0.1;
  for (const Vec2& v : polygon) most = std::max(most, v.norm());
  const double scale = 0.9 * kCell / (2 * most);
  // forward is up; the dot is the null velocity, the bar the present one
  const double center_x = x + kCell / 2, center_y = y + kCell * 0.55;
  std::printf("<rect x='%.0f' y='%.0f' width='%.0f' height='%.0f' fill='none' stroke='#ddd'/>\n", x,
              y, kCell, kCell);
  std::printf("<polygon fill='#7fb2e5' fill-opacity='0.6' stroke='#1f5f9f' points='");
  for (const Vec2& v : polygon)
    std::printf("%.1f,%.1f ", center_x - scale * v.y(), center_y - scale * v.x());
  std::printf("'/>\n<circle cx='%.1f' cy='%.1f' r='2'/>\n", center_x, center_y);
  std::printf("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' stroke='#c33' stroke-width='2'/>\n",
              center_x, center_y, center_x, center_y - scale * speed);
  std::printf("<text x='%.0f' y='%.0f' font-size='10' fill='#555'>to %.1f m/s</text>\n", x + 4,
              y + kCell - 5, most);
}

}  // namespace

int draw() {
  Model model;
  Workers workers(2);
  model.types = default_agent_types();
  model.kinematics = build_kinematic_tables(model.types, workers);
  const double speeds[] = {0, 1, 3, 6, 12, 20};
  const double width = kLeft + 6 * kCell + 10,
               height = kTop + kCell * static_cast<double>(model.types.size()) + 10;
  std::printf(
      "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f' font-family='sans-serif' "
      "font-size='13'>\n",
      width, height);
  std::printf(
      "<rect width='100%%' height='100%%' fill='white'/>\n<text x='10' y='20'>Kinematic sets K "
      "(forward is up; red: the "
      "present velocity; each cell has its own scale)</text>\n");
  for (std::size_t s = 0; s < 6; ++s)
    std::printf("<text x='%.0f' y='%.0f'>at %.0f m/s</text>\n",
                kLeft + kCell * (static_cast<double>(s) + 0.3), kTop - 8, speeds[s]);
  for (std::size_t type = 0; type < model.types.size(); ++type) {
    const double y = kTop + kCell * static_cast<double>(type);
    std::printf("<text x='10' y='%.0f'>%s</text>\n", y + kCell / 2, model.types[type].name.c_str());
    for (std::size_t s = 0; s < 6; ++s)
      if (speeds[s] <= model.types[type].max_speed)
        draw_cell(model, type, speeds[s], kLeft + kCell * static_cast<double>(s), y);
  }
  std::printf("</svg>\n");
  return 0;
}

}  // namespace sumogamma

int main() { return sumogamma::draw(); }
