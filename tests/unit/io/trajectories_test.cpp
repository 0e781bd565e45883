#include "io/trajectories.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <filesystem>
#include <pugixml.hpp>

#include "base/error.h"
#include "base/units.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

constexpr double kStep = 0.05;

std::string inflate(const fs::path& file) {
  gzFile stream = gzopen(file.c_str(), "rb");
  std::string content(1 << 20, '\0');
  const int read = gzread(stream, content.data(), 1 << 20);
  int status = 0;
  gzerror(stream, &status);
  EXPECT_EQ(status, Z_OK) << "the file must be whole";
  gzclose(stream);
  content.resize(static_cast<std::size_t>(std::max(read, 0)));
  return content;
}

class Trajectories : public ::testing::Test {
 protected:
  void SetUp() override {
    file_ = fs::temp_directory_path() / ("sumogamma_fcd_" + std::to_string(getpid()) + ".xml.gz");
    AgentState car;
    car.type = find_agent_type(types_, "car");
    car.footprint = box_footprint(4.5, 1.8);
    car.position = {20, 0};
    car.speed = 5;
    append_agent(scene_, car);
    scene_.lane[0] = {net_.lane_by_name.at("in_1"), 20, 0};
    AgentState walker;
    walker.id = AgentId{1};
    walker.type = find_agent_type(types_, "pedestrian");
    walker.footprint = box_footprint(0.4, 0.48);
    walker.position = {30, 2.6};
    walker.heading = kPi;
    append_agent(scene_, walker);
  }
  void TearDown() override { fs::remove(file_); }

  RoadNetwork net_ = testing::small_net();
  LaneLocator locator_{net_};
  AgentTypeTable types_ = default_agent_types();
  Scene scene_;
  AgentName name_ = [](AgentId id) -> std::string_view { return id.value == 0 ? "a<&\"b" : "p1"; };
  fs::path file_;
};

TEST_F(Trajectories, SumoReferencePointsAndAngles) {
  {
    TrajectoryWriter writer(0, kStep, net_, &locator_);
    writer.add_sink(std::make_unique<FcdSink>(file_));
    writer.add(scene_, types_, name_);
  }
  pugi::xml_document document;
  const std::string content = inflate(file_);
  ASSERT_TRUE(document.load_string(content.c_str()));
  const pugi::xml_node step = document.child("fcd-export").child("timestep");
  const pugi::xml_node car = step.child("vehicle"), walker = step.child("person");
  EXPECT_STREQ(car.attribute("id").value(), "a<&\"b");
  EXPECT_DOUBLE_EQ(car.attribute("x").as_double(), 22.25) << "front bumper";
  EXPECT_DOUBLE_EQ(car.attribute("angle").as_double(), 90);
  EXPECT_STREQ(car.attribute("lane").value(), "in_1");
  EXPECT_DOUBLE_EQ(car.attribute("pos").as_double(), 22.25);
  EXPECT_DOUBLE_EQ(car.attribute("speed").as_double(), 5);
  EXPECT_DOUBLE_EQ(walker.attribute("x").as_double(), 30) << "centre";
  EXPECT_DOUBLE_EQ(walker.attribute("angle").as_double(), 270);
  EXPECT_STREQ(walker.attribute("edge").value(), "in") << "found by the locator";
}

TEST_F(Trajectories, RecordsOncePerPeriod) {
  {
    TrajectoryWriter writer(0.5, kStep, net_);
    writer.add_sink(std::make_unique<FcdSink>(file_));
    // after each tick
    for (int tick = 0; tick <= 40; ++tick) {
      scene_.time = (tick + 1) * kStep;
      writer.add(scene_, types_, name_);
    }
  }
  pugi::xml_document document;
  const std::string content = inflate(file_);
  ASSERT_TRUE(document.load_string(content.c_str()));
  std::vector<double> times;
  for (const pugi::xml_node step : document.child("fcd-export").children())
    times.push_back(step.attribute("time").as_double());
  EXPECT_EQ(times, (std::vector<double>{0, 0.5, 1.0, 1.5, 2.0}));
}

// as SUMO names its steps; whom SUMO drives is seen when the next tick begins
TEST_F(Trajectories, AStepIsNamedByItsBeginAndHoldsEverybodyAtItsEnd) {
  scene_.control[1] = Control::External;
  {
    TrajectoryWriter writer(0, kStep, net_);
    writer.add_sink(std::make_unique<FcdSink>(file_));
    for (int tick = 1; tick <= 3; ++tick) {
      scene_.tick = tick;
      scene_.time = 7.0 + tick * kStep;
      scene_.position[0].x() += 0.3;
      scene_.position[1].x() += 0.1;
      writer.add(scene_, types_, name_);
    }
  }
  pugi::xml_document document;
  const std::string content = inflate(file_);
  ASSERT_TRUE(document.load_string(content.c_str()));
  std::vector<double> times, cars, walkers, speeds;
  for (const pugi::xml_node step : document.child("fcd-export").children()) {
    times.push_back(step.attribute("time").as_double());
    cars.push_back(step.child("vehicle").attribute("x").as_double());
    speeds.push_back(step.child("vehicle").attribute("speed").as_double());
    walkers.push_back(step.child("person").attribute("x").as_double());
  }
  // the last one isn't whole
  EXPECT_EQ(times, (std::vector<double>{7.0, 7.05}));
  EXPECT_EQ(cars, (std::vector<double>{22.55, 22.85}));
  EXPECT_EQ(walkers, (std::vector<double>{30.2, 30.3}));
  EXPECT_EQ(speeds, (std::vector<double>{5.0, 6.0})) << "of the way made in it";
}

TEST_F(Trajectories, AnEmptyRunIsAValidDocument) {
  { FcdSink sink(file_); }
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(inflate(file_).c_str()));
  EXPECT_TRUE(document.child("fcd-export"));
}

TEST_F(Trajectories, FullDiskAndUnwritableFolder) {
  EXPECT_THROW(FcdSink("/dev/null/x.xml.gz"), Error);
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  TrajectoryWriter writer(0, kStep, net_);
  writer.add_sink(std::make_unique<FcdSink>("/dev/full"));
  try {
    for (int i = 0; i < 1000; ++i) writer.add(scene_, types_, name_);
    writer.close();
    FAIL() << "expected an error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full"), std::string::npos);
  }
}

}  // namespace
}  // namespace sumogamma
