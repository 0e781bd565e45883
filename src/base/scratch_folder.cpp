#include "base/scratch_folder.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <system_error>

#include "base/error.h"

namespace sumogamma {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "sumo-gamma-XXXXXX").string();
  if (!mkdtemp(name.data())) throw Error(name, "can't be made: is the disk full?");
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path ScratchFolder::file(const char* name, const std::string& content) const {
  std::ofstream(path_ / name, std::ios::binary) << content;
  return path_ / name;
}

}  // namespace sumogamma
