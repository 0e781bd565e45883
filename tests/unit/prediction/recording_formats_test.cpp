#include "prediction/recording_formats.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "prediction/protocol.h"
#include "prediction/track_set.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

/// A folder of files that ends with the test.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("sumogamma_formats_" + std::to_string(getpid()));
  Folder() {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return path / name;
  }
};

/// Where agent `a` of ten is at a time: on its own line, at its own speed.
Vec2 place(int a, double time) { return {(1.0 + 0.1 * a) * time, 2.0 * a}; }

/// Ten agents for ten seconds, a line by `line(agent, frame, x, y)` for each and every frame.
template <typename Line>
std::string ten_agents(double rate, Line&& line, int first = 0, int agents = 10) {
  std::string text;
  for (int frame = 0; frame <= static_cast<int>(10 * rate); ++frame)
    for (int a = first; a < first + agents; ++a) {
      const Vec2 at = place(a, frame / rate);
      text += line(a, frame, at.x(), at.y());
    }
  return text;
}

void expect_the_ten(const TrackSet& set, const std::string& format, int agents = 10) {
  EXPECT_EQ(set.format, format);
  ASSERT_EQ(set.tracks.size(), static_cast<std::size_t>(agents));
  EXPECT_EQ(set.split_gaps, 0);
  for (int a = 0; a < agents; ++a) {
    const Track& track = set.tracks[static_cast<std::size_t>(a)];
    EXPECT_GE(track.position.size(), 24u);
    EXPECT_LE(track.position.size(), 26u);
    for (std::size_t k = 0; k < track.position.size(); ++k)
      EXPECT_LT((track.position[k] - place(a, 0.4 * static_cast<double>(k))).norm(), 2e-3);
  }
}

TEST(RecordingFormats, OwnCsvWithARateOrATime) {
  const Folder folder;
  const auto row = [](int a, int f, double x, double y) {
    return fmt::format("{},{},{},{:.4f},{:.4f}\n", f, a, a == 9 ? "truck" : "Pedestrian", x, y);
  };
  const auto file =
      folder.write("own.csv", "frame,agent_id,agent_type,x_m,y_m\n" + ten_agents(25, row));
  ReadOptions told;
  told.period = 1.0 / 25;
  const TrackSet set = read_track_set(file, told);
  expect_the_ten(set, "csv");
  EXPECT_EQ(type_of(recorded_agent_types(), set.tracks[9].type).name, "truck");
  // 25 frames a second aren't taken for 0.4 s in silence
  EXPECT_THROW(read_track_set(file), Error);
  for (const char* delimiter : {";", "\t"}) {
    std::string text = "time_s,id,x,y\n" + ten_agents(10, [](int a, int f, double x, double y) {
                         return fmt::format("{:.2f},p{},{:.4f},{:.4f}\n", 0.1 * f, a, x, y);
                       });
    for (char& c : text)
      if (c == ',') c = delimiter[0];
    expect_the_ten(read_track_set(folder.write("time.csv", text)), "csv");
  }
}

TEST(RecordingFormats, TextOfEthAndUcy) {
  const Folder folder;
  const auto row = [](int a, int f, double x, double y) {
    return fmt::format("{}\t{}\t{:.4f}\t{:.4f}\n", 10 * f, a, x, y);
  };
  const TrackSet set = read_track_set(folder.write("eth.txt", ten_agents(2.5, row)));
  expect_the_ten(set, "text");
  ASSERT_EQ(set.notes.size(), 1u);  // the rate is assumed, and it says so
}

TEST(RecordingFormats, CorridorsInCentimetres) {
  const Folder folder;
  std::string text;
  for (int a = 0; a < 10; ++a)
    for (int f = 0; f <= 160; ++f)
      text += fmt::format("{} {} {:.3f} {:.3f} 170.0\n", a, f, 100 * place(a, f / 16.0).x(),
                          100 * place(a, f / 16.0).y());
  expect_the_ten(read_track_set(folder.write("uo.txt", text)), "juelich");
}

TEST(RecordingFormats, TrajNetLines) {
  const Folder folder;
  const auto row = [](int a, int f, double x, double y) {
    return fmt::format(R"({{"track": {{"f": {}, "p": {}, "x": {:.4f}, "y": {:.4f}}}}})"
                       "\n",
                       10 * f, a, x, y);
  };
  expect_the_ten(
      read_track_set(folder.write("trajnet.ndjson",
                                  R"({"scene": {"id": 0, "p": 1, "s": 0, "e": 200, "fps": 2.5}})"
                                  "\n" +
                                      ten_agents(2.5, row))),
      "trajnet");
  EXPECT_THROW(read_track_set(folder.write("bad.ndjson", "{\"track\": {\"f\": 1}}\n")), Error);
}

TEST(RecordingFormats, InteractionWithWalkersBesideVehicles) {
  const Folder folder;
  const auto row = [](int a, int f, double x, double y) {
    return fmt::format("{},{},{},car,{:.4f},{:.4f},1,0,0.0,4.5,1.8\n", a, f + 1, 100 * (f + 1), x,
                       y);
  };
  const auto walker = [](int a, int f, double x, double y) {
    return fmt::format("P{},{},{},pedestrian/bicycle,{:.4f},{:.4f},1,0\n", a, f + 1, 100 * (f + 1),
                       x, y);
  };
  const std::string names = "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy";
  const auto file = folder.write("vehicle_tracks_000.csv",
                                 names + ",psi_rad,length,width\n" + ten_agents(10, row, 0, 6));
  expect_the_ten(read_track_set(file), "interaction", 6);
  EXPECT_EQ(read_track_set(file).tracks[3].length, 4.5);
  EXPECT_EQ(read_track_set(file).tracks[3].width, 1.8);
  folder.write("pedestrian_tracks_000.csv", names + "\n" + ten_agents(10, walker, 6, 4));
  expect_the_ten(read_track_set(file), "interaction");
}

TEST(RecordingFormats, LevelXWithItsMetaFiles) {
  const Folder folder;
  const auto row = [](int a, int f, double x, double y) {
    return fmt::format("1,{},{},{},{:.4f},{:.4f},90.0,1.8,4.5\n", a, f, f, x, y);
  };
  const auto file = folder.write(
      "01_tracks.csv",
      "recordingId,trackId,frame,trackLifetime,xCenter,yCenter,heading,width,length\n" +
          ten_agents(25, row));
  EXPECT_THROW(read_track_set(file), Error);  // without them there is no rate
  std::string classes = "recordingId,trackId,class\n";
  for (int a = 0; a < 10; ++a) classes += fmt::format("1,{},{}\n", a, a == 3 ? "truck_bus" : "car");
  folder.write("01_tracksMeta.csv", classes);
  folder.write("01_recordingMeta.csv", "recordingId,frameRate\n1,25\n");
  const TrackSet set = read_track_set(file);
  expect_the_ten(set, "levelx");
  EXPECT_EQ(type_of(recorded_agent_types(), set.tracks[3].type).name, "bus");
  EXPECT_NEAR(set.tracks[0].heading[5], std::acos(0.0), 1e-9);
}

TEST(RecordingFormats, HighDGivesCorners) {
  const Folder folder;
  const auto row = [](int a, int f, double x, double y) {
    return fmt::format("{},{},{:.4f},{:.4f},4.0,2.0,1.0,0.0\n", f, a, x - 2.0, y - 1.0);
  };
  const auto file = folder.write(
      "02_tracks.csv", "frame,id,x,y,width,height,xVelocity,yVelocity\n" + ten_agents(25, row));
  std::string classes = "id,class\n";
  for (int a = 0; a < 10; ++a) classes += fmt::format("{},Truck\n", a);
  folder.write("02_tracksMeta.csv", classes);
  folder.write("02_recordingMeta.csv", "id,frameRate\n2,25\n");
  expect_the_ten(read_track_set(file), "levelx");
}

TEST(RecordingFormats, SinD) {
  const Folder folder;
  const auto row = [](int a, int f, double x, double y) {
    return fmt::format("{},{},{:.4f},{},{:.4f},{:.4f},1,0,0.0,0.0,2,1\n", a, f, 100.1 * f,
                       a == 2 ? "tricycle" : "motorcycle", x, y);
  };
  const TrackSet set = read_track_set(folder.write(
      "Veh_smoothed_tracks.csv",
      "track_id,frame_id,timestamp_ms,agent_type,x,y,vx,vy,yaw_rad,heading_rad,length,width\n" +
          ten_agents(1 / 0.1001, row)));
  expect_the_ten(set, "sind");
  EXPECT_EQ(type_of(recorded_agent_types(), set.tracks[2].type).name, "electric_tricycle");
}

TEST(RecordingFormats, DutWithVehiclesBesideWalkers) {
  const Folder folder;
  const auto walker = [](int a, int f, double x, double y) {
    return fmt::format("{},{},ped,{:.5f},{:.5f},1,0\n", a, f, x, y);
  };
  const auto vehicle = [](int a, int f, double x, double y) {
    return fmt::format("{},{},veh,{:.5f},{:.5f},0.0,1\n", a - 8, f, x, y);
  };
  const auto file =
      folder.write("clip_traj_ped_filtered.csv",
                   "id,frame,label,x_est,y_est,vx_est,vy_est\n" + ten_agents(23.98, walker, 0, 8));
  folder.write("clip_traj_veh_filtered.csv",
               "id,frame,label,x_est,y_est,psi_est,vel_est\n" + ten_agents(23.98, vehicle, 8, 2));
  expect_the_ten(read_track_set(file), "dut");
}

TEST(RecordingFormats, SamplesAsOftenAsAsked) {
  const Folder folder;
  const auto row = [](int a, int f, double x, double y) {
    return fmt::format("{:.1f},{},{:.4f},{:.4f},,\n", 0.1 * f, a, x, y);
  };
  const fs::path file =
      folder.write("ten.csv", "time_s,agent_id,x_m,y_m,length_m,width_m\n" + ten_agents(10, row));
  ReadOptions options;
  options.sample = 0.1;
  const TrackSet set = read_track_set(file, options);
  EXPECT_EQ(set.period, 0.1);
  EXPECT_FALSE(set.assumed_period);
  ASSERT_EQ(set.tracks[2].position.size(), 101u);
  for (std::size_t k = 0; k <= 100; ++k)
    EXPECT_LT((set.tracks[2].position[k] - place(2, 0.1 * static_cast<double>(k))).norm(), 1e-3);
  EXPECT_EQ(set.tracks[2].length, 0.0) << "empty fields tell no size";
  EXPECT_THROW(read_track_set(folder.write("huge.csv",
                                           "time_s,agent_id,x_m,y_m,length_m,width_m\n"
                                           "0,1,0,0,500,2\n0.1,1,0,0,500,2\n")),
               Error);
}

TEST(RecordingFormats, FillsShortGapsAndCountsThem) {
  const Folder folder;
  std::string text;
  for (int f = 0; f < 40; ++f)
    if (f != 9 && f != 20 && f != 21 && f != 22)
      text += fmt::format("{} 1 {} 0\n", 10 * f, 0.5 * f);
  const auto file = folder.write("gaps.txt", text);
  const TrackSet set = read_track_set(file);
  ASSERT_EQ(set.tracks.size(), 2u);  // 1.6 s are too long
  EXPECT_EQ(set.filled_gaps, 1);
  EXPECT_EQ(set.filled_steps, 1);
  EXPECT_EQ(set.split_gaps, 1);
  EXPECT_NEAR(set.tracks[0].position[9].x(), 4.5, 1e-9);
  ReadOptions longer;
  longer.fill = 2;
  const TrackSet whole = read_track_set(file, longer);
  ASSERT_EQ(whole.tracks.size(), 1u);
  EXPECT_EQ(whole.filled_steps, 4);
  // no window is cut where its present was made of its future
  for (const Window& window : windows_of(whole, protocol_from_letter("C")))
    EXPECT_TRUE(window.frame != 9 && (window.frame < 20 || window.frame > 22));
  EXPECT_EQ(windows_of(whole, protocol_from_letter("C")).size(), 40u - 19u - 4u);
}

TEST(RecordingFormats, TellWhatTheyCannotUse) {
  const Folder folder;
  const std::string header = "frame,agent_id,agent_type,x_m,y_m\n";
  for (const std::string& text :
       {header + "0,1,pedestrian,1e300,0\n1,1,pedestrian,0,0\n", header + "0,1,lorry,0,0\n",
        std::string("0 1 0 0 0 0\n10 1 1 0 0 0\n"), std::string("a,b,c\n1,2,3\n")}) {
    const auto file = folder.write("wrong.csv", text);
    try {
      read_track_set(file);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("wrong.csv"), std::string::npos) << error.what();
    }
  }
  ReadOptions told;
  told.types["lorry"] = "truck";
  const auto lorry = folder.write("lorry.csv", header + "0,1,lorry,0,0\n1,1,lorry,1,0\n");
  EXPECT_EQ(read_track_set(lorry, told).tracks.size(), 1u);
  told.format = "dut";
  EXPECT_THROW(read_track_set(lorry, told), Error);
}

}  // namespace
}  // namespace sumogamma
