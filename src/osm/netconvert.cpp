#include "osm/netconvert.h"

#include <cstdlib>
#include <fstream>
#include <pugixml.hpp>
#include <regex>
#include <sstream>

#include "base/error.h"
#include "base/subprocess.h"

namespace sumogamma::osm {
namespace {

/// The lines that say why: errors, else the last words.
std::string reason_of(const ProcessResult& result) {
  std::istringstream lines(result.errors + "\n" + result.output);
  std::string line, errors, last;
  while (std::getline(lines, line)) {
    if (line.empty() || line == "Quitting (on error).") continue;
    last = line;
    if (line.starts_with("Error:") && errors.size() < 400)
      errors += (errors.empty() ? "" : "; ") + line.substr(7);
  }
  return errors.empty() ? last : errors;
}

std::vector<std::string> run(const NetconvertRequest& request, std::vector<std::string> arguments) {
  const std::filesystem::path program = find_program("netconvert");
  if (program.empty())
    throw Error("netconvert",
                "not found in $SUMO_HOME/bin or PATH: install SUMO (apt install sumo sumo-tools)");
  arguments.insert(arguments.begin(), program.string());
  ProcessRequest process;
  process.arguments = arguments;
  process.environment = {{"SUMO_HOME", sumo_home().string()}};
  process.time_limit = request.time_limit;
  process.should_stop = request.should_stop;
  const ProcessResult result = run_process(process);

  std::ofstream log(request.log, std::ios::app | std::ios::binary);
  log << result.output << result.errors;
  log.close();
  if (result.stopped) return {};
  if (!log) throw Error(request.log.string(), "cannot be written: is the disk full?");
  if (!result.ok() || !std::filesystem::exists(request.network)) {
    const std::string reason = reason_of(result);
    throw Error("netconvert",
                describe_end(result, request.time_limit) + (reason.empty() ? "" : ": " + reason));
  }
  return arguments;
}

}  // namespace

std::filesystem::path sumo_home() {
  const char* set = std::getenv("SUMO_HOME");
  for (const std::filesystem::path& home :
       {std::filesystem::path(set ? set : ""), std::filesystem::path("/usr/share/sumo")})
    if (!home.empty() && std::filesystem::exists(home / "data/typemap/osmNetconvert.typ.xml"))
      return home;
  throw Error(set ? std::string("SUMO_HOME=") + set : "SUMO_HOME",
              "holds no data/typemap: install sumo, or set SUMO_HOME to its folder");
}

std::vector<std::string> run_netconvert(const NetconvertRequest& request) {
  const std::string typemap = (sumo_home() / "data/typemap").string() + "/";
  std::vector<std::string> arguments = {
      "--xml-validation",
      "never",
      "--osm-files",
      request.prepared.string(),
      "-o",
      request.network.string(),
      "-t",
      typemap + "osmNetconvert.typ.xml," + typemap + "osmNetconvertUrbanDe.typ.xml," + typemap +
          "osmNetconvertPedestrians.typ.xml," + typemap + "osmNetconvertBicycle.typ.xml",
      "--proj",
      request.projection,
      "--offset.disable-normalization",
      "--geometry.remove",
      "--roundabouts.guess",
      "--ramps.guess",
      "--junctions.join",
      "--junctions.corner-detail",
      "5",
      "--junctions.internal-link-detail",
      "8",
      "--tls.guess-signals",
      "--tls.discard-simple",
      "--tls.default-type",
      "static",
      "--walkingareas",
      "--crossings.guess",
      "--osm.bike-access",
      "--osm.lane-access",
      "--osm.turn-lanes",
      "--no-turnarounds.except-deadend",
      "--opposites.guess",
      "--opposites.guess.fix-lengths",
      "--output.street-names",
      "--output.original-names",
      "--osm.all-attributes",
      "--osm.extra-attributes",
      "surface,layer,bridge,tunnel,lit,maxspeed,sidewalk,footway,crossing,access,width,junction"};
  if (request.left_hand) arguments.push_back("--lefthand");
  if (request.layers) arguments.insert(arguments.end(), {"--osm.layer-elevation", "5"});
  return run(request, std::move(arguments));
}

std::vector<std::string> mark_roundabouts(const NetconvertRequest& request,
                                          const std::vector<std::vector<std::string>>& rings) {
  pugi::xml_document network;
  if (!network.load_file(request.network.c_str()))
    throw Error(request.network.string(), "not a network");
  std::map<std::string, std::string> start;
  for (const pugi::xml_node edge : network.child("net").children("edge"))
    start[edge.attribute("id").value()] = edge.attribute("from").value();

  pugi::xml_document patch;
  pugi::xml_node edges = patch.append_child("edges");
  for (const auto& ring : rings) {
    std::string nodes, names;
    for (const std::string& edge : ring) {
      nodes += (nodes.empty() ? "" : " ") + start[edge];
      names += (names.empty() ? "" : " ") + edge;
    }
    pugi::xml_node roundabout = edges.append_child("roundabout");
    roundabout.append_attribute("nodes") = nodes.c_str();
    roundabout.append_attribute("edges") = names.c_str();
  }
  const std::filesystem::path patch_file = request.network.string() + ".roundabouts.edg.xml";
  const std::filesystem::path unpatched = request.network.string() + ".unpatched.net.xml";
  if (!patch.save_file(patch_file.c_str()))
    throw Error(patch_file.string(), "cannot be written: is the disk full?");
  std::filesystem::rename(request.network, unpatched);
  std::vector<std::string> arguments = {"--xml-validation",
                                        "never",
                                        "-s",
                                        unpatched.string(),
                                        "-e",
                                        patch_file.string(),
                                        "-o",
                                        request.network.string(),
                                        "--offset.disable-normalization",
                                        "--junctions.corner-detail",
                                        "5",
                                        "--junctions.internal-link-detail",
                                        "8",
                                        "--no-turnarounds.except-deadend",
                                        "--output.street-names",
                                        "--output.original-names"};
  if (request.left_hand) arguments.push_back("--lefthand");
  std::vector<std::string> command = run(request, std::move(arguments));
  std::filesystem::remove(patch_file);
  std::filesystem::remove(unpatched);
  return command;
}

std::map<std::string, long> count_message_kinds(const std::string& log_text) {
  static const std::regex quoted("'[^']*'"), number("[-:]?[0-9]+([.,#_][0-9#]+)*");
  std::map<std::string, long> kinds;
  std::istringstream lines(log_text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("Warning: ") && !line.starts_with("Error: ")) continue;
    line = std::regex_replace(line, quoted, "'*'");
    line = std::regex_replace(line, number, "N");
    ++kinds[line.substr(0, 160)];
  }
  return kinds;
}

}  // namespace sumogamma::osm
