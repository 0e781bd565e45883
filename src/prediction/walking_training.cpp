#include "prediction/walking_training.h"

#include <fmt/format.h>

#include "prediction/walking_model.h"

namespace sumogamma {

namespace {
constexpr std::size_t kAhead[] = {3, 6, 9, 12};

void append(fmt::memory_buffer& line, const Vec2& vector) {
  fmt::format_to(std::back_inserter(line), ",{:.6g},{:.6g}", vector.x(), vector.y());
}
}  // namespace

void write_walking_rows(std::ostream& out, const TrackSet& set, bool header) {
  const AgentTypeTable types = recorded_agent_types();
  const Protocol protocol = protocol_from_letter("C");
  if (header) {
    out << "set";
    for (const std::size_t ahead : kAhead) out << ",x" << ahead << ",y" << ahead;
    for (std::size_t f = 0; f < kWalkingFeatures; ++f) out << ",fx" << f << ",fy" << f;
    out << '\n';
  }
  std::vector<WalkingFeatures> features;
  int shown = set.first_frame - 1;
  TrackSet window;
  ObservedScene scene;
  for (const Window& asked : windows_of(set, protocol)) {
    const Track& track = set.tracks[asked.track];
    if (type_of(types, track.type).kinematics != Kinematics::Holonomic) continue;
    if (asked.frame != shown) {
      window = window_of(set, asked.frame - protocol.observed + 1, asked.frame);
      scene = observe(window, asked.frame);
      walking_features(types, scene, features);
      shown = asked.frame;
    }
    std::size_t row = 0;
    while (scene.agents[row].id != track.id) ++row;
    fmt::memory_buffer line;
    fmt::format_to(std::back_inserter(line), "{}", set.name);
    const auto now = static_cast<std::size_t>(asked.frame - track.first);
    for (const std::size_t ahead : kAhead)
      append(line, track.position[now + ahead] - track.position[now]);
    for (const Vec2& feature : features[row]) append(line, feature);
    out << fmt::to_string(line) << '\n';
  }
}

}  // namespace sumogamma
