#include "outputs/fcd_places.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "outputs/sumo_file.h"
#include "outputs/xml_lines.h"

namespace sumogamma {

namespace {

constexpr std::int32_t kWaiting = -2;

}  // namespace

FcdPlaces::FcdPlaces(std::filesystem::path spool) : spool_(std::move(spool)) {
  file_ = std::fopen(spool_.c_str(), "w+b");
  if (file_ == nullptr)
    throw Error(spool_.string(), std::string("can't be written (") + std::strerror(errno) + ")");
}

FcdPlaces::~FcdPlaces() {
  std::fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(spool_, ignored);
}

std::int32_t FcdPlaces::agent_of(std::string_view name, bool is_person) {
  return agents_
      .emplace(std::pair(is_person, std::string(name)), static_cast<std::int32_t>(agents_.size()))
      .first->second;
}

void FcdPlaces::put_step() {
  if (head_.time < 0) return;
  head_.count = static_cast<std::int64_t>(places_.size());
  const bool written =
      std::fwrite(&head_, sizeof head_, 1, file_) == 1 &&
      std::fwrite(places_.data(), sizeof(Place), places_.size(), file_) == places_.size();
  if (!written)
    throw Error(spool_.string(), "can't be written to its end, make room and run again");
  places_.clear();
}

void FcdPlaces::begin_step(std::int64_t time) {
  put_step();
  head_.time = time;
}

void FcdPlaces::add(std::string_view name, bool is_person, LaneId lane, double along) {
  places_.push_back(
      {agent_of(name, is_person), static_cast<std::int32_t>(lane), static_cast<float>(along)});
}

void FcdPlaces::add_waiting(std::string_view name, bool is_person) {
  places_.push_back({agent_of(name, is_person), kWaiting, 0.0F});
}

void FcdPlaces::write(const std::filesystem::path& from, const std::filesystem::path& to,
                      const RoadNetwork& network, int precision) {
  put_step();
  head_.time = -1;
  std::rewind(file_);
  Head next{-1, 0};
  bool more = std::fread(&next, sizeof next, 1, file_) == 1;
  std::vector<Place> places;
  std::map<std::int32_t, Place> now;  // by agent
  const auto go_to = [&](std::int64_t time) {
    now.clear();
    while (more && next.time <= time) {
      places.resize(static_cast<std::size_t>(next.count));
      more = std::fread(places.data(), sizeof(Place), places.size(), file_) == places.size();
      if (more && next.time == time)
        for (const Place& place : places) now.emplace(place.agent, place);
      more = more && std::fread(&next, sizeof next, 1, file_) == 1;
    }
  };
  copy_lines(from, to, [&](XmlLine& line) {
    if (line.element == "timestep") go_to(std::llround(1000.0 * line.number("time")));
    const bool is_person = line.element == "person";
    if (!is_person && line.element != "vehicle") return LineFate::Keep;
    const auto agent = agents_.find({is_person, std::string(line.get("id"))});
    const auto place = agent == agents_.end() ? now.end() : now.find(agent->second);
    if (place == now.end()) return LineFate::Keep;
    if (place->second.lane == kWaiting) return LineFate::Drop;
    if (place->second.lane < 0) return LineFate::Keep;
    const Lane& lane = network.lanes[static_cast<std::size_t>(place->second.lane)];
    line.set("pos", sumo_number(static_cast<double>(place->second.along), precision));
    line.set("lane", lane.name);
    if (is_person) line.set("edge", network.edge(lane.edge).name);
    if (line.has("slope")) {
      const double scale = lane.length > 0.0 ? lane.centerline.length() / lane.length : 1.0;
      const double along = static_cast<double>(place->second.along) * scale;
      const double rise = lane.elevation.empty() || lane.kind == LaneKind::WalkingArea
                              ? 0.0
                              : elevation_at(lane, along + 0.5) - elevation_at(lane, along - 0.5);
      line.set("slope", sumo_number(degrees(std::atan(rise)), precision));
    }
    return LineFate::Rewrite;
  });
}

}  // namespace sumogamma
