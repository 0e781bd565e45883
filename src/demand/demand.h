#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "demand/count_fit.h"
#include "demand/demand_settings.h"
#include "road/public_transport.h"
#include "road/road_network.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// A box of the network [m].
struct TripWindow {
  Vec2 lower = Vec2::Zero(), upper = Vec2::Zero();
};

/// Trips of a type from one edge to another: a row of an origin-destination table.
struct AskedTrips {
  std::string type, from, to;
  double per_hour = 0;
};

/// 40 % cars, 6 % vans, 4 % buses, 5 % trucks, 10 % motorcycles, 12 % bicycles, 23 % pedestrians.
std::vector<DemandShare> default_demand_mix();

inline constexpr double kUsualHeadway = 600.0;  ///< [s]

/// Buses on the lines of a place.
struct AskedTransport {
  PublicTransport transport;
  double headway = kUsualHeadway;  ///< of lines of which the map tells none [s]
  std::optional<double> riders;    ///< an hour; none: as many as suit the buses
};

struct DemandRequest {
  std::string name;               ///< of the place in messages; empty: the network's file
  std::filesystem::path network;  ///< the file that `road` was read from: the router reads it again
  std::filesystem::path
      routes;  ///< to write: vTypes, vehicles with explicit routes, persons with explicit walks
  std::filesystem::path
      work;  ///< an existing folder for the router's files; they are removed again
  std::vector<DemandShare> mix = default_demand_mix();
  std::uint64_t seed = 1;
  long agents = 100;         ///< to be kept alive
  double duration = 3600.0;  ///< [s] for which demand is written
  /// How busy equal parts of the duration are, beside each other; empty: all alike. `agents` are
  /// alive in the busiest.
  std::vector<double> profile;
  /// The part of the map for which `agents` counts; others only come from there or go there.
  std::optional<TripWindow> window;
  std::vector<AskedTrips> trips;  ///< all trips of their types; other types travel as drawn
  std::vector<EdgeCount> counts;  ///< of vehicles, that the others' trips are fitted to
  std::optional<AskedTransport> transport;
  double warm_up = 30.0;  ///< [s] within which the first `agents` depart, spread over the network
  double min_distance = 150.0;  ///< [m] of a trip, where the map allows
  double slowness = 1.3;        ///< mean trip duration over that of the empty road
  std::function<bool()> should_stop;

  /// Does anything but the shares say how many of a type there are?
  bool asks_for_more() const { return window || !trips.empty() || !counts.empty(); }
};

/// What came of one type.
struct DemandByType {
  std::string type;
  double share = 0;          ///< of the agents alive, after types that cannot travel were left out
  long trips_drawn = 0;      ///< origin-destination pairs given to the router
  long trips_routable = 0;   ///< that it could route
  long departures = 0;       ///< written
  double mean_length = 0;    ///< [m]
  double mean_duration = 0;  ///< [s], with `slowness`
  std::string problem;       ///< why it cannot travel here, else empty
};

/// What came of public transport.
struct TransportDemand {
  long parts = 0;       ///< of lines, with buses
  long buses = 0;       ///< departures
  long initial = 0;     ///< of these, on the way at the begin
  long riders = 0;      ///< departures
  double alive = 0;     ///< buses at once
  std::string problem;  ///< why there are no buses, or no riders
  std::vector<std::pair<std::string, std::string>> left_out;  ///< part of a line, why
};

struct DemandReport {
  std::vector<DemandByType> types;
  double agents = 0;             ///< alive in the busiest part, on all of the map
  std::vector<CountFit> counts;  ///< what the trips make of them
  TransportDemand transport;
  long unroutable = 0;       ///< rows of `trips` that have no way
  double on_foot = 0;        ///< share of people on foot among the agents alive
  std::string busiest_lane;  ///< the one asked for most of what it carries; empty: none is
  double busiest_load = 0;   ///< what it is asked for, by what it carries
  long departures = 0;
  long initial = 0;      ///< of these, in the warm-up, started in the middle of their trips
  bool stopped = false;  ///< should_stop ended it; nothing was written
  std::string router;    ///< its messages, for the log
};

/// How busy it is at a time, the busiest part being 1.
double activity_at(const DemandRequest& request, double time);

/// Draws trips, has SUMO's duarouter route them, and writes demand that keeps `agents` alive: first
/// `agents` departures on the way (so that the mix of trip ages is that of a running city, not a
/// wave that ends all at once), then each type at agents * share / mean duration (Little's law).
/// Trips run between the edges of the network's rim where it has one, are drawn by edge length, are
/// at least min_distance long (less where no such trip exists), and stay on one edge only where
/// that stands alone or a type has no other trips. How often each is driven weigh_trips() decides,
/// so that no lane is asked for more than it carries, where it can. `transport` adds the buses of
/// lines and their riders. Deterministic in the seed. A type that no edge lets travel is left out
/// and reported, its share going to the others. Throws Error where nothing at all can travel, where
/// `trips` or `counts` name what isn't there, where the router is missing or fails, or where
/// writing fails.
DemandReport generate_demand(const RoadNetwork& road, const AgentTypeTable& types,
                             const DemandRequest& request);

}  // namespace sumogamma
