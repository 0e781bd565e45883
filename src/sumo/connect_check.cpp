#include "sumo/connect_check.h"

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/number_text.h"
#include "base/subprocess.h"
#include "base/time_text.h"

namespace sumogamma {
namespace {

/// "1.15.0" in "Eclipse SUMO sumo Version 1.15.0" or "SUMO 1.15.0".
std::string version_in(const std::string& text) {
  const std::size_t begin = text.find_first_of("0123456789");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_first_of(" \t\r\n", begin) - begin);
}

/// The command that starts a SUMO for this run.
std::string command_for(const ConnectExpectation& expected) {
  const std::size_t colon = expected.where.rfind(':');
  const std::string port =
      colon == std::string::npos ? "" : " --remote-port " + expected.where.substr(colon + 1);
  return "start it with: sumo -c " + expected.scenario->config.string() + port + " --step-length " +
         number_text(expected.step);
}

/// Names an edge that one of the two networks has alone; empty where both have the same.
std::string network_difference(SumoBackend& backend, const RoadNetwork& network) {
  std::size_t theirs = 0, ours = 0;
  for (const std::string& id : backend.edge_ids()) {
    if (!id.empty() && id.front() == ':') continue;
    ++theirs;
    if (!network.edge_by_name.contains(id)) return "edge '" + id + "' is not in the net file here";
  }
  for (const Edge& edge : network.edges) ours += edge.kind == LaneKind::Normal ? 1 : 0;
  if (theirs == ours) return "";
  return "it has " + std::to_string(theirs) + " edges, the net file here " + std::to_string(ours);
}

}  // namespace

std::string installed_sumo_version() {
  const std::filesystem::path sumo = find_program("sumo");
  if (sumo.empty()) return "";
  ProcessRequest request;
  request.arguments = {sumo.string(), "--version"};
  request.time_limit = 20;
  const ProcessResult result = run_process(request);
  const std::size_t word = result.output.find("Version ");
  return word == std::string::npos ? "" : version_in(result.output.substr(word));
}

void require_same_run(SumoBackend& backend, const ConnectExpectation& expected) {
  const auto refuse = [&](const std::string& what) {
    throw Error(expected.where, what + "; " + command_for(expected));
  };
  const std::string here = installed_sumo_version(), there = version_in(backend.version());
  if (!here.empty() && here != there)
    throw Error(expected.where, "it is SUMO " + there + ", the one here is " + here +
                                    "; start that one, or set SUMO_HOME to the other");
  const std::string step_text = backend.option("step-length");
  const std::optional<double> step = parse_time(step_text);
  if (!step || std::abs(*step - expected.step) > 1e-6)
    refuse("its steps are " + step_text + " s long, this run's are " + number_text(expected.step));
  const std::filesystem::path net = backend.option("net-file");
  if (net.filename() != expected.scenario->network.filename())
    refuse("it runs on the network " + net.string() + ", this scenario's is " +
           expected.scenario->network.string());
  const std::string difference = network_difference(backend, *expected.network);
  if (!difference.empty()) refuse("it runs on another network: " + difference);
  if (expected.begin && std::abs(backend.time() - *expected.begin) > 1e-6)
    refuse("it stands at " + number_text(backend.time()) + " s, this run begins at " +
           number_text(*expected.begin));
}

}  // namespace sumogamma
