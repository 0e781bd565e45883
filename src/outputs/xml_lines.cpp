#include "outputs/xml_lines.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <system_error>

#include "base/error.h"
#include "base/xml_text.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

using File = std::unique_ptr<gzFile_s, decltype(&gzclose)>;

std::string unescaped(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kNames = {
      {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};
  std::string result;
  while (!text.empty()) {
    const auto name = std::find_if(kNames.begin(), kNames.end(),
                                   [&](const auto& one) { return text.starts_with(one.first); });
    result += name == kNames.end() ? text.front() : name->second;
    text.remove_prefix(name == kNames.end() ? 1 : name->first.size());
  }
  return result;
}

/// The next line; false at the end of the file, or of what is whole of it.
bool read_line(gzFile file, std::string& line) {
  line.clear();
  std::array<char, 4096> part{};
  while (gzgets(file, part.data(), static_cast<int>(part.size())) != nullptr) {
    line += part.data();
    if (line.ends_with('\n')) {
      line.pop_back();
      return true;
    }
  }
  return false;
}

void write_line(gzFile file, const fs::path& name, const std::string& line) {
  if (gzwrite(file, line.data(), static_cast<unsigned>(line.size())) <
          static_cast<int>(line.size()) ||
      gzputc(file, '\n') < 0)
    throw Error(name.string(), "can't be written to its end, make room and run again");
}

/// Are we in SUMO's comment at the head of its files, which holds its whole configuration?
class Comment {
 public:
  bool holds(const std::string& line) {
    const bool is_comment = open_ || line.starts_with("<!--");
    open_ = is_comment && line.find("-->") == std::string::npos;
    return is_comment;
  }

 private:
  bool open_ = false;
};

/// Follows the elements that are open.
class Nesting {
 public:
  /// Depth after a line.
  void follow(const XmlLine& line) {
    if (!line.element.empty()) {
      if (!line.closed) open_.push_back(line.element);
      return;
    }
    const std::size_t first = line.text.find_first_not_of(' ');
    if (first != std::string::npos && line.text.compare(first, 2, "</") == 0 && !open_.empty())
      open_.pop_back();
  }
  std::vector<std::string>& open() { return open_; }

 private:
  std::vector<std::string> open_;
};

}  // namespace

std::string_view XmlLine::get(std::string_view name) const {
  for (const auto& [key, value] : attributes)
    if (key == name) return value;
  return {};
}

bool XmlLine::has(std::string_view name) const { return get(name).data() != nullptr; }

void XmlLine::set(std::string_view name, std::string value) {
  for (auto& [key, old] : attributes)
    if (key == name) {
      old = std::move(value);
      return;
    }
}

double XmlLine::number(std::string_view name, double otherwise) const {
  const std::string_view value = get(name);
  double result = otherwise;
  std::from_chars(value.data(), value.data() + value.size(), result);
  return result;
}

XmlLine parse_line(std::string text) {
  XmlLine line;
  line.text = std::move(text);
  std::string_view rest = line.text;
  rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
  if (rest.size() < 2 || rest[0] != '<' || rest[1] == '/' || rest[1] == '!' || rest[1] == '?')
    return line;
  rest.remove_prefix(1);
  const std::size_t end = std::min(rest.find_first_of(" />"), rest.size());
  std::string element(rest.substr(0, end));
  rest.remove_prefix(end);
  while (true) {
    const std::size_t equals = rest.find("=\"");
    const std::size_t quote =
        equals == std::string_view::npos ? equals : rest.find('"', equals + 2);
    if (quote == std::string_view::npos) break;
    const std::size_t begin = std::min(rest.find_first_not_of(' '), equals);
    line.attributes.emplace_back(rest.substr(begin, equals - begin),
                                 unescaped(rest.substr(equals + 2, quote - equals - 2)));
    rest.remove_prefix(quote + 1);
  }
  line.closed = rest.find("/>") != std::string_view::npos;
  if (line.closed || rest.find('>') != std::string_view::npos) line.element = std::move(element);
  return line;
}

std::string text_of(const XmlLine& line) {
  std::string text(std::min(line.text.find_first_not_of(' '), line.text.size()), ' ');
  text += '<' + line.element;
  for (const auto& [name, value] : line.attributes) {
    text += ' ' + name + "=\"";
    append_escaped(text, value);
    text += '"';
  }
  text += line.closed ? "/>" : ">";
  return text;
}

void visit_lines(const fs::path& file, const std::function<void(const XmlLine&)>& look) {
  const File source(gzopen(file.c_str(), "rb"), &gzclose);
  if (!source) return;
  Comment comment;
  for (std::string text; read_line(source.get(), text);) {
    if (comment.holds(text)) continue;
    const XmlLine line = parse_line(std::move(text));
    if (!line.element.empty()) look(line);
  }
}

void copy_lines(const fs::path& from, const fs::path& to,
                const std::function<LineFate(XmlLine&)>& change) {
  const File source(gzopen(from.c_str(), "rb"), &gzclose);
  if (!source) return;
  const fs::path unfinished = from.parent_path() / (from.filename().string() + ".part");
  File target(gzopen(unfinished.c_str(), to.extension() == ".gz" ? "wb4" : "wbT"), &gzclose);
  if (!target) throw Error(to.string(), "can't be written");
  Nesting nesting;
  std::size_t dropped_from = std::string::npos;  // depth of what is left out
  Comment comment;
  for (std::string text; read_line(source.get(), text);) {
    if (comment.holds(text)) {
      write_line(target.get(), to, text);
      continue;
    }
    XmlLine line = parse_line(std::move(text));
    const std::size_t depth = nesting.open().size();
    nesting.follow(line);
    if (dropped_from != std::string::npos) {
      if (nesting.open().size() <= dropped_from) dropped_from = std::string::npos;
      continue;
    }
    const LineFate fate = line.element.empty() ? LineFate::Keep : change(line);
    if (fate == LineFate::Drop) {
      if (!line.closed) dropped_from = depth;
      continue;
    }
    write_line(target.get(), to, fate == LineFate::Rewrite ? text_of(line) : line.text);
  }
  // SUMO died: what is whole of it is ended
  for (auto& open = nesting.open(); !open.empty(); open.pop_back())
    write_line(target.get(), to,
               std::string(4 * (open.size() - 1), ' ') + "</" + open.back() + ">");
  std::error_code failed;
  if (gzclose(target.release()) == Z_OK) fs::rename(unfinished, to, failed);
  if (failed || fs::exists(unfinished, failed))
    throw Error(to.string(), "can't be written to its end, make room and run again");
}

}  // namespace sumogamma
