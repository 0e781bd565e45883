#include "io/replay.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/units.h"
#include "io/output_file.h"
#include "io/page_assets.h"
#include "io/replay_map.h"

namespace sumogamma {

// The layout, inside gzip. count: unsigned, seven bits a byte, low first. signed: zigzag of a
// count. text: count, bytes.
//
//   "SGR1"  text(map JSON)  record*
//   record 1, a step:   count(milliseconds since the last step)
//                       count(gone)  count(index in the list of agents, less the previous one)*
//                       count(new)   [count(id) byte(type) byte(driven by SUMO) text(name)
//                                     byte(corners) signed(x, y of each corner in cm, body axes)]*
//                       for every agent, in order of id: signed(second difference of x, of y in
//                       cm), signed(turn in 1/4096 of a circle), byte(why it can't go faster, as
//                       LimitReason; +16: active)
//   record 2, signals:  count(changed) [count(signal) text(state)]*
//   record 3, an event: byte(kind) count(milliseconds) signed(x, y in cm) count(a) count(b + 1, 0
//   for nobody) record 0: the end
//
// New agents stand at the end of the list: ids only grow. A new agent's differences start from
// zero.

namespace {

constexpr double kTurnSteps = 4096.0;

std::int64_t centimetres(double metres) { return std::llround(metres * 100.0); }

std::int64_t turn_steps(double angle) {
  return std::llround(angle / (2.0 * kPi) * kTurnSteps) &
         (static_cast<std::int64_t>(kTurnSteps) - 1);
}

}  // namespace

ReplayRecorder::ReplayRecorder(const std::filesystem::path& file, const std::string& title,
                               const RoadNetwork& network, const AgentTypeTable& types,
                               double period)
    : file_(file), period_(period) {
  stream_ = gzopen(file.c_str(), "wb6");
  if (!stream_)
    throw Error(file.string(), std::string("can't be written (") + std::strerror(errno) + ")");
  buffer_ = "SGR1";
  put_text(replay_map_json(title, network, types));
  flush();
}

ReplayRecorder::~ReplayRecorder() {
  try {
    close();
  } catch (const Error&) {
    // an exception is on its way already, or nobody asked whether the end was written
  }
}

void ReplayRecorder::put_count(std::uint64_t value) {
  while (value >= 0x80) {
    put_byte(static_cast<unsigned>(value) | 0x80u);
    value >>= 7;
  }
  put_byte(static_cast<unsigned>(value));
}

void ReplayRecorder::put_signed(std::int64_t value) {
  put_count((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}

void ReplayRecorder::put_text(std::string_view text) {
  put_count(text.size());
  buffer_ += text;
}

void ReplayRecorder::flush() {
  if (buffer_.empty() || !stream_) return;
  if (gzwrite(stream_, buffer_.data(), static_cast<unsigned>(buffer_.size())) <= 0) {
    const std::string why = std::strerror(errno);
    gzclose(stream_);
    stream_ = nullptr;
    throw Error(file_.string(),
                "can't be written to its end (" + why + "), make room and run again");
  }
  buffer_.clear();
}

void ReplayRecorder::add(const Scene& scene, const RoadState* road, const AgentName& name_of,
                         const AgentTypeTable* types) {
  if (!stream_) throw Error(file_.string(), "is closed already");
  // a little early: sums of steps don't meet the period exactly
  if (started_ && scene.time < next_time_ - 1e-6) return;
  next_time_ = started_ ? std::max(next_time_ + period_, scene.time) : scene.time + period_;
  if (road) append_signals(*road);
  const std::int64_t ms = std::llround(scene.time * 1000.0);
  put_byte(1);
  put_count(static_cast<std::uint64_t>(std::max<std::int64_t>(ms - last_ms_, 0)));
  last_ms_ = ms;
  started_ = true;
  append_changes(scene, name_of, types);
  append_poses(scene);
  constexpr std::size_t kFlushAt = 1 << 16;
  if (buffer_.size() >= kFlushAt) flush();
}

void ReplayRecorder::append_changes(const Scene& scene, const AgentName& name_of,
                                    const AgentTypeTable* types) {
  next_.clear();
  std::vector<std::uint64_t> gone;
  std::size_t row = 0;
  for (std::size_t i = 0; i < agents_.size(); ++i) {
    if (row < scene.size() && scene.id[row] == agents_[i].id) {
      next_.push_back(agents_[i]);
      ++row;
    } else {
      gone.push_back(i);
    }
  }
  put_count(gone.size());
  std::uint64_t previous = 0;
  for (const std::uint64_t index : gone) {
    put_count(index - previous);
    previous = index;
  }
  put_count(scene.size() - row);
  for (; row < scene.size(); ++row) {
    next_.push_back({scene.id[row], 0, 0, 0, 0, 0});
    put_count(scene.id[row].value);
    put_byte(static_cast<unsigned>(types ? kind_of(*types, scene.type[row]) : scene.type[row]));
    put_byte(is_ours(scene.control[row]) ? 0 : 1);
    put_text(name_of(scene.id[row]));
    put_byte(scene.footprint[row].count);
    for (const Vec2& corner : scene.footprint[row].outline()) {
      put_signed(centimetres(corner.x()));
      put_signed(centimetres(corner.y()));
    }
  }
  agents_.swap(next_);
}

void ReplayRecorder::append_poses(const Scene& scene) {
  for (std::size_t row = 0; row < scene.size(); ++row) {
    Agent& agent = agents_[row];
    const std::int64_t x = centimetres(scene.position[row].x()),
                       y = centimetres(scene.position[row].y());
    const std::int64_t step_x = x - agent.x, step_y = y - agent.y;
    put_signed(step_x - agent.step_x);
    put_signed(step_y - agent.step_y);
    const std::int64_t heading = turn_steps(scene.heading[row]);
    std::int64_t turn = heading - agent.heading;
    const auto circle = static_cast<std::int64_t>(kTurnSteps);
    if (turn > circle / 2) turn -= circle;
    if (turn < -circle / 2) turn += circle;
    put_signed(turn);
    const RoadContext& context = scene.context[row];
    put_byte(static_cast<unsigned>(context.reason) | (context.active ? 16u : 0u));
    agent.x = x;
    agent.y = y;
    agent.heading = heading;
    agent.step_x = step_x;
    agent.step_y = step_y;
  }
}

void ReplayRecorder::append_signals(const RoadState& road) {
  if (road.signal_states == signals_) return;
  signals_.resize(road.signal_states.size());
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < signals_.size(); ++i)
    if (signals_[i] != road.signal_states[i]) changed.push_back(i);
  put_byte(2);
  put_count(changed.size());
  for (const std::size_t i : changed) {
    put_count(i);
    put_text(road.signal_states[i]);
    signals_[i] = road.signal_states[i];
  }
}

void ReplayRecorder::add_event(ReplayEventKind kind, double time, const Vec2& position, AgentId a,
                               AgentId b) {
  put_byte(3);
  put_byte(static_cast<unsigned>(kind));
  put_count(static_cast<std::uint64_t>(std::max<std::int64_t>(std::llround(time * 1000.0), 0)));
  put_signed(centimetres(position.x()));
  put_signed(centimetres(position.y()));
  put_count(a.value);
  put_count(b.value == kNobody ? 0 : std::uint64_t{b.value} + 1);
}

void ReplayRecorder::close() {
  if (!stream_) return;
  put_byte(0);
  flush();
  const int code = gzclose(stream_);
  stream_ = nullptr;
  if (code != Z_OK)
    throw Error(file_.string(),
                std::string("can't be written to its end (") + std::strerror(errno) + ")");
}

namespace {

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k)
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    const std::size_t given = std::min<std::size_t>(bytes.size() - i, 3);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= given ? kDigits[block >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

/// First bytes of a gzip file, inflated. Throws Error where it isn't a recording.
void check_recording(const std::filesystem::path& file) {
  gzFile stream = gzopen(file.c_str(), "rb");
  std::array<char, 4> magic{};
  const int read = stream ? gzread(stream, magic.data(), magic.size()) : -1;
  const bool direct = stream && gzdirect(stream) != 0;
  if (stream) gzclose(stream);
  if (read != 4 || direct || std::string_view(magic.data(), magic.size()) != "SGR1")
    throw Error(file.string(),
                "isn't a recording, expected replay.bin of `sumo-gamma run --replay`");
}

void replace_once(std::string& text, std::string_view mark, std::string_view with) {
  if (const std::size_t at = text.find(mark); at != std::string::npos)
    text.replace(at, mark.size(), with);
}

}  // namespace

void write_replay_page(const std::filesystem::path& page, const std::filesystem::path& recording) {
  const std::string bytes = read_file(recording);
  check_recording(recording);
  std::string html(kReplayPageHtml);
  replace_once(html, "/*STYLE*/", kReplayPageCss);
  replace_once(html, "/*SCRIPT*/", kReplayPageJs);
  replace_once(html, "<!--DATA-->", base64(bytes));
  write_file(page, html);
}

}  // namespace sumogamma
