// Whatever SUMO answers over TraCI: it is read, or refused in one line; lengths that lie allocate
// nothing.
#include <cstdint>

#include "fuzz/parser.h"
#include "sumo/traci_answers.h"

using namespace sumogamma;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::span<const std::uint8_t> reply(data + 1, size - 1);
  return fuzz::read_or_say_why([&] {
    TraciReader reader(reply);
    switch (data[0] % 5) {
      case 0:
        read_details(reader, "v", false);
        break;
      case 1:
        read_details(reader, "p", true);
        break;
      case 2:
        read_texts(reader, traci::kVehicle, traci::kIdList);
        break;
      case 3:
        read_stage(reader);
        break;
      default:
        while (reader.remaining() > 0) reader.skip_value();
    }
  });
}
