#pragma once

#include "prediction/recording_formats.h"
#include "prediction/track_set.h"

namespace sumogamma {

/// Tracks of a recording, a point every `options.sample` from its first observation on, by linear
/// interpolation between observations (exact where observations fall on the steps). Where
/// observations are missing for longer than 1.5 of the file's own steps there is a gap: up to
/// `fill` seconds it is filled and counted, a longer one makes two tracks of one. A file that
/// doesn't tell its rate is taken to have a step every 0.4 s, which its notes say. `file` for
/// messages. Throws Error on an agent twice in a frame, on times instead of counted frames, and
/// where nobody moves as people or vehicles do at the rate that had to be assumed.
TrackSet resampled_tracks(const RawRecording& raw, const ReadOptions& options,
                          const AgentTypeTable& types, const std::string& file);

}  // namespace sumogamma
