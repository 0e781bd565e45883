#include <memory>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "app/demand_setup.h"
#include "base/error.h"
#include "base/print.h"
#include "base/staged_folder.h"
#include "io/config.h"
#include "io/output_file.h"
#include "io/public_transport_file.h"
#include "io/scenario_files.h"
#include "road/sumo_net_reader.h"

namespace sumogamma {
namespace {

/// The lines and stops that the import found; none where the map has none.
PublicTransport lines_of(const std::filesystem::path& folder, const RoadNetwork& road) {
  const std::filesystem::path file = folder / kPublicTransportFile;
  return std::filesystem::exists(file) ? read_public_transport(file, road) : PublicTransport{};
}

/// Draws the demand of an imported scenario anew, as its [demand] asks.
int draw_demand(const std::filesystem::path& folder, const CommonOptions& common) {
  for (const char* const file : {"scenario.toml", "scenario.sumocfg", "net.net.xml", "import.json"})
    if (!std::filesystem::exists(folder / file))
      throw Error(folder.string(), std::string("has no ") + file +
                                       ": expected a folder made by 'sumo-gamma import'");
  const ScenarioConfig config = read_config(folder / "scenario.toml", common.set);
  DemandRequest request = request_of(config.demand, folder, config.types);
  if (config.demand.agents == 0) request.agents = config.agents;
  request.duration = config.duration;
  request.seed = common.seed;
  request.should_stop = interrupted;
  request.network = folder / "net.net.xml";
  const RoadNetwork road = read_sumo_net(request.network);
  if (!config.demand.window.empty()) request.window = window_on(road, config.demand.window);

  if (config.demand.public_transport)
    request.transport = transport_of(config.demand, lines_of(folder, road));

  StagedFolder staged(folder.string(), true);
  request.routes = staged.path() / "demand.rou.xml";
  request.work = staged.path() / "work";
  std::filesystem::create_directory(request.work);
  if (!common.quiet) print(stderr, "demand: drawing and routing (duarouter)\n");
  const DemandReport report = generate_demand(road, config.types, request);
  if (report.stopped || interrupted()) return kExitInterrupted;
  std::filesystem::remove_all(request.work);

  auto imported = nlohmann::ordered_json::parse(read_file(folder / "import.json"), nullptr, false);
  if (!imported.is_object()) throw Error((folder / "import.json").string(), "is no JSON object");
  imported["demand"] = demand_report(report, request);
  write_file(staged.path() / "import.json", imported.dump(2) + "\n");
  const long alive = agents_alive(request, report);
  write_file(staged.path() / "scenario.toml",
             with_agents_alive(read_file(folder / "scenario.toml"), alive, report.on_foot));
  const std::string sumocfg = read_file(folder / "scenario.sumocfg");
  write_file(
      staged.path() / "scenario.sumocfg",
      with_stops(sumocfg, report.transport.buses > 0, (folder / "scenario.sumocfg").string()));
  staged.commit();
  print(common.out, "{}: {} departures, {} agents alive\n", folder.string(), report.departures,
        alive);
  print_demand(common.out, report);
  return kExitDone;
}

}  // namespace

CommandRunner add_demand_command(CLI::App& parent) {
  CLI::App* command = parent.add_subcommand(
      "demand",
      "draw the demand of an imported scenario anew, as [demand] of its scenario.toml asks");
  auto folder = std::make_shared<std::string>();
  command->add_option("SCENARIO", *folder, "folder made by 'sumo-gamma import'")->required();
  return [folder](const CommonOptions& common) { return draw_demand(*folder, common); };
}

}  // namespace sumogamma
