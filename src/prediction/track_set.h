#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "road/road_network.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// One agent of a recording: frames first, first + 1, ... without a gap.
struct Track {
  std::uint32_t id = 0;
  AgentTypeId type{};
  int first = 0;
  std::vector<Vec2> position;   ///< of the reference point: rear axle on wheels, centre on foot [m]
  std::vector<double> heading;  ///< as annotated, or else the last direction of motion [rad]

  int last() const { return first + static_cast<int>(position.size()) - 1; }
  bool present(int frame) const { return frame >= first && frame <= last(); }
};

/// A recorded scene: the past as data, sampled once every `period`.
struct TrackSet {
  std::string name;
  double period = 0.4;        ///< [s]
  std::vector<Track> tracks;  ///< in order of id
  int first_frame = 0, last_frame = -1;
  std::vector<Obstacle> obstacles;  ///< solid things, in the same axes
};

/// The types of the recordings with the boxes, wheelbases and limits that the published predictor
/// uses (pedestrian, moped, bicycle, electric_tricycle, car, van, bus); a type's
/// rear_axle_to_center leads from a track's position to its footprint's centre.
AgentTypeTable recorded_agent_types();

/// Reads `frame,agent_id,agent_type,x_m,y_m,vx_mps,vy_mps,heading_x,heading_y` (CSV with a header,
/// columns found by name, heading and type optional) or the common text format `frame id x y`
/// (blanks or tabs, no header, frames a constant number apart, everybody on foot). An agent whose
/// frames have a gap becomes several tracks. Where NAME_obstacles.json stands beside NAME.csv, its
/// polygons come along. Throws Error naming file and line.
TrackSet read_track_set(const std::filesystem::path& path);

/// The same recording with its observations disturbed by normal noise of this deviation [m], to see
/// what a predictor owes to observations that are finer than any tracker's.
TrackSet with_noise(const TrackSet& set, double deviation, std::uint64_t seed);

}  // namespace sumogamma
