#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "road/sumo_net_reader.h"

namespace sumogamma::testing {

// A two-way road W=E with a signal at C, a sidewalk along it, a crossing and a bridge over it:
//
//        y=2    W ----- in_0 (sidewalk) ----->:C_w0        : bridge_0 at x=50, northwards, 6 m up
//        y=0    W ===== in_1 =====> C ==== out_0 ===> E    : signal C: link 0 drives, link 1 walks
//        y=-3.2 W <==== back_1 ==== C <=== back_in_0 === E : no signal
//                            x=95..105, crossing at x=101 from (101,-5) to (101,2)
inline constexpr const char* kSmallNet = R"xml(<?xml version="1.0" encoding="UTF-8"?>
<net version="1.9">
  <location netOffset="0.00,0.00" convBoundary="0,0,200,0" origBoundary="0,0,1,1" projParameter="!"/>
  <edge id=":C_0" function="internal">
    <lane id=":C_0_0" index="0" disallow="pedestrian" speed="13.9" length="10" shape="95,0 105,0"/>
  </edge>
  <edge id=":C_1" function="internal">
    <lane id=":C_1_0" index="0" disallow="pedestrian" speed="13.9" length="10" shape="105,-3.2 95,-3.2"/>
  </edge>
  <edge id=":C_c0" function="crossing" crossingEdges="in back">
    <lane id=":C_c0_0" index="0" allow="pedestrian" speed="1" length="7" width="4" shape="101,-5 101,2"/>
  </edge>
  <edge id=":C_w0" function="walkingarea">
    <lane id=":C_w0_0" index="0" allow="pedestrian" speed="1" length="2" width="2" shape="95,2 104,2 104,5 95,5"/>
  </edge>
  <edge id=":C_w1" function="walkingarea">
    <lane id=":C_w1_0" index="0" allow="pedestrian" speed="1" length="2" width="2" shape="95,-8 104,-8 104,-5 95,-5"/>
  </edge>
  <edge id="in" from="W" to="C" priority="7" type="highway.primary">
    <lane id="in_0" index="0" allow="pedestrian" speed="1.5" length="95" width="2" shape="0,2.6 95,2.6"/>
    <lane id="in_1" index="1" disallow="pedestrian" speed="13.9" length="95" shape="0,0 95,0"/>
  </edge>
  <edge id="out" from="C" to="E" priority="7">
    <lane id="out_0" index="0" disallow="pedestrian" speed="13.9" length="95" shape="105,0 200,0"/>
  </edge>
  <edge id="back_in" from="E" to="C" priority="7">
    <lane id="back_in_0" index="0" disallow="pedestrian" speed="13.9" length="95" shape="200,-3.2 105,-3.2"/>
  </edge>
  <edge id="back" from="C" to="W" priority="7">
    <lane id="back_0" index="0" disallow="pedestrian" speed="13.9" length="95" shape="95,-3.2 0,-3.2"/>
  </edge>
  <edge id="bridge" from="S" to="N" priority="7">
    <lane id="bridge_0" index="0" disallow="pedestrian" speed="13.9" length="95" shape="50,-60,6 50,60,6"/>
  </edge>
  <tlLogic id="C" type="static" programID="0" offset="0"><phase duration="30" state="Gr"/></tlLogic>
  <junction id="W" type="dead_end" x="0" y="0" incLanes="back_0" intLanes="" shape="0,0 0,1"/>
  <junction id="N" type="dead_end" x="50" y="60" incLanes="bridge_0" intLanes="" shape="50,60 51,60"/>
  <junction id="S" type="dead_end" x="50" y="-60" incLanes="" intLanes="" shape="50,-60 51,-60"/>
  <junction id="C" type="traffic_light" x="100" y="0" incLanes="in_1 back_in_0 :C_w0_0" intLanes=":C_0_0 :C_1_0 :C_c0_0"
    shape="95,1.6 105,1.6 105,-4.8 95,-4.8">
    <request index="0" response="000" foes="100" cont="0"/>
    <request index="1" response="000" foes="100" cont="0"/>
    <request index="2" response="011" foes="011" cont="0"/>
  </junction>
  <junction id="E" type="dead_end" x="200" y="0" incLanes="out_0" intLanes="" shape="200,0 200,1"/>
  <connection from="in" to="out" fromLane="1" toLane="0" via=":C_0_0" tl="C" linkIndex="0" dir="s" state="o"/>
  <connection from=":C_0" to="out" fromLane="0" toLane="0" dir="s" state="M"/>
  <connection from="back_in" to="back" fromLane="0" toLane="0" via=":C_1_0" dir="s" state="M"/>
  <connection from=":C_1" to="back" fromLane="0" toLane="0" dir="s" state="M"/>
  <connection from=":C_w0" to=":C_c0" fromLane="0" toLane="0" tl="C" linkIndex="1" dir="s" state="o"/>
  <connection from=":C_c0" to=":C_w1" fromLane="0" toLane="0" dir="s" state="M"/>
  <connection from="in" to=":C_w0" fromLane="0" toLane="0" dir="s" state="M"/>
</net>
)xml";

inline RoadNetwork small_net() {
  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("sumogamma_small_" + std::to_string(getpid()) + ".net.xml");
  std::ofstream(file) << kSmallNet;
  RoadNetwork network = read_sumo_net(file);
  std::filesystem::remove(file);
  return network;
}

}  // namespace sumogamma::testing
