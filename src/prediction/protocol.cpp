#include "prediction/protocol.h"

#include <algorithm>
#include <limits>

#include "base/error.h"

namespace sumogamma {

namespace {
/// Last frame that the paper's script reads; beyond all frames for most recordings.
int last_frame_of_script(const std::string& name) {
  if (name == "zara1") return 898;
  if (name == "zara2") return 1048;
  return std::numeric_limits<int>::max();
}
}  // namespace

Protocol protocol_from_letter(std::string_view letter) {
  if (letter == "A") return {ProtocolId::A, 'A', 5, 12, true};
  if (letter == "B") return {ProtocolId::B, 'B', 5, 12, false};
  if (letter == "C") return {ProtocolId::C, 'C', 8, 12, false};
  throw Error("--protocol", "\"" + std::string(letter) + "\" is unknown, expected A, B or C");
}

std::string_view name_of(Memory memory) { return memory == Memory::Strict ? "strict" : "online"; }

Memory memory_from_name(std::string_view name) {
  for (const Memory memory : {Memory::Strict, Memory::Online})
    if (name == name_of(memory)) return memory;
  throw Error("--memory", "\"" + std::string(name) + "\" is unknown, expected strict or online");
}

std::vector<Window> windows_of(const TrackSet& set, const Protocol& protocol) {
  std::vector<Window> windows;
  const bool script = protocol.id != ProtocolId::C;
  const int last_read = script ? last_frame_of_script(set.name) : std::numeric_limits<int>::max();
  for (std::size_t t = 0; t < set.tracks.size(); ++t) {
    const Track& track = set.tracks[t];
    int begin = track.first + protocol.observed - 1;
    if (script) begin = std::max(begin, 1);
    const int end = std::min(track.last(), last_read) - protocol.steps;
    for (int frame = begin; frame <= end; ++frame) {
      // a point in a gap was made of the next one: it would tell the future
      const auto now = static_cast<std::size_t>(frame - track.first);
      if (track.filled.empty() || !track.filled[now]) windows.push_back({t, frame});
    }
  }
  std::stable_sort(windows.begin(), windows.end(),
                   [](const Window& a, const Window& b) { return a.frame < b.frame; });
  return windows;
}

}  // namespace sumogamma
