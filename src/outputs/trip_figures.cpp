#include "outputs/trip_figures.h"

#include <algorithm>
#include <cmath>

#include "outputs/sumo_file.h"
#include "outputs/xml_lines.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

/// Times in a file, that SUMO gives as -1 where there is none yet.
bool is_time(const XmlLine& line, std::string_view name) { return line.number(name, -1.0) >= 0.0; }

class TripinfoWriter {
 public:
  TripinfoWriter(const RoadNetwork& network, const Trips& trips, int precision)
      : network_(network), trips_(trips), precision_(precision) {}

  LineFate change(XmlLine& line) {
    if (line.element == "tripinfo") return change_trip(line);
    if (line.element == "ride") return change_ride(line);
    // a walk that GAMMA ends leaves this behind in SUMO
    if (line.element == "stop" && line.get("actType") == "last stage removed")
      return LineFate::Drop;
    return LineFate::Keep;
  }

 private:
  void set_time(XmlLine& line, std::string_view name, double value) const {
    line.set(name, sumo_time(value, precision_));
  }
  void set_number(XmlLine& line, std::string_view name, double value) const {
    line.set(name, sumo_number(value, precision_));
  }

  LineFate change_trip(XmlLine& line) const {
    const auto found = trips_.find(line.get("id"));
    if (found == trips_.end() || !found->second.driven) return LineFate::Keep;
    const TripFigures& trip = found->second;
    if (!trip.entered) return LineFate::Drop;
    if (is_time(line, "depart")) set_time(line, "depart", line.number("depart") + trip.waited);
    set_time(line, "departDelay", line.number("departDelay") + trip.waited);
    line.set("departLane", network_.lane(trip.first.lane).name);
    set_number(line, "departPos", std::max(0.0, trip.first.front));
    set_number(line, "departSpeed", trip.first.speed);
    if (trip.arrived) {
      const Lane& lane = network_.lane(trip.last.lane);
      line.set("arrivalLane", lane.name);
      set_number(line, "arrivalPos", std::min(trip.last.front, lane.length));
      set_number(line, "arrivalSpeed", trip.last.speed);
      line.set("vaporized", "");
    }
    set_time(line, "duration", std::max(0.0, line.number("duration") - trip.waited));
    set_number(line, "routeLength", trip.odometer.distance);
    set_time(line, "waitingTime", trip.odometer.waiting_time);
    line.set("waitingCount", std::to_string(trip.odometer.waiting_count));
    // stopTime is right: SUMO serves the stops
    set_time(line, "timeLoss", trip.odometer.time_loss);
    return LineFate::Rewrite;
  }

  LineFate change_ride(XmlLine& line) const {
    const auto found = trips_.find(line.get("vehicle"));
    if (found == trips_.end() || !found->second.driven || !is_time(line, "depart"))
      return LineFate::Keep;
    const TripFigures& trip = found->second;
    const auto at = [&](double time) {
      constexpr double kTolerance = 1.0;  // between SUMO's look at a stop and ours [s]
      TripFigures::Halt last{0, 0, 0};
      for (const TripFigures::Halt& halt : trip.halts)
        if (halt.time <= time + kTolerance) last = halt;
      return last;
    };
    const TripFigures::Halt from = at(line.number("depart"));
    TripFigures::Halt to{0, trip.odometer.distance, trip.odometer.time_loss};
    // else it rides still, or to the end
    if (is_time(line, "arrival") && at(line.number("arrival")).time > from.time)
      to = at(line.number("arrival"));
    set_number(line, "routeLength", to.distance - from.distance);
    if (line.has("timeLoss")) set_time(line, "timeLoss", to.time_loss - from.time_loss);
    return LineFate::Rewrite;
  }

  const RoadNetwork& network_;
  const Trips& trips_;
  int precision_;
};

/// Sums over the trips of a kind.
struct TripSums {
  double number = 0, way = 0, speed = 0, duration = 0, waiting = 0, time_loss = 0, delay = 0;

  void add(const XmlLine& line) {
    number += 1.0;
    way += line.number("routeLength");
    duration += line.number("duration");
    if (line.number("duration") > 0.0)
      speed += line.number("routeLength") / line.number("duration");
    waiting += line.number("waitingTime");
    time_loss += line.number("timeLoss");
    delay += line.number("departDelay");
  }
};

struct AllSums {
  TripSums vehicles, bicycles;
  double rides = 0, ride_way = 0;
};

AllSums sums_of(const fs::path& tripinfo, const Trips& trips) {
  AllSums sums;
  visit_lines(tripinfo, [&](const XmlLine& line) {
    if (line.element == "tripinfo" && is_time(line, "depart")) {
      const auto trip = trips.find(line.get("id"));
      const bool bicycle = trip != trips.end() && trip->second.bicycle;
      (bicycle ? sums.bicycles : sums.vehicles).add(line);
    } else if (line.element == "ride" && is_time(line, "arrival")) {
      sums.rides += 1.0;
      sums.ride_way += line.number("routeLength");
    }
  });
  return sums;
}

void set_means(const TripSums& sums, int precision, XmlLine& line) {
  const double number = std::max(sums.number, 1.0);
  line.set("count", std::to_string(std::lround(sums.number)));
  line.set("routeLength", sumo_number(sums.way / number, precision));
  line.set("speed", sumo_number(sums.speed / number, precision));
  line.set("duration", sumo_number(sums.duration / number, precision));
  line.set("waitingTime", sumo_number(sums.waiting / number, precision));
  line.set("timeLoss", sumo_number(sums.time_loss / number, precision));
  line.set("totalTravelTime", sumo_time(sums.duration, precision));
}

const SummaryFigures* figures_at(const SummaryByTime& summary, const XmlLine& line) {
  if (line.element != "step") return nullptr;
  const auto found = summary.find(std::llround(1000.0 * line.number("time")));
  return found == summary.end() ? nullptr : &found->second;
}

}  // namespace

void write_tripinfo(const fs::path& from, const fs::path& to, const RoadNetwork& network,
                    const Trips& trips, int precision) {
  TripinfoWriter writer(network, trips, precision);
  copy_lines(from, to, [&](XmlLine& line) { return writer.change(line); });
}

void write_statistics(const fs::path& from, const fs::path& to, const fs::path& tripinfo,
                      const Trips& trips, int precision) {
  const AllSums sums = sums_of(tripinfo, trips);
  double waited = 0.0;
  for (const auto& [name, trip] : trips)
    if (trip.entered) waited += trip.waited;
  copy_lines(from, to, [&](XmlLine& line) {
    if (line.element == "vehicleTripStatistics") {
      set_means(sums.vehicles, precision, line);
      const double delay = sums.vehicles.delay + sums.bicycles.delay;
      line.set("departDelay", sumo_number(delay / std::max(sums.vehicles.number, 1.0), precision));
      line.set("totalDepartDelay", sumo_time(line.number("totalDepartDelay") + waited, precision));
    } else if (line.element == "bikeTripStatistics") {
      set_means(sums.bicycles, precision, line);
    } else if (line.element == "rideStatistics" && sums.rides > 0.0) {
      line.set("routeLength", sumo_number(sums.ride_way / sums.rides, precision));
    } else {
      return LineFate::Keep;
    }
    return LineFate::Rewrite;
  });
}

void write_summary(const fs::path& from, const fs::path& to, const SummaryByTime& summary,
                   int precision) {
  copy_lines(from, to, [&](XmlLine& line) {
    const SummaryFigures* now = figures_at(summary, line);
    if (now == nullptr || !now->driven) return LineFate::Keep;
    const auto add = [&](std::string_view name, std::int64_t more) {
      line.set(name, std::to_string(std::lround(line.number(name)) + more));
    };
    const double before = line.number("inserted");
    add("inserted", -now->waiting);
    add("running", -now->waiting);
    add("waiting", now->waiting);
    line.set("halting", std::to_string(now->halting));
    if (line.number("inserted") > 0.0 && is_time(line, "meanWaitingTime"))
      line.set("meanWaitingTime",
               sumo_number((line.number("meanWaitingTime") * before + now->waited) /
                               line.number("inserted"),
                           precision));
    if (line.number("ended") > 0.0 && is_time(line, "meanTravelTime"))
      line.set("meanTravelTime", sumo_number(line.number("meanTravelTime") -
                                                 now->waited_arrived / line.number("ended"),
                                             precision));
    line.set("meanSpeed", sumo_number(now->speed, precision));
    line.set("meanSpeedRelative", sumo_number(now->relative_speed, precision));
    return LineFate::Rewrite;
  });
}

void write_person_summary(const fs::path& from, const fs::path& to, const SummaryByTime& summary) {
  copy_lines(from, to, [&](XmlLine& line) {
    const SummaryFigures* now = figures_at(summary, line);
    if (now == nullptr || !now->walked) return LineFate::Keep;
    // SUMO counts a walk anew whenever a person is moved, and takes it off who rides
    const long both = std::lround(line.number("walking") + line.number("riding"));
    const long riding = std::min(static_cast<long>(now->riding), std::max(both, 0L));
    line.set("riding", std::to_string(riding));
    line.set("walking", std::to_string(both - riding));
    return LineFate::Rewrite;
  });
}

}  // namespace sumogamma
