#include "io/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/xml_text.h"

namespace sumogamma {

namespace {

constexpr double kLeft = 58, kRight = 12, kTop = 26, kBottom = 40;
// Okabe and Ito's colours, which people with any colour vision tell apart; shapes differ, too
constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"};

const char* colour_of(std::size_t series) { return kColours[series % std::size(kColours)]; }

struct Axis {
  double low = 0, high = 1;

  void widen(double value) {
    if (!std::isfinite(value)) return;
    low = empty ? value : std::min(low, value);
    high = empty ? value : std::max(high, value);
    empty = false;
  }
  void settle() {
    if (empty) *this = {0, 1, true};
    if (low == high) high = low + 1;
  }
  bool empty = true;
};

/// 1, 2 or 5 times a power of ten: some four of them cover the axis.
double tick_of(const Axis& axis) {
  const double rough = (axis.high - axis.low) / 4;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double share = rough / power;
  return power * (share < 1.5 ? 1 : share < 3.5 ? 2 : share < 7.5 ? 5 : 10);
}

class Picture {
 public:
  Picture(const PlotFrame& frame, Axis x, Axis y) : frame_(frame), x_(x), y_(y) {
    x_.settle();
    y_.settle();
    if (frame.square) make_square();
    text_ = fmt::format(
        R"(<svg class="plot" viewBox="0 0 {0:.0f} {1:.0f}" role="img" aria-label="{2}">)"
        R"(<text class="title" x="{3}" y="15">{2}</text>)",
        frame.width, frame.height, escaped(frame.title), kLeft);
    draw_axes();
  }
  double px(double x) const {
    return kLeft + (x - x_.low) / (x_.high - x_.low) * (frame_.width - kLeft - kRight);
  }
  double py(double y) const {
    return frame_.height - kBottom -
           (y - y_.low) / (y_.high - y_.low) * (frame_.height - kTop - kBottom);
  }
  void mark(std::size_t series, double x, double y) {
    const double at_x = px(x), at_y = py(y);
    const char* const colour = colour_of(series);
    if (series % 3 == 0)
      text_ +=
          fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="2.6" fill="{}"/>)", at_x, at_y, colour);
    else if (series % 3 == 1)
      text_ += fmt::format(R"(<rect x="{:.1f}" y="{:.1f}" width="5" height="5" fill="none" )"
                           R"(stroke="{}"/>)",
                           at_x - 2.5, at_y - 2.5, colour);
    else
      text_ += fmt::format(R"(<path d="M{0:.1f} {1:.1f}l3 5h-6z" fill="none" stroke="{2}"/>)", at_x,
                           at_y - 3, colour);
  }
  void line(std::size_t series, const std::string& path) {
    constexpr const char* kDashes[] = {"", "6 3", "2 3"};
    text_ += fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="1.8" )"
                         R"(stroke-dasharray="{}"/>)",
                         path, colour_of(series), kDashes[series % 3]);
  }
  void note(const std::string& words) {
    text_ += fmt::format(R"(<text x="{:.0f}" y="{:.0f}" text-anchor="middle">{}</text>)",
                         0.5 * frame_.width, 0.5 * frame_.height, escaped(words));
  }
  void label(double y, const std::string& words) {
    text_ += fmt::format(R"(<text x="{}" y="{:.1f}" text-anchor="end">{}</text>)", kLeft - 6, y + 4,
                         escaped(words));
  }
  std::string finish() { return text_ + "</svg>"; }

 private:
  void make_square() {
    const double wide = frame_.width - kLeft - kRight, tall = frame_.height - kTop - kBottom;
    const double scale = std::max((x_.high - x_.low) / wide, (y_.high - y_.low) / tall);
    const double more_x = scale * wide - (x_.high - x_.low),
                 more_y = scale * tall - (y_.high - y_.low);
    x_.low -= 0.5 * more_x;
    x_.high += 0.5 * more_x;
    y_.low -= 0.5 * more_y;
    y_.high += 0.5 * more_y;
  }
  void draw_axes() {
    const double bottom = frame_.height - kBottom, right = frame_.width - kRight;
    text_ +=
        fmt::format(R"(<path class="axis" d="M{0} {1}V{2}H{3}"/>)", kLeft, kTop, bottom, right);
    const double step = tick_of(x_);
    for (double tick = std::ceil(x_.low / step) * step; tick <= x_.high + 1e-9 * step; tick += step)
      text_ += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{:.4g}</text>)",
                           px(tick), bottom + 14, std::abs(tick) < 1e-9 * step ? 0.0 : tick);
    text_ += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)",
                         0.5 * (kLeft + right), bottom + 30, escaped(frame_.x_label));
    if (frame_.y_label.empty()) return;
    const double rise = tick_of(y_);
    for (double tick = std::ceil(y_.low / rise) * rise; tick <= y_.high + 1e-9 * rise; tick += rise)
      label(py(tick), fmt::format("{:.4g}", std::abs(tick) < 1e-9 * rise ? 0.0 : tick));
    text_ += fmt::format(
        R"svg(<text transform="translate(12 {:.1f}) rotate(-90)" text-anchor="middle">{}</text>)svg",
        0.5 * (kTop + bottom), escaped(frame_.y_label));
  }

  const PlotFrame& frame_;
  Axis x_, y_;
  std::string text_;
};

}  // namespace

std::string scatter_svg(const PlotFrame& frame, std::span<const PlotSeries> series) {
  Axis x, y;
  for (const PlotSeries& one : series) {
    for (const double value : one.x) x.widen(value);
    for (const double value : one.y) y.widen(value);
  }
  const bool empty = x.empty;
  if (!frame.square && !empty) {
    x.widen(0);
    y.widen(0);
  }
  Picture picture(frame, x, y);
  if (empty) picture.note("none");
  for (std::size_t s = 0; s < series.size(); ++s)
    for (std::size_t k = 0; k < series[s].x.size(); ++k)
      if (std::isfinite(series[s].x[k]) && std::isfinite(series[s].y[k]))
        picture.mark(s, series[s].x[k], series[s].y[k]);
  return picture.finish();
}

std::string histogram_svg(const PlotFrame& frame, std::span<const PlotSeries> series,
                          std::size_t bins) {
  std::vector<double> all;
  for (const PlotSeries& one : series) all.insert(all.end(), one.x.begin(), one.x.end());
  std::sort(all.begin(), all.end());
  Axis x, y;
  x.widen(all.empty() ? 0 : std::min(0.0, all.front()));
  x.widen(all.empty() ? 1
                      : all[static_cast<std::size_t>(0.99 * static_cast<double>(all.size() - 1))]);
  x.settle();
  y.widen(0);
  std::vector<std::vector<double>> shares;
  for (const PlotSeries& one : series) {
    std::vector<double> share(bins, 0.0);
    for (const double value : one.x) {
      const double place = (value - x.low) / (x.high - x.low) * static_cast<double>(bins);
      share[std::min(static_cast<std::size_t>(std::max(place, 0.0)), bins - 1)] +=
          1.0 / static_cast<double>(one.x.size());
    }
    for (const double value : share) y.widen(value);
    shares.push_back(std::move(share));
  }
  Picture picture(frame, x, y);
  if (all.empty()) picture.note("none");
  for (std::size_t s = 0; s < shares.size(); ++s) {
    if (series[s].x.empty()) continue;
    std::string path;
    for (std::size_t k = 0; k < bins; ++k) {
      const double width = (x.high - x.low) / static_cast<double>(bins);
      const double left = x.low + static_cast<double>(k) * width;
      path += fmt::format("{}{:.1f} {:.1f}H{:.1f}", k == 0 ? "M" : "L", picture.px(left),
                          picture.py(shares[s][k]), picture.px(left + width));
    }
    picture.line(s, path);
  }
  return picture.finish();
}

std::string strip_svg(const PlotFrame& frame, std::span<const PlotSeries> series) {
  Axis x, y;
  for (const PlotSeries& one : series)
    for (const double value : one.x) x.widen(value);
  y.widen(-0.7);
  y.widen(static_cast<double>(series.size()) - 0.3);
  Picture picture(frame, x, y);
  for (std::size_t s = 0; s < series.size(); ++s) {
    const double line = static_cast<double>(series.size() - 1 - s);
    picture.label(picture.py(line), series[s].name.substr(0, 9));
    for (const double value : series[s].x) picture.mark(s, value, line);
  }
  return picture.finish();
}

std::string interval_svg(double low, double middle, double high, double reach) {
  const auto at = [&](double value) { return 80.0 + 76.0 * std::clamp(value / reach, -1.0, 1.0); };
  return fmt::format(
      R"(<svg class="interval" width="160" height="16" viewBox="0 0 160 16" role="presentation">)"
      R"(<path class="zero" d="M80 0V16"/><path class="reach" d="M{:.1f} 8H{:.1f}"/>)"
      R"(<circle cx="{:.1f}" cy="8" r="3.5"/></svg>)",
      at(low), at(high), at(middle));
}

}  // namespace sumogamma
