#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "prediction/recording_formats.h"
#include "road/road_network.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// From one pose of a score to the next: 10 Hz, as the Waymo Open Sim Agents Challenge has it [s].
inline constexpr double kScoreStep = 0.1;

/// Which point of a body a recording's positions are.
enum class RecordedPoint : std::uint8_t { Centre, RearAxle };

/// How a recording is to be read.
struct SceneReading {
  ReadOptions tracks;  ///< of which `sample` counts for nothing
  RecordedPoint point = RecordedPoint::Centre;
  std::map<std::string, Vec2> boxes;  ///< length and width of who has none in it, by type [m]
};

/// Where somebody is, and how it moves.
struct MotionState {
  Vec2 position = Vec2::Zero();  ///< of the box's centre [m]
  Vec2 velocity = Vec2::Zero();  ///< [m/s]
  double heading = 0;            ///< [rad]
};

/// One agent of a recording, for as long as it was seen: a smoothed pose every kScoreStep, and what
/// was seen as it stands.
struct RecordedAgent {
  std::uint32_t id = 0;
  AgentTypeId type{};
  double length = 0, width = 0;      ///< of its box [m]
  bool default_box = false;          ///< the recording told none: the type's
  bool on_wheels = false;            ///< it rolls where it points, or walks where it will
  int first = 0;                     ///< step of the first pose
  std::vector<Vec2> position;        ///< of the box's centre, smoothed [m]
  std::vector<Vec2> velocity;        ///< likewise [m/s]
  std::vector<double> heading;       ///< continuous, without jumps by a turn [rad]
  double seen_from = 0;              ///< time of the first of `seen` [s]
  double seen_period = 0.1;          ///< [s]
  std::vector<Vec2> seen;            ///< of the box's centre, as recorded [m]
  std::vector<double> seen_heading;  ///< as annotated; empty: the recording tells none [rad]

  int last() const { return first + static_cast<int>(position.size()) - 1; }
  bool present(int step) const { return step >= first && step <= last(); }
  /// Smoothed, which knows what comes within half a window. Precondition: present(step).
  MotionState at(int step) const;
  /// From what was seen in the last second up to the step alone: a local parabola, a line where
  /// there are fewer than five points. Precondition: present(step).
  MotionState known_at(int step) const;
};

/// A recording that can be scored.
struct RecordedScene {
  std::string name, format;
  std::string file;  ///< as the user named it, for messages
  AgentTypeTable types;
  std::vector<RecordedAgent> agents;  ///< in order of id
  int first = 0, last = -1;           ///< steps
  std::vector<Obstacle> obstacles;
  double own_period = 0.1;         ///< of the file's own frames [s]
  std::size_t default_boxes = 0;   ///< agents with the box of their type
  std::size_t too_short = 0;       ///< tracks left out: under kLeastPoints points
  std::vector<std::string> notes;  ///< what was assumed, for people

  double duration() const { return kScoreStep * (last - first); }
};

/// A track with fewer points can't be smoothed.
inline constexpr std::size_t kLeastPoints = 5;

/// The types of recordings as they are scored and driven: the program's own, with its boxes, limits
/// and horizons (default_agent_types), in the order of recorded_agent_types. A moped is a
/// motorcycle with a box of 1.74 m x 0.78 m, as motorcycles of SinD Tianjin measure.
AgentTypeTable scored_agent_types();

/// Scored types that drive as `behavior` says of their names (of motorcycles for a moped): all but
/// bodies is taken from there.
AgentTypeTable behaving_as(const AgentTypeTable& scored, const AgentTypeTable& behavior);

/// Reads a recording in any format of recording_formats.h at 10 Hz, coarser ones at their own
/// frames, and smooths it by parabolas over 1.0 s, at least five points (Savitzky and Golay 1964);
/// coarser recordings are then brought to 10 Hz by cubics through places and velocities (Hermite).
/// Headings are the annotated ones (of who rolls at 2 m/s and more those within 60 degrees of its
/// motion, else that direction), or else of the smoothed velocity where it is over 0.5 m/s.
/// Throws Error on a file that can't be read, that tells no rate where the user doesn't either, or
/// whose frames are more than half a second apart, and on boxes of an unknown type.
RecordedScene read_recorded_scene(const std::filesystem::path& path,
                                  const SceneReading& reading = {});

}  // namespace sumogamma
