#include "osm/netconvert.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "base/error.h"
#include "base/subprocess.h"
#include "osm/network_file.h"

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

/// Takes out netconvert's comment with the time of day, so that equal input gives equal bytes, and
/// makes sure that the file is whole: netconvert does not notice a full disk.
void strip_header(const std::filesystem::path& network) {
  std::ifstream stream(network, std::ios::binary);
  std::ostringstream whole;
  whole << stream.rdbuf();
  std::string text = whole.str();
  if (text.find("</net>", text.size() - std::min<std::size_t>(text.size(), 64)) ==
      std::string::npos)
    throw Error(network.string(), "was written in part only: is the disk full?");
  const std::size_t begin = text.find("<!-- generated on"), end = text.find("-->", begin);
  if (begin != std::string::npos && end != std::string::npos) text.erase(begin, end + 3 - begin);
  std::ofstream out(network, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Error(network.string(), "cannot be written: is the disk full?");
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
  process.folder = request.folder;
  process.time_limit = request.time_limit;
  process.should_stop = request.should_stop;
  const ProcessResult result = run_process(process);

  const std::filesystem::path log_file = request.folder / request.log,
                              network = request.folder / request.network;
  std::ofstream log(log_file, std::ios::app | std::ios::binary);
  log << result.output << result.errors;
  log.close();
  if (result.stopped) return {};
  if (!result.ok() || !std::filesystem::exists(network)) {
    const std::string reason = reason_of(result);
    throw Error("netconvert",
                describe_end(result, request.time_limit) + (reason.empty() ? "" : ": " + reason));
  }
  if (!log) throw Error(log_file.string(), "cannot be written: is the disk full?");
  strip_header(network);
  return arguments;
}

/// Places of junctions [m], each as often as it has nodes, and how many nodes that is.
struct Places {
  double x = 0, y = 0, z = 0, nodes = 0;
};

/// The junctions of a network, each by one of the nodes that it was made of.
std::map<std::string, Places> places_by_node(const pugi::xml_node& network) {
  std::map<std::string, Places> places;
  for (const pugi::xml_node junction : network.children("junction")) {
    const NodeGroup made_of = nodes_of(junction.attribute("id").value());
    if (made_of.empty()) continue;
    const auto nodes = static_cast<double>(made_of.size());
    places[*made_of.begin()] = {nodes * junction.attribute("x").as_double(),
                                nodes * junction.attribute("y").as_double(),
                                nodes * junction.attribute("z").as_double(), nodes};
  }
  return places;
}

/// Writes the groups of nodes to join. Where traffic keeps left each of them needs its place, the
/// mean of what the network as it stands makes of it: without one netconvert 1.15 mirrors what
/// stands for none, puts the junction 1e9 m off, and cuts the roads there to fit.
void write_joins(const NetconvertRequest& request, const pugi::xml_node& before,
                 const std::filesystem::path& file) {
  std::map<std::string, Places> places;
  if (request.left_hand) places = places_by_node(before);
  pugi::xml_document document;
  pugi::xml_node nodes = document.append_child("nodes");
  for (const NodeGroup& group : *request.joins) {
    std::string names;
    Places sum;
    for (const std::string& node : group) {
      names += (names.empty() ? "" : " ") + node;
      const auto found = places.find(node);
      if (found == places.end()) continue;
      const Places& place = found->second;
      sum = {sum.x + place.x, sum.y + place.y, sum.z + place.z, sum.nodes + place.nodes};
    }
    pugi::xml_node join = nodes.append_child("join");
    join.append_attribute("nodes") = names.c_str();
    if (sum.nodes == 0) continue;
    join.append_attribute("x") = sum.x / sum.nodes;
    join.append_attribute("y") = sum.y / sum.nodes;
    join.append_attribute("z") = sum.z / sum.nodes;
  }
  save_xml(document, file);
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

std::vector<std::filesystem::path> typemaps() {
  const std::filesystem::path folder = sumo_home() / "data/typemap";
  std::vector<std::filesystem::path> files;
  for (const char* name : {"osmNetconvert", "osmNetconvertUrbanDe", "osmNetconvertPedestrians",
                           "osmNetconvertBicycle"})
    files.push_back(folder / (std::string(name) + ".typ.xml"));
  return files;
}

std::vector<std::string> run_netconvert(const NetconvertRequest& request,
                                        const pugi::xml_node& before) {
  std::string types;
  for (const std::filesystem::path& file : typemaps())
    types += (types.empty() ? "" : ",") + file.string();
  if (!request.road_types.empty()) types += "," + request.road_types;
  std::vector<std::string> arguments = {
      "--xml-validation", "never", "--osm-files", request.prepared, "-o", request.network, "-t",
      types, "--proj", request.projection, "--offset.disable-normalization", "--geometry.remove",
      "--roundabouts.guess", "--ramps.guess", "--junctions.corner-detail", "5",
      "--junctions.internal-link-detail", "8",
      // bodies turn about a rear axle: with SUMO's 4 m no bus and hardly a van gets round a
      // right-angled corner
      "--default.junctions.radius", "7", "--tls.guess-signals", "--tls.discard-simple",
      "--tls.default-type", "static", "--walkingareas", "--crossings.guess", "--osm.bike-access",
      "--osm.lane-access", "--osm.turn-lanes", "--no-turnarounds.except-deadend",
      "--opposites.guess", "--opposites.guess.fix-lengths", "--output.street-names",
      "--output.original-names", "--osm.all-attributes", "--osm.extra-attributes",
      "surface,layer,bridge,tunnel,lit,maxspeed,sidewalk,footway,crossing,access,width,junction"};
  if (request.left_hand) arguments.push_back("--lefthand");
  if (request.layers) arguments.insert(arguments.end(), {"--osm.layer-elevation", "5"});
  if (!request.joins) {
    arguments.insert(arguments.end(),
                     {"--junctions.join", "--junctions.join-output", request.joined});
  } else {
    const std::string joins = "work/join.nod.xml";
    write_joins(request, before, request.folder / joins);
    arguments.insert(arguments.end(), {"--node-files", joins});
  }
  return run(request, std::move(arguments));
}

namespace {

/// New shapes and lane widths, and edges to leave out.
void append_carriageways(const pugi::xml_node& network, const CarriagewayPlan& plan,
                         pugi::xml_node& edges) {
  for (const pugi::xml_node edge : network.children("edge")) {
    const char* id = edge.attribute("id").value();
    if (plan.dropped.contains(id)) {
      edges.append_child("delete").append_attribute("id") = id;
      continue;
    }
    pugi::xml_node patched;
    const auto patch = [&] {
      if (patched) return;
      patched = edges.append_child("edge");
      patched.append_attribute("id") = id;
    };
    if (const auto shape = plan.shapes.find(id); shape != plan.shapes.end()) {
      patch();
      patched.append_attribute("shape") = shape->second.c_str();
    }
    for (const pugi::xml_node lane : edge.children("lane")) {
      const auto width = plan.lane_widths.find(lane.attribute("id").value());
      if (width == plan.lane_widths.end()) continue;
      patch();
      pugi::xml_node patched_lane = patched.append_child("lane");
      patched_lane.append_attribute("index") = lane.attribute("index").value();
      patched_lane.append_attribute("width") = width->second;
    }
  }
}

/// Who waits for whom, but for edges that are left out.
void append_prohibitions(const NetworkPatch& patch, pugi::xml_node connections) {
  const auto& dropped = patch.carriageways.dropped;
  for (const Prohibition& rule : patch.prohibitions) {
    const auto edges = {&rule.from, &rule.to, &rule.waits_from, &rule.waits_to};
    if (std::any_of(edges.begin(), edges.end(),
                    [&](const std::string* edge) { return dropped.contains(*edge); }))
      continue;
    pugi::xml_node prohibition = connections.append_child("prohibition");
    prohibition.append_attribute("prohibitor") = (rule.from + "->" + rule.to).c_str();
    prohibition.append_attribute("prohibited") = (rule.waits_from + "->" + rule.waits_to).c_str();
  }
}

void append_refused(const std::vector<Turn>& turns, pugi::xml_node connections) {
  for (const Turn& turn : turns) {
    pugi::xml_node refused = connections.append_child("delete");
    refused.append_attribute("from") = turn.from.c_str();
    refused.append_attribute("to") = turn.to.c_str();
    refused.append_attribute("fromLane") = turn.from_lane;
    refused.append_attribute("toLane") = turn.to_lane;
  }
}

void write_patch(const pugi::xml_node& net, const NetworkPatch& patch,
                 const std::filesystem::path& edge_file, const std::filesystem::path& node_file,
                 const std::filesystem::path& connection_file) {
  pugi::xml_document edge_document, node_document, connection_document;
  std::map<std::string, std::string> start;
  for (const pugi::xml_node edge : net.children("edge"))
    start[edge.attribute("id").value()] = edge.attribute("from").value();

  pugi::xml_node edges = edge_document.append_child("edges"),
                 nodes = node_document.append_child("nodes");
  for (const auto& ring : patch.roundabouts) {
    std::string node_names, edge_names;
    for (const std::string& edge : ring) {
      node_names += (node_names.empty() ? "" : " ") + start[edge];
      edge_names += (edge_names.empty() ? "" : " ") + edge;
    }
    pugi::xml_node roundabout = edges.append_child("roundabout");
    roundabout.append_attribute("nodes") = node_names.c_str();
    roundabout.append_attribute("edges") = edge_names.c_str();
  }
  append_carriageways(net, patch.carriageways, edges);
  for (const auto& [junction, type] : patch.junction_types) {
    pugi::xml_node node = nodes.append_child("node");
    node.append_attribute("id") = junction.c_str();
    node.append_attribute("type") = type.c_str();
  }
  append_prohibitions(patch, connection_document.append_child("connections"));
  append_refused(patch.refused, connection_document.child("connections"));
  save_xml(edge_document, edge_file);
  save_xml(node_document, node_file);
  save_xml(connection_document, connection_file);
}

}  // namespace

std::vector<std::string> patch_network(const NetconvertRequest& request, const pugi::xml_node& net,
                                       const NetworkPatch& patch) {
  const std::string edges = "work/patch.edg.xml", nodes = "work/patch.nod.xml",
                    connections = "work/patch.con.xml", unpatched = "work/unpatched.net.xml";
  write_patch(net, patch, request.folder / edges, request.folder / nodes,
              request.folder / connections);
  std::filesystem::rename(request.folder / request.network, request.folder / unpatched);
  std::vector<std::string> arguments = {"--xml-validation",
                                        "never",
                                        "-s",
                                        unpatched,
                                        "-n",
                                        nodes,
                                        "-e",
                                        edges,
                                        "-x",
                                        connections,
                                        "-o",
                                        request.network,
                                        "--offset.disable-normalization",
                                        "--junctions.corner-detail",
                                        "5",
                                        "--junctions.internal-link-detail",
                                        "8",
                                        "--no-turnarounds.except-deadend",
                                        "--output.street-names",
                                        "--output.original-names"};
  if (request.left_hand) arguments.push_back("--lefthand");
  return run(request, std::move(arguments));
}

std::vector<std::string> run_netconvert_on_plain(const NetconvertRequest& request,
                                                 const std::string& name) {
  std::vector<std::string> arguments = {"--xml-validation",
                                        "never",
                                        "-n",
                                        name + ".nod.xml",
                                        "-e",
                                        name + ".edg.xml",
                                        "-x",
                                        name + ".con.xml",
                                        "-o",
                                        request.network,
                                        "--offset.disable-normalization",
                                        "--no-turnarounds",
                                        "--tls.default-type",
                                        "static",
                                        "--junctions.internal-link-detail",
                                        "8"};
  if (request.left_hand) arguments.push_back("--lefthand");
  return run(request, std::move(arguments));
}

std::vector<NodeGroup> read_joins(const std::filesystem::path& file) {
  pugi::xml_document document;
  if (!document.load_file(file.c_str())) throw Error(file.string(), "not a file of joined nodes");
  std::vector<NodeGroup> groups;
  for (const pugi::xml_node join : document.child("nodes").children("join")) {
    std::istringstream names(join.attribute("nodes").value());
    groups.push_back({std::istream_iterator<std::string>(names), {}});
  }
  return groups;
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
