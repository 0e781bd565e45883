#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

inline const Tags kStreet = {{"highway", "residential"}};

}  // namespace sumogamma::osm
