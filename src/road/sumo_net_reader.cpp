#include "road/sumo_net_reader.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/xml_text.h"
#include "road/inner_signals.h"
#include "road/junction_room.h"
#include "road/lane_crossings.h"
#include "road/overpasses.h"
#include "road/stop_lines.h"
#include "road/sumo_letters.h"

namespace sumogamma {
namespace {

constexpr double kDefaultLaneWidth =
    3.2;  // SUMO's SUMO_const_laneWidth, left out of the file where it applies

/// The root element.
pugi::xml_node load_document(const std::filesystem::path& file, pugi::xml_document& document) {
  const std::string content = read_maybe_gzip(file);
  const pugi::xml_parse_result parsed = document.load_buffer(content.data(), content.size());
  if (!parsed)
    throw Error(file.string(), std::string("not well-formed XML (") + parsed.description() +
                                   " at byte " + std::to_string(parsed.offset) +
                                   "), make or fetch the file again");
  if (declares_entities(content))
    throw Error(file.string(), "declares XML entities of its own, take them out");
  return document.document_element();
}

/// Words of a list separated by blanks.
template <typename Visit>
void for_each_word(std::string_view text, Visit&& visit) {
  std::size_t begin = 0;
  while ((begin = text.find_first_not_of(" \t\n\r", begin)) != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(" \t\n\r", begin), text.size());
    visit(text.substr(begin, end - begin));
    begin = end;
  }
}

struct Shape {
  std::vector<Vec2> points;
  std::vector<double> elevation;  ///< by point; empty where no point has a z
};

/// "x,y[,z] x,y[,z] ..."; false where it is anything else or not finite.
bool parse_shape(std::string_view text, Shape& shape) {
  shape.points.clear();
  shape.elevation.clear();
  bool valid = true, has_z = false;
  for_each_word(text, [&](std::string_view word) {
    std::array<double, 3> value{};
    std::size_t count = 0;
    const char* at = word.data();
    const char* const end = word.data() + word.size();
    while (at < end && count < 3) {
      const auto [next, error] = std::from_chars(at, end, value[count]);
      if (error != std::errc() || !std::isfinite(value[count])) break;
      ++count;
      at = next;
      if (at < end && *at == ',') ++at;
    }
    if (at != end || count < 2) {
      valid = false;
      return;
    }
    has_z = has_z || count == 3;
    shape.points.emplace_back(value[0], value[1]);
    shape.elevation.push_back(value[2]);
  });
  if (!has_z) shape.elevation.clear();
  return valid;
}

VehicleClassMask parse_class_list(std::string_view text) {
  VehicleClassMask mask = 0;
  for_each_word(text, [&](std::string_view word) {
    // "ignoring" is no permission that a lane could give
    if (word != "ignoring")
      mask |= word == "all" ? vehicle_class::kAll : vehicle_class_from_name(word);
  });
  return mask;
}

/// Who may use a lane, as SUMO reads it (parseVehicleClasses): an empty list is none, `allow` wins,
/// and networks older than 1.3 knew no rail_fast.
VehicleClassMask allowed_on(pugi::xml_node lane, double version) {
  const std::string_view allow = lane.attribute("allow").value();
  const std::string_view disallow = lane.attribute("disallow").value();
  if (!allow.empty()) return parse_class_list(allow);
  if (disallow.empty()) return vehicle_class::kAll;
  return ~(parse_class_list(disallow) | (version < 1.03 ? vehicle_class::kRailFast : 0u));
}

/// "1.16" as 1.16, "1.3" as 1.03: major and minor, so that versions compare; 0 where there is none.
double net_version(std::string_view text) {
  int major = 0, minor = 0;
  const char* const end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, major);
  if (error != std::errc()) return 0.0;
  if (after != end && *after == '.') std::from_chars(after + 1, end, minor);
  return major + 0.01 * minor;
}

/// Builds the arrays in the order that references need: junctions, edges and lanes, connections,
/// right of way.
class NetBuilder {
 public:
  NetBuilder(const std::filesystem::path& file, pugi::xml_node root)
      : file_(file.string()), root_(root) {}

  RoadNetwork build() {
    net_.left_hand = root_.attribute("lefthand").as_bool();
    version_ = net_version(root_.attribute("version").value());
    for (const pugi::xml_node node : root_.children("junction")) add_junction(node);
    for (const pugi::xml_node node : root_.children("edge")) add_edge(node);
    link_opposites();
    set_junction_layers();
    for (const pugi::xml_node node : root_.children("tlLogic")) add_signal(node);
    for (const pugi::xml_node node : root_.children("connection")) add_connection(node);
    for (const pugi::xml_node node : root_.children("junction")) add_right_of_way(node);
    leave_main_roads_without_stop_signs();
    for (const pugi::xml_node node : root_.children("roundabout"))
      for_each_word(node.attribute("nodes").value(), [&](std::string_view name) {
        const auto found = net_.junction_by_name.find(std::string(name));
        if (found != net_.junction_by_name.end())
          net_.junctions[index_of(found->second)].in_roundabout = true;
      });
    if (net_.lanes.empty()) fail("holds no lane, expected a road network");
    read_location();
    return std::move(net_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(file_, what); }

  std::string_view required(pugi::xml_node node, const char* attribute) const {
    const pugi::xml_attribute found = node.attribute(attribute);
    if (!found)
      fail("<" + std::string(node.name()) + " id=\"" + node.attribute("id").value() + "\"> (byte " +
           std::to_string(node.offset_debug()) + ") has no attribute '" + attribute + "'");
    return found.value();
  }

  double required_number(pugi::xml_node node, const char* attribute) const {
    const std::string_view text = required(node, attribute);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail("attribute " + std::string(attribute) + "=\"" + std::string(text) + "\" of <" +
           node.name() + " id=\"" + node.attribute("id").value() + "\"> is not a number");
    return value;
  }

  int required_whole(pugi::xml_node node, const char* attribute) const {
    constexpr double kMost = 1e6;
    const double value = required_number(node, attribute);
    if (value != std::floor(value) || std::abs(value) > kMost)
      fail("attribute " + std::string(attribute) + "=\"" + node.attribute(attribute).value() +
           "\" of <" + node.name() + "> is no whole number to count by");
    return static_cast<int>(value);
  }

  Shape shape_of(pugi::xml_node node, const char* attribute) const {
    Shape shape;
    if (!parse_shape(node.attribute(attribute).value(), shape))
      fail("attribute " + std::string(attribute) + " of <" + node.name() + " id=\"" +
           node.attribute("id").value() + "\"> is not a list of points x,y");
    return shape;
  }

  void add_junction(pugi::xml_node node) {
    const std::string_view type = required(node, "type");
    // an internal junction is a waiting place within another junction: RightOfWay::may_stop_inside
    // tells of it
    if (type == "internal") return;
    Junction junction;
    junction.name = required(node, "id");
    junction.type = type;
    junction.position = {required_number(node, "x"), required_number(node, "y")};
    junction.outline = shape_of(node, "shape").points;
    if (!net_.junction_by_name
             .emplace(junction.name, JunctionId(static_cast<int>(net_.junctions.size())))
             .second)
      fail("junction '" + junction.name + "' stands twice");
    net_.junctions.push_back(std::move(junction));
  }

  JunctionId junction_named(std::string_view name, std::string_view user) const {
    const auto found = net_.junction_by_name.find(std::string(name));
    if (found == net_.junction_by_name.end())
      fail("'" + std::string(user) + "' names the unknown junction '" + std::string(name) + "'");
    return found->second;
  }

  void add_edge(pugi::xml_node node) {
    Edge edge;
    edge.name = required(node, "id");
    const std::string_view function = node.attribute("function").value();
    edge.kind = function == "internal"      ? LaneKind::Internal
                : function == "crossing"    ? LaneKind::Crossing
                : function == "walkingarea" ? LaneKind::WalkingArea
                                            : LaneKind::Normal;
    edge.priority = node.attribute("priority").as_int();
    edge.type = node.attribute("type").value();
    JunctionId inside = kNoJunction;
    if (edge.kind == LaneKind::Normal) {
      edge.from = junction_named(required(node, "from"), edge.name);
      edge.to = junction_named(required(node, "to"), edge.name);
    } else {
      // ":<junction>_<number>", and the junction's name may hold underscores itself
      const std::size_t cut = edge.name.rfind('_');
      if (edge.name.empty() || edge.name.front() != ':' || cut == std::string::npos || cut < 2)
        fail("internal edge '" + edge.name + "' isn't named :<junction>_<number>");
      inside = junction_named(std::string_view(edge.name).substr(1, cut - 1), edge.name);
      edge.from = edge.to = inside;
    }
    const EdgeId id{static_cast<int>(net_.edges.size())};
    if (!net_.edge_by_name.emplace(edge.name, id).second)
      fail("edge '" + edge.name + "' stands twice");
    const int layer =
        node.find_child_by_attribute("param", "key", "layer").attribute("value").as_int();
    for (const pugi::xml_node lane : node.children("lane")) add_lane(lane, id, layer, edge, inside);
    if (edge.lanes.empty()) fail("edge '" + edge.name + "' has no lane");
    for (std::size_t i = 1; i < edge.lanes.size(); ++i) {
      net_.lanes[index_of(edge.lanes[i - 1])].inner = edge.lanes[i];
      net_.lanes[index_of(edge.lanes[i])].outer = edge.lanes[i - 1];
    }
    if (const pugi::xml_attribute crossed = node.attribute("crossingEdges"))
      crossed_.emplace_back(id, crossed.value());
    net_.edges.push_back(std::move(edge));
  }

  void add_lane(pugi::xml_node node, EdgeId edge_id, int layer, Edge& edge, JunctionId inside) {
    Lane lane;
    lane.name = required(node, "id");
    lane.edge = edge_id;
    // as SUMO counts: by place in the file, whatever its attribute says (some netconverts write 0
    // for all lanes on junctions)
    lane.index = static_cast<int>(edge.lanes.size());
    lane.kind = edge.kind;
    lane.layer = layer;
    lane.junction = inside;
    lane.allowed = allowed_on(node, version_);
    lane.speed_limit = required_number(node, "speed");
    lane.length = required_number(node, "length");
    lane.width = node.attribute("width") ? required_number(node, "width") : kDefaultLaneWidth;
    if (lane.width <= 0 || lane.length <= 0 || lane.speed_limit < 0)
      fail("lane '" + lane.name + "' has a width, length or speed that is not positive");
    Shape shape = shape_of(node, "shape");
    if (shape.points.empty()) fail("lane '" + lane.name + "' has an empty shape");
    set_centerline(lane, std::move(shape));
    if (lane.kind == LaneKind::WalkingArea)
      lane.outline = lane.centerline.points();
    else if (lane.kind == LaneKind::Crossing)
      lane.outline = shape_of(node, "outlineShape").points;
    const LaneId id{static_cast<int>(net_.lanes.size())};
    if (const pugi::xml_node neighbour = node.child("neigh"))
      opposite_.emplace_back(id, std::string(required(neighbour, "lane")));
    if (!net_.lane_by_name.emplace(lane.name, id).second)
      fail("lane '" + lane.name + "' stands twice");
    edge.lanes.push_back(id);
    net_.lanes.push_back(std::move(lane));
  }

  /// Polyline drops repeated points, so elevations are matched to the points that it kept.
  static void set_centerline(Lane& lane, Shape shape) {
    lane.centerline = Polyline(shape.points);
    if (shape.elevation.empty()) return;
    std::size_t read = 0;
    for (const Vec2& kept : lane.centerline.points()) {
      while (shape.points[read] != kept) ++read;
      lane.elevation.push_back(shape.elevation[read]);
    }
  }

  /// Layers on junctions, from the roads that meet there.
  void set_junction_layers() {
    std::vector<std::optional<int>> nearest(net_.junctions.size());
    for (const Edge& edge : net_.edges) {
      if (edge.kind != LaneKind::Normal) continue;
      const int own = net_.lane(edge.lanes.front()).layer;
      net_.has_layers = net_.has_layers || own != 0;
      for (const JunctionId end : {edge.from, edge.to}) {
        std::optional<int>& layer = nearest[index_of(end)];
        if (!layer || std::abs(own) < std::abs(*layer)) layer = own;
      }
    }
    for (Lane& lane : net_.lanes)
      if (lane.junction != kNoJunction) lane.layer = nearest[index_of(lane.junction)].value_or(0);
  }

  /// References to lanes and edges that stood later in the file.
  void link_opposites() {
    for (const auto& [lane, name] : opposite_) {
      const auto found = net_.lane_by_name.find(name);
      if (found == net_.lane_by_name.end())
        fail("lane '" + net_.lane(lane).name + "' names the unknown neighbour '" + name + "'");
      net_.lanes[index_of(lane)].opposite = found->second;
    }
    for (const auto& [edge, names] : crossed_)
      for_each_word(names, [&, id = edge](std::string_view name) {
        const auto found = net_.edge_by_name.find(std::string(name));
        if (found == net_.edge_by_name.end())
          fail("crossing '" + net_.edge(id).name + "' names the unknown edge '" +
               std::string(name) + "'");
        net_.edges[index_of(id)].crossing_edges.push_back(found->second);
      });
  }

  SignalId signal_named(const std::string& name) {
    const auto [entry, added] =
        net_.signal_by_name.emplace(name, SignalId(static_cast<int>(net_.signals.size())));
    if (added) net_.signals.push_back({name, 0, {}});
    return entry->second;
  }

  void grow_signal(SignalId id, std::size_t size) {
    std::size_t& known = net_.signals[index_of(id)].size;
    known = std::max(known, size);
  }

  void add_signal(pugi::xml_node node) {
    const SignalId id = signal_named(std::string(required(node, "id")));
    const bool first = net_.signals[index_of(id)].phases.empty();
    for (const pugi::xml_node phase : node.children("phase")) {
      const std::string state = phase.attribute("state").value();
      grow_signal(id, state.size());
      if (first)
        net_.signals[index_of(id)].phases.push_back({required_number(phase, "duration"), state});
    }
  }

  LaneId lane_of(pugi::xml_node node, const char* edge_attribute,
                 const char* lane_attribute) const {
    const std::string_view edge_name = required(node, edge_attribute);
    const auto edge = net_.edge_by_name.find(std::string(edge_name));
    if (edge == net_.edge_by_name.end())
      fail("a connection names the unknown edge '" + std::string(edge_name) + "'");
    const int index = required_whole(node, lane_attribute);
    const std::vector<LaneId>& lanes = net_.edge(edge->second).lanes;
    if (index < 0 || index >= static_cast<int>(lanes.size()))
      fail("a connection names lane " + std::to_string(index) + " of edge '" +
           std::string(edge_name) + "', which has " + std::to_string(lanes.size()));
    return lanes[static_cast<std::size_t>(index)];
  }

  void add_connection(pugi::xml_node node) {
    Connection connection;
    connection.from = lane_of(node, "from", "fromLane");
    connection.to = lane_of(node, "to", "toLane");
    if (const pugi::xml_attribute via = node.attribute("via")) {
      const auto found = net_.lane_by_name.find(via.value());
      if (found == net_.lane_by_name.end())
        fail("a connection names the unknown lane '" + std::string(via.value()) + "'");
      connection.via = found->second;
    }
    const Lane& from = net_.lane(connection.from);
    connection.junction = from.kind == LaneKind::Normal ? net_.edge(from.edge).to : from.junction;
    // linkIndex -1: a link at a signalled junction that no signal controls
    const pugi::xml_attribute signal = node.attribute("tl");
    const int link = signal ? required_whole(node, "linkIndex") : -1;
    if (link >= 0) {
      connection.signal = signal_named(signal.value());
      connection.signal_link = link;
      grow_signal(connection.signal, static_cast<std::size_t>(connection.signal_link) + 1);
    }
    const std::string_view direction = node.attribute("dir").value(),
                           state = node.attribute("state").value();
    if (!direction.empty()) connection.direction = direction_from_letter(direction.front());
    if (!state.empty()) connection.priority = priority_from_letter(state.front());
    const ConnectionId id{static_cast<int>(net_.connections.size())};
    net_.lanes[index_of(connection.from)].outgoing.push_back(id);
    net_.lanes[index_of(connection.to)].incoming.push_back(id);
    net_.connections.push_back(connection);
  }

  /// A stop sign stands on an approach, but netconvert gives its letter to every link of such a
  /// junction that yields: also to who turns off the main road across those who come towards it.
  void leave_main_roads_without_stop_signs() {
    std::vector<bool> is_main(net_.edges.size());
    const auto goes_on = [](TurnDirection direction) {
      return direction == TurnDirection::Straight || direction == TurnDirection::PartlyLeft ||
             direction == TurnDirection::PartlyRight;
    };
    // links of sidewalks onto walking areas have no right of way, and netconvert's letter for it
    for (const Connection& link : net_.connections)
      if (net_.lane(link.from).kind == LaneKind::Normal &&
          net_.lane(link.to).kind == LaneKind::Normal && link.signal == kNoSignal &&
          link.priority == LinkPriority::Major && goes_on(link.direction))
        is_main[index_of(net_.lane(link.from).edge)] = true;
    for (Connection& link : net_.connections)
      if (net_.lane(link.from).kind == LaneKind::Normal && link.priority == LinkPriority::Stop &&
          is_main[index_of(net_.lane(link.from).edge)])
        link.priority = LinkPriority::Minor;
  }

  static std::vector<bool> parse_bits(std::string_view text) {
    // SUMO writes the bit of link 0 last
    std::vector<bool> bits(text.size());
    for (std::size_t link = 0; link < bits.size(); ++link)
      bits[link] = text[text.size() - 1 - link] == '1';
    return bits;
  }

  void add_right_of_way(pugi::xml_node node) {
    const auto found = net_.junction_by_name.find(node.attribute("id").value());
    if (found == net_.junction_by_name.end()) return;
    Junction& junction = net_.junctions[index_of(found->second)];
    const auto rows = node.children("request");
    const auto count = static_cast<std::size_t>(std::distance(rows.begin(), rows.end()));
    junction.requests.resize(count);
    for (const pugi::xml_node row : rows) {
      const double index = required_number(row, "index");
      if (!(index >= 0 && index < static_cast<double>(count)))
        fail("junction '" + junction.name + "' has a request " + row.attribute("index").value() +
             " among its " + std::to_string(count));
      junction.requests[static_cast<std::size_t>(index)] = {parse_bits(required(row, "response")),
                                                            parse_bits(required(row, "foes")),
                                                            row.attribute("cont").as_bool()};
    }
    for (const RightOfWay& row : junction.requests)
      if (row.yields_to.size() != count || row.conflicts.size() != count)
        fail("a request of junction '" + junction.name + "' hasn't one bit for each of its " +
             std::to_string(count) + " links");
    junction.links.assign(count, kNoConnection);
    if (count > 0) number_links(node, junction);
  }

  /// Requests are numbered by incoming lane, then by the order of its connections in the file; of a
  /// walking area only the links onto crossings count (SUMO's MSRightOfWayJunction, and sumolib's
  /// getLinkIndex).
  void number_links(pugi::xml_node node, Junction& junction) {
    std::size_t next = 0;
    for_each_word(node.attribute("incLanes").value(), [&](std::string_view name) {
      const auto found = net_.lane_by_name.find(std::string(name));
      if (found == net_.lane_by_name.end())
        fail("junction '" + junction.name + "' names the unknown lane '" + std::string(name) + "'");
      const Lane& lane = net_.lane(found->second);
      for (const ConnectionId id : lane.outgoing) {
        Connection& connection = net_.connections[index_of(id)];
        const LaneKind to = net_.lane(connection.to).kind;
        // sidewalks join walking areas without a rule
        if (to == LaneKind::WalkingArea) continue;
        if (lane.kind == LaneKind::WalkingArea && to != LaneKind::Crossing) continue;
        if (next >= junction.links.size())
          fail("junction '" + junction.name + "' has more links than its " +
               std::to_string(junction.links.size()) + " requests");
        connection.junction_link = static_cast<int>(next);
        junction.links[next++] = id;
      }
    });
  }

  void read_location() {
    const pugi::xml_node location = root_.child("location");
    net_.projection = location ? location.attribute("projParameter").value() : "!";
    Shape offset;
    if (parse_shape(location.attribute("netOffset").value(), offset) && offset.points.size() == 1)
      net_.projection_offset = offset.points.front();
    // the file's own boundary leaves out lane widths and walking areas, so it is measured
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Vec2 lower(kInfinity, kInfinity), upper(-kInfinity, -kInfinity);
    for (const Lane& lane : net_.lanes) {
      const double half = lane.kind == LaneKind::WalkingArea ? 0.0 : 0.5 * lane.width;
      const Vec2 margin(half, half);
      for (const Vec2& point : lane.centerline.points()) {
        lower = lower.cwiseMin(point - margin);
        upper = upper.cwiseMax(point + margin);
      }
    }
    net_.lower_corner = lower;
    net_.upper_corner = upper;
    constexpr double kWidest = 5e6;  // [m]; grids over the network have cells by its size
    if (!net_.lanes.empty() && !((upper - lower).maxCoeff() < kWidest))
      fail("reaches over more than 5,000 km: the shape of a lane is damaged");
  }

  std::string file_;
  pugi::xml_node root_;
  RoadNetwork net_;
  double version_ = 0;
  std::vector<std::pair<LaneId, std::string>> opposite_;
  std::vector<std::pair<EdgeId, std::string>> crossed_;
};

}  // namespace

std::string read_maybe_gzip(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file))
    throw Error(file.string(), "no such file, expected a SUMO network");
  if (std::filesystem::is_directory(file))
    throw Error(file.string(), "is a folder, expected a file");
  gzFile stream = gzopen(file.c_str(), "rb");
  if (!stream) throw Error(file.string(), "can't be opened, check its permissions");
  std::string content;
  std::array<char, 1 << 16> chunk{};
  int read = 0;
  while ((read = gzread(stream, chunk.data(), static_cast<unsigned>(chunk.size()))) > 0)
    content.append(chunk.data(), static_cast<std::size_t>(read));
  int status = Z_OK;
  gzerror(stream, &status);
  gzclose(stream);
  // a truncated gzip ends with Z_BUF_ERROR although the last gzread returned data
  if (read < 0 || (status != Z_OK && status != Z_STREAM_END))
    throw Error(file.string(), "damaged or truncated gzip data, make or fetch the file again");
  return content;
}

VehicleClassMask vehicle_class_from_name(std::string_view name) {
  using namespace vehicle_class;
  static constexpr std::array<std::pair<std::string_view, VehicleClassMask>, 35> kNames{{
      {"pedestrian", kPedestrian},
      {"bicycle", kBicycle},
      {"motorcycle", kMotorcycle},
      {"moped", kMoped},
      {"passenger", kPassenger},
      {"delivery", kDelivery},
      {"truck", kTruck},
      {"trailer", kTrailer},
      {"bus", kBus},
      {"coach", kCoach},
      {"taxi", kTaxi},
      {"emergency", kEmergency},
      {"authority", kAuthority},
      {"army", kArmy},
      {"vip", kVip},
      {"private", kPrivate},
      {"hov", kHov},
      {"evehicle", kEvehicle},
      {"tram", kTram},
      {"rail_urban", kRailUrban},
      {"rail", kRail},
      {"rail_electric", kRailElectric},
      {"rail_fast", kRailFast},
      {"ship", kShip},
      {"custom1", kCustom1},
      {"custom2", kCustom2},
      {"ignoring", kAll},
      // deprecated, which SUMO still reads
      {"public_emergency", kEmergency},
      {"public_authority", kAuthority},
      {"public_army", kArmy},
      {"public_transport", kBus},
      {"transport", kTruck},
      {"lightrail", kTram},
      {"cityrail", kRailUrban},
      {"rail_slow", kRail},
  }};
  for (const auto& [known, mask] : kNames)
    if (known == name) return mask;
  return kOther;
}

double elevation_at(const Lane& lane, double along) {
  if (lane.elevation.empty()) return 0.0;
  if (lane.elevation.size() == 1) return lane.elevation.front();
  const std::size_t i = lane.centerline.segment_at(along);
  const double from = lane.centerline.along_of_vertex(i),
               to = lane.centerline.along_of_vertex(i + 1);
  const double t = std::clamp((along - from) / (to - from), 0.0, 1.0);
  return lane.elevation[i] + t * (lane.elevation[i + 1] - lane.elevation[i]);
}

RoadNetwork read_sumo_net(const std::filesystem::path& file, Workers& workers) {
  pugi::xml_document document;
  load_document(file, document);
  return read_sumo_net(document, file, workers);
}

RoadNetwork read_net_elements(const pugi::xml_document& document,
                              const std::filesystem::path& file) {
  const pugi::xml_node root = document.document_element();
  if (std::string_view(root.name()) != "net")
    throw Error(file.string(),
                "root element is <" + std::string(root.name()) + ">, expected <net>");
  return NetBuilder(file, root).build();
}

RoadNetwork read_sumo_net(const pugi::xml_document& document, const std::filesystem::path& file,
                          Workers& workers) {
  RoadNetwork network = read_net_elements(document, file);
  set_back_stop_lines(network, workers);
  find_inner_signals(network);
  set_junction_rooms(network, workers);
  find_overpasses(network);
  find_lane_crossings(network, workers);
  return network;
}

void read_obstacles(const std::filesystem::path& file, RoadNetwork& network) {
  pugi::xml_document document;
  // SUMO takes any root element of an additional file
  const pugi::xml_node root = load_document(file, document);
  for (const pugi::xml_node node : root.children("poly")) {
    const std::string_view type = node.attribute("type").value();
    const bool building = type.substr(0, 8) == "building", barrier = type.substr(0, 7) == "barrier";
    const bool furniture = type.substr(0, 9) == "furniture", closed = building || furniture;
    if (!closed && !barrier) continue;
    if (node.attribute("geo").as_bool())
      continue;  // longitude and latitude: not in the network's metres
    Shape shape;
    if (!parse_shape(node.attribute("shape").value(), shape))
      throw Error(file.string(), "the shape of polygon '" +
                                     std::string(node.attribute("id").value()) +
                                     "' is not a list of points x,y");
    std::vector<Vec2>& points = shape.points;
    if (closed && points.size() > 1 && points.front() == points.back()) points.pop_back();
    if (points.size() < (closed ? 3u : 2u)) continue;
    network.obstacles.push_back({building    ? ObstacleKind::Building
                                 : furniture ? ObstacleKind::Furniture
                                             : ObstacleKind::Barrier,
                                 std::move(points)});
  }
}

std::map<std::string, std::vector<Vec2>> read_polygons(const std::filesystem::path& file) {
  pugi::xml_document document;
  const pugi::xml_node root = load_document(file, document);
  std::map<std::string, std::vector<Vec2>> rings;
  for (const pugi::xml_node node : root.children("poly")) {
    const std::string id = node.attribute("id").value();
    if (node.attribute("geo").as_bool()) continue;
    Shape shape;
    if (!parse_shape(node.attribute("shape").value(), shape))
      throw Error(file.string(), "the shape of polygon '" + id + "' is not a list of points x,y");
    if (shape.points.size() >= 3) rings.emplace(id, std::move(shape.points));
  }
  return rings;
}

}  // namespace sumogamma
