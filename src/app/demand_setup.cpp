#include "app/demand_setup.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/print.h"
#include "io/demand_files.h"
#include "osm/geo_projection.h"

namespace sumogamma {

namespace {

void check_profile(const std::vector<double>& profile) {
  if (profile.empty() || *std::max_element(profile.begin(), profile.end()) > 0) return;
  throw Error("[demand] profile", "must have a part above 0: at 0 nobody departs");
}

void check_window(const std::vector<double>& window) {
  if (window.empty()) return;
  if (window.size() == 4 && window[0] < window[2] && window[1] < window[3]) return;
  throw Error("[demand] window", "must be W, S, E, N in degrees with west < east, south < north");
}

void check_transport(const DemandSettings& settings) {
  if (settings.public_transport) return;
  for (const auto& [key, given] :
       {std::pair("headway", settings.headway > 0), std::pair("riders", settings.riders >= 0)})
    if (given)
      throw Error(std::string("[demand] ") + key,
                  "is of lines of public transport: needs public_transport = true");
}

}  // namespace

AskedTransport transport_of(const DemandSettings& settings, PublicTransport transport) {
  AskedTransport asked{std::move(transport), kUsualHeadway, std::nullopt};
  if (settings.headway > 0) asked.headway = settings.headway;
  if (settings.riders >= 0) asked.riders = settings.riders;
  return asked;
}

DemandRequest request_of(const DemandSettings& settings, const std::filesystem::path& base,
                         const AgentTypeTable& types) {
  check_profile(settings.profile);
  check_window(settings.window);
  DemandRequest request;
  std::vector<DemandShare> shares = settings.shares;
  std::erase_if(shares, [](const DemandShare& share) { return !(share.share > 0); });
  const bool shares_are_usual = shares.empty();
  if (!shares.empty()) request.mix = std::move(shares);
  check_transport(settings);
  // the drawn buses stand for lines that aren't there
  if (settings.public_transport && shares_are_usual)
    std::erase_if(request.mix, [](const DemandShare& share) { return share.type == "bus"; });
  if (settings.agents > 0) request.agents = settings.agents;
  request.profile = settings.profile;
  if (!settings.od.empty()) request.trips = read_od_table(base / settings.od, types);
  if (!settings.counts.empty()) request.counts = read_counts(base / settings.counts);
  return request;
}

TripWindow window_on(const RoadNetwork& road, const std::vector<double>& degrees) {
  if (road.projection.empty() || road.projection == "!")
    throw Error("[demand] window", "needs a network with a geographic projection");
  const osm::GeoProjection projection(road.projection);
  const auto place = [&](double longitude, double latitude) {
    return Vec2(projection.to_plane({longitude, latitude}) + road.projection_offset);
  };
  TripWindow window{place(degrees[0], degrees[1]), place(degrees[2], degrees[3])};
  const bool overlaps = (window.lower.array() < road.upper_corner.array()).all() &&
                        (window.upper.array() > road.lower_corner.array()).all();
  if (!overlaps) throw Error("[demand] window", "lies outside of the network");
  return window;
}

long agents_alive(const DemandRequest& request, const DemandReport& report) {
  return request.asks_for_more() || request.transport
             ? std::max(1L, std::lround(std::ceil(report.agents)))
             : request.agents;
}

namespace {

void print_transport(std::FILE* out, const TransportDemand& transport) {
  if (!transport.problem.empty())
    print(out, "  warning: public transport: {}\n", transport.problem);
  if (transport.buses > 0)
    print(out, "  {:<12} {:5} departures on {} parts of lines, {:.1f} alive; {} riders\n",
          "line buses", transport.buses, transport.parts, transport.alive, transport.riders);
  for (const auto& [part, why] : transport.left_out)
    print(out, "  line {} left out: {}\n", part, why);
}

}  // namespace

void print_demand(std::FILE* out, const DemandReport& report) {
  for (const DemandByType& type : report.types) {
    if (type.problem.empty())
      print(out, "  {:<12} {:5} departures, mean trip {:.0f} m, {:.0f} s\n", type.type,
            type.departures, type.mean_length, type.mean_duration);
    else
      print(out, "  {:<12} left out: {}\n", type.type, type.problem);
  }
  print_transport(out, report.transport);
  if (report.busiest_load > 1)
    print(out,
          "  warning: so many agents are more than these roads carry: {:.1f} times as many as lane "
          "{} "
          "lets out; expect queues, ask for fewer agents or import more of the city\n",
          report.busiest_load, report.busiest_lane);
  if (report.unroutable > 0)
    print(out, "  warning: {} rows of the origin-destination table have no way\n",
          report.unroutable);
  if (report.counts.empty()) return;
  constexpr double kWell = 5;  // GEH
  long well = 0;
  for (const CountFit& fit : report.counts) {
    well += fit.geh < kWell ? 1 : 0;
    if (fit.geh >= kWell)
      print(out, "  warning: {}{}: {:.0f} an hour counted, the trips make {:.0f} (GEH {:.1f})\n",
            fit.count.edge, fit.count.to.empty() ? "" : " -> " + fit.count.to, fit.count.per_hour,
            fit.per_hour, fit.geh);
  }
  print(out, "  counts: {} of {} met with a GEH under 5 by the trips\n", well,
        report.counts.size());
}

}  // namespace sumogamma
