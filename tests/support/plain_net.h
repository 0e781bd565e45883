#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "road/sumo_net_reader.h"

namespace sumogamma::testing {

/// A network for a test in netconvert's plain XML: elements of <nodes>, <edges> and <connections>.
struct PlainNet {
  std::string nodes, edges, connections;
  std::vector<std::string> options;
};

/// Writes it as `file` with netconvert.
inline void write_plain_net(const PlainNet& plain, const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  const fs::path base = file.string() + ".plain";
  auto write = [&](const char* kind, const std::string& elements) {
    std::ofstream(base.string() + "." + kind)
        << '<' << kind << '>' << elements << "</" << kind << '>';
    return base.string() + "." + kind;
  };
  ProcessRequest request;
  request.arguments = {"netconvert", "--node-files", write("nodes", plain.nodes), "--edge-files",
                       write("edges", plain.edges)};
  auto add = [&](std::vector<std::string> more) {
    request.arguments.insert(request.arguments.end(), more.begin(), more.end());
  };
  if (!plain.connections.empty())
    add({"--connection-files", write("connections", plain.connections)});
  add({"--offset.disable-normalization", "--no-turnarounds", "--output-file", file.string()});
  add(plain.options);
  const ProcessResult result = run_process(request);
  for (const char* kind : {"nodes", "edges", "connections"}) fs::remove(base.string() + "." + kind);
  if (!result.ok()) throw std::runtime_error("netconvert failed: " + result.errors);
}

inline RoadNetwork read_plain_net(const PlainNet& plain) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("sumogamma_plain_" + std::to_string(getpid()) + ".net.xml");
  write_plain_net(plain, file);
  RoadNetwork network = read_sumo_net(file);
  std::filesystem::remove(file);
  return network;
}

/// Four arms, 200 m long, around C at the origin: the east-west road has two lanes each way, the
/// other one, which gives way, one.
///
///               N
///               |          edges are named after their ends: WC runs from W to C
///       W ===== C ===== E
///               |
///               S
inline PlainNet crossroads(const std::string& type, std::vector<std::string> options = {}) {
  PlainNet plain;
  plain.nodes = R"(<node id="C" x="0" y="0" type=")" + type +
                R"("/><node id="W" x="-200" y="0"/><node id="E" x="200" y="0"/>
                   <node id="N" x="0" y="200"/><node id="S" x="0" y="-200"/>)";
  auto edge = [&](const char* from, const char* to, int lanes, int priority) {
    plain.edges += std::string("<edge id=\"") + from + to + "\" from=\"" + from + "\" to=\"" + to +
                   "\" numLanes=\"" + std::to_string(lanes) + "\" priority=\"" +
                   std::to_string(priority) + "\" speed=\"13\"/>";
  };
  for (const char* end : {"W", "E"}) {
    edge(end, "C", 2, 3);
    edge("C", end, 2, 3);
  }
  for (const char* end : {"N", "S"}) {
    edge(end, "C", 1, 1);
    edge("C", end, 1, 1);
  }
  plain.options = std::move(options);
  return plain;
}

/// Two ways from A to D, by N or, shorter, by S; one lane each, and `both_ways` the way back, too.
///
///          N
///        /   |          edges are named after their ends: IA runs from I to A
///   I - A    D - O
///        |   /
///          S
inline PlainNet two_ways(bool both_ways) {
  PlainNet plain;
  plain.nodes = R"(<node id="I" x="-150" y="0"/><node id="A" x="0" y="0"/>
    <node id="N" x="100" y="100"/><node id="S" x="100" y="-60"/><node id="D" x="200" y="0"/>
    <node id="O" x="350" y="0"/>)";
  auto edge = [&](char from, char to) {
    plain.edges += std::string("<edge id=\"") + from + to + "\" from=\"" + from + "\" to=\"" + to +
                   "\" numLanes=\"1\" speed=\"13\"/>";
  };
  for (const std::string way : {"IA", "AN", "ND", "AS", "SD", "DO"}) {
    edge(way[0], way[1]);
    if (both_ways) edge(way[1], way[0]);
  }
  return plain;
}

inline std::vector<EdgeId> route_of(const RoadNetwork& network,
                                    const std::vector<std::string>& names) {
  std::vector<EdgeId> route;
  for (const std::string& name : names) route.push_back(network.edge_by_name.at(name));
  return route;
}

}  // namespace sumogamma::testing
