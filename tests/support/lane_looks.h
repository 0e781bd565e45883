#pragma once

#include "model/lane_choice.h"
#include "support/road_scene.h"

namespace sumogamma::testing {

/// Everybody looks once at the lanes beside: within 0.4 s, each in its own tick.
inline void let_all_look(RoadScene& here) {
  LaneChoiceWork work;
  Workers alone(1);
  for (here.scene.tick = 0; here.scene.tick < 8; ++here.scene.tick)
    choose_lanes(here.model, here.geometry.grid, 0.05, alone, here.road, here.scene, work);
}

}  // namespace sumogamma::testing
