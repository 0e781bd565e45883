#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/agent_type.h"
#include "scene/scene.h"

namespace sumogamma {

/// How commanded velocities turn into motion in a standalone scene.
enum class Actuation : std::uint8_t {
  CarLike,  ///< wheels: speed within +3/-6 m/s^2, steering within 45 degrees, single track about
            ///< the rear axle
  Ideal,    ///< everybody moves exactly as asked, heading along the motion
};

/// A standalone scene: no roads, everybody towards a goal.
struct SceneFile {
  std::string name;      ///< the file's name without folder and ending
  AgentTypeTable types;  ///< those that occur
  Scene scene;
  std::vector<Vec2> goals;  ///< by row [m]
};

/// Reads `id,type,x,y,heading_rad,speed,goal_x,goal_y,pref_speed` (metres, radians
/// counter-clockwise from +x, x,y = centre of the box). Types: People, Bicycle, Scooter, Car, Van,
/// Bus, Jeep, Electric_Tricycle, Gyro_Scooter with the sizes of the reference's scene set, or any
/// name of default_agent_types. `length,width` [m] may stand behind these columns: the box of each,
/// which otherwise is its type's. Rows may come in any order of ids. Throws Error naming file and
/// line.
SceneFile read_scene_file(const std::filesystem::path& path, Actuation actuation);

/// The types of the scene set with its boxes, wheelbases, top speeds and rear axles, and these
/// limits of actuation.
AgentTypeTable scene_agent_types(Actuation actuation);

}  // namespace sumogamma
