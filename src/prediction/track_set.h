#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geometry/vec2.h"
#include "prediction/recording_formats.h"
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
  bool annotated = false;       ///< the recording tells headings itself
  std::vector<bool> filled{};   ///< by frame: lies in a gap that was filled; empty: none does
  double length = 0, width = 0;  ///< of the body, 0 where the recording tells none [m]

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
  std::string format;               ///< as which it was read
  double own_period = 0.4;          ///< of the file's own frames [s]
  bool assumed_period = false;      ///< the file tells none, nor did the user
  std::int64_t filled_gaps = 0, filled_steps = 0, split_gaps = 0;
  std::vector<std::string> notes;  ///< what was assumed in reading it
};

/// The types of the recordings with the boxes, wheelbases and limits that the published predictor
/// uses (pedestrian, moped, bicycle, electric_tricycle, car, van, bus), and a truck; a type's
/// rear_axle_to_center leads from a track's position to its footprint's centre.
AgentTypeTable recorded_agent_types();

/// Headings of a track: as annotated where that is a number, or else the direction of the last
/// motion. Somebody on foot has none before moving.
void point_track(const AgentTypeTable& types, std::span<const double> annotated, Track& track);

/// Reads a recording in any format of recording_formats.h and samples it every `options.sample`
/// (resampling.h). Where NAME_obstacles.json stands beside NAME.csv, its polygons come along.
/// Throws Error naming file and line.
TrackSet read_track_set(const std::filesystem::path& path, const ReadOptions& options = {});

/// A number that two recordings of the same tracks share, whatever they are called and in whatever
/// order: it is made of the positions, to a centimetre.
std::uint64_t content_of(const TrackSet& set);

/// The frames [first, last] of a recording as a recording by itself: whoever is present at any of
/// them, with these positions and nothing from before or after. Directions of motion are taken from
/// these positions alone. Obstacles come along.
TrackSet window_of(const TrackSet& set, int first, int last);

/// The same recording with its observations disturbed by normal noise of this deviation [m], to see
/// what a predictor owes to observations that are finer than any tracker's.
TrackSet with_noise(const TrackSet& set, double deviation, std::uint64_t seed);

}  // namespace sumogamma
