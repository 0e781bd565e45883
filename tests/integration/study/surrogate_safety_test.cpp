#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <pugixml.hpp>

#include "base/csv_text.h"
#include "base/subprocess.h"
#include "io/output_file.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

struct LeastTime {
  double time_to_collision = 1e9, deceleration = 0;
};
using ByPair = std::map<std::string, LeastTime>;

std::string pair_of(const std::string& a, const std::string& b) {
  return std::min(a, b) + " " + std::max(a, b);
}

void run_words(const std::vector<std::string>& words) {
  ProcessRequest request;
  request.arguments = words;
  const ProcessResult result = run_process(request);
  ASSERT_TRUE(result.ok()) << result.errors << describe_end(result, request.time_limit);
}

ByPair of_ssm_device(const fs::path& file) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_file(file.c_str()));
  ByPair pairs;
  for (const pugi::xml_node conflict : document.child("SSMLog").children("conflict")) {
    const std::string time = conflict.child("minTTC").attribute("value").value();
    if (time.empty() || time == "NA") continue;
    LeastTime& least =
        pairs[pair_of(conflict.attribute("ego").value(), conflict.attribute("foe").value())];
    least.time_to_collision = std::min(least.time_to_collision, std::stod(time));
    least.deceleration =
        std::max(least.deceleration, conflict.child("maxDRAC").attribute("value").as_double());
  }
  return pairs;
}

ByPair of_conflicts(const fs::path& file) {
  ByPair pairs;
  visit_csv_rows(read_file(file), [&](const CsvRow& row) {
    LeastTime& least =
        pairs[pair_of(std::string(row.text("agent")), std::string(row.text("other")))];
    least.time_to_collision = std::min(least.time_to_collision, row.number("ttc_s").value_or(1e9));
    least.deceleration = std::max(least.deceleration, row.number("drac").value_or(0));
  });
  return pairs;
}

// three platoons whose first car halts, driven by SUMO: in a lane the plane's time to collision is
// that of SUMO's own SSM device, which measures along lanes
TEST(SurrogateSafety, AgreesWithSumosDeviceInCarFollowing) {
  const fs::path folder =
      fs::temp_directory_path() / ("sumogamma_safety_" + std::to_string(getpid()));
  fs::create_directories(folder);
  const std::string scenario = SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/platoon/platoon.sumocfg";
  run_words({SUMOGAMMA_PROGRAM, "run", scenario, "-o", (folder / "run").string(), "--control",
             "none", "--step", "0.1", "--seed", "1", "--duration", "100", "--quiet"});
  run_words({find_program("sumo").string(),
             "-c",
             scenario,
             "--step-length",
             "0.1",
             "--seed",
             "1",
             "--end",
             "100",
             "--no-step-log",
             "true",
             "--device.ssm.probability",
             "1",
             "--device.ssm.file",
             (folder / "ssm.xml").string(),
             "--device.ssm.measures",
             "TTC DRAC",
             "--device.ssm.thresholds",
             "3.0 3.0",
             "--device.ssm.range",
             "80"});
  const ByPair device = of_ssm_device(folder / "ssm.xml");
  const ByPair ours = of_conflicts(folder / "run/conflicts.csv");
  fs::remove_all(folder);
  EXPECT_GE(device.size(), 8u);
  EXPECT_EQ(device.size(), ours.size());
  for (const auto& [pair, least] : device) {
    SCOPED_TRACE(pair);
    ASSERT_TRUE(ours.contains(pair));
    // it writes two decimals
    EXPECT_NEAR(ours.at(pair).time_to_collision, least.time_to_collision, 0.011);
    // its DRAC is looked at in other moments: up to 0.03 apart
    EXPECT_NEAR(ours.at(pair).deceleration, least.deceleration, 0.04);
  }
}

}  // namespace
}  // namespace sumogamma
