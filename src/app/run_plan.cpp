#include "app/run_plan.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/edit_distance.h"
#include "base/error.h"
#include "base/number_text.h"
#include "road/sumo_net_reader.h"
#include "sumo/sumo_arguments.h"

namespace sumogamma {

namespace {

constexpr double kDefaultStep = 0.05, kShortestStep = 0.01, kLongestStep = 0.5;  // [s]
constexpr const char* kCommandLine = "command line";
constexpr const char* kConfiguration = "configuration";
constexpr const char* kDefault = "default";

/// Where `agents` are to be alive, 0 for as many as the demand has, how many may be vehicles. SUMO
/// can hold back vehicles alone: people come as the demand has them, and leave the vehicles their
/// share. A tenth more gets in: a bound at the mean would cut off every fluctuation, and who drives
/// more slowly would get less of the same demand.
std::size_t most_vehicles(long agents, double on_foot) {
  constexpr double kSlack = 1.1;
  if (agents <= 0) return 0;
  const long vehicles = std::lround(kSlack * static_cast<double>(agents) * (1.0 - on_foot));
  return static_cast<std::size_t>(std::max(vehicles, 1L));
}

constexpr std::size_t kMostRules = 32;

/// Types, ids and patterns, and a share of them such as "30%".
ControlRule rule_of_words(const std::string& option, const std::vector<std::string>& words) {
  ControlRule rule;
  for (const std::string& word : words) {
    if (word == "all" || word == "none" || word == "called")
      throw Error(option, "'" + word + "' stands alone, among types and ids it means nothing");
    if (word.empty() || word.back() != '%') {
      rule.who.push_back(word);
      continue;
    }
    double percent = -1.0;
    const char* const end = word.data() + word.size() - 1;
    const auto [stop, error] = std::from_chars(word.data(), end, percent);
    if (error != std::errc() || stop != end || !(percent >= 0.0 && percent <= 100.0))
      throw Error(option + " " + word.substr(0, 60), "must be a share from 0% to 100%");
    rule.share = percent / 100.0;
  }
  return rule;
}

/// Reads the polygons that a rule names: "FILE", "FILE#ID", or "#ID" of the scenario's own files.
void read_areas(const ScenarioInput& input, ControlRule& rule) {
  if (rule.area_file.empty()) return;
  const std::size_t hash = rule.area_file.find('#');
  const std::string file = rule.area_file.substr(0, hash);
  const std::string id = hash == std::string::npos ? "" : rule.area_file.substr(hash + 1);
  std::vector<std::filesystem::path> files = input.additional;
  if (!file.empty()) {
    const std::filesystem::path beside = input.config.parent_path() / file;
    files = {std::filesystem::exists(file) ? std::filesystem::path(file) : beside};
  }
  std::string known;
  for (const std::filesystem::path& one : files)
    for (auto& [name, ring] : read_polygons(one)) {
      if (id.empty() || name == id) rule.areas.push_back(std::move(ring));
      if (known.size() < 80) known += (known.empty() ? "" : ", ") + name;
    }
  if (rule.areas.empty())
    throw Error("area " + rule.area_file.substr(0, 200),
                "no polygon of that name" + (known.empty() ? "" : "; there are " + known));
}

/// Rules of the options, else of scenario.toml.
ControlChoice control_choice(const RunOptions& options, const ScenarioConfig& config,
                             const ScenarioInput& input, std::string& text) {
  ControlChoice control;
  std::vector<std::string> words = options.control;
  const bool region = !options.region.empty();
  if (words.empty() && !region && options.take.empty()) {
    control.rules = config.rules;
    if (config.rules.empty()) words = {config.control};
  }
  const std::vector<std::string> all{"all"}, none{"none"}, called{"called"};
  if (words == called) {
    ControlRule rule;
    rule.from = std::numeric_limits<double>::infinity();  // never by itself
    control.rules.push_back(std::move(rule));
  } else if ((!words.empty() && words != none) || (words.empty() && region)) {
    ControlRule rule =
        words.empty() || words == all ? ControlRule{} : rule_of_words("--control", words);
    if (region) {
      rule.areas.push_back(ring_of(options.region));
      if (rule.areas.back().empty())
        throw Error("--region", "must be X0,Y0,X1,Y1 of a box or X,Y of three points and more");
    }
    control.rules.push_back(std::move(rule));
  }
  for (const std::string& take : options.take) control.rules.push_back(parse_control_rule(take));
  if (control.rules.size() > kMostRules)
    throw Error("--take", "more than " + std::to_string(kMostRules) + " rules of who is driven");
  for (ControlRule& rule : control.rules) read_areas(input, rule);
  text.clear();
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  if (region) text += text.empty() ? "region" : " in a region";
  for (const std::string& take : options.take) text += (text.empty() ? "" : " or ") + take;
  if (text.empty()) text = "scenario.toml";
  return control;
}

/// SUMO counts whole milliseconds.
bool is_whole_milliseconds(double seconds) {
  return std::abs(1000.0 * seconds - std::round(1000.0 * seconds)) < 1e-6;
}

bool is_usable_step(double step) {
  return step >= kShortestStep && step <= kLongestStep && is_whole_milliseconds(step);
}

void choose_step(RunPlan& plan) {
  RunClock& clock = plan.clock;
  const auto given = plan.config.given.find("run.step");
  if (plan.options.step) {
    clock.step = *plan.options.step;
    clock.step_from = kCommandLine;
  } else if (given != plan.config.given.end()) {
    clock.step = plan.config.step;
    clock.step_from = given->second;
  } else if (plan.input.step_length && is_usable_step(*plan.input.step_length)) {
    clock.step = *plan.input.step_length;
    clock.step_from = kConfiguration;
  } else {
    clock.step = kDefaultStep;
    clock.step_from = kDefault;
  }
  if (is_usable_step(clock.step)) return;
  const std::string where = plan.options.step ? "--step " : "run.step ";
  throw Error(where + number_text(clock.step),
              "must be from 0.01 to 0.5 s and a multiple of 0.001 s: SUMO counts whole "
              "milliseconds");
}

void choose_end(RunPlan& plan) {
  RunClock& clock = plan.clock;
  const auto given = plan.config.given.find("run.duration");
  const auto end = plan.input.options.find("end");
  const bool end_on_command_line = end != plan.input.options.end() && end->second.on_command_line;
  const bool set = given != plan.config.given.end() && given->second == kCommandLine;
  auto after = [&](double duration, const std::string& from) {
    clock.end = clock.begin + duration;
    clock.end_from = from;
    plan.ends_after_duration = true;
  };
  // SUMO's -1: no end
  const bool has_end = plan.input.end && *plan.input.end >= 0.0;
  if (plan.options.duration) return after(*plan.options.duration, kCommandLine);
  if (set && !end_on_command_line) return after(plan.config.duration, kCommandLine);
  if (given != plan.config.given.end() && !end_on_command_line)
    return after(plan.config.duration, given->second);
  if (!has_end) return after(plan.config.duration, kDefault);
  clock.end = *plan.input.end;
  clock.end_from = end_on_command_line ? kCommandLine : kConfiguration;
}

void require_time_left(const RunPlan& plan) {
  if (plan.clock.end - plan.clock.begin >= plan.clock.step) return;
  throw Error(plan.input.config.string(), "ends at " + number_text(plan.clock.end) +
                                              " s, but begins at " + number_text(plan.clock.begin) +
                                              " s; give --duration");
}

/// A name that nobody answers to would drive nobody, without a word.
void require_known_names(const std::string& option, const std::set<std::string>& names,
                         const RunPlan& plan) {
  std::set<std::string> known = plan.inventory.types;
  for (const AgentType& type : plan.config.types) known.insert(type.name);
  for (const std::string& name : names) {
    const auto fits = [&](const std::string& other) { return matches(name, other); };
    if (std::any_of(known.begin(), known.end(), fits) || has_id(plan.inventory, name) ||
        std::any_of(plan.inventory.ids.begin(), plan.inventory.ids.end(), fits) ||
        std::any_of(plan.inventory.flows.begin(), plan.inventory.flows.end(),
                    [&](const std::string& flow) { return matches(name, flow + ".0"); }))
      continue;
    std::string nearest;
    for (const std::set<std::string>* some : {&std::as_const(known), &plan.inventory.ids})
      for (const std::string& other : *some)
        if (nearest.empty() || edit_distance(name, other) < edit_distance(name, nearest))
          nearest = other;
    throw Error(option + " " + name.substr(0, 60),
                "no agent type, vType or id in the scenario's demand is called that, the nearest "
                "one is '" +
                    nearest + "'; of a flow f they are f.0, f.1, ...");
  }
}

/// A step's length, so that the window shows the time that passes, unless SUMO's --delay says
/// otherwise.
double window_delay(const RunPlan& plan) {
  if (!plan.options.gui) return 0.0;
  const auto given = plan.input.options.find("delay");
  if (given == plan.input.options.end()) return plan.clock.step;
  double milliseconds = -1.0;
  const std::string& text = given->second.value;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), milliseconds);
  if (error != std::errc() || end != text.data() + text.size() ||
      !(milliseconds >= 0.0 && milliseconds <= 60000.0))
    throw Error("--delay " + text.substr(0, 60), "must be milliseconds from 0 to 60000");
  return 0.001 * milliseconds;
}

}  // namespace

RunPlan make_plan(const RunOptions& options, const CommonOptions& common) {
  RunPlan plan;
  plan.options = options;
  plan.sumo_words = split_options(options.sumo_options);
  plan.input = find_scenario(options.scenario, plan.sumo_words);
  std::vector<std::string> overrides = common.set;
  if (options.preset) overrides.push_back("behavior.preset=" + *options.preset);
  plan.config = read_config(plan.input.settings, overrides);
  choose_step(plan);
  plan.delay = window_delay(plan);
  auto from_sumo = [&](const char* option) {
    const auto found = plan.input.options.find(option);
    return found == plan.input.options.end() ? kDefault
           : found->second.on_command_line   ? kCommandLine
                                             : kConfiguration;
  };
  plan.clock.begin = plan.input.begin.value_or(0.0);
  plan.clock.begin_from = from_sumo("begin");
  choose_end(plan);
  plan.clock.seed = common.seed_given ? common.seed : plan.input.seed.value_or(common.seed);
  plan.clock.seed_from = common.seed_given ? kCommandLine : from_sumo("seed");
  if (!plan.input.options.contains("load-state")) require_time_left(plan);
  // the cap of scenario.toml belongs to imported demand; a user's own .sumocfg brings as many as it
  // likes
  const long cap = options.agents.value_or(plan.input.settings.empty() ? 0 : plan.config.agents);
  plan.vehicles = most_vehicles(cap, plan.config.on_foot);
  plan.control = control_choice(options, plan.config, plan.input, plan.control_text);
  if (!options.inspect.empty()) {
    if (!options.replay && !options.serve)
      throw Error("--inspect", "nothing shows what it records, give --replay or --serve");
    plan.inspect = rule_of_words("--inspect", options.inspect);
  }
  const bool named = !plan.control.names().empty() || (plan.inspect && !plan.inspect->who.empty());
  plan.inventory = take_inventory(plan.input, !plan.control.any(), named);
  // others may bring agents that no file tells of
  const bool alone = options.connect.empty() && options.clients == 1;
  if (named && alone && plan.inventory.complete) {
    require_known_names("--control", plan.control.names(), plan);
    if (plan.inspect)
      require_known_names("--inspect", {plan.inspect->who.begin(), plan.inspect->who.end()}, plan);
  }
  return plan;
}

void settle_begin(double sumo_time, RunPlan& plan) {
  RunClock& clock = plan.clock;
  if (std::abs(sumo_time - clock.begin) > 1e-6) {
    if (plan.ends_after_duration) clock.end += sumo_time - clock.begin;
    clock.begin = sumo_time;
    clock.begin_from = plan.input.options.contains("load-state") ? "loaded state" : "SUMO";
  }
  require_time_left(plan);
}

std::string describe(const RunPlan& plan) {
  const RunClock& clock = plan.clock;
  std::string text = number_text(clock.begin) + " s (" + clock.begin_from + ") to " +
                     number_text(clock.end) + " s (" + clock.end_from + ") in steps of " +
                     number_text(clock.step) + " s (" + clock.step_from;
  if (clock.step_from == kDefault && plan.input.step_length)
    text += "; the configuration's " + number_text(*plan.input.step_length) +
            " s is not from 0.01 to 0.5 s";
  return text + "), seed " + std::to_string(clock.seed) + " (" + clock.seed_from + ")";
}

}  // namespace sumogamma
