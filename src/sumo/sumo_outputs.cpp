#include "sumo/sumo_outputs.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <set>
#include <system_error>

#include "base/error.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

/// SUMO's TIME in a prefix (OutputDevice::getDevice).
std::string with_time(std::string prefix) {
  const std::size_t place = prefix.find("TIME");
  if (place == std::string::npos) return prefix;
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d-%H-%M-%S", &local);
  return prefix.replace(place, 4, text.data());
}

std::vector<fs::path> hidden_files(const OutputNames& names, const std::vector<fs::path>& folders) {
  std::vector<fs::path> hidden;
  std::error_code ignored;
  for (const fs::path& folder : folders)
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored))
      if (entry.path().filename().string().starts_with(names.marker))
        hidden.push_back((folder / entry.path().filename()).lexically_normal());
  return hidden;
}

}  // namespace

std::string_view attribute_or(const XmlAttributes& attributes, std::string_view name,
                              std::string_view otherwise) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? otherwise : std::string_view(found->second);
}

bool asks_for(const std::vector<AskedOutput>& outputs, std::string_view what) {
  return std::any_of(outputs.begin(), outputs.end(),
                     [&](const AskedOutput& output) { return output.what == what; });
}

bool is_null_output(std::string_view name) {
  return name.empty() || name == "NUL" || name == "nul" || name == "/dev/null";
}

bool is_stream_output(std::string_view name) {
  if (name == "-" || name == "stdout" || name == "STDOUT" || name == "stderr" || name == "STDERR")
    return true;
  // SUMO takes everything with a colon behind its second letter for HOST:PORT
  const std::size_t colon = name.rfind(':');
  return colon != std::string_view::npos && colon > 1 && name.find('/') == std::string_view::npos;
}

fs::path output_file(std::string_view name, const fs::path& source) {
  // an absolute name wins over what it is appended to
  return source.parent_path() / fs::path(name);
}

fs::path OutputNames::hidden(const fs::path& file) const {
  return file.parent_path() / (sumo_prefix() + file.filename().string());
}

fs::path OutputNames::shown(const fs::path& file) const {
  return file.parent_path() / (prefix + file.filename().string());
}

OutputNames output_names(const SumoOptions& options) {
  const auto given = options.find("output-prefix");
  return {".sumo-gamma-" + std::to_string(getpid()) + "-",
          given == options.end() ? "" : with_time(given->second.value)};
}

void show_outputs(const OutputNames& names, const std::vector<fs::path>& folders,
                  const std::vector<fs::path>& written) {
  std::set<fs::path> ours;
  for (const fs::path& file : written) ours.insert(names.hidden(file).lexically_normal());
  std::error_code failed;
  for (const fs::path& file : hidden_files(names, folders)) {
    if (ours.contains(file)) {
      fs::remove(file, failed);
      continue;
    }
    const fs::path shown =
        file.parent_path() / file.filename().string().substr(names.marker.size());
    fs::rename(file, shown, failed);
    if (failed)
      throw Error(shown.string(), "can't be given its name (" + failed.message() +
                                      "), SUMO's output is in " + file.string());
  }
}

void drop_outputs(const OutputNames& names, const std::vector<fs::path>& folders) {
  std::error_code ignored;
  for (const fs::path& file : hidden_files(names, folders)) fs::remove(file, ignored);
}

}  // namespace sumogamma
