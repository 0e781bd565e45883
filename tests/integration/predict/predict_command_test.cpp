#include <gtest/gtest.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/subprocess.h"
#include "geometry/vec2.h"
#include "road/sumo_net_reader.h"

namespace sumogamma {
namespace {

ProcessResult predict(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {SUMOGAMMA_PROGRAM, "predict", "--quiet"});
  return run_process({.arguments = std::move(arguments),
                      .environment = {},
                      .folder = {},
                      .time_limit = 300.0,
                      .output_limit = 1 << 24,
                      .should_stop = {}});
}

/// Of the running test alone: tests run side by side.
std::filesystem::path own_folder() {
  const auto folder = std::filesystem::temp_directory_path() /
                      (std::string("sumogamma_predict_") +
                       ::testing::UnitTest::GetInstance()->current_test_info()->name() + "_" +
                       std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  return folder;
}

/// Five walkers on straight lines, in the common text format.
std::string small_recording() {
  const auto path = std::filesystem::temp_directory_path() /
                    ("sumogamma_predict_" + std::to_string(getpid()) + ".txt");
  std::ofstream file(path);
  for (int frame = 0; frame < 30; ++frame)
    for (int agent = 1; agent <= 5; ++agent)
      file << 10 * frame << ' ' << agent << ' ' << 0.5 * frame << ' ' << 3 * agent << '\n';
  return path.string();
}

TEST(PredictCommand, ScoresARecordingAndWritesJson) {
  const auto json_path = own_folder() / "sumogamma_predict.json";
  const ProcessResult result = predict(
      {small_recording(), "--method", "gamma,cv", "--samples", "10", "--json", json_path.string()});
  ASSERT_TRUE(result.ok()) << result.errors;
  EXPECT_NE(result.output.find("constant velocity"), std::string::npos);
  const auto json = nlohmann::json::parse(std::ifstream(json_path));
  ASSERT_EQ(json.at("evaluations").size(), 2u);
  EXPECT_EQ(json["evaluations"][0]["windows"], 5 * 11);
  EXPECT_LT(json["evaluations"][0]["ade"], 0.35);
  EXPECT_NEAR(json["evaluations"][1]["ade"], 0.0, 1e-9);
  EXPECT_TRUE(json["evaluations"][0].contains("inside_90"));
}

/// The table's figures, to four digits, from the exported rows alone, by a program of its own.
TEST(PredictCommand, ExportsWhatAnIndependentScorerNeeds) {
  const auto folder = own_folder();
  const std::string rows = (folder / "sumogamma_export.csv").string();
  const std::string json_path = (folder / "sumogamma_export.json").string();
  const auto hotel =
      std::filesystem::path(SUMOGAMMA_SHARED_DIR) / "data" / "trajectories" / "hotel.csv";
  const std::string recording = std::filesystem::exists(hotel) ? hotel.string() : small_recording();
  for (const char* protocol : {"A", "C"}) {
    SCOPED_TRACE(protocol);
    const ProcessResult result =
        predict({recording, "--method", "gamma,cv-fan,mean", "--samples", "4", "--protocol",
                 protocol, "--json", json_path, "--export", rows});
    ASSERT_TRUE(result.ok()) << result.errors;
    const ProcessResult scored = run_process(
        {.arguments = {"python3", std::string(SUMOGAMMA_SOURCE_DIR) + "/tools/score_predictions.py",
                       rows, "--json", "--protocol", protocol},
         .environment = {},
         .folder = {},
         .time_limit = 300.0,
         .output_limit = 1 << 20,
         .should_stop = {}});
    ASSERT_TRUE(scored.ok()) << scored.errors;
    const auto ours = nlohmann::json::parse(std::ifstream(json_path)).at("evaluations");
    const auto theirs = nlohmann::json::parse(scored.output);
    ASSERT_EQ(ours.size(), 3u);
    ASSERT_EQ(theirs.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(theirs[k].at("method"), ours[k].at("method"));
      EXPECT_EQ(theirs[k].at("windows"), ours[k].at("windows"));
      EXPECT_EQ(theirs[k].at("memory"), "strict");
      for (const char* figure : {"ade", "fde", "miss_rate", "min_ade", "min_fde"})
        if (ours[k].contains(figure)) {
          EXPECT_NEAR(theirs[k].at(figure).get<double>(), ours[k].at(figure).get<double>(), 5e-5);
        }
    }
  }
}

/// Numbers of a column of a small Parquet file as ParquetWriter makes it, decoded by hand: one
/// group, plain doubles compressed by zstd, the columns' pages one after the other.
std::vector<std::vector<double>> parquet_pages(const std::string& path, std::size_t rows) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  std::vector<std::vector<double>> pages;
  const std::string magic = "\x28\xb5\x2f\xfd";  // of a zstd frame
  for (std::size_t at = bytes.find(magic); at != std::string::npos;) {
    const std::size_t size = ZSTD_findFrameCompressedSize(bytes.data() + at, bytes.size() - at);
    if (ZSTD_isError(size) != 0) break;
    std::string plain(ZSTD_getFrameContentSize(bytes.data() + at, size), '\0');
    ZSTD_decompress(plain.data(), plain.size(), bytes.data() + at, size);
    std::vector<double> values;
    if (plain.size() == rows * sizeof(double)) {
      values.resize(rows);
      std::memcpy(values.data(), plain.data(), plain.size());
    }
    pages.push_back(std::move(values));
    at = bytes.find(magic, at + size);
  }
  return pages;
}

TEST(PredictCommand, ExportsTheSameToParquet) {
  const auto folder = own_folder();
  const std::string csv = (folder / "sumogamma_export.csv").string();
  const std::string parquet = (folder / "sumogamma_export.parquet").string();
  for (const std::string& file : {csv, parquet})
    ASSERT_TRUE(predict({small_recording(), "--method", "cv,mean", "--export", file}).ok());
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);
  std::vector<std::vector<std::string>> rows;
  while (std::getline(file, line)) {
    std::vector<std::string>& fields = rows.emplace_back();
    std::istringstream text(line);
    for (std::string field; std::getline(text, field, ',');) fields.push_back(field);
    ASSERT_EQ(fields.size(), 13u);
  }
  ASSERT_GT(rows.size(), 100u);
  const auto pages = parquet_pages(parquet, rows.size());
  ASSERT_EQ(pages.size(), 13u);
  for (const std::size_t column : {3u, 5u, 6u, 7u, 8u, 9u, 10u, 11u, 12u}) {
    ASSERT_EQ(pages[column].size(), rows.size()) << column;
    for (std::size_t row = 0; row < rows.size(); ++row)
      ASSERT_NEAR(pages[column][row], std::stod(rows[row][column]), 1e-6) << column << " " << row;
  }
  EXPECT_FALSE(std::filesystem::exists(parquet + ".part"));
  EXPECT_EQ(predict({small_recording(), "--export", "/nowhere/x.parquet"}).exit_code, 2);
  EXPECT_EQ(predict({small_recording(), "--export", "/nowhere/x.csv"}).exit_code, 2);
}

TEST(PredictCommand, SaysWhichMemoryAndKeepsPublishedRowsBesideStrict) {
  const auto named = own_folder() / "hotel.txt";
  std::filesystem::copy_file(small_recording(), named,
                             std::filesystem::copy_options::overwrite_existing);
  const ProcessResult strict = predict({named.string(), "--method", "cv"});
  EXPECT_NE(strict.output.find("Memory: strict"), std::string::npos) << strict.output;
  EXPECT_NE(strict.output.find("as published"), std::string::npos);
  const ProcessResult online = predict({named.string(), "--memory", "online"});
  ASSERT_TRUE(online.ok()) << online.errors;
  EXPECT_NE(online.output.find("Memory: online"), std::string::npos);
  EXPECT_NE(online.output.find("constant velocity + flow"), std::string::npos) << online.output;
  EXPECT_EQ(online.output.find("as published"), std::string::npos);
  EXPECT_EQ(predict({named.string(), "--memory", "none"}).exit_code, 2);
}

TEST(PredictCommand, MeasuresSamplesByClassSpeedAndStep) {
  const auto json_path = own_folder() / "sumogamma_samples.json";
  for (const std::string draws : {"independent", "even"}) {
    SCOPED_TRACE(draws);
    const ProcessResult result =
        predict({small_recording(), "--method", "gamma,cv", "--samples", "6", "--draws", draws,
                 "--calibration", "--json", json_path.string()});
    ASSERT_TRUE(result.ok()) << result.errors;
    EXPECT_NE(result.output.find(draws + " draws"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("Calibration:"), std::string::npos);
    const auto json = nlohmann::json::parse(std::ifstream(json_path));
    EXPECT_EQ(json.at("draws"), draws);
    const auto& gamma = json.at("evaluations")[0];
    EXPECT_EQ(gamma.at("draws"), draws);
    EXPECT_EQ(gamma.at("against").at("method"), "cv");
    const double difference =
        gamma.at("ade").get<double>() - json.at("evaluations")[1].at("ade").get<double>();
    EXPECT_NEAR(gamma.at("against").at("ade").get<double>(), difference, 1e-9);
    EXPECT_FALSE(json.at("evaluations")[1].contains("against"));
    std::size_t windows = 0;
    double inside = 0;
    for (const auto& stratum : gamma.at("calibration")) {
      windows += stratum.at("windows").get<std::size_t>();
      ASSERT_EQ(stratum.at("inside_90").size(), 12u);
      for (const auto& share : stratum.at("inside_90"))
        inside += share.get<double>() * stratum.at("windows").get<double>() / 12.0;
    }
    EXPECT_EQ(windows, gamma.at("windows").get<std::size_t>());
    EXPECT_NEAR(inside / static_cast<double>(windows), gamma.at("inside_90").get<double>(), 1e-9);
  }
}

TEST(PredictCommand, NamesEveryMethodInItsHelp) {
  const ProcessResult help = predict({"--help"});
  for (const char* name :
       {"gamma-no-experts", "oracle", "cv-fan", "mean", "kalman", "ctra", "+flow"})
    EXPECT_NE(help.output.find(name), std::string::npos) << name;
}

TEST(PredictCommand, DrawsPictures) {
  const auto folder = own_folder() / "sumogamma_predict_plots";
  std::filesystem::remove_all(folder);
  const ProcessResult result =
      predict({small_recording(), "--method", "cv", "--plots", folder.string()});
  ASSERT_TRUE(result.ok()) << result.errors;
  ASSERT_FALSE(std::filesystem::is_empty(folder));
}

/// A file with such a content.
std::string made_file(const std::string& name, const std::string& text) {
  const auto path = own_folder() / ("sumogamma_predict_" + std::to_string(getpid()) + "_" + name);
  std::ofstream(path) << text;
  return path.string();
}

TEST(PredictCommand, RefusesBadRecordingsWithOneLine) {
  const std::string header = "frame,agent_id,agent_type,x_m,y_m\n";
  struct Row {
    const char* name;
    std::string text;
    const char* words;
  };
  const Row rows[] = {
      {"empty.csv", "", "no observations"},
      {"header.csv", header, "no observations"},
      {"nan.csv", header + "0,1,pedestrian,nan,0\n", ":2: x is"},
      {"twice.csv", header + "0,1,pedestrian,0,0\n0,1,pedestrian,1,0\n", "twice in frame 0"},
      {"type.csv", header + "0,1,dragon,0,0\n", "dragon"},
      {"short.txt", "0 1 0 0\n10 1 1 0\n", "20 frames"},
      {"times.txt", "0 1 0 0\n1000000000 1 0 0\n7 2 0 0\n", "counted steps"},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    const ProcessResult result = predict({made_file(row.name, row.text)});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors.rfind("sumo-gamma: ", 0), 0u) << result.errors;
    EXPECT_NE(result.errors.find(row.words), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
}

TEST(PredictCommand, LeavesOutWhatCannotBeUsedAndWritesTheRest) {
  const auto json_path = own_folder() / "sumogamma_left_out.json";
  const std::string bad = made_file("bad.csv", "frame,agent_id,x,y\n0,1,1e300,0\n");
  const ProcessResult result =
      predict({bad, small_recording(), "--method", "cv", "--json", json_path.string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("left out: " + bad), std::string::npos) << result.errors;
  EXPECT_NE(result.output.find("55 windows"), std::string::npos) << result.output;
  const auto json = nlohmann::json::parse(std::ifstream(json_path));
  EXPECT_EQ(json.at("left_out").size(), 1u);
  EXPECT_EQ(json.at("evaluations").size(), 1u);
  EXPECT_EQ(json.at("memory"), "strict");
}

TEST(PredictCommand, TakesTheRateThatItIsTold) {
  std::string text = "frame,agent_id,x_m,y_m\n";
  for (int frame = 0; frame < 300; ++frame) {
    text += std::to_string(frame) + ",1," + std::to_string(0.05 * frame) + ",2\n";
    text += std::to_string(frame) + ",2," + std::to_string(0.05 * frame) + ",4\n";
  }
  const std::string file = made_file("native.csv", text);
  const ProcessResult silent = predict({file, "--method", "cv"});
  EXPECT_EQ(silent.exit_code, 2);
  EXPECT_NE(silent.errors.find("--fps"), std::string::npos) << silent.errors;
  const ProcessResult told = predict({file, "--method", "cv", "--fps", "25"});
  EXPECT_EQ(told.exit_code, 0) << told.errors;
  EXPECT_NE(told.output.find("22 windows"), std::string::npos) << told.output;
}

TEST(PredictCommand, TakesOneAgentAlone) {
  std::string text;
  for (int frame = 0; frame < 25; ++frame)
    text += std::to_string(10 * frame) + ".0\t1.0\t" + std::to_string(0.5 * frame) + "\t2.0\r\n";
  const ProcessResult result =
      predict({made_file("alone.txt", "\xEF\xBB\xBF" + text), "--samples", "5"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("6 windows"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("chosen without it"), std::string::npos) << result.output;
  EXPECT_EQ(result.output.find("nan"), std::string::npos) << result.output;
}

/// Two cars on the east-west road of the signalled crossing's scenario, one in the fields beside
/// it; `away` from its axes [m].
std::string recorded_on_crossing(const std::filesystem::path& folder, double away) {
  const auto path = folder / ("away_" + std::to_string(static_cast<int>(away)) + ".csv");
  std::ofstream file(path);
  file << "time_s,agent_id,agent_type,x_m,y_m\n";
  const RoadNetwork network =
      read_sumo_net(SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/signalled_crossing/net.net.xml");
  const Lane* longest = nullptr;
  for (const Lane& lane : network.lanes)
    if (lane.kind == LaneKind::Normal && (lane.allowed & vehicle_class::kPassenger) != 0 &&
        (longest == nullptr || lane.centerline.length() > longest->centerline.length()))
      longest = &lane;
  for (int frame = 0; frame < 22; ++frame) {
    const Vec2 at = longest->centerline.point_at(5 + 1.6 * frame), off(away, away);
    const Vec2 one = at + off, field = at + off + 300 * left_of(Vec2(1, 0));
    file << 0.4 * frame << ",1,car," << one.x() << ',' << one.y() << '\n';
    file << 0.4 * frame << ",2,car," << field.x() << ',' << field.y() << '\n';
  }
  return path.string();
}

TEST(PredictCommand, TakesAMapAndSaysWhoLiesOnIt) {
  const auto folder = own_folder();
  const std::string scenario = SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/signalled_crossing";
  const auto run_on = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--json", (folder / "out.json").string()});
    const ProcessResult result = predict(more);
    EXPECT_TRUE(result.ok()) << result.errors;
    EXPECT_NE(result.output.find("with the map less without it"), std::string::npos);
    return nlohmann::json::parse(std::ifstream(folder / "out.json"));
  };
  const auto here = run_on({recorded_on_crossing(folder, 0), "--map", scenario});
  EXPECT_EQ(here["map"]["network"], scenario + "/net.net.xml");
  EXPECT_EQ(here["map"]["recorded_signals"], 0) << "a program of the scenario's own";
  EXPECT_EQ(here["recordings"][0]["map"]["agents_on_wheels"], 2);
  EXPECT_EQ(here["recordings"][0]["map"]["on_map"], 1);
  EXPECT_EQ(here["evaluations"][0]["against_without_map"]["method"], "gamma-no-map");
  // in other axes, and told so
  const std::string away = recorded_on_crossing(folder, 2000);
  const auto there = run_on({away, "--map", scenario + "/net.net.xml", "--map-offset=-2000,-2000"});
  EXPECT_EQ(there["recordings"][0]["map"]["on_map"], 1);
  EXPECT_NEAR(there["evaluations"][0]["ade"].get<double>(),
              here["evaluations"][0]["ade"].get<double>(), 1e-3);
  // without a map there is none in the JSON
  ASSERT_TRUE(predict({away, "--method", "gamma", "--json", (folder / "out.json").string()}).ok());
  EXPECT_TRUE(nlohmann::json::parse(std::ifstream(folder / "out.json"))["map"].is_null());
}

TEST(PredictCommand, PlacesTheMapByTheOriginOfTheAxes) {
  const auto folder = own_folder();
  const std::string scenario = SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/signalled_crossing";
  std::stringstream net;
  net << std::ifstream(scenario + "/net.net.xml").rdbuf();
  std::string text = net.str();
  const std::size_t begin = text.find("<location"), end = text.find("/>", begin);
  ASSERT_NE(begin, std::string::npos);
  text.replace(begin, end - begin,
               R"(<location netOffset="-2000.00,-2000.00" convBoundary="0,0,1,1" )"
               R"(origBoundary="0,0,1,1" projParameter="+proj=tmerc +lat_0=48 +lon_0=11 )"
               R"(+ellps=WGS84 +units=m +no_defs")");
  const std::string map = (folder / "geo.net.xml").string();
  std::ofstream(map) << text;
  const ProcessResult result =
      predict({recorded_on_crossing(folder, 2000), "--map", map, "--map-origin", "48,11",
               "--method", "gamma", "--json", (folder / "out.json").string()});
  ASSERT_TRUE(result.ok()) << result.errors;
  const auto json = nlohmann::json::parse(std::ifstream(folder / "out.json"));
  EXPECT_NEAR(json["map"]["offset_m"][0].get<double>(), -2000, 1e-3);
  EXPECT_NEAR(json["map"]["offset_m"][1].get<double>(), -2000, 1e-3);
  EXPECT_EQ(json["recordings"][0]["map"]["on_map"], 1);
}

TEST(PredictCommand, RefusesAMapThatFitsNobody) {
  const auto folder = own_folder();
  const std::string scenario = SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/signalled_crossing";
  const std::string away = recorded_on_crossing(folder, 2000);
  for (const auto& [arguments, told] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{away, "--map", scenario}, "--map-offset"},
           {{small_recording(), "--map", scenario}, "nobody is on wheels"},
           {{away, "--map", away}, "is no map"},
           {{away, "--map", folder.string()}, "has 0 networks"},
           {{away, "--map-offset", "1,2"}, "--map NAME.net.xml"},
           {{away, "--map", scenario, "--map-offset", "nan,2"}, "--map-offset"},
           {{away, "--map", scenario, "--map-offset", "1,2", "--map-origin", "48,11"},
            "expected one of them"}}) {
    const ProcessResult result = predict(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.errors.find(told), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
}

TEST(PredictCommand, RefusesBadInputWithOneLine) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"nowhere.csv"},
                                             {},
                                             {small_recording(), "--protocol", "Z"},
                                             {small_recording(), "--method", "magic"},
                                             {small_recording(), "--samples", "1"},
                                             {small_recording(), "--draws", "lots"},
                                             {small_recording(), "--calibration"},
                                             {small_recording(), "--set", "predict.luck=1"}}) {
    const ProcessResult result = predict(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors.rfind("sumo-gamma: ", 0), 0u) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  }
}

}  // namespace
}  // namespace sumogamma
