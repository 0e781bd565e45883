#include "realism/sumo_free_run.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "base/error.h"
#include "base/scratch_folder.h"
#include "base/subprocess.h"
#include "base/units.h"
#include "realism/scene_export.h"
#include "realism/sumo_loop.h"

namespace sumogamma {

namespace {

std::map<std::uint32_t, std::size_t> rows_of(const RecordedScene& scene) {
  std::map<std::uint32_t, std::size_t> rows;
  for (std::size_t row = 0; row < scene.agents.size(); ++row) rows[scene.agents[row].id] = row;
  return rows;
}

/// The demand, with a method's model. Who is still there at the recording's end drives on.
std::string demand_of(const RecordedScene& scene, const RecordedRoad& road,
                      const std::string& method) {
  pugi::xml_document document;
  document.load_string(road_scene_of(scene, road.road.network).routes.c_str());
  const auto rows = rows_of(scene);
  for (pugi::xml_node type : document.first_child().children("vType")) {
    type.remove_attribute("minGap");
    type.attribute("speedFactor").set_value("normc(1,0.1,0.2,2)");
    type.append_attribute("carFollowModel") = car_following_of(method);
  }
  for (pugi::xml_node vehicle : document.first_child().children("vehicle")) {
    const std::size_t row = rows.at(vehicle.attribute("id").as_uint());
    if (scene.agents[row].last() < scene.last) continue;
    vehicle.remove_attribute("arrivalPos");
    std::string edges;
    for (const EdgeId edge : road.routes[row].edges)
      edges += (edges.empty() ? "" : " ") + road.road.network.edge(edge).name;
    vehicle.child("route").attribute("edges").set_value(edges.c_str());
  }
  std::ostringstream text;
  document.save(text);
  return text.str();
}

}  // namespace

FreeRun drive_sumo_freely(const RecordedScene& scene, const RecordedRoad& road,
                          const std::string& method, std::uint64_t seed) {
  const ScratchFolder folder;
  const std::filesystem::path poses = folder.path() / "fcd.xml";
  const int steps = free_steps(scene);
  ProcessRequest request;
  request.arguments = {find_program("sumo").string(),
                       "-n",
                       std::filesystem::absolute(road.file).string(),
                       "-r",
                       folder.file("demand.rou.xml", demand_of(scene, road, method)).string(),
                       "--fcd-output",
                       poses.string(),
                       "--precision",
                       "3",
                       "--end",
                       fmt::format("{:.1f}", kScoreStep * (steps + 1)),
                       "--step-length",
                       fmt::format("{:.1f}", kScoreStep),
                       "--seed",
                       std::to_string(seed % 2147483647u),
                       "--no-step-log",
                       "--no-warnings",
                       "--time-to-teleport",
                       "-1",
                       "--collision.action",
                       "none"};
  if (method == "sumo-sublane")
    request.arguments.insert(request.arguments.end(), {"--lateral-resolution", "0.64"});
  const ProcessResult result = run_process(request);
  if (!result.ok())
    throw Error("sumo", describe_end(result, request.time_limit) + ": " + result.errors);
  pugi::xml_document document;
  if (!document.load_file(poses.c_str())) throw Error(poses.string(), "is no XML of SUMO's");
  const auto rows = rows_of(scene);
  FreeRunNotes notes(scene);
  std::map<std::size_t, int> seen;  // last step by agent
  for (const pugi::xml_node time : document.first_child().children("timestep")) {
    const int step = static_cast<int>(std::lround(time.attribute("time").as_double() / kScoreStep));
    if (step > steps) break;
    for (const pugi::xml_node vehicle : time.children("vehicle")) {
      const std::size_t row = rows.at(vehicle.attribute("id").as_uint());
      const double heading = heading_from_sumo(vehicle.attribute("angle").as_double());
      const Vec2 front(vehicle.attribute("x").as_double(), vehicle.attribute("y").as_double());
      notes.note(row, scene.first + step,
                 front - 0.5 * scene.agents[row].length * direction_of(heading), heading);
      seen[row] = step;
    }
  }
  for (const auto& [row, step] : seen)
    if (step < steps) notes.note_arrival(row);
  return std::move(notes).result();
}

}  // namespace sumogamma
