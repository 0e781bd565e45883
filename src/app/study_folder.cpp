#include "app/study_folder.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/scenario_hash.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/subprocess.h"
#include "io/output_file.h"
#include "io/output_folder.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kStudyFile = "study.json";

/// What decides the outcome of a study's runs: options, this program, and by name scenarios (hash
/// of their files) and variants. Seeds, measures and questions may change: the runs stay what they
/// are.
Json identity_json(const Study& study) {
  Json scenarios = Json::object(), variants = Json::object();
  for (const StudyScenario& scenario : study.scenarios)
    scenarios[scenario.name] = hash_of_files(find_scenario(scenario.path));
  for (const StudyVariant& variant : study.variants) {
    Json set = Json::array();
    for (const StudySetting& setting : variant.set)
      set.push_back(setting.key + "=" + setting.value);
    variants[variant.name] = {
        {"driver", variant.plain ? "plain" : "gamma"}, {"set", set}, {"options", variant.options}};
  }
  return {{"study", study.name},
          {"program", hash_text(hash_of_bytes(read_file(own_program())))},
          {"options", study.options},
          {"scenarios", scenarios},
          {"variants", variants}};
}

/// What of `old` this study contradicts, or nothing.
std::string contradiction(const Json& old, const Json& now) {
  if (old.value("study", "") != now["study"].get<std::string>())
    return "holds the study '" + old.value("study", "?") + "'";
  if (old["program"] != now["program"]) return "holds runs of another build of sumo-gamma";
  if (old["options"] != now["options"])
    return "holds runs with other options (" + old["options"].dump() + ")";
  for (const char* part : {"scenarios", "variants"})
    for (const auto& [name, value] : now[part].items())
      if (old[part].contains(name) && old[part][name] != value)
        return "holds runs of another " + std::string(part, std::string(part).size() - 1) + " '" +
               name + "'";
  return "";
}

Json read_identity(const fs::path& folder) {
  const fs::path file = folder / kStudyFile;
  Json old = Json::parse(read_file(file), nullptr, false);
  for (const char* key : {"study", "program", "options", "scenarios", "variants"})
    if (!old.is_object() || !old.contains(key))
      throw Error(file.string(), "isn't what sumo-gamma wrote, choose another folder");
  return old;
}

void require_no_contradiction(const fs::path& folder, const Json& old, const Json& now) {
  const std::string other = contradiction(old, now);
  if (!other.empty()) throw Error(folder.string(), other + ", choose another folder");
}

}  // namespace

void claim_study_folder(const fs::path& folder, const Study& study) {
  Json now = identity_json(study);
  make_output_folder(folder);
  // shards may begin at the same moment
  const FolderLock lock(folder);
  if (fs::exists(folder / kStudyFile)) {
    const Json old = read_identity(folder);
    require_no_contradiction(folder, old, now);
    // what this version of the study leaves out stays known, as its runs stay
    for (const char* part : {"scenarios", "variants"})
      for (const auto& [name, value] : old[part].items())
        if (!now[part].contains(name)) now[part][name] = value;
    if (now == old) return;
  } else if (!fs::is_empty(folder)) {
    throw Error(folder.string(), "holds other files than a study's, choose another folder");
  }
  write_file(folder / kStudyFile, now.dump(2) + "\n");
}

void require_same_study(const fs::path& folder, const Study& study) {
  if (!fs::exists(folder / kStudyFile))
    throw Error(folder.string(), "holds no runs of a study, name the folder where a shard ran");
  require_no_contradiction(folder, read_identity(folder), identity_json(study));
}

}  // namespace sumogamma
