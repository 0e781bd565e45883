#include "io/replay_page.h"

#include <zlib.h>

#include <array>
#include <cstdint>

#include "base/error.h"
#include "io/output_file.h"
#include "io/page_assets.h"

namespace sumogamma {

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

namespace {

/// First bytes of a gzip file, inflated. Throws Error where it isn't a recording.
void check_recording(const std::filesystem::path& file) {
  gzFile stream = gzopen(file.c_str(), "rb");
  std::array<char, 4> magic{};
  const int read = stream ? gzread(stream, magic.data(), magic.size()) : -1;
  const bool direct = stream && gzdirect(stream) != 0;
  if (stream) gzclose(stream);
  const std::string_view found(magic.data(), magic.size());
  if (read == 4 && !direct && found != "SGR3" && found.substr(0, 3) == "SGR")
    throw Error(file.string(), "another version of sumo-gamma recorded it, run again");
  if (read != 4 || direct || found != "SGR3")
    throw Error(file.string(),
                "isn't a recording, expected replay.bin of `sumo-gamma run --replay`");
}

void replace_once(std::string& text, std::string_view mark, std::string_view with) {
  if (const std::size_t at = text.find(mark); at != std::string::npos)
    text.replace(at, mark.size(), with);
}

}  // namespace

std::string live_replay_page() {
  std::string html(kReplayPageHtml);
  replace_once(html, "/*STYLE*/", kReplayPageCss);
  replace_once(html, "/*SCRIPT*/", kReplayPageJs);
  return html;
}

void write_replay_page(const std::filesystem::path& page, const std::filesystem::path& recording) {
  const std::string bytes = read_file(recording);
  check_recording(recording);
  std::string html = live_replay_page();
  replace_once(html, "<!--DATA-->", base64(bytes));
  write_file(page, html);
}

}  // namespace sumogamma
