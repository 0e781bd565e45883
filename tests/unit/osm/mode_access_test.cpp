#include "osm/mode_access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "osm/netconvert.h"
#include "osm/road_types.h"
#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(ModeAccess, TheMostSpecificTagHolds) {
  const ModeAccess open = mode_access({});
  EXPECT_TRUE(open.motors && open.bicycle && open.foot);
  EXPECT_THAT(open.closed, IsEmpty());
  const ModeAccess bus = mode_access({{"access", "no"}, {"bus", "yes"}});
  EXPECT_TRUE(bus.motors);
  EXPECT_FALSE(bus.bicycle || bus.foot);
  EXPECT_THAT(bus.closed, Not(Contains("bus")));
  EXPECT_THAT(bus.closed, Contains("motorcar"));
  EXPECT_THAT(mode_access({{"motor_vehicle", "no"}, {"psv", "yes"}}).opened,
              ElementsAre("taxi", "bus"));
  EXPECT_THAT(mode_access({{"psv", "yes"}, {"bus", "no"}}).closed, ElementsAre("bus"));
  const ModeAccess bicycle = mode_access({{"vehicle", "no"}, {"bicycle", "yes"}});
  EXPECT_FALSE(bicycle.motors);
  EXPECT_TRUE(bicycle.bicycle && bicycle.foot);
  EXPECT_FALSE(mode_access({{"access", "private"}}).foot);
  EXPECT_TRUE(mode_access({{"access", "private"}, {"foot", "yes"}}).foot);
  EXPECT_TRUE(mode_access({{"access", "destination"}}).closed.empty());
}

TEST(ModeAccess, NoCarsMeansNothingWithTwoTracks) {
  const ModeAccess access = mode_access({{"motorcar", "no"}});
  EXPECT_TRUE(access.motors && access.bicycle);
  EXPECT_THAT(access.closed, ElementsAre("motorcar", "taxi", "bus", "coach", "goods", "hgv"));
  EXPECT_THAT(mode_access({{"hgv", "no"}}).closed, ElementsAre("hgv"));
}

/// Value of highway that a road gets, and the classes of its type.
struct Typed {
  std::string value;
  std::set<std::string> allowed;
};
Typed typed(Tags tags) {
  MapBuilder b;
  b.node(1, 0, 0).node(2, 200, 0).way(10, {1, 2}, std::move(tags));
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("road_types_" + std::to_string(getpid()) + ".xml");
  const HighwayValues values = write_road_types(b.map, typemaps(), file);
  pugi::xml_document document;
  EXPECT_TRUE(document.load_file(file.c_str()));
  std::filesystem::remove(file);
  if (values.empty()) return {};
  const pugi::xml_node type = document.child("types").child("type");
  EXPECT_EQ(type.attribute("id").value(), "highway." + values.at(10));
  EXPECT_FALSE(type.attribute("disallow"));
  std::istringstream allowed(type.attribute("allow").value());
  return {values.at(10), {std::istream_iterator<std::string>(allowed), {}}};
}

TEST(RoadTypes, ShutOutWhoMayNotAndLetInWhoMay) {
  EXPECT_EQ(typed({{"highway", "residential"}}).value, "");
  EXPECT_EQ(typed({{"highway", "residential"}, {"access", "destination"}}).value, "");
  const Typed bus = typed({{"highway", "residential"}, {"access", "no"}, {"bus", "yes"}});
  EXPECT_EQ(bus.value, "residential.only_bus");
  EXPECT_THAT(bus.allowed, Contains("bus"));
  for (const char* shut : {"passenger", "truck", "motorcycle", "delivery", "taxi", "tram"})
    EXPECT_THAT(bus.allowed, Not(Contains(shut)));
  const Typed light = typed({{"highway", "primary"}, {"hgv", "no"}});
  EXPECT_EQ(light.value, "primary.not_hgv");
  EXPECT_THAT(light.allowed, Not(Contains("truck")));
  EXPECT_THAT(light.allowed, Contains("passenger"));
  const Typed motorcycle =
      typed({{"highway", "residential"}, {"motorcar", "no"}, {"motorcycle", "yes"}});
  EXPECT_EQ(motorcycle.value, "residential.only_motorcycle_moped");
  // netconvert lets nothing but deliveries into service roads
  const Typed service = typed({{"highway", "service"}, {"bus", "yes"}});
  EXPECT_EQ(service.value, "service.with_bus");
  EXPECT_THAT(service.allowed, Contains("bus"));
  EXPECT_THAT(service.allowed, Not(Contains("passenger")));
}

}  // namespace
}  // namespace sumogamma::osm
