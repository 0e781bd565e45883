// Whatever a network file holds, gzipped or not: it is read, or refused in one line.
#include <cstdint>

#include "fuzz/parser.h"
#include "road/sumo_net_reader.h"

using namespace sumogamma;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  fuzz::read_or_say_why([&] { read_polygons(file.path()); });
  return fuzz::read_or_say_why([&] { read_sumo_net(file.path()); });
}
