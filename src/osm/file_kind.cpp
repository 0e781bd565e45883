#include "osm/file_kind.h"

#include <algorithm>
#include <fstream>
#include <string_view>

#include "base/error.h"

namespace sumogamma::osm {
namespace {

constexpr std::size_t kLooked = 1024;  // bytes

std::string first_bytes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(kLooked, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

/// What else people take for an extract, by what it begins with, and what to do.
struct Stranger {
  std::string_view start, advice;
};
constexpr Stranger kStrangers[] = {
    {"PK\x03\x04", "is a zip archive: unpack it first"},
    {"\xfd"
     "7zXZ",
     "is compressed with xz: unpack it first"},
    {"\x28\xb5\x2f\xfd", "is compressed with zstd: unpack it first"},
    {"7z\xbc\xaf", "is a 7z archive: unpack it first"},
    {"{", "is JSON: ask Overpass for XML ([out:xml]), or export .osm"},
    {"[", "is JSON: ask Overpass for XML ([out:xml]), or export .osm"},
    {"\xff\xe0", "is an o5m file: convert it with osmconvert or osmium to .osm.pbf"},
    {"SQLite format 3", "is a database (GeoPackage?): expected .osm, .osm.gz, .osm.bz2, .osm.pbf"}};

/// Without a byte-order mark and white space in front.
std::string_view trimmed(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const std::size_t begin = bytes.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? std::string_view() : bytes.substr(begin);
}

}  // namespace

std::string kind_of_file(const std::filesystem::path& file) {
  const std::string bytes = first_bytes(file);
  const std::string_view text = trimmed(bytes);
  if (bytes.starts_with("\x1f\x8b")) return "osm.gz";
  if (bytes.starts_with("BZh")) return "osm.bz2";
  if (bytes.substr(0, 64).find("OSMHeader") != std::string::npos) return "pbf";
  for (const Stranger& stranger : kStrangers)
    if (text.starts_with(stranger.start)) throw Error(file.string(), stranger.advice);
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (lower.starts_with("<!doctype html") || lower.starts_with("<html"))
    throw Error(file.string(), "is a web page, perhaps a server's message: open it in a browser");
  if (lower.find("<net ") != std::string::npos && lower.find("<osm") == std::string::npos)
    throw Error(file.string(), "is a network of SUMO's, no map: run it with a .sumocfg");
  if (text.starts_with("<")) return "osm";
  const std::string name = file.filename().string();
  if (name.ends_with(".pbf"))
    throw Error(file.string(), "is no PBF file, whatever its name: download it again");
  throw Error(file.string(), "unknown kind of file; expected .osm, .osm.gz, .osm.bz2 or .osm.pbf");
}

}  // namespace sumogamma::osm
