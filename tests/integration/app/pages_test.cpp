#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "base/subprocess.h"
#include "io/output_file.h"
#include "io/replay.h"
#include "io/replay_page.h"
#include "io/results.h"
#include "support/headless.h"
#include "support/small_net.h"
#include "support/synthetic_traffic.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

class Pages : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("sumogamma_pages_" + std::to_string(getpid()));
    fs::create_directories(folder_ / "run");
  }
  void TearDown() override { fs::remove_all(folder_); }

  ProcessResult program(std::vector<std::string> arguments) const {
    ProcessRequest request;
    request.arguments = std::move(arguments);
    request.arguments.insert(request.arguments.begin(), SUMOGAMMA_PROGRAM);
    request.time_limit = 60;
    return run_process(request);
  }

  /// Ten seconds of boxes on the small network, with one collision marked, and one of them an ego
  /// with a plan.
  void record() const {
    const RoadNetwork net = testing::small_net();
    testing::SyntheticTraffic traffic(net, 30, 0.05);
    std::map<std::uint32_t, std::string> names;
    ReplayRecorder recorder(folder_ / "run" / "replay.bin", "Small <town>", net, traffic.types);
    const AgentName name = [&](AgentId id) -> std::string_view {
      return names.try_emplace(id.value, testing::SyntheticTraffic::name_of(id)).first->second;
    };
    for (int tick = 0; tick < 200; ++tick) {
      recorder.add({traffic.scene, name, &traffic.road});
      if (tick == 60)
        recorder.add_event(
            {ReplayEventKind::Collision, 3.0, {20, 0}, AgentId{1}, AgentId{2}, "0.2 m deep"});
      if (tick == 100) recorder.add_plan(plan_of(traffic.scene));
      traffic.advance();
    }
    recorder.close();
  }

  static PlanTrace plan_of(const Scene& scene) {
    PlanTrace plan;
    plan.ego = AgentId{3};
    plan.time = scene.time;
    plan.action.acceleration = -3;
    plan.figures = PlanTrace::Figures::Values;
    plan.choices = {{3, -812, -1.5}, {-3, -21.25, -3}};
    const Vec2 here = scene.position[find_row(scene, AgentId{5})];
    plan.beliefs = {{AgentId{5}, {{0.75, {here, here + Vec2(10, 0)}}, {0.25, {here}}}}};
    plan.scenarios = {{{AgentId{5}, 0, {}}}, {{AgentId{5}, 1, {}}}};
    return plan;
  }

  /// Of what record() leaves.
  void make_page() {
    record();
    ASSERT_TRUE(program({"replay", (folder_ / "run").string()}).ok());
    page_ = folder_ / "run" / "replay.html";
  }

  /// The page's document as headless Chromium has it after its scripts ran; complaints of the
  /// scripts in `console`.
  std::string dom_of(const fs::path& page, const std::string& wish, std::string& console) const {
    ProcessRequest request;
    request.arguments = testing::headless_chromium(
        folder_ / "chromium", {"--virtual-time-budget=5000", "--window-size=1200,800",
                               "file://" + page.string() + "#" + wish});
    request.time_limit = 120;
    const ProcessResult result = run_process(request);
    EXPECT_TRUE(result.ok()) << describe_end(result, request.time_limit);
    for (std::size_t at = 0; (at = result.errors.find("CONSOLE", at)) != std::string::npos; ++at)
      console += result.errors.substr(at, result.errors.find('\n', at) - at) + "\n";
    return result.output;
  }

  fs::path page_;
  fs::path folder_;
};

TEST_F(Pages, ReplayPlaysInChromium) {
  if (find_program("chromium").empty())
    GTEST_SKIP() << "no chromium in PATH: the replay page was NOT tested in a browser";
  ASSERT_NO_FATAL_FAILURE(make_page());
  std::string console;
  const std::string dom = dom_of(page_, "play=0&t=4.5&theme=dark", console);
  EXPECT_EQ(console, "");
  EXPECT_NE(dom.find("data-state=\"ready\""), std::string::npos) << dom.substr(0, 400);
  EXPECT_NE(dom.find("data-steps=\"100\""), std::string::npos) << "every second tick of 200";
  EXPECT_NE(dom.find("data-agents=\"30\""), std::string::npos);
  EXPECT_NE(dom.find("data-events=\"1\""), std::string::npos);
  EXPECT_NE(dom.find("<b id=\"time\">0:04.5</b>"), std::string::npos) << "the link's time is shown";
  EXPECT_NE(dom.find("Small &lt;town&gt;"), std::string::npos);
  EXPECT_NE(dom.find("collision ›"), std::string::npos);
  EXPECT_NE(dom.find("driven by GAMMA"), std::string::npos);
}

TEST_F(Pages, BeginsWhereTrafficIsAndTellsOfMarksAndAgents) {
  if (find_program("chromium").empty())
    GTEST_SKIP() << "no chromium in PATH: the replay page was NOT tested in a browser";
  ASSERT_NO_FATAL_FAILURE(make_page());
  std::string console;
  const std::string marked = dom_of(page_, "play=0&mark=0", console);
  EXPECT_NE(marked.find("0:03.0 · collision · agent1 and agent2: 0.2 m deep"), std::string::npos);
  EXPECT_NE(marked.find("<b id=\"time\">0:03.0</b>"), std::string::npos);
  const std::string looked_at = dom_of(page_, "play=0&t=2&follow=agent1&list=1", console);
  EXPECT_NE(looked_at.find("velocity space: run with --inspect agent1"), std::string::npos);
  EXPECT_NE(looked_at.find("nothing holds it back"), std::string::npos);
  EXPECT_NE(looked_at.find("<em>collision</em><span>agent1 and agent2: 0.2 m deep</span>"),
            std::string::npos);
  EXPECT_EQ(console, "");
}

TEST_F(Pages, TellsOfTheEgosPlan) {
  if (find_program("chromium").empty())
    GTEST_SKIP() << "no chromium in PATH: the replay page was NOT tested in a browser";
  ASSERT_NO_FATAL_FAILURE(make_page());
  std::string console;
  const std::string ego = dom_of(page_, "play=0&t=7&follow=agent3&scenarios=1", console);
  EXPECT_NE(ego.find("data-plans=\"1\""), std::string::npos);
  EXPECT_NE(ego.find("plan of 0:05.0: brakes by 3.0 m/s²"), std::string::npos);
  EXPECT_NE(ego.find("<span>brakes by 3.0 m/s²</span><b>-21.25 … -3.00</b>"), std::string::npos);
  EXPECT_NE(ego.find("<span>speeds up by 3.0 m/s²</span><b>-812 … -1.50</b>"), std::string::npos);
  const std::string other = dom_of(page_, "play=0&t=7&follow=agent5", console);
  EXPECT_NE(other.find("<b>75 %</b>"), std::string::npos);
  EXPECT_NE(other.find("<span>stops</span><b>25 %</b>"), std::string::npos);
  const std::string before = dom_of(page_, "play=0&t=4&follow=agent5", console);
  EXPECT_EQ(before.find("<b>75 %</b>"), std::string::npos);
  EXPECT_EQ(console, "");
}

/// Width and height of a PNG.
std::pair<unsigned, unsigned> png_size(const std::string& bytes) {
  if (bytes.size() < 24 || bytes.substr(1, 3) != "PNG") return {0, 0};
  const auto number = [&](std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
      value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
  };
  return {number(16), number(20)};
}

TEST_F(Pages, MakesAPicture) {
  record();
  const std::string run = (folder_ / "run").string(), file = (folder_ / "a picture.png").string();
  const ProcessResult bad = program({"replay", run, "--picture", "5", "--size", "big"});
  EXPECT_EQ(bad.exit_code, 2) << bad.errors;
  if (find_program("chromium").empty()) {
    const ProcessResult without = program({"replay", run, "--picture", "5"});
    EXPECT_EQ(without.exit_code, 2);
    EXPECT_NE(without.errors.find("install Debian's package chromium"), std::string::npos);
    GTEST_SKIP() << "no chromium in PATH: no picture was made";
  }
  const ProcessResult made =
      program({"replay", run, "--picture", "5", "-o", file, "--size", "800x600"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  EXPECT_EQ(png_size(read_file(file)), std::pair(800u, 600u));
  // of a page alone, as a drive leaves it
  const std::string page = (folder_ / "replay_7.html").string();
  ASSERT_TRUE(program({"replay", run, "-o", page}).ok());
  const ProcessResult of_page = program({"replay", page, "--picture", "5", "--size", "800x600"});
  ASSERT_EQ(of_page.exit_code, 0) << of_page.errors;
  EXPECT_EQ(read_file(folder_ / "replay_7.png"), read_file(file));
  const ProcessResult late = program({"replay", run, "--picture", "99"});
  EXPECT_EQ(late.exit_code, 2);
  EXPECT_NE(late.errors.find("from 0.0 to 9.9 s"), std::string::npos) << late.errors;
  EXPECT_FALSE(fs::exists(folder_ / "run" / "replay.png"));
}

TEST_F(Pages, NamesThePackageThatIsMissing) {
  record();
  ProcessRequest request;
  request.arguments = {SUMOGAMMA_PROGRAM, "replay", (folder_ / "run").string(), "--picture", "5"};
  request.environment = {{"PATH", "/nowhere"}, {"SUMO_HOME", "/nowhere"}};
  const ProcessResult result = run_process(request);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("install Debian's package chromium"), std::string::npos)
      << result.errors;
  request.arguments = {SUMOGAMMA_PROGRAM, "replay", (folder_ / "run").string(), "--video",
                       (folder_ / "a.mp4").string()};
  EXPECT_NE(run_process(request).errors.find("install Debian's package ffmpeg"), std::string::npos);
}

TEST_F(Pages, MakesAVideo) {
  if (find_program("chromium").empty() || find_program("ffmpeg").empty() ||
      find_program("ffprobe").empty())
    GTEST_SKIP() << "no chromium or no ffmpeg in PATH: no video was made";
  record();
  const std::string run = (folder_ / "run").string(), file = (folder_ / "out.mp4").string();
  const ProcessResult made = program({"replay", run, "--video", file, "--from", "2", "--to", "4",
                                      "--fps", "10", "--size", "320x240"});
  ASSERT_EQ(made.exit_code, 0) << made.errors;
  ProcessRequest probe;
  probe.arguments = {"ffprobe",
                     "-v",
                     "error",
                     "-count_frames",
                     "-show_entries",
                     "stream=codec_name,width,height,nb_read_frames",
                     "-of",
                     "csv=p=0",
                     file};
  std::string told = run_process(probe).output;
  // a newer ffprobe ends its lines with a comma
  if (told.ends_with(",\n")) told.erase(told.size() - 2, 1);
  EXPECT_EQ(told, "h264,320,240,21\n");
  EXPECT_FALSE(fs::exists(file + ".part.mp4"));
  EXPECT_EQ(program({"replay", run, "--video", file, "--from", "4", "--to", "2"}).exit_code, 2);
  const ProcessResult nowhere =
      program({"replay", run, "--video", "/nowhere/a.mp4", "--to", "1", "--size", "320x240"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_NE(nowhere.errors.find("ffmpeg"), std::string::npos) << nowhere.errors;
}

TEST_F(Pages, AnInterruptedRecordingPlaysToWhereItGot) {
  if (find_program("chromium").empty())
    GTEST_SKIP() << "no chromium in PATH: the replay page was NOT tested in a browser";
  record();
  const fs::path recording = folder_ / "run" / "replay.bin";
  fs::resize_file(recording, fs::file_size(recording) * 3 / 4);
  ASSERT_TRUE(program({"replay", (folder_ / "run").string()}).ok());
  std::string console;
  const std::string dom = dom_of(folder_ / "run" / "replay.html", "play=0", console);
  EXPECT_NE(dom.find("data-state=\"ready\""), std::string::npos);
  EXPECT_EQ(dom.find("data-steps=\"100\""), std::string::npos);
}

TEST_F(Pages, ReplayOfNothingIsBadInput) {
  const ProcessResult result = program({"replay", (folder_ / "run").string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.errors.rfind("sumo-gamma: ", 0), 0u) << result.errors;
  EXPECT_NE(result.errors.find("replay.bin"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "run" / "replay.html"));
}

TEST_F(Pages, ReportComparesRuns) {
  write_results(folder_ / "run" / "results.json", RunResults{});
  const std::string run = (folder_ / "run").string(), page = (folder_ / "report.html").string();
  const ProcessResult result = program({"report", run, run, "-o", page});
  EXPECT_TRUE(result.ok()) << result.errors;
  EXPECT_NE(result.output.find("| flow.stuck_agents | 0 | 0 |"), std::string::npos);
  EXPECT_NE(read_file(page).find("<h2>collisions</h2>"), std::string::npos);
  EXPECT_NE(program({"report", run, "--csv"}).output.find("flow.stuck_agents,0\n"),
            std::string::npos);
  EXPECT_EQ(program({"report", (folder_ / "absent").string()}).exit_code, 2);
  EXPECT_EQ(program({"report", run, "-o", "/dev/null/page.html"}).exit_code, 2);
}

TEST_F(Pages, VersionNamesEverything) {
  const ProcessResult result = program({"version"});
  EXPECT_TRUE(result.ok());
  for (const char* name : {"sumo-gamma", "commit", "SUMO", "libosmium", "Eigen", "zlib"})
    EXPECT_NE(result.output.find(name), std::string::npos) << name;
}

TEST_F(Pages, UsageErrorsAreOneLineAndTwo) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {"fly"}, {"replay"}, {"report"}, {"version", "--nonsense"}}) {
    const ProcessResult result = program(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors.rfind("sumo-gamma: ", 0), 0u) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
}

}  // namespace
}  // namespace sumogamma
