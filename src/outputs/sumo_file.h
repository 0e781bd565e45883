#pragma once

#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sumogamma {

/// A file in one of SUMO's schemas, written under a hidden name until it is whole; gzipped where
/// its name ends in ".gz".
class SumoFile {
 public:
  /// Writes to `hidden`, which becomes `shown` in finish(). `root` and `schema`: "detector" and
  /// "det_e1_file.xsd". `precision`: decimals, SUMO's option of that name. Throws Error naming the
  /// file.
  SumoFile(std::filesystem::path hidden, std::filesystem::path shown, std::string_view root,
           std::string_view schema, int precision);
  ~SumoFile();
  SumoFile(const SumoFile&) = delete;
  SumoFile& operator=(const SumoFile&) = delete;

  /// Begins an element, which is open for attributes.
  SumoFile& open(std::string_view tag);
  SumoFile& number(std::string_view name, double value);
  SumoFile& time(std::string_view name, double value);  ///< [s]
  SumoFile& count(std::string_view name, std::int64_t value);
  SumoFile& word(std::string_view name, std::string_view value);
  /// Ends the innermost element.
  void close();

  /// Completes the file and gives it its name. Idempotent. Throws Error naming it.
  void finish();

 private:
  void end_tag();
  void write_out();

  std::filesystem::path hidden_, shown_;
  gzFile stream_ = nullptr;
  int precision_;
  std::string root_, text_;
  std::vector<std::string> open_;  ///< elements within the root
  bool in_tag_ = false;
};

/// A number as SUMO prints it, with so many decimals.
std::string sumo_number(double value, int precision);
/// A time as SUMO prints it [s]: whole milliseconds, three decimals at the most.
std::string sumo_time(double seconds, int precision);
}  // namespace sumogamma
