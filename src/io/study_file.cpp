#include "io/study_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>

#include "base/edit_distance.h"
#include "base/error.h"
#include "base/number_text.h"
#include "io/output_file.h"
#include "study/measures.h"

namespace sumogamma {

namespace {

constexpr std::size_t kMostVariants = 10000;
constexpr std::size_t kMostSeeds = 100000;

/// A study as TOML: knows how to name a place in it.
class StudyDocument {
 public:
  explicit StudyDocument(const std::filesystem::path& file) : file_(file) {
    const std::string content = read_file(file);
    try {
      root_ = toml::parse(content);
    } catch (const toml::parse_error& error) {
      throw Error(file.string() + ":" + std::to_string(error.source().begin.line),
                  "not TOML (" + std::string(error.description()) + ")");
    }
  }

  const toml::table& root() const { return root_; }

  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw Error(file_.string() + ":" + std::to_string(node.source().begin.line), what);
  }

  void require_known(const toml::table& table, const std::string& where,
                     std::span<const char* const> known) const {
    for (const auto& [key, value] : table) {
      const std::string name(key.str());
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const auto nearest = nearest_named(name, known, [](const char* one) { return one; });
      fail(value, "unknown key '" + name + "' of " + where + ", the nearest known one is '" +
                      *nearest + "'");
    }
  }

  std::string text(const toml::node& node, const std::string& key) const {
    if (!node.is_string()) fail(node, "'" + key + "' must be a text in quotes");
    return node.value<std::string>().value();
  }
  std::vector<std::string> texts(const toml::node& node, const std::string& key) const {
    if (node.is_string()) return {text(node, key)};
    if (!node.is_array()) fail(node, "'" + key + "' must be a list of texts in quotes");
    std::vector<std::string> list;
    for (const toml::node& one : *node.as_array()) list.push_back(text(one, key));
    if (list.empty()) fail(node, "'" + key + "' must not be empty");
    return list;
  }
  double number(const toml::node& node, const std::string& key, double least, double most) const {
    const double value = node.is_number() ? node.value<double>().value() : std::nan("");
    if (!(value >= least && value <= most))
      fail(node, fmt::format("'{}' must be a number from {:g} to {:g}", key, least, most));
    return value;
  }
  std::uint64_t whole(const toml::node& node, const std::string& key, std::int64_t least,
                      std::int64_t most) const {
    const std::int64_t value = node.is_integer() ? node.value<std::int64_t>().value() : least - 1;
    if (value < least || value > most)
      fail(node, fmt::format("'{}' must be a whole number from {} to {}", key, least, most));
    return static_cast<std::uint64_t>(value);
  }
  const toml::table* table(const char* name) const {
    const toml::node* node = root_.get(name);
    if (!node) return nullptr;
    if (!node->is_table()) fail(*node, fmt::format("'{0}' must be a table, [{0}]", name));
    return node->as_table();
  }

  /// Keys with dots, as tables within tables or in quotes, and their values.
  void flatten(const toml::table& table, const std::string& prefix,
               std::vector<std::pair<std::string, const toml::node*>>& values) const {
    for (const auto& [key, value] : table) {
      const std::string full = prefix + std::string(key.str());
      if (value.is_table())
        flatten(*value.as_table(), full + ".", values);
      else
        values.emplace_back(full, &value);
    }
  }

  /// As --set takes it.
  std::string value_text(const toml::node& node, const std::string& key) const {
    if (node.is_boolean()) return node.value<bool>().value() ? "true" : "false";
    if (node.is_integer()) return std::to_string(node.value<std::int64_t>().value());
    if (node.is_floating_point()) {
      const std::string number = number_text(node.value<double>().value());
      return number.find_first_of(".en") == std::string::npos ? number + ".0" : number;
    }
    if (node.is_string()) {
      std::ostringstream quoted;
      quoted << toml::value<std::string>(node.value<std::string>().value());
      return quoted.str();
    }
    fail(node, "'" + key + "' must be a number, a text, true or false");
  }

  std::vector<StudySetting> settings(const toml::node& node, const std::string& key) const {
    if (!node.is_table()) fail(node, "'" + key + "' must be a table of keys of scenario.toml");
    std::vector<std::pair<std::string, const toml::node*>> values;
    flatten(*node.as_table(), "", values);
    std::vector<StudySetting> settings;
    for (const auto& [name, value] : values) settings.push_back({name, value_text(*value, name)});
    return settings;
  }

 private:
  std::filesystem::path file_;
  toml::table root_;
};

/// An entry of the list of variants, before it is combined with grid and hypercube.
struct ListedVariant {
  std::string name;
  std::optional<bool> plain;  ///< not set: every driver of the study
  std::vector<StudySetting> set;
  std::vector<std::string> options;
};

bool is_plain(const StudyDocument& document, const toml::node& node, const std::string& driver) {
  if (driver == "gamma") return false;
  if (driver == "plain") return true;
  document.fail(node, "unknown driver '" + driver + "', expected gamma or plain");
}

std::uint64_t parse_seed(const StudyDocument& document, const toml::node& node,
                         std::string_view text) {
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size() || text.empty())
    document.fail(node, "'seeds' must be \"FIRST..LAST\", a list of whole numbers, or how many");
  return seed;
}

std::vector<std::uint64_t> read_seeds(const StudyDocument& document, const toml::node& node) {
  std::vector<std::uint64_t> seeds;
  auto fill = [&](std::uint64_t first, std::uint64_t last) {
    if (last < first || last - first >= kMostSeeds)
      document.fail(node, "'seeds' must go up, and be no more than 100000");
    for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  };
  if (node.is_integer()) {
    fill(1, document.whole(node, "seeds", 1, kMostSeeds));
  } else if (node.is_string()) {
    const std::string text = document.text(node, "seeds");
    const std::size_t dots = text.find("..");
    const std::uint64_t first = parse_seed(document, node, text.substr(0, dots));
    fill(first,
         dots == std::string::npos ? first : parse_seed(document, node, text.substr(dots + 2)));
  } else if (node.is_array()) {
    std::set<std::uint64_t> seen;
    for (const toml::node& one : *node.as_array()) {
      seeds.push_back(document.whole(one, "seeds", 0, std::numeric_limits<std::int64_t>::max()));
      if (!seen.insert(seeds.back()).second) document.fail(one, "'seeds' has one twice");
    }
  }
  if (seeds.empty())
    document.fail(node, "'seeds' must be \"FIRST..LAST\", a list of whole numbers, or how many");
  return seeds;
}

void read_scenarios(const StudyDocument& document, const toml::node& node,
                    const std::filesystem::path& folder, Study& study) {
  for (const std::string& given : document.texts(node, "scenarios")) {
    const std::filesystem::path path =
        (folder / given).lexically_normal();  // of an absolute path: itself
    if (!std::filesystem::exists(path))
      document.fail(node, "scenario '" + given + "' isn't there (looked for " + path.string() +
                              "), name a folder or a .sumocfg");
    std::filesystem::path last = path.has_filename() ? path : path.parent_path();
    const std::string name =
        last.extension() == ".sumocfg" ? last.stem().string() : last.filename().string();
    for (const StudyScenario& other : study.scenarios)
      if (other.name == name)
        document.fail(node, "two scenarios are called '" + name + "', rename a folder");
    study.scenarios.push_back({name, path});
  }
}

constexpr const char* kStudyKeys[] = {
    "name",    "question", "scenarios", "seeds",   "drivers",    "duration", "step",      "agents",
    "options", "measures", "baseline",  "threads", "time_limit", "until",    "most_seeds"};

/// Options of the study as words of `run`.
void read_words(const StudyDocument& document, const toml::table& table, Study& study) {
  const auto add = [&](const char* key, const char* option, double least, double most) {
    if (const toml::node* node = table.get(key)) {
      study.options.emplace_back(option);
      study.options.push_back(number_text(document.number(*node, key, least, most)));
    }
  };
  add("duration", "--duration", 1e-3, 1e9);
  add("step", "--step", 0.01, 0.5);
  if (const toml::node* node = table.get("agents")) {
    study.options.emplace_back("--agents");
    study.options.push_back(std::to_string(document.whole(*node, "agents", 1, 1000000)));
  }
  if (const toml::node* node = table.get("options"))
    for (const std::string& word : document.texts(*node, "options")) study.options.push_back(word);
}

void read_head(const StudyDocument& document, const std::filesystem::path& file, Study& study) {
  const toml::table* table = document.table("study");
  if (!table) throw Error(file.string(), "has no table [study], which names scenarios and seeds");
  document.require_known(*table, "[study]", kStudyKeys);
  const auto get = [&](const char* key) { return table->get(key); };
  study.name = file.stem().string();
  if (const toml::node* node = get("name")) study.name = document.text(*node, "name");
  if (const toml::node* node = get("question")) study.question = document.text(*node, "question");
  if (!get("scenarios")) document.fail(*table, "[study] needs scenarios = [...]");
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  read_scenarios(document, *get("scenarios"), folder, study);
  if (!get("seeds")) document.fail(*table, "[study] needs seeds, such as \"1..10\"");
  study.seeds = read_seeds(document, *get("seeds"));
  read_words(document, *table, study);
  if (const toml::node* node = get("measures")) {
    study.measures = document.texts(*node, "measures");
  } else {
    for (const Measure& measure : named_measures())
      if (measure.better != Better::Neither) study.measures.emplace_back(measure.key);
  }
  if (const toml::node* node = get("threads"))
    study.threads = static_cast<unsigned>(document.whole(*node, "threads", 1, 1024));
  if (const toml::node* node = get("time_limit"))
    study.time_limit = document.number(*node, "time_limit", 1, 1e7);
  if (const toml::node* node = get("until"))
    study.until = parse_until(document.text(*node, "until"));
  if (const toml::node* node = get("most_seeds")) {
    if (!study.until) document.fail(*node, "'most_seeds' means nothing without 'until'");
    study.until->most_seeds = document.whole(*node, "most_seeds", 2, kMostSeeds);
  }
}

std::vector<ListedVariant> read_list(const StudyDocument& document) {
  constexpr const char* kKeys[] = {"name", "driver", "set", "options"};
  const toml::node* node = document.root().get("variant");
  if (!node) return {ListedVariant{}};
  if (!node->is_array_of_tables()) document.fail(*node, "'variant' must be [[variant]] entries");
  std::vector<ListedVariant> list;
  for (const toml::node& one : *node->as_array()) {
    const toml::table& table = *one.as_table();
    document.require_known(table, "[[variant]]", kKeys);
    ListedVariant variant;
    if (!table.get("name")) document.fail(one, "a variant needs a name");
    variant.name = document.text(*table.get("name"), "name");
    if (const toml::node* driver = table.get("driver"))
      variant.plain = is_plain(document, *driver, document.text(*driver, "driver"));
    if (const toml::node* set = table.get("set")) variant.set = document.settings(*set, "set");
    if (const toml::node* options = table.get("options"))
      variant.options = document.texts(*options, "options");
    list.push_back(std::move(variant));
  }
  return list;
}

std::vector<std::vector<StudySetting>> read_grid(const StudyDocument& document) {
  const toml::table* table = document.table("grid");
  if (!table) return {{}};
  std::vector<std::pair<std::string, const toml::node*>> values;
  document.flatten(*table, "", values);
  std::vector<ParameterValues> parameters;
  double combinations = 1;
  for (const auto& [key, node] : values) {
    if (!node->is_array() || node->as_array()->empty())
      document.fail(*node, "'" + key + "' must be a list of the values to try, [1.0, 1.5]");
    ParameterValues parameter{key, {}};
    for (const toml::node& one : *node->as_array())
      parameter.values.push_back(document.value_text(one, key));
    combinations *= static_cast<double>(parameter.values.size());
    if (combinations > static_cast<double>(kMostVariants))
      document.fail(*node, "more than 10000 combinations, take a [latin_hypercube]");
    parameters.push_back(std::move(parameter));
  }
  return grid_of(parameters);
}

std::vector<std::vector<StudySetting>> read_hypercube(const StudyDocument& document) {
  const toml::table* table = document.table("latin_hypercube");
  if (!table) return {{}};
  std::vector<std::pair<std::string, const toml::node*>> values;
  document.flatten(*table, "", values);
  std::vector<ParameterRange> ranges;
  std::uint64_t points = 0, seed = 1;
  for (const auto& [key, node] : values) {
    if (key == "points") {
      points = document.whole(*node, key, 1, kMostVariants);
    } else if (key == "seed") {
      seed = document.whole(*node, key, 0, std::numeric_limits<std::int64_t>::max());
    } else {
      const toml::array* pair = node->as_array();
      if (!pair || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number())
        document.fail(*node, "'" + key + "' must be a range, [LOW, HIGH]");
      ParameterRange range{key, (*pair)[0].value<double>().value(),
                           (*pair)[1].value<double>().value(),
                           (*pair)[0].is_integer() && (*pair)[1].is_integer()};
      if (!(range.low < range.high) || !std::isfinite(range.high - range.low))
        document.fail(*node, "'" + key + "' must be a range that goes up, [LOW, HIGH]");
      ranges.push_back(std::move(range));
    }
  }
  if (points == 0) document.fail(*table, "[latin_hypercube] needs points = N");
  if (ranges.empty()) document.fail(*table, "[latin_hypercube] needs a KEY = [LOW, HIGH]");
  return latin_hypercube(ranges, points, seed);
}

/// What is set of plain SUMO: of scenario.toml it reads [run] alone, and so runs that differ in
/// other keys are one.
std::vector<StudySetting> for_plain(const std::vector<StudySetting>& set) {
  std::vector<StudySetting> kept;
  for (const StudySetting& setting : set)
    if (setting.key.rfind("run.", 0) == 0) kept.push_back(setting);
  return kept;
}

std::string variant_name(const std::string& listed, bool plain,
                         const std::vector<StudySetting>& varied) {
  std::string name = !listed.empty() ? listed : plain ? "plain" : "";
  for (const StudySetting& setting : varied)
    name += (name.empty() ? "" : ", ") + setting.key + "=" + setting.value;
  return name.empty() ? "gamma" : name;
}

void add_variant(const ListedVariant& listed, bool plain,
                 const std::vector<StudySetting>& combination, Study& study) {
  const std::vector<StudySetting> varied = plain ? for_plain(combination) : combination;
  // where the list doesn't speak of drivers, its plain runs are those of all its entries
  const bool own_name = !plain || listed.plain.has_value();
  StudyVariant variant{variant_name(own_name ? listed.name : "", plain, varied), plain,
                       plain ? for_plain(listed.set) : listed.set, listed.options};
  if (!own_name && !variant.set.empty())
    variant.name = variant_name(listed.name + " plain", plain, varied);
  variant.set.insert(variant.set.end(), varied.begin(), varied.end());
  const auto same = [&](const StudyVariant& other) {
    return other.plain == plain && other.set == variant.set && other.options == variant.options;
  };
  if (plain && std::any_of(study.variants.begin(), study.variants.end(), same)) return;
  study.variants.push_back(std::move(variant));
}

void read_variants(const StudyDocument& document, const std::filesystem::path& file, Study& study) {
  std::vector<bool> drivers{false, true};
  const toml::table& head = *document.table("study");
  if (const toml::node* node = head.get("drivers")) {
    drivers.clear();
    for (const std::string& driver : document.texts(*node, "drivers"))
      drivers.push_back(is_plain(document, *node, driver));
  }
  const std::vector<ListedVariant> list = read_list(document);
  const auto grid = read_grid(document), hypercube = read_hypercube(document);
  for (const ListedVariant& listed : list)
    for (const bool plain : listed.plain ? std::vector<bool>{*listed.plain} : drivers)
      for (const auto& of_grid : grid)
        for (const auto& of_cube : hypercube) {
          std::vector<StudySetting> combination = of_grid;
          combination.insert(combination.end(), of_cube.begin(), of_cube.end());
          add_variant(listed, plain, combination, study);
          if (study.variants.size() > kMostVariants)
            throw Error(file.string(), "has more than 10000 variants");
        }
  std::set<std::string> names;
  for (const StudyVariant& variant : study.variants)
    if (!names.insert(variant.name).second)
      throw Error(file.string(), "has two variants called '" + variant.name + "', rename one");
}

void choose_baseline(const StudyDocument& document, Study& study) {
  const auto& variants = study.variants;
  const auto plain = std::find_if(variants.begin(), variants.end(),
                                  [](const StudyVariant& variant) { return variant.plain; });
  study.baseline = plain == variants.end() ? 0 : static_cast<std::size_t>(plain - variants.begin());
  const toml::node* node = document.table("study")->get("baseline");
  if (!node) return;
  const std::string name = document.text(*node, "baseline");
  const auto found = std::find_if(variants.begin(), variants.end(),
                                  [&](const StudyVariant& one) { return one.name == name; });
  if (found == variants.end()) {
    const auto nearest =
        nearest_named(name, variants, [](const StudyVariant& variant) { return variant.name; });
    document.fail(
        *node, "no variant is called '" + name + "', the nearest one is '" + nearest->name + "'");
  }
  study.baseline = static_cast<std::size_t>(found - variants.begin());
}

}  // namespace

Study read_study(const std::filesystem::path& file) {
  const StudyDocument document(file);
  constexpr const char* kTables[] = {"study", "variant", "grid", "latin_hypercube"};
  document.require_known(document.root(), "a study", kTables);
  Study study;
  read_head(document, file, study);
  read_variants(document, file, study);
  choose_baseline(document, study);
  return study;
}

StudyUntil parse_until(const std::string& text) {
  const std::size_t equals = text.find('=');
  StudyUntil until;
  std::string width = equals == std::string::npos ? "" : text.substr(equals + 1);
  until.measure = text.substr(0, equals);
  until.relative = !width.empty() && width.back() == '%';
  if (until.relative) width.pop_back();
  const auto [end, error] = std::from_chars(width.data(), width.data() + width.size(), until.width);
  if (until.measure.empty() || width.empty() || error != std::errc() ||
      end != width.data() + width.size() || !std::isfinite(until.width) || until.width <= 0.0)
    throw Error("until " + text.substr(0, 60),
                "must be MEASURE=WIDTH, a key of results.json and the width of its interval above "
                "0, in its unit or with %: agents.arrived=5%");
  if (until.relative) until.width /= 100.0;
  return until;
}

}  // namespace sumogamma
