#include "realism/sumo_free_run.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <pugixml.hpp>

#include "base/error.h"
#include "base/scratch_folder.h"
#include "base/subprocess.h"
#include "base/units.h"
#include "realism/scene_export.h"
#include "realism/sumo_drivers.h"

namespace sumogamma {

namespace {

std::map<std::uint32_t, std::size_t> rows_of(const RecordedScene& scene) {
  std::map<std::uint32_t, std::size_t> rows;
  for (std::size_t row = 0; row < scene.agents.size(); ++row) rows[scene.agents[row].id] = row;
  return rows;
}

/// The demand. Who is still there at the recording's end drives on.
std::string demand_of(const RecordedScene& scene, const RecordedRoad& road) {
  pugi::xml_document document;
  document.load_string(road_scene_of(scene, road.road.network).routes.c_str());
  const auto rows = rows_of(scene);
  for (pugi::xml_node vehicle : document.first_child().children("vehicle")) {
    const std::size_t row = rows.at(vehicle.attribute("id").as_uint());
    if (scene.agents[row].last() < scene.last) continue;
    vehicle.remove_attribute("arrivalPos");
    vehicle.child("route").attribute("edges").set_value(
        edge_names(road.road.network, road.routes[row].edges).c_str());
  }
  return xml_text(document);
}

std::string driven_by(const std::string& demand, const std::string& method) {
  pugi::xml_document document;
  document.load_string(demand.c_str());
  for (const pugi::xml_node type : document.first_child().children("vType"))
    set_driver(type, method, "normc(1,0.1,0.2,2)");
  return xml_text(document);
}

}  // namespace

SumoFreeRuns::SumoFreeRuns(const RecordedScene& scene, const RecordedRoad& road)
    : scene_(scene), road_(road), demand_(demand_of(scene, road)) {}

FreeRun SumoFreeRuns::drive(const std::string& method, std::uint64_t seed) const {
  const ScratchFolder folder;
  const std::filesystem::path poses = folder.path() / "fcd.xml";
  const int steps = free_steps(scene_);
  ProcessRequest request;
  request.arguments = sumo_arguments(
      road_.file, folder.file("demand.rou.xml", driven_by(demand_, method)), method, seed);
  request.arguments.insert(request.arguments.begin(), find_program("sumo").string());
  request.arguments.insert(request.arguments.end(),
                           {"--fcd-output", poses.string(), "--precision", "3", "--end",
                            fmt::format("{:.1f}", kScoreStep * (steps + 1))});
  const ProcessResult result = run_process(request);
  if (!result.ok())
    throw Error("sumo", describe_end(result, request.time_limit) + ": " + result.errors);
  pugi::xml_document document;
  if (!document.load_file(poses.c_str())) throw Error(poses.string(), "is no XML of SUMO's");
  const auto rows = rows_of(scene_);
  FreeRunNotes notes(scene_);
  std::map<std::size_t, int> seen;  // last step by agent
  for (const pugi::xml_node time : document.first_child().children("timestep")) {
    const int step = static_cast<int>(std::lround(time.attribute("time").as_double() / kScoreStep));
    if (step > steps) break;
    for (const pugi::xml_node vehicle : time.children("vehicle")) {
      const std::size_t row = rows.at(vehicle.attribute("id").as_uint());
      const double heading = heading_from_sumo(vehicle.attribute("angle").as_double());
      const Vec2 front(vehicle.attribute("x").as_double(), vehicle.attribute("y").as_double());
      notes.note(row, scene_.first + step,
                 front - 0.5 * scene_.agents[row].length * direction_of(heading), heading);
      seen[row] = step;
    }
  }
  for (const auto& [row, step] : seen)
    if (step < steps) notes.note_arrival(row);
  return std::move(notes).result();
}

}  // namespace sumogamma
