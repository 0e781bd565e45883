#pragma once

#include "support/road_scene.h"
#include "support/small_net.h"
#include "traffic/lateral/lane_choice.h"

namespace sumogamma::testing {

/// A road of 200 m with two lanes.
inline PlainNet two_lanes() {
  PlainNet net;
  net.nodes = "<node id='W' x='0' y='0'/><node id='E' x='200' y='0'/>";
  net.edges = "<edge id='WE' from='W' to='E' numLanes='2' speed='13.89' width='3.5'/>";
  return net;
}

/// Everybody looks once at the lanes beside: within 0.4 s, each in its own tick.
inline void let_all_look(RoadScene& here) {
  LaneChoiceWork work;
  Workers alone(1);
  for (here.scene.tick = 0; here.scene.tick < 8; ++here.scene.tick)
    choose_lanes(here.tick(alone), work);
}

}  // namespace sumogamma::testing
