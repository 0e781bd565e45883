#pragma once

#include <memory>
#include <string>

#include "geometry/vec2.h"
#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Transverse Mercator about the middle of the place, in metres, without an offset: known before
/// netconvert runs, so that obstacles line up with its network by construction, and distances are
/// true (a web-Mercator network is stretched by 1 / cos(latitude)).
std::string local_projection(GeoPoint center);

/// PROJ behind a small door: WGS 84 to the plane of a PROJ string. Throws Error where PROJ refuses
/// the string.
class GeoProjection {
 public:
  explicit GeoProjection(const std::string& definition);
  ~GeoProjection();
  GeoProjection(const GeoProjection&) = delete;
  GeoProjection& operator=(const GeoProjection&) = delete;

  /// Position in the plane [m].
  Vec2 to_plane(GeoPoint point) const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace sumogamma::osm
