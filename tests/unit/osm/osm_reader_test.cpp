#include "osm/osm_reader.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/random.h"

namespace sumogamma::osm {
namespace {
namespace fs = std::filesystem;

const fs::path kFixtures = fs::path(SUMOGAMMA_SOURCE_DIR) / "tests/support/osm";
const fs::path kMaps = fs::path(SUMOGAMMA_SOURCE_DIR) / "osm_maps";

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class OsmReaderTest : public ::testing::Test {
 protected:
  OsmReaderTest() {
    folder_ = fs::temp_directory_path() /
              ("osm_reader_" +
               std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~OsmReaderTest() override { fs::remove_all(folder_); }
  fs::path put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// What is wrong, or "" where the file can be read.
  static std::string error_of(const fs::path& file) {
    try {
      read_osm(file);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  }
  fs::path folder_;
};

const char* const kTwoWays = R"(<osm version="0.6">
  <node id="1" version="1" lat="48.0" lon="11.0"/><node id="2" version="1" lat="48.001" lon="11.0"/>
  <node id="3" version="1" lat="48.002" lon="11.0" ACTION><tag k="highway" v="traffic_signals"/></node>
  <way id="10" version="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/></way>
  <way id="11" version="1" ACTION><nd ref="1"/><nd ref="3"/><tag k="highway" v="residential"/></way>
</osm>)";

std::string with_action(std::string text, const std::string& action) {
  for (std::size_t at = text.find("ACTION"); at != std::string::npos; at = text.find("ACTION"))
    text.replace(at, 6, action);
  return text;
}

TEST_F(OsmReaderTest, ReadsWaysNodesAndAreas) {
  const OsmMap map = read_osm(kFixtures / "square_right.osm");
  EXPECT_EQ(map.counts.at("ways"), 11);
  ASSERT_EQ(map.areas.size(), 2u);  // the square and the kiosk
  for (const MapArea& area : map.areas) EXPECT_EQ(area.parts.at(0).outer.size(), 4u) << area.id;
  EXPECT_EQ(tag(map.nodes.at(31).tags, "natural"), "tree");
  EXPECT_FALSE(map.bounds.has_value());
}

TEST_F(OsmReaderTest, ReadsEveryKindOfFileAlike) {
  const std::string text = content(kFixtures / "zebra_right.osm");
  const fs::path packed = folder_ / "zebra.osm.gz";
  gzFile stream = gzopen(packed.c_str(), "wb");
  gzwrite(stream, text.data(), static_cast<unsigned>(text.size()));
  gzclose(stream);
  const OsmMap plain = read_osm(kFixtures / "zebra_right.osm"), gzipped = read_osm(packed);
  EXPECT_EQ(plain.nodes.size(), gzipped.nodes.size());
  EXPECT_EQ(plain.ways.size(), gzipped.ways.size());
  const OsmMap monaco = read_osm(kMaps / "monaco.osm.pbf");
  EXPECT_EQ(monaco.counts.at("nodes"), 16664);
  EXPECT_EQ(monaco.areas.size(), 1000u);
}

TEST_F(OsmReaderTest, LeavesOutWhatWasDeletedInTheEditor) {
  for (const char* action : {"action='delete'", "action=\"delete\""}) {
    const OsmMap map = read_osm(put("josm.osm", with_action(kTwoWays, action)));
    EXPECT_EQ(map.ways.size(), 1u) << action;
    EXPECT_FALSE(map.nodes.contains(3)) << action;
    EXPECT_EQ(map.counts.at("deleted_objects"), 2) << action;
  }
  EXPECT_EQ(read_osm(put("josm.osm", with_action(kTwoWays, "action='modify'"))).ways.size(), 2u);
  EXPECT_EQ(read_osm(put("josm.osm", with_action(kTwoWays, "visible='false'"))).ways.size(), 1u);
}

TEST_F(OsmReaderTest, GivesUnsavedObjectsPositiveIds) {
  const OsmMap map = read_osm(put("new.osm", R"(<osm version="0.6">
    <node id="-1" lat="48.0" lon="11.0"/><node id="-2" lat="48.001" lon="11.0"/><node id="7" lat="48.002" lon="11.0"/>
    <way id="-1"><nd ref="-1"/><nd ref="-2"/><nd ref="7"/><tag k="highway" v="residential"/></way></osm>)"));
  ASSERT_EQ(map.ways.size(), 1u);
  EXPECT_GT(map.ways[0].id, 7);
  ASSERT_EQ(map.ways[0].nodes.size(), 3u);
  for (const auto& [id, node] : map.nodes) EXPECT_GT(id, 0);
  EXPECT_DOUBLE_EQ(map.nodes.at(map.ways[0].nodes[1]).place.lat, 48.001);
  EXPECT_GT(map.next_id, map.ways[0].id);
}

TEST_F(OsmReaderTest, ReadsObjectsInAnyOrder) {
  // Overpass' "out body; >; out skel qt;"
  const OsmMap map = read_osm(put("overpass.osm", R"(<osm version="0.6">
    <way id="9"><nd ref="2"/><nd ref="1"/><nd ref="3"/><nd ref="2"/><tag k="building" v="yes"/></way>
    <way id="5"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/></way>
    <node id="2" lat="48.001" lon="11.0"/><node id="1" lat="48.0" lon="11.0"/><node id="3" lat="48.0" lon="11.001"/>
    </osm>)"));
  ASSERT_EQ(map.ways.size(), 2u);
  EXPECT_EQ(map.ways[0].id, 5);
  EXPECT_EQ(map.areas.size(), 1u);
}

TEST_F(OsmReaderTest, CountsPointsThatAreMissing) {
  const OsmMap map =
      read_osm(put("cut.osm", R"(<osm version="0.6"><node id="1" lat="48.0" lon="11.0"/>
    <node id="2" lat="48.001" lon="11.0"/>
    <way id="5"><nd ref="1"/><nd ref="2"/><nd ref="99"/><tag k="highway" v="residential"/></way></osm>)"));
  EXPECT_EQ(map.counts.at("missing_nodes"), 1);
  EXPECT_EQ(map.ways.at(0).nodes.size(), 2u);
}

TEST_F(OsmReaderTest, KeepsWholeWaysThatReachIntoTheBox) {
  const GeoBox box{10.9995, 47.9995, 11.0005, 48.0005};
  const OsmMap map = read_osm(kFixtures / "square_right.osm", box);
  const OsmMap all = read_osm(kFixtures / "square_right.osm");
  EXPECT_LT(map.ways.size(), all.ways.size());
  for (const MapWay& way : map.ways) EXPECT_GE(way.nodes.size(), 2u);
}

TEST_F(OsmReaderTest, NamesTheFileAndTheTrouble) {
  EXPECT_NE(error_of(folder_ / "none.osm").find("no such file"), std::string::npos);
  EXPECT_NE(error_of(folder_).find("is a folder"), std::string::npos);
  EXPECT_NE(error_of(put("map.txt", "hello")).find("unknown kind"), std::string::npos);
  EXPECT_NE(error_of(put("empty.osm", "")).find("is empty"), std::string::npos);
  EXPECT_NE(error_of(put("json.osm", "{\"elements\": []}")).find("json.osm"), std::string::npos);
  EXPECT_NE(error_of(put("page.osm", "<html><body>429</body></html>")).find("page.osm"),
            std::string::npos);
  EXPECT_NE(error_of(put("old.osm", "<osm version=\"0.5\"></osm>")).find("0.5"), std::string::npos);
  EXPECT_NE(
      error_of(put("hollow.osm", "<osm version=\"0.6\"></osm>")).find("no OpenStreetMap objects"),
      std::string::npos);
  EXPECT_NE(error_of(put("noise.osm.pbf", std::string(500, 'x'))).find("noise.osm.pbf"),
            std::string::npos);
}

TEST_F(OsmReaderTest, LooksAtTheBytesNotAtTheName) {
  const std::string text = content(kFixtures / "square_right.osm");
  const std::string pbf = content(kMaps / "fujisawa.osm.pbf");
  const OsmMap map = read_osm(kFixtures / "square_right.osm");
  for (const char* name : {"map.pbf", "map.osm.gz", "map", "map.xml", "map.txt"})
    EXPECT_EQ(read_osm(put(name, text)).ways.size(), map.ways.size()) << name;
  const std::size_t ways = read_osm(kMaps / "fujisawa.osm.pbf").ways.size();
  for (const char* name : {"map.osm", "map.osm.bz2", "map"})
    EXPECT_EQ(read_osm(put(name, pbf)).ways.size(), ways) << name;
  EXPECT_NE(error_of(put("map.osm", "PK\x03\x04 packed")).find("unpack it"), std::string::npos);
  EXPECT_NE(error_of(put("json.osm", "{\"elements\": []}")).find("is JSON"), std::string::npos);
  EXPECT_NE(error_of(put("page.osm", "<!DOCTYPE html><html>429")).find("web page"),
            std::string::npos);
  EXPECT_NE(
      error_of(put("net.xml", "<?xml version='1.0'?>\n<net version=\"1.9\">")).find("network"),
      std::string::npos);
}

TEST_F(OsmReaderTest, ReadsAnswersOfServersAndLibrariesThatAreNotPlain) {
  const std::string body =
      "<bounds minlat='47.9' minlon='10.9' maxlat='48.1' maxlon='11.1'/>"
      "<way id='10'><center lat='48' lon='11'/><nd ref='1' lat='48.0' lon='11.0'/>"
      "<nd ref='2' lat='48.001' lon='11.0'/><tag k='highway' v='residential'/></way>"
      "<relation id='5'><member type='way' ref='10' role=''><nd lat='48' lon='11'/></member>"
      "</relation></osm>";
  for (const char* version : {"0.6", "1", "1.0"}) {
    const OsmMap map =
        read_osm(put("map.osm", "<osm version=\"" + std::string(version) + "\">" + body));
    ASSERT_EQ(map.ways.size(), 1u) << version;
    EXPECT_EQ(map.ways[0].nodes.size(), 2u);
    EXPECT_NEAR(map.nodes.at(2).place.lat, 48.001, 1e-6);
    EXPECT_EQ(map.counts.at("nodes_from_ways"), 2);
    EXPECT_TRUE(map.bounds.has_value());
  }
}

TEST_F(OsmReaderTest, PassesOnThatAnAnswerIsNotWhole) {
  std::string text = with_action(kTwoWays, "");
  text.insert(text.find("</osm>"), "<remark> runtime error: Query timed out </remark>");
  EXPECT_NE(read_osm(put("cut.osm", text)).server_remark.find("timed out"), std::string::npos);
  EXPECT_EQ(read_osm(put("whole.osm", with_action(kTwoWays, ""))).server_remark, "");
  EXPECT_NE(error_of(put("none.osm", "<osm version='0.6'><remark>out of memory</remark></osm>"))
                .find("out of memory"),
            std::string::npos);
}

TEST_F(OsmReaderTest, NamesANodeThatIsNowhere) {
  const auto map_with = [&](const std::string& place) {
    std::string text = with_action(kTwoWays, "");
    text.insert(text.find("<way"), "<node id=\"77\" version=\"1\" " + place + "/>");
    return put("map.osm", text);
  };
  EXPECT_NE(
      read_osm(map_with("lat=\"91.5\" lon=\"11\"")).bad_place.find("node 77 at latitude 91.5"),
      std::string::npos);
  EXPECT_NE(read_osm(map_with("lat=\"48\" lon=\"181\"")).bad_place.find("181"), std::string::npos);
  EXPECT_NE(error_of(map_with("lat=\"48\" lon=\"5000\"")).find("node 77"), std::string::npos);
  std::string all = with_action(kTwoWays, "");
  for (std::size_t at = all.find("lat=\"48"); at != std::string::npos; at = all.find("lat=\"48"))
    all.replace(at, 7, "lat=\"98");
  EXPECT_NE(error_of(put("all.osm", all)).find("node 1 at latitude 98"), std::string::npos);
}

/// Reads a damaged file: it may be readable still (a flipped digit), but never ends other than by a
/// result or an Error.
void expect_result_or_error(const fs::path& file, const std::string& trace) {
  SCOPED_TRACE(trace);
  try {
    read_osm(file);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(file.filename().string()), std::string::npos)
        << error.what();
  }
}

TEST_F(OsmReaderTest, SurvivesFilesThatAreCutShort) {
  for (const fs::path& whole : {kFixtures / "square_left.osm", kMaps / "fujisawa.osm.pbf"}) {
    const std::string text = content(whole);
    ASSERT_GT(text.size(), 1000u);
    for (std::uint64_t i = 0; i < 40; ++i) {
      const auto size = static_cast<std::size_t>(random_uniform(1, i, 0, Draw::Demand) *
                                                 static_cast<double>(text.size()));
      const fs::path cut = put("cut_" + whole.filename().string(), text.substr(0, size));
      expect_result_or_error(cut, "cut at " + std::to_string(size));
      if (whole.extension() == ".osm") {
        EXPECT_NE(error_of(cut), "") << size;  // XML tells when its end is missing
      }
    }
  }
}

TEST_F(OsmReaderTest, SurvivesFlippedBits) {
  for (const fs::path& whole : {kFixtures / "square_left.osm", kMaps / "fujisawa.osm.pbf"}) {
    const std::string text = content(whole);
    for (std::uint64_t i = 0; i < 150; ++i) {
      std::string damaged = text;
      // headers matter most: a third of the flips are in the first 200 bytes
      const double span = i % 3 == 0 ? 200.0 : static_cast<double>(text.size());
      const auto at = static_cast<std::size_t>(random_uniform(2, i, 0, Draw::Demand) * span);
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << (i % 8)));
      expect_result_or_error(put("flip_" + whole.filename().string(), damaged),
                             "bit " + std::to_string(i % 8) + " of byte " + std::to_string(at));
    }
  }
}

}  // namespace
}  // namespace sumogamma::osm
