#include "app/scenario_hash.h"

#include <vector>

#include "base/hash.h"
#include "io/output_file.h"

namespace sumogamma {

std::string hash_of_files(const ScenarioInput& input) {
  std::vector<std::filesystem::path> files{input.config, input.settings, input.network};
  files.insert(files.end(), input.routes.begin(), input.routes.end());
  files.insert(files.end(), input.additional.begin(), input.additional.end());
  std::uint64_t hash = kFnvBasis;
  for (const std::filesystem::path& file : files) {
    const std::string content = file.empty() ? std::string() : read_file(file);
    hash = fnv1a(hash_text(hash) + hash_text(hash_of_bytes(content)));
  }
  return hash_text(hash);
}

}  // namespace sumogamma
