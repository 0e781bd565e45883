#include "simulation/scene_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace sumogamma {
namespace {

constexpr const char* kHeader = "id,type,x,y,heading_rad,speed,goal_x,goal_y,pref_speed\n";

class SceneFileTest : public ::testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    path_ = std::filesystem::temp_directory_path() /
            ("scene_file_test_" + std::to_string(getpid()) + ".csv");
    std::ofstream(path_) << text;
    return path_;
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::filesystem::path path_;
};

TEST_F(SceneFileTest, ReadsAgentsInOrderOfId) {
  const auto path =
      write(std::string(kHeader) + "7,Car,1,2,0.5,3,10,20,4\r\n2,People,0,0,0,0,1,1,1.2\n\n");
  const SceneFile file = read_scene_file(path, Actuation::CarLike);
  ASSERT_EQ(file.scene.size(), 2u);
  EXPECT_EQ(file.scene.id[0].value, 2u);
  EXPECT_EQ(file.scene.position[1], Vec2(1, 2));
  EXPECT_EQ(file.goals[1], Vec2(10, 20));
  EXPECT_EQ(type_of(file.types, file.scene.type[1]).name, "Car");
  EXPECT_EQ(type_of(file.types, file.scene.type[1]).wheelbase, 2.7);
  EXPECT_EQ(type_of(file.types, file.scene.type[0]).kinematics, Kinematics::Holonomic);
}

TEST_F(SceneFileTest, BodiesMayHaveSizesOfTheirOwn) {
  std::string header = kHeader;
  header.insert(header.size() - 1, ",length,width");
  const SceneFile file =
      read_scene_file(write(header + "1,car,0,0,0,0,9,9,4,5.2,2.1\n"), Actuation::CarLike);
  EXPECT_DOUBLE_EQ(file.scene.footprint[0].radius, box_footprint(5.2, 2.1).radius);
  EXPECT_THROW(read_scene_file(write(header + "1,car,0,0,0,0,9,9,4\n"), Actuation::CarLike), Error);
  EXPECT_THROW(read_scene_file(write(header + "1,car,0,0,0,0,9,9,4,0,2\n"), Actuation::CarLike),
               Error);
}

TEST_F(SceneFileTest, IdealActuationFreesTheWheels) {
  const auto path = write(std::string(kHeader) + "1,Bus,0,0,0,0,1,1,4\n");
  EXPECT_EQ(read_scene_file(path, Actuation::Ideal).types[0].kinematics, Kinematics::Holonomic);
}

TEST_F(SceneFileTest, NamesFileAndLineOfWhatIsWrong) {
  const std::string bad[] = {"id,type\n",
                             kHeader,
                             std::string(kHeader) + "1,Car,1,2\n",
                             std::string(kHeader) + "1,Car,one,2,0,0,0,0,1\n",
                             std::string(kHeader) + "1,Car,nan,2,0,0,0,0,1\n",
                             std::string(kHeader) + "1,Car,1,2,0,-1,0,0,1\n",
                             std::string(kHeader) + "-1,Car,1,2,0,0,0,0,1\n",
                             std::string(kHeader) + "1,Tank,1,2,0,0,0,0,1\n",
                             std::string(kHeader) + "1,Car,1,2,0,0,0,0,1\n1,Car,9,9,0,0,0,0,1\n"};
  for (const std::string& text : bad) {
    SCOPED_TRACE(text);
    EXPECT_THROW(read_scene_file(write(text), Actuation::CarLike), Error);
  }
  try {
    read_scene_file(write(bad[3]), Actuation::CarLike);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(".csv:2: x is 'one'"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(read_scene_file("/no/such/file.csv", Actuation::CarLike), Error);
}

}  // namespace
}  // namespace sumogamma
