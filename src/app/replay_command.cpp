#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/page_camera.h"
#include "app/progress.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/number_text.h"
#include "base/print.h"
#include "io/output_file.h"
#include "io/output_folder.h"
#include "io/replay_page.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;

struct ReplayOptions {
  std::vector<std::string> folders;
  std::string output;
  std::optional<double> picture;  ///< [s]
  std::string video;
  std::optional<double> from, to;  ///< of the video [s]
  double rate = 1;                 ///< simulated over shown seconds
  int frames = 25;                 ///< a second
  std::string size = "1280x720", view;

  bool makes_picture() const { return picture || !video.empty(); }
};

PageCamera::Shot shot_of(const ReplayOptions& options) {
  constexpr int kLeast = 160, kMost = 4096;
  PageCamera::Shot shot;
  const std::string& text = options.size;
  const char* const end = text.data() + text.size();
  const auto [cross, error] = std::from_chars(text.data(), end, shot.width);
  const char* const second = cross == end ? end : cross + 1;
  const auto [last, other] = std::from_chars(second, end, shot.height);
  const bool fits =
      std::min(shot.width, shot.height) >= kLeast && std::max(shot.width, shot.height) <= kMost;
  if (error != std::errc() || other != std::errc() || last != end || *cross != 'x' || !fits)
    throw Error("--size " + text.substr(0, 60), "must be WIDTHxHEIGHT from 160 to 4096 pixels");
  // what H.264 stores in pairs
  shot.width &= ~1;
  shot.height &= ~1;
  shot.view = options.view + (options.view.empty() ? "" : "&") + "play=0&bare=1";
  return shot;
}

double checked_time(const std::string& option, double time, const PageCamera& camera) {
  constexpr double kSlack = 0.5;  // a run's last step isn't at its very end
  if (time < camera.begin() - kSlack || time > camera.end() + kSlack)
    throw Error(option + " " + number_text(time),
                fmt::format("isn't in the recording, which goes from {:.1f} to {:.1f} s",
                            camera.begin(), camera.end()));
  return std::clamp(time, camera.begin(), camera.end());
}

fs::path make_picture(const ReplayOptions& options, const fs::path& page, const fs::path& usual) {
  const fs::path file = options.output.empty() ? usual : fs::path(options.output);
  if (file.extension() != ".png")
    throw Error("--output " + file.string(), "is no name of a picture, expected FILE.png");
  PageCamera camera(page, shot_of(options));
  const double time = checked_time("--picture", *options.picture, camera);
  write_file(file, camera.picture(time, "png"));
  return file;
}

/// Frame by frame: as many as there are, however long each takes. Nothing stays where it doesn't
/// come to its end.
fs::path make_video(const ReplayOptions& options, const fs::path& page, bool quiet) {
  constexpr double kMostFrames = 100000;
  const fs::path file = options.video, part = file.string() + ".part.mp4";
  if (file.extension() != ".mp4")
    throw Error("--video " + file.string(), "is no name of a video, expected FILE.mp4");
  const fs::path ffmpeg = require_program({"ffmpeg"}, "ffmpeg", "a video");
  PageCamera camera(page, shot_of(options));
  const double from = options.from ? checked_time("--from", *options.from, camera) : camera.begin(),
               to = options.to ? checked_time("--to", *options.to, camera) : camera.end();
  const double step = options.rate / options.frames;  // of simulated time [s]
  const double count = std::floor((to - from) / step) + 1.0;
  if (!(count >= 2.0) || count > kMostFrames)
    throw Error("--video", fmt::format("would have {:.0f} pictures, expected 2 to {:.0f}: see "
                                       "--from, --to, --rate and --fps",
                                       count, kMostFrames));
  const ScratchFolder scratch;
  PipedProcess encoder(
      {{ffmpeg.string(), "-loglevel", "error", "-y", "-f", "image2pipe", "-framerate",
        std::to_string(options.frames), "-c:v", "mjpeg", "-i", "-", "-c:v", "libx264", "-pix_fmt",
        "yuv420p", "-movflags", "+faststart", fs::absolute(part).string()},
       0,
       -1,
       scratch.path() / "ffmpeg.log"});
  Progress progress("video", count, "pictures", quiet);
  const auto give_up = [&] {
    std::error_code ignored;
    fs::remove(part, ignored);
  };
  try {
    for (double i = 0; i < count; ++i) {
      if (interrupted()) break;
      encoder.write(camera.picture(from + i * step, "jpeg"));
      if (progress.due()) progress.update(i + 1.0, fmt::format("{:.0f} of {:.0f}", i + 1.0, count));
    }
    if (encoder.finish() != 0)
      throw Error(file.string(), "ffmpeg can't write it, see that there is room and the folder");
  } catch (...) {
    give_up();
    throw;
  }
  if (interrupted()) {
    give_up();
    return {};
  }
  fs::rename(part, file);
  return file;
}

void require_recording(const fs::path& folder) {
  if (!fs::exists(folder / "replay.bin"))
    throw Error(folder.string(),
                "holds no replay.bin, expected the output folder of `sumo-gamma run --replay`");
}

/// A picture or video: of a run's recording, or of a page that is there, as drives leave them.
fs::path picture_of(const ReplayOptions& options, const fs::path& shown, bool quiet) {
  const ScratchFolder scratch;
  const bool is_page = shown.extension() == ".html" && fs::is_regular_file(shown);
  const fs::path page = is_page ? shown : scratch.path() / "replay.html";
  if (!is_page) {
    require_recording(shown);
    write_replay_page(page, shown / "replay.bin");
  }
  if (!options.picture) return make_video(options, page, quiet);
  fs::path usual = shown / "replay.png";
  if (is_page) usual = fs::path(shown).replace_extension(".png");
  return make_picture(options, page, usual);
}

int run_replay(const ReplayOptions& options, const CommonOptions& common) {
  const bool one = options.folders.size() == 1;
  if (!one && (!options.output.empty() || options.makes_picture()))
    throw Error(options.output.empty() ? "--picture, --video" : "--output",
                "one file for several folders, name one folder");
  if (options.picture && !options.video.empty())
    throw Error("--picture", "and --video at once, make one after the other");
  for (const fs::path folder : options.folders) {
    fs::path made;
    if (options.makes_picture()) {
      made = picture_of(options, folder, common.quiet);
      if (made.empty()) return kExitInterrupted;
    } else {
      require_recording(folder);
      made = options.output.empty() ? folder / "replay.html" : fs::path(options.output);
      require_page_name(made);
      write_replay_page(made, folder / "replay.bin");
    }
    if (!common.quiet) print(stdout, "{}\n", made.string());
  }
  return kExitDone;
}

void add_picture_options(CLI::App& command, ReplayOptions& options) {
  command
      .add_option("--picture", options.picture,
                  "a picture of the page at this time instead (seconds or h:m:s), by Chromium")
      ->transform(time_span());
  command.add_option("--video", options.video,
                     "a video of the page instead: FILE.mp4, by Chromium and ffmpeg");
  command.add_option("--from", options.from, "where the video begins")->transform(time_span());
  command.add_option("--to", options.to, "where the video ends")->transform(time_span());
  command.add_option("--rate", options.rate, "simulated seconds in one of the video")
      ->check(finite_number(0.01, 1000.0))
      ->capture_default_str();
  command.add_option("--fps", options.frames, "pictures a second of the video")
      ->check(whole_number(1, 60))
      ->capture_default_str();
  command.add_option("--size", options.size, "of picture and video [px]")->capture_default_str();
  command.add_option("--view", options.view,
                     "what is shown how, as in the page's links: "
                     "'follow=car.3&paint=reason&theme=dark&x=10&y=20&s=8'");
}

}  // namespace

CommandRunner add_replay_command(CLI::App& parent) {
  CLI::App* command = parent.add_subcommand(
      "replay", "make the replay page of a run again from what it recorded; a picture, a video");
  auto options = std::make_shared<ReplayOptions>();
  command
      ->add_option("DIR", options->folders,
                   "output folder of `run --replay`, or for pictures and videos a page, as `drive "
                   "--replay` leaves")
      ->required();
  command->add_option("-o,--output", options->output,
                      "where to write the page or picture (one DIR alone; default "
                      "DIR/replay.html, DIR/replay.png)");
  add_picture_options(*command, *options);
  return [options](const CommonOptions& common) { return run_replay(*options, common); };
}

}  // namespace sumogamma
