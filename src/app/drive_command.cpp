#include "app/command.h"
#include "app/drive_options.h"
#include "app/validators.h"
#include "ego/planners.h"
#include "scene/behavior_preset.h"

namespace sumogamma {

namespace {

/// What is driven, and in which world.
void add_world_options(CLI::App& command, DriveOptions& options) {
  RunOptions& run = options.run;
  command
      .add_option("SCENARIO", run.scenario, "folder made by 'sumo-gamma import', or any .sumocfg")
      ->required();
  command.add_option("-o,--output", run.output, "folder for the episodes and their tables")
      ->required();
  command
      .add_option("--seeds", options.seeds, "A..B, one, or several with commas: an episode each")
      ->capture_default_str();
  command.add_option("--shard", options.shard, "i/n: the i-th of n parts of the seeds, from 1 on");
  command.add_option("--merge", options.merge,
                     "folders of the same drive: what they have done is taken over");
  command.add_option("--replay", options.replay, "seeds of which a replay page is written");
  command.add_option(
      "--reference", options.reference,
      "a drive by the planner gamma, whose way on the same seed counts as all of it");
  command.add_option("--step", run.step, "step length [s]")->check(finite_number());
  command.add_option("--agents", run.agents, "agents to keep alive, people on foot included")
      ->check(whole_number(1, 1000000));
  command
      .add_option("--control", run.control,
                  "who else is driven by GAMMA: all, none, types, vTypes, ids, patterns")
      ->delimiter(',');
  command
      .add_option(
          "--preset", run.preset,
          "how people behave: compliant, observed, interaction or unregulated (nobody keeps "
          "any rule)")
      ->check(CLI::IsMember(preset_names()));
  command
      .add_option("--backend", run.backend,
                  "traci (SUMO as a child process) or libsumo (in process)")
      ->check(CLI::IsMember({"traci", "libsumo"}));
  command.add_option("--sumo-options", run.sumo_options, "further options for SUMO, in quotes");
  command.add_flag("--no-cache", run.no_cache, "work out anew what follows from the network");
}

/// Who drives, from where to where.
void add_ego_options(CLI::App& command, DriveOptions& options) {
  std::string names;
  for (const PlannerEntry& entry : planners())
    names += (names.empty() ? "" : "; ") + std::string(entry.name) + ": " + std::string(entry.what);
  command.add_option("--planner", options.planner, names);
  command.add_option("--ego", options.address,
                     "unix:PATH or HOST:PORT where a planner of your own joins (docs/ego.md)");
  command.add_flag("--ego-anywhere", options.anywhere,
                   "HOST needn't be this machine's loopback: whoever reaches it may drive");
  command
      .add_option("--ego-deadline", options.limits.answer,
                  "for an action of such a planner, then the ego brakes fully [s]")
      ->check(finite_number(0.001, 1e6))
      ->capture_default_str();
  command
      .add_option("--ego-wait", options.limits.join, "for one to join and to begin an episode [s]")
      ->check(finite_number(0.001, 1e6))
      ->capture_default_str();
  command.add_option("--vehicle", options.vehicle, "the ego is this vehicle of the demand");
  command.add_option("--type", options.type, "agent type of an ego whose start is drawn");
  command
      .add_option("--window", options.window,
                  "X0,Y0,X1,Y1: where it starts [m] (default: anywhere)")
      ->delimiter(',')
      ->check(finite_number());
  command.add_option("--goal-edge", options.goal_edge, "edge that it makes for");
  command.add_option("--goal-way", options.goal_way, "or the length of its way, drawn [m]")
      ->check(finite_number());
  command.add_option("--max-speed", options.max_speed, "of the ego [m/s]")
      ->check(finite_number(0.1, 100.0));
  command
      .add_option("--deadline", options.deadline,
                  "of a search on the clock [s]: plans that it cuts short can't be repeated")
      ->check(finite_number(0.001, 1e6));
  command.add_flag("--untrusted", options.untrusted,
                   "others don't count on the ego to do its share");
  command.add_flag("--emergency-brake", options.emergency_brake,
                   "it brakes fully, whatever it plans, where it would hit somebody");
}

}  // namespace

CommandRunner add_drive_command(CLI::App& parent) {
  auto options = std::make_shared<DriveOptions>();
  CLI::App* command = parent.add_subcommand(
      "drive", "episodes of an ego among the others, by a planner in the box or one of yours");
  add_world_options(*command, *options);
  add_ego_options(*command, *options);
  return [options](const CommonOptions& common) { return drive_session(*options, common); };
}

}  // namespace sumogamma
