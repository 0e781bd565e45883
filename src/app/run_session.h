#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"

namespace sumogamma {

/// Options of `sumo-gamma run`; unset ones come from scenario.toml.
struct RunOptions {
  std::filesystem::path scenario, output;
  std::optional<double> step, duration;  ///< [s]
  std::optional<long> agents;            ///< to be alive, a tenth more at the most
  std::vector<std::string> control;      ///< all | none | types and ids
  std::vector<double> region;            ///< of --region: a box or a ring [m]
  std::vector<std::string> take;         ///< rules of --take
  std::optional<std::string> backend;    ///< traci | libsumo
  std::optional<std::string> preset;     ///< compliant | observed
  std::string connect;                   ///< HOST:PORT of a SUMO that the user started
  int socket = -1;        ///< not negative: an open TraCI connection whose owner makes SUMO's steps
  bool own_loop = false;  ///< a Session's, whose owner may talk to libsumo by itself in between
  std::optional<int> client_order;  ///< our place among several TraCI clients
  int clients = 1;                  ///< that a SUMO of ours waits for, us included
  int remote_port = 0;              ///< on which it listens, 0: any
  bool convert = false;             ///< leave out classes that this SUMO doesn't know
  bool no_cache = false;            ///< work out anew what follows from the network
  bool force = false;               ///< replace what another run left in the output folder
  std::string sumo_options;
  bool gui = false, replay = false;
  std::vector<std::string> inspect;  ///< whose velocity spaces are recorded: as for control
  std::optional<int> serve;          ///< port of the live page, 0: any free one
  bool predict = false;              ///< predict everybody and score it against what then happens
  double trajectory_period = 0.5, replay_period = 0.1;  ///< [s]
  std::vector<std::string> trajectories{"fcd"};         ///< formats: fcd, csv, parquet; none
  std::vector<std::string> trajectory_columns;          ///< of tables; empty: all
  double interval = 300;                                ///< of lanes.csv and traffic.csv [s]
  std::vector<std::string> fail_on;  ///< collision, deep-collision, red-light, stuck, removed

  /// Is it about a SUMO that the user started?
  bool joins() const { return !connect.empty() || socket >= 0; }
};

/// Adds the command `run` with its options, which `options` then holds.
CLI::App& add_run_options(CLI::App& parent, RunOptions& options);

/// Options from words as they follow `run SCENARIO` on the command line. Throws Error naming
/// `where` for those that `run` doesn't know.
RunOptions parse_run_words(const std::string& where, const std::filesystem::path& scenario,
                           const std::vector<std::string>& words);

/// Runs a scenario to its end and writes everything into the output folder. Returns the exit code;
/// throws Error for bad input and SumoError where SUMO failed, after the outputs were completed.
int run_session(const RunOptions& options, const CommonOptions& common);

}  // namespace sumogamma
