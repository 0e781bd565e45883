#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/command.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/print.h"
#include "io/config.h"
#include "io/replay.h"
#include "io/replay_page.h"
#include "simulation/scene_run.h"

namespace sumogamma {

namespace {

struct SceneOptions {
  std::string file;
  std::string actuation = "car-like";
  std::size_t steps = 200;
  double dt = 0.05;
  std::string replay;  ///< page to write, empty for none
};

nlohmann::ordered_json to_json(const std::string& scene, const SceneReport& report) {
  const std::string hash = hash_text(report.state_hash);
  return {{"scene", scene},
          {"agents", report.agents},
          {"steps", report.steps},
          {"dt", report.dt},
          {"agents_overlapped_share", report.agents_overlapped_share},
          {"pairs_per_agent", report.pairs_per_agent},
          {"overlap_share_of_agent_steps", report.overlap_share_of_agent_steps},
          {"deep_agents_share", report.deep_agents_share},
          {"progress_mean", report.progress_mean},
          {"stuck_share", report.stuck_share},
          {"infeasible_share", report.infeasible_share},
          {"reversal_share", report.reversal_share},
          {"kinematics_violation_share", report.kinematics_violation_share},
          {"hard_violation_share", report.hard_violation_share},
          {"neighbours_mean", report.neighbours_mean},
          {"half_planes_mean", report.half_planes_mean},
          {"model_cpu_us_per_agent_step", report.model_cpu_us_per_agent_step},
          {"model_wall_us_per_agent_step", report.model_wall_us_per_agent_step},
          {"state_hash", hash}};
}

int run(const SceneOptions& options, const CommonOptions& common) {
  const Actuation actuation = options.actuation == "ideal" ? Actuation::Ideal : Actuation::CarLike;
  const SceneFile file = read_scene_file(options.file, actuation);
  const ScenarioConfig config = read_config({}, common.set);
  Workers workers(common.threads);

  const std::filesystem::path page = options.replay;
  const std::filesystem::path recording = std::filesystem::path(page).replace_extension(".bin");
  std::unique_ptr<ReplayRecorder> recorder;
  std::string name;
  SceneObserver observer;
  if (!page.empty()) {
    recorder = std::make_unique<ReplayRecorder>(recording, file.name, RoadNetwork{}, file.types);
    observer = [&](const Scene& scene) {
      const AgentName name_of = [&](AgentId id) -> std::string_view {
        name = std::to_string(id.value);
        return name;
      };
      recorder->add({scene, name_of});
    };
  }
  const SceneReport report =
      run_scene(file, config.model, options.steps, options.dt, workers, observer);
  if (recorder) {
    recorder->close();
    write_replay_page(page, recording);
  }
  print(common.out, "{}\n", to_json(file.name, report).dump(2));
  return kExitDone;
}

}  // namespace

CommandRunner add_scene_command(CLI::App& parent) {
  CLI::App* command = parent.add_subcommand(
      "scene", "drive a standalone scene (no roads, no SUMO) and print its figures");
  auto options = std::make_shared<SceneOptions>();
  command->add_option("FILE", options->file, "scene file (CSV)")->required();
  command->add_option("--actuation", options->actuation, "how bodies follow their velocities")
      ->check(CLI::IsMember({"car-like", "ideal"}))
      ->capture_default_str();
  command->add_option("--steps", options->steps, "ticks to drive")
      ->check(whole_number(1, 10'000'000))
      ->capture_default_str();
  command->add_option("--dt", options->dt, "length of a tick [s]")
      ->check(finite_number(0.001, 1.0))
      ->capture_default_str();
  command->add_option("--replay", options->replay, "page to write for watching it: FILE.html");
  return [options](const CommonOptions& common) { return run(*options, common); };
}

}  // namespace sumogamma
