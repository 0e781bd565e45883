#include "app/scene_reading.h"

#include <charconv>
#include <string_view>

#include "base/error.h"

namespace sumogamma {

namespace {

bool parse_metres(std::string_view text, double& value) {
  constexpr double kLargest = 100.0;  // no body is longer [m]
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  return status == std::errc() && end == text.data() + text.size() && value > 0.0 &&
         value <= kLargest;
}

}  // namespace

void add_scene_reading_options(CLI::App& command, SceneArguments& arguments) {
  command
      .add_option("--point", arguments.point,
                  "which point of a body the recordings' positions are: centre or rear-axle")
      ->check(CLI::IsMember({"centre", "rear-axle"}))
      ->capture_default_str();
  command
      .add_option("--box", arguments.boxes,
                  "TYPE=LENGTHxWIDTH [m] of who has no size in the recording (may be repeated)")
      ->take_all()
      ->allow_extra_args(false);
  add_reading_options(command, arguments.reading);
}

SceneReading scene_reading(const SceneArguments& arguments) {
  SceneReading reading;
  reading.tracks = read_options(arguments.reading);
  if (arguments.point == "rear-axle") reading.point = RecordedPoint::RearAxle;
  for (const std::string& text : arguments.boxes) {
    const std::string_view whole = text;
    const std::size_t equals = whole.find('='), by = whole.find('x', equals + 1);
    double length = 0, width = 0;
    if (equals == std::string::npos || equals == 0 || by == std::string::npos ||
        !parse_metres(whole.substr(equals + 1, by - equals - 1), length) ||
        !parse_metres(whole.substr(by + 1), width))
      throw Error("--box " + text, "expected TYPE=LENGTHxWIDTH in metres, such as moped=1.8x0.7");
    reading.boxes[text.substr(0, equals)] = {length, width};
  }
  return reading;
}

}  // namespace sumogamma
