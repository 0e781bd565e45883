#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "geometry/polyline.h"
#include "osm/geo_projection.h"
#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Who a lanelet is for.
enum class LaneletUse : std::uint8_t { Road, Bicycle, Foot };

/// What its regulatory elements say of who drives on a lanelet.
enum class LaneletRule : std::uint8_t { None, GoesFirst, Yields, Stops, StopsOnAllArms };

/// A lanelet (Poggenhans et al. 2018): a piece of a lane that is driven one way, between two
/// borders that run in that direction.
struct Lanelet {
  std::int64_t id = 0;
  LaneletUse use = LaneletUse::Road;
  std::vector<std::int64_t> left, right;  ///< nodes of the borders
  Polyline center;                        ///< halfway between them [m]
  double width = 0;                       ///< the median along it [m]
  double speed = 0;                       ///< the limit [m/s]
  bool bicycles = true;                   ///< on a road: may they ride on it?
  bool signalled = false;                 ///< a traffic light is for it
  LaneletRule rule = LaneletRule::None;
};

/// A Lanelet2 map in the plane of a recording.
struct LaneletMap {
  std::vector<Lanelet> lanelets;         ///< in order of the file
  std::string axes;                      ///< how its places came into the plane, for people
  std::map<std::string, long> left_out;  ///< by kind: what it has that isn't read
  std::size_t turned = 0;                ///< lanelets whose borders ran against their direction
  std::size_t without_a_limit = 0;       ///< lanelets that get kLaneletSpeed
};

/// The plane of a recording whose axes have their origin at a place: UTM in its zone, less the
/// origin, as Lanelet2 projects.
class LaneletPlane {
 public:
  explicit LaneletPlane(GeoPoint origin);
  Vec2 place_of(GeoPoint point) const { return projection_.to_plane(point) - zero_; }
  /// For people.
  std::string describe() const;

 private:
  GeoPoint origin_;
  int zone_;
  GeoProjection projection_;
  Vec2 zero_;
};

/// Where a map tells no limit: 50 km/h [m/s].
inline constexpr double kLaneletSpeed = 50.0 / 3.6;

/// Reads OSM XML of Lanelet2's form (relations type=lanelet with a left and a right way; no subtype
/// counts as road), as INTERACTION, inD, SinD and the Test Area Baden-Württemberg have it. Places
/// are the nodes' local_x and local_y where all have them; else longitude and latitude by UTM in
/// the zone of the origin, less the origin, as Lanelet2 projects; without an origin it is 0, 0
/// where all nodes lie about there, as in INTERACTION's maps.
/// Throws Error naming the file, and the lanelet, where it is none, has no lanelets for vehicles,
/// or tells no places.
LaneletMap read_lanelet_map(const std::filesystem::path& file,
                            const std::optional<GeoPoint>& origin = std::nullopt);

}  // namespace sumogamma::osm
