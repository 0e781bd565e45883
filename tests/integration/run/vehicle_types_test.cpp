// What vTypes say shows in how their vehicles drive. Roads side by side, one a vType: a vehicle
// that sets out on an empty road, and one behind another of 4 m/s.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "base/subprocess.h"
#include "support/coupling_scenario.h"

namespace sumogamma {
namespace {

struct Sample {
  double time = 0, x = 0, speed = 0;
};
using Tracks = std::map<std::string, std::vector<Sample>>;

Tracks read_tracks(const std::string& file) {
  std::string text;
  gzFile stream = gzopen(file.c_str(), "rb");
  if (stream == nullptr) throw std::runtime_error(file + " can't be read");
  char buffer[1 << 16];
  for (int got = 0; (got = gzread(stream, buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(got));
  gzclose(stream);
  pugi::xml_document document;
  document.load_string(text.c_str());
  Tracks tracks;
  for (const pugi::xml_node step : document.document_element().children())
    for (const pugi::xml_node agent : step.children())
      tracks[agent.attribute("id").value()].push_back({step.attribute("time").as_double(),
                                                       agent.attribute("x").as_double(),
                                                       agent.attribute("speed").as_double()});
  return tracks;
}

struct Saying {
  std::string name, attributes;
};

/// One run for all of them, 60 s: NAME_first on the empty road, NAME behind NAME_slow.
Tracks run(const std::vector<Saying>& sayings) {
  const TemporaryFolder folder;
  std::string nodes, edges, types, early, slow, late;
  for (std::size_t k = 0; k < sayings.size(); ++k) {
    const auto& [name, attributes] = sayings[k];
    const std::string y = std::to_string(30 * k),
                      route = "\"><route edges=\"" + name + "\"/></vehicle>";
    nodes += "<node id=\"a" + name + "\" x=\"0\" y=\"" + y + "\"/><node id=\"b" + name +
             "\" x=\"900\" y=\"" + y + "\"/>";
    edges += "<edge id=\"" + name + "\" from=\"a" + name + "\" to=\"b" + name +
             "\" numLanes=\"1\" speed=\"13.9\"/>";
    types += "<vType id=\"" + name + "\" vClass=\"passenger\" speedDev=\"0\" " + attributes + "/>";
    early += "<vehicle id=\"" + name + "_first\" type=\"" + name +
             "\" depart=\"0\" departPos=\"20\"><route edges=\"" + name + "\"/><stop lane=\"" +
             name + "_0\" endPos=\"100\" duration=\"2\"/></vehicle>";
    slow += "<vehicle id=\"" + name + "_slow\" type=\"slow\" depart=\"10\" departPos=\"60" + route;
    late += "<vehicle id=\"" + name + "\" type=\"" + name + "\" depart=\"12" + route;
  }
  folder.write("nodes.xml", "<nodes>" + nodes + "</nodes>");
  folder.write("edges.xml", "<edges>" + edges + "</edges>");
  folder.write("routes.rou.xml",
               "<routes><vType id=\"slow\" vClass=\"passenger\" speedDev=\"0\" maxSpeed=\"4\"/>" +
                   types + early + slow + late + "</routes>");
  folder.write("s.sumocfg",
               "<configuration><input><net-file value=\"net.net.xml\"/><route-files "
               "value=\"routes.rou.xml\"/></input></configuration>");
  ProcessRequest request;
  request.arguments = {"netconvert",
                       "--node-files",
                       folder.file("nodes.xml"),
                       "--edge-files",
                       folder.file("edges.xml"),
                       "--offset.disable-normalization",
                       "-o",
                       folder.file("net.net.xml")};
  EXPECT_TRUE(run_process(request).ok());
  request.arguments = {SUMOGAMMA_PROGRAM,
                       "run",
                       folder.file("s.sumocfg"),
                       "-o",
                       folder.file("out"),
                       "--quiet",
                       "--duration",
                       "60",
                       "--step",
                       "0.05",
                       "--trajectory-period",
                       "0"};
  request.time_limit = 300.0;
  const ProcessResult result = run_process(request);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  Tracks tracks = read_tracks(folder.file("out/trajectories.fcd.xml.gz"));
  for (const Saying& saying : sayings)
    for (const char* which : {"", "_first", "_slow"})
      if (!tracks.contains(saying.name + which))
        throw std::runtime_error(saying.name + which + " didn't come");
  return tracks;
}

double fastest(const std::vector<Sample>& track) {
  double speed = 0;
  for (const Sample& sample : track) speed = std::max(speed, sample.speed);
  return speed;
}

/// Mean from its stop to 5 m/s [m/s^2].
double acceleration(const std::vector<Sample>& track) {
  double left = -1.0;
  for (const Sample& sample : track) {
    if (sample.speed < 0.05) left = sample.time;
    if (left >= 0.0 && sample.speed >= 5.0) return sample.speed / (sample.time - left);
  }
  return 0.0;
}

double hardest_braking(const std::vector<Sample>& track) {
  double most = 0;
  for (std::size_t k = 1; k < track.size(); ++k)
    most = std::max(most, (track[k - 1].speed - track[k].speed) / 0.05);
  return most;
}

/// At the end, between the two on a road [m].
double gap(const Tracks& tracks, const std::string& name, double length = 5.0) {
  return tracks.at(name + "_slow").back().x - tracks.at(name).back().x - length;
}

TEST(VehicleTypes, AreDrivenAsTheySay) {
  const Tracks tracks = run({{"plain", ""},
                             {"lame", R"(accel="0.6")"},
                             {"near", R"(tau="0.5" minGap="1")"},
                             {"far", R"(carFollowModel="IDM" tau="2.5")"},
                             {"apart", R"(minGap="6")"},
                             {"gentle", R"(decel="1")"},
                             {"capped", R"(maxSpeed="6")"},
                             {"slower", R"(speedFactor="0.5")"},
                             {"faster", R"(speedFactor="1.3")"},
                             {"dawdler", R"(sigma="1")"},
                             {"long", R"(length="15")"}});
  EXPECT_NEAR(acceleration(tracks.at("plain_first")), 2.5, 0.3);
  EXPECT_NEAR(acceleration(tracks.at("lame_first")), 0.6, 0.05);
  EXPECT_NEAR(acceleration(tracks.at("dawdler_first")), 1.25, 0.15);
  EXPECT_NEAR(fastest(tracks.at("plain_first")), 13.9, 0.3);
  EXPECT_NEAR(fastest(tracks.at("capped_first")), 6.0, 0.1);
  EXPECT_NEAR(fastest(tracks.at("slower_first")), 6.95, 0.1);
  EXPECT_NEAR(fastest(tracks.at("faster_first")), 18.07, 0.3);
  // minGap + tau * 4 m/s
  EXPECT_NEAR(gap(tracks, "near"), 3.0, 0.6);
  EXPECT_NEAR(gap(tracks, "far"), 12.5, 1.0);
  EXPECT_NEAR(gap(tracks, "apart"), gap(tracks, "plain") + 4.2, 0.6);
  EXPECT_NEAR(gap(tracks, "long"), gap(tracks, "plain"), 0.6) << "of its front";
  EXPECT_LT(hardest_braking(tracks.at("gentle")), 1.3);
  EXPECT_GT(hardest_braking(tracks.at("plain")), 1.3);
}

}  // namespace
}  // namespace sumogamma
