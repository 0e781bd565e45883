// Whatever a recording (CSV, text) or a standalone scene holds: it is read, or refused in one line.
#include <cstdint>

#include "fuzz/parser.h"
#include "prediction/recording_formats.h"
#include "simulation/scene_file.h"

using namespace sumogamma;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const AgentTypeTable types = default_agent_types();
  const fuzz::MemoryFile file(data, size);
  fuzz::read_or_say_why([&] { read_raw_recording(file.path(), {}, types); });
  return fuzz::read_or_say_why([&] { read_scene_file(file.path(), Actuation::CarLike); });
}
