#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "demand/demand_settings.h"
#include "ego/ego_settings.h"
#include "model/model.h"
#include "scene/agent_type.h"
#include "scene/behavior_preset.h"
#include "scene/traffic_code.h"
#include "sumo/control_choice.h"
#include "traffic/parameters.h"

namespace sumogamma {

/// What scenario.toml says: docs/scenario.md lists the keys. Everything has a default, so an empty
/// file is valid.
struct ScenarioConfig {
  // [scenario]: what the importer notes about the place, for people and reports
  std::string name, map, bbox, attribution;
  // [run]: defaults of `sumo-gamma run`; its options win
  int agents = 100;       ///< to be alive; a tenth more at the most
  double on_foot = 0;     ///< share of people on foot among them, who come as the demand has them
  double duration = 600;  ///< [s]
  double step = 0.05;     ///< [s]
  std::string control = "all";
  std::vector<ControlRule> rules;  ///< [[control]]: instead of run.control where there are some
  std::string backend = "traci";
  // [behavior]
  BehaviorPreset preset = BehaviorPreset::Compliant;  ///< keys of types win over it
  // [model]
  ModelOptions model;
  // [traffic]
  TrafficParameters traffic;
  TrafficCode code;
  // [demand]: of `sumo-gamma import` and `sumo-gamma demand`
  DemandSettings demand;
  // [ego]: of `sumo-gamma drive`
  EgoSettings ego;
  // [types.NAME]: rows changed, or added with base = "car"
  AgentTypeTable types = default_agent_types();
  /// Keys that were set, and where: scenario.toml or the command line (--set).
  std::map<std::string, std::string> given;
};

/// One rule of who is driven, as [[control]] has it: "who = [\"car\"], share = 0.3, from = 60".
/// Throws Error naming `text`.
ControlRule parse_control_rule(const std::string& text);

/// Reads scenario.toml (an empty path: defaults alone) and applies overrides "key=value" in order,
/// later ones winning. The preset comes before all of [types.NAME], wherever it stands. Throws
/// Error naming file and line (or the override) for what isn't TOML, an unknown key (with the
/// nearest known one), a value of the wrong type or out of range, and a new type without a known
/// `base`.
ScenarioConfig read_config(const std::filesystem::path& file,
                           std::span<const std::string> overrides = {});

}  // namespace sumogamma
