#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "prediction/track_set.h"

namespace sumogamma {

/// How windows are cut and scored.
enum class ProtocolId {
  A,  ///< the paper's script: 5 frames seen, the present one counts as the first of 12 predictions
  B,  ///< the same windows, 12 true steps
  C,  ///< the standard: 8 frames seen, 12 predicted
};

struct Protocol {
  ProtocolId id = ProtocolId::C;
  char letter = 'C';
  int observed = 8;             ///< frames seen before a prediction, the present one included
  int steps = 12;               ///< frames predicted and scored
  bool counts_present = false;  ///< the first scored row is the present: error 0
};

/// Throws Error on a letter that is none of A, B, C.
Protocol protocol_from_letter(std::string_view letter);

/// What a prediction may have learned from.
enum class Memory {
  Strict,  ///< its window alone: the frames seen of everybody present in them, nothing else
  Online,  ///< the recording so far
};
std::string_view name_of(Memory memory);
/// Throws Error on a name that is neither strict nor online.
Memory memory_from_name(std::string_view name);

/// One prediction to score: a track, seen up to and including `frame`.
struct Window {
  std::size_t track = 0;
  int frame = 0;
};

/// All windows of a recording, stride 1, by frame and then by track; none whose present lies in a
/// gap that was filled. Under A and B the recordings zara1 and zara2 lose their last frames as in
/// the paper's script.
std::vector<Window> windows_of(const TrackSet& set, const Protocol& protocol);

}  // namespace sumogamma
