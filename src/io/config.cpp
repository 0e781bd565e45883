#include "io/config.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "base/edit_distance.h"
#include "base/error.h"
#include "io/output_file.h"

namespace sumogamma {

namespace {

constexpr double kAny = -std::numeric_limits<double>::infinity();

/// A word for one value of an enumeration.
template <typename Enum>
struct Choice {
  Enum* target;
  std::vector<std::pair<std::string, Enum>> words;
};

/// A key and where its value goes. Numbers must be finite, at least `least`, or above it where
/// `open`, and at most `most`.
struct Binding {
  std::string key;
  std::variant<double*, int*, bool*, std::string*, std::vector<double>*, Choice<Kinematics>,
               Choice<PairHorizon>, Choice<BehaviorPreset>>
      target;
  double least = kAny;
  bool open = false;
  double most = std::numeric_limits<double>::infinity();
};

struct TypeField {
  const char* name;
  double AgentType::*member;
  double least;
  bool open;
};

constexpr std::array kTypeFields{
    TypeField{"length", &AgentType::length, 0, true},
    TypeField{"width", &AgentType::width, 0, true},
    TypeField{"wheelbase", &AgentType::wheelbase, 0, true},
    TypeField{"rear_axle_to_center", &AgentType::rear_axle_to_center, 0, false},
    TypeField{"max_steering", &AgentType::max_steering, 0, true},
    TypeField{"max_steering_rate", &AgentType::max_steering_rate, 0, true},
    TypeField{"max_speed", &AgentType::max_speed, 0, true},
    TypeField{"preferred_speed", &AgentType::preferred_speed, 0, true},
    TypeField{"max_acceleration", &AgentType::max_acceleration, 0, true},
    TypeField{"comfortable_deceleration", &AgentType::comfortable_deceleration, 0, true},
    TypeField{"max_deceleration", &AgentType::max_deceleration, 0, true},
    TypeField{"max_lateral_acceleration", &AgentType::max_lateral_acceleration, 0, true},
    TypeField{"tracking_error", &AgentType::tracking_error, 0, true},
    TypeField{"horizon", &AgentType::horizon, 0, true},
    TypeField{"attention_front", &AgentType::attention_front, 0, false},
    TypeField{"attention_rear", &AgentType::attention_rear, 0, false},
    TypeField{"headway", &AgentType::headway, 0, false},
    TypeField{"min_gap", &AgentType::min_gap, 0, false},
    TypeField{"critical_gap", &AgentType::critical_gap, 0, false},
};

struct ComplianceField {
  const char* name;
  double Compliance::*member;
  bool share;  ///< from 0 to 1
};

constexpr std::array kComplianceFields{
    ComplianceField{"red_light_running", &Compliance::red_light_running, true},
    ComplianceField{"yielding_rate", &Compliance::yielding_rate, true},
    ComplianceField{"jaywalking_rate", &Compliance::jaywalking_rate, true},
    ComplianceField{"rolling_stops", &Compliance::rolling_stops, true},
    ComplianceField{"creeping", &Compliance::creeping, true},
    ComplianceField{"speed_factor", &Compliance::speed_factor, false},
    ComplianceField{"speed_factor_deviation", &Compliance::speed_factor_deviation, false},
    ComplianceField{"free_speed", &Compliance::free_speed, false},
    ComplianceField{"free_speed_spread", &Compliance::free_speed_spread, false},
    ComplianceField{"headway_deviation", &Compliance::headway_deviation, false},
    ComplianceField{"place_deviation", &Compliance::place_deviation, false},
    ComplianceField{"responsibility_least", &Compliance::responsibility_least, true},
    ComplianceField{"responsibility_most", &Compliance::responsibility_most, true},
    ComplianceField{"attention_least", &Compliance::attention_least, false},
    ComplianceField{"attention_most", &Compliance::attention_most, false},
};

void bind_model(ModelOptions& model, std::vector<Binding>& bindings) {
  bindings.push_back({"model.use_kinematics", &model.use_kinematics});
  bindings.push_back({"model.use_polygons", &model.use_polygons});
  bindings.push_back({"model.use_avoidance", &model.use_avoidance});
  // keep_left isn't here: the network says on which side traffic keeps
  bindings.push_back({"model.use_guard", &model.use_guard});
  bindings.push_back({"model.take_detours", &model.take_detours});
  bindings.push_back({"model.guard_margin", &model.guard_margin, 0});
  bindings.push_back({"model.pass_as_intended", &model.pass_as_intended});
  bindings.push_back({"model.look_aside", &model.look_aside});
  bindings.push_back({"model.creep_when_held", &model.creep_when_held});
  bindings.push_back({"model.constrain_safe_pairs", &model.constrain_safe_pairs});
  bindings.push_back({"model.share_responsibility", &model.share_responsibility});
  bindings.push_back(
      {"model.pair_horizon", Choice<PairHorizon>{&model.pair_horizon,
                                                 {{"own", PairHorizon::Own},
                                                  {"shortest", PairHorizon::Shortest},
                                                  {"longest", PairHorizon::Longest}}}});
  bindings.push_back({"model.separation_time", &model.separation_time, 0, true});
  bindings.push_back({"model.margin_time", &model.margin_time, 0, true});
  bindings.push_back({"model.walker_separation_time", &model.walker_separation_time, 0, true});
  bindings.push_back({"model.front_margin", &model.front_margin, 0});
  bindings.push_back({"model.rear_margin", &model.rear_margin, 0});
  bindings.push_back({"model.side_margin", &model.side_margin, 0});
  bindings.push_back({"model.walker_margin", &model.walker_margin, 0});
}

void bind_ego(EgoSettings& ego, std::vector<Binding>& bindings) {
  bindings.push_back({"ego.vehicle", &ego.vehicle});
  bindings.push_back({"ego.type", &ego.type});
  bindings.push_back({"ego.window", &ego.window});
  bindings.push_back({"ego.goal_edge", &ego.goal_edge});
  bindings.push_back({"ego.goal_at", &ego.goal_at, 0});
  bindings.push_back({"ego.goal_way", &ego.goal_way, 0});
  bindings.push_back({"ego.max_speed", &ego.max_speed, 0, true});
  bindings.push_back({"ego.accelerations", &ego.accelerations});
  bindings.push_back({"ego.rate", &ego.rate, 0, true});
  bindings.push_back({"ego.planner", &ego.planner});
  bindings.push_back({"ego.agents_seen", &ego.agents_seen, 1, false, 1000});
  bindings.push_back({"ego.scenarios", &ego.scenarios, 1, false, 10000});
  bindings.push_back({"ego.depth", &ego.depth, 1, false, 1000});
  bindings.push_back({"ego.trees", &ego.trees, 1, false, 2});
  bindings.push_back({"ego.scene_steps", &ego.scene_steps, 1, false, 1e9});
  bindings.push_back({"ego.deadline", &ego.deadline, 0, false, 1e6});
  bindings.push_back({"ego.trusted", &ego.trusted});
  bindings.push_back({"ego.emergency_brake", &ego.emergency_brake});
  bindings.push_back({"ego.warm_up", &ego.warm_up, 0, false, 1e6});
  bindings.push_back({"ego.clearance", &ego.clearance, 0});
  bindings.push_back({"ego.limit", &ego.limit, 0, true, 1e6});
}

void bind_demand(ScenarioConfig& config, std::vector<Binding>& bindings) {
  DemandSettings& demand = config.demand;
  for (std::size_t row = demand.shares.size(); row < config.types.size(); ++row)
    demand.shares.push_back({config.types[row].name, 0});
  bindings.push_back({"demand.agents", &demand.agents, 1, false, 1e6});
  bindings.push_back({"demand.profile", &demand.profile, 0});
  bindings.push_back({"demand.window", &demand.window, -180, false, 180});
  bindings.push_back({"demand.od", &demand.od});
  bindings.push_back({"demand.counts", &demand.counts});
  bindings.push_back({"demand.public_transport", &demand.public_transport});
  bindings.push_back({"demand.headway", &demand.headway, 30, false, 86400});
  bindings.push_back({"demand.riders", &demand.riders, 0, false, 1e6});
  for (DemandShare& share : demand.shares)
    bindings.push_back({"demand.shares." + share.type, &share.share, 0});
}

void bind_preset(BehaviorPreset& preset, std::vector<Binding>& bindings) {
  Choice<BehaviorPreset> choice{&preset, {}};
  for (const BehaviorPreset one : kBehaviorPresets) choice.words.emplace_back(name_of(one), one);
  bindings.push_back({"behavior.preset", choice});
}

std::vector<Binding> bind_all(ScenarioConfig& config) {
  std::vector<Binding> bindings{
      {"scenario.name", &config.name},
      {"scenario.map", &config.map},
      {"scenario.bbox", &config.bbox},
      {"scenario.attribution", &config.attribution},
      {"run.agents", &config.agents, 1},
      {"run.on_foot", &config.on_foot, 0, false, 1},
      {"run.duration", &config.duration, 0, true},
      {"run.step", &config.step, 0, true},
      {"run.control", &config.control},
      {"run.backend", &config.backend},
  };
  bind_preset(config.preset, bindings);
  bind_model(config.model, bindings);
  bind_demand(config, bindings);
  bind_ego(config.ego, bindings);
  bindings.push_back({"traffic.turn_on_red", &config.code.turn_on_red});
  for (const TrafficParameter& one : traffic_parameters())
    bindings.push_back({"traffic." + std::string(one.name), &(config.traffic.*one.value), one.least,
                        false, one.most});
  for (AgentType& type : config.types) {
    const std::string prefix = "types." + type.name + ".";
    bindings.push_back({prefix + "sumo_class", &type.sumo_class});
    bindings.push_back(
        {prefix + "kinematics", Choice<Kinematics>{&type.kinematics,
                                                   {{"holonomic", Kinematics::Holonomic},
                                                    {"single_track", Kinematics::SingleTrack}}}});
    for (const TypeField& field : kTypeFields)
      bindings.push_back({prefix + field.name, &(type.*field.member), field.least, field.open});
    for (const ComplianceField& field : kComplianceFields)
      bindings.push_back({prefix + field.name, &(type.compliance.*field.member), 0, false,
                          field.share ? 1.0 : std::numeric_limits<double>::infinity()});
  }
  return bindings;
}

/// One document (the file, or one override): knows how to name a place in it.
class Document {
 public:
  Document(std::string origin, bool has_lines)
      : origin_(std::move(origin)), has_lines_(has_lines) {}

  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw Error(has_lines_ ? origin_ + ":" + std::to_string(node.source().begin.line) : origin_,
                what);
  }

  /// Rows for [types.NAME] that name a base: they must exist before their fields can be bound.
  void add_types(const toml::table& root, AgentTypeTable& types) const {
    const toml::node* node = root.get("types");
    if (!node) return;
    if (!node->is_table()) fail(*node, "'types' must be a table of types, [types.NAME]");
    for (const auto& [key, value] : *node->as_table()) {
      const std::string name(key.str());
      if (!value.is_table())
        fail(value, "'types." + name + "' must be a table, [types." + name + "]");
      const bool known = std::any_of(types.begin(), types.end(),
                                     [&](const AgentType& t) { return t.name == name; });
      const toml::node* base = value.as_table()->get("base");
      if (known) {
        if (base)
          fail(*base,
               "'types." + name + ".base': the type '" + name + "' exists already, leave base out");
        continue;
      }
      if (!base || !base->is_string())
        fail(value,
             "unknown type '" + name + "', a new type needs base = \"car\" or another known type");
      AgentType type;
      try {
        type = type_of(types, find_agent_type(types, base->value<std::string>().value()));
      } catch (const Error& error) {
        fail(*base, error.what());
      }
      type.name = name;
      types.push_back(std::move(type));
    }
  }

  /// [[control]]: who is driven, where and when.
  void read_rules(const toml::table& root, std::vector<ControlRule>& rules) const {
    const toml::node* node = root.get("control");
    if (!node) return;
    if (!node->is_array_of_tables()) fail(*node, "'control' must be rules, each under [[control]]");
    for (const toml::node& rule : *node->as_array()) rules.push_back(read_rule(*rule.as_table()));
  }

  ControlRule read_rule(const toml::table& table) const {
    ControlRule rule;
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (name == "who") {
        rule.who = texts_of(value, name);
      } else if (name == "share") {
        rule.share = number_in(value, name, 0.0, 1.0);
      } else if (name == "area") {
        read_area(value, rule);
      } else if (name == "around") {
        if (!value.is_string()) fail(value, "'around' must be an agent's id in quotes");
        rule.around = value.value<std::string>().value();
      } else if (name == "radius") {
        rule.radius = number_in(value, name, 0.0, 1e6);
      } else if (name == "from") {
        rule.from = number_in(value, name, -1e9, 1e9);
      } else if (name == "to") {
        rule.to = number_in(value, name, -1e9, 1e9);
      } else {
        fail(value, "unknown key '" + name +
                        "' of a control rule, expected who, share, area, around, radius, from, to");
      }
    }
    if (rule.around.empty() != (rule.radius <= 0.0))
      fail(table, "a circle needs both, around = \"ID\" and a radius above 0");
    if (rule.from >= rule.to) fail(table, "'from' must be before 'to'");
    return rule;
  }

  void apply(const toml::table& table, const std::string& prefix,
             const std::vector<Binding>& bindings,
             std::map<std::string, std::string>& given) const {
    for (const auto& [key, value] : table) {
      const std::string full = prefix + std::string(key.str());
      if (full == "control") continue;  // read_rules
      if (value.is_table()) {
        apply(*value.as_table(), full + ".", bindings, given);
        continue;
      }
      // consumed by add_types
      if (full.rfind("types.", 0) == 0 && key.str() == "base") continue;
      const auto found = std::find_if(bindings.begin(), bindings.end(),
                                      [&](const Binding& b) { return b.key == full; });
      if (found == bindings.end()) {
        const auto nearest =
            nearest_named(full, bindings, [](const Binding& binding) { return binding.key; });
        fail(value, "unknown key '" + full + "', the nearest known one is '" + nearest->key + "'");
      }
      assign_to(value, *found);
      given[full] = has_lines_ ? "scenario.toml" : "command line";
    }
  }

  void assign_to(const toml::node& node, const Binding& binding) const {
    std::visit([&](const auto& target) { assign(node, binding, target); }, binding.target);
  }

 private:
  std::vector<std::string> texts_of(const toml::node& node, const std::string& name) const {
    std::vector<std::string> texts;
    if (node.is_string()) {
      texts.push_back(node.value<std::string>().value());
    } else if (node.is_array()) {
      for (const toml::node& one : *node.as_array()) {
        if (!one.is_string()) fail(one, "'" + name + "' must hold texts in quotes alone");
        texts.push_back(one.value<std::string>().value());
      }
    }
    if (texts.empty()) fail(node, "'" + name + "' must be a text in quotes, or a list of such");
    return texts;
  }
  double number_in(const toml::node& node, const std::string& name, double least,
                   double most) const {
    const double value = node.is_number() ? node.value<double>().value() : std::nan("");
    if (value >= least && value <= most) return value;
    fail(node, fmt::format("'{}' must be a number from {:g} to {:g}", name, least, most));
  }
  /// Numbers x0, y0, x1, y1 of a box or x, y, x, y, x, y, ... of a ring, or where polygons stand.
  void read_area(const toml::node& node, ControlRule& rule) const {
    if (node.is_string()) {
      rule.area_file = node.value<std::string>().value();
      return;
    }
    std::vector<double> numbers;
    if (node.is_array())
      for (const toml::node& one : *node.as_array())
        numbers.push_back(number_in(one, "area", -1e9, 1e9));
    rule.areas.push_back(ring_of(numbers));
    if (rule.areas.back().empty())
      fail(node,
           "'area' must be [x0, y0, x1, y1] of a box, the points of a ring, or "
           "\"FILE#POLYGON\"");
  }

  void check_range(const toml::node& node, const Binding& binding, double value) const {
    const bool fits = std::isfinite(value) && value <= binding.most &&
                      (binding.open ? value > binding.least : value >= binding.least);
    if (fits) return;
    const std::string range =
        binding.least == kAny ? "that is finite"
        : std::isfinite(binding.most)
            ? fmt::format("from {:g} to {:g}", binding.least, binding.most)
            : fmt::format("{} {:g}", binding.open ? "above" : "of at least", binding.least);
    fail(node, "'" + binding.key + "' must be a number " + range);
  }

  void assign(const toml::node& node, const Binding& binding, double* target) const {
    if (!node.is_number()) fail(node, "'" + binding.key + "' must be a number");
    *target = node.value<double>().value();
    check_range(node, binding, *target);
  }
  void assign(const toml::node& node, const Binding& binding, int* target) const {
    const auto value = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
    if (!value || *value > std::numeric_limits<int>::max() ||
        *value < std::numeric_limits<int>::min())
      fail(node, "'" + binding.key + "' must be a whole number");
    *target = static_cast<int>(*value);
    check_range(node, binding, *target);
  }
  void assign(const toml::node& node, const Binding& binding, bool* target) const {
    if (!node.is_boolean()) fail(node, "'" + binding.key + "' must be true or false");
    *target = node.value<bool>().value();
  }
  void assign(const toml::node& node, const Binding& binding, std::string* target) const {
    if (!node.is_string()) fail(node, "'" + binding.key + "' must be a text in quotes");
    *target = node.value<std::string>().value();
  }
  void assign(const toml::node& node, const Binding& binding, std::vector<double>* target) const {
    const toml::array* const list = node.as_array();
    if (list == nullptr) fail(node, "'" + binding.key + "' must be a list of numbers, [1, 2]");
    target->clear();
    for (const toml::node& one : *list) {
      if (!one.is_number()) fail(one, "'" + binding.key + "' must hold numbers alone");
      target->push_back(one.value<double>().value());
      check_range(one, binding, target->back());
    }
  }
  template <typename Enum>
  void assign(const toml::node& node, const Binding& binding, const Choice<Enum>& choice) const {
    const auto word = node.value<std::string>();
    std::string known;
    for (const auto& [name, value] : choice.words) {
      if (word && *word == name) {
        *choice.target = value;
        return;
      }
      known += (known.empty() ? "\"" : ", \"") + name + "\"";
    }
    fail(node, "'" + binding.key + "' must be one of " + known);
  }

  std::string origin_;
  bool has_lines_;
};

void apply_document(const Document& document, const toml::table& root, ScenarioConfig& config) {
  document.add_types(root, config.types);
  document.read_rules(root, config.rules);
  document.apply(root, "", bind_all(config), config.given);
}

/// "key=value" as TOML; a value that is no TOML by itself is taken as text, so that quotes aren't
/// needed in a shell.
toml::table parse_override(const std::string& text) {
  const std::size_t cut = text.find('=');
  if (cut == std::string::npos || cut == 0) throw Error("--set " + text, "expected KEY=VALUE");
  const std::string key = text.substr(0, cut), value = text.substr(cut + 1);
  try {
    return toml::parse(key + " = " + value);
  } catch (const toml::parse_error&) {
  }
  try {
    toml::table table = toml::parse(key + " = \"\"");
    toml::node* node = &table;
    while (node->is_table()) node = &node->as_table()->begin()->second;
    *node->as_string() = value;
    return table;
  } catch (const toml::parse_error&) {
    throw Error("--set " + text, "'" + key + "' is no key, expected one such as types.car.headway");
  }
}

/// Levels of patience that don't follow one another would be skipped without a word.
void check_patience(const ScenarioConfig& config) {
  const TrafficParameters& t = config.traffic;
  const std::array levels{t.waiting, t.impatient, t.pressing, t.stuck, t.desperate, t.hopeless};
  constexpr std::array kNames{"waiting", "impatient", "pressing", "stuck", "desperate", "hopeless"};
  for (std::size_t k = 1; k < levels.size(); ++k) {
    if (levels[k] > levels[k - 1]) continue;
    // the defaults are in order: one of the two was given
    auto given = config.given.find(fmt::format("traffic.{}", kNames[k]));
    if (given == config.given.end())
      given = config.given.find(fmt::format("traffic.{}", kNames[k - 1]));
    throw Error(given->second,
                fmt::format("traffic.{} = {} has to be more than traffic.{} = {}: these levels of "
                            "patience follow one another",
                            kNames[k], levels[k], kNames[k - 1], levels[k - 1]));
  }
}

}  // namespace

ControlRule parse_control_rule(const std::string& text) {
  const Document document("--take " + text, false);
  try {
    const toml::table table = toml::parse("rule = {" + text + "}");
    return document.read_rule(*table.get("rule")->as_table());
  } catch (const toml::parse_error& error) {
    throw Error("--take " + text, "isn't like 'who = [\"car\"], share = 0.3, from = 60' (" +
                                      std::string(error.description()) + ")");
  }
}

ScenarioConfig read_config(const std::filesystem::path& file,
                           std::span<const std::string> overrides) {
  std::vector<std::pair<Document, toml::table>> documents;
  if (!file.empty()) {
    const std::string content = read_file(file);
    try {
      documents.emplace_back(Document(file.string(), true), toml::parse(content));
    } catch (const toml::parse_error& error) {
      throw Error(file.string() + ":" + std::to_string(error.source().begin.line),
                  "not TOML (" + std::string(error.description()) + ")");
    }
  }
  for (const std::string& text : overrides)
    documents.emplace_back(Document("--set " + text, false), parse_override(text));

  ScenarioConfig config;
  // the last word on the preset counts, and comes before what is said of single types
  std::vector<Binding> preset;
  bind_preset(config.preset, preset);
  for (const auto& [document, root] : documents)
    if (const toml::node* node = root.at_path("behavior.preset").node())
      document.assign_to(*node, preset.front());
  apply_preset(config.preset, config.types);
  for (const auto& [document, root] : documents) apply_document(document, root, config);
  check_patience(config);
  return config;
}

}  // namespace sumogamma
