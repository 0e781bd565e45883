#include "prediction/plot.h"

#include <fmt/format.h>

#include <algorithm>

namespace sumogamma {

namespace {

constexpr double kPixels = 32;   // a metre
constexpr double kMargin = 1.5;  // around everything [m]
constexpr double kLegend = 34;   // [px]

/// World to picture.
struct Frame {
  Vec2 low = Vec2(1e300, 1e300), high = Vec2(-1e300, -1e300);

  void hold(const Vec2& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  double x(const Vec2& p) const { return kPixels * (p.x() - low.x() + kMargin); }
  double y(const Vec2& p) const { return kLegend + kPixels * (high.y() - p.y() + kMargin); }
  double width() const { return kPixels * (high.x() - low.x() + 2 * kMargin); }
  double height() const { return kLegend + kPixels * (high.y() - low.y() + 2 * kMargin); }
};

std::string polyline(const Frame& frame, const std::vector<Vec2>& points, const char* style) {
  std::string text = R"(<polyline fill="none" )" + std::string(style) + R"( points=")";
  for (const Vec2& point : points)
    text += fmt::format("{:.1f},{:.1f} ", frame.x(point), frame.y(point));
  return text + R"("/>)"
                "\n";
}

std::string dots(const Frame& frame, const std::vector<Vec2>& points, const char* color) {
  std::string text;
  for (std::size_t k = 1; k < points.size(); ++k)
    text += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.2" fill="{}"/>)"
                        "\n",
                        frame.x(points[k]), frame.y(points[k]), color);
  return text;
}

std::vector<Vec2> path_of(const ObservedAgent& agent, const Forecast& forecast, std::size_t row) {
  std::vector<Vec2> path = {agent.now()};
  path.insert(path.end(), forecast.row(row).begin(), forecast.row(row).end());
  return path;
}

std::vector<Vec2> true_path(const TrackSet& truth, const ObservedScene& scene, std::uint32_t id,
                            std::size_t steps) {
  for (const Track& track : truth.tracks) {
    if (track.id != id || !track.present(scene.frame)) continue;
    const auto now = track.position.begin() + (scene.frame - track.first);
    const auto left = static_cast<std::size_t>(track.position.end() - now);
    return {now, now + static_cast<std::ptrdiff_t>(std::min(left, steps + 1))};
  }
  return {};
}

std::string box(const Frame& frame, const AgentType& type, const ObservedAgent& agent) {
  const Vec2 forward = direction_of(agent.heading.back());
  const Vec2 center = agent.now() + type.rear_axle_to_center * forward;
  std::string text = R"(<polygon fill="#dddddd" stroke="#888888" points=")";
  for (const Vec2& corner : {Vec2(1, 1), Vec2(-1, 1), Vec2(-1, -1), Vec2(1, -1)}) {
    const Vec2 at =
        center +
        from_body(Vec2(0.5 * type.length * corner.x(), 0.5 * type.width * corner.y()), forward);
    text += fmt::format("{:.1f},{:.1f} ", frame.x(at), frame.y(at));
  }
  return text + R"("/>)"
                "\n";
}

std::string solid(const Frame& frame, const Obstacle& obstacle) {
  std::string text = R"(<polygon fill="#e9d8c4" stroke="#b08d62" points=")";
  for (const Vec2& at : obstacle.outline)
    text += fmt::format("{:.1f},{:.1f} ", frame.x(at), frame.y(at));
  return text + R"("/>)"
                "\n";
}

}  // namespace

std::string forecast_svg(const TrackSet& truth, const ObservedScene& scene,
                         const Forecast& forecast, const std::vector<Forecast>& samples) {
  const AgentTypeTable types = recorded_agent_types();
  Frame frame;
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    frame.hold(scene.agents[row].now());
    for (const Vec2& point : forecast.row(row)) frame.hold(point);
    for (const Vec2& point : true_path(truth, scene, scene.agents[row].id, forecast.steps))
      frame.hold(point);
  }
  if (scene.agents.empty()) frame.hold(Vec2::Zero());
  std::string text =
      fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{:.0f}" height="{:.0f}" )",
                  frame.width(), frame.height());
  text += R"(font-family="sans-serif" font-size="14">)"
          "\n"
          R"(<rect width="100%" height="100%" )"
          R"(fill="white"/>)"
          "\n";
  for (const Obstacle& obstacle : truth.obstacles) text += solid(frame, obstacle);
  for (const ObservedAgent& agent : scene.agents)
    text += box(frame, type_of(types, agent.type), agent);
  for (const Forecast& sample : samples)
    for (std::size_t row = 0; row < scene.agents.size(); ++row)
      text += polyline(frame, path_of(scene.agents[row], sample, row),
                       R"(stroke="#9ecae9" stroke-width="1")");
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    const ObservedAgent& agent = scene.agents[row];
    const std::size_t seen = std::min<std::size_t>(agent.position.size(), 8);
    const auto past = agent.position.last(seen);
    text += polyline(frame, {past.begin(), past.end()}, R"(stroke="#999999" stroke-width="2")");
    const std::vector<Vec2> truth_path = true_path(truth, scene, agent.id, forecast.steps);
    text += polyline(frame, truth_path, R"(stroke="#000000" stroke-width="2")") +
            dots(frame, truth_path, "#000000");
    const std::vector<Vec2> predicted = path_of(agent, forecast, row);
    text += polyline(frame, predicted, R"(stroke="#1f6fb4" stroke-width="2")") +
            dots(frame, predicted, "#1f6fb4");
  }
  text += fmt::format(
      R"(<text x="8" y="20">{}, frame {}: seen grey, truth black, prediction blue{}</text>)"
      "\n",
      truth.name, scene.frame, samples.empty() ? "" : ", samples light");
  return text + "</svg>\n";
}

}  // namespace sumogamma
