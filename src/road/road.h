#pragma once

#include <filesystem>

#include "base/parallel.h"
#include "road/swept_ways.h"

namespace sumogamma {

/// A network and what is worked out from it alone.
struct Road {
  RoadNetwork network;
  ConflictTable conflicts;   ///< by connection
  SweptWayTable swept_ways;  ///< likewise
};

/// Where roads are kept that were read before, so that the next start needn't work them out again.
struct RoadCache {
  std::filesystem::path folder;            ///< empty: none are kept
  std::uintmax_t least_network = 1 << 20;  ///< smaller files are read in no time [bytes]
  std::uintmax_t most_kept = 1u << 30;     ///< what wasn't used for longest goes first [bytes]
};

/// Reads a SUMO network and works out conflicts and swept ways, or takes all of it from the cache,
/// where it lies by the hash of the network file, of this program and of how its C library
/// computes: a road from there is the same to the last bit. What can't be read there, isn't whole
/// or can't be written is left alone. Throws Error as read_sumo_net() does.
Road read_road(const std::filesystem::path& file, const RoadCache& cache, Workers& workers);

}  // namespace sumogamma
