#include "osm/geo_projection.h"

#include <proj.h>

#include <cstdio>

#include "base/error.h"
#include "base/units.h"

namespace sumogamma::osm {

struct GeoProjection::Handle {
  PJ_CONTEXT* context = nullptr;
  PJ* transformation = nullptr;
};

std::string local_projection(GeoPoint center) {
  char text[256];
  std::snprintf(text, sizeof text,
                "+proj=tmerc +lat_0=%.6f +lon_0=%.6f +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +datum=WGS84 "
                "+units=m +no_defs",
                center.lat, center.lon);
  return text;
}

GeoProjection::GeoProjection(const std::string& definition) : handle_(std::make_unique<Handle>()) {
  handle_->context = proj_context_create();
  proj_log_level(handle_->context, PJ_LOG_NONE);
  handle_->transformation = proj_create(handle_->context, definition.c_str());
  if (handle_->transformation == nullptr) {
    proj_context_destroy(handle_->context);
    throw Error("projection '" + definition + "'", "PROJ does not know it");
  }
}

GeoProjection::~GeoProjection() {
  proj_destroy(handle_->transformation);
  proj_context_destroy(handle_->context);
}

Vec2 GeoProjection::to_plane(GeoPoint point) const {
  // a bare "+proj=..." takes radians
  const PJ_COORD in = proj_coord(radians(point.lon), radians(point.lat), 0, 0);
  const PJ_COORD out = proj_trans(handle_->transformation, PJ_FWD, in);
  return {out.xy.x, out.xy.y};
}

}  // namespace sumogamma::osm
