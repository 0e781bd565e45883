#include "io/study_plan_file.h"

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/output_file.h"

namespace sumogamma {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

void write_study_plan(const std::filesystem::path& folder, const Study& study) {
  Json scenarios = Json::array(), variants = Json::array();
  for (const StudyScenario& scenario : study.scenarios) scenarios.push_back(scenario.name);
  for (const StudyVariant& variant : study.variants) {
    Json set = Json::array();
    for (const StudySetting& setting : variant.set)
      set.push_back({{"key", setting.key}, {"value", setting.value}});
    variants.push_back({{"name", variant.name},
                        {"plain", variant.plain},
                        {"set", set},
                        {"options", variant.options}});
  }
  const Json json = {{"name", study.name},         {"question", study.question},
                     {"baseline", study.baseline}, {"seeds", study.seeds},
                     {"options", study.options},   {"measures", study.measures},
                     {"scenarios", scenarios},     {"variants", variants}};
  write_file(folder / kPlanFile, json.dump(2) + "\n");
}

Study read_study_plan(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / kPlanFile;
  Study study;
  try {
    const Json json = Json::parse(read_file(file));
    study.name = json.at("name").get<std::string>();
    study.question = json.at("question").get<std::string>();
    study.seeds = json.at("seeds").get<std::vector<std::uint64_t>>();
    study.options = json.at("options").get<std::vector<std::string>>();
    study.measures = json.at("measures").get<std::vector<std::string>>();
    for (const Json& name : json.at("scenarios"))
      study.scenarios.push_back({name.get<std::string>(), {}});
    for (const Json& one : json.at("variants")) {
      StudyVariant variant;
      variant.name = one.at("name").get<std::string>();
      variant.plain = one.at("plain").get<bool>();
      variant.options = one.at("options").get<std::vector<std::string>>();
      for (const Json& setting : one.at("set"))
        variant.set.push_back(
            {setting.at("key").get<std::string>(), setting.at("value").get<std::string>()});
      study.variants.push_back(std::move(variant));
    }
    study.baseline = json.at("baseline").get<std::size_t>();
  } catch (const nlohmann::json::exception&) {
    throw Error(file.string(), "isn't what `sumo-gamma batch` wrote, run the batch again");
  }
  if (study.variants.empty() || study.baseline >= study.variants.size())
    throw Error(file.string(), "isn't what `sumo-gamma batch` wrote, run the batch again");
  return study;
}

}  // namespace sumogamma
