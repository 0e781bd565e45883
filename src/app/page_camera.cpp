#include "app/page_camera.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/subprocess.h"

namespace sumogamma {

namespace {

using Json = nlohmann::json;

/// A file's address: what isn't a plain letter is escaped.
std::string url_of(const std::filesystem::path& file) {
  std::string url = "file://";
  for (const char letter : std::filesystem::absolute(file).string()) {
    const bool plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 ||
                       std::strchr("/-_.~", letter) != nullptr;
    url +=
        plain ? std::string(1, letter) : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
  }
  return url;
}

std::string decoded(const std::string& base64) {
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char letter : base64) {
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char* const at = letter == 0 ? nullptr : std::strchr(digits, letter);
    if (!at) continue;
    bits = bits << 6 | static_cast<unsigned>(at - digits);
    if (++count % 4 == 1) continue;
    const unsigned left = count % 4 == 2 ? 4u : count % 4 == 3 ? 2u : 0u;
    bytes.push_back(static_cast<char>(bits >> left & 0xffu));
  }
  return bytes;
}

}  // namespace

std::filesystem::path require_program(std::initializer_list<const char*> names,
                                      const std::string& package, const std::string& purpose) {
  for (const char* const name : names)
    if (std::filesystem::path found = find_program(name); !found.empty()) return found;
  throw Error(*names.begin(), "is not installed, which " + purpose +
                                  " is made with: install Debian's package " + package);
}

PageCamera::PageCamera(const std::filesystem::path& page, const Shot& shot) {
  const std::filesystem::path program =
      require_program({"chromium", "chromium-browser", "google-chrome"}, "chromium", "a picture");
  PipedProcess::Request request;
  request.arguments = {program.string(),
                       "--headless",
                       "--remote-debugging-pipe",
                       "--user-data-dir=" + (scratch_.path() / "profile").string(),
                       "--disable-gpu",
                       "--disable-dev-shm-usage",
                       "--no-first-run",
                       "--no-default-browser-check",
                       "--disable-background-networking",
                       "--disable-component-update",
                       "--disable-sync",
                       "--hide-scrollbars",
                       "about:blank"};
  // Chromium has no sandbox for root
  if (geteuid() == 0) request.arguments.emplace_back("--no-sandbox");
  request.input = 3;
  request.output = 4;
  request.log = scratch_.path() / "chromium.log";
  browser_ = std::make_unique<PipedProcess>(std::move(request));
  open(page, shot);
}

void PageCamera::open(const std::filesystem::path& page, const Shot& shot) {
  const Json target = ask("Target.createTarget", {{"url", "about:blank"}});
  session_ = ask("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}})
                 .at("sessionId");
  ask("Emulation.setDeviceMetricsOverride", {{"width", shot.width},
                                             {"height", shot.height},
                                             {"deviceScaleFactor", 1},
                                             {"mobile", false}});
  ask("Page.navigate", {{"url", url_of(page) + "#" + shot.view}});
  constexpr int kTries = 1200;  // a minute
  std::string state;
  for (int i = 0; i < kTries && state != "ready"; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    state = evaluate("document.documentElement?.dataset.state ?? ''").get<std::string>();
    if (state == "empty") throw Error(page.string(), "its recording holds no step");
    if (state == "error") throw Error(page.string(), "its recording can't be read");
  }
  if (state != "ready") throw Error(page.string(), "isn't shown within a minute");
  const Json span = evaluate("window.replay.span()");
  begin_ = span.at(0);
  end_ = span.at(1);
}

Json PageCamera::ask(const std::string& method, const Json& parameters) {
  Json message = {{"id", ++asked_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  browser_->write(message.dump() + '\0');
  for (;;) {
    Json answer = Json::parse(browser_->read_until('\0'));
    if (answer.value("id", 0) != asked_) continue;  // an event
    if (answer.contains("error"))
      throw Error("chromium", method + ": " + answer["error"].value("message", "failed"));
    return std::move(answer.at("result"));
  }
}

Json PageCamera::evaluate(const std::string& expression) {
  const Json answer =
      ask("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}});
  if (answer.contains("exceptionDetails"))
    throw Error("replay page", "its script failed at: " + expression);
  return answer.at("result").value("value", Json());
}

std::string PageCamera::picture(double time, const std::string& format) {
  evaluate(fmt::format("window.replay.show({})", time));
  Json parameters = {{"format", format}};
  if (format == "jpeg") parameters["quality"] = 92;
  return decoded(ask("Page.captureScreenshot", parameters).at("data"));
}

}  // namespace sumogamma
