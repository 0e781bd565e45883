#include "sumo/libsumo_module.h"

#include <dlfcn.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "base/error.h"

namespace sumogamma {
namespace {

constexpr const char* kFile = "sumo-gamma-libsumo.so";

/// The folder of the shared library that this code is in; else the program's.
std::filesystem::path own_folder() {
  Dl_info info{};
  const void* const here = reinterpret_cast<const void*>(&own_folder);
  const bool known = dladdr(here, &info) != 0 && info.dli_fname != nullptr;
  const std::filesystem::path file = known ? info.dli_fname : "";
  if (file.filename().string().find(".so") != std::string::npos) return file.parent_path();
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

/// Beside the program or library; above it, where a build has its test programs; where a system
/// keeps modules.
std::filesystem::path find_module() {
  const std::filesystem::path here = own_folder();
  const std::array places{here / kFile, here.parent_path() / kFile,
                          here.parent_path() / "lib" / "sumo-gamma" / kFile,
                          here / "sumo-gamma" / kFile, here.parent_path() / "sumo-gamma" / kFile};
  for (const std::filesystem::path& place : places)
    if (std::filesystem::exists(place)) return place;
  throw Error(places.front().string(),
              "not found, though the libsumo back end is in it: build it, or use --backend traci");
}

/// Stays open to the program's end: libsumo keeps its simulation in static variables.
decltype(&sumogamma_start_libsumo) open_module() {
  const std::filesystem::path file = find_module();
  void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = module ? dlsym(module, "sumogamma_start_libsumo") : nullptr;
  if (function) return reinterpret_cast<decltype(&sumogamma_start_libsumo)>(function);
  const char* const why = dlerror();
  throw Error(file.string(), std::string("can't be opened: ") + (why ? why : "no reason given"));
}

}  // namespace

std::unique_ptr<SumoBackend> start_libsumo_backend(const SumoStart& start) {
  static const auto start_in_module = open_module();
  return std::unique_ptr<SumoBackend>(start_in_module(start));
}

}  // namespace sumogamma
