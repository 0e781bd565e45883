#include <algorithm>

#include "app/command.h"
#include "app/run_session.h"
#include "app/validators.h"
#include "base/error.h"
#include "io/trajectory_tables.h"
#include "scene/behavior_preset.h"

namespace sumogamma {

namespace {

/// What is run, and who is driven.
void add_scenario_options(CLI::App& command, RunOptions& options) {
  command
      .add_option("SCENARIO", options.scenario,
                  "folder made by 'sumo-gamma import', or any .sumocfg")
      ->required();
  command
      .add_option("-o,--output", options.output, "folder for results.json, trajectories and replay")
      ->required();
  command.add_option("--step", options.step, "step length [s]")->check(finite_number());
  command.add_option("--duration", options.duration, "simulated time: seconds or h:m:s")
      ->transform(time_span());
  command
      .add_option("--agents", options.agents,
                  "agents to keep alive, people on foot included; at the most a tenth more")
      ->check(whole_number(1, 1000000));
  command
      .add_option("--control", options.control,
                  "who is driven by GAMMA: all, none, called (whom another client asks for), or "
                  "agent types, vTypes, ids, patterns (bus*), a share (30%)")
      ->delimiter(',');
  command
      .add_option("--region", options.region,
                  "of these only who is in this box, or ring, of the network: X0,Y0,X1,Y1[,...] "
                  "[m]; who leaves it is SUMO's again")
      ->delimiter(',')
      ->expected(4, 1000)
      ->check(finite_number());
  command
      .add_option("--take", options.take,
                  "a rule as under [[control]] in scenario.toml, such as 'who = [\"car\"], "
                  "around = \"bus.1\", radius = 50, from = 60'; may be given several times")
      ->take_all();
}

/// How people behave, and which SUMO moves with them.
void add_sumo_options(CLI::App& command, RunOptions& options) {
  command
      .add_option("--backend", options.backend,
                  "traci (SUMO as a child process) or libsumo (in process)")
      ->check(CLI::IsMember({"traci", "libsumo"}));
  command
      .add_option("--preset", options.preset,
                  "how people behave: compliant (keep every rule), observed (as recorded), "
                  "interaction (drivers of cars as in those recordings) or unregulated (nobody "
                  "keeps any rule)")
      ->check(CLI::IsMember(preset_names()));
  command.add_option("--connect", options.connect,
                     "HOST:PORT of a SUMO or sumo-gui started with --remote-port");
  command
      .add_option("--num-clients", options.clients,
                  "TraCI clients that SUMO waits for, this run included")
      ->check(whole_number(1, 100));
  command
      .add_option("--client-order", options.client_order,
                  "place of this run among SUMO's TraCI clients: lower ones act first")
      ->check(whole_number(0, 1000000));
  command
      .add_option("--remote-port", options.remote_port,
                  "port on which SUMO waits for further clients (default: any free one)")
      ->check(whole_number(1, 65535));
  command.add_flag("--convert", options.convert,
                   "run on a copy of the network without the vehicle classes of a newer SUMO");
  command.add_flag("--no-cache", options.no_cache,
                   "work out anew what follows from the network, and keep none of it in "
                   "$XDG_CACHE_HOME/sumo-gamma for the next run");
  command.add_flag("--force", options.force, "replace what another run left in the folder");
  command.add_option("--sumo-options", options.sumo_options, "further options for SUMO, in quotes");
  command.add_flag("--gui", options.gui,
                   "show the run in sumo-gui, no faster than the clock (--sumo-options \"--delay "
                   "MS\"), whom GAMMA drives in the color of what binds them");
}

/// What is measured and written.
void add_output_options(CLI::App& command, RunOptions& options) {
  command.add_flag("--predict", options.predict,
                   "predict everybody 4.8 s ahead and score it against what they then do");
  command.add_flag("--replay", options.replay, "write replay.html");
  command
      .add_option("--inspect", options.inspect,
                  "record the velocity spaces of these agents, 16 at once at the most, for the "
                  "replay: ids, patterns (bus*), agent types, a share (2%)")
      ->delimiter(',');
  command
      .add_option("--serve", options.serve,
                  "show the replay page live while the run goes on, at 127.0.0.1 alone, on this "
                  "port (default: any free one)")
      ->check(whole_number(0, 65535))
      ->expected(0, 1)
      ->default_str("0");
  command
      .add_option("--trajectory-period", options.trajectory_period,
                  "time between recorded trajectory points [s], 0: every step")
      ->check(finite_number(0.0, 1e6))
      ->capture_default_str();
  command
      .add_option(
          "--trajectories", options.trajectories,
          "formats of trajectories: fcd, csv, parquet, or none; CSV and Parquet are tables, "
          "vehicles and persons apart")
      ->delimiter(',')
      ->check(CLI::IsMember({"fcd", "csv", "parquet", "none"}));
  command
      .add_option(
          "--trajectory-columns", options.trajectory_columns,
          "columns of the tables (default: all): time, id, type, x, y, angle, speed, place, "
          "pos, slope")
      ->delimiter(',')
      ->check(CLI::IsMember(trajectory_columns()));
  command
      .add_option("--interval", options.interval,
                  "time over which lanes.csv and traffic.csv sum up [s]")
      ->check(finite_number(1.0, 1e6))
      ->capture_default_str();
  command
      .add_option(
          "--fail-on", options.fail_on,
          "exit 1 where this happened: collision, deep-collision, red-light, stuck, removed")
      ->delimiter(',')
      ->check(CLI::IsMember({"collision", "deep-collision", "red-light", "stuck", "removed"}));
}

void add_all_options(CLI::App& command, RunOptions& options) {
  add_scenario_options(command, options);
  add_sumo_options(command, options);
  add_output_options(command, options);
}

}  // namespace

RunOptions parse_run_words(const std::string& where, const std::filesystem::path& scenario,
                           const std::vector<std::string>& words) {
  CLI::App parser;
  RunOptions options;
  add_all_options(parser, options);
  std::vector<std::string> all{scenario.string(), "--output", "."};
  all.insert(all.end(), words.begin(), words.end());
  std::reverse(all.begin(), all.end());
  try {
    parser.parse(all);
  } catch (const CLI::ParseError& error) {
    throw Error(where, std::string(error.what()) + "; sumo-gamma run --help has the options");
  }
  return options;
}

CLI::App& add_run_options(CLI::App& parent, RunOptions& options) {
  CLI::App* command =
      parent.add_subcommand("run", "drive a scenario: GAMMA moves the agents, SUMO does the rest");
  add_all_options(*command, options);
  return *command;
}

CommandRunner add_run_command(CLI::App& parent) {
  auto options = std::make_shared<RunOptions>();
  add_run_options(parent, *options);
  return [options](const CommonOptions& common) { return run_session(*options, common); };
}

}  // namespace sumogamma
