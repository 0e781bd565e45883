// Whatever scenario.toml says: it is taken, or refused in one line.
#include <cstdint>

#include "fuzz/parser.h"
#include "io/config.h"

using namespace sumogamma;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  return fuzz::read_or_say_why([&] { read_config(file.path()); });
}
