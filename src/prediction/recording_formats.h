#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// What a user tells about recordings; what isn't told is found by looking.
struct ReadOptions {
  std::string format;   ///< one of recording_formats(), empty: by looking
  double period = 0;    ///< of the file's own frames [s]; 0: as the format has it
  double fill = 1.0;    ///< gaps up to this long are filled [s]
  double sample = 0.4;  ///< from one point of a track to the next [s]; 0.4 is every benchmark's
  std::map<std::string, std::string> types;  ///< what a file calls a type, and our name for it
};

/// One observation of one agent.
struct RawPoint {
  double frame = 0;  ///< counted, or seconds, see RawRecording::unit
  std::uint32_t id = 0;
  AgentTypeId type{};
  Vec2 position = Vec2::Zero();  ///< [m]
  double heading = 0;            ///< [rad], not a number where the file tells none
  double length = 0, width = 0;  ///< of the body, 0 where the file tells none [m]
};

/// A file as it stands, in metres.
struct RawRecording {
  std::string format, name;
  double unit = 0;     ///< seconds that one of `frame` is; 0: the file doesn't tell
  bool times = false;  ///< `frame` is a time, not a count
  double step = 0;     ///< seconds that the smallest step between frames is; 0: likewise
  std::vector<RawPoint> points;
  std::vector<std::string> notes;  ///< what was assumed, for people
};

/// Names for --format: csv, text, juelich, trajnet, interaction, levelx, sind, dut.
std::string recording_formats();

/// Reads a recording with what belongs to it beside it (meta data; the other kind of road user).
/// Delimiters are found by looking: semicolon, comma, tab, blanks. Throws Error naming file and
/// line.
RawRecording read_raw_recording(const std::filesystem::path& path, const ReadOptions& options,
                                const AgentTypeTable& types);

}  // namespace sumogamma
