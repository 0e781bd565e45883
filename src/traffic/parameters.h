#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sumogamma {

/// Every tunable of the rules of the road, each once: a rule has no number of its own. What each is
/// for, its unit, range and source are told by traffic_parameters(); set by `--set traffic.NAME=X`.
/// All are doubles.
struct TrafficParameters {
  // how fast somebody is that stands, creeps, drives
  double moving_speed = 0.1;
  double standing_speed = 0.3;
  double halting_speed = 0.6;
  double crawling_speed = 1.0;
  double rolling_speed = 2.0;
  double queue_speed = 3.0;
  double flow_speed = 8.0;
  double slow_walk = 0.48;
  double drift_speed = 0.15;
  double lateral_speed = 0.8;
  double swift_lateral_speed = 1.4;

  // patience: where its levels begin
  double waiting = 2.0;
  double impatient = 5.0;
  double pressing = 10.0;
  double stuck = 20.0;
  double desperate = 40.0;
  double hopeless = 90.0;
  double walker_forgets = 10.0;
  double walker_creeping = 0.3;
  double impatient_gap_share = 0.4;

  // how far ahead in time
  double reaction_time = 0.3;
  double look_period = 0.4;
  double soon = 3.0;
  double outlook = 4.0;
  double merging_outlook = 10.0;
  double filtering_outlook = 20.0;

  // time gaps
  double time_gap = 1.0;
  double walker_time_gap = 2.0;
  double overtaking_time_gap = 3.5;
  double overtaking_time = 6.0;
  double flowing_headway = 0.75;

  // signals
  double amber_time = 2.5;
  double clearance_time = 20.0;

  // braking that is asked of others, and taking up speed
  double easy_braking = 1.5;
  double courtesy_braking = 2.0;
  double pressed_braking = 3.5;
  double throttle_jerk = 2.4;
  double gap_closing_rate = 0.5;

  // lengths along the way
  double line_tolerance = 0.3;
  double least_gap = 0.5;
  double stop_margin = 0.6;
  double closed_up_gap = 1.0;
  double waiting_room = 2.0;
  double near_line = 2.5;
  double near = 5.0;
  double soon_way = 10.0;
  double nearby = 20.0;
  double junction_outlook = 40.0;
  double queue_outlook = 80.0;
  double sight = 300.0;
  double nose_room_share = 0.6;
  double steepest_aim = 1.8;
  double straight = 0.985;
  double slack = 1.3;

  // widths beside the way
  double touching = 0.05;
  double tight_side = 0.18;
  double side_clearance = 0.3;
  double ample_side = 0.6;
  double overtaking_gap = 1.3;
  double farthest_aside = 2.3;
  double filtering_clearance = 0.23;
  double filtering_rate = 25.0;
  double lock_share = 0.55;

  // worth a change of lane, of place or of route
  double worthwhile_gain = 1.0;
  double small_gain = 0.3;
  double nearly_as_well = 2.0;
  double not_as_easily = 10.0;
  double queued_vehicle_time = 5.0;

  // recovery
  double backing_time = 12.0;
  double giving_way_time = 5.0;
  double giving_way_spread = 18.0;

  // on foot
  double footstep = 0.5;
  double walking_aside = 1.5;
  double sidestep_cost = 0.15;
  double shut_share = 0.3;
  double open_share = 0.6;
  double free_share = 0.95;

  // how finely ways are sampled
  double fine_step = 0.25;
  double sampling_step = 0.5;
  double path_step = 2.0;
};

/// What one parameter is.
struct TrafficParameter {
  std::string_view name, unit;
  double TrafficParameters::*value;
  double least, most;        ///< admitted
  std::string_view meaning;  ///< with its source where it has one; a clause for a table
};

/// One entry a parameter, in the order of the struct.
std::span<const TrafficParameter> traffic_parameters();

/// The parameters' table for docs/rules/parameters.md, in Markdown.
std::string traffic_parameter_table();

}  // namespace sumogamma
