#include "outputs/step_output.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"
#include "base/time_text.h"
#include "base/xml_text.h"

namespace sumogamma {

namespace {

constexpr double kSame = 1e-6;  // [s]

[[noreturn]] void complain(const AskedOutput& output, std::string_view name,
                           std::string_view value) {
  throw Error(output.source, output.what + " " +
                                 std::string(attribute_or(output.attributes, "id")) + ": " +
                                 std::string(name) + "='" + std::string(value.substr(0, 80)) +
                                 "' can't be meant; SUMO 1.15's schema says what can");
}

}  // namespace

OutputIntervals::OutputIntervals(double period, double begin, double run_begin)
    : period_(period), last_(begin) {
  if (begin < run_begin && period > 0.0)
    last_ = run_begin - std::fmod(run_begin - begin + kSame, period) + kSame;
}

bool OutputIntervals::is_over(double time, bool end) const {
  if (period_ > 0.0 && last_ + period_ <= time + kSame) return true;
  return end && last_ < time - kSame;
}

TypeFilter::TypeFilter(std::string_view types) {
  for (std::string& word : words_of(types)) types_.insert(std::move(word));
}

double number_of(const AskedOutput& output, const XmlAttributes& attributes, std::string_view name,
                 double otherwise) {
  const std::string_view text = attribute_or(attributes, name);
  if (text.empty()) return otherwise;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    complain(output, name, text);
  return value;
}

double time_of(const AskedOutput& output, std::initializer_list<std::string_view> names,
               double otherwise) {
  for (const std::string_view name : names) {
    const std::string_view text = attribute_or(output.attributes, name);
    if (text.empty()) continue;
    const auto time = parse_time(std::string(text));
    if (!time) complain(output, name, text);
    return *time;
  }
  return otherwise;
}

LaneId lane_of(const RoadNetwork& network, const AskedOutput& output,
               const XmlAttributes& attributes, std::string_view name) {
  const std::string_view text = attribute_or(attributes, name);
  const auto lane = network.lane_by_name.find(std::string(text));
  if (lane == network.lane_by_name.end()) complain(output, name, text);
  return lane->second;
}

double place_on(const Lane& lane, double place) {
  return std::clamp(place < 0.0 ? place + lane.length : place, 0.0, lane.length);
}

}  // namespace sumogamma
