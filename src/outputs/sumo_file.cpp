#include "outputs/sumo_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/xml_text.h"

namespace sumogamma {

std::string sumo_number(double value, int precision) {
  char digits[400];
  const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed,
                                 std::clamp(precision, 0, 20));
  return {digits, end.ptr};
}

std::string sumo_time(double seconds, int precision) {
  return sumo_number(std::round(seconds * 1000.0) / 1000.0, std::min(precision, 3));
}

SumoFile::SumoFile(std::filesystem::path hidden, std::filesystem::path shown, std::string_view root,
                   std::string_view schema, int precision)
    : hidden_(std::move(hidden)), shown_(std::move(shown)), precision_(precision), root_(root) {
  // "T": plain text through the same interface
  stream_ = gzopen(hidden_.c_str(), shown_.extension() == ".gz" ? "wb4" : "wbT");
  if (!stream_)
    throw Error(shown_.string(), std::string("can't be written (") + std::strerror(errno) + ")");
  text_ =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\n"
      "<!-- written by sumo-gamma from the poses of all vehicles, in SUMO's schema -->\n\n<" +
      root_ +
      " xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:noNamespaceSchemaLocation=\"http://sumo.dlr.de/xsd/" +
      std::string(schema) + "\">\n";
}

SumoFile::~SumoFile() {
  if (!stream_) return;
  gzclose(stream_);
  std::error_code ignored;
  std::filesystem::remove(hidden_, ignored);
}

void SumoFile::end_tag() {
  if (in_tag_) text_ += ">\n";
  in_tag_ = false;
}

SumoFile& SumoFile::open(std::string_view tag) {
  end_tag();
  open_.emplace_back(tag);
  text_.append(4 * open_.size(), ' ');
  text_ += '<';
  text_ += tag;
  in_tag_ = true;
  return *this;
}

SumoFile& SumoFile::word(std::string_view name, std::string_view value) {
  text_ += ' ';
  text_ += name;
  text_ += "=\"";
  append_escaped(text_, value);
  text_ += '"';
  return *this;
}

SumoFile& SumoFile::number(std::string_view name, double value) {
  return word(name, sumo_number(value, precision_));
}

SumoFile& SumoFile::time(std::string_view name, double value) {
  return word(name, sumo_time(value, precision_));
}

SumoFile& SumoFile::count(std::string_view name, std::int64_t value) {
  return word(name, std::to_string(value));
}

void SumoFile::close() {
  if (in_tag_) {
    text_ += "/>\n";
  } else {
    text_.append(4 * open_.size(), ' ');
    text_ += "</" + open_.back() + ">\n";
  }
  in_tag_ = false;
  open_.pop_back();
  constexpr std::size_t kChunk = 1 << 16;
  if (text_.size() > kChunk) write_out();
}

void SumoFile::write_out() {
  if (!text_.empty() && gzwrite(stream_, text_.data(), static_cast<unsigned>(text_.size())) <= 0)
    throw Error(shown_.string(), "can't be written to its end, make room and run again");
  text_.clear();
}

void SumoFile::finish() {
  if (!stream_) return;
  while (!open_.empty()) close();
  text_ += "</" + root_ + ">\n";
  write_out();
  const int code = gzclose(std::exchange(stream_, nullptr));
  std::error_code failed;
  if (code == Z_OK) std::filesystem::rename(hidden_, shown_, failed);
  if (code != Z_OK || failed)
    throw Error(shown_.string(), "can't be written to its end" +
                                     (failed ? " (" + failed.message() + ")" : std::string()));
}

}  // namespace sumogamma
