#include "road/road_archive.h"

#include <concepts>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

namespace sumogamma {
namespace {

/// A T, constant where it is written from.
template <typename Value, typename T>
concept Is = std::same_as<std::remove_const_t<Value>, T>;

// Each type names all its members, in one list for both ways. A member that is added to the type
// and not here doesn't compile.

template <typename Archive, Is<LaneCrossing> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [other, apart] = value;
  archive(other, apart);
}

template <typename Archive, Is<JunctionNeighbour> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [junction, way] = value;
  archive(junction, way);
}

template <typename Archive, Is<Overpass> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [one, other, along_one, along_other] = value;
  archive(one, other, along_one, along_other);
}

template <typename Archive, Is<Connection> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [from, to, via, junction, junction_link, signal, signal_link, setback, storage, direction,
         priority] = value;
  archive(from, to, via, junction, junction_link, signal, signal_link, setback, storage, direction,
          priority);
}

template <typename Archive, Is<SharedStretch> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [begin, end, foe_begin, foe_end] = value;
  archive(begin, end, foe_begin, foe_end);
}

/// No list can be checked against the members of a class and its base: the size has to do.
template <typename Archive, Is<ConflictZone> Value>
void visit_members(Archive& archive, Value& value) {
  struct Counterpart : SharedStretch {
    ConnectionId foe;
    bool yields, foe_yields, unruled, foe_is_crossing;
    std::optional<SharedStretch> of_narrow;
  };
  static_assert(sizeof(ConflictZone) == sizeof(Counterpart), "list the new member, too");
  visit_members(
      archive,
      static_cast<std::conditional_t<std::is_const_v<Value>, const SharedStretch, SharedStretch>&>(
          value));
  archive(value.foe, value.yields, value.foe_yields, value.unruled, value.foe_is_crossing,
          value.of_narrow);
}

template <typename Archive, Is<SweptWay> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [foe, begin, end, foe_begin, foe_end, body, foe_sweeps, for_wide] = value;
  archive(foe, begin, end, foe_begin, foe_end, body, foe_sweeps, for_wide);
}

template <typename Archive, Is<Lane> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [name, edge, index, layer, kind, allowed, speed_limit, width, length, centerline, elevation,
         outline, beside_left, beside_right, inner, outer, opposite, has_overpass, junction,
         outgoing, incoming, crossings] = value;
  archive(name, edge, index, layer, kind, allowed, speed_limit, width, length, centerline,
          elevation, outline, beside_left, beside_right, inner, outer, opposite, has_overpass,
          junction, outgoing, incoming, crossings);
}

template <typename Archive, Is<Edge> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [name, kind, from, to, priority, type, lanes, crossing_edges] = value;
  archive(name, kind, from, to, priority, type, lanes, crossing_edges);
}

template <typename Archive, Is<RightOfWay> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [yields_to, conflicts, may_stop_inside] = value;
  archive(yields_to, conflicts, may_stop_inside);
}

template <typename Archive, Is<Junction> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [name, type, position, outline, requests, links, in_roundabout, neighbours] = value;
  archive(name, type, position, outline, requests, links, in_roundabout, neighbours);
}

template <typename Archive, Is<SignalPhase> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [duration, state] = value;
  archive(duration, state);
}

template <typename Archive, Is<Signal> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [name, size, phases] = value;
  archive(name, size, phases);
}

template <typename Archive, Is<Obstacle> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [kind, outline] = value;
  archive(kind, outline);
}

template <typename Archive, Is<RoadNetwork> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [left_hand, lanes, edges, connections, junctions, signals, obstacles, has_layers,
         overpasses, lower_corner, upper_corner, projection, projection_offset, lane_by_name,
         edge_by_name, junction_by_name, signal_by_name] = value;
  archive(left_hand, lanes, edges, connections, junctions, signals, obstacles, has_layers,
          overpasses, lower_corner, upper_corner, projection, projection_offset);
  archive.names(lanes, lane_by_name);
  archive.names(edges, edge_by_name);
  archive.names(junctions, junction_by_name);
  archive.names(signals, signal_by_name);
}

template <typename Archive, Is<Road> Value>
void visit_members(Archive& archive, Value& value) {
  auto& [network, conflicts, swept_ways] = value;
  archive(network, conflicts, swept_ways);
}

/// Nothing but its bytes, all of which mean something.
template <typename T>
constexpr bool kIsPlain = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::same_as<T, Vec2>;

template <typename T>
constexpr bool kIsList = false;
template <typename T>
constexpr bool kIsList<std::vector<T>> = true;

class Writer {
 public:
  template <typename... Values>
  void operator()(const Values&... values) {
    (put(values), ...);
  }
  template <typename Items, typename Table>
  void names(const Items&, const Table&) {}  // follow from the items

  std::string take() { return std::move(bytes_); }

 private:
  void append(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  void put_size(std::size_t size) {
    const std::uint64_t count = size;
    append(&count, sizeof count);
  }
  void put(const std::string& text) {
    put_size(text.size());
    bytes_ += text;
  }
  void put(const Polyline& line) { put(line.points()); }
  void put(const std::optional<SharedStretch>& stretch) {
    put(stretch.has_value());
    if (stretch) put(*stretch);
  }
  void put(const std::vector<bool>& bits) {
    put_size(bits.size());
    for (const bool bit : bits) bytes_.push_back(bit ? 1 : 0);
  }
  template <typename T>
  void put(const T& value) {
    if constexpr (kIsPlain<T>) {
      append(&value, sizeof value);
    } else if constexpr (kIsList<T>) {
      put_size(value.size());
      if constexpr (kIsPlain<typename T::value_type>)
        append(value.data(), value.size() * sizeof(typename T::value_type));
      else
        for (const auto& item : value) put(item);
    } else {
      visit_members(*this, value);
    }
  }

  std::string bytes_;
};

/// What is behind the end reads as zero and empty, and ok() tells.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <typename... Values>
  void operator()(Values&... values) {
    (get(values), ...);
  }
  template <typename Items, typename Table>
  void names(const Items& items, Table& table) {
    using Id = typename Table::mapped_type;
    table.reserve(items.size());
    for (std::size_t i = 0; i < items.size(); ++i)
      table.emplace(items[i].name, Id(static_cast<std::underlying_type_t<Id>>(i)));
  }

  bool ok() const { return ok_ && bytes_.empty(); }

 private:
  bool copy(void* to, std::size_t size) {
    if (size > bytes_.size()) {
      ok_ = false;
      bytes_ = {};
      return false;
    }
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
    return true;
  }
  /// Number of items of which each takes `bytes_each` at the least.
  std::size_t get_size(std::size_t bytes_each) {
    std::uint64_t count = 0;
    copy(&count, sizeof count);
    if (count <= bytes_.size() / bytes_each) return count;
    ok_ = false;
    bytes_ = {};
    return 0;
  }
  void get(std::string& text) {
    text.resize(get_size(1));
    copy(text.data(), text.size());
  }
  void get(Polyline& line) {
    std::vector<Vec2> points;
    get(points);
    line = Polyline(points);
  }
  void get(std::optional<SharedStretch>& stretch) {
    bool is_there = false;
    get(is_there);
    if (is_there) get(stretch.emplace());
  }
  void get(std::vector<bool>& bits) {
    bits.resize(get_size(1));
    for (std::size_t i = 0; i < bits.size(); ++i) bits[i] = bytes_[i] != 0;
    bytes_.remove_prefix(bits.size());
  }
  template <typename T>
  void get(T& value) {
    if constexpr (kIsPlain<T>) {
      copy(static_cast<void*>(&value), sizeof value);
    } else if constexpr (kIsList<T>) {
      using Item = typename T::value_type;
      value.resize(get_size(kIsPlain<Item> ? sizeof(Item) : 1));
      if constexpr (kIsPlain<Item>)
        copy(static_cast<void*>(value.data()), value.size() * sizeof(Item));
      else
        for (Item& item : value) get(item);
    } else {
      visit_members(*this, value);
    }
  }

  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace

std::string archive_of(const Road& road) {
  Writer writer;
  writer(road);
  return writer.take();
}

std::optional<Road> road_of(std::string_view bytes) {
  Reader reader(bytes);
  std::optional<Road> road(std::in_place);
  reader(*road);
  if (!reader.ok()) road.reset();
  return road;
}

}  // namespace sumogamma
